// Inputs of kernels that are filled from rows (shading::LightRows) are those that points give.
#include "shading/batch.h"
#include <gtest/gtest.h>

namespace batchrows_test {

using namespace alpenglow;
using namespace alpenglow::shading;

namespace {

struct Kernel final : rsl::CompiledKernel {
    explicit Kernel(std::vector<rsl::ir::Input> in) {
        inputs_ = std::move(in);
        outputs_ = {{"Cl", rsl::ir::Kind::Triple, {}}};
    }
};
rsl::ir::Input triple(const std::string& name) { return {name, rsl::ir::Kind::Triple, {}, 0, false, false, 0}; }
rsl::ir::Input number(const std::string& name, bool uniform) { return {name, rsl::ir::Kind::Float, {}, 0, uniform, false, 0}; }

struct NoSpaces final : SpaceResolver {
    bool matrix(const std::string&, const std::string&, Matrix&) const override { return false; }
};

bool readsRows(std::vector<rsl::ir::Input> in) { return BatchPlan(Kernel(std::move(in)), false).readsLightRows(); }

} // namespace

TEST(BatchRows, RowsGiveWhatPointsGive) {
    const auto kernel =
        std::make_shared<Kernel>(std::vector{triple("Ps"), number("param:intensity", true), triple("N"), triple("P")});
    const BatchPlan plan(*kernel, false);
    ASSERT_TRUE(plan.readsLightRows());
    ParameterBlock parameters;
    parameters.numbers["intensity"] = {7};
    const Matrix space;
    const InstanceView view{&parameters, &space};
    for (const size_t n : {size_t(1), size_t(16), size_t(80)}) {
        std::vector<ShadePoint> points(n);
        std::vector<float> P(3 * n), N(3 * n), Ps(3 * n);
        for (size_t i = 0; i < n; ++i)
            for (size_t q = 0; q < 3; ++q) {
                P[q * n + i] = points[i].P[int(q)] = float(10 * i + q);
                N[q * n + i] = points[i].N[int(q)] = float(10 * i + q) + .25f;
                Ps[q * n + i] = points[i].Ps[int(q)] = float(10 * i + q) + .5f;
            }
        Batch one, all;
        one.assign(kernel, plan, points, {&view, 1}, {}, NoSpaces());
        all.assign(kernel, plan, {P, N, Ps}, {&view, 1}, {});
        ASSERT_EQ(all.size(), int(n));
        ASSERT_EQ(all.call().stride, one.call().stride);
        EXPECT_EQ(all.call().in[1][0], 7);
        for (int input : {0, 2, 3})
            for (size_t q = 0; q < 3; ++q)
                for (size_t i = 0; i < (n + 15) / 16 * 16; ++i) { // whole strips
                    const size_t at = q * size_t(one.call().stride) + i;
                    EXPECT_EQ(all.call().in[input][at], one.call().in[input][at]) << input << " " << q << " " << i;
                }
        EXPECT_EQ(all.value(0, 2, int(n) - 1), 0);
    }
}

TEST(BatchRows, OtherInputsAreNotInRows) {
    EXPECT_TRUE(readsRows({}));
    EXPECT_TRUE(readsRows({triple("Ps")}));
    EXPECT_FALSE(readsRows({triple("Ps"), number("s", false)}));
    EXPECT_FALSE(readsRows({triple("Ns")}));
    EXPECT_TRUE(readsRows({number("param:intensity", false)})) << "unless a variable of the primitive stands for it";
    EXPECT_FALSE(readsRows({number("param:__faceindex", false)})) << "known by the primitive alone";
    rsl::ir::Input slopes = triple("P");
    slopes.order = 1;
    EXPECT_FALSE(readsRows({slopes}));
    EXPECT_FALSE(readsRows({{"space:shader>current", rsl::ir::Kind::Matrix, {}, 0, true, false, 0}}));
}

} // namespace batchrows_test
