// I, E and depths: I is P - E though camera rays begin at the near plane (RISpec 3.2, table 12.1), behind transparent surfaces
// too; what displacements and lights ask of depth() and ptlined().
#include "integrator/floorscene.h"
#include "render/camera.h"
#include "scene/scene.h"

namespace eye_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// The colour in the middle of the frame, by the camera of the scene.
Color middle(const std::string& options, const std::string& inside, Hider hider = Hider::Raytrace) {
    Scene s("Format 64 64 1\n" + options + "WorldBegin\nSides 2\n" + inside + "WorldEnd\n", withShaders(hider));
    Diagnostics d;
    const render::Camera camera(s.frame->options, d);
    return s.one(camera.ray(48, 32, {.5f, .5f}, 0)); // x = 1/2 of the way to the right
}
void expectColor(const Color& c, const Color& want, const std::string& what, float error = 1e-5f) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], error) << what << ", channel " << k;
}
/// A wall at depth z.
std::string wall(float z, const std::string& before, int half = 99) {
    const std::string d = " " + std::to_string(z) + " ", to = std::to_string(half), from = "-" + to, space = " ";
    return "AttributeBegin " + before + " Polygon \"P\" [" + from + space + from + d + from + space + to + d + to + space + to +
           d + to + space + from + d + "] AttributeEnd\n";
}

TEST(Eye, IncidentVectorsOfCameras) {
    writeShader("eyes", "surface eyes(float what = 0) { Oi = 1; point p = P - I;\n"
                        "    Ci = (what == 0) ? color(xcomp(I), ycomp(I), zcomp(I)) : (what == 1) ? color(xcomp(E), ycomp(E), "
                        "zcomp(E)) : color(xcomp(p), ycomp(p), zcomp(p)); }\n");
    const std::string eyes = "Surface \"eyes\" \"float what\" ";
    for (const char* near : {"", "Clipping 2 100\n", "Clipping .001 9\n"}) {
        // Field of view 90: the ray goes through (.5, 0, 1) and meets the wall at (4, 0, 8).
        const std::string perspective = std::string("Projection \"perspective\" \"fov\" 90\n") + near,
                          flat = std::string("Projection \"orthographic\"\n") + near;
        expectColor(middle(perspective, wall(8, eyes + "0")), {4, 0, 8}, std::string("I ") + near, 1e-4f);
        expectColor(middle(perspective, wall(8, eyes + "1")), {0, 0, 0}, std::string("E ") + near, 0);
        expectColor(middle(perspective, wall(8, eyes + "2")), {0, 0, 0}, std::string("P - I ") + near, 2e-6f);
        // Parallel rays look along z from the plane of the eye.
        expectColor(middle(flat, wall(8, eyes + "0")), {0, 0, 8}, std::string("parallel I ") + near, 1e-4f);
        expectColor(middle(flat, wall(8, eyes + "2")), {.5f, 0, 0}, std::string("parallel P - I ") + near, 1e-5f);
        // Seen through something that is not opaque.
        const std::string glass = wall(4, "Surface \"constant\" Color 0 0 0 Opacity .5 .5 .5");
        expectColor(middle(perspective, glass + wall(8, eyes + "0")), {2, 0, 4}, std::string("behind glass ") + near, 1e-4f);
        expectColor(middle(flat, glass + wall(8, eyes + "0")), {0, 0, 4}, std::string("parallel, behind glass ") + near, 1e-4f);
    }
    // The direction that rayinfo() gives is that of I; a moving eye has its own.
    writeShader("way", "surface way() { float l = 0; point o = 0; rayinfo(\"length\", l); rayinfo(\"origin\", o); Oi = 1; Ci = "
                       "color(l, xcomp(o), zcomp(o)); }\n");
    expectColor(middle("Projection \"perspective\" \"fov\" 90\nClipping 2 100\n", wall(8, "Surface \"way\"")),
                {std::sqrt(80.f), 0, 0}, "rayinfo", 1e-4f);
    expectColor(middle("Projection \"orthographic\"\nClipping 2 100\n", wall(8, "Surface \"way\"")), {8, .5f, 0},
                "rayinfo, parallel", 1e-4f);
}

