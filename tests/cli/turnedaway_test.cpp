// occlusion(), indirectdiffuse() and gather() with normals that face away from the viewer: its hemisphere is about the normal as
// given, and where that makes primitives black it is said.
#include "command_folder.h"

namespace turnedaway_test {

namespace {

class FlippedNormals : public alpenglow::cli::testing::CommandFolder {
protected:
    const std::string ball = "Sphere 1 -1 1 360\n";
    std::string said(const std::string& hider, const std::string& normal, const std::string& world) {
        return shown(hider, "1 - occlusion(P, " + normal + ", 16)", world);
    }
    /// `call`: a colour; `h` and `sum` are colours, and `n` the normal as it is.
    std::string shown(const std::string& hider, const std::string& call, const std::string& world,
                      const std::string& before = "") {
        write("occ.sl", "surface occ() { color h = 0, sum = 0; normal n = normalize(N);\n  Oi = 1; " + before +
                            "\n  Ci = " + call + ";\n}\n");
        write("a.rib", "Format 16 16 1\nPixelSamples 2 2\nHider \"" + hider +
                           "\"\nDisplay \"a.exr\" \"openexr\" \"rgba\"\nProjection \"perspective\" \"fov\" 40\nTranslate 0 0 4\n"
                           "WorldBegin\nSurface \"occ\"\n" +
                           world + "WorldEnd\n");
        return run("render a.rib", "2>&1");
    }
    static size_t times(const std::string& text) {
        size_t n = 0;
        for (size_t at = 0; (at = text.find("faces away from the viewer", at)) != text.npos; ++at) ++n;
        return n;
    }
};

TEST_F(FlippedNormals, ThatIsBlackIsSaidAtItsCall) {
    for (const char* hider : {"hidden", "raytrace", "path"}) {
        const std::string one = said(hider, "normalize(N)", "ReverseOrientation\n" + ball);
        EXPECT_EQ(times(one), 1u) << hider << one;
        EXPECT_NE(one.find("occ.sl:3:12: warning"), std::string::npos) << one;
        const std::string two =
            said(hider, "N", ball + "TransformBegin Translate 2 0 0 ReverseOrientation\n" + ball + "TransformEnd\n");
        EXPECT_EQ(times(two), 1u) << hider << two;
        EXPECT_NE(two.find("a primitive (a.rib:11)"), std::string::npos) << two;
    }
}

TEST_F(FlippedNormals, WhatIsRightOrNotBlackIsNotSaid) {
    const std::string wall = "Polygon \"P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]\n";
    for (const char* hider : {"hidden", "raytrace", "path"})
        for (const auto& [normal, world] : {std::pair<std::string, std::string>{"normalize(N)", ball},
                                            {"faceforward(normalize(N), I)", "ReverseOrientation\n" + ball},
                                            {"faceforward(normalize(N), I)", ball},
                                            {"normalize(N)", wall},
                                            {"normalize(N)", "ReverseOrientation\n" + wall},
                                            {"-normalize(N)", wall}}) {
            const std::string text = said(hider, normal, world);
            EXPECT_EQ(times(text), 0u) << hider << normal << text;
        }
}

// A ball that looks into itself is black under the brightest sky, which is not what its author meant. What faces the viewer, lies
// open or refracts gets no note.
TEST_F(FlippedNormals, WhatLooksForLightInsideOfItself) {
    const std::string sky = "LightSource \"envlight\" 1\n", turned = sky + "ReverseOrientation\n" + ball;
    const std::string gathers = "float deep = 0; rayinfo(\"depth\", deep); if (deep == 0) { gather(\"illuminance\", P, n, PI / "
                                "2, 8, \"surface:Ci\", h) sum += h / 8; else sum += .1; }";
    const std::string refracts =
        "gather(\"illuminance\", P, refract(normalize(I), -n, .7), 0, 8, \"surface:Ci\", h) sum += h / 8;";
    for (const char* hider : {"hidden", "raytrace", "path"}) {
        const std::string one = shown(hider, "indirectdiffuse(P, n, 16)", turned);
        EXPECT_EQ(times(one), 1u) << hider << one;
        EXPECT_NE(one.find("occ.sl:3:8: warning: indirectdiffuse(): all over a primitive (a.rib:11)"), std::string::npos) << one;
        EXPECT_NE(one.find("faceforward(normalize(N), I)"), std::string::npos) << one;
        const std::string two = shown(hider, "sum", turned, gathers);
        EXPECT_EQ(times(two), 1u) << hider << two;
        EXPECT_NE(two.find("warning: gather(): all over a primitive"), std::string::npos) << two;
        const std::string wall = sky + "Polygon \"P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]\n";
        for (const std::string& silent :
             {shown(hider, "indirectdiffuse(P, n, 16)", sky + ball),
              shown(hider, "indirectdiffuse(P, faceforward(n, I), 16)", turned), shown(hider, "indirectdiffuse(P, n, 16)", wall),
              shown(hider, "sum", sky + ball, gathers), shown(hider, "sum", turned, refracts)})
            EXPECT_EQ(times(silent), 0u) << hider << silent;
    }
}

} // namespace

} // namespace turnedaway_test
