// The regular expressions of match() against those of the C library, and such as nothing may take long.
#include "base/limits.h"
#include "base/pattern.h"
#include <chrono>
#include <gtest/gtest.h>
#include <random>
#include <regex.h>

namespace alpenglow::rsl::pattern_test {
namespace {

std::string repeat(const std::string& s, int n) {
    std::string r;
    for (int i = 0; i < n; ++i) r += s;
    return r;
}

/// 1, 0; -1 for what is no pattern.
int ours(const std::string& pattern, const std::string& text) {
    std::string error;
    const auto p = Pattern::make(pattern, error);
    EXPECT_EQ(p == nullptr, !error.empty()) << pattern;
    return p ? p->occurs(text) : -1;
}

int theirs(const std::string& pattern, const std::string& text) {
    regex_t r;
    if (regcomp(&r, pattern.c_str(), REG_EXTENDED | REG_NOSUB)) return -1;
    const bool found = regexec(&r, text.c_str(), 0, nullptr, 0) == 0;
    regfree(&r);
    return found;
}

TEST(Pattern, WrittenOnes) {
    const char* patterns[] = {"",
                              "a",
                              "a+b",
                              "^a+b$",
                              "a|b|",
                              "(ab|cd)e",
                              "[^a-c]",
                              "[]a]x",
                              "[^]a]",
                              "[a-]",
                              "[[:digit:][:upper:]_]+$",
                              "a{2}",
                              "a{0}b",
                              "a{2,}",
                              "(ab){1,2}c",
                              "a{,2}b",
                              "()",
                              "(|a)b",
                              "a**",
                              "a+?b",
                              "\\.",
                              "\\*a",
                              "\\w+\\s\\W",
                              "\\S$",
                              "\\bab\\b",
                              "\\Bb",
                              "\\<b",
                              "a\\>",
                              "\\`a",
                              "b\\'",
                              "a.c",
                              "[.]",
                              "[[.a.]-c]d",
                              "[[=a=]]b",
                              "x*",
                              "(a*)*b",
                              "(a|b)*abb",
                              "^$",
                              "a$b",
                              "a^b",
                              "a]",
                              "a}",
                              "(",
                              "[",
                              "a{2",
                              "a{3,2}",
                              "*a",
                              "a|*b",
                              "(*a)",
                              "[b-a]",
                              "[[:nosuch:]]",
                              "\\",
                              "{1}",
                              "a{99999}"};
    const char* texts[] = {"",    "a",    "b",     "ab",   "ba",  "aab", "abc",    "a.c", "a*a",       "aa",
                           "aaa", "abab", "ababc", "cde",  "x",   "]x",  "-",      "A_9", "two words", "a b",
                           "a]",  "a}",   "abb",   "babb", "a-b", "cd",  "aabb c", "\n",  "a\nb"};
    for (const char* p : patterns)
        for (const char* t : texts) EXPECT_EQ(ours(p, t), theirs(p, t)) << '"' << p << "\" in \"" << t << '"';
}

constexpr int kOuter = 2; ///< nesting of groups

struct Writer {
    std::mt19937& random;
    unsigned below(unsigned n) { return random() % n; }
    std::string pattern(int depth) {
        std::string s = sequence(depth);
        for (; below(4) == 0;) s += "|" + sequence(depth);
        return s;
    }
    std::string sequence(int depth) {
        std::string s;
        for (unsigned n = 1 + below(3); n > 0; --n) {
            s += atom(depth);
            const char* signs[] = {"*", "+", "?", "{2}", "{0,1}", "{1,3}", "{2,}"};
            if (below(3) == 0 && s.back() != '^' && s.back() != '$') s += signs[below(7)];
        }
        return s;
    }
    std::string atom(int depth) {
        const char* plain[] = {"a", "b", "c", ".", "[ab]", "[^a]", "[a-b]", "\\.", "[[:alpha:]]", "^", "$"};
        if (depth > 0 && below(3) == 0) return "(" + pattern(depth - 1) + ")";
        return plain[below(depth == kOuter ? 11 : 9)]; // the library is wrong about (^a){2}, which nothing can be
    }
};

TEST(Pattern, DrawnOnesAgainstTheLibrary) {
    std::mt19937 random(7);
    Writer w{random};
    for (int n = 0; n < 3000; ++n) {
        const std::string p = w.pattern(kOuter);
        for (int k = 0; k < 5; ++k) {
            std::string t;
            for (unsigned i = random() % 8; i > 0; --i) t += "abc."[random() % 4];
            EXPECT_EQ(ours(p, t), theirs(p, t)) << '"' << p << "\" in \"" << t << '"';
        }
    }
}

TEST(Pattern, CostIsBounded) {
    const auto start = std::chrono::steady_clock::now();
    std::string error;
    for (int depth : {4, 7, 12})
        EXPECT_FALSE(Pattern::make(repeat("(", depth) + "a{1,99}" + repeat("){1,99}", depth) + "b", error));
    EXPECT_NE(error.find("too large"), std::string::npos) << error;
    EXPECT_FALSE(Pattern::make("(((a{1,255}){1,255}){1,255})", error));
    EXPECT_FALSE(Pattern::make(std::string(limits::kPatternStates + 1, 'a'), error));
    EXPECT_TRUE(Pattern::make(std::string(limits::kPatternStates / 4, 'a'), error)) << error;
    for (const std::string& sign : {std::string("+"), std::string("*"), std::string("{1}"), std::string("{0}")})
        Pattern::make("a" + repeat(sign, 100'000), error);
    EXPECT_FALSE(Pattern::make(repeat("(", 100'000), error));
    EXPECT_FALSE(Pattern::make(repeat("(", 100'000) + repeat(")", 100'000), error));
    // Where backtracking would need 2^60 steps.
    EXPECT_EQ(ours("(a|a)*b", std::string(60, 'a')), 0);
    EXPECT_EQ(ours("(a*)*b", std::string(2000, 'a')), 0);
    EXPECT_EQ(ours("(a?){60}a{60}", std::string(60, 'a')), 1);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20);
}

} // namespace
} // namespace alpenglow::rsl::pattern_test
