#include "bench/scene_set.h"
#include "display/imageio.h"
#include "texture/maketexture.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace alpenglow::bench {
namespace {

namespace fs = std::filesystem;

/// Mixes an integer: every bit of the result depends on every bit of the input (David Stafford, variant 13).
uint64_t mixed(uint64_t x) {
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ull;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebull;
    return x ^ x >> 31;
}
/// 0..1, of three integers.
double hashed(uint64_t a, uint64_t b = 0, uint64_t c = 0) {
    return double(mixed(a * 0x9e3779b97f4a7c15ull + mixed(b + 0x51ull * c)) >> 11) * 0x1p-53;
}

/// A text file that is whole or not there.
class Text {
public:
    Text(std::string path, Diagnostics& d)
        : path_(std::move(path)), diagnostics_(d), file_(std::fopen((path_ + "~").c_str(), "wb")) {}
    ~Text() {
        if (file_) std::fclose(file_);
    }
    Text(const Text&) = delete;
    Text& operator=(const Text&) = delete;
    [[gnu::format(printf, 2, 3)]] void operator()(const char* format, ...) {
        if (!file_) return;
        va_list args;
        va_start(args, format);
        std::vfprintf(file_, format, args);
        va_end(args);
    }
    bool done() {
        bool fine = file_ && !std::ferror(file_);
        if (file_) fine &= std::fclose(file_) == 0;
        file_ = nullptr;
        std::error_code e;
        if (fine) fs::rename(path_ + "~", path_, e);
        if (!fine || e) diagnostics_.report(Severity::Error, Rie::System, {}, "cannot write " + path_);
        return fine && !e;
    }

private:
    std::string path_;
    Diagnostics& diagnostics_;
    FILE* file_;
};

bool copyInto(const std::string& from, const std::string& folder, Diagnostics& d) {
    std::error_code e;
    fs::copy_file(from, fs::path(folder) / fs::path(from).filename(), fs::copy_options::overwrite_existing, e);
    if (e) d.report(Severity::Error, Rie::System, {}, "cannot copy " + from + " to " + folder + ": " + e.message());
    return !e;
}

/// Tiles with joints, each with a colour and a grain of its own, as a MIP-mapped texture of side x side texels.
bool writeTiles(const std::string& path, int side, Diagnostics& d) {
    if (fs::exists(path)) return true;
    display::Image image = display::makeImage(side, side, {"r", "g", "b"});
    constexpr int kTiles = 16;
    const int tile = std::max(1, side / kTiles);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto i = uint64_t(x / tile), j = uint64_t(y / tile);
            const double u = double(x % tile) / tile, v = double(y % tile) / tile;
            const bool joint = std::min({u, v, 1 - u, 1 - v}) < 0.04;
            const double grain = 0.75 + 0.25 * hashed(uint64_t(x / 2), uint64_t(y / 8), 9);
            for (uint64_t k = 0; k < 3; ++k) image.pixel(x, y)[k] = joint ? 0.25f : float(grain * (0.25 + 0.7 * hashed(i, j, k)));
        }
    const std::string picture = path + ".png";
    const OutputPolicy anywhere{".", true};
    if (!display::writeImage(picture, image,
                             {.format = display::Format::Png, .sample = display::Sample::UInt8, .policy = anywhere}, d))
        return false;
    texture::MakeOptions m;
    m.swrap = m.twrap = "periodic";
    m.policy = anywhere;
    const bool made = texture::makeTexture(picture, path, m, d);
    fs::remove(picture);
    return made;
}

/// Gradient noise on the unit lattice, -0.7..0.7 (Perlin 2002), gradients of length 1 by hash.
double noise(double x, double y, uint64_t seed) {
    const double ix = std::floor(x), iy = std::floor(y), fx = x - ix, fy = y - iy;
    const auto corner = [&](int dx, int dy) {
        const double a =
            6.283185307179586 * hashed(uint64_t(int64_t(ix)) + uint64_t(dx), uint64_t(int64_t(iy)) + uint64_t(dy), seed);
        return std::cos(a) * (fx - dx) + std::sin(a) * (fy - dy);
    };
    const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const double u = fade(fx), v = fade(fy);
    return std::lerp(std::lerp(corner(0, 0), corner(1, 0), u), std::lerp(corner(0, 1), corner(1, 1), u), v);
}

