// Every primitive as a lamp: curved towards the floor and away from it, still, moved, deformed, displaced. Light samples alone,
// rays of lobes alone, both, an illuminance loop, traced shadows under hidden, and photons tell the same light, and it is that of
// a closed form. A sheet between four straight edges lights as much as any other between them that hides nothing of itself
// (Lambert); a half ball seen from its open side is a disc, one seen from the other a ball (Howell). The large table runs with
// ALPENGLOW_NIGHTLY.
#include "integrator/floorscene.h"
#include "integrator/integrator.h"
#include "world/photonmaps.h"

namespace lamps_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

constexpr double kRadiance = 5, kHeight = 2, kUnknown = -1;

std::string numbers(std::initializer_list<double> all) {
    std::string s = "[";
    for (const double x : all) s += std::to_string(x) + " ";
    return s + "]";
}
/// Points over the square |x|, |z| <= 1, n a side, whose inner ones are lifted. With weights: "Pw".
std::string net(int n, double lift, bool weights = false) {
    std::string s = weights ? "\"Pw\" [" : "\"P\" [";
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const bool inner = i > 0 && j > 0 && i < n - 1 && j < n - 1;
            const double w = weights && inner ? 1.5 : 1;
            for (const double c : {2. * i / (n - 1) - 1, inner ? lift : 0., 2. * j / (n - 1) - 1})
                s += std::to_string(c * w) + " ";
            if (weights) s += std::to_string(w) + " ";
        }
    return s + "]\n";
}
std::string bicubic(double lift) { return "Patch \"bicubic\" " + net(4, lift); }
std::string nurbs(double lift) { return "NuPatch 4 4 [0 0 0 0 1 1 1 1] 0 1 4 4 [0 0 0 0 1 1 1 1] 0 1 " + net(4, lift, true); }
std::string subdivision(double lift) {
    constexpr int n = 5;
    std::string count, index;
    for (int j = 0; j + 1 < n; ++j)
        for (int i = 0; i + 1 < n; ++i) {
            count += "4 ";
            for (const int k : {j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i}) index += std::to_string(k) + " ";
        }
    return "SubdivisionMesh \"catmull-clark\" [" + count + "] [" + index +
           "] [\"interpolateboundary\" \"corner\"] [0 0 4 1] [0 4 20 24] [8] " + net(n, lift);
}
std::string bilinear(double lift) {
    return "Patch \"bilinear\" \"P\" " + numbers({-1, lift, -1, 1, -lift, -1, -1, -lift, 1, 1, lift, 1}) + "\n";
}
std::string pyramid(double lift) {
    return "PointsPolygons [3 3 3 3] [0 1 4 1 2 4 2 3 4 3 0 4] \"P\" " +
           numbers({-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1, 0, lift, 0}) + "\n";
}
std::string spline(double lift) { // a bowl that no net borders
    std::string p = "Patch \"bicubic\" \"P\" [";
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const double x = 2. * i - 3, z = 2. * j - 3;
            for (const double c : {x, lift * (x * x + z * z) / 8, z}) p += std::to_string(c) + " ";
        }
    return p + "]\n";
}
std::string sphere(double r, double from, double to) { return "Sphere " + numbers({r, from * r, to * r, 360}).substr(1) + "\n"; }

/// What a lamp between four corners over the origin gives: half the sum over its edges of the angle each is seen under, times how
/// far the normal of its plane points up.
double between(const Vec3d (&p)[4]) {
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        const Vec3d a = normalize(p[i]), b = normalize(p[(i + 1) % 4]);
        sum += std::acos(dot(a, b)) * normalize(cross(a, b)).y;
    }
    return std::fabs(sum) / (2 * kPi);
}
double ofSquare(double, double aside) {
    return between({{aside - 1, kHeight, -1}, {aside + 1, kHeight, -1}, {aside + 1, kHeight, 1}, {aside - 1, kHeight, 1}});
}
double ofTwisted(double lift, double aside) {
    return between({{aside - 1, kHeight + lift, -1},
                    {aside + 1, kHeight - lift, -1},
                    {aside + 1, kHeight + lift, 1},
                    {aside - 1, kHeight - lift, 1}});
}
double ofDisc(double r, double aside) {
    const double z = aside * aside + r * r + kHeight * kHeight;
    return .5 * (1 - (z - 2 * r * r) / std::sqrt(z * z - 4 * r * r * aside * aside));
}
double ofBall(double r, double aside) { return r * r * kHeight / std::pow(aside * aside + kHeight * kHeight, 1.5); }
double unknown(double, double) { return kUnknown; }

