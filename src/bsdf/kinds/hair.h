// trace()'s "hair": a fibre with direction axis. part: a single lobe (R, TT, TRT, TRRT). Directions are sampled uniformly over
// the sphere: unbiased for any lobes, but noisy for narrow ones.
#pragma once
#include "bsdf/kinds/lobe.h"
#include "shadeops/bsdf/hair.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// The lobe "hair" (formula: shadeops/bsdf).
struct Hair {
    static constexpr const char* name = "hair";
    static constexpr const char* doc = "Light scattered by a fibre that points along axis.";
    static constexpr bool distribution = true;
    static constexpr int needs = kNeedsWo | kNeedsSurface | kNeedsNumbers;
    static constexpr float eta = kHairEta;
    static constexpr int kLobes = 4, kNumbers = 4; ///< 3Delight manual, 6.4.5.2: up to 4 lobes of 4 numbers
    // Rows of a lobe: weight (0: absent), sine and cosine of its tilt, longitudinal variance, and the three numbers of its bell.
    static AL_MEMBER void prepare(const Rows& p) {
        p.common(vf(1), vf(0.5f), vf(0));
        const vf count = p.number(kRowCount), part = p.number(kRowPart),
                 lobes = select(count > 0, floorLanes(count * vf(1.0f / kNumbers)), vf(3));
        const vm unset = count == 0;
        const auto given = [&](int i, int k, float otherwise) __attribute__((always_inline)) {
            return select(unset, vf(otherwise), p.number(kRowLobes + kNumbers * i + k));
        };
        vf largest = vf(1); // weights above 1 are scaled down together
        for (int i = 0; i < kLobes; ++i) largest = maxLanes(select(lobes > float(i), given(i, 0, 1), vf(1)), largest);
        for (int i = 0; i < kLobes; ++i) {
            const vm here = (lobes > float(i)) & ((part < 0) | (part == float(i)));
            const vf turn = given(i, 1, 0) * vf(2 - 3 * float(i));
            // Overwrites the input numbers.
            const vf weight = where(here, given(i, 0, 1) / largest), along = hairVariance(given(i, 2, 0.3f)),
                     width = hairBellWidth(given(i, 3, 0.3f));
            p.own(4 * i, weight), p.own(4 * i + 1, turn), p.own(4 * i + 2, along), p.own(4 * i + 3, width);
        }
    }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const Direction tip = p.axis(), absorption = p.triple(kRowAbsorption);
        const HairLight<vf> g =
            hairLight(w, tip, p.wo(), tangents(tip, p.triple(kRowUdir)), p.triple(kRowUdir), p.number(kRowEta));
        HairLobe<vf> lobe[kLobes];
        vf weight[kLobes];
        int count = 0; // lobes present in some lane; the other lanes add zeros
        for (int i = 0; i < kLobes; ++i) {
            const vf share = p.own(4 * i), turn = p.own(4 * i + 1);
            if (!__builtin_reduce_or(share != 0)) continue;
            weight[count] = share;
            lobe[count++] =
                hairLobe(g, vf(float(i)), sinLanes(turn), cosLanes(turn), p.own(4 * i + 2), HairBell<vf>(p.own(4 * i + 3)));
        }
        for (int i = 0; i < kHairPieces; ++i) {
            const HairPiece<vf> piece = hairPiece(g, absorption, i);
            for (int k = 0; k < count; ++k) addPiece(lobe[k], g, piece, i);
        }
        Direction sum = none3<vf>();
        for (int k = 0; k < count; ++k)
            sum = sum + select3(weight[k] != 0, times(lobe[k].around, lobe[k].along * g.crossing * weight[k]), none3<vf>());
        return {sum, vf(0.25f / kPi)};
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        w = toWorld(basisAbout(p.axis()), sampleCone(vf(2), u));
        return u.a == u.a;
    }
};

} // namespace alpenglow::bsdf::AL_NAMESPACE
