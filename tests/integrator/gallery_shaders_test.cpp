// Every shader that ships, in shaders/ and examples/shaders/: compiles without a warning, says in its header comment what it is,
// and shades a ball (examples/shaders/ball.rib) without a message and without a number that is none.
#include "integrator/harness.h"
#include <regex>

namespace gallery_shaders_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kRoot = ALPENGLOW_SOURCE_DIR;

std::vector<std::string> shaderFiles() {
    std::vector<std::string> all;
    for (const char* folder : {"/shaders", "/examples/shaders"})
        for (const auto& f : std::filesystem::directory_iterator(kRoot + folder))
            if (f.path().extension() == ".sl" &&
                !std::regex_search(readText(f.path()), std::regex("(^|\n)\\s*plugin\\b"))) // plug-ins have their own test
                all.push_back(f.path());
    std::sort(all.begin(), all.end());
    return all;
}

/// The file without comments, strings and lines of the preprocessor.
std::string codeOf(const std::string& text) {
    std::string code = text;
    for (const char* what : {"/\\*([^*]|\\*+[^*/])*\\*+/", "\"[^\"\n]*\"", "(^|\n)[ \t]*#[^\n]*"})
        code = std::regex_replace(code, std::regex(what), " ");
    return code;
}
/// Kind and name.
std::pair<std::string, std::string> shaderOf(const std::string& text) {
    std::smatch m;
    const std::string code = codeOf(text);
    return std::regex_search(code, m, std::regex("\\b(surface|displacement|light|volume|imager|class)\\s+(\\w+)\\s*\\("))
               ? std::pair{m[1].str(), m[2].str()}
               : std::pair<std::string, std::string>();
}
/// What follows a word of the header comment on its line: RIB requests (scripts/shader_gallery).
std::string requests(const std::string& text, const std::string& word) {
    size_t at = text.find(" " + word + ": ");
    if (at == std::string::npos) return "";
    at += word.size() + 3;
    return text.substr(at, std::min(text.find("*/", at), text.find('\n', at)) - at);
}
std::string sceneOf(const std::string& name, const std::string& kind, const std::string& text) {
    const std::string ball = requests(text, "Ball"), lamp = requests(text, "Lamp");
    const auto lampOf = [](const std::string& r) {
        return "TransformBegin ConcatTransform [0.8 0 -0.6 0  0.37482 0.78087 0.49976 0  0.46852 -0.6247 0.6247 0  -3 4 -4 1]\n" +
               r + "\nTransformEnd\n";
    };
    std::map<std::string, std::string> part = {
        {"options", ""},
        {"world", ""},
        {"surface", ""},
        {"lamp", lampOf(lamp.empty() ? "LightSource \"pointlight\" \"key\" \"float intensity\" 38" : lamp)}};
    const auto or_ = [](const std::string& a, const std::string& b) { return a.empty() ? b : a; };
    if (kind == "light") part["lamp"] = !ball.empty() ? ball : lampOf(or_(lamp, "LightSource \"" + name + "\" \"key\""));
    else if (kind == "imager") part["options"] = or_(ball, "Imager \"" + name + "\"");
    else if (kind == "volume") part["world"] = or_(ball, "Atmosphere \"" + name + "\"");
    else if (kind == "displacement")
        part["surface"] = or_(ball, "Displacement \"" + name + "\"") + " Attribute \"displacementbound\" \"float sphere\" [0.4]";
    else part["surface"] = or_(ball, "Surface \"" + name + "\"");
    std::string rib = readText(kRoot + "/examples/shaders/ball.rib");
    for (const auto& [word, text2] : part) {
        const size_t at = rib.find("#@" + word);
        EXPECT_NE(at, std::string::npos) << word;
        if (at != std::string::npos) rib.replace(at, word.size() + 2, text2);
    }
    return rib;
}

class GalleryShader : public ::testing::TestWithParam<std::string> {};

TEST_P(GalleryShader, ShadesABall) {
    const std::string text = readText(GetParam());
    const auto [kind, name] = shaderOf(text);
    ASSERT_FALSE(name.empty());
    EXPECT_EQ(std::filesystem::path(GetParam()).stem(), name);
    EXPECT_TRUE(text.rfind("/* " + name + ": ", 0) == 0 || text.find("/* " + name + ": ") != std::string::npos)
        << "a header comment says what it is";
    Settings set;
    set.hider = Hider::Path;
    set.shaderPaths.push_back(kRoot + "/examples/shaders");
    set.shaderPaths.push_back(kRoot + "/shaders");
    Scene s(sceneOf(name, kind, text), set);
    std::vector<CameraRay> rays;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) { // the window of the ball's camera: fov 27
            CameraRay r = rayTo({0, 0, 0}, {(float(x) - 7.5f) / 8 * .24f, (7.5f - float(y)) / 8 * .24f, 1});
            r.px = x;
            r.py = y;
            rays.push_back(r);
        }
    const std::vector<SampleResult> samples = s.trace(rays);
    double sum = 0;
    for (const SampleResult& r : samples)
        for (int k = 0; k < 3; ++k) {
            EXPECT_TRUE(std::isfinite(r.color[k]));
            sum += r.color[k];
        }
    EXPECT_GT(sum, 1) << "the picture is black";
    if (kind == "imager") {
        float x[4] = {.5f, 64.5f, 100.5f, 127.5f}, y[4] = {.5f, 64.5f, 30.5f, 127.5f}, r[4] = {.5f, .5f, .2f, .9f},
              g[4] = {.5f, .1f, .2f, .9f}, b[4] = {.5f, .5f, .9f, .9f}, a[4] = {1, 1, .5f, 0};
        EXPECT_TRUE(s.world->runImager(4, x, y, r, g, b, a, s.diagnostics));
        for (int k = 0; k < 4; ++k)
            EXPECT_TRUE(std::isfinite(r[k]) && std::isfinite(g[k]) && std::isfinite(b[k]) && std::isfinite(a[k]));
    }
    for (const Diagnostic& d : s.diagnostics.all())
        if (d.severity != Severity::Info) ADD_FAILURE() << toString(d);
}

INSTANTIATE_TEST_SUITE_P(All, GalleryShader, ::testing::ValuesIn(shaderFiles()),
                         [](const ::testing::TestParamInfo<std::string>& p) {
                             return std::filesystem::path(p.param).stem().string();
                         });

TEST(Gallery, ShowsAtLeastFortyAndAllAreListed) {
    const auto files = shaderFiles();
    EXPECT_GE(files.size(), 40u);
    const std::string page = readText(kRoot + "/docs/gallery.md");
    for (const std::string& f : files) {
        const std::string name = std::filesystem::path(f).stem();
        EXPECT_NE(page.find("`" + name + "`"), std::string::npos) << name << " is not in docs/gallery.md";
    }
}

} // namespace

} // namespace gallery_shaders_test
