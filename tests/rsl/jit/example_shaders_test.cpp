// The large shaders of examples/shaders: nothing to say about them, and light goes through them without waiting.
#include "rsl/compiler.h"
#include <gtest/gtest.h>

namespace alpenglow::rsl::example_shaders_test {
namespace {

struct ExampleShaders : testing::Test {
    Diagnostics diagnostics{[](const Diagnostic& d) { ADD_FAILURE() << toString(d); }};
    ShaderCompiler compiler{[] {
        ShaderCompiler::Settings s;
        s.useDefaultCache = false;
        return s;
    }()};
    std::shared_ptr<const CompiledKernel> kernel(const char* name, bool path, bool mixed) {
        const std::string folder = std::string(ALPENGLOW_SOURCE_DIR) + "/examples/shaders";
        auto shader = compiler.load(name, {folder}, diagnostics);
        if (!shader) return nullptr;
        KernelOptions o;
        o.path = path;
        o.mixed = mixed;
        return compiler.kernel(shader, o, diagnostics);
    }
};

TEST_F(ExampleShaders, UberSurfaceIsAffineUnderPath) {
    const auto k = kernel("ubersurface", true, false);
    ASSERT_TRUE(k);
    EXPECT_TRUE(k->facts().affine) << k->facts().whyNot;
    EXPECT_FALSE(k->facts().suspends);
}

TEST_F(ExampleShaders, UberSurfaceForMixedBatches) {
    const auto k = kernel("ubersurface", true, true);
    ASSERT_TRUE(k);
    EXPECT_FALSE(k->facts().suspends);
}

TEST_F(ExampleShaders, UberLightHasOneBlockAroundIt) {
    const auto k = kernel("uberlight", false, false);
    ASSERT_TRUE(k);
    EXPECT_EQ(k->facts().blocks, std::vector<std::string>{"illuminate"});
}

} // namespace
} // namespace alpenglow::rsl::example_shaders_test
