// Light-directed sampling (lightdirected.h) at vertices on surfaces in scattering media.
#include "integrator/lobeselection.h"
#include "integrator/medium.h"
#include <bit>

namespace alpenglow::integrator {

/// Selects lights for light-directed sampling, and the lobes that use it.
void LobeSelection::lightDirections(const BatchContext& c) {
    for (size_t k = 0; k < v_.count; ++k) v_.sites[k].lightDirected.clear();
    if (v_.waits || c.between || !mediumEvents_.surfacesAim()) return; // rays of waiting kernels follow the lobe's density alone
    for (size_t b = 0; b < v_.blocks; ++b) {
        Lanes some = 0;
        for (size_t k = 0; k < v_.count; ++k) some |= v_.sites[k].spreads(b);
        for (some &= v_.vertices[b].points; some; some &= some - 1) {
            const int lane = std::countr_zero(some);
            const size_t point = b * kBlock + size_t(lane);
            const LightDirected lightDirected = mediumEvents_.atSurfaceInMedium(c, point);
            if (!(lightDirected.share > 0)) continue;
            for (size_t k = 0; k < v_.count; ++k) {
                if (!(v_.sites[k].spreads(b) >> lane & 1)) continue;
                v_.sites[k].lightDirected.resize(v_.blocks * kBlock);
                v_.sites[k].lightDirected[point] = lightDirected;
            }
        }
    }
    for (size_t k = 0; k < v_.count; ++k)
        for (size_t b = 0; b < v_.blocks && !v_.sites[k].lightDirected.empty(); ++b) v_.sites[k].weighLightDirected(b, v_.value);
}

Lanes BlockLobes::spreads(size_t b) const {
    const LobeBlock& l = lobes[b];
    Lanes some = 0;
    for (int i = 0; i < kBlock; ++i) some |= Lanes(l.chosen[i] > 0 && l.lobe[kRowDelta][i] == 0) << i;
    return walks || (info && info->trace && info->trace->onlyLights) ? 0 : some & l.asked & ~l.ownOrigin;
}

void BlockLobes::weighLightDirected(size_t b, Row* value) {
    LightDirected* const of = &lightDirected[b * kBlock];
    Lanes asked = 0;
    alignas(64) Row w[3];
    for (int i = 0; i < kBlock; ++i) {
        asked |= Lanes(of[i].share > 0) << i;
        for (int q = 0; q < 3; ++q) w[q][i] = of[i].light[q];
    }
    if (!asked) return;
    lanes->evaluate(lobes[b].lobe[0], asked, w[0], value[0]);
    for (; asked; asked &= asked - 1) {
        const int i = std::countr_zero(asked);
        of[i].weigh({{}, value[kRowFcos][i], value[kRowPdf][i]});
    }
}

void BlockLobes::addLightDirected(Lanes some, const Row* w, const size_t* pointOf, float* pdf) const {
    for (some = lightDirected.empty() ? 0 : some; some; some &= some - 1) {
        const int i = std::countr_zero(some);
        pdf[i] = lightDirected[pointOf[i]].density({w[0][i], w[1][i], w[2][i]}, pdf[i]);
    }
}

void BlockLobes::draw(size_t b, Lanes some, NumberBlock& u, Row* drawn) const {
    Vec3 directions[kBlock];
    Lanes directed = 0;
    for (Lanes left = lightDirected.empty() ? 0 : some; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        Vec2 pair{u.x[i], u.y[i]};
        const std::optional<Vec3> w = lightDirected[b * kBlock + size_t(i)].draw(pair);
        u.x[i] = pair.x;
        if (!w) continue;
        directions[i] = *w;
        directed |= 1u << i;
    }
    lanes->sample(lobes[b].lobe[0], some & ~directed, u.x, drawn[0]);
    for (; directed; directed &= directed - 1) {
        const int i = std::countr_zero(directed);
        for (int q = 0; q < 3; ++q) drawn[kRowDirection + q][i] = directions[i][q];
        drawn[kRowDrawn][i] = 1;
    }
}

} // namespace alpenglow::integrator