/// Eight octaves, the first three with ridges.
double height(double x, double z) {
    double y = 0, amplitude = 1, frequency = 0.8;
    for (uint64_t o = 0; o < 8; ++o, amplitude *= 0.5, frequency *= 2) {
        const double n = noise(x * frequency + 40, z * frequency + 40, o);
        y += amplitude * (o < 3 ? 1 - 2 * std::abs(n) : n);
    }
    return y;
}

/// Two triangles a cell of a grid of n x n vertices.
void gridFaces(Text& t, int n) {
    t("PointsPolygons [");
    for (int i = 0; i < 2 * (n - 1) * (n - 1); ++i) t(i % 40 == 39 ? "3\n" : "3 ");
    t("] [");
    for (int i = 0; i + 1 < n; ++i)
        for (int j = 0; j + 1 < n; ++j) {
            const int a = i * n + j, b = a + n;
            t("%d %d %d\n%d %d %d\n", a, a + 1, b + 1, a, b + 1, b);
        }
    t("]");
}

constexpr const char* kSkyAndLamp =
    "LightSource \"envlight\" \"sky\" \"float intensity\" 0.5\n"
    "AttributeBegin\nAreaLightSource \"slrect\" \"lamp\" \"float intensity\" 20\nSurface \"constant\"\nColor 0 0 0\nSides 1\n"
    "Polygon \"P\" [5 1 -.75  5 1 .75  5 2.5 .75  5 2.5 -.75]\nAttributeEnd\nIlluminate \"lamp\" 1\nIlluminate \"sky\" 1\n";

void head(Text& t, const char* name, int width, int height, const char* rest) {
    t("Display \"%s.exr\" \"openexr\" \"rgb\"\nFormat %d %d 1\nPixelFilter \"box\" 1 1\nPixelSamples 4 4\nHider \"path\"\n%s",
      name, width, height, rest);
}

/// From (0, 4, 3.2) to (0, -.3, -.2) in a right-handed world with y up.
constexpr const char* kFromAbove =
    "Projection \"perspective\" \"fov\" 30\nOption \"trace\" \"int maxdepth\" 10\n"
    "ConcatTransform [1 0 0 0  0 0.620235584 -0.784415592 0  0 -0.784415592 -0.620235584 0  0 0.0291875569 5.12241624 1]\n";

bool writeTerrain(const std::string& folder, double size, Diagnostics& d) {
    const std::string path = folder + "/terrain.rib";
    if (fs::exists(path)) return true;
    const int n = std::max(2, int(std::lround(1024 * size))) + 1;
    std::vector<double> y(size_t(n) * size_t(n));
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            sum += y[size_t(i) * size_t(n) + size_t(j)] = height(-4 + 8.0 * i / (n - 1), -4 + 8.0 * j / (n - 1));
    sum /= double(n) * n;
    Text t(path, d);
    head(t, "terrain", 960, 540, kFromAbove);
    t("WorldBegin\nSides 2\n%sSurface \"slmaterial\" \"color diffusecolor\" [.6 .6 .6]\n", kSkyAndLamp);
    gridFaces(t, n);
    t(" \"P\" [");
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            t("%.7g %.7g %.7g\n", -4 + 8.0 * i / (n - 1), y[size_t(i) * size_t(n) + size_t(j)] - sum, -4 + 8.0 * j / (n - 1));
    t("]\nWorldEnd\n");
    return t.done();
}

/// Rolling hills with normals, s, t and a map, under nothing but the sky.
bool writeMesh(const std::string& folder, double size, Diagnostics& d) {
    const std::string path = folder + "/mesh.rib";
    if (!writeTiles(folder + "/mesh.tx", std::max(64, int(std::lround(4096 * size))), d)) return false;
    if (fs::exists(path)) return true;
    const int n = std::max(2, int(std::lround(708 * size))) + 1;
    const auto at = [&](int i) { return -4 + 8.0 * i / (n - 1); };
    const auto y = [](double x, double z) {
        return 0.35 * std::sin(1.7 * x) * std::cos(1.3 * z) + 0.08 * std::sin(5 * x + 2 * z);
    };
    Text t(path, d);
    head(t, "mesh", 640, 360, kFromAbove);
    t("WorldBegin\nSides 2\nLightSource \"envlight\" \"sky\" \"float intensity\" 1\nIlluminate \"sky\" 1\n"
      "Surface \"paintedplastic\" \"float Kd\" 0.8 \"float Ks\" 0.2 \"string texturename\" [\"mesh.tx\"]\n");
    gridFaces(t, n);
    t(" \"P\" [");
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) t("%.7g %.7g %.7g\n", at(i), y(at(i), at(j)), at(j));
    t("] \"N\" [");
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x = at(i), z = at(j), c = 0.4 * std::cos(5 * x + 2 * z);
            t("%.6g 1 %.6g\n", -(0.595 * std::cos(1.7 * x) * std::cos(1.3 * z) + c),
              0.455 * std::sin(1.7 * x) * std::sin(1.3 * z) - 0.4 * c);
        }
    t("] \"st\" [");
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) t("%.7g %.7g\n", 2.0 * i / (n - 1), 2.0 * j / (n - 1));
    t("]\nWorldEnd\n");
    return t.done();
}

