// How many points a kernel works on at once: less than asked for where it calls what only the narrower runtimes have.
#include "handmade.h"
#include "shadeops/descriptor.h"
#include <algorithm>

namespace alpenglow::rsl::test::width_test {
namespace {

// The widths at which the runtime has these functions: Shadeop::widest. The values are those of the program's own copy of them.
void expectWidth(const char* symbol, int widest, const std::vector<Kind>& arguments) {
    Made m;
    std::vector<Inst*> in;
    for (size_t i = 0; i < arguments.size(); ++i) in.push_back(m.input(std::string("xyzw").substr(i, 1).c_str(), arguments[i]));
    m.output("f", m.call(symbol, Kind::Float, in));
    const auto value = [](int i, int n, int row) { return .1f + .37f * float(n % 11) + float(i) * .23f - float(row) * .41f; };
    for (const auto& o : configurations()) {
        SCOPED_TRACE(std::string(symbol) + " " + describe(o));
        auto kernel = compile(m, o);
        ASSERT_TRUE(kernel);
        int most = widest;
        while (most > o.lanes * o.vectors) most /= 2;
        EXPECT_EQ(kernel->lanes(), most);
        Batch run;
        run(*kernel, o, value);
        for (int n = 0; n < kPoints; n++) {
            std::vector<float> given;
            for (size_t i = 0; i < arguments.size(); ++i)
                for (int row = 0; row < ir::components(arguments[i]); ++row) given.push_back(value(int(i), n, row));
            float want = 0;
            ASSERT_TRUE(evaluateRuntime(symbol, given.data(), int(given.size()), &want, 1));
            ASSERT_EQ(run(0, 0, n), want) << n;
        }
    }
}

TEST(Width, OfNoise) { expectWidth("al_noise2_f", 32, {Kind::Float, Kind::Float}); }
TEST(Width, OfDistributions) { expectWidth("al_bsdf_orennayar", 16, {Kind::Triple, Kind::Triple, Kind::Triple, Kind::Float}); }
TEST(Width, OfSmallFunctions) { expectWidth("al_smoothstep_f", 64, {Kind::Float, Kind::Float, Kind::Float}); }

} // namespace
} // namespace alpenglow::rsl::test::width_test
