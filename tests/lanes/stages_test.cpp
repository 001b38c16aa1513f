// Stages over blocks (lanes/stages.h): every width gives the same bits, those of functions of one point.
#include "base/direction.h"
#include "bsdf/sampling.h"
#include "geometry/shape.h"
#include "lanes/stages.h"
#include "services/random.h"
#include <bit>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

namespace stages_test {

using namespace alpenglow;
using namespace alpenglow::lanes;

namespace {

struct Draws {
    std::mt19937 random{11};
    float one(float low = 0, float high = 1) { return low + (high - low) * std::generate_canonical<float, 24>(random); }
    Vec3 vector(float size) { return {one(-size, size), one(-size, size), one(-size, size)}; }
    bool rarely() { return random() % 8 == 0; }
};
Vec3 at(const Row* r, int i) { return {r[0][i], r[1][i], r[2][i]}; }
void put(Row* r, int i, const Vec3& v) { r[0][i] = v.x, r[1][i] = v.y, r[2][i] = v.z; }
bool same(float a, float b) {
    return (std::isnan(a) && std::isnan(b)) || std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b);
}
bool same(const Vec3& a, const Vec3& b) { return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z); }

VertexBlock vertices(Draws& d) {
    VertexBlock v{};
    for (int i = 0; i < kBlock; ++i) {
        put(v.P, i, d.rarely() ? Vec3(0) : d.vector(9));
        put(v.n, i, normalize(d.vector(1)));
        put(v.I, i, d.rarely() ? Vec3(0) : d.vector(5));
        put(v.weight, i, {d.one(0, 2), d.one(0, 2), d.one(0, .5f)});
        v.error[i] = geometry::roundingError(at(v.P, i));
        v.bias[i] = d.rarely() ? .01f : 0;
        v.bounces[i] = int32_t(d.random() % 6);
        v.vertex[i] = uint32_t(d.random());
    }
    v.points = d.rarely() ? 0x0fffu : 0xffffu;
    return v;
}
Vec3 leave(const VertexBlock& v, int i, const Vec3& w) {
    const Vec3 P = at(v.P, i);
    return v.bias[i] > 0 ? P + w * v.bias[i] : geometry::offsetOrigin(P, at(v.n, i), v.error[i], w);
}
std::vector<const Stages*> widths() {
    std::vector<const Stages*> all;
    for (int lanes : {4, 8, 16})
        if (const Stages* s = stages(lanes)) all.push_back(s);
    return all;
}
LobeBlock lobe(Draws& d, bool single) {
    LobeBlock l{};
    l.asked = Lanes(d.random()) & 0xffffu;
    for (int i = 0; i < kBlock; ++i) {
        put(l.weight, i, {d.one(-.2f, 1), d.one(), d.one()});
        l.lobe[kRowAlbedo][i] = d.rarely() ? 0 : d.one(0, 1.2f);
        l.lobe[kRowDelta][i] = single;
        l.lobe[kRowSpread][i] = d.one();
    }
    return l;
}
} // namespace