/// A lamp in a space whose origin is at its place, as a number makes it: how far its middle is lifted, or a radius.
struct Lamp {
    const char* name;
    std::string (*shape)(double);
    double from, to;                 ///< what it is, and becomes where it deforms
    double (*light)(double, double); ///< that radiance 1 of it gives at the origin, over pi; aside: how far it is beside
    bool upright = false;            ///< made about z, to be stood on it
    bool displaces = false;          ///< u and v go over the square
};
const Lamp kLamps[] = {
    {"bicubic dome", bicubic, .9, .5, ofSquare, false, true},
    {"bicubic bowl", bicubic, -.9, -.5, ofSquare, false, true},
    {"NURBS dome", nurbs, .7, .4, ofSquare, false, true},
    {"NURBS bowl", nurbs, -.7, -.4, ofSquare, false, true},
    {"subdivision dome", subdivision, .6, .3, ofSquare},
    {"subdivision bowl", subdivision, -.6, -.3, ofSquare},
    {"b-spline dome", spline, -.6, -.4, unknown},
    {"b-spline bowl", spline, .6, .4, unknown},
    {"twisted patch", bilinear, .5, .2, ofTwisted},
    {"patch, twisted otherwise", bilinear, -.5, -.2, ofTwisted},
    {"flat patch", bilinear, 0, .1, ofTwisted, false, true},
    {"pyramid", pyramid, .5, .9, ofSquare},
    {"pyramid on its head", pyramid, -.5, -.9, ofSquare},
    {"disk", [](double r) { return "Disk 0 " + std::to_string(r) + " 360\n"; }, .7, 1, ofDisc, true},
    {"half ball, open", [](double r) { return sphere(r, 0, 1); }, .6, 1, ofDisc, true},
    {"half ball, closed", [](double r) { return sphere(r, -1, 0); }, .6, 1,
     [](double r, double aside) { return aside == 0 ? ofBall(r, 0) : kUnknown; }, true},
    {"ball", [](double r) { return sphere(r, -1, 1); }, .5, .9, ofBall},
    {"cone", [](double r) { return "Cone " + numbers({r / 2, r, 360}).substr(1) + "\n"; }, .6, 1, ofDisc, true},
    {"cylinder", [](double r) { return "Cylinder " + numbers({r, -r / 2, r, 270}).substr(1) + "\n"; }, .4, .7, unknown},
    {"torus", [](double r) { return "Torus " + numbers({r, r / 2, 0, 360, 360}).substr(1) + "\n"; }, .5, .7, unknown, true},
    {"points",
     [](double r) {
         return "Points \"P\" [0 0 0] \"string type\" \"sphere\" \"constantwidth\" [" + std::to_string(2 * r) + "]\n";
     },
     .5, .9, ofBall},
    {"ball that is seen through", [](double r) { return "Opacity 0 0 0\n" + sphere(r, -1, 1); }, .5, .9,
     [](double r, double aside) { return 2 * ofBall(r, aside); }},
    {"discs that face", // whatever ray comes: a ball to all
     [](double r) { return "Points \"P\" [0 0 0] \"constantwidth\" [" + std::to_string(2 * r) + "]\n"; }, .9, .7, ofBall},
    {"ribbon that faces",
     [](double r) {
         return "Curves \"linear\" [2] \"nonperiodic\" \"P\" [-1 0 0 1 .3 0] \"constantwidth\" [" + std::to_string(2 * r) + "]\n";
     },
     .8, .6, unknown},
    {"tube",
     [](double r) {
         return "Attribute \"dice\" \"int roundcurve\" 1\nCurves \"linear\" [2] \"nonperiodic\" \"P\" [-1 0 0 1 .3 0] "
                "\"constantwidth\" [" +
                std::to_string(r) + "]\n";
     },
     .6, .9, unknown},
    {"blobby",
     [](double r) {
         return "Blobby 1 [1001 0] [" + numbers({r, 0, 0, 0, 0, r, 0, 0, 0, 0, r, 0, 0, 0, 0, 1}).substr(1) + " [\"\"]\n";
     },
     1, 1.4, unknown},
};

