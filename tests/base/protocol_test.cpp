// rsl/front/protocol.h is the only place that writes or takes apart the names that the compiler and its kernels' users agree on.
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <regex>
#include <string>
#include <vector>

namespace protocol_test {

namespace fs = std::filesystem;

namespace {

/// Text literals of a source that are, or begin as, names of the protocol. Comments are left out.
std::vector<std::string> namesIn(const std::string& source) {
    static const std::regex comment(R"(//[^\n]*)"), literal(R"re("((?:[^"\\\n]|\\.)*)")re"),
        name(R"(^(param:|Du:|Dv:|given:|slope:|space:|displacement:|send:light:|surface:|light#|length |begin\(\)|opacity\(\)).*)"
             R"(|^.*this->.*|^__(setup|outside|part|once|uniform|gather|hemisphere|nondiffuse|nonspecular)$)"
             R"(|^__(category|group|sentL|sentCl|sentShadows)$)"
             R"(|^__displacementbound_(sphere|coordinatesystem)$)");
    std::vector<std::string> found;
    const std::string code = std::regex_replace(source, comment, "");
    for (std::sregex_iterator i(code.begin(), code.end(), literal), end; i != end; ++i)
        if (const std::string text = (*i)[1]; std::regex_match(text, name)) found.push_back(text);
    return found;
}

TEST(Protocol, TheScannerFindsNames) {
    EXPECT_EQ(namesIn(R"(x = "param:" + n; if (t.rfind("space:", 0) == 0) f("__nondiffuse");)").size(), 3u);
    EXPECT_EQ(namesIn(R"(report("the space: none"); // "param:Kd"
 f("light:samples"), g("spaces"), h("displacementbound:sphere");)")
                  .size(),
              0u);
}

TEST(Protocol, NamesAreWrittenInOnePlace) {
    // What documents shadeops says what authors of shaders write; the front end reads what they have written.
    const auto exempt = [](const std::string& file) {
        return file.rfind("rsl/front/", 0) == 0 || file.rfind("shadeops/", 0) == 0;
    };
    const fs::path src = fs::path(ALPENGLOW_SOURCE_DIR) / "src";
    int files = 0;
    for (const auto& e : fs::recursive_directory_iterator(src)) {
        const auto ext = e.path().extension();
        const std::string file = fs::relative(e.path(), src).string();
        if ((ext != ".cpp" && ext != ".h") || exempt(file)) continue;
        ++files;
        std::ifstream in(e.path());
        const std::string text(std::istreambuf_iterator<char>(in), {});
        for (const std::string& name : namesIn(text))
            ADD_FAILURE() << file << " writes \"" << name << "\": rsl/front/protocol.h makes such names";
    }
    EXPECT_GT(files, 200);
}

} // namespace

} // namespace protocol_test
