// A class (3Delight manual, 6.1.1.2) that displaces and shades: what its displacement() writes to members its other methods see,
// with derivatives.
#include "integrator/floorscene.h"

namespace leftmembers_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// The plane z = 5 from -2 to 2: u = (x + 2) / 4, v = (y + 2) / 4. It moves by less than one. Pieces of five pixels: what lies on
/// a parabola is off by 1e-5, and there are 25 times fewer of them. Derivatives are exact under all hiders: a difference over
/// such a piece would be off by half of it.
const std::string kPatch = "ShadingRate 25\nAttribute \"shade\" \"derivatives\" \"exact\"\nAttribute \"displacementbound\" "
                           "\"float sphere\" 1\nPatch \"bilinear\" \"P\" [-2 -2 5  2 -2 5  -2 2 5  2 2 5]\n";
const Hider kHiders[] = {Hider::Hidden, Hider::Raytrace, Hider::Path};

/// What the camera sees where u and v are these.
Color seen(const std::string& inside, Hider hider, float u, float v, bool mixed = false) {
    Settings settings = withShaders(hider);
    settings.mixedOnly = mixed;
    Scene s(inWorld(inside), settings);
    const Vec3 at{4 * u - 2, 4 * v - 2, 0};
    return s.one(rayTo(at, at + Vec3(0, 0, 5)));
}

void expectColor(const Color& c, const Color& want, const std::string& what) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], 1e-4f) << what << ", channel " << k;
}

const char* const kDune = R"(class dune(float what = 0; output varying float left = 0; float list[3] = {1, 1, 1})
{
    varying float height = 7;
    uniform float scale = 0;
    point before = 0;
    float own[2] = {5, 6};
    float grown[];
    string word = "?";
    matrix m = 1;
    float again = 1;
    public void construct() { scale = .5; }
    public void begin() { before = P; height = 3; again += 1; }
    public void displacement(output point P; output normal N)
    {
        height = scale * u * u;
        left = v;
        list[1] = 2 * u;
        own[1] = 3 * v;
        push(grown, u);
        if (u > .5) push(grown, 20);
        word = "dune";
        m = 2;
        P += vector "camera" (0, 0, -height);
        N = calculatenormal(P);
    }
    public void opacity(output color Oi) { Oi = 1 - height; }
    public void surface(output color Ci, Oi)
    {
        Oi = 1;
        if (what == 0) Ci = color(height, Du(height), Dv(height));
        else if (what == 1) Ci = color(zcomp(before), zcomp(P), left);
        else if (what == 2) Ci = color(list[0], list[1], list[2]);
        else if (what == 3) Ci = color(own[0], own[1], arraylength(grown));
        else if (what == 4) Ci = color(grown[0], grown[arraylength(grown) - 1], comp(m, 1, 1));
        else if (what == 5) Ci = color(word == "dune", again, scale);
    }
}
)";

} // namespace

TEST(LeftMembers, SurfaceSeesWhatDisplacementWrote) {
    writeShader("dune", kDune);
    const float u = .6f, v = .3f, height = .5f * u * u;
    const Color wants[] = {{height, u, 0},                                              // d(u*u/2)/du = u
                           {5, 5 - height, v},                                          // begin() saw the surface where it was
                           {1, 2 * u, 1},      {5, 3 * v, 2}, {u, 20, 2}, {1, 2, .5f}}; // begin() ran once
    for (const Hider h : kHiders)
        for (int what = 0; what < 6; ++what)
            for (const bool mixed : {false, h == Hider::Hidden})
                expectColor(seen("Surface \"dune\" \"float what\" " + std::to_string(what) + "\n" + kPatch, h, u, v, mixed),
                            wants[what], "what " + std::to_string(what) + ", hider " + std::to_string(int(h)));
    // An array that grows is as long as displacement() made it at this point.
    expectColor(seen("Surface \"dune\" \"float what\" 3\n" + kPatch, Hider::Hidden, .4f, v), {5, 3 * v, 1}, "u below 1/2");
}

TEST(LeftMembers, OpacityStopsRaysByThem) {
    writeShader("dune", kDune);
    writeShader("through", "surface through() { Oi = 1; Ci = transmission(P, P - vector(0, 0, 6)); }\n");
    // A wall behind the dune, and the eye between the two: what goes through the dune is its height.
    const std::string scene = "AttributeBegin\nAttribute \"visibility\" \"integer transmission\" 1\nAttribute \"shade\" \"string "
                              "transmissionhitmode\" \"shader\"\nSurface \"dune\"\n" +
                              kPatch +
                              "AttributeEnd\nSurface \"through\"\nPatch \"bilinear\" \"P\" [-2 -2 9  2 -2 9  -2 2 9  2 2 9]\n";
    for (const Hider h : kHiders) {
        Scene s(inWorld(scene), withShaders(h));
        const Vec3 at{4 * .6f - 2, 0, 6};
        expectColor(s.one(rayTo(at, at + Vec3(0, 0, 3))), Color(.5f * .6f * .6f), "hider " + std::to_string(int(h)));
    }
}

TEST(LeftMembers, BeginPrintsOnce) {
    writeShader("says", R"(class says() {
    varying float h = 0;
    public void construct() { printf("construct\n"); }
    public void begin() { printf("begin %g\n", u); }
    public void displacement(output point P; output normal N) { h = u; P += vector "camera" (0, 0, -h); }
    public void surface(output color Ci, Oi) { Oi = 1; Ci = h; }
}
)");
    ::testing::internal::CaptureStdout();
    const Color c = seen("Surface \"says\"\n" + kPatch, Hider::Hidden, .5f, .5f);
    const std::string text = ::testing::internal::GetCapturedStdout();
    expectColor(c, Color(.5f), "colour");
    EXPECT_EQ(text, "construct\nbegin 0.5\n");
}

// Two shaders of one class are two objects, and a surface that another displacement moves has no part in its members.
TEST(LeftMembers, OthersKeepTheirOwn) {
    writeShader("dune", kDune);
    writeShader("flat", "displacement flat() { P += vector \"camera\" (0, 0, -.25); }\n");
    for (const char* before : {"Displacement \"flat\"\n", "Displacement \"dune\"\n"})
        expectColor(seen(before + std::string("Surface \"dune\"\n") + kPatch, Hider::Hidden, .6f, .3f), {3, 0, 0}, before);
}

} // namespace leftmembers_test
