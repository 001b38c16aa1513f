// Equality to the bit (T10 for transport): how rays are split into calls, threads, lanes, builds S and V change nothing.
#include "transport/box.h"
#include <cstring>
#include <thread>

using namespace alpenglow;
using namespace alpenglow::transport;
using namespace alpenglow::transport::testing;

namespace {

struct Bits {
    std::vector<Color> color, opacity;
    std::vector<float> z;
    bool operator==(const Bits&) const = default;
};
Bits bitsOf(const std::vector<SampleResult>& r) {
    Bits b;
    for (const SampleResult& s : r) {
        b.color.push_back(s.color);
        b.opacity.push_back(s.opacity);
        b.z.push_back(s.z);
    }
    return b;
}
// How many samples differ in any bit: readable when it fails.
size_t differences(const Bits& a, const Bits& b) {
    size_t n = a.color.size() != b.color.size();
    for (size_t i = 0; i < std::min(a.color.size(), b.color.size()); ++i)
        n += std::memcmp(&a.color[i], &b.color[i], sizeof(Color)) != 0 || a.opacity[i] != b.opacity[i] || a.z[i] != b.z[i];
    return n;
}

// All kinds of things at once: lights of every kind, plastic, glass, transparency, textures of noise, a suspending shader.
std::string crowd() {
    writeShader("busy", R"(surface busy(float Kd = .6;) {
    normal Nf = faceforward(normalize(N), I);
    color c = Cs * (.5 + .5 * noise(4 * P));
    color loop = 0;
    color around = 0;
    illuminance(P, Nf, PI / 2, "light:around", around) { loop += Cl * (normalize(L) . Nf) + .1 * around; }
    float r = random();
    Oi = Os;
    Ci = Os * (c * Kd * diffuse(Nf) + .1 * loop + .05 * r + .2 * specular(Nf, -normalize(I), .1));
}
)");
    writeShader("waits", R"(surface waits() {
    normal Nf = faceforward(normalize(N), I);
    color seen = trace(P, reflect(normalize(I), Nf));
    Oi = Os;
    if (comp(seen, 0) > .1)
        Ci = .5 * seen + .3 * trace(P, vector(Nf), "distribution", "cosine", "samplecone", 1, "samplearealights", 1);
    else
        Ci = color(.1, .2, .3) * diffuse(Nf);
}
)");
    // Lights that trace: a soft shadow by several rays, and what is seen around the lit point.
    writeShader("softly", R"(light softly() {
    point at = point "world" (-1, 2, 3);
    illuminate(at) Cl = 2 * transmission(Ps, at, "samplecone", .1, "samples", 3) / (1 + .1 * (L . L));
}
)");
    writeShader("around", R"(light around(output varying color around = 0;) {
    illuminate(point "world" (2, 2, 4)) {
        around = trace(Ps, vector "world" (0, 1, 0), "distribution", "uniform", "samplecone", 1, "samples", 2);
        Cl = .2 + .3 * around;
    }
}
)");
    std::string s = "WorldBegin\nSides 2\nLightSource \"softly\" 6\nLightSource \"around\" 7\n"
                    "LightSource \"pointlight\" 1 \"intensity\" 8 \"from\" [1 3 2]\nLightSource \"spotlight\" 2 \"intensity\" 9 "
                    "\"from\" [-2 3 3] \"to\" [0 0 5]\n"
                    "LightSource \"distantlight\" 3 \"intensity\" .3 \"from\" [1 1 -1] \"to\" [0 0 0]\nLightSource \"envlight\" "
                    "4 \"intensity\" .2\n"
                    "AttributeBegin\nAreaLightSource \"slrect\" 5 \"float intensity\" 3\nSurface \"constant\"\nColor 0 0 0\n"
                    "Polygon \"P\" [-1 3 4  1 3 4  1 3 6  -1 3 6]\nAttributeEnd\nIlluminate 5 1\n";
    const char* shaders[] = {
        "plastic", "busy", "waits", "matte",
        "slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float kn\" 1.5 \"string fresnel\" \"exact"};
    // Something above the lights: what they see is mostly lit by them again.
    s += "AttributeBegin\nSurface \"matte\"\nColor .2 .5 .9\nPolygon \"P\" [-3 3 4  -3 3 6  0 3 6  0 3 4]\nAttributeEnd\n";
    for (int i = 0; i < 15; ++i) {
        s += "AttributeBegin\nSurface \"" + std::string(shaders[i % 5]) + "\"\nColor [" + std::to_string(.3 + .04 * i) +
             " .5 .6]\n";
        if (i % 4 == 1) s += "Opacity .5 .6 .7\n";
        s += "Translate " + std::to_string(-2 + i % 5) + " " + std::to_string(-1 + i / 5) + " " +
             std::to_string(4 + .3 * (i % 3)) + "\nSphere .45 -.45 .45 360\nAttributeEnd\n";
    }
    return s + "Surface \"busy\"\nPolygon \"P\" [-9 -2 0  -9 -2 20  9 -2 20  9 -2 0]\nWorldEnd\n";
}
std::vector<CameraRay> crowdRays(int n) {
    std::vector<CameraRay> rays;
    std::mt19937_64 rng(3);
    std::uniform_real_distribution<float> u(-.55f, .55f);
    for (int i = 0; i < n; ++i) {
        CameraRay r = rayTo({0, 0, 0}, {u(rng), u(rng), 1});
        r.px = i % 50;
        r.py = i / 50;
        r.sample = uint32_t(i % 7);
        r.spread = .001f;
        rays.push_back(r);
    }
    return rays;
}

