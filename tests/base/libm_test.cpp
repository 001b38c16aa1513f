// The same bits on every machine: a library's elementary functions differ with its version and the processor, so what decides a
// picture calls none of them. base/exact.h and shadeops/elementary.h have those that are used instead.
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace libm_test {

namespace fs = std::filesystem;

namespace {

// Not correctly rounded by IEEE 754. What is exact may be called: sqrt, fma, floor, ceil, trunc, round, rint, nearbyint, lround,
// fmod, remainder, frexp, ldexp, scalbn, logb, fabs, copysign, nextafter, fmin, fmax.
const char kInexact[] =
    "(sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|asinh|acosh|atanh|sincos|exp|exp2|exp10|expm1|log|log2|log10|"
    "log1p|pow|cbrt|hypot|erf|erfc|tgamma|lgamma|cyl_bessel_j)";

/// The text without comments and without what is between quotes, where RSL and messages are.
std::string codeOf(const std::string& text) {
    std::string code;
    for (size_t i = 0; i < text.size();) {
        if (text.compare(i, 2, "//") == 0) {
            i = std::min(text.find('\n', i), text.size());
        } else if (text.compare(i, 2, "/*") == 0) {
            i = std::min(text.find("*/", i), text.size() - 2) + 2;
        } else if (text.compare(i, 3, "R\"(") == 0) {
            i = std::min(text.find(")\"", i), text.size() - 2) + 2;
        } else if (text[i] == '"') {
            for (++i; i < text.size() && text[i] != '"'; ++i) i += text[i] == '\\';
            ++i;
        } else {
            code += text[i++];
        }
    }
    return code;
}
/// Calls of the library's functions: by std::, or by the plain name where no other is meant (exact::sin, al_sin, x.log).
std::set<std::string> callsIn(const std::string& code) {
    static const std::regex plain(std::string("(^|[^A-Za-z0-9_:.>\"])((std)?::)?(__builtin_)?") + kInexact + "[fl]?\\s*(?=\\()");
    std::set<std::string> found;
    for (std::sregex_iterator i(code.begin(), code.end(), plain), end; i != end; ++i) {
        const std::string name = i->str();
        // A declaration of a function of our own: a type stands before the name.
        const std::string before = code.substr(0, size_t(i->position()) + 1);
        const bool declares = before.size() > 6 && (before.compare(before.size() - 7, 7, "double ") == 0 ||
                                                    before.compare(before.size() - 6, 6, "float ") == 0 ||
                                                    before.compare(before.size() - 7, 7, "SinCos ") == 0);
        if (!declares) found.insert(name);
    }
    // Estimates of reciprocals and roots, which every maker of processors rounds in another way.
    static const std::regex estimate("_mm[0-9]*_(mask_|maskz_)?(rcp|rsqrt)[A-Za-z0-9_]*|__builtin_ia32_(rcp|rsqrt)[a-z0-9_]*");
    for (std::sregex_iterator i(code.begin(), code.end(), estimate), end; i != end; ++i) found.insert(i->str());
    return found;
}

TEST(Libm, FindsCalls) {
    EXPECT_EQ(callsIn("x = std::sin(y); z = powf(a, b);").size(), 2u);
    EXPECT_EQ(callsIn("x = std::pow(std::sin(y), 2);").size(), 2u);
    EXPECT_EQ(callsIn(codeOf("exact::sin(y); r.cos(x); sinLanes(x); al_pow(x); // cos(x)\n f(\"sin(x)\"); double sin(double x);"))
                  .size(),
              0u);
    EXPECT_EQ(callsIn("__builtin_expf(x)").size(), 1u);
    EXPECT_EQ(callsIn("y = _mm256_rcp_ps(x); z = _mm_rsqrt_ss(x);").size(), 2u);
}

TEST(Libm, NothingThatDecidesBitsCallsIt) {
    const fs::path src = fs::path(ALPENGLOW_SOURCE_DIR) / "src";
    int files = 0;
    // All rooms but the command line.
    for (const char* room : {"base", "shadeops", "rsl", "ri", "scene", "geometry", "accel", "texture", "shading", "bsdf", "lanes",
                             "world", "services", "integrator", "render", "display"})
        for (const auto& e : fs::recursive_directory_iterator(src / room)) {
            const auto ext = e.path().extension();
            if (ext != ".cpp" && ext != ".h" && ext != ".inc") continue;
            // exact.cpp calls its own functions by their plain names.
            if (e.path().filename() == "exact.cpp") continue;
            ++files;
            std::ifstream in(e.path());
            std::stringstream text;
            text << in.rdbuf();
            for (const std::string& call : callsIn(codeOf(text.str())))
                ADD_FAILURE() << fs::relative(e.path(), src).string() << " calls \"" << call
                              << "\": its last bits are not the same on every machine; use base/exact.h or shadeops/elementary.h";
        }
    EXPECT_GT(files, 200);
}

} // namespace

} // namespace libm_test
