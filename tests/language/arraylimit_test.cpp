// What does not fit into an array is left out, and said.
#include "base/limits.h"
#include "rsl/evaluate.h"
#include <gtest/gtest.h>

namespace alpenglow::rsl::arraylimit_test {
namespace {

TEST(ArrayLimit, GrowthEndsWithAMessage) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    const Evaluation e =
        evaluate(compiler, "float a[], i; for (i = 0; i < u * 400; i += 1) push(a, i);", "arraylength(a) * 1000 + a[1e6]", {}, d);
    ASSERT_TRUE(e.ok);
    ASSERT_EQ(e.numbers.size(), 1u);
    EXPECT_EQ(e.numbers[0], limits::kResizableArray * 1000 + limits::kResizableArray - 1);
    ASSERT_EQ(d.errors(), 1);
    EXPECT_EQ(d.all()[0].message,
              "an array cannot grow beyond " + std::to_string(limits::kResizableArray) + " elements; what follows is left out");
    EXPECT_EQ(d.all()[0].place.file, "expression");
}

} // namespace
} // namespace alpenglow::rsl::arraylimit_test
