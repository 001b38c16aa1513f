// Plug-ins: the example of examples/plugins called by shaders in every build, and everything that is refused.
#include "language/points.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace alpenglow::rsl::plugins_test {
namespace {

ShaderCompiler::Settings trusting(const std::string& cache = {}) {
    ShaderCompiler::Settings s;
    s.useDefaultCache = false;
    s.cacheDirectory = cache;
    s.allowExec = true;
    s.pluginPaths = {ALPENGLOW_PLUGINS};
    return s;
}

/// All errors and warnings, one a line, as "id message (hint)".
std::string said(const Diagnostics& d) {
    std::string s;
    for (const Diagnostic& m : d.all())
        if (m.severity >= Severity::Warning)
            s += std::to_string(m.place.line) + ":" + std::to_string(m.place.column) + " " + m.message + " (" + m.hint + ")\n";
    return s;
}

std::string refusal(ShaderCompiler& c, const std::string& text) {
    Diagnostics d;
    EXPECT_FALSE(c.loadText(text, "test", d));
    EXPECT_EQ(d.errors(), 1) << said(d);
    return said(d);
}

/// Output `o` at n points with u = 0, 1/n, 2/n ...; components one after the other.
std::vector<float> run(ShaderCompiler& c, const std::string& body, const KernelOptions& options, int n,
                       const std::string& type = "float") {
    Diagnostics d;
    const std::string zero = type == "string" ? "\"\"" : "0";
    const auto shader =
        c.loadText("plugin \"weave\";\nsurface t(output varying " + type + " o = " + zero + ";) { " + body + " }", "test", d);
    EXPECT_TRUE(shader) << said(d);
    if (!shader) return {};
    KernelOptions o = options;
    o.outputs = {"o"};
    const auto kernel = c.kernel(shader, o, d);
    EXPECT_TRUE(kernel) << said(d);
    if (!kernel) return {};
    std::vector<std::vector<float>> out;
    const auto value = [n](const std::string& name, int component, int part, int point) {
        float v = 0;
        EvaluationPoint::value(name, component, part, v);
        return name == "u" && part == 0 ? float(point) / float(n) : v;
    };
    EXPECT_TRUE(runPoints(*kernel, o.mixed, n, value, c.parameterValues(shader, d), out, d));
    return out.empty() ? std::vector<float>() : out[0];
}

TEST(Plugins, AFunctionIsCalledForAllPointsInEveryBuild) {
    ShaderCompiler c(trusting());
    for (const KernelOptions& o : configurations()) {
        SCOPED_TRACE(describe(o));
        const int n = 37;
        const std::vector<float> got = run(c, "o = triangle(4 * u);", o, n);
        ASSERT_EQ(got.size(), size_t(n));
        for (int p = 0; p < n; p++) {
            const float x = 4 * (float(p) / float(n)), f = x - std::floor(x);
            EXPECT_EQ(got[size_t(p)], f < 0.5f ? 2 * f : 2 - 2 * f) << p;
        }
    }
}

TEST(Plugins, EveryKindOfArgument) {
    ShaderCompiler c(trusting());
    const KernelOptions o;
    EXPECT_EQ(run(c, "float a[4] = {1, 2, 3, 4}; o = polynomial(2, a);", o, 3)[1], 1 + 2 * 2 + 3 * 4 + 4 * 8);
    EXPECT_EQ(run(c, "vector a = 1, b = vector(2, 3, 4); swap(a, b); o = a[2] * 10 + b[2];", o, 3)[1], 41);
    EXPECT_EQ(run(c, "o = trace(matrix(2));", o, 3)[1], 8);
    // Overloaded by the result and by what else is given; which thread is an output argument. cos(0) of the middle of a thread
    // is 1.
    EXPECT_EQ(run(c, "o = weave(0.5, 0.5);", o, 3)[1], 1);
    EXPECT_EQ(run(c, "float w = 7; color k = weave(1.5, 0.5, 0, color(1, 2, 3), w); o = k[1] * 10 + w;", o, 3)[1], 21);
    const float id =
        run(c, "string s = (u < 0.5) ? \"ab\" : \"\"; o = concat(repeated(s, 2), repeated(\"x\", 3));", o, 3, "string")[1];
    EXPECT_EQ(internedString(std::bit_cast<int32_t>(id)), "ababxxx");
}

TEST(Plugins, OnlyPointsThatComeByAreAskedAndOthersKeepTheirValues) {
    ShaderCompiler c(trusting());
    for (const KernelOptions& o : configurations()) {
        SCOPED_TRACE(describe(o));
        const std::vector<float> got = run(c,
                                           "o = 5; if (u >= 0.5) o = trace(matrix(1)); else if (u < 0.25) { float k;"
                                           "for (k = 0; k < 3; k += 1) o += polynomial(1, {0, k, 0, 0}); }",
                                           o, 40);
        ASSERT_EQ(got.size(), 40u);
        EXPECT_EQ(got[0], 8);
        EXPECT_EQ(got[12], 5);
        EXPECT_EQ(got[39], 4);
    }
}

TEST(Plugins, UniformArgumentsGiveAUniformResult) {
    ShaderCompiler c(trusting());
    EXPECT_EQ(run(c, "uniform float k = triangle(0.25); o = k;", {}, 3)[1], 0.5f);
    Diagnostics d;
    c.loadText("plugin \"weave\"; surface t() { uniform float k = triangle(u); Ci = k; }", "test", d);
    EXPECT_NE(said(d).find("uniform"), std::string::npos);
}

TEST(Plugins, TheNameMayBeAFileAndStandWhereStatementsStand) {
    ShaderCompiler c(trusting());
    Diagnostics d;
    EXPECT_TRUE(c.loadText("surface t() { plugin \"weave.so\"; Ci = triangle(u); }", "test", d)) << said(d);
    EXPECT_TRUE(c.loadText("plugin \"" ALPENGLOW_PLUGINS "/weave.so\"\nsurface t() { Ci = triangle(u); }", "test", d)) << said(d);
    // The word is no keyword.
    EXPECT_TRUE(c.loadText("surface t(float plugin = 1) { Ci = plugin; }", "test", d)) << said(d);
}

TEST(Plugins, WithoutAllowExecNothingIsLoaded) {
    ShaderCompiler::Settings s;
    s.useDefaultCache = false;
    s.pluginPaths = {ALPENGLOW_PLUGINS};
    ShaderCompiler c(s);
    // One message: what the plug-in would have brought is not missed aloud.
    const std::string m = refusal(c, "plugin \"weave\";\nsurface t() { Ci = triangle(u) + polynomial(1, {1, 2, 3, 4}); }");
    EXPECT_EQ(m, "1:1 plug-in \"weave\" is not loaded: a plug-in is a program, and shaders may not run programs (--allow-exec "
                 "lets them)\n");
}

TEST(Plugins, WhatIsNoPluginIsRefused) {
    ShaderCompiler c(trusting());
    const std::string tail = "surface t() { Ci = sum(u, 1); }";
    EXPECT_NE(
        refusal(c, "plugin \"nowhere\";\n" + tail).find("1:1 plug-in \"nowhere\" was not found (it is looked for as nowhere.so"),
        std::string::npos);
    EXPECT_NE(refusal(c, "plugin \"\";\n" + tail).find("was not found"), std::string::npos);
    EXPECT_NE(refusal(c, "plugin \"stranger\";\n" + tail).find("is no RSL plug-in"), std::string::npos);
    EXPECT_NE(refusal(c, "plugin \"misfit\";\n" + tail)
                  .find("of the signature \"float sum(float a; color b)\" in " ALPENGLOW_PLUGINS
                        "/misfit.so, it says 4 numbers in and 1 out, its function has 2 and 1"),
              std::string::npos);
    const fs::path text = fs::temp_directory_path() / ("alpenglow_plugin_" + std::to_string(getpid()) + ".so");
    std::ofstream(text) << "this is no library\n";
    EXPECT_NE(refusal(c, "plugin \"" + text.string() + "\";\n" + tail).find("cannot be loaded"), std::string::npos);
    fs::remove(text);
}

TEST(Plugins, ArgumentsAreChecked) {
    ShaderCompiler c(trusting());
    Diagnostics d;
    EXPECT_FALSE(c.loadText("plugin \"weave\";\nsurface t() { Ci = triangle(\"a\"); }", "test", d));
    ASSERT_EQ(d.errors(), 1) << said(d);
    ASSERT_FALSE(d.all()[0].notes.empty());
    EXPECT_EQ(d.all()[0].notes.back(), "'triangle' is a function of plug-in \"weave\": " ALPENGLOW_PLUGINS "/weave.so");
    EXPECT_NE(
        refusal(c, "plugin \"weave\";\nsurface t() { Ci = triangle(\"a\"); }").find("'triangle' cannot be called with (string)"),
        std::string::npos);
    EXPECT_NE(refusal(c, "plugin \"weave\";\nsurface t() { vector a = 0; swap(a, a + a); }").find("output argument"),
              std::string::npos);
}

TEST(Plugins, DerivativesAreZero) {
    ShaderCompiler c(trusting());
    EXPECT_EQ(run(c, "o = Du(triangle(u)) + u;", {}, 4)[1], 0.25f);
}

// Code from the cache finds the functions by their names; the cache holds no address.
TEST(Plugins, TheCacheKeepsCodeThatCallsThem) {
    const fs::path cache = fs::temp_directory_path() / ("alpenglow_plugin_cache_" + std::to_string(getpid()));
    fs::remove_all(cache);
    fs::create_directories(cache);
    for (const bool again : {false, true}) {
        ShaderCompiler c(trusting(cache.string()));
        EXPECT_EQ(run(c, "o = trace(matrix(u + 3));", {}, 4)[1], 13);
        EXPECT_EQ(c.statistics().fromDisk > 0, again);
        EXPECT_EQ(c.statistics().compiled > 0, !again);
    }
    bool named = false;
    for (const auto& e : fs::recursive_directory_iterator(cache)) {
        if (!e.is_regular_file()) continue;
        std::ifstream in(e.path(), std::ios::binary);
        const std::string bytes(std::istreambuf_iterator<char>(in), {});
        named |= bytes.find("rslplugin:") != std::string::npos && bytes.find("float trace(matrix m)") != std::string::npos;
    }
    EXPECT_TRUE(named);
    fs::remove_all(cache);
}

} // namespace
} // namespace alpenglow::rsl::plugins_test
