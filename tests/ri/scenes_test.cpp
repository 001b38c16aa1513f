// The eight published scenes of ../shared/scenes: not a word to say, and every primitive there.
#include "collect.h"
#include "scene/scene.h"
#include <filesystem>

namespace scenes_test {

using namespace alpenglow;
using namespace alpenglow::ri;

TEST(PublishedScenes, AreReadWithoutAWarning) {
    const std::string folder = std::string(ALPENGLOW_SOURCE_DIR) + "/../shared/scenes/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "../shared/scenes is not here";
    // Counted in the files by their request names.
    struct {
        const char* name;
        size_t primitives, lights;
        int xres;
    } scenes[] = {{"bulb", 9, 2, 380},    {"cubits", 24, 0, 380}, {"showquads", 6, 1, 640}, {"spot", 2, 2, 640},
                  {"teapot", 10, 2, 640}, {"tetra", 256, 2, 380}, {"uteapot", 32, 4, 320},  {"val_poly", 530, 2, 205}};
    for (auto& s : scenes) {
        Collected c;
        RibReader reader({}, c, c.diagnostics);
        EXPECT_TRUE(reader.readFile(folder + s.name + ".rib")) << s.name;
        EXPECT_EQ(c.diagnostics.errors() + c.diagnostics.warnings(), 0) << s.name << "\n" << c.messages(); // notes may be
        EXPECT_EQ(c.frame().primitives.size(), s.primitives) << s.name;
        EXPECT_EQ(c.frame().lights.size(), s.lights) << s.name;
        EXPECT_EQ(c.frame().options.xres, s.xres) << s.name;
        EXPECT_EQ(c.frame().options.pixelAspect, 1) << s.name;
    }
}

} // namespace scenes_test