bool writeSpots(const std::string& folder, int which, Diagnostics& d) {
    char name[16];
    std::snprintf(name, sizeof name, "spots%02d", which);
    const auto k = uint64_t(which);
    Text t(folder + "/" + name + ".sl", d);
    t("/* One of many that differ in their numbers only. */\nsurface %s(float Kd = .8;) {\n", name);
    t("    float n = noise(%.4f * transform(\"shader\", P) + %d);\n", 4 + 5 * hashed(k, 1), which);
    t("    color c = mix(color(%.4f, %.4f, %.4f), color(%.4f, %.4f, %.4f), smoothstep(.35, .65, n));\n", hashed(k, 2),
      hashed(k, 3), hashed(k, 4), hashed(k, 5), hashed(k, 6), hashed(k, 7));
    t("    Oi = Os;\n    Ci = Os * Cs * c * Kd * diffuse(faceforward(normalize(N), I));\n}\n");
    return t.done();
}

/// Five hundred spheres on a floor, with `shaders` shaders in turns.
bool writeSpheres(const std::string& folder, const char* name, int shaders, double size, Diagnostics& d) {
    for (int k = 0; k < shaders; ++k)
        if (!writeSpots(folder, k, d)) return false;
    Text t(folder + "/" + name + ".rib", d);
    head(t, name, 480, 300, kFromAbove);
    t("WorldBegin\nSides 2\n%sAttributeBegin\nSurface \"slmaterial\" \"color diffusecolor\" [.6 .6 .6]\n"
      "Polygon \"P\" [-6 -.5 -6  6 -.5 -6  6 -.5 6  -6 -.5 6]\nAttributeEnd\n",
      kSkyAndLamp);
    const int rows = std::max(2, int(std::lround(20 * std::sqrt(size)))),
              columns = std::max(2, int(std::lround(25 * std::sqrt(size))));
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const int k = i * columns + j;
            const double r = 0.06 + 0.06 * hashed(uint64_t(k), 11);
            t("AttributeBegin\nSurface \"spots%02d\"\nTranslate %.4f %.4f %.4f\nSphere %.4f %.4f %.4f 360\nAttributeEnd\n",
              k % shaders, -2.2 + 4.4 * (j + 0.3 * hashed(uint64_t(k), 12)) / columns, -0.5 + r,
              -1.9 + 3.6 * (i + 0.3 * hashed(uint64_t(k), 13)) / rows, r, -r, r);
        }
    t("WorldEnd\n");
    return t.done();
}

