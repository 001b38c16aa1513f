// Lobes in lanes (bsdf/lobelanes.h): every width gives the bits of one lobe alone, whoever shares its block.
#include "bsdf/lobe.h"
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

namespace lobelanes_test {

using namespace alpenglow;
using namespace alpenglow::bsdf;

namespace {

bool sameBits(float a, float b) { return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0; }
bool sameBits(const Vec3& a, const Vec3& b) { return sameBits(a.x, b.x) && sameBits(a.y, b.y) && sameBits(a.z, b.z); }

struct Draws {
    std::mt19937 random{7};
    float one(float low = 0, float high = 1) { return low + (high - low) * std::generate_canonical<float, 24>(random); }
    Vec3 unit() { return normalize(Vec3(one(-1), one(-1), one(-1))); }
    bool half() { return random() & 1; }
};
LobeParams lobeOf(Draws& d, const LobeKind& k) {
    LobeParams p{d.unit(), d.unit(), d.unit(), d.half() ? d.one(0, 1.5f) : d.one(1, 1200), d.half(), {}};
    if (!k.distribution) return p;
    DistributionParams m;
    m.roughness = d.one(), m.roughnessv = d.one(), m.udir = d.half() ? d.unit() * .7f : Vec3();
    m.eta = d.half() ? Color(0) : Color(d.one(.5f, 2), d.one(.5f, 2), d.one(.5f, 2));
    m.k = d.half() ? Color(0) : Color(d.one(), d.one(), d.one());
    m.absorption = Color(d.one(), d.one(), d.one());
    for (int n = int(d.random() % 18); n > 0; --n) m.lobes.push_back(d.one(0, 1.5f));
    m.part = int(d.random() % 5) - 1;
    p.more = std::make_shared<DistributionParams>(m);
    return p;
}
/// What a lobe gives for a direction and for a pair of numbers.
struct Services {
    LobeValue value;
    Vec3 w;
    float drawn, albedo, spread, delta;
};
void expectSame(const Services& a, const Services& b, std::string_view kind, int width, int lane) {
    const bool same = sameBits(a.value.colour, b.value.colour) && sameBits(a.value.fcos, b.value.fcos) &&
                      sameBits(a.value.pdf, b.value.pdf) && sameBits(a.drawn, b.drawn) && (a.drawn == 0 || sameBits(a.w, b.w)) &&
                      sameBits(a.albedo, b.albedo) && sameBits(a.spread, b.spread) && sameBits(a.delta, b.delta);
    EXPECT_TRUE(same) << kind << " at " << width << " lanes, lane " << lane << ": " << a.value.fcos << " " << b.value.fcos << ", "
                      << a.value.pdf << " " << b.value.pdf << ", " << a.w.x << " " << b.w.x << ", " << a.drawn << " " << b.drawn;
}

/// Sixteen lobes of a kind in a block of its own, asked at a width.
struct Block {
    alignas(64) float rows[kLobeRows][kLobeBlock] = {}, from[3][kLobeBlock] = {}, u[2][kLobeBlock] = {},
                      value[kValueRows][kLobeBlock] = {}, drawn[kDrawnRows][kLobeBlock] = {};
};
void give(Block& b, int lane, const LobeParams& p) {
    const auto triple = [&](int row, const Vec3& v) {
        b.rows[row][lane] = v.x, b.rows[row + 1][lane] = v.y, b.rows[row + 2][lane] = v.z;
    };
    triple(kRowAxis, p.axis), triple(kRowWo, p.wo), triple(kRowHorizon, p.horizon);
    b.rows[kRowHasHorizon][lane] = p.hasHorizon, b.rows[kRowA][lane] = p.a;
    if (!p.more) return;
    b.rows[kRowRoughness][lane] = p.more->roughness, b.rows[kRowRoughnessV][lane] = p.more->roughnessv;
    triple(kRowUdir, p.more->udir), triple(kRowEta, p.more->eta), triple(kRowK, p.more->k),
        triple(kRowAbsorption, p.more->absorption);
    b.rows[kRowPart][lane] = float(p.more->part);
    const int count = std::min(int(p.more->lobes.size()), kMostLobeNumbers);
    b.rows[kRowCount][lane] = float(count);
    for (int i = 0; i < count; ++i) b.rows[kRowLobes + i][lane] = p.more->lobes[size_t(i)];
}
Services answersOf(const Block& b, int lane) {
    return {{{b.value[0][lane], b.value[1][lane], b.value[2][lane]}, b.value[kRowFcos][lane], b.value[kRowPdf][lane]},
            {b.drawn[0][lane], b.drawn[1][lane], b.drawn[2][lane]},
            b.drawn[kRowDrawn][lane],
            b.rows[kRowAlbedo][lane],
            b.rows[kRowSpread][lane],
            b.rows[kRowDelta][lane]};
}

class LobeLanesOf : public ::testing::TestWithParam<const LobeKind*> {};

// 40 blocks a width, a third of them with some lanes only. A lobe's bits depend on no other's.
TEST_P(LobeLanesOf, EveryWidthGivesTheBitsOfOne) {
    const LobeKind& k = *GetParam();
    for (int width : {4, 8, 16}) {
        const LobeLanesList list = lobeLanes(width);
        if (!list.count) continue; // not on this processor
        const LobeLanes& lanes = list.lobes[k.index];
        ASSERT_EQ(lanes.name, k.name);
        Draws d;
        for (int round = 0; round < 40; ++round) {
            Block b;
            const uint32_t mask = round % 3 ? 0xffff : uint32_t(d.random()) & 0xffff;
            std::vector<Services> want;
            for (int lane = 0; lane < kLobeBlock; ++lane) {
                const LobeParams p = lobeOf(d, k);
                const Vec3 w = d.unit();
                const Vec2 u{d.one(), d.one()};
                give(b, lane, p);
                b.from[0][lane] = w.x, b.from[1][lane] = w.y, b.from[2][lane] = w.z, b.u[0][lane] = u.x, b.u[1][lane] = u.y;
                const Bsdf one(k, p);
                Services a{one.value(w), {}, 0, one.albedo(), one.spread(), one.delta() ? 1.f : 0.f};
                a.drawn = one.sample(u, a.w) ? 1.f : 0.f;
                want.push_back(a);
            }
            lanes.prepare(b.rows[0], mask);
            lanes.evaluate(b.rows[0], mask, b.from[0], b.value[0]);
            lanes.sample(b.rows[0], mask, b.u[0], b.drawn[0]);
            for (int lane = 0; lane < kLobeBlock; ++lane)
                if (mask >> lane & 1) expectSame(answersOf(b, lane), want[size_t(lane)], k.name, width, lane);
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Kinds, LobeLanesOf, ::testing::ValuesIn(lobeKinds().begin(), lobeKinds().end()), [](const auto& i) {
    std::string name(i.param->name);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

// Lobes of all kinds mixed, some of them asked, in rounds; columns are used again after clear().
TEST(BsdfBatch, AnswersAreThoseOfOneLobe) {
    Draws d;
    BsdfBatch columns;
    for (int again = 0; again < 3; ++again) {
        columns.clear();
        std::vector<LobeParams> params;
        std::vector<const LobeKind*> kinds;
        std::vector<BsdfBatch::Place> places;
        for (int i = 0; i < 300; ++i) {
            kinds.push_back(lobeKinds()[d.random() % lobeKinds().size()]);
            params.push_back(lobeOf(d, *kinds.back()));
            places.push_back(columns.add(*kinds.back(), params.back()));
            if (i == 150) columns.prepare();
        }
        columns.prepare();
        for (int round = 0; round < 4; ++round) {
            std::vector<Vec3> from(params.size());
            std::vector<Vec2> u(params.size());
            std::vector<char> asked(params.size());
            for (size_t i = 0; i < params.size(); ++i) from[i] = d.unit(), u[i] = {d.one(), d.one()}, asked[i] = d.half();
            for (size_t i = 0; i < params.size(); ++i)
                if (asked[i]) columns.ask(places[i], from[i]);
            columns.evaluate();
            std::vector<Services> got(params.size());
            for (size_t i = 0; i < params.size(); ++i)
                got[i] = {columns.value(places[i]),
                          {},
                          0,
                          columns.albedo(places[i]),
                          columns.spread(places[i]),
                          columns.delta(places[i]) ? 1.f : 0.f};
            for (size_t i = 0; i < params.size(); ++i)
                if (asked[i]) columns.ask(places[i], u[i]);
            columns.sample();
            for (size_t i = 0; i < params.size(); ++i) {
                if (!asked[i]) continue;
                got[i].drawn = columns.drawn(places[i], got[i].w) ? 1.f : 0.f;
                const Bsdf one(*kinds[i], params[i]);
                Services want{one.value(from[i]), {}, 0, one.albedo(), one.spread(), one.delta() ? 1.f : 0.f};
                want.drawn = one.sample(u[i], want.w) ? 1.f : 0.f;
                expectSame(got[i], want, kinds[i]->name, 0, int(i));
            }
        }
    }
}

// A draw's density is that of its direction, and what is drawn where one lane of a value is wanted is the code of bsdf():
// Lambert's law, the closed form of a uniform cone, and a mirror-like exponent's peak.
TEST(BsdfBatch, ClosedForms) {
    LobeParams p{{0, 0, 1}, {0, 0, 1}, {}, 0, false, {}};
    const Vec3 w = normalize(Vec3(.6f, 0, .8f));
    EXPECT_NEAR(findLobe("diffuse")->fcos(p, w), .8 / kPi, 1e-7);
    p.a = 20;
    EXPECT_NEAR(findLobe("specular")->fcos(p, w), std::pow(std::sqrt(.9), 20) / kPi, 1e-6);
    EXPECT_NEAR(findLobe("phong")->fcos(p, w), std::pow(.8, 20) / kPi, 1e-7);
    EXPECT_NEAR(findLobe("slphong")->pdf(p, w), 21 / (2 * kPi) * std::pow(.8, 20), 1e-6);
    p.a = 1;
    EXPECT_NEAR(findLobe("uniform")->pdf(p, w), 1 / (2 * kPi * (1 - std::cos(1.))), 1e-6);
    EXPECT_NEAR(findLobe("cosine")->pdf(p, w), .8 / (kPi * std::pow(std::sin(1.), 2)), 1e-6);
}

} // namespace

} // namespace lobelanes_test
