// .alpenglowrc and the environment variables of other renderers: where they are looked for, what they may do, what is reported.
#include "command_folder.h"
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

namespace rcfile_test {

namespace {

/// Sets a variable for the length of a test.
class Variable {
public:
    Variable(std::string name, const std::string& value) : name_(std::move(name)) {
        if (const char* before = std::getenv(name_.c_str())) before_ = before;
        value.empty() ? unsetenv(name_.c_str()) : setenv(name_.c_str(), value.c_str(), 1);
    }
    ~Variable() { before_ ? setenv(name_.c_str(), before_->c_str(), 1) : unsetenv(name_.c_str()); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    std::string name_;
    std::optional<std::string> before_;
};

class RcFile : public alpenglow::cli::testing::CommandFolder {
protected:
    std::optional<Variable> rc, home, config;
    void SetUp() override {
        CommandFolder::SetUp();
        std::filesystem::create_directories(dir / "home" / ".config" / "alpenglow");
        std::filesystem::create_directories(dir / "work");
        rc.emplace("ALPENGLOW_RC", "");
        home.emplace("HOME", (dir / "home").string());
        config.emplace("XDG_CONFIG_HOME", "");
        write("work/a.rib", "Display \"a.exr\" \"openexr\" \"rgb\"\nPixelSamples 1 1\nWorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
    }
    std::string run(const std::string& arguments) { return CommandFolder::run("render --cwd work " + arguments, "2>err"); }
    std::string errors() const {
        std::ifstream in(dir / "err", std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    bool says(const std::string& words) const { return errors().find(words) != std::string::npos; }
    /// Width of the picture and its threads, by --stats.
    std::pair<int, int> rendered(const std::string& options = "") {
        run("--stats s.json " + options + " a.rib");
        EXPECT_EQ(status, 0) << errors();
        std::ifstream in(dir / "work" / "s.json");
        const auto j = nlohmann::json::parse(in, nullptr, false);
        return j.is_object() ? std::pair{j.value("width", 0), j.value("threads", 0)} : std::pair{0, 0};
    }
};

} // namespace

TEST_F(RcFile, LaterOnesHaveTheLastWord) {
    EXPECT_EQ(rendered().first, 640);
    write("home/.config/alpenglow/alpenglowrc", "--threads 2\nFormat 10 10 1\nOption \"user\" \"float x\" 1\n");
    EXPECT_EQ(rendered(), (std::pair{10, 2}));
    EXPECT_TRUE(says("alpenglow/alpenglowrc: note: it is read before the scene; --no-rc leaves it out")) << errors();
    EXPECT_TRUE(says("note: .alpenglowrc adds --threads 2")) << errors();
    write("home/.alpenglowrc", "# mine\n  --threads 1\nFormat 20 20 1\n");
    EXPECT_EQ(rendered(), (std::pair{20, 1}));
    write("work/.alpenglowrc", "Format 30 30 1\n");
    EXPECT_EQ(rendered(), (std::pair{30, 1}));
    EXPECT_EQ(rendered("--threads 2 --format 40x40"), (std::pair{40, 2})); // the command line
    EXPECT_EQ(rendered("--rib 'Format 35 35 1'").first, 35);
    write("work/a.rib", "Format 50 50 1\nPixelSamples 1 1\nDisplay \"a.exr\" \"openexr\" \"rgb\"\nWorldBegin\nWorldEnd\n");
    EXPECT_EQ(rendered().first, 50); // the scene
}

TEST_F(RcFile, AnotherPlaceByTheEnvironment) {
    write("home/.config/alpenglow/alpenglowrc", "Format 10 10 1\n");
    std::filesystem::create_directories(dir / "other" / "alpenglow");
    write("other/alpenglow/alpenglowrc", "Format 11 11 1\n");
    const Variable other("XDG_CONFIG_HOME", (dir / "other").string());
    EXPECT_EQ(rendered().first, 11);
    write("one.rc", "Format 12 12 1\n");
    const Variable one("ALPENGLOW_RC", (dir / "one.rc").string());
    EXPECT_EQ(rendered().first, 12);
    const Variable off("ALPENGLOW_RC", "off");
    EXPECT_EQ(rendered().first, 640);
    EXPECT_FALSE(says("note:")) << errors();
}

TEST_F(RcFile, IsLeftOut) {
    write("home/.alpenglowrc", "--threads 1\nFormat 20 20 1\n");
    write("work/.alpenglowrc", "Format 30 30 1\n");
    EXPECT_EQ(rendered("--no-rc").first, 640);
    EXPECT_FALSE(says(".alpenglowrc")) << errors();
}

// A folder may be anybody's: what lies in it can say what a scene can, and no more.
TEST_F(RcFile, OfTheFolderHoldsNoOptions) {
    write("work/.alpenglowrc", "\n--allow-exec\nFormat 30 30 1\n");
    EXPECT_EQ(rendered().first, 30);
    EXPECT_TRUE(says(".alpenglowrc:2:1: warning: options are read from ~/.alpenglowrc only")) << errors();
}

TEST_F(RcFile, FaultsAreTold) {
    write("home/.alpenglowrc", "--threads 1\n\nFormat 20 20 1\nSides 3\n");
    run("a.rib");
    EXPECT_EQ(status, 1);
    EXPECT_TRUE(says(".alpenglowrc:4:1: error: Sides: it is 1 or 2")) << errors(); // lines count from the file's first
    write("home/.alpenglowrc", "--nosuch\n");
    run("a.rib");
    EXPECT_EQ(status, 2);
    EXPECT_TRUE(says("note: .alpenglowrc adds --nosuch")) << errors();
    EXPECT_TRUE(says("render has no option --nosuch")) << errors();
}

namespace {
/// A folder with a shader that gives this colour.
void shaderFolder(const std::filesystem::path& folder, const std::string& name, const std::string& colour) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / (name + ".sl")) << "surface " << name << "() { Oi = 1; Ci = color(" << colour << "); }\n";
}
} // namespace

TEST_F(RcFile, VariablesFindWhatIsNowhereElse) {
    const auto scene = [&](const std::string& shader) {
        write("work/a.rib", "Format 4 4 1\nDisplay \"a.exr\" \"openexr\" \"rgb\"\nPixelSamples 1 1\nWorldBegin\nSurface \"" +
                                shader + "\"\nTranslate 0 0 9\nSphere 8 -8 8 360\nWorldEnd\n");
    };
    const auto pixel = [&] { return CommandFolder::run("render --cwd work --pixel 2,2 a.rib", "2>err"); };
    shaderFolder(dir / "env", "nowhere", "1, 0, 0");
    shaderFolder(dir / "env", "mine", "1, 0, 0");
    shaderFolder(dir / "env", "constant", "1, 0, 0");
    shaderFolder(dir / "work", "mine", "0, 1, 0");
    for (const char* name : {"RMAN_SHADERPATH", "SHADERS", "DL_SHADERS_PATH", "AQSIS_SHADER_PATH"}) {
        scene("nowhere");
        pixel();
        EXPECT_EQ(status, 1) << name << errors(); // there is no such shader
        const Variable v(name, "@:" + (dir / "env").string() + ":/not/there");
        EXPECT_EQ(pixel(), "1 0 0 1\n") << name << errors();
        scene("mine"); // the scene's own
        EXPECT_EQ(pixel(), "0 1 0 1\n") << name;
        scene("constant"); // the shipped one
        EXPECT_EQ(pixel(), "1 1 1 1\n") << name;
        run("-v --stats s.json a.rib");
        EXPECT_TRUE(says(std::string("note: $") + name + " names folders that are searched last: @:" + (dir / "env").string()))
            << errors();
        std::ifstream in(dir / "work" / "s.json");
        EXPECT_EQ(nlohmann::json::parse(in).at("environment"), name + ("=@:" + (dir / "env").string() + ":/not/there"));
    }
    shaderFolder(dir / "tree" / "lib" / "shaders", "nowhere", "0, 0, 1");
    scene("nowhere");
    const Variable tree("RMANTREE", (dir / "tree").string());
    EXPECT_EQ(pixel(), "0 0 1 1\n") << errors();
}

TEST_F(RcFile, VariablesForArchives) {
    std::filesystem::create_directories(dir / "ribs");
    write("ribs/ball.rib", "Translate 0 0 9\nSphere 8 -8 8 360\n");
    write("work/a.rib", "Format 4 4 1\nDisplay \"a.exr\" \"openexr\" \"rgb\"\nWorldBegin\nSurface \"constant\"\nReadArchive "
                        "\"ball.rib\"\nWorldEnd\n");
    const auto pixel = [&] { return CommandFolder::run("render --cwd work --pixel 2,2 a.rib", "2>err"); };
    EXPECT_EQ(pixel(), "0 0 0 0\n");
    for (const char* name : {"RMAN_ARCHIVEPATH", "ARCHIVES", "RIBS", "DL_RIBS_PATH", "DL_ARCHIVES_PATH", "AQSIS_ARCHIVE_PATH"}) {
        const Variable v(name, (dir / "ribs").string());
        EXPECT_EQ(pixel(), "1 1 1 1\n") << name << errors();
        EXPECT_EQ(status, 0);
    }
}

// The manual has the same table: sorted, with a sentence for each.
TEST_F(RcFile, VariablesStandInTheManual) {
    const std::string page = CommandFolder::run("info --options --markdown", "2>err");
    const size_t from = page.find("| variable | of | here |");
    ASSERT_NE(from, page.npos);
    std::istringstream rows(page.substr(from));
    std::string last, row;
    std::getline(rows, row);
    std::getline(rows, row);
    int n = 0;
    for (; std::getline(rows, row) && row.starts_with("| "); ++n) {
        const std::string name = row.substr(2, row.find(" |") - 2), what = row.substr(row.find(" | ", 2 + name.size() + 3) + 3);
        EXPECT_LT(last, name);
        EXPECT_TRUE(what.find("searched last.") != what.npos || what.find("Does nothing: ") != what.npos) << row;
        last = name;
    }
    EXPECT_GT(n, 20);
}

} // namespace rcfile_test