TEST(Stages, RequestsAreThoseOfOnePoint) {
    Draws d;
    constexpr int kRows = 16, kStride = 64;
    alignas(64) static float rows[kRows * kStride];
    LobeArguments a;
    a.axis = 3, a.wo = 6, a.horizon = 9, a.a = 12, a.from = 0, a.needsWo = a.traces = true;
    for (int turn = 0; turn < 200; ++turn) {
        const VertexBlock v = vertices(d);
        for (float& x : rows) x = d.one(-2, 2);
        for (int i = 0; i < kBlock; ++i) {
            for (int q = 0; q < 3; ++q) {
                rows[(3 + q) * kStride + i] = v.P[q][i]; // trace() starts at the point
                if (i == turn % 29) rows[(3 + q) * kStride + i] += 1;
                if (i == turn % 31) rows[(6 + q) * kStride + i] = 0;
                if (i == turn % 37) rows[q * kStride + i] = 0;
                if (i == turn % 41) rows[(9 + q) * kStride + i] *= 1e-20f;
            }
        }
        for (const Stages* s : widths()) {
            LobeBlock l{};
            const Lanes odd = s->request(v, a, rows, kStride, 0xffffu, l);
            for (int i = 0; i < kBlock; ++i) {
                const auto triple = [&](int row) {
                    return Vec3(rows[row * kStride + i], rows[(row + 1) * kStride + i], rows[(row + 2) * kStride + i]);
                };
                const bool asks = !(triple(0) == Vec3(0)) && !(triple(6) == Vec3(0));
                EXPECT_EQ(l.asked >> i & 1, asks);
                if (!asks) continue;
                EXPECT_EQ(odd >> i & 1, i == turn % 41) << "a direction whose square no float holds";
                EXPECT_EQ(l.ownOrigin >> i & 1, i == turn % 29);
                if (odd >> i & 1) continue;
                const Vec3 n = at(v.n, i), viewer = normalizeOr(-at(v.I, i), n);
                EXPECT_TRUE(same(at(l.weight, i), triple(0)));
                EXPECT_TRUE(same(at(l.lobe + kRowAxis, i), directionOr(triple(6), n)));
                EXPECT_TRUE(same(at(l.lobe + kRowWo, i), directionOr(triple(9), viewer)));
                EXPECT_TRUE(same(at(l.lobe + kRowHorizon, i), directionOr(triple(12), n)));
                EXPECT_TRUE(same(l.lobe[kRowA][i], rows[15 * kStride + i]));
            }
        }
    }
}

/// The chances at point i, and what they leave to the ray behind it: light comes through there.
struct Chances {
    std::vector<float> chosen;
    std::vector<bool> ended;
    float passes = 1, scale = 1;
};
Chances chancesOf(const VertexBlock& v, const std::vector<LobeBlock>& lobes, int i) {
    Chances c;
    const Color clear = v.through ? at(v.clear, i) : Color(0), left = absolute(at(v.weight, i));
    const Color beyond = v.through ? at(v.beyond, i) : Color(0); // another one for photons
    const bool competes = v.bounces[i] > 0 && maxComponent(beyond) > 0;
    const auto worth = [&](const Color& share) { return competes ? dot(share, left) / 3 : luminance(share); };
    Color sum(0);
    int asked = 0;
    for (size_t k = 0; k < lobes.size(); ++k) {
        const bool asks = lobes[k].asked >> i & 1;
        const Color w = absolute(at(lobes[k].weight, i));
        const bool deep = (v.deep[k == 1] & (v.last | ~lobes[k].boundless)) >> i & 1;
        c.chosen.push_back(asks && !deep ? worth(w) * lobes[k].lobe[kRowAlbedo][i] : 0);
        c.ended.push_back(asks && deep && worth(w) * lobes[k].lobe[kRowAlbedo][i] > 0);
        if (asks && k % 2 == 0) sum += w * lobes[k].lobe[kRowAlbedo][i];
        asked += asks;
    }
    for (int q = 0; q < 3; ++q)
        if (sum[q] + clear[q] > 1 && sum[q] > 0) c.scale = std::min(c.scale, (1 - clear[q]) / sum[q]);
    const float behind = competes ? worth(beyond) : 0;
    double total = behind;
    for (size_t k = 0; k < lobes.size(); ++k) {
        if (behind > 0 && k % 2 == 0) c.chosen[k] *= std::max(c.scale, 1 / 32.f);
        total += c.chosen[k];
    }
    for (float& x : c.chosen) x = asked == 1 && behind == 0 ? x > 0 : total > 0 ? float(x / total) : 0;
    if (behind > 0 && total > behind) c.passes = float(behind / total);
    return c;
}

