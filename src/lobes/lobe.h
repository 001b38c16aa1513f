// Lobes: what a vertex does to light. One file each in lobes/; each is one kind, known to trace() and the lighting shadeops by
// name. The value of a lobe is f cos (docs/light.md): the shadeop's result is the integral of L f cos over directions, so
// diffuse() of radiance 1 from everywhere is 1 and a light's Cl (irradiance / pi) is scored pi f cos Cl.
//
// Their code runs over blocks of 16 lobes of a kind (lobelanes.h). LobeColumns holds those of a batch; OneLobe asks one alone,
// with the same bits.
#pragma once
#include "base/vec.h"
#include "lobes/lobelanes.h"
#include <algorithm>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace alpenglow::transport {

/// What the distributions that trace() has in common with bsdf() take beside the rest (3Delight manual, 6.4.5.2). Current space.
struct DistributionParams {
    float roughness = 0, roughnessv = 0;
    Vec3 udir;
    Color eta{0}, k{0};       ///< index of refraction and extinction; glass-ggx and hair: the first channel of eta
    Color absorption{0};      ///< hair
    std::vector<float> lobes; ///< glass-ggx: weights of reflection and refraction; hair: four numbers a lobe
    int part = -1;            ///< glass-ggx: 0 reflection, 1 refraction; hair: the lobe; -1: all
};

/// Parameters of a lobe at one vertex, in current space. Which are used is said by the kind.
struct LobeParams {
    Vec3 axis;    ///< normal, mirror or cone direction; unit
    Vec3 wo;      ///< toward the viewer; unit
    Vec3 horizon; ///< normal of the plane that cuts the lobe; used when hasHorizon
    float a = 0;  ///< roughness, exponent or cone half angle
    bool hasHorizon = false;
    std::shared_ptr<const DistributionParams> more; ///< kinds with `distribution` need it; null for others
};

/// A lobe for light that arrives from one direction.
struct LobeValue {
    Color colour{0}; ///< f cos by channel; >= 0; per steradian
    float fcos = 0;  ///< the largest channel
    float pdf = 0;   ///< density of sample() per solid angle
};

struct LobeKind {
    std::string_view name;
    std::string_view doc;
    bool distribution = false; ///< reads LobeParams::more
    int index = 0;             ///< in lobeKinds() and in lobeLanes()

    // One lobe, asked once; see OneLobe.
    bool isDelta(const LobeParams&) const;
    float fcos(const LobeParams&, Vec3 w) const;
    float pdf(const LobeParams&, Vec3 w) const;
    bool sample(const LobeParams&, Vec2 u, Vec3& w) const;
    float albedo(const LobeParams&) const;
    float spread(const LobeParams&) const;
};

/// One lobe by itself.
class OneLobe {
public:
    OneLobe(const LobeKind&, const LobeParams&);
    /// w is unit.
    LobeValue value(const Vec3& w) const;
    /// Draws a direction by u, 0 to 1; false: this draw brings nothing (it counts as a sample of value 0).
    bool sample(Vec2 u, Vec3& w) const;
    /// About the integral of fcos; for choosing between lobes and for the energy rule. Exact is not needed, > 0 is.
    float albedo() const { return rows_[kRowAlbedo]; }
    /// Half angle in radians of the lobe's spread, for the footprint of rays behind it.
    float spread() const { return rows_[kRowSpread]; }
    /// A single direction: fcos and pdf are 0 everywhere, sample returns it with weight albedo().
    bool delta() const { return rows_[kRowDelta] != 0; }

private:
    const LobeLanes* lanes_;
    float rows_[kLobeRows];
};

/// f cos by channel.
inline Color lobeValue(const LobeKind& k, const LobeParams& p, Vec3 w) { return OneLobe(k, p).value(w).colour; }

/// Lobes of any kinds in blocks of their kind. First all are added, then prepare() makes them ready; then rounds of questions,
/// each lobe at most once in a round.
class LobeColumns {
public:
    /// Where a lobe is.
    struct Place {
        int kind = 0, at = 0;
    };
    LobeColumns();
    void clear();
    Place add(const LobeKind&, const LobeParams&,
              const DistributionParams* more = nullptr); ///< `more`: in place of LobeParams::more
    /// Call after the last add(), before all that follows. Again after more were added.
    void prepare();
    float albedo(Place p) const { return block(p).rows[kRowAlbedo][lane(p)]; }
    float spread(Place p) const { return block(p).rows[kRowSpread][lane(p)]; }
    bool delta(Place p) const { return block(p).rows[kRowDelta][lane(p)] != 0; }
    /// A row of a lobe (LobeRow), and three of them; only those that its kind needs hold anything.
    float row(Place p, int r) const { return block(p).rows[r][lane(p)]; }
    Vec3 triple(Place p, int r) const { return {row(p, r), row(p, r + 1), row(p, r + 2)}; }
    /// Asks for the value for light from w, unit; evaluate() answers all that were asked.
    void ask(Place p, const Vec3& w) {
        Block& b = block(p);
        const int l = lane(p);
        b.in[0][l] = w.x, b.in[1][l] = w.y, b.in[2][l] = w.z;
        note(p, b);
    }
    void evaluate();
    LobeValue value(Place p) const {
        const Block& b = block(p);
        const int l = lane(p);
        return {{b.value[0][l], b.value[1][l], b.value[2][l]}, b.value[kRowFcos][l], b.value[kRowPdf][l]};
    }
    /// Asks for a direction by u; sample() draws all that were asked.
    void ask(Place p, Vec2 u) {
        Block& b = block(p);
        const int l = lane(p);
        b.in[0][l] = u.x, b.in[1][l] = u.y;
        note(p, b);
    }
    void sample();
    /// False: this draw brings nothing.
    bool drawn(Place p, Vec3& w) const {
        const Block& b = block(p);
        const int l = lane(p);
        w = {b.value[0][l], b.value[1][l], b.value[2][l]};
        return b.value[kRowDrawn][l] != 0;
    }

private:
    struct alignas(64) Block {
        float rows[kLobeRows][kLobeBlock], in[3][kLobeBlock], value[kValueRows][kLobeBlock];
        uint32_t asked;
    };
    struct Kind {
        std::vector<Block> blocks;
        int count = 0, ready = 0;
        std::vector<int> asked; ///< blocks with questions
    };
    static int lane(Place p) { return p.at % kLobeBlock; }
    Block& block(Place p) { return kinds_[size_t(p.kind)].blocks[size_t(p.at / kLobeBlock)]; }
    const Block& block(Place p) const { return kinds_[size_t(p.kind)].blocks[size_t(p.at / kLobeBlock)]; }
    void note(Place p, Block& b) {
        if (!b.asked) kinds_[size_t(p.kind)].asked.push_back(p.at / kLobeBlock);
        b.asked |= 1u << lane(p);
    }
    LobeLanesList lanes_;
    std::vector<Kind> kinds_;
};

std::span<const LobeKind* const> lobeKinds();
/// By the name trace() or a lighting shadeop knows it under; null when unknown.
const LobeKind* findLobe(std::string_view name);

} // namespace alpenglow::transport
