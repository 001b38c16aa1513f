// Lobes: BSDFs and phase functions. One file each in kinds/; trace() and the lighting shadeops find them by name. The value of a
// lobe is f cos (docs/light.md): the shadeop's result is the integral of L f cos over directions, so diffuse() of uniform
// radiance 1 is 1, and a light's Cl (irradiance / pi) contributes pi f cos Cl.
//
// The code runs over blocks of 16 lobes of a kind (lobelanes.h). BsdfBatch holds those of a batch; Bsdf evaluates a single
// one with the same bits.
#pragma once
#include "base/vec.h"
#include "bsdf/lobelanes.h"
#include <algorithm>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace alpenglow::bsdf {

/// Parameters of the distributions shared by trace() and bsdf() (3Delight manual, 6.4.5.2). Current space.
struct DistributionParams {
    float roughness = 0, roughnessv = 0; ///< 0 to 1, along udir and across it
    Vec3 udir;                           ///< direction along the surface; zero: any
    Color eta{0}, k{0};                  ///< index of refraction and extinction; glass-ggx and hair: the first channel of eta
    Color absorption{0};                 ///< hair
    std::vector<float> lobes;            ///< glass-ggx: weights of reflection and refraction; hair: four numbers for each lobe
    int part = -1;                       ///< glass-ggx: 0 reflection, 1 refraction; hair: the lobe; -1: all
};

/// Parameters of a lobe at one vertex, in current space. Each kind uses some of them.
struct LobeParams {
    Vec3 axis;                                      ///< normal, mirror or cone direction; unit
    Vec3 wo;                                        ///< toward the viewer; unit
    Vec3 horizon;                                   ///< normal of the plane that clips the lobe; used if hasHorizon
    float a = 0;                                    ///< roughness, exponent or cone half angle
    bool hasHorizon = false;                        ///< `horizon` counts
    std::shared_ptr<const DistributionParams> more; ///< required by kinds with `distribution`; null for others
};

/// Value of a lobe for light from one direction.
struct LobeValue {
    Color colour{0}; ///< f cos by channel; >= 0; per steradian
    float fcos = 0;  ///< the largest channel
    float pdf = 0;   ///< density of sample() per solid angle
};

/// A lobe by name, with its description for the manual and its code.
struct LobeKind {
    std::string_view name;
    std::string_view doc;      ///< for the manual
    bool distribution = false; ///< reads LobeParams::more
    int index = 0;             ///< in lobeKinds() and in lobeLanes()
    int traits = 0;            ///< LobeTrait
    float eta = 0;             ///< index of refraction of a call that gives none
    /// Whether it has this trait.
    bool has(LobeTrait t) const { return (traits & t) != 0; }

    // A single evaluation; see Bsdf.
    bool isDelta(const LobeParams&) const;
    /// LobeValue::fcos.
    float fcos(const LobeParams&, Vec3 w) const;
    float pdf(const LobeParams&, Vec3 w) const;
    /// False: there is no direction.
    bool sample(const LobeParams&, Vec2 u, Vec3& w) const;
    /// About the fraction that the lobe reflects, for selection; half its width in radians, for footprints.
    float albedo(const LobeParams&) const;
    float spread(const LobeParams&) const;
};

/// A single lobe.
class Bsdf {
public:
    /// kind: of lobeKinds(), outlives the lobe.
    Bsdf(const LobeKind&, const LobeParams&);
    /// w is unit.
    LobeValue value(const Vec3& w) const;
    /// Samples a direction by u, each in [0, 1); returns false if there is none (counts as a sample of value 0).
    bool sample(Vec2 u, Vec3& w) const;
    /// Approximate integral of fcos, > 0; for lobe selection and the energy rule.
    float albedo() const { return rows_[kRowAlbedo]; }
    /// Half angle of the lobe in radians, for the footprint of rays that it scatters.
    float spread() const { return rows_[kRowSpread]; }
    /// A delta lobe: fcos and pdf are 0 everywhere, sample() returns the direction with weight albedo().
    bool delta() const { return rows_[kRowDelta] != 0; }

private:
    const LobeLanes* lanes_;
    float rows_[kLobeRows];
};

/// f cos by channel.
inline Color lobeValue(const LobeKind& k, const LobeParams& p, Vec3 w) { return Bsdf(k, p).value(w).colour; }

/// Lobes of any kinds, in blocks by kind. First add() all, then prepare(); then rounds of queries, each lobe at most once in a
/// round.
class BsdfBatch {
public:
    /// Position of a lobe.
    struct Place {
        int kind = 0, at = 0; ///< index of the kind, and of the lobe among those of its kind
    };
    /// Empty.
    BsdfBatch();
    /// Removes all lobes; memory is kept.
    void clear();
    Place add(const LobeKind&, const LobeParams&,
              const DistributionParams* more = nullptr); ///< `more`: replaces LobeParams::more
    /// Call after the last add(), before queries. Call again after further add().
    void prepare();
    /// Bsdf::albedo(), spread() and delta(); after prepare().
    float albedo(Place p) const { return block(p).rows[kRowAlbedo][lane(p)]; }
    float spread(Place p) const { return block(p).rows[kRowSpread][lane(p)]; }
    bool delta(Place p) const { return block(p).rows[kRowDelta][lane(p)] != 0; }
    /// A row of a lobe (LobeRow), or three of them; only those that its kind reads are set.
    float row(Place p, int r) const { return block(p).rows[r][lane(p)]; }
    Vec3 triple(Place p, int r) const { return {row(p, r), row(p, r + 1), row(p, r + 2)}; }
    /// The first row of a lobe; the others lie kLobeBlock floats apart.
    const float* rowsAt(Place p) const { return &block(p).rows[0][lane(p)]; }
    /// Queries the value for light from w, unit; evaluate() answers all queries.
    void ask(Place p, const Vec3& w) {
        Block& b = block(p);
        const int l = lane(p);
        b.in[0][l] = w.x, b.in[1][l] = w.y, b.in[2][l] = w.z;
        note(p, b);
    }
    /// Answers all queries of values since the last evaluate() or sample().
    void evaluate();
    /// The answer to a query of a value.
    LobeValue value(Place p) const {
        const Block& b = block(p);
        const int l = lane(p);
        return {{b.value[0][l], b.value[1][l], b.value[2][l]}, b.value[kRowFcos][l], b.value[kRowPdf][l]};
    }
    /// Queries a direction by u; sample() answers all queries.
    void ask(Place p, Vec2 u) {
        Block& b = block(p);
        const int l = lane(p);
        b.in[0][l] = u.x, b.in[1][l] = u.y;
        note(p, b);
    }
    /// Answers all queries of directions.
    void sample();
    /// Returns false if the sample has no direction.
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
        std::vector<int> asked; ///< blocks with queries
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

/// All lobes, by LobeKind::index.
std::span<const LobeKind* const> lobeKinds();
/// The lobe that trace() or a lighting shadeop knows by this name; null if unknown.
const LobeKind* findLobe(std::string_view name);

} // namespace alpenglow::bsdf