TEST(Stages, SelectsByWhatLobesGiveBack) {
    Draws d;
    size_t passing = 0;
    for (int turn = 0; turn < 300; ++turn) {
        VertexBlock before = vertices(d);
        before.through = turn % 3 == 0;
        before.last = d.rarely() ? uint32_t(d.random()) & 0xffffu : 0;
        for (Lanes& deep : before.deep) deep = before.last | (d.rarely() ? uint32_t(d.random()) & 0xffffu : 0);
        for (int i = 0; i < kBlock; ++i) {
            put(before.clear, i, d.rarely() ? Color(0) : Color(d.one(), d.one(), d.one()));
            put(before.beyond, i, d.rarely() ? Color(1) : at(before.clear, i));
        }
        std::vector<LobeBlock> lobes;
        for (int k = 0; k < 1 + turn % 4; ++k) {
            lobes.push_back(lobe(d, false));
            lobes.back().boundless = d.rarely() ? uint32_t(d.random()) & 0xffffu : 0;
        }
        for (const Stages* s : widths()) {
            VertexBlock v = before;
            std::vector<LobeBlock> mine = lobes;
            std::vector<LobeBlock*> sites;
            for (LobeBlock& l : mine) sites.push_back(&l);
            constexpr SiteRules kRules[4] = {{true, false, false}, {false, true, false}, {true, false, false}, {}};
            const Selected found = s->select(v, sites.data(), int(sites.size()), {kRules});
            EXPECT_EQ(found.failed, 0u);
            EXPECT_EQ(found.cut & ~before.last, 0u);
            for (int i = 0; i < kBlock; ++i) {
                const Chances c = chancesOf(before, lobes, i);
                for (size_t k = 0; k < lobes.size(); ++k) {
                    EXPECT_TRUE(same(mine[k].chosen[i], c.chosen[k])) << k << " of " << lobes.size();
                    EXPECT_EQ(mine[k].ended >> i & 1, c.ended[k]) << k << " of " << lobes.size();
                }
                EXPECT_TRUE(same(v.energyScale[i], c.scale));
                EXPECT_TRUE(same(v.passes[i], c.passes));
                EXPECT_EQ((found.bright | found.brightWithClear) >> i & 1, c.scale < .999f && (v.points >> i & 1));
                passing += c.passes < 1;
            }
        }
    }
    EXPECT_GT(passing, 500u);
}

TEST(Stages, ShadowRaysStopBeforeTheEmitter) {
    Draws d;
    for (int turn = 0; turn < 200; ++turn) {
        const VertexBlock v = vertices(d);
        LightBlock l{};
        l.emitter = turn % 2, l.met = turn % 3 == 0, l.asked = Lanes(d.random()) & 0xffffu;
        l.metDiffuse = Lanes(d.random()) & 0xffffu;
        LobeBlock b = lobe(d, false);
        b.lights = b.asked;
        alignas(64) float value[kValueRows][kBlock];
        for (int i = 0; i < kBlock; ++i) {
            put(l.w, i, normalize(d.vector(1)));
            put(l.Cl, i, {d.one(), d.one(), d.one()});
            put(l.end, i, d.vector(20));
            l.far[i] = d.one(1, 9), l.density[i] = d.one(.1f, 4), l.keptDiffuse[i] = d.one(), l.keptSpecular[i] = d.one();
            for (auto& row : value) row[i] = d.one();
            if (d.rarely()) value[kRowFcos][i] = 0;
        }
        for (const Stages* s : widths()) {
            ShadowBlock to{};
            s->aim(v, l, to);
            Lanes failed = 1;
            LobeBlock chosen = b;
            for (float& c : chosen.chosen) c = .25f;
            const Lanes some = s->contribute(v, chosen, l, l.keptDiffuse, l.metDiffuse, turn % 5 == 0, value[0], to, &failed);
            EXPECT_EQ(failed, 0u);
            for (int i = 0; i < kBlock; ++i) {
                const Vec3 w = at(l.w, i), from = leave(v, i, w), way = at(l.end, i) - from;
                EXPECT_TRUE(same(at(to.origin, i), from));
                EXPECT_TRUE(same(at(to.direction, i), l.emitter ? normalizeOr(way, w) : w));
                EXPECT_TRUE(same(to.length[i], l.emitter ? length(way) * (1 - 1e-6f) : l.far[i]));
                const float fcos = value[kRowFcos][i], pdf = value[kRowPdf][i];
                const bool ahead = turn % 5 || !l.emitter || dot(way, w) > 0;
                EXPECT_EQ(some >> i & 1, (b.lights & l.asked) >> i & 1 && fcos > 0 && ahead);
                if (!(some >> i & 1)) continue;
                Color c = at(b.weight, i) * at(v.weight, i) * at(l.Cl, i);
                c *= Color(value[0][i], value[1][i], value[2][i]) / fcos;
                const float other = l.metDiffuse >> i & 1 ? pdf * .25f : 0, kept = l.keptDiffuse[i];
                if (l.met) c = c * (kept * fcos / l.density[i] * misWeight(l.density[i], other));
                else c = c * (kept * kFloatPi * fcos / l.density[i]);
                EXPECT_TRUE(same(at(to.light, i), c));
            }
        }
    }
}

