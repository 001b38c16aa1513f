// Lobe code over blocks of 16 lobes, compiled for 4, 8 and 16 lanes and selected once by processor. Every width gives the same
// bits, as does a single lobe (Bsdf). No standard header beyond <cstdint>: code for newer processors must not leave a copy of
// a library's inline function for others.
#pragma once
#include <cstdint>

namespace alpenglow::bsdf {

inline constexpr int kLobeBlock = 16; ///< lobes in a block

/// Rows of a block, each of kLobeBlock floats. Vectors have three, in current space. Rows below kRowOwn hold LobeParams and
/// results of prepare().
enum LobeRow : int {
    kRowAxis = 0,       ///< normal, mirror or cone direction; unit
    kRowWo = 3,         ///< toward the viewer; unit
    kRowHorizon = 6,    ///< normal of the plane that clips the lobe
    kRowHasHorizon = 9, ///< 1 if there is such a plane, else 0
    kRowA = 10,         ///< roughness, exponent or cone half angle
    kRowRoughness = 11, ///< this and the following: kinds with `distribution`
    kRowRoughnessV = 12,
    kRowUdir = 13,
    kRowEta = 16,
    kRowK = 19,
    kRowAbsorption = 22,
    kRowPart = 25,  ///< -1: all
    kRowCount = 26, ///< number of values in kRowLobes
    kRowLobes = 27,
    kRowAlbedo = 43, ///< this and the following by prepare(); see LobeKind
    kRowSpread = 44,
    kRowDelta = 45, ///< 1 for a delta lobe, else 0
    kRowOwn = 46,   ///< rows for the kind's own use
    kLobeRows = 64
};
inline constexpr int kMostLobeNumbers = kRowAlbedo - kRowLobes;

/// Rows that a kind reads in addition to the axis.
enum LobeNeed : int {
    kNeedsWo = 1,
    kNeedsHorizon = 2, ///< kRowHorizon and kRowHasHorizon
    kNeedsA = 4,
    kNeedsSurface = 8, ///< from kRowRoughness to kRowPart
    kNeedsNumbers = 16 ///< kRowCount and kRowLobes
};

/// What callers must know of a kind besides its value.
enum LobeTrait : int {
    kCosineOfAxis = 1,    ///< the value includes the cosine between the light's direction and the axis
    kCosineOfHorizon = 2, ///< the same for the horizon, if there is one
    kRefracts = 4,        ///< light passes the surface and is bent by kRowEta
    kSameFromBoth = 8,    ///< the same lobe if light and viewer change places
    kAxisIsMirror = 16,   ///< the same, if the axis is the mirror direction of wo
    kTakesExponent = 32,  ///< kRowA is the "exponent" of trace(); otherwise it is "samplecone"
    kLambert = 64         ///< the value is max(0, axis . w) / pi
};

/// Rows of a value.
enum ValueRow : int { kRowColour = 0, kRowFcos = 3, kRowPdf = 4, kValueRows = 5 };
/// Rows of a sampled direction.
enum DrawnRow : int { kRowDirection = 0, kRowDrawn = 3, kDrawnRows = 4 };

/// A lobe kind at one width. `lanes`: bit mask of the lobes in the block to process; rows of other lanes are undefined, before
/// and after.
struct LobeLanes {
    const char* name;  ///< as in shaders
    const char* doc;   ///< for the manual
    bool distribution; ///< shared by trace() and bsdf()
    int needs;         ///< LobeNeed; other rows are undefined
    int traits;        ///< LobeTrait
    float eta;         ///< index of refraction of a call that gives none
    /// Sets the rows from kRowAlbedo on. Call first.
    void (*prepare)(float* block, uint32_t lanes);
    /// f cos and density for light from w (3 rows, unit), into `value` (kValueRows).
    void (*evaluate)(const float* block, uint32_t lanes, const float* w, float* value);
    /// Samples directions by u (2 rows, [0, 1)) into `drawn` (kDrawnRows). kRowDrawn is 0 if there is none.
    void (*sample)(const float* block, uint32_t lanes, const float* u, float* drawn);
};
/// The code of all lobes for one width.
struct LobeLanesList {
    const LobeLanes* lobes = nullptr; ///< in order of lobeKinds()
    int count = 0;                    ///< number of lobes
};

/// The lobes at 4, 8 or 16 lanes; empty if this processor cannot run that width. 1: for blocks of one lobe, whose rows are single
/// floats.
LobeLanesList lobeLanes(int width);
/// The widest that this processor can run.
int lobeWidth();

} // namespace alpenglow::bsdf
