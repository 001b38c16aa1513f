// Equality to the bit (T10 for transport): how rays are split into calls, threads, lanes, builds S and V change nothing.
#include "integrator/box.h"
#include <cstring>
#include <thread>

namespace bits_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

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

/// However these rays are split into calls, ordered, shared by threads, in whatever lanes: the same bits.
void expectSameBits(const std::string& rib, const std::vector<CameraRay>& rays, const Settings& settings) {
    Scene scene(rib, settings);
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

    for (int lanes : {4, 8}) {
        Settings narrow = settings;
        narrow.lanes = lanes;
        EXPECT_EQ(differences(whole, bitsOf(Scene(rib, narrow).trace(rays))), 0u) << "lanes " << lanes;
    }
    Settings mixedOnly = settings;
    mixedOnly.mixedOnly = true;
    EXPECT_EQ(differences(whole, bitsOf(Scene(rib, mixedOnly).trace(rays))), 0u) << "build V";
    Settings single = settings;
    single.rowRequests = false;
    EXPECT_EQ(differences(whole, bitsOf(Scene(rib, single).trace(rays))), 0u) << "points one by one";
}

/// A primitive, and the same one at the end of the shutter, of as many pieces.
struct Pair {
    std::string first, last;
};
std::vector<Pair> everyPrimitive() {
    const auto solid = [](const char* x) {
        return std::string("SolidBegin \"difference\"\nSolidBegin \"primitive\"\nSphere .5 -.5 .5 360\nSolidEnd\nSolidBegin "
                           "\"primitive\"\nColor .9 .1 .1\nTranslate ") +
               x + " -.3\nSphere .4 -.4 .4 360\nSolidEnd\nSolidEnd\n";
    };
    const auto net = [](double bend) { // of a bicubic patch
        std::string s;
        for (int i = 0; i < 16; ++i)
            s += std::to_string(.3 * (i % 4) - .45) + " " + std::to_string(.3 * (i / 4) - .45) + " " +
                 std::to_string(bend * (i % 3 - 1)) + " ";
        return s;
    };
    const auto cube = [](double top) {
        std::string s;
        for (int k = 0; k < 8; ++k)
            s += std::to_string((k & 1 ? .4 : -.4) * (k & 2 ? top : 1)) + " " + std::to_string(k & 2 ? .4 : -.4) + " " +
                 std::to_string(k & 4 ? .4 : -.4) + " ";
        return "\"P\" [" + s + "]\n";
    };
    const std::string faces = "[4 4 4 4 4 4] [0 2 3 1  4 5 7 6  0 1 5 4  2 6 7 3  0 4 6 2  1 3 7 5] ";
    const std::string knots = "4 4 [0 0 0 0 1 1 1 1] 0 1 ",
                      hole = "TrimCurve [1] [2] [0 0 1 2 3 4 4] [0] [4] [5] [.3 .7 .7 .3 .3] [.3 .3 .7 .7 .3] [1 1 1 1 1]\n";
    std::string Pw;
    for (int i = 0; i < 16; ++i)
        Pw += std::to_string(.3 * (i % 4) - .45) + " " + std::to_string(.3 * (i / 4) - .45) + " " + std::to_string(.2 * (i % 2)) +
              " 1 ";
    return {
        {"Sphere .5 -.5 .5 360\n", "Sphere .3 -.3 .3 360\n"},
        {"Cone .8 .4 360\n", "Cone .6 .5 360\n"},
        {"Cylinder .3 -.4 .4 360\n", "Cylinder .4 -.4 .4 360\n"},
        {"Hyperboloid .4 -.4 -.4 .2 .4 .4 360\n", "Hyperboloid .4 -.4 -.4 .4 .2 .4 360\n"},
        {"Paraboloid .4 0 .7 360\n", "Paraboloid .5 0 .6 360\n"},
        {"Torus .35 .15 0 360 360\n", "Torus .4 .1 0 360 360\n"},
        {"Disk 0 .5 360\n", "Disk -.2 .4 360\n"},
        {"Polygon \"P\" [-.4 -.4 0  -.4 .4 0  .4 .4 0  .4 -.4 0]\n",
         "Polygon \"P\" [-.4 -.4 0  -.4 .4 .2  .4 .4 0  .4 -.4 .2]\n"},
        {"PointsPolygons " + faces + cube(1), "PointsPolygons " + faces + cube(.5)},
        {"Patch \"bicubic\" \"P\" [" + net(.1) + "]\n", "Patch \"bicubic\" \"P\" [" + net(.3) + "]\n"},
        {"PatchMesh \"bilinear\" 4 \"nonperiodic\" 4 \"nonperiodic\" \"P\" [" + net(.1) + "]\n",
         "PatchMesh \"bilinear\" 4 \"nonperiodic\" 4 \"nonperiodic\" \"P\" [" + net(.2) + "]\n"},
        {hole + "NuPatch " + knots + knots + "\"Pw\" [" + Pw + "]\n", ""},
        {"SubdivisionMesh \"catmull-clark\" " + faces + "[\"interpolateboundary\"] [0 0] [] [] " + cube(1),
         "SubdivisionMesh \"catmull-clark\" " + faces + "[\"interpolateboundary\"] [0 0] [] [] " + cube(.5)},
        {"Curves \"cubic\" [7] \"nonperiodic\" \"P\" [-.5 -.5 0  -.4 .5 0  -.2 .5 .3  0 0 0  .2 -.5 -.3  .4 -.5 0  .5 .5 0] "
         "\"constantwidth\" .15\n",
         "Curves \"cubic\" [7] \"nonperiodic\" \"P\" [-.5 -.5 0  -.4 .5 .2  -.2 .3 .3  0 0 0  .2 -.3 -.3  .4 -.5 0  .5 .3 0] "
         "\"constantwidth\" .1\n"},
        {"Attribute \"dice\" \"roundcurve\" 1\nCurves \"linear\" [3] \"nonperiodic\" \"P\" [-.4 -.4 0  0 .4 0  .4 -.4 .2] "
         "\"constantwidth\" .2\n",
         "Curves \"linear\" [3] \"nonperiodic\" \"P\" [-.4 -.4 0  0 .4 .2  .4 -.4 .2] \"constantwidth\" .3\n"},
        {"Points \"P\" [-.3 0 0  .3 0 0  0 .3 .2] \"width\" [.2 .3 .4]\n",
         "Points \"P\" [-.3 .2 0  .3 0 0  0 .3 .2] \"width\" [.4 .3 .2]\n"},
        {"Points \"P\" [-.3 0 0  .3 0 0  0 .3 .2] \"constantwidth\" .4 \"uniform string type\" \"sphere\"\n",
         "Points \"P\" [-.3 .2 0  .3 0 0  0 .3 .2] \"constantwidth\" .3 \"uniform string type\" \"sphere\"\n"},
        {"Blobby 2 [1001 0 1001 16 0 2 0 1] [.8 0 0 0  0 .8 0 0  0 0 .8 0  -.2 0 0 1  .7 0 0 0  0 .7 0 0  0 0 .7 0  .25 .1 0 1] "
         "[\"\"]\n",
         "Blobby 2 [1001 0 1001 16 0 2 0 1] [.6 0 0 0  0 .8 .1 0  0 0 .8 0  -.1 0 0 1  .7 0 0 0  0 .7 0 0  0 .2 .7 0  .3 .1 0 1] "
         "[\"\"]\n"},
        {"Attribute \"displacementbound\" \"sphere\" .2\nDisplacement \"waves\"\nSphere .4 -.4 .4 360\n",
         "Sphere .3 -.3 .3 360\n"},
        {solid(".1 0"), ""},
    };
}
/// All of them in rows, lit by a lamp and a point light. moving: each turns, and becomes its other one.
std::string all(bool moving, bool instances = false) {
    writeShader("waves", "displacement waves() { P += .03 * sin(30 * xcomp(transform(\"object\", P))) * normalize(N); N = "
                         "calculatenormal(P); }\n");
    std::string s =
        "Shutter 0 1\nWorldBegin\nSides 2\nShadingRate 4\nLightSource \"pointlight\" 1 \"intensity\" 30 \"from\" [1 4 -1]\n"
        "AttributeBegin\nAreaLightSource \"slrect\" 2 \"float intensity\" 3\nSurface \"constant\"\nColor 0 0 0\nPolygon \"P\" "
        "[-1 4 4  1 4 4  1 4 6  -1 4 6]\n"
        "AttributeEnd\nIlluminate 2 1\n";
    const char* shaders[] = {"plastic", "matte", "busyall"};
    writeShader(
        "busyall",
        "surface busyall() { normal Nf = faceforward(normalize(N), I); color r = .2 * random(); Oi = Os; "
        "Ci = Os * (Cs * .7 * diffuse(Nf) + r + .1 * color(abs(dPdtime)) + .2 * trace(P, reflect(normalize(I), Nf))); }\n");
    int i = 0;
    for (const auto& [first, last] : everyPrimitive()) {
        const std::string number = std::to_string(i + 1);
        std::string body = first;
        if (moving && !last.empty()) { // attributes before the primitive stay outside
            const size_t line = first.rfind('\n', first.size() - 2) + 1;
            body = first.substr(0, line) + "MotionBegin [0 1]\n" + first.substr(line) + last + "MotionEnd\n";
        }
        std::string place =
            "Translate " + std::to_string(1.15 * (i % 5) - 2.3) + " " + std::to_string(1.15 * (i / 5) - 1.7) + " 6\n";
        if (moving)
            place += "MotionBegin [0 1]\nRotate " + std::to_string(20 + 7 * i) + " 1 2 1\nRotate " + std::to_string(50 + 9 * i) +
                     " 1 2 1\nMotionEnd\n";
        else place += "Rotate " + std::to_string(20 + 17 * i) + " 1 2 1\n";
        const std::string surface = "Surface \"" + std::string(shaders[i % 3]) + "\"\nColor [" + std::to_string(.3 + .03 * i) +
                                    " .6 .5]\n" + (i % 4 == 3 ? "Opacity .6 .7 .8\n" : "");
        if (instances)
            s += "AttributeBegin\n" + surface + "ObjectBegin " + number + "\n" + body + "ObjectEnd\n" + place +
                 "ObjectInstance " + number + "\nAttributeEnd\n";
        else s += "AttributeBegin\n" + surface + place + body + "AttributeEnd\n";
        ++i;
    }
    return s + "Surface \"matte\"\nPolygon \"P\" [-9 -2.5 0  -9 -2.5 20  9 -2.5 20  9 -2.5 0]\nWorldEnd\n";
}
std::vector<CameraRay> allRays(int n, bool moving) {
    std::vector<CameraRay> rays = crowdRays(n);
    for (size_t i = 0; i < rays.size() && moving; ++i) rays[i].time = rays[i].shutter = float(i % 97) / 97;
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

TEST_P(BitsTest, SplitsThreadsLanesBuilds) { expectSameBits(crowd(), crowdRays(700), settings()); }
TEST_P(BitsTest, EveryPrimitive) { expectSameBits(all(false), allRays(500, false), settings()); }
TEST_P(BitsTest, EveryPrimitiveMoving) { expectSameBits(all(true), allRays(500, true), settings()); }
INSTANTIATE_TEST_SUITE_P(Hiders, BitsTest, ::testing::Values(Hider::Hidden, Hider::Path),
                         [](const auto& i) { return i.param == Hider::Path ? "path" : "hidden"; });

// Every primitive as an instance, and where it is: the same bits. (What large instances share is rounded otherwise:
// Placed.InstancesOfEveryFormAreCopies.)
TEST(Bits, InstancesAreCopies) {
    for (const bool moving : {false, true})
        for (const Hider h : {Hider::Hidden, Hider::Path}) {
            if (!nightly() && moving != (h == Hider::Path)) continue;
            Settings s;
            s.hider = h;
            s.seed = 5;
            const auto rays = allRays(nightly() ? 400 : 120, moving);
            const Bits copies = bitsOf(Scene(all(moving), s).trace(rays)),
                       instances = bitsOf(Scene(all(moving, true), s).trace(rays));
            EXPECT_EQ(differences(copies, instances), 0u) << (moving ? "moving" : "still") << ", hider " << int(h);
        }
}

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

} // namespace bits_test