enum Change { Still, Moved, Deformed, Displaced };
constexpr const char* kChanges[] = {"still", "moved", "deformed", "displaced"};
constexpr float kWhen = .5f;        ///< of the shutter
constexpr double kLightOutput = .3; ///< then, of what moves

/// The lamp at its place. Between keys numbers and points are linear.
std::string placed(const Lamp& l, Change c) {
    std::string s = "Translate 0 2 0\n";
    if (c == Moved) s += "MotionBegin [0 1]\nTranslate 0 0 0\nTranslate .6 0 0\nMotionEnd\n";
    if (l.upright) s += "Rotate -90 1 0 0\n";
    if (l.shape == spline) s += "Basis \"b-spline\" 1 \"b-spline\" 1\n";
    if (c == Displaced)
        s += "Attribute \"displacementbound\" \"float sphere\" 1\nDisplacement \"lampbulge\" \"float lift\" " +
             std::to_string(l.to) + "\n";
    std::string first = l.shape(l.from);
    if (const size_t at = first.rfind('\n', first.size() - 2); at != std::string::npos) { // an attribute before it
        s += first.substr(0, at + 1);
        first = first.substr(at + 1);
    }
    if (c != Deformed) return s + first;
    std::string last = l.shape(l.to);
    return s + "MotionBegin [0 1]\n" + first + last.substr(last.rfind('\n', last.size() - 2) + 1) + "MotionEnd\n";
}
double wanted(const Lamp& l, Change c) {
    const double light = l.light(c == Deformed ? (l.from + l.to) / 2 : l.from, c == Moved ? kLightOutput : 0);
    return light == kUnknown ? kUnknown : kRadiance * light;
}

std::string sceneOf(const Lamp& l, Change c, const std::string& floor, Hider hider = Hider::Path) {
    writeShader("lampboth", "light lampboth() { illuminate(P, N, PI) Cl = 5; }\n");
    writeShader("lampbulge", "displacement lampbulge(float lift = 0;) { P += lift * 4 * u * (1 - u) * 4 * v * (1 - v) * vector "
                             "\"world\" (0, .5, 0); N = calculatenormal(P); }\n");
    writeShader("lamploop", "surface lamploop() { normal n = normalize(faceforward(N, I)); illuminance(P, n, PI / 2) Ci += Cl * "
                            "(normalize(L) . n); Oi = 1; }\n");
    return std::string(hider == Hider::Path ? "Hider \"path\"\n" : "") +
           "Shutter 0 1\nWorldBegin\nSides 2\nAttributeBegin\nSurface \"constant\"\nColor 0 0 0\nAttribute \"light\" \"string "
           "units\" \"radiance\" \"string shadows\" \"on\"\nAreaLightSource \"lampboth\" 1\n" +
           placed(l, c) + "AttributeEnd\nIlluminate 1 1\nSurface " + floor + "\n" + kFloor + "WorldEnd\n";
}
const char* const kMatte = "\"matte\" \"float Ka\" 0 \"float Kd\" 1";

Moments floorUnder(const Lamp& l, Change c, Hider hider, const std::string& floor, int mode, int n) {
    Settings set = withShaders(hider);
    set.bsdfOnly = mode == 1;
    set.lightOnly = mode == 2;
    Scene s(sceneOf(l, c, floor, hider), set);
    CameraRay view = kView;
    if (hider == Hider::Path) view.shutter = view.time = kWhen; // hidden shades where things are when the shutter opens
    return s.estimate(view, n);
}

