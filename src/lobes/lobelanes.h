// Lobes in columns: the code of every lobe kind over blocks of 16 lobes, compiled at 4, 8 and 16 lanes and chosen once by the
// processor. Every width gives the same bits, and so does one lobe alone (OneLobe). No standard header beyond <cstdint>: what
// compiles for newer processors must not leave a copy of a library's inline function behind for others.
#pragma once
#include <cstdint>

namespace alpenglow::transport {

inline constexpr int kLobeBlock = 16; ///< lobes of a block

/// Rows of a block, each of kLobeBlock floats. Vectors have three, in current space. Up to kRowOwn they are what LobeParams
/// holds.
enum LobeRow : int {
    kRowAxis = 0,       ///< normal, mirror or cone direction; unit
    kRowWo = 3,         ///< toward the viewer; unit
    kRowHorizon = 6,    ///< normal of the plane that cuts the lobe
    kRowHasHorizon = 9, ///< 1: it does; 0
    kRowA = 10,         ///< roughness, exponent or cone half angle
    kRowRoughness = 11, ///< from here on: kinds with `distribution`
    kRowRoughnessV = 12,
    kRowUdir = 13,
    kRowEta = 16,
    kRowK = 19,
    kRowAbsorption = 22,
    kRowPart = 25,  ///< -1: all
    kRowCount = 26, ///< how many numbers of kRowLobes are given
    kRowLobes = 27,
    kRowAlbedo = 43, ///< by prepare(), as all that follow; see LobeKind
    kRowSpread = 44,
    kRowDelta = 45, ///< 1: a single direction; 0
    kRowOwn = 46,   ///< the kind's own
    kLobeRows = 64
};
inline constexpr int kMostLobeNumbers = kRowAlbedo - kRowLobes;

/// Which rows a kind reads besides the axis.
enum LobeNeed : int {
    kNeedsWo = 1,
    kNeedsHorizon = 2, ///< kRowHorizon and kRowHasHorizon
    kNeedsA = 4,
    kNeedsSurface = 8, ///< from kRowRoughness to kRowPart
    kNeedsNumbers = 16 ///< kRowCount and kRowLobes
};

/// Rows of a value.
enum ValueRow : int { kRowColour = 0, kRowFcos = 3, kRowPdf = 4, kValueRows = 5 };
/// Rows of a drawn direction.
enum DrawnRow : int { kRowDirection = 0, kRowDrawn = 3, kDrawnRows = 4 };

/// One lobe kind at one width. `lanes`: the lobes of the block that are asked, as bits; rows of others may be anything, before
/// and after.
struct LobeLanes {
    const char* name;
    const char* doc;
    bool distribution; ///< one of those that trace() has in common with bsdf()
    int needs;         ///< LobeNeed; other rows may hold anything
    /// Fills the rows from kRowAlbedo on; before all else.
    void (*prepare)(float* block, uint32_t lanes);
    /// f cos and density for light from w (3 rows, unit), into `value` (kValueRows).
    void (*evaluate)(const float* block, uint32_t lanes, const float* w, float* value);
    /// Draws directions by u (2 rows, 0 to 1) into `drawn` (kDrawnRows). Not drawn: this draw brings nothing.
    void (*sample)(const float* block, uint32_t lanes, const float* u, float* drawn);
};
struct LobeLanesList {
    const LobeLanes* lobes = nullptr; ///< in the order of lobeKinds()
    int count = 0;
};

/// The lobes at 4, 8 or 16 lanes; none where this processor cannot run that. 1: for blocks of one lobe, whose rows are single
/// floats.
LobeLanesList lobeLanes(int width);
/// The widest that this processor runs.
int lobeWidth();

} // namespace alpenglow::transport