/// Spheres on a floor under lights of the same power together: points and small squares in turns.
bool writeLights(const std::string& folder, const char* name, int lights, Diagnostics& d) {
    Text t(folder + "/" + name + ".rib", d);
    head(t, name, 480, 300, kFromAbove);
    t("WorldBegin\nSides 2\n");
    const double each = 1.0 / lights;
    for (int k = 0; k < lights; ++k) {
        const auto h = [&](uint64_t what) { return hashed(uint64_t(k), what, 77); };
        const double x = -3 + 6 * h(1), y = 0.2 + 1.3 * h(2), z = -3 + 5 * h(3);
        const double r = 0.4 + 0.6 * h(4), g = 0.4 + 0.6 * h(5), b = 0.4 + 0.6 * h(6);
        if (k % 2 == 0) {
            t("LightSource \"pointlight\" %d \"float intensity\" %.6g \"color lightcolor\" [%.4f %.4f %.4f] \"point from\" [%.5f "
              "%.5f %.5f]\n",
              k + 1, 5 * each, r, g, b, x, y, z);
            continue;
        }
        constexpr double s = 0.02; // half a side
        t("AttributeBegin\nAreaLightSource \"slrect\" %d \"float intensity\" %.6g \"color lightcolor\" [%.4f %.4f %.4f]\nSurface "
          "\"constant\"\n"
          "Color 0 0 0\nSides 1\nPolygon \"P\" [%.5f %.5f %.5f  %.5f %.5f %.5f  %.5f %.5f %.5f  %.5f %.5f "
          "%.5f]\nAttributeEnd\nIlluminate %d 1\n",
          k + 1, 5 * each / (4 * s * s), r, g, b, x - s, y, z - s, x + s, y, z - s, x + s, y, z + s, x - s, y, z + s, k + 1);
    }
    t("Surface \"slmaterial\" \"color diffusecolor\" [.6 .6 .6]\nPolygon \"P\" [-6 -.5 -6  6 -.5 -6  6 -.5 6  -6 -.5 6]\n");
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 5; ++j)
            t("TransformBegin\nTranslate %.3f -0.2 %.3f\nSphere 0.3 -0.3 0.3 360\nTransformEnd\n", -1.8 + 0.9 * j,
              -1.4 + 1.1 * i);
    t("WorldEnd\n");
    return t.done();
}

const std::vector<std::string>& ownFiles(const std::string& name) {
    static const std::vector<std::string> lobes{"lobes.rib", "ggxglass.sl", "facetmetal.sl", "fibres.sl"},
        waiting{"waiting.rib", "threshold.sl"}, plastic{"plastic.rib"}, none;
    return name == "lobes" ? lobes : name == "waiting" ? waiting : name == "plastic" ? plastic : none;
}

} // namespace

const std::vector<BenchScene>& benchScenes() {
    static const std::vector<BenchScene> all{
        {"box", "(a) the Muttenzer box, 640 x 480, path", 8, false},
        {"terrain", "(b) a terrain of 2.1 million triangles, lamp and sky, 960 x 540, path", 2, true},
        {"mesh", "(c) a million triangles with N, st, a map of 4096 x 4096, sky, 640 x 360, path", 8, true},
        {"plastic", "(d) twelve objects of plastic and paintedplastic, eight point lights, fog, 480 x 300, hidden", 9, false},
        {"lobes", "(e) trace() with GGX glass, Beckmann metal and hair, lamp and sky, 480 x 300, path", 2, false},
        {"waiting", "(f) a shader that waits: a threshold on traced light, 400 x 300, path", 8, false},
        {"fifty_shaders", "(g) fifty shaders on five hundred spheres, lamp and sky, 480 x 300, path", 8, true},
        {"one_shader", "    the same with one shader", 8, true},
        {"thousand_lights", "(h) a thousand lights, points and squares, 480 x 300, path", 2, true},
        {"ten_lights", "    the same with ten lights", 4, true}};
    return all;
}

bool writeBenchScene(const std::string& name, const std::string& folder, double size, Diagnostics& d) {
    std::error_code e;
    fs::create_directories(folder, e);
    const std::string source = ALPENGLOW_SOURCE_DIR;
    const auto share = [&](int n, int least) { return std::max(least, int(std::lround(n * size))); };
    if (name == "terrain") return writeTerrain(folder, size, d);
    if (name == "mesh") return writeMesh(folder, size, d);
    if (name == "fifty_shaders") return writeSpheres(folder, "fifty_shaders", share(50, 2), size, d);
    if (name == "one_shader") return writeSpheres(folder, "one_shader", 1, size, d);
    if (name == "thousand_lights") return writeLights(folder, "thousand_lights", share(1000, 12), d);
    if (name == "ten_lights") return writeLights(folder, "ten_lights", 10, d);
    if (name == "box") {
        if (!copyInto(source + "/examples/muttenzer_box.rib", folder, d)) return false;
        fs::rename(folder + "/muttenzer_box.rib", folder + "/box.rib", e);
        return !e;
    }
    if (name == "plastic" && !writeTiles(folder + "/tiles.tx", share(1024, 64), d)) return false;
    for (const std::string& file : ownFiles(name))
        if (!copyInto(source + "/bench/scenes/" + file, folder, d)) return false;
    if (!ownFiles(name).empty()) return true;
    d.report(Severity::Error, Rie::BadToken, {}, "there is no bench scene \"" + name + "\"");
    return false;
}

} // namespace alpenglow::bench
