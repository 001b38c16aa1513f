// --allow-exec and the rslplugin search path, as a user meets them. The plug-in is that of examples/plugins.
#include "command_folder.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plugins_test {

namespace fs = std::filesystem;

namespace {

class PluginTools : public alpenglow::cli::testing::CommandFolder {
protected:
    const std::string folder = (fs::path(ALPENGLOW_PROGRAM).parent_path().parent_path() / "plugins").string();
    /// Standard output and errors together.
    std::string run(const std::string& arguments) { return CommandFolder::run(arguments, "2>&1"); }
};

TEST_F(PluginTools, AShaderIsAskedForBeforeItRunsForeignCode) {
    const std::string shader = ALPENGLOW_SOURCE_DIR "/examples/plugins/weave.sl";
    EXPECT_NE(run("compile " + shader).find("[plugin-refused]"), std::string::npos);
    EXPECT_EQ(status, 1);
    EXPECT_NE(run("compile --allow-exec " + shader).find("[plugin-missing]"), std::string::npos);
    EXPECT_EQ(status, 1);
    EXPECT_EQ(run("compile --allow-exec --searchpath '" + folder + "' " + shader), "");
    EXPECT_EQ(status, 0);
    const std::string info = run("info --json --allow-exec --searchpath '" + folder + "' " + shader);
    ASSERT_EQ(status, 0) << info;
    const auto j = nlohmann::json::parse(info);
    ASSERT_EQ(j["plugins"]["weave"].size(), 7u);
    EXPECT_EQ(j["plugins"]["weave"][0]["signature"], "float polynomial(float x; float c[4])");
}

TEST_F(PluginTools, TheSearchPathOfAScene) {
    std::ofstream(dir / "steps.sl") << "plugin \"weave\";\nsurface steps() { Ci = triangle(0.25); Oi = 1; }\n";
    std::ofstream(dir / "a.rib") << "Option \"searchpath\" \"string rslplugin\" [\"" + folder + "\"]\n"
                                 << "Hider \"hidden\"\nFormat 8 8 1\nPixelSamples 1 1\nDisplay \"a.tif\" \"file\" \"rgb\"\n"
                                    "Projection \"orthographic\"\nWorldBegin\nSurface \"steps\"\n"
                                    "Polygon \"P\" [-2 -2 1  2 -2 1  2 2 1  -2 2 1]\nWorldEnd\n";
    EXPECT_NE(run("render -q a.rib --pixel 4,4").find("--allow-exec lets them"), std::string::npos);
    const std::string pixel = run("render -q a.rib --allow-exec --pixel 4,4");
    EXPECT_EQ(status, 0) << pixel;
    EXPECT_NE(pixel.find("0.5"), std::string::npos) << pixel;
}

TEST_F(PluginTools, ALibraryOfProceduralsFindsTheBindingInTheProgram) {
    std::ofstream(dir / "b.rib")
        << "Hider \"hidden\"\nFormat 8 8 1\nPixelSamples 1 1\nDisplay \"b.tif\" \"file\" \"rgb\"\n"
           "Projection \"orthographic\"\nTranslate 0 0 5\nWorldBegin\nColor [0.5 0 0]\nSurface \"constant\"\n"
           "Procedural \"DynamicLoad\" [\"facets\" \"halves .5\"] [-1 1 -1 1 -1 1]\nWorldEnd\n";
    const std::string folder = (fs::path(ALPENGLOW_PROGRAM).parent_path().parent_path() / "procedurals").string();
    EXPECT_NE(run("render b.rib --pixel 4,4").find("it needs --allow-exec"), std::string::npos);
    const std::string pixel = run("render -q b.rib --allow-exec --searchpath '" + folder + "' --pixel 4,4");
    EXPECT_EQ(status, 0) << pixel;
    EXPECT_NE(pixel.find("0.5"), std::string::npos) << pixel;
}

} // namespace

} // namespace plugins_test
