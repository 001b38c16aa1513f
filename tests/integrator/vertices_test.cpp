// What a vertex sends: shadow rays, and batches that wait for hits of other slices.
#include "integrator/harness.h"
#include <cstring>

namespace alpenglow::integrator::testing::vertices_test {
namespace {

Settings path() {
    Settings s;
    s.hider = Hider::Path;
    return s;
}

const std::string kFloor = "Patch \"bilinear\" \"P\" [-9 -1 0  9 -1 0  -9 -1 20  9 -1 20]\n";
const CameraRay kDown = rayTo(Vec3(0, 0, 0), Vec3(0.2f, -1, 4));

std::vector<CameraRay> fan(int n) {
    std::vector<CameraRay> rays;
    for (int i = 0; i < n; ++i) {
        CameraRay r = rayTo(Vec3(0, 0, 0), Vec3(float(i % 37) / 6 - 3, -1, 3 + float(i % 11)));
        r.px = i;
        rays.push_back(r);
    }
    return rays;
}

int differ(const std::vector<SampleResult>& a, const std::vector<SampleResult>& b) {
    int n = 0;
    for (size_t i = 0; i < a.size(); ++i) n += std::memcmp(&a[i].color, &b[i].color, sizeof(Color)) != 0;
    return n;
}

// diffuse() and specular() of a vertex get their light of a lamp along one ray: before, each traced a shadow of its own.
TEST(Vertices, LobesShareAShadowRay) {
    Settings set = path();
    set.maxDepth = 0;
    for (const char* surface : {"matte", "plastic"}) {
        Scene s("WorldBegin\nLightSource \"pointlight\" 1 \"from\" [0 3 4]\nSurface \"" + std::string(surface) + "\"\n" + kFloor +
                    "WorldEnd\n",
                set);
        Counters counters;
        EXPECT_GT(s.estimate(kDown, 100, &counters).mean(), 0) << surface;
        EXPECT_EQ(counters.shadow, 100u) << surface;
    }
}

// A transparent shape changes nothing for rays that pass beside it, and takes its share where they do not.
TEST(Vertices, TransparentShapes) {
    const auto scene = [](const std::string& more) {
        return "WorldBegin\nLightSource \"pointlight\" 1 \"from\" [0 3 4]\nSurface \"matte\"\n" + kFloor +
               "AttributeBegin\nTranslate 1 0 5\nSphere .3 -.3 .3 360\nAttributeEnd\n" + more + "WorldEnd\n";
    };
    const auto rays = fan(600);
    Scene plain(scene(""), path());
    const auto without = plain.trace(rays);
    Scene beside(scene("AttributeBegin\nOpacity [.5 .5 .5]\nTranslate 0 900 0\nSphere 1 -1 1 360\nAttributeEnd\n"), path());
    EXPECT_EQ(differ(without, beside.trace(rays)), 0);
    // A pane over everything between the lamp and the floor: direct light of a first hit is halved, exactly.
    Settings set = path();
    set.maxDepth = 0;
    const std::string pane = "AttributeBegin\nOpacity [.5 .5 .5]\nPatch \"bilinear\" \"P\" [-9 2 -9  9 2 -9  -9 2 20  9 2 20]\n"
                             "AttributeEnd\n";
    Scene open(scene(""), set), behind(scene(pane), set);
    const auto full = open.trace(rays), half = behind.trace(rays);
    int lit = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        EXPECT_NEAR(half[i].color.x, full[i].color.x / 2, 1e-6f * full[i].color.x) << i;
        lit += full[i].color.x > 0;
    }
    EXPECT_GT(lit, 400);
}

// Hits of rare shaders wait for others of their kind; who waits with whom changes no bit.
TEST(Vertices, RareShaders) {
    std::string rib = "WorldBegin\nLightSource \"pointlight\" 1 \"from\" [0 3 4]\nSurface \"plastic\"\n" + kFloor;
    for (int i = 0; i < 24; ++i) {
        const std::string name = "rare" + std::to_string(i);
        writeShader(name,
                    "surface " + name + "() { Oi = Os; Ci = Cs * (" + std::to_string(0.02 * (i + 1)) +
                        " * diffuse(faceforward(normalize(N), I)) + .1 * trace(P, reflect(normalize(I), normalize(N)))); }");
        rib += "AttributeBegin\nSurface \"" + name + "\"\nTranslate " + std::to_string(i % 6 - 2.5) + " " +
               std::to_string(i / 6 * .5 - .7) + " " + std::to_string(4 + i / 6) + "\nSphere .3 -.3 .3 360\nAttributeEnd\n";
    }
    const auto rays = fan(3000);
    Scene s(rib + "WorldEnd\n", path());
    const auto together = s.trace(rays);
    std::vector<SampleResult> parts;
    for (size_t first = 0; first < rays.size(); first += 70)
        for (const SampleResult& r : s.trace(std::span(rays).subspan(first, std::min<size_t>(70, rays.size() - first))))
            parts.push_back(r);
    EXPECT_EQ(differ(together, parts), 0);
}

} // namespace
} // namespace alpenglow::integrator::testing::vertices_test
