// occlusion() with normals that face away from the viewer: its hemisphere is about the normal as given, and where that makes
// primitives black it is said.
#include "command_folder.h"

namespace turnedaway_test {

namespace {

class TurnedAway : public alpenglow::cli::testing::CommandFolder {
protected:
    const std::string ball = "Sphere 1 -1 1 360\n";
    std::string said(const std::string& hider, const std::string& normal, const std::string& world) {
        write("occ.sl", "surface occ() {\n  Oi = 1;\n  Ci = 1 - occlusion(P, " + normal + ", 16);\n}\n");
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

TEST_F(TurnedAway, ThatIsBlackIsSaidAtItsCall) {
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

TEST_F(TurnedAway, WhatIsRightOrNotBlackIsNotSaid) {
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

} // namespace

} // namespace turnedaway_test