TEST(Stages, LightsWithoutGeometryStandWhereTheySay) {
    Draws d;
    constexpr int kStride = 48;
    alignas(64) static float L[3 * kStride];
    for (int turn = 0; turn < 100; ++turn) {
        for (int i = 0; i < kBlock; ++i) {
            const Vec3 way = i == turn % 19   ? Vec3(0)
                             : i == turn % 23 ? d.vector(1e-20f)
                             : i == turn % 29 ? d.vector(1e25f)
                                              : d.vector(9);
            for (int q = 0; q < 3; ++q) L[q * kStride + i] = way[q];
        }
        for (const Stages* s : widths())
            for (const bool endless : {false, true}) {
                LightBlock l{};
                const Lanes odd = s->placeFar(L, kStride, endless, l);
                for (int i = 0; i < kBlock; ++i) {
                    const Vec3 way(L[i], L[kStride + i], L[2 * kStride + i]);
                    EXPECT_EQ(odd >> i & 1, i == turn % 19 || i == turn % 23 || i == turn % 29);
                    const float far = endless ? 1e38f : length(way);
                    EXPECT_TRUE(same(l.far[i], far < 1e30f ? far * (1 - 1e-5f) : far));
                    EXPECT_EQ(l.density[i], 1);
                    if (!(odd >> i & 1)) EXPECT_TRUE(same(at(l.w, i), directionOr(-way, Vec3(0, 0, 1))));
                }
            }
    }
}

