#include "world/procedurals.h"
#include "world/bakes.h"
#include "world/impl.h"
#include "world/photonmaps.h"

namespace alpenglow::world {
namespace {
/// Null for other implementations of World (tests), which have no procedurals.
const WorldImpl* inside(const World& w) { return dynamic_cast<const WorldImpl*>(&w); }
} // namespace

std::vector<int> procedurals(const World& w) { return hasDeferred(w) ? inside(w)->deferred()->met() : std::vector<int>(); }

bool hasDeferred(const World& w) { return inside(w) && inside(w)->deferred(); }

bool needsAllShapes(const World& w) { return inside(w) && (bakes(w) || w.interpolates() || !photonMapsOf(w, true).empty()); }

void takeOver(const World& w, const World& before) {
    if (inside(w) && inside(before)) inside(w)->prints().goOn(inside(before)->prints());
}

bool hasPrints(const World& w) { return inside(w) && inside(w)->prints().pending(); }

} // namespace alpenglow::world
