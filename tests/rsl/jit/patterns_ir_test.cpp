// What the machine code of the benchmark patterns is made of: the optimised LLVM IR holds nothing but straight vector code.
#include "rsl/compiler.h"
#include <filesystem>
#include <gtest/gtest.h>
#include <sstream>

namespace alpenglow::rsl::patterns_ir_test {
namespace {

/// Every instruction of the text that should not be there, one a line. Intrinsics that are one machine instruction may be called.
std::string offences(const std::string& llvm) {
    static const char* const kInstructions[] = {"llvm.fma.",  "llvm.floor.", "llvm.ceil.",       "llvm.trunc.",
                                                "llvm.fabs.", "llvm.sqrt.",  "llvm.fshl.",       "llvm.umin.",
                                                "llvm.umax.", "llvm.smin.",  "llvm.smax.",       "llvm.copysign.",
                                                "llvm.abs.",  "llvm.rint.",  "llvm.is.fpclass.", "llvm.vector.reduce.or."};
    std::istringstream in(llvm);
    std::string line, found;
    while (std::getline(in, line)) {
        if (line.rfind("declare", 0) == 0 || line.starts_with(';')) continue;
        bool bad = line.find(" alloca ") != std::string::npos || line.find("gather") != std::string::npos ||
                   line.find("scatter") != std::string::npos;
        if (line.find(" call ") != std::string::npos) {
            bool one = false;
            for (const char* k : kInstructions) one = one || line.find("@" + std::string(k)) != std::string::npos;
            bad = bad || !one;
        }
        if (bad) found += line.substr(0, 200) + "\n";
    }
    return found;
}

class PatternsIr : public testing::TestWithParam<int> {
protected:
    void look(const std::string& folder, const std::vector<std::string>& names) {
        Diagnostics diagnostics([](const Diagnostic& d) { ADD_FAILURE() << toString(d); });
        ShaderCompiler::Settings settings;
        settings.useDefaultCache = false;
        ShaderCompiler compiler(settings);
        for (const auto& name : names) {
            auto shader = compiler.load(folder + "/" + name + ".sl", {folder}, diagnostics);
            ASSERT_TRUE(shader) << name;
            KernelOptions options;
            options.lanes = GetParam();
            const std::string text = compiler.dump(shader, options, diagnostics, true);
            const size_t start = text.find("define void @alpenglow_entry");
            ASSERT_NE(start, std::string::npos) << name << ": no machine code of its own";
            EXPECT_EQ(offences(text.substr(start)), "") << name << " at " << GetParam() << " lanes";
            EXPECT_NE(text.find("fmul <", start), std::string::npos) << name << ": no vectors at all";
        }
    }
};

TEST_P(PatternsIr, OurPatterns) {
    look(std::string(ALPENGLOW_SOURCE_DIR) + "/bench/shaders",
         {"clouds", "veins", "cells", "tiles", "transcendental", "escape", "clouds_slope"});
}

TEST_P(PatternsIr, PublishedPatterns) {
    const std::string folder = std::string(ALPENGLOW_SOURCE_DIR) + "/../shared/bench";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "../shared/bench is not here";
    look(folder, {"a_fbm", "b_marble", "c_worley", "d_brick", "e_math", "f_mandel", "g_fbm_deriv"});
}

INSTANTIATE_TEST_SUITE_P(Lanes, PatternsIr, testing::Values(16, 8));

TEST(PatternsIrCheck, FindsWhatItLooksFor) {
    EXPECT_EQ(offences("  %1 = call <16 x float> @llvm.fma.v16f32(<16 x float> %a)\n"), "");
    EXPECT_NE(offences("  %1 = alloca <16 x float>\n"), "");
    EXPECT_NE(offences("  call void @al_noise3_f_0(ptr %a, ptr %b)\n"), "");
    EXPECT_NE(offences("  %1 = tail call fastcc <16 x float> @al_noise3_f_0_wide(<16 x float> %a)\n"), "");
    EXPECT_NE(offences("  %1 = call <16 x float> @llvm.masked.gather.v16f32.v16p0(<16 x ptr> %p)\n"), "");
    EXPECT_NE(offences("  call void @llvm.masked.scatter.v16f32.v16p0(<16 x float> %v, <16 x ptr> %p)\n"), "");
}

} // namespace
} // namespace alpenglow::rsl::patterns_ir_test
