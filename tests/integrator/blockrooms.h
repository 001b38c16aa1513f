// Rooms of one shader that are traced in blocks and point by point.
#pragma once
#include "integrator/harness.h"
#include "nightly.h"
#include <cmath>

namespace alpenglow::integrator::testing {

struct Traced {
    std::vector<SampleResult> samples;
    uint64_t inRows, points, cut;
};
inline Settings pathSettings() {
    Settings s;
    s.hider = Hider::Path;
    return s;
}
inline Traced trace(Scene& scene) {
    std::vector<CameraRay> rays;
    const int side = nightly() ? 30 : 20;
    for (int i = 0; i < side * side; ++i) {
        CameraRay r = rayTo({0, 0, 0}, {float(i % side) / float(side) - .48f, float(i / side) / float(side) - .48f, 1});
        r.px = i % side, r.py = i / side, r.sample = uint32_t(i % 5), r.spread = .001f;
        rays.push_back(r);
    }
    Traced t;
    t.samples.resize(rays.size());
    Integrator integrator(scene.world, scene.diagnostics);
    integrator.trace(rays, t.samples, nullptr);
    t.inRows = integrator.counters().inRows;
    t.points = integrator.counters().points;
    t.cut = integrator.counters().depthCap;
    return t;
}
inline Traced trace(const std::string& rib, bool blocks, int lanes = 16, int maxDepth = -1, Settings s = pathSettings()) {
    s.maxDepth = maxDepth;
    s.rowRequests = blocks;
    s.lanes = lanes;
    Scene scene(rib, s);
    return trace(scene);
}

inline const char* const kLights =
    "LightSource \"pointlight\" 1 \"intensity\" 9 \"from\" [1 2 3] \"float radius\" .3\n"
    "LightSource \"distantlight\" 2 \"intensity\" .4 \"from\" [1 1 -1] \"to\" [0 0 0]\n"
    "LightSource \"ambientlight\" 3 \"intensity\" .2\n"
    "AttributeBegin\nAreaLightSource \"slrect\" 4 \"float intensity\" 5\nSurface \"constant\"\nColor 0 0 0\n"
    "Polygon \"P\" [-1 2.5 4  1 2.5 4  1 2.5 6  -1 2.5 6]\nAttributeEnd\n"
    "AttributeBegin\nAreaLightSource \"arealight\" 5 \"float intensity\" 2\nSurface \"constant\"\nTranslate -2 1 4\n"
    "Sphere .3 -.3 .3 360\nAttributeEnd\n"
    "AttributeBegin\nAreaLightSource \"slrect\" 6 \"float intensity\" 3\nSurface \"constant\"\nColor 0 0 0\n"
    "Polygon \"P\" [1.5 -1 4  1.5 0 4  1.5 0 4.5  1.5 -1 4.5]\nAttribute \"visibility\" \"int diffuse\" 0\n"
    "Polygon \"P\" [-1.5 0 3  -1.5 .7 3.2  -1.5 0 3.6]\nAttributeEnd\n"
    "LightSource \"spotlight\" 7 \"intensity\" 9 \"from\" [0 2 3] \"to\" [0 0 5] \"coneangle\" .7\n"
    "Illuminate 4 1\nIlluminate 5 1\nIlluminate 6 1\n";

/// A room of balls of one shader.
inline std::string roomOf(const std::string& shader, const std::string& more = "") {
    std::string s = "WorldBegin\nSides 2\n" + std::string(kLights) + more + "Surface " + shader + "\n";
    for (int i = 0; i < 9; ++i)
        s += "AttributeBegin\nColor [" + std::to_string(.2 + .08 * i) + " .6 .7]\nTranslate " + std::to_string(i % 3 - 1) + " " +
             std::to_string(i / 3 - 1) + " " + std::to_string(4 + .2 * i) + "\nSphere .4 -.4 .4 360\nAttributeEnd\n";
    return s + "Polygon \"P\" [-9 -2 0  -9 -2 20  9 -2 20  9 -2 0]\nPolygon \"P\" [-9 -9 9  -9 9 9  9 9 9  9 -9 9]\nWorldEnd\n";
}

/// Lamps of all kinds, so many that chance chooses among them.
inline std::string manyLights(double brightest) {
    std::string s;
    int handle = 20;
    const auto at = [](int i, float y) {
        return std::to_string(std::sin(float(i)) * 3) + " " + std::to_string(y) + " " +
               std::to_string(4 + 3 * std::cos(float(i)));
    };
    for (int i = 0; i < 12; ++i)
        s += "LightSource \"pointlight\" " + std::to_string(handle++) + " \"intensity\" 1 \"from\" [" + at(i, 2) + "]" +
             (i % 3 == 0 ? " \"float radius\" .2\n" : "\n");
    for (int i = 0; i < 3; ++i)
        s += "LightSource \"distantlight\" " + std::to_string(handle++) + " \"intensity\" .1 \"from\" [" + at(i, 5) +
             "] \"to\" [0 0 0]\n";
    for (int i = 0; i < 12; ++i) {
        s += "AttributeBegin\nAreaLightSource \"slrect\" " + std::to_string(handle) + " \"float intensity\" " +
             std::to_string(i == 5 ? brightest : i + 1.) + (i == 7 ? " \"int __importancesample\" 0" : "") +
             "\nSurface \"constant\"\nColor 0 0 0\nTranslate " + at(5 * i, 1) + "\n";
        if (i % 4 == 0) s += "Sides 1\n";
        if (i % 5 == 4) s += "Attribute \"visibility\" \"int specular\" 0\n";
        s += "Polygon \"P\" [-.2 .3 -.2  .2 .3 -.2  .2 .3 .2  -.2 .3 .2]";
        s += i % 4 == 1 ? " \"constant float intensity\" [2]\n" : "\n";
        if (i % 3 == 0) s += "Polygon \"P\" [0 .5 0  .4 .5 0  0 .5 .9]\n";
        if (i % 6 == 5) s += "Sphere .1 -.1 .1 360\n";
        s += "AttributeEnd\nIlluminate " + std::to_string(handle++) + " 1\n";
    }
    return s + "LightSource \"envlight\" 90 \"float intensity\" .2\nIlluminate 90 1\n";
}

inline size_t differences(const Traced& a, const Traced& b) {
    size_t n = 0;
    for (size_t i = 0; i < a.samples.size(); ++i)
        n += !(a.samples[i].color == b.samples[i].color) || a.samples[i].z != b.samples[i].z ||
             a.samples[i].parts != b.samples[i].parts || !(a.samples[i].albedo == b.samples[i].albedo) ||
             !(a.samples[i].normal == b.samples[i].normal) || a.samples[i].aovs != b.samples[i].aovs;
    return n;
}
inline void writeFacets() {
    writeShader("facets", R"(surface facets() {
    normal n = faceforward(normalize(N), I);
    Ci = .4 * diffuse(n)
         + .5 * trace(P, vector n, "distribution", "ggx", "wo", -I, "roughness", .3, "eta", color(.2, .9, 1.1), "k", 3)
         + .2 * trace(P, vector n, "distribution", "oren-nayar", "roughness", .5, "samplearealights", 1);
    Oi = Os;
})");
}
inline void writeGlossy() {
    writeShader("glossy", R"(surface glossy() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * (.9 * diffuse(n) + .8 * specular(n, -normalize(I), .2) + .2 * phong(n, -normalize(I), 9));
    if (xcomp(P) > 0) Ci += .3 * trace(P, reflect(normalize(I), n), "samplecone", .1, "samples", 3);
})");
}
inline double sumOf(const Traced& t) {
    double sum = 0;
    for (const SampleResult& s : t.samples) sum += s.color.x + s.color.y + s.color.z;
    return sum;
}
/// Lanes of kernels for requests in rows, and for those that are read one by one: 16 and 4, or 4 and 16. They take turns by room,
/// so that one comparison tests both; nightly a third trace tests each alone.
struct Widths {
    explicit Widths(const std::string& rib) : rows(rib.size() % 2 ? 4 : 16), single(rib.size() % 2 ? 16 : 4) {}
    int rows, single;
};
/// Traces a room with requests in rows and one by one, at both ends of the widths of kernels: the samples have the same bits, and
/// paths are cut at the same places. least: of all points those whose requests must be in rows. Returns the one in rows.
inline Traced expectSameBits(const std::string& rib, const Settings& s, double least, const std::string& what, int depth = -1) {
    const Widths lanes(rib);
    const Traced one = trace(rib, false, lanes.single, depth, s), all = trace(rib, true, lanes.rows, depth, s);
    EXPECT_GT(sumOf(one), 1) << what;
    EXPECT_EQ(one.inRows, 0u) << what;
    EXPECT_GT(double(all.inRows), double(all.points) * least) << what;
    EXPECT_EQ(one.cut, all.cut) << what;
    const size_t found = differences(one, all);
    EXPECT_EQ(found, 0u) << what << ", depth " << depth;
    if (found > 0 || nightly())
        EXPECT_EQ(differences(one, trace(rib, false, lanes.rows, depth, s)), 0u) << what << ", kernels of 4 and 16 lanes alone";
    return all;
}

} // namespace alpenglow::integrator::testing
