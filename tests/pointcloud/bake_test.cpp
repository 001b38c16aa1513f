// Baking as a user has it: baked, read back, compared with what the shader says directly; the same bits for any number of
// threads.
#include "cli/command_folder.h"
#include "display/imageio.h"
#include "pointcloud/bakefile.h"
#include "pointcloud/bakelog.h"
#include "pointcloud/cloudfile.h"
#include "pointcloud/make.h"

namespace bake_test {

namespace {

using namespace alpenglow;

constexpr double kPi = 3.14159265358979323846;

class Bake : public cli::testing::CommandFolder {
protected:
    const std::string ball = "Surface \"baker\"\nSphere 1 -1 1 360\nWorldEnd\n";
    const std::string begin = "Projection \"perspective\" \"fov\" 40\nTranslate 0 0 4\nWorldBegin\n";
    std::string header(const std::string& name, const std::string& hider = "hidden") const {
        return "Format 48 48 1\nPixelSamples 2 2\nHider \"" + hider + "\"\nDisplay \"" + name + "\" \"openexr\" \"rgba\"\n";
    }
    void writeShader(const std::string& name, const std::string& body) const {
        write(name + ".sl", "surface " + name + "() { Oi = 1; Ci = Cs; " + body + " }\n");
    }
    std::string bytes(const std::string& name) const {
        std::ifstream f(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(f), {}};
    }
    pointcloud::PointCloud cloud(const std::string& name) const {
        Diagnostics d;
        auto c = pointcloud::loadCloud((dir / name).string(), d);
        EXPECT_TRUE(c) << pointcloud::test::said(d);
        return c ? std::move(*c) : pointcloud::PointCloud{};
    }
    /// Runs without errors and warnings.
    void quiet(const std::string& arguments) {
        const std::string said = run(arguments, "2>&1");
        EXPECT_EQ(said.find("error: "), std::string::npos) << said;
        EXPECT_EQ(said.find("warning: "), std::string::npos) << said;
        EXPECT_EQ(status, 0) << arguments << said;
    }
    std::vector<float> pixels(const std::string& name) const {
        Diagnostics d;
        const auto image = display::readImage((dir / name).string(), d);
        return image ? image->data : std::vector<float>{};
    }
    /// The largest difference of two pictures of 48 x 48 pixels, `margin` pixels from their borders.
    double worst(const std::string& a, const std::string& b, int margin = 0) const {
        const auto x = pixels(a), y = pixels(b);
        EXPECT_EQ(x.size(), y.size());
        EXPECT_FALSE(x.empty());
        double most = 0;
        const auto inside = [&](size_t i) {
            const int px = int(i / 4 % 48), py = int(i / 4 / 48);
            return std::min(px, py) >= margin && std::max(px, py) < 48 - margin;
        };
        for (size_t i = 0; i < std::min(x.size(), y.size()); ++i)
            if (inside(i)) most = std::max(most, std::fabs(double(x[i]) - double(y[i])));
        return most;
    }
};

// A call behind a condition that is false for the whole primitive: no more than a few points are shaded for it, and none is
// written. Where it is true all are, and so is what only some points reach.
TEST_F(Bake, BehindConditions) {
    const auto points = [&](const std::string& parameters, const std::string& before, const std::string& condition) {
        write("baker.sl", "surface baker(" + parameters + ") { " + before + " Oi = 1; Ci = Cs; if (" + condition +
                              ") bake3d(\"b.ptc\", \"\", P, N, \"interpolate\", 1); }\n");
        write("a.rib", header("a.exr") + "Option \"user\" \"string pass\" \"beauty\" \"float kind\" 2\n" + begin +
                           "Attribute \"user\" \"string pass\" \"beauty\" \"float kind\" 2\n" + ball);
        std::filesystem::remove(dir / "b.ptc");
        quiet("render -t 1 --stats a.json a.rib"); // threads share no micropolygons
        const std::string stats = bytes("a.json");
        return std::atoi(stats.c_str() + stats.find("\"points\":") + 9);
    };
    const int none = points("", "", "0");
    const std::tuple<const char*, const char*, const char*> never[] = {
        {"float bake = .3;", "", "bake > .5"},
        {"float bakes[2] = {.3, .4};", "", "bakes[1] > .5"},
        {"float a = 3; float b = 4;", "uniform float c = sqrt(a * a + b * b);", "c > 6"},
        {"", "uniform float k = 0; attribute(\"user:kind\", k);", "k == 1"},
        {"", "uniform string s = \"\"; option(\"user:pass\", s); uniform float bake = 0; if (s == \"point\") bake = 1;",
         "bake == 1"},
        {"", "uniform string s = \"\"; rayinfo(\"type\", s);", "s == \"diffuse\""}};
    for (const auto& [parameters, before, condition] : never) {
        EXPECT_LE(points(parameters, before, condition), none + 40) << condition;
        EXPECT_FALSE(std::filesystem::exists(dir / "b.ptc")) << condition;
    }
    EXPECT_GT(points("", "", "1"), 2 * none);
    const std::string all = bytes("b.ptc");
    EXPECT_FALSE(all.empty());
    points("float bake = .7;", "", "bake > .5");
    EXPECT_EQ(bytes("b.ptc"), all);
    EXPECT_GT(points("", "", "v > .9"), 2 * none); // where the few points may not be
    EXPECT_LT(bytes("b.ptc").size(), all.size() / 2);
    EXPECT_GT(cloud("b.ptc").size(), 10u);
}

// All of the ball, its far side too: places, normals, values and the area of the surface.
TEST_F(Bake, WholeSpheres) {
    writeShader("baker", "point p = transform(\"world\", P); normal n = normalize(N); float ok = bake3d(\"ball.ptc\", \"\", P, "
                         "n, \"_x\", xcomp(p), \"_p\", P); Ci = ok;");
    for (const char* hider : {"hidden", "raytrace", "path"}) {
        write("a.rib", header("a.exr", hider) + begin + ball);
        quiet("render a.rib -t 2");
        const pointcloud::PointCloud c = cloud("ball.ptc");
        ASSERT_GT(c.size(), 500u);
        double area = 0, far = 0;
        float lo = 0, hi = 0;
        for (size_t i = 0; i < c.size(); ++i) {
            const double l = length(Vec3d(c.P[i]));
            EXPECT_NEAR(l, 1, 1e-5);
            EXPECT_NEAR(std::fabs(dot(c.P[i], c.N[i])), 1, 1e-4);
            EXPECT_NEAR(c.valuesOf(i)[0], c.P[i].x, 1e-6);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(c.valuesOf(i)[1 + size_t(k)], c.P[i][k], 1e-6) << "points are written in the space of the file";
            area += double(c.valuesOf(i)[size_t(c.offsetOf("_area"))]);
            far = std::max(far, double(c.P[i].z));
            lo = std::min(lo, c.P[i].y), hi = std::max(hi, c.P[i].y);
        }
        // A cell of side h is flat: about h^2 / 12 of the area is missing, with h below 2 pi / 40 here.
        EXPECT_NEAR(area, 4 * kPi, 4 * kPi * .0025) << hider;
        EXPECT_NEAR(far, 1, .01);
        EXPECT_NEAR(lo, -1, .01);
        EXPECT_NEAR(hi, 1, .01);
        for (const float v : pixels("a.exr")) EXPECT_GE(v, 0);
        EXPECT_EQ(pixels("a.exr")[(24 * 48 + 24) * 4], 1) << "bake3d() gives 1";
        std::filesystem::rename(dir / "ball.ptc", dir / (std::string(hider) + ".ptc"));
    }
    EXPECT_EQ(bytes("hidden.ptc"), bytes("raytrace.ptc"));
    pointcloud::test::expectSame(cloud("hidden.ptc"), cloud("path.ptc"));
}

// What shaders of PRMan give as "_area" adds up to the area of the surface, however small it looks from the eye: floors that are
// seen at a flat angle, the far side of a ball, at each ShadingRate.
TEST_F(Bake, AreasThatShadersGive) {
    const struct {
        std::string shape;
        double area;
    } shapes[] = {{"Sphere 1 -1 1 360\n", 4 * kPi},
                  {"Polygon \"P\" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1]\n", 4},
                  {"Scale 2 1 3 Patch \"bilinear\" \"P\" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]\n", 24},
                  {"Rotate 80 1 0 0 Cylinder .5 -1 1 360\n", 2 * kPi}};
    for (const char* interpolate : {"0", "1"}) {
        writeShader("baker", std::string("bake3d(\"b.ptc\", \"\", P, normalize(N), \"interpolate\", ") + interpolate +
                                 ", \"_area\", area(P, \"dicing\"));");
        for (const char* rate : {"1", "9"})
            for (const auto& s : shapes) {
                write("a.rib",
                      header("a.exr") + begin + "ShadingRate " + rate + "\nSurface \"baker\"\n" + s.shape + "WorldEnd\n");
                quiet("render a.rib -t 2");
                const pointcloud::PointCloud c = cloud("b.ptc");
                double area = 0;
                for (size_t i = 0; i < c.size(); ++i) area += double(c.valuesOf(i)[size_t(c.offsetOf("_area"))]);
                EXPECT_NEAR(area, s.area, .03 * s.area) << s.shape << rate << interpolate; // the cells of round shapes are flat
            }
    }
}

TEST_F(Bake, CornersAndMiddlesOfPolygons) {
    writeShader("baker", "bake3d(\"c.ptc\", \"\", P, N, \"coordsystem\", \"object\"); bake3d(\"m.ptc\", \"\", P, N, "
                         "\"interpolate\", 1, \"radius\", .25, \"radiusscale\", 2);");
    write("a.rib", header("a.exr") + begin +
                       "Translate 0 0 1 Surface \"baker\" PointsPolygons [4 4] [0 1 2 3 2 1 4 5] \"P\" [-1 -1 0 1 -1 0 1 1 0 -1 "
                       "1 0 2 -1 0 2 1 0] WorldEnd\n");
    run("render a.rib", "2>&1");
    const pointcloud::PointCloud corners = cloud("c.ptc"), middles = cloud("m.ptc");
    double area[2] = {0, 0};
    for (size_t i = 0; i < corners.size(); ++i) {
        area[0] += double(corners.valuesOf(i)[0]);
        EXPECT_EQ(corners.P[i].z, 0) << "object space";
        for (size_t k = 0; k < i; ++k) EXPECT_GT(length(corners.P[i] - corners.P[k]), 1e-4) << "each once";
    }
    for (size_t i = 0; i < middles.size(); ++i) {
        area[1] += double(middles.valuesOf(i)[0]);
        EXPECT_EQ(middles.radius[i], .5f);
        EXPECT_NEAR(middles.P[i].z, 1, 1e-6);
    }
    EXPECT_GT(middles.size(), corners.size());
    EXPECT_NEAR(area[0], area[1], 1e-4) << "the same surface";
}

TEST_F(Bake, SameBitsForAllThreads) {
    writeShader(
        "baker",
        "float o = occlusion(P, N, 16); bake3d(\"o.ptc\", \"\", P, N, \"_o\", o); bake(\"o.bake\", s, t, color(o, s, t));");
    writeShader("hairs", "bake3d(\"o.ptc\", \"\", P, 0, \"_v\", v);");
    const std::string scene = "Surface \"hairs\" Curves \"linear\" [4 4] \"nonperiodic\" \"P\" [-1 -1 -1.5 -1 0 -1.5 -1 .5 -1.5 "
                              "-1 1 -1.5 1 -1 -1.5 1 0 -1.5 1 .5 -1.5 1 1 -1.5] \"constantwidth\" [.2]\n"
                              "Surface \"baker\" Polygon \"P\" [-2 -2 2 2 -2 2 2 2 2 -2 2 2]\n" +
                              ball;
    for (const char* hider : {"hidden", "path"}) {
        std::string first[2];
        for (const char* threads : {"1", "2", "8"}) {
            write("a.rib", header("a.exr", hider) + begin + scene);
            run(std::string("render a.rib -t ") + threads, "2>&1");
            EXPECT_EQ(status, 0);
            const std::string now[2] = {bytes("o.ptc"), bytes("o.bake")};
            ASSERT_GT(now[0].size(), 10000u);
            for (int k = 0; k < 2; ++k) {
                if (first[k].empty()) first[k] = now[k];
                EXPECT_TRUE(now[k] == first[k]) << hider << " " << threads;
            }
        }
        const pointcloud::PointCloud c = cloud("o.ptc");
        const int v = c.offsetOf("_v");
        size_t hairs = 0;
        for (size_t i = 0; i < c.size(); ++i) hairs += length(c.N[i]) == 0 && c.valuesOf(i)[size_t(v)] > 0;
        EXPECT_GT(hairs, 20u) << "where camera rays meet them";
    }
}

// A frame bakes, MakeTexture makes a texture of it, and the next frame looks that up: all in one stream.
TEST_F(Bake, TexturesInOneStream) {
    const std::string f = "color(s * s, .5 + .5 * sin(6 * t), s * t)";
    const std::string wall = "Patch \"bilinear\" \"P\" [-1 1 0 1 1 0 -1 -1 0 1 -1 0]\nWorldEnd\n";
    for (const char* suffix : {"", "&binary"}) {
        writeShader("baker", "bake(\"f.bake" + std::string(suffix) + "\", s, t, " + f + ");");
        writeShader("direct", "Ci = " + f + ";");
        writeShader("looked", "Ci = color texture(\"f.tex\", s, t, s, t, s, t, s, t);"); // no filter
        const std::string dice = "ShadingRate .25\nSurface ";
        write("a.rib", "FrameBegin 1\n" + header("a.exr") + begin + dice + "\"baker\"\n" + wall +
                           "FrameEnd\nMakeTexture \"f.bake" + suffix +
                           "\" \"f.tex\" \"clamp\" \"clamp\" \"box\" 1 1\nFrameBegin 2\n" + header("b.exr") + begin +
                           "Surface \"looked\"\n" + wall + "FrameEnd\nFrameBegin 3\n" + header("c.exr") + begin +
                           "Surface \"direct\"\n" + wall + "FrameEnd\n");
        quiet("render a.rib");
        // 64 pixels on a side, h = 1/64, and a second derivative of 18: between pixels 18 h^2 / 8, by the fit over two pixels
        // less than 18 h^2 / 2, half floats 2^-11. Beyond the outer pixels' middles, half a pixel at a slope of 3, the texture is
        // clamped.
        EXPECT_LT(worst("b.exr", "c.exr", 14), .0035) << suffix;
        EXPECT_LT(worst("b.exr", "c.exr"), .03) << suffix;
    }
    writeShader("baker", "bake(\"g.bake\", s, t, s);");
    write("a.rib", header("a.exr") + begin + "Surface \"baker\"\n" + wall);
    quiet("render a.rib");
    EXPECT_EQ(bytes("g.bake").substr(0, 15), "# bake 1 float\n");
    quiet("maketx g.bake g.tex");
    const auto g = pixels("g.tex");
    const int side = int(std::sqrt(double(g.size())));
    for (int x = 0; x < side; ++x) EXPECT_NEAR(g[size_t(x)], (x + .5) / side, 1e-3) << "half floats";
}

TEST_F(Bake, CloudsAndBricksReadBack) {
    const std::string f = "color(.5 + .5 * sin(4 * xcomp(p)), .5 + .5 * ycomp(p), .5 * zcomp(p) * zcomp(p))";
    const std::string at = "point p = transform(\"world\", P); ";
    writeShader("baker", at + "bake3d(\"f.ptc\", \"\", P, normalize(N), \"_f\", " + f + ");");
    writeShader("direct", at + "Ci = " + f + ";");
    for (const char* name : {"ptc", "bkm"})
        writeShader(std::string("read") + name,
                    at + "color c = 0; float ok = texture3d(\"f." + name + "\", P, normalize(N), \"_f\", c); Ci = ok * c;");
    const auto frame = [&](const std::string& number, const std::string& picture, const std::string& shader) {
        return "FrameBegin " + number + "\n" + header(picture) + begin + "ShadingRate .5\nSurface \"" + shader +
               "\"\nRotate 90 1 0 0\nSphere 1 -1 1 360\nWorldEnd\nFrameEnd\n";
    };
    write("a.rib", frame("1", "a.exr", "baker") + "MakeBrickMap [\"f.ptc\"] \"f.bkm\"\n" + frame("2", "b.exr", "readptc") +
                       frame("3", "c.exr", "readbkm") + frame("4", "d.exr", "direct"));
    quiet("render a.rib");
    // Means within h = R + 2 r, about .06 + .05, of a second derivative of 8: 8 h^2 / 16, and as much for what pixels are
    // filtered. At the silhouette filters are wider, up to 20 pixels long by setFootprint(); the poles lie there, too.
    for (const char* picture : {"b.exr", "c.exr"}) {
        EXPECT_LT(worst(picture, "d.exr", 14), .01) << picture;
        EXPECT_LT(worst(picture, "d.exr"), .03) << picture;
    }
}

// Channels that a shader gives by several calls are those of the same points; where only some points have a channel, that is
// said.
TEST_F(Bake, SeveralCallsForOneFile) {
    writeShader("baker",
                "bake3d(\"f.ptc\", \"\", P, N, \"_x\", 3); bake3d(\"f.ptc\", \"\", P, N, \"_c\", color(1, .5, 0)); "
                "bake3d(\"g.ptc\", \"\", P, N, \"_x\", 3);"
                "bake3d(\"h.ptc\", \"\", P, N, \"_x\", 1, \"_name\", \"a\"); bake3d(\"h.ptc\", \"\", P + N, N, \"_y\", 1);");
    for (const char* hider : {"hidden", "path"}) {
        write("a.rib", header("a.exr", hider) + begin + ball);
        const std::string said = run("render a.rib", "2>&1");
        const pointcloud::PointCloud f = cloud("f.ptc"), h = cloud("h.ptc");
        EXPECT_EQ(f.size(), cloud("g.ptc").size()) << hider;
        ASSERT_GT(f.size(), 0u);
        const int x = f.offsetOf("_x"), c = f.offsetOf("_c");
        for (size_t i = 0; i < f.size(); ++i) {
            EXPECT_EQ(f.valuesOf(i)[size_t(x)], 3);
            EXPECT_EQ(f.valuesOf(i)[size_t(c) + 1], .5f);
        }
        EXPECT_EQ(h.size(), 2 * f.size()) << hider;
        EXPECT_NE(said.find("points of \"h.ptc\" have no channel \"_y\""), std::string::npos) << said;
        EXPECT_EQ(said.find("points of \"f.ptc\" have no"), std::string::npos) << said;
        EXPECT_NE(said.find("\"_name\" is a string; it is not written"), std::string::npos) << said;
    }
}

TEST_F(Bake, WhatCannotBe) {
    writeShader("baker", "float ok = bake3d(\"../../out.ptc\", \"\", P, N); float x = 5; float r = texture3d(\"none.ptc\", P, N, "
                         "\"_x\", x); Ci = color(ok, r, x / 10);");
    write("a.rib", header("a.exr") + begin + ball);
    const std::string said = run("render a.rib", "2>&1");
    EXPECT_NE(said.find("no point cloud or brick map \"none.ptc\""), std::string::npos) << said;
    EXPECT_NE(said.find("../../out.ptc"), std::string::npos) << said;
    EXPECT_FALSE(std::filesystem::exists(dir.parent_path().parent_path() / "out.ptc"));
    EXPECT_NE(status, 0);
    const float* p = nullptr;
    const auto image = pixels("a.exr");
    p = &image[(24 * 48 + 24) * 4];
    EXPECT_EQ(p[1], 0);
    EXPECT_NEAR(p[2], .5f, 1e-3) << "x stays as it was";
}

// A call without the name of a file does nothing: no primitive is shaded whole for it.
TEST_F(Bake, WithoutANameNothingIsShadedWhole) {
    const auto points = [&](const std::string& call) {
        write("baker.sl", "surface baker(uniform string cloud = \"\";) { uniform string type = \"\"; attribute(\"user:type\", "
                          "type); Ci = Cs; Oi = 1; if (type == \"point\") " +
                              call + "; }\n");
        write("a.rib", header("a.exr") + begin + "Attribute \"user\" \"string type\" \"point\"\n" + ball);
        quiet("render -t 1 a.rib --stats s.json"); // threads share no micropolygons
        const std::string stats = bytes("s.json");
        return std::atoi(stats.c_str() + stats.find("\"points\":") + 9);
    };
    const int without = points("Ci = Cs"), never = points("bake3d(cloud, \"\", P, N)");
    EXPECT_GT(without, 100);
    EXPECT_EQ(never, without);
    EXPECT_GT(points("bake3d(\"there.ptc\", \"\", P, N)"), without);
}

TEST_F(Bake, ThePtcCommand) {
    writeShader("baker", "bake3d(\"f.ptc\", \"\", P, N, \"_c\", color(1, .5, 0), \"_s\", s);");
    write("a.rib", header("a.exr") + begin + ball);
    quiet("render a.rib");
    const size_t points = cloud("f.ptc").size();
    const std::string info = run("ptc info f.ptc", "2>&1");
    EXPECT_NE(info.find("points " + std::to_string(points) + "\n"), std::string::npos) << info;
    EXPECT_NE(info.find("channel color _c, mean 1 0.5 0\n"), std::string::npos) << info;
    quiet("ptc merge f.ptc f.ptc two.ptc");
    EXPECT_EQ(cloud("two.ptc").size(), 2 * points);
    quiet("ptc toply f.ptc f.ply");
    quiet("ptc fromply f.ply g.ptc");
    pointcloud::test::expectSame(cloud("f.ptc"), cloud("g.ptc"));
    quiet("ptc filter --channels _c --box 0,-2,-2,2,2,2 f.ptc half.ptc");
    EXPECT_NEAR(double(cloud("half.ptc").size()), double(points) / 2, double(points) / 20);
    EXPECT_EQ(cloud("half.ptc").channels.size(), 1u);
    quiet("ptc filter --depth 3 --smooth .5 f.ptc few.ptc");
    EXPECT_LT(cloud("few.ptc").size(), 513u);
    quiet("ptc brick f.ptc f.bkm");
    EXPECT_NE(run("ptc info f.bkm", "2>&1").find("channel color _c"), std::string::npos);
    quiet("ptc picture --channel _c --size 64 f.ptc f.exr");
    const auto p = pixels("f.exr");
    EXPECT_EQ(p[(32 * 64 + 32) * 4], 1);
    EXPECT_EQ(p[(32 * 64 + 32) * 4 + 1], .5f);
    EXPECT_EQ(p[3], 0) << "corners are empty";
    EXPECT_NE(run("ptc info none.ptc", "2>&1").find("none.ptc"), std::string::npos);
    EXPECT_EQ(status, 3);
    run("ptc brick f.ptc", "2>&1");
    EXPECT_EQ(status, 2);
}

// Samples that are averaged take the room of one point afterwards, and what is forgotten takes none: the limit is for what is
// written.
TEST(BakeLogs, KeepNoCountOfWhatIsGone) {
    pointcloud::BakeLog log;
    pointcloud::BakeLayout layout;
    layout.channels = {{"_x", pointcloud::ChannelType::Float}};
    layout.width = 1;
    layout.where = "here";
    const auto sample = [&](int point, uint32_t s) {
        pointcloud::BakeKey key;
        key.x = point;
        key.sample = s;
        const float numbers[] = {float(point), 0, 0, 0, 0, 1, .1f, float(s)};
        EXPECT_TRUE(log.add("a.ptc", layout, key, numbers));
    };
    for (uint32_t s = 0; s < 100; ++s) sample(0, s);
    log.commit();
    const size_t one = log.bytes();
    EXPECT_LT(one, 100u);
    for (uint32_t s = 0; s < 100; ++s) sample(1, s);
    log.discard();
    EXPECT_EQ(log.bytes(), one);
    for (uint32_t s = 0; s < 100; ++s) sample(1, s);
    log.commit();
    EXPECT_EQ(log.bytes(), 2 * one);
}

// A loop that bakes at one point: what it bakes twice is kept once, in time that does not grow with the square of its turns
// (which was minutes here).
TEST(BakeLogs, LoopsThatBake) {
    constexpr int kTurns = 200'000;
    pointcloud::BakeLog log;
    pointcloud::BakeLayout layout;
    layout.channels = {{"_x", pointcloud::ChannelType::Float}};
    layout.width = 1;
    layout.where = "here";
    const auto turn = [&](float x) {
        const float numbers[] = {0, 0, 0, 0, 0, 1, .1f, x};
        EXPECT_TRUE(log.add("a.ptc", layout, {}, numbers));
    };
    turn(0);
    log.commit();
    const size_t one = log.bytes();
    for (int i = 0; i < kTurns; ++i) turn(float(i % (kTurns / 2)));
    log.commit();
    EXPECT_EQ(log.bytes(), one + one * kTurns / 2);
    // Nor does what others bake behind it take as long as the loop, each.
    for (int i = 0; i < kTurns; ++i) turn(float(i));
    pointcloud::BakeKey other;
    for (int i = 0; i < kTurns; ++i) {
        const float numbers[] = {0, 0, 0, 0, 0, 1, .1f, 0};
        other.vertex = uint32_t(i + 1);
        log.add("a.ptc", layout, other, numbers);
    }
    log.commit();
    EXPECT_EQ(log.bytes(), one + one * kTurns / 2 + 2 * one * kTurns);
}

// Outputs of one frame that would be one file: one is written, the others are errors that name both.
TEST_F(Bake, TwoOutputsOfOneName) {
    write("b.sl", "surface b(string to = \"\"; string flat = \"\") {\n"
                  "  normal n = normalize(N);\n"
                  "  if (to != \"\") bake3d(to, \"\", P, n, \"interpolate\", 1, \"light\", color 1);\n"
                  "  if (flat != \"\") bake(flat, s, t, color 1);\n  Ci = 1; Oi = 1;\n}\n");
    const auto scene = [&](const std::string& names) {
        write("two.rib", "Format 8 8 1\nDisplay \"x.png\" \"png\" \"rgb\"\nWorldBegin\nSurface \"b\" " + names +
                             "\nTranslate 0 0 3\nSphere 1 -1 1 360\nWorldEnd\n");
        return run("render -q two.rib", "2>&1");
    };
    std::string said = scene("\"to\" \"x.png\"");
    EXPECT_EQ(status, 5) << said;
    EXPECT_NE(said.find("\"x.png\" is not written: the Display of two.rib:2 writes that file"), said.npos) << said;
    std::ifstream picture(dir / "x.png");
    EXPECT_EQ(picture.get(), 0x89); // of PNG
    said = scene("\"to\" \"a.ptc\" \"flat\" \"./a.ptc\"");
    EXPECT_EQ(status, 5) << said;
    EXPECT_NE(said.find("bake3d(): \"a.ptc\" is not written: bake() of \"./a.ptc\" writes that file"), said.npos) << said;
    said = scene("\"to\" \"a.ptc\" \"flat\" \"a.ptc\"");
    EXPECT_EQ(status, 1) << said;
    EXPECT_NE(said.find("\"a.ptc\" has points of"), said.npos) << said;
    said = scene("\"to\" \"a.ptc\" \"flat\" \"a.txt\"");
    EXPECT_EQ(status, 0) << said;
}

// What is made of a file does not take its place.
TEST_F(Bake, NothingReplacesWhatItIsMadeOf) {
    pointcloud::PointCloud cloud;
    cloud.add({0, 0, 0}, {0, 0, 1}, 1, {});
    Diagnostics d;
    ASSERT_TRUE(pointcloud::saveCloud((dir / "a.ptc").string(), cloud, {".", true}, d));
    std::filesystem::create_symlink("a.ptc", dir / "link.ptc");
    for (const char* what : {"brick a.ptc a.ptc", "brick a.ptc ./a.ptc", "brick link.ptc a.ptc", "merge a.ptc link.ptc a.ptc",
                             "toply a.ptc a.ptc"}) {
        const std::string said = run("ptc " + std::string(what), "2>&1");
        EXPECT_EQ(status, 2) << what << said;
        EXPECT_NE(said.find("would replace the file that it is made of"), said.npos) << said;
    }
    EXPECT_NE(run("ptc info a.ptc", "2>&1").find("kind point cloud"), std::string::npos);
    run("ptc brick link.ptc b.bkm", "2>&1");
    EXPECT_EQ(status, 0);
    // The same for requests.
    write("make.rib", "Format 8 8 1\nDisplay \"z.z\" \"zfile\" \"z\"\nWorldBegin\nTranslate 0 0 3\nSphere 1 -1 1 360\n"
                      "WorldEnd\nMakeShadow \"z.z\" \"z.z\"\nMakeTexture \"z.z\" \"./z.z\" \"black\" \"black\" \"box\" 1 1\n"
                      "MakeBrickMap [\"a.ptc\"] \"a.ptc\"\n");
    const std::string said = run("render -q make.rib", "2>&1");
    EXPECT_EQ(status, 1) << said;
    size_t refused = 0;
    for (size_t at = 0; (at = said.find("it would replace the", at)) != said.npos; ++at) ++refused;
    EXPECT_EQ(refused, 3u) << said;
    EXPECT_NE(run("ptc info a.ptc", "2>&1").find("kind point cloud"), std::string::npos);
    // A file that is no point cloud could not be read, which is another status than one that could not be written.
    run("ptc brick make.rib c.bkm", "2>&1");
    EXPECT_EQ(status, 3);
    const std::string full = run("ptc brick a.ptc /dev/full", "2>&1");
    EXPECT_EQ(status, 5) << full;
}

} // namespace

} // namespace bake_test
