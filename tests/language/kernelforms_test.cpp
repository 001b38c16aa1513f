// What the forms of a shader's kernel say.
#include "points.h"
#include "rsl/compiler.h"
#include <algorithm>
#include <gtest/gtest.h>

namespace alpenglow::rsl::kernelforms_test {

// A shader is compiled in several forms, each of which finds the same at the same place.
TEST(KernelForms, SayTheSameOnce) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    const auto shader =
        compiler.loadText("surface s()\n{\n    Ci = Du(Du(Du(u * u * u)));\n    Oi = Du(Du(Du(v * v)));\n}\n", "s.sl", d);
    ASSERT_TRUE(shader);
    for (const bool mixed : {false, true})
        for (const int lanes : {4, 8}) {
            KernelOptions o;
            o.mixed = mixed;
            o.lanes = lanes;
            EXPECT_TRUE(compiler.kernel(shader, o, d));
        }
    const std::vector<Diagnostic> all = d.all();
    const auto third = std::count_if(all.begin(), all.end(),
                                     [](const Diagnostic& m) { return m.message.find("third order") != m.message.npos; });
    EXPECT_EQ(third, 2); // of either line
}

} // namespace alpenglow::rsl::kernelforms_test
