// RE2 as the engine of match(): which POSIX patterns mean something else to it, and its speed beside ours (base/pattern.h).
// The C library's regcomp() is the judge.
#include "base/pattern.h"
#include <chrono>
#include <cstdio>
#include <re2/re2.h>
#include <regex.h>

using namespace alpenglow;

namespace {

RE2::Options posix() {
    RE2::Options o;
    o.set_posix_syntax(true);
    o.set_perl_classes(true);
    o.set_word_boundary(true);
    o.set_one_line(true);
    o.set_dot_nl(true);
    o.set_never_capture(true);
    o.set_encoding(RE2::Options::EncodingLatin1);
    o.set_log_errors(false);
    return o;
}

/// 1, 0; -1 for what is no pattern.
int withRe2(const std::string& pattern, const std::string& text) {
    const RE2 r(pattern, posix());
    return r.ok() ? RE2::PartialMatch(text, r) : -1;
}

int withOurs(const std::string& pattern, const std::string& text) {
    std::string error;
    const auto p = Pattern::make(pattern, error);
    return p ? p->occurs(text) : -1;
}

int withLibrary(const std::string& pattern, const std::string& text) {
    regex_t r;
    if (regcomp(&r, pattern.c_str(), REG_EXTENDED | REG_NOSUB)) return -1;
    const bool found = regexec(&r, text.c_str(), 0, nullptr, 0) == 0;
    regfree(&r);
    return found;
}

/// Those of tests/rsl/jit/pattern_test.cpp, and some that RE2 has meanings of its own for.
const char* const kPatterns[] = {"",
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
                                 "a{99999}",
                                 "a{1001}",
                                 "a{300}",
                                 "(a{40}){40}",
                                 "\\d",
                                 "\\pL",
                                 "\\Qa*\\E",
                                 "\\x61",
                                 "\\Ca",
                                 "(?i)A"};
const char* const kTexts[] = {"",     "a",     "b",   "ab", "ba",     "aab", "abc",  "a.c",       "a*a", "aa", "aaa",
                              "abab", "ababc", "cde", "x",  "]x",     "-",   "A_9",  "two words", "a b", "a]", "a}",
                              "abb",  "babb",  "a-b", "cd", "aabb c", "\n",  "a\nb", "d",         "a*",  "\v", "\xe4"};

void meanings() {
    int re2 = 0, ours = 0, all = 0;
    std::string which;
    for (const char* p : kPatterns) {
        int differs = 0;
        for (const char* t : kTexts) {
            const int right = withLibrary(p, t);
            differs += withRe2(p, t) != right;
            ours += withOurs(p, t) != right;
        }
        ++all;
        re2 += differs > 0;
        if (differs > 0) which += std::string("  ") + p;
    }
    std::printf("%d patterns: ours differs from the C library in %d results, RE2 differs in %d patterns:%s\n", all, ours, re2,
                which.c_str());
}

template <class F> double nanoseconds(int runs, F f) {
    double best = 1e99;
    for (int k = 0; k < 7; ++k) {
        const auto begin = std::chrono::steady_clock::now();
        for (int i = 0; i < runs; ++i) f();
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
        best = std::min(best, spent.count() / runs);
    }
    return best * 1e9;
}

void speed() {
    const std::string a60(60, 'a');
    const std::pair<std::string, std::string> cases[] = {
        {"^spher", "hemisphere"},
        {"(wood|stone)_[0-9]+$", "textures/interior/wood_oak_017"},
        {"[a-z]*\\.tex$", "a/long/path/to/some/folder/of/textures/called_bark.tex"},
        {"(a|a)*b", a60},
        {"(a?){60}a{60}", a60}};
    for (const auto& [pattern, text] : cases) {
        std::string error;
        const auto ours = Pattern::make(pattern, error);
        const RE2 re2(pattern, posix());
        volatile int found = 0;
        const double o = nanoseconds(5000, [&] { found = found + ours->occurs(text); });
        const double r = nanoseconds(5000, [&] { found = found + RE2::PartialMatch(text, re2); });
        const double made = nanoseconds(200, [&] { found = found + (Pattern::make(pattern, error) != nullptr); });
        const double madeRe2 = nanoseconds(200, [&] { found = found + withRe2(pattern, ""); });
        std::printf("%-22s a match: ours %7.0f ns, RE2 %4.0f ns; a new pattern: ours %5.0f ns, RE2 %6.0f ns\n", pattern.c_str(),
                    o, r, made, madeRe2);
    }
}

} // namespace

int main() {
    meanings();
    speed();
}
