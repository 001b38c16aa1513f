// Local arrays of shaders: what is large lives outside the stack, and their sum has a limit.
#include "base/limits.h"
#include "integrator/harness.h"
#include "rsl/evaluate.h"

namespace local_arrays_test {

using namespace alpenglow;
using namespace alpenglow::rsl;

namespace {

std::string all(const Diagnostics& d) {
    std::string s;
    for (const Diagnostic& m : d.all()) s += toString(m);
    return s;
}

/// The value of an expression at each number of lanes, or the messages.
void expectValue(const std::string& setup, const std::string& expression, float value,
                 int outline = limits::kOutlineInstructions) {
    for (int lanes : {4, 8, 16}) {
        ShaderCompiler::Settings settings;
        settings.useDefaultCache = false;
        ShaderCompiler compiler(settings);
        Diagnostics d;
        KernelOptions o;
        o.lanes = lanes;
        o.outline = outline;
        const Evaluation e = evaluate(compiler, setup, expression, o, d);
        ASSERT_TRUE(e.ok) << lanes << " lanes: " << all(d);
        ASSERT_EQ(e.numbers.size(), 1u);
        EXPECT_EQ(e.numbers[0], value) << lanes << " lanes";
    }
}

/// Declarations of n varying arrays that keep their elements: each holds its number.
std::string arrays(int n) {
    std::string text = "uniform float i; varying float sum = 0;\n";
    for (int k = 0; k < n; ++k) {
        const std::string a = "a" + std::to_string(k);
        text += "varying float " + a + "[16384]; for (i = 0; i < 16384; i += 1) " + a + "[i] = i + " + std::to_string(k) +
                " + u * 0;\n";
    }
    for (int k = 0; k < n; ++k) text += "sum += a" + std::to_string(k) + "[2 + floor(u * 0)];\n";
    return text;
}

} // namespace

TEST(LocalArrays, OneAsLargeAsTheLimit) {
    // 16,384 matrices are 1 MiB a point: 16 MiB with 16 lanes, twice the usual stack.
    static_assert(limits::kShaderArray * 16 * sizeof(float) == limits::kShaderMemory);
    expectValue("matrix m[16384]; uniform float i; for (i = 0; i < 16384; i += 1) m[i] = matrix (i + u * 0);",
                "comp(m[3 + u * 0], 0, 0)", 3);
}

TEST(LocalArrays, SeveralLargeOnes) {
    expectValue(arrays(8), "sum", 8 * 2 + 28);
    static_assert(8 * limits::kShaderArray * sizeof(float) > limits::kKernelStack);
}

TEST(LocalArrays, OfFunctionsThatAreCalled) {
    const std::string functions =
        "float f(float x) { uniform float i; varying float a[4000]; for (i = 0; i < 4000; i += 1) a[i] = i + x;"
        " return a[10 + x]; }\n"
        "float g(float x) { uniform float i; varying float b[4000]; for (i = 0; i < 4000; i += 1) b[i] = 2 * i;"
        " float y = f(x); return y + b[20 + x]; }\n";
    // f(x) is 10 + 2x, g(x) is f(x) + 40 + 2x.
    for (int outline : {0, limits::kOutlineInstructions})
        expectValue(functions + "varying float x = u * 0 + 1;", "f(x) + g(x) + f(x + 1) + g(x + 2)", 12 + 54 + 14 + 62, outline);
}

TEST(LocalArrays, SumOverTheLimit) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    for (const auto& [n, fits] : {std::pair{16, true}, {17, false}, {400, false}}) {
        ShaderCompiler compiler(settings);
        Diagnostics d;
        auto s = compiler.loadText("surface big() {\n" + arrays(n) + "Ci = sum; }\n", "big.sl", d);
        ASSERT_TRUE(s) << all(d);
        EXPECT_EQ(compiler.kernel(s, {}, d) != nullptr, fits) << n;
        EXPECT_EQ(d.errors(), fits ? 0 : 1) << all(d);
        if (fits) continue;
        EXPECT_NE(all(d).find("bytes a point; the limit is " + std::to_string(limits::kShaderMemory) + " [shader-memory]"),
                  std::string::npos)
            << all(d);
        EXPECT_NE(all(d).find("big.sl:3:"), std::string::npos) << all(d);
    }
}

TEST(LocalArrays, OfAKernelThatWaits) {
    // min() of what a ray brings is not affine: the kernel is a coroutine, and its arrays live across the wait.
    using namespace alpenglow::integrator::testing;
    writeShader("glow", "surface glow() { Ci = 2; Oi = 1; }\n");
    writeShader("waits", "surface waits() { uniform float i; varying float a[16384], b[16384];"
                         " for (i = 0; i < 16384; i += 1) { a[i] = i + u * 0; b[i] = 2 * i + u * 0; }"
                         " color c = trace(P, N); c = min(c, color 1.5);"
                         " Ci = c * (a[5 + floor(u * 0)] + b[7 + floor(u * 0)]); Oi = 1; }\n");
    Scene scene("WorldBegin\nSurface \"waits\"\nSides 2\nTransformBegin Translate 0 0 3 Disk 0 1 360 TransformEnd\n"
                "Surface \"glow\"\nSphere 50 -50 50 360\nWorldEnd\n");
    ASSERT_TRUE(scene.world);
    alpenglow::integrator::CameraRay rays[] = {rayTo({0, 0, 0}, {0.1f, 0.1f, 3}), rayTo({0, 0, 0}, {0.2f, 0.1f, 3})};
    const auto results = scene.trace(rays);
    for (const auto& r : results) EXPECT_EQ(r.color.x, 1.5f * 19);
}

} // namespace local_arrays_test
