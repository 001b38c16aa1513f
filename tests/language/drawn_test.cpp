// random() where there is no scene: a number for each call of the text and each turn of a loop, the same whenever it is asked
// again.
#include "rsl/compiler.h"
#include "rsl/evaluate.h"
#include <gtest/gtest.h>
#include <set>

namespace alpenglow::rsl::drawn_test {
namespace {

std::vector<std::string> printed(const std::string& setup) {
    ShaderCompiler compiler;
    Diagnostics d;
    const Evaluation r = evaluate(compiler, setup, "0", {}, d);
    EXPECT_EQ(d.errors(), 0);
    std::vector<std::string> words;
    std::istringstream in(r.printed);
    for (std::string w; in >> w;) words.push_back(w);
    return words;
}

TEST(Drawn, EveryTurnAndEveryCallHasItsOwn) {
    const char* text = "float one() { return random(); } float i; for (i = 0; i < 8; i += 1) printf(\"%.7f %.7f \", random(), "
                       "one()); printf(\"%.7f\", one());";
    const auto words = printed(text);
    ASSERT_EQ(words.size(), 17u);
    EXPECT_EQ(std::set<std::string>(words.begin(), words.end()).size(), 17u);
    for (const std::string& w : words) {
        EXPECT_GE(std::stof(w), 0);
        EXPECT_LE(std::stof(w), 1);
    }
    EXPECT_EQ(printed(text), words);
}

} // namespace
} // namespace alpenglow::rsl::drawn_test