void expectAgreement(const Lamp& l, Change c, bool large) {
    const std::string what = std::string(l.name) + ", " + kChanges[c];
    double want = wanted(l, c), known = 0;
    const int few = large ? 40'000 : 2500;
    if (want == kUnknown || large) {
        const Moments rays = floorUnder(l, c, Hider::Path, kMatte, 1, large ? 400'000 : 8000);
        if (want == kUnknown) want = rays.mean(), known = kZ * rays.se();
        else EXPECT_NEAR(rays.mean(), want, kZ * rays.se() + .005 * want) << what << ", rays of lobes";
    }
    const auto expect = [&](const Moments& m, const char* way) {
        EXPECT_LE(std::fabs(m.mean() - want), kZ * m.se() + known + .005 * want)
            << what << ", " << way << ": " << m.mean() << " +- " << m.se() << ", " << want;
        EXPECT_LE(m.se(), (large ? .03 : .07) * want) << what << ", " << way << ": not precise enough to decide";
    };
    expect(floorUnder(l, c, Hider::Path, kMatte, 2, few), "light samples");
    expect(floorUnder(l, c, Hider::Path, kMatte, 0, few), "both");
    if (!large) return;
    expect(floorUnder(l, c, Hider::Path, "\"lamploop\"", 0, few), "illuminance loop");
    if (c == Still || c == Displaced) expect(floorUnder(l, c, Hider::Hidden, kMatte, 0, few), "hidden");
}

} // namespace

TEST(Lamps, Still) {
    for (const Lamp& l : kLamps) expectAgreement(l, Still, nightly());
}
TEST(Lamps, Moved) {
    for (const Lamp& l : kLamps)
        if (chosen(size_t(&l - kLamps) + 1, 2)) expectAgreement(l, Moved, nightly());
}
TEST(Lamps, Deformed) {
    for (const Lamp& l : kLamps)
        if (chosen(size_t(&l - kLamps), 2)) expectAgreement(l, Deformed, nightly());
}
TEST(Lamps, Displaced) {
    for (const Lamp& l : kLamps)
        if (l.displaces) expectAgreement(l, Displaced, nightly());
}

// What photons bring to a disc on the floor is what its middle gets: it is so small that the rest does not differ.
TEST(Lamps, Photons) {
    for (const Lamp& l : kLamps)
        for (const Change c : {Still, Moved, Deformed, Displaced}) {
            const double want = wanted(l, c);
            if (want == kUnknown || std::string(l.name).ends_with("face") || // nobody says where those look
                (c == Displaced && !l.displaces) || (c != Still && !nightly()))
                continue;
            Scene s(sceneOf(l, c, kMatte), withShaders(Hider::Path));
            PhotonEmission emission(s.world, {}, s.diagnostics);
            PhotonEmission::Thread thread(emission, s.diagnostics);
            std::vector<StoredPhoton> all;
            const uint32_t n = nightly() ? 400'000 : 20'000;
            EXPECT_TRUE(thread.emit(0, 0, n, n, all, nullptr));
            double sum = 0, square = 0;
            for (const StoredPhoton& p : all) {
                // Of what moves those that met the floor when it was half way.
                if (p.photon.bounces > 0 || p.photon.P.x * p.photon.P.x + p.photon.P.z * p.photon.P.z > .16f) continue;
                if (c != Still && c != Displaced && std::fabs(p.time - kWhen) > .1) continue;
                const double w = double(p.photon.power.x) / (kPi * .16 * kPi) * (c == Still || c == Displaced ? 1 : 5);
                sum += w, square += w * w;
            }
            EXPECT_NEAR(sum, want, kZ * std::sqrt(square) + .03 * want) << l.name << ", " << kChanges[c];
        }
}

} // namespace lamps_test