class BitsTest : public ::testing::TestWithParam<Hider> {
protected:
    Settings settings(int lanes = 16) {
        Settings s;
        s.hider = GetParam();
        s.lanes = lanes;
        s.seed = 5;
        return s;
    }
};

TEST_P(BitsTest, SplitsThreadsLanesBuilds) {
    std::string rib = crowd();
    auto rays = crowdRays(700);
    Scene scene(rib, settings());
    ASSERT_TRUE(scene.world);
    Bits whole = bitsOf(scene.trace(rays));
    double sum = 0;
    for (const Color& c : whole.color) sum += c.x;
    EXPECT_GT(sum, 10); // there is something to compare

    for (size_t chunk : {size_t(1), size_t(17), size_t(256)}) {
        std::vector<SampleResult> parts;
        for (size_t i = 0; i < rays.size(); i += chunk) {
            auto r = scene.trace(std::span(rays).subspan(i, std::min(chunk, rays.size() - i)));
            parts.insert(parts.end(), r.begin(), r.end());
        }
        EXPECT_EQ(differences(whole, bitsOf(parts)), 0u) << "calls of " << chunk;
    }
    // Another order of the rays.
    std::vector<size_t> order(rays.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), std::mt19937(9));
    std::vector<CameraRay> shuffled;
    for (size_t i : order) shuffled.push_back(rays[i]);
    auto mixed = scene.trace(shuffled);
    std::vector<SampleResult> back(rays.size());
    for (size_t i = 0; i < order.size(); ++i) back[order[i]] = mixed[i];
    EXPECT_EQ(differences(whole, bitsOf(back)), 0u) << "order";

    std::vector<SampleResult> threaded(rays.size());
    std::vector<std::thread> threads;
    for (int t = 0; t < 3; ++t)
        threads.emplace_back([&, t] {
            Integrator mine(scene.world, scene.diagnostics);
            for (size_t i = size_t(t) * 50; i < rays.size(); i += 150) {
                size_t n = std::min<size_t>(50, rays.size() - i);
                mine.trace(std::span(rays).subspan(i, n), std::span(threaded).subspan(i, n), nullptr);
            }
        });
    for (auto& t : threads) t.join();
    EXPECT_EQ(differences(whole, bitsOf(threaded)), 0u) << "threads";

    for (int lanes : {4, 8})
        EXPECT_EQ(differences(whole, bitsOf(Scene(rib, settings(lanes)).trace(rays))), 0u) << "lanes " << lanes;
    Settings mixedOnly = settings();
    mixedOnly.mixedOnly = true;
    EXPECT_EQ(differences(whole, bitsOf(Scene(rib, mixedOnly).trace(rays))), 0u) << "build V";
}
INSTANTIATE_TEST_SUITE_P(Hiders, BitsTest, ::testing::Values(Hider::Hidden, Hider::Path),
                         [](const auto& i) { return i.param == Hider::Path ? "path" : "hidden"; });

TEST(Bits, BoxInEveryWidth) {
    auto rays = boxRays(20, 5);
    std::string rib = boxRib(true);
    Bits first;
    for (int lanes : {16, 8, 4})
        for (bool mixed : {false, true}) {
            Settings s;
            s.hider = Hider::Path;
            s.lanes = lanes;
            s.mixedOnly = mixed;
            Bits b = bitsOf(Scene(rib, s).trace(rays));
            if (first.color.empty()) first = b;
            EXPECT_EQ(differences(first, b), 0u) << lanes << " lanes" << (mixed ? ", V" : ", S");
        }
}

} // namespace