TEST(Stages, PathsGoOnAsThoseOfOnePoint) {
    Draws d;
    const uint32_t keys[] = {7, 900, 13};
    for (int turn = 0; turn < 300; ++turn) {
        VertexBlock v = vertices(d);
        const int count = 1 + turn % 3;
        const Roulette rule = Roulette(turn / 3 % 3);
        v.through = turn % 4 == 0;
        for (float& p : v.passes) p = v.through && d.rarely() ? d.one() : 1;
        std::vector<LobeBlock> lobes;
        for (int k = 0; k < count; ++k) lobes.push_back(lobe(d, k == 1));
        alignas(64) float number[kBlock], drawn[kDrawnRows][kBlock], value[kValueRows][kBlock], dice[kBlock];
        for (int i = 0; i < kBlock; ++i) {
            float total = 0; // chances of the lobes of a point sum up to 1
            for (LobeBlock& l : lobes) total += l.chosen[i] = l.asked >> i & 1 ? d.one() : 0;
            for (LobeBlock& l : lobes)
                l.chosen[i] = total > 0 ? l.chosen[i] / total * (v.passes[i] < 1 ? 1 - v.passes[i] : 1) : 0;
            number[i] = d.one(), dice[i] = d.one();
            put(drawn, i, normalize(d.vector(1)));
            drawn[kRowDrawn][i] = !d.rarely();
            for (auto& row : value) row[i] = d.one();
            if (d.rarely()) value[kRowPdf][i] = 0;
        }
        std::vector<const LobeBlock*> sites;
        for (const LobeBlock& l : lobes) sites.push_back(&l);
        for (const Stages* s : widths()) {
            ScatterBlock to{};
            VertexBlock after = v;
            s->pick(after, sites.data(), count, number, to);
            for (int k = 0; k < count; ++k) s->takeDirections(lobes[size_t(k)], k, k == 0, drawn[0], to);
            for (int k = 0; k < count; ++k) s->takeValues(lobes[size_t(k)], k, value[0], to);
            s->name(v, keys, to);
            std::copy_n(dice, kBlock, to.dice);
            EXPECT_EQ(s->extend(v, rule, to), 0u);
            for (int i = 0; i < kBlock; ++i) {
                int picked = -1, last = -1, asked = 0;
                float sum = 0;
                for (int k = 0; k < count; ++k)
                    if (lobes[size_t(k)].asked & v.points & (1u << i)) last = k, ++asked;
                for (int k = 0; k < count; ++k) {
                    const LobeBlock& l = lobes[size_t(k)];
                    if (!(l.asked & v.points & (1u << i)) || !(l.chosen[i] > 0)) continue;
                    sum += l.chosen[i];
                    if (picked < 0 && (number[i] < sum || (!(v.passes[i] < 1) && (k == last || asked == 1)))) picked = k;
                }
                ASSERT_EQ(to.site[i], picked);
                EXPECT_EQ(after.passes[i], v.passes[i] < 1 && picked >= 0 ? 0 : v.passes[i]);
                if (picked < 0 || drawn[kRowDrawn][i] == 0) {
                    EXPECT_FALSE(to.goes >> i & 1);
                    continue;
                }
                const LobeBlock& l = lobes[size_t(picked)];
                EXPECT_EQ(to.vertex[i], services::childVertex(v.vertex[i], keys[picked], 0));
                const bool single = l.lobe[kRowDelta][i] != 0;
                const float pdf = value[kRowPdf][i];
                const Color f = single    ? Color(l.lobe[kRowAlbedo][i])
                                : pdf > 0 ? Color(value[0][i], value[1][i], value[2][i]) / pdf
                                          : Color(0);
                Color weight = at(v.weight, i) * (at(l.weight, i) * (f * (1 / l.chosen[i])));
                const int depth = v.bounces[i] + 1;
                const float q = rule == Roulette::None || depth <= 3 ? 1
                                : rule == Roulette::Local            ? rouletteLocal(depth, at(l.weight, i), dice[i])
                                                                     : rouletteOfPath(weight, [&] { return dice[i]; });
                EXPECT_EQ(to.goes >> i & 1, !(weight == Color(0)) && q > 0);
                if (!(to.goes >> i & 1)) continue;
                EXPECT_TRUE(same(at(to.weight, i), weight / q));
                EXPECT_TRUE(same(at(to.origin, i), leave(v, i, at(drawn, i))));
                EXPECT_EQ(to.spread[i], l.lobe[kRowSpread][i]);
                EXPECT_EQ(to.indirect[i], picked == 0 ? 1 : 0);
            }
        }
    }
}

TEST(Stages, StructuresBecomeRowsAndRowsStructures) {
    Draws d;
    for (const Stages* stage : widths())
        for (int turn = 0; turn < 200; ++turn) {
            const int words = turn % 3 == 0 ? 32 : turn % 3 == 1 ? 16 : 30, stride = words + turn % 4, count = 1 + turn % kBlock;
            std::vector<uint32_t> from(size_t(stride * count));
            for (uint32_t& w : from) w = uint32_t(d.random());
            alignas(64) uint32_t rows[32][kBlock] = {};
            stage->load(from.data(), 4 * stride, count, words, rows);
            for (int i = 0; i < kBlock; ++i)
                for (int w = 0; w < words; ++w)
                    ASSERT_EQ(rows[w][i], from[size_t(std::min(i, count - 1) * stride + w)]) << words << " words, " << count;
            if (words % 16 != 0) continue;
            const Lanes which = uint32_t(d.random()) & 0xffffu;
            std::vector<uint32_t> to(size_t((kBlock + 1) * words), 7);
            ASSERT_EQ(stage->store(rows, words, which, to.data()), std::popcount(which));
            for (int i = 0, at = 0; i < kBlock; ++i) {
                if (!(which >> i & 1)) continue;
                for (int w = 0; w < words; ++w) ASSERT_EQ(to[size_t(at * words + w)], rows[w][i]);
                ++at;
            }
            for (size_t behind = size_t((std::popcount(which) + 1) * words); behind < to.size(); ++behind)
                ASSERT_EQ(to[behind], 7u);
        }
}

} // namespace stages_test
