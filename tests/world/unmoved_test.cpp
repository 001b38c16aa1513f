// A displacement shader that leaves P as it is, with the values that its parameters have, makes no grid: the primitive keeps its
// exact form, and the normals that the shader sets arrive.
#include "integrator/harness.h"
#include "world/impl.h"

namespace unmoved_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kFrame =
    "Format 64 64 1 Projection \"perspective\" \"fov\" 60\nWorldBegin\nSurface \"constant\"\nTranslate 0 0 5\n";

/// Whether a unit sphere at z = 5 keeps its exact form under a displacement shader of this body.
bool exact(const std::string& body, const std::string& given = "", const std::string& sphere = "") {
    static int number = 0;
    const std::string name = "body" + std::to_string(++number);
    writeShader(name, "displacement " + name + "(float Km = .1; float bumps[2] = {0, 0}; float n = 3;) {\n" + body + "\n}\n");
    const Scene s(kFrame + "Displacement \"" + name + "\" " + given + "\nSphere 1 -1 1 360 " + sphere + "\nWorldEnd\n");
    if (!s.world) return false;
    return static_cast<const WorldImpl&>(*s.world).shapes().at(0)->exact();
}

const char* const kBump = "P += Km * noise(4 * P) * normalize(N); N = calculatenormal(P);";

} // namespace

TEST(Unmoved, ShadersThatNeverWritePMakeNoGrid) {
    EXPECT_TRUE(exact("N = normalize(N + .2 * (vector noise(9 * P) - .5));"));
    EXPECT_TRUE(exact("point Q = P + Km * noise(4 * P) * normalize(N); N = calculatenormal(Q);"));
}

TEST(Unmoved, NorDoThoseThatAddNothing) {
    EXPECT_TRUE(exact(kBump, "\"Km\" 0"));
    EXPECT_TRUE(exact("P -= normalize(N) * (Km * (noise(P) + .5) / 3); N = calculatenormal(P);", "\"Km\" 0"));
    EXPECT_TRUE(exact("if (Km != 0) { P += Km * N; N = calculatenormal(P); }", "\"Km\" 0"));
    EXPECT_TRUE(exact("if (noise(P) > .5) P += Km * N;", "\"Km\" 0"));
    EXPECT_TRUE(exact("P = P + 0 * N;"));
    EXPECT_TRUE(exact("setxcomp(P, xcomp(P) + Km * noise(P));", "\"Km\" 0"));
    EXPECT_TRUE(exact("float i = 0; while (i < n * noise(P)) { P += Km * N * i; i += 1; }", "\"Km\" 0"));
    EXPECT_TRUE(
        exact("float amp = 0, f = 1; for (; f < 20 * noise(P); f *= 2) amp += Km * noise(P * f); P += amp * N;", "\"Km\" 0"));
}

TEST(Unmoved, OthersDo) {
    EXPECT_FALSE(exact(kBump));
    EXPECT_FALSE(exact(kBump, "\"Km\" 1e-6"));
    EXPECT_FALSE(exact(kBump, "\"Km\" 0", "\"varying float Km\" [0 0 .1 .1]")) << "the primitive has values of its own";
    EXPECT_FALSE(exact("if (noise(P) > 2) P += N;")) << "what noise gives is not known";
    EXPECT_FALSE(exact("P *= 1.5;"));
    EXPECT_FALSE(exact("P += (1 - Km) * N;", "\"Km\" 0"));
    EXPECT_FALSE(exact("P = point(ycomp(P), xcomp(P), zcomp(P));"));
    EXPECT_FALSE(exact("P += Km * N; P += .1 * N;", "\"Km\" 0"));
    EXPECT_FALSE(exact("float i = 0; while (i < n * noise(P)) { P += i * N; i += 1; }", "\"Km\" 0"));
    EXPECT_FALSE(exact("float a = 0, b = 0, i = 0; while (i < n * noise(P)) { P += b * N; b = a; a = 1; i += 1; }"))
        << "what comes from the turn before the last";
}

TEST(Unmoved, TheNormalThatItSetsArrives) {
    writeShader("sideways", "displacement sideways(float Km = 0;) { P += Km * N; N = normal(1, 0, 0); }");
    writeShader("shown", "surface shown() { Ci = color(xcomp(N), ycomp(N), zcomp(N)); Oi = 1; }");
    for (const char* primitive : {"Sphere 1 -1 1 360", "Patch \"bilinear\" \"P\" [-1 -1 0 1 -1 .3 -1 1 0 1 1 0]",
                                  "Polygon \"P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0]"})
        for (const char* km : {"0", ".01"}) {
            Scene s(kFrame + "Surface \"shown\" Displacement \"sideways\" \"Km\" " + km + "\n" + primitive + "\nWorldEnd\n");
            const Color c = s.one(rayTo(Vec3(0.f), Vec3(0.1f, 0.1f, 4)));
            EXPECT_NEAR(c.x, 1, 1e-5) << primitive << km;
            EXPECT_NEAR(c.y, 0, 1e-5) << primitive << km;
            EXPECT_NEAR(c.z, 0, 1e-5) << primitive << km;
        }
}

} // namespace unmoved_test
