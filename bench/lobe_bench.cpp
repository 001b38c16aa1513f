// What lobes cost: nanoseconds a lobe of each kind to prepare it, for a value with its density, and for a draw; one by one
// (Bsdf, as nobody does in a loop), in full blocks at each width, and in blocks by way of BsdfBatch as the engine asks. The
// best of several runs.
#include "bsdf/lobe.h"
#include <chrono>
#include <cstdio>
#include <cstring>
#include <random>

using namespace alpenglow;
using namespace alpenglow::bsdf;

namespace {
constexpr int kLobes = 1024, kRuns = 15;
volatile float kept; ///< so that nothing is left out

/// Best time of a run of `work` over kLobes lobes, ns a lobe.
template <class Work> double nanoseconds(const Work& work) {
    double best = 1e30;
    for (int run = 0; run < kRuns; ++run) {
        const auto from = std::chrono::steady_clock::now();
        work();
        best = std::min(best, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - from).count() / kLobes);
    }
    return best;
}

struct Lobes {
    std::vector<LobeParams> params;
    std::vector<Vec3> from;
    std::vector<Vec2> u;
    explicit Lobes(const LobeKind& kind) {
        std::mt19937 random(5);
        const auto one = [&](float low, float high) { return low + (high - low) * std::generate_canonical<float, 24>(random); };
        for (int i = 0; i < kLobes; ++i) {
            const Vec3 n = normalize(Vec3(one(-1, 1), one(-1, 1), one(-1, 1)));
            const auto above = [&] { return normalize(n + normalize(Vec3(one(-1, 1), one(-1, 1), one(-1, 1))) * .9f); };
            LobeParams p{n, above(), {}, one(.1f, 1.5f), false, {}};
            if (kind.name == "specular" || kind.name == "phong" || kind.name == "slphong") p.a = one(2, 80);
            if (kind.distribution) {
                DistributionParams m;
                m.roughness = one(.1f, .6f), m.roughnessv = one(.1f, .6f), m.udir = {1, .2f, .1f};
                m.eta = Color(1.5f, 1.4f, 2), m.k = Color(.5f, 1, 2), m.absorption = Color(.2f, .4f, .8f);
                p.more = std::make_shared<DistributionParams>(m);
            }
            params.push_back(p);
            from.push_back(above());
            u.push_back({one(0, 1), one(0, 1)});
        }
    }
};

void measure(const LobeKind& kind) {
    const Lobes lobes(kind);
    const auto n = size_t(kLobes);
    const double alone = nanoseconds([&] {
        for (size_t i = 0; i < n; ++i) kept = Bsdf(kind, lobes.params[i]).value(lobes.from[i]).fcos;
    });
    std::vector<Bsdf> ready;
    for (size_t i = 0; i < n; ++i) ready.emplace_back(kind, lobes.params[i]);
    const double one = nanoseconds([&] {
        for (size_t i = 0; i < n; ++i) kept = ready[i].value(lobes.from[i]).fcos;
    });
    BsdfBatch columns;
    std::vector<BsdfBatch::Place> place(n);
    const double add = nanoseconds([&] {
        columns.clear();
        for (size_t i = 0; i < n; ++i) place[i] = columns.add(kind, lobes.params[i]);
        columns.prepare();
    });
    const double value = nanoseconds([&] {
        for (size_t i = 0; i < n; ++i) columns.ask(place[i], lobes.from[i]);
        columns.evaluate();
        for (size_t i = 0; i < n; ++i) kept = columns.value(place[i]).fcos;
    });
    const double draw = nanoseconds([&] {
        Vec3 w;
        for (size_t i = 0; i < n; ++i) columns.ask(place[i], lobes.u[i]);
        columns.sample();
        for (size_t i = 0; i < n; ++i) {
            columns.drawn(place[i], w);
            kept = w.x;
        }
    });
    std::printf("%-18.*s %8.1f %8.1f | %8.1f %8.1f %8.1f |", int(kind.name.size()), kind.name.data(), alone, one, add, value,
                draw);
    // Whole blocks, nothing but the lobes' code.
    for (int width : {4, 8, 16}) {
        const LobeLanesList list = lobeLanes(width);
        if (!list.count) continue;
        struct alignas(64) Block {
            float rows[kLobeRows][kLobeBlock], in[3][kLobeBlock], value[kValueRows][kLobeBlock];
        };
        static Block b[kLobes / kLobeBlock];
        std::memset(b, 0, sizeof b);
        const LobeLanes& lanes = list.lobes[kind.index];
        for (size_t i = 0; i < n; ++i) {
            Block& of = b[i / kLobeBlock];
            const LobeParams& p = lobes.params[i];
            const size_t l = i % kLobeBlock;
            const auto triple = [&](int row, const Vec3& v) {
                of.rows[row][l] = v.x, of.rows[row + 1][l] = v.y, of.rows[row + 2][l] = v.z;
            };
            triple(kRowAxis, p.axis), triple(kRowWo, p.wo), of.rows[kRowA][l] = p.a;
            if (p.more) {
                of.rows[kRowRoughness][l] = p.more->roughness, of.rows[kRowRoughnessV][l] = p.more->roughnessv,
                of.rows[kRowPart][l] = -1;
                triple(kRowUdir, p.more->udir), triple(kRowEta, p.more->eta), triple(kRowK, p.more->k),
                    triple(kRowAbsorption, p.more->absorption);
            }
            of.in[0][l] = lobes.from[i].x, of.in[1][l] = lobes.from[i].y, of.in[2][l] = lobes.from[i].z;
        }
        for (Block& of : b) lanes.prepare(of.rows[0], 0xffff);
        std::printf(" %8.1f", nanoseconds([&] {
                        for (Block& of : b) lanes.evaluate(of.rows[0], 0xffff, of.in[0], of.value[0]);
                    }));
    }
    std::printf("\n");
}
} // namespace

int main() {
    std::printf("ns a lobe                   one by one |             in columns     | value alone, by width\n");
    std::printf("%-18s %8s %8s | %8s %8s %8s | %8s %8s %8s\n", "", "anew", "value", "prepare", "value", "draw", "4", "8", "16");
    for (const LobeKind* kind : lobeKinds()) measure(*kind);
}
