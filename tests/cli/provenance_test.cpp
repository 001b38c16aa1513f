// What made a picture: --version, metadata, --stamp, --stats frame by frame; docs/statistics.md names every key.
#include "command_folder.h"
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

namespace provenance_test {

using Json = nlohmann::json;

namespace {

const char* const kFrames = R"(
Format 16 12 1
Projection "perspective" "fov" 40
Hider "path"
LightSource "distantlight" 1 "to" [0 0 1]
FrameBegin 3
Display "a.exr" "openexr" "rgba,N"
WorldBegin
Translate 0 0 5
Surface "matte"
Sphere 1 -1 1 360
WorldEnd
FrameEnd
FrameBegin 7
Display "b.png" "png" "rgb"
Display "+c.png" "png" "N"
WorldBegin
Translate 0 0 6
Surface "paintedplastic" "texturename" ["skin.tga"]
Sphere 1 -1 1 360
WorldEnd
FrameEnd
)";

class Provenance : public alpenglow::cli::testing::CommandFolder {
protected:
    void SetUp() override {
        CommandFolder::SetUp();
        write("f.rib", kFrames);
        std::string tga(18, '\0'); // true colour, two pixels of 24 bits
        tga[2] = 2, tga[12] = 2, tga[14] = 1, tga[16] = 24;
        write("skin.tga", tga + "bgrBGR");
    }
    std::string run(const std::string& arguments) { return CommandFolder::run(arguments, "2>err"); }
    std::string text(const std::string& name) const { return textOf(dir / name); }
    static std::string textOf(const std::filesystem::path& p) {
        std::ifstream in(p, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// The texts of a PNG.
    std::map<std::string, std::string> textsOf(const std::string& name) const {
        const std::string all = text(name);
        std::map<std::string, std::string> found;
        for (size_t at = 8; at + 12 <= all.size();) {
            size_t n = 0;
            for (size_t k = 0; k < 4; ++k) n = n << 8 | static_cast<unsigned char>(all[at + k]);
            const std::string data = all.substr(at + 8, n);
            if (const size_t zero = data.find('\0'); all.substr(at + 4, 4) == "tEXt" && zero != data.npos)
                found[data.substr(0, zero)] = data.substr(zero + 1);
            at += n + 12;
        }
        return found;
    }
};

/// "rays.camera", ... of an object; of lists the keys of what is in them.
void keysOf(const Json& j, const std::string& before, std::set<std::string>* keys) {
    if (j.is_array())
        for (const Json& item : j) keysOf(item, before, keys);
    if (!j.is_object()) return;
    for (const auto& [key, value] : j.items()) {
        const std::string name = before.empty() || before == "frames" ? key : before + "." + key;
        if (!value.is_object()) keys->insert(name);
        keysOf(value, name, keys);
    }
}

// The firefly control is off unless asked for, and a picture whose samples it cut says so, merged ones too.
TEST_F(Provenance, TheSampleClampIsNamed) {
    run("render -q --frames 7 --spp 2 f.rib");
    EXPECT_FALSE(textsOf("b.png").contains("sampleClamp"));
    run("render -q --frames 7 --spp 2 --sample-clamp 2.5 f.rib");
    EXPECT_EQ(textsOf("b.png")["sampleClamp"], "2.5");
    EXPECT_NE(textsOf("b.png")["options"].find("--sample-clamp 2.5"), std::string::npos);
    write("o.rib", "Format 8 8 1\nHider \"path\"\nWorldBegin\nWorldEnd\n");
    run("render -q --preset slproject --spp 2 -o s.png o.rib");
    EXPECT_EQ(textsOf("s.png")["sampleClamp"], "3");
    run("render -q --samples 0:2 --sample-clamp 2.5 -o p.png o.rib");
    run("merge p.png -o m.png");
    EXPECT_EQ(textsOf("m.png")["sampleClamp"], "2.5");
}

} // namespace

TEST_F(Provenance, VersionNamesTheCommit) {
    const std::string version = run("--version");
    EXPECT_TRUE(std::regex_match(version, std::regex("alpenglow [0-9]+\\.[0-9]+\\.[0-9]+( \\([0-9a-f]+\\+?\\))?\n"
                                                     "  LLVM       19\\.[0-9.]+\n"
                                                     "  processor  x86-64-v[234], [0-9]+ threads?, 16 lanes \\([a-z0-9.+]+\\)\n"
                                                     "  shaders    /.*/shaders\n"
                                                     "  modules    /.*/libalpenglow_jit\\.so\n(             /.*\\.so\n)*")))
        << version;
    // Without the shader compiler's module it says why.
    setenv("ALPENGLOW_JIT", "/nowhere.so", 1);
    EXPECT_NE(run("--version")
                  .find("LLVM       none: the shader compiler's module libalpenglow_jit.so cannot be loaded: "
                        "ALPENGLOW_JIT names no file\n"),
              std::string::npos);
    EXPECT_EQ(status, 0);
    unsetenv("ALPENGLOW_JIT");
}

TEST_F(Provenance, PicturesSayWhatMadeThem) {
    run("render -q --spp 8 --max-depth 3 --gamma 1.5 --seed 4 --threads 2 --stats s.json f.rib");
    ASSERT_EQ(status, 0) << text("err");
    auto m = textsOf("b.png");
    EXPECT_TRUE(run("--version").starts_with("alpenglow" + m["Software"].substr(9) + "\n"));
    EXPECT_EQ(m["scene"], "f.rib");
    EXPECT_EQ(m["frame"], "7");
    EXPECT_EQ(m["fov"], "40");
    EXPECT_EQ(m["options"], "--max-depth 3 --gamma 1.5");
    EXPECT_EQ(m["seed"], "4");
    EXPECT_EQ(m["sceneHash"].size(), 16u);
    for (const char* key : {"host", "date", "seconds", "command", "threads"}) EXPECT_EQ(m.count(key), 0u) << key;
    const std::string exr = text("a.exr").substr(0, 4000), hash = Json::parse(text("s.json"))["frames"][0]["sceneHash"];
    for (const std::string& part : {m["Software"], std::string("f.rib"), hash, m["options"]})
        EXPECT_NE(exr.find(part), std::string::npos) << part;
    EXPECT_NE(hash, m["sceneHash"]) << "another frame is another scene";
    // Other threads, another time, parts: the same bytes.
    const std::string before = text("b.png");
    run("render -q --spp 8 --max-depth 3 --gamma 1.5 --seed 4 --threads 1 f.rib");
    EXPECT_TRUE(text("b.png") == before);
}

TEST_F(Provenance, StampsSayWhenAndWhere) {
    run("render -q --spp 4 f.rib");
    auto plain = textsOf("b.png");
    run("render -q --spp 4 --threads 1 --stamp f.rib");
    auto m = textsOf("b.png");
    EXPECT_NE(m["command"].find("render -q --spp 4 --threads 1 --stamp f.rib"), std::string::npos) << m["command"];
    EXPECT_TRUE(std::regex_match(m["date"], std::regex("[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z"))) << m["date"];
    EXPECT_GE(std::stod(m["seconds"]), 0);
    EXPECT_EQ(m["threads"], "1");
    for (const auto& [key, value] : plain) EXPECT_EQ(m[key], value) << key;
}

TEST_F(Provenance, StatisticsFrameByFrame) {
    run("render -q --spp 8 --stats s.json f.rib");
    const Json j = Json::parse(text("s.json"));
    ASSERT_EQ(j["frames"].size(), 2u);
    const Json &a = j["frames"][0], &b = j["frames"][1];
    EXPECT_EQ(a["frame"], 3);
    EXPECT_EQ(b["frame"], 7);
    EXPECT_EQ(a["scene"], "f.rib");
    ASSERT_EQ(a["pictures"].size(), 1u);
    EXPECT_EQ(a["pictures"][0]["file"], "a.exr");
    EXPECT_EQ(a["pictures"][0]["channels"], Json({"r", "g", "b", "a", "N.x", "N.y", "N.z"}));
    ASSERT_EQ(b["pictures"].size(), 2u);
    EXPECT_EQ(b["pictures"][1]["file"], "c.png");
    EXPECT_EQ(a["textures"], Json::array());
    ASSERT_EQ(b["textures"].size(), 1u);
    EXPECT_EQ(std::filesystem::path(std::string(b["textures"][0]["file"])).filename(), "skin.tga");
    EXPECT_EQ(b["textures"][0]["fileBytes"], 18 + 6);
    EXPECT_GE(b["textures"][0]["memoryBytes"], 6 + 12) << "codes of two pixels, and numbers of one";
    EXPECT_EQ(b["textures"][0]["scratchBytes"], 0);
    EXPECT_EQ(a["rays"]["camera"], 16 * 12 * 8);
    EXPECT_EQ(j["rays"]["camera"], 2 * 16 * 12 * 8) << "the run has the sums";
    EXPECT_GT(double(a["coverage"]), double(b["coverage"])) << "each frame its own";
    EXPECT_EQ(j["coverage"], b["coverage"]) << "the run has the last frame's";
    for (const char* key : {"totalRays", "renderSec", "buildSec", "nonFinite"})
        EXPECT_NEAR(double(j[key]), double(a[key]) + double(b[key]), 1e-9 * double(j[key])) << key;
    EXPECT_NE(std::string(j["command"]).find("--stats s.json f.rib"), std::string::npos);
}

TEST_F(Provenance, EveryKeyIsInTheManual) {
    run("render -q --spp 8 --stats s.json f.rib");
    std::set<std::string> written, documented;
    keysOf(Json::parse(text("s.json")), "", &written);
    const std::string page = textOf(ALPENGLOW_SOURCE_DIR "/docs/statistics.md"),
                      json = page.substr(0, page.find("## In the pictures"));
    const std::regex row("\\n\\| (`[^|]*`) \\|"), name("`([A-Za-z0-9.]+)`"),
        inText("(?:what was written|the maps that were read): (.*) \\|");
    for (std::sregex_iterator i(json.begin(), json.end(), row), end; i != end; ++i) {
        const std::string cell = (*i)[1];
        for (std::sregex_iterator k(cell.begin(), cell.end(), name); k != end; ++k) documented.insert((*k)[1]);
    }
    for (std::sregex_iterator i(json.begin(), json.end(), inText), end; i != end; ++i) {
        const std::string cell = (*i)[1];
        for (std::sregex_iterator k(cell.begin(), cell.end(), name); k != end; ++k) documented.insert((*k)[1]);
    }
    EXPECT_EQ(written, documented);
    for (const auto& [key, value] : textsOf("b.png"))
        EXPECT_NE(page.substr(page.find("## In the pictures")).find("`" + key + "`"), std::string::npos) << key;
}

} // namespace provenance_test