TEST(Eye, SecondaryRays) {
    // A mirror at depth 4 sends the ray back to a wall behind the eye: I there is the way from the mirror, E the point that sent
    // it.
    writeShader("seen", "surface seen(float what = 0) { Oi = 1; Ci = (what == 0) ? color(xcomp(I), 0, -zcomp(I)) : "
                        "color(xcomp(E), 0, zcomp(E)); }\n");
    writeShader("sends", "surface sends() { Oi = 1; Ci = trace(P, reflect(normalize(I), normalize(N))); }\n");
    const std::string begin = "Projection \"perspective\" \"fov\" 90\nClipping 1 100\n", mirror = wall(4, "Surface \"sends\"");
    expectColor(middle(begin, mirror + wall(-4, "Surface \"seen\"")), {4, 0, 8}, "I", 1e-3f);
    expectColor(middle(begin, mirror + wall(-4, "Surface \"seen\" \"float what\" 1")), {2, 0, 4}, "E", 1e-3f);
    // Fog takes its way from I: between the eye and the wall, and between the mirror and what it shows.
    writeShader("haze", "volume haze() { float f = 1 - length(I) / 100; Ci = f * Ci; }\n");
    const std::string lit = "Surface \"constant\" Color 1 1 1 Atmosphere \"haze\"";
    expectColor(middle(begin, wall(8, lit)), Color(1 - std::sqrt(80.f) / 100), "volume", 1e-5f);
    expectColor(middle(begin, mirror + wall(-4, lit)), Color(1 - std::sqrt(80.f) / 100), "volume behind a mirror", 1e-4f);
    expectColor(middle("Projection \"orthographic\"\nClipping 1 100\n", wall(8, lit)), Color(1 - 8 / 100.f), "volume, parallel",
                1e-5f);
}

TEST(Eye, DepthAndLinesInDisplacementsAndLights) {
    // depth() goes from the near plane, 0, to the far one, 1. A displacement that pushes by it, along z away from the eye.
    writeShader("pushes", "displacement pushes() { P += depth(P) * vector \"camera\" (0, 0, 1); }\n");
    writeShader("tells", "surface tells() { Oi = 1; Ci = zcomp(transform(\"camera\", P)); }\n");
    const std::string
        begin = "Projection \"perspective\" \"fov\" 90\nClipping 2 10\n",
        bound = "ShadingRate 64 Attribute \"displacementbound\" \"float sphere\" 2 \"string coordinatesystem\" \"camera\" ";
    expectColor(middle(begin, wall(8, bound + "Displacement \"pushes\" Surface \"tells\"", 9)), Color(8.75f),
                "depth in a displacement", 1e-4f);
    writeShader("pushline", "displacement pushline() { P += min(1, ptlined(point \"camera\" (4, -50, 8), point \"camera\" (4, "
                            "50, 8), transform(\"current\", \"camera\", P)) / 2) * vector \"camera\" (0, 0, 1); }\n");
    expectColor(middle("Projection \"orthographic\"\n", wall(8, bound + "Displacement \"pushline\" Surface \"tells\"", 9)),
                Color(9), "ptlined in a displacement", 1e-3f);
    // A light whose colour is the depth of the lit point, and one that is a tube.
    writeShader("deep", "light deep() { illuminate(point \"camera\" (4, 0, 7)) Cl = depth(Ps); }\n");
    writeShader("tube", "light tube() { illuminate(point \"camera\" (4, 0, 7)) Cl = 1 / ptlined(point \"camera\" (0, -3, 8), "
                        "point \"camera\" (0, 3, 8), Ps); }\n");
    const std::string matte = "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1";
    expectColor(middle(begin, "LightSource \"deep\" 1\n" + wall(8, matte), Hider::Hidden), Color(.75f), "depth in a light",
                1e-4f);
    expectColor(middle(begin, "LightSource \"tube\" 1\n" + wall(8, matte), Hider::Hidden), Color(.25f), "ptlined in a light",
                1e-4f);
}

} // namespace

} // namespace eye_test
