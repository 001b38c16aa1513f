// Displaced surfaces end where their closed forms do, to a pixel: near and far, in mirrors, moving. A ball is displaced to an
// ellipsoid, which rays meet by the sign of a quadratic's discriminant.
#include "integrator/floorscene.h"

namespace silhouettes_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

constexpr int kSide = 400; ///< of the picture, whose field is 60 degrees
const double kTangent = std::tan(30 * kPi / 180), kPixel = 2 * kTangent / kSide;

/// x^2 + (y / tall)^2 + z^2 < 1 about a centre.
struct Egg {
    Vec3d centre;
    double tall;
    bool meets(const Vec3d& eye, Vec3d dir) const {
        Vec3d o = eye - centre;
        o.y /= tall;
        dir.y /= tall;
        const double a = dot(dir, dir), b = dot(o, dir), c = dot(o, o) - 1;
        return b * b - a * c > 0 && (c < 0 || b < 0);
    }
};

class Silhouettes : public ::testing::TestWithParam<Hider> {
protected:
    void SetUp() override {
        writeShader("eggs", "displacement eggs(float tall = 1.6) { point p = transform(\"object\", P);\n"
                            "    P = transform(\"object\", \"current\", point(2 * xcomp(p), 2 * tall * ycomp(p), 2 * zcomp(p))); "
                            "N = calculatenormal(P); }\n");
        writeShader("glows", "surface glows() { Oi = 1; Ci = 1; }\n");
        writeShader("glass", "surface glass() { Oi = 1; Ci = trace(P, reflect(normalize(I), normalize(N))); }\n");
    }
    static std::string egg(const std::string& shape) {
        return "Attribute \"displacementbound\" \"float sphere\" 3 Displacement \"eggs\" Surface \"glows\" " + shape + "\n";
    }
    static std::string scene(const std::string& inside, const std::string& before = {}) {
        return "Format " + std::to_string(kSide) + " " + std::to_string(kSide) + " 1\nProjection \"perspective\" \"fov\" 60\n" +
               before + "WorldBegin\nSides 2\nAttribute \"visibility\" \"int specular\" 1 \"int camera\" 1\n" + inside +
               "WorldEnd\n";
    }
    static CameraRay through(double x, double y) { return rayTo({0, 0, 0}, {float(x * kTangent), float(y * kTangent), 1}); }

    /// Rays a pixel inside and outside the silhouette `meets` (by direction from the eye), in all directions from (cx, cy) of the
    /// picture of -1 to 1: what is met and should not be, or the other way about.
    template <class Meets>
    static void expectSilhouette(Scene& s, const Meets& meets, double cx, double cy, const std::string& what, float time = 0) {
        std::vector<CameraRay> rays;
        std::vector<bool> want;
        for (int k = 0; k < 64; ++k) {
            const double phi = 2 * kPi * (k + 0.37) / 64, c = std::cos(phi), sn = std::sin(phi), step = kPixel / kTangent;
            double lo = 0, hi = 3;
            ASSERT_TRUE(meets(Vec3d(cx * kTangent, cy * kTangent, 1))) << what;
            if (meets(Vec3d((cx + hi * c) * kTangent, (cy + hi * sn) * kTangent, 1))) continue; // beyond the picture
            for (int i = 0; i < 60; ++i) {
                const double mid = 0.5 * (lo + hi);
                (meets(Vec3d((cx + mid * c) * kTangent, (cy + mid * sn) * kTangent, 1)) ? lo : hi) = mid;
            }
            for (const double off : {-1., 1.}) {
                const double at = lo + off * step;
                if (at < 0) continue;
                rays.push_back(through(cx + at * c, cy + at * sn));
                rays.back().time = time;
                rays.back().shutter = time;
                want.push_back(off < 0);
            }
        }
        ASSERT_GT(rays.size(), 60u) << what;
        const auto seen = s.trace(rays);
        int wrong = 0;
        for (size_t i = 0; i < rays.size(); ++i) wrong += (seen[i].color.x > 0.5f) != want[i];
        EXPECT_EQ(wrong, 0) << what << ", of " << rays.size();
    }
    static Settings settings() {
        Settings s = under(GetParam());
        s.roulette = false;
        return s;
    }
};
const char* const kForms[] = {"Sphere .5 -.5 .5 360", // each a ball of a half before it is displaced
                              "Scale .5 .5 .5 Sphere 1 -1 1 360"};

TEST_P(Silhouettes, NearAndFar) {
    for (const double far : {1.3, 2.5, 9., 60., 400.}) {
        const Egg egg{{0.2, 0.1, far}, 1.6};
        Scene s(scene("Translate .2 .1 " + std::to_string(far) + " " + this->egg(kForms[0])), settings());
        expectSilhouette(
            s, [&](const Vec3d& d) { return egg.meets({}, d); }, 0.2 / far / kTangent, 0.1 / far / kTangent,
            "at " + std::to_string(far));
    }
}

TEST_P(Silhouettes, InAMirror) {
    // A mirror at z = 6 that faces the eye; balls behind the eye and beside it, which it does not see itself. Their images lie as
    // far behind it.
    for (const double z : {-1.5, -12., -150.}) {
        const double x = z < -2 ? 0.3 : 4;
        const Egg image{{x, 0, 12 - z}, 1.6};
        Scene s(scene("AttributeBegin Surface \"glass\" Polygon \"P\" [-99 -99 6  -99 99 6  99 99 6  99 -99 6] AttributeEnd "
                      "Translate " +
                      std::to_string(x) + " 0 " + std::to_string(z) + " " + egg(kForms[1])),
                settings());
        expectSilhouette(
            s, [&](const Vec3d& d) { return image.meets({}, d); }, x / (12 - z) / kTangent, 0,
            "mirrored at " + std::to_string(z));
    }
}

TEST_P(Silhouettes, Moving) {
    // By its transformation, and by its numbers: at every time the displaced shape of that time.
    const std::string open = "Shutter 0 1\n";
    for (const char* moves : {"MotionBegin [0 1] Translate -1 0 8 Translate 1 .5 5 MotionEnd Sphere .5 -.5 .5 360",
                              "Translate 0 0 8 MotionBegin [0 1] Sphere .5 -.5 .5 360 Sphere 1 -1 1 360 MotionEnd"}) {
        const bool placed = moves[18] == 'T';
        Settings set = settings();
        Scene s(scene(egg(moves), open), set);
        for (const float t : {0.f, 0.25f, 0.5f, 1.f}) {
            // Twice as large means twice the ellipsoid: seen at half the distance.
            const Vec3d at = placed ? Vec3d(-1 + 2 * t, 0.5 * t, 8 - 3 * t) : Vec3d(0, 0, 8 / (1 + t));
            const Egg now{at, 1.6};
            expectSilhouette(
                s, [&](const Vec3d& d) { return now.meets({}, d); }, at.x / at.z / kTangent, at.y / at.z / kTangent,
                (placed ? "placed " : "growing ") + std::to_string(t), t);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Silhouettes, ::testing::Values(Hider::Hidden, Hider::Raytrace, Hider::Path));

} // namespace

} // namespace silhouettes_test
