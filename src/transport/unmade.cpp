#include "transport/unmade.h"
#include "transport/bakes.h"
#include "transport/photons.h"
#include "world/impl.h"

namespace alpenglow::transport {
namespace {
const WorldImpl& inside(const World& w) { return static_cast<const WorldImpl&>(w); }
} // namespace

void askForProcedurals(const World& w, int most) {
    if (inside(w).unmade_) inside(w).unmade_->askFor(most);
}

std::vector<int> procedurals(const World& w) { return inside(w).unmade_ ? inside(w).unmade_->met() : std::vector<int>(); }

bool hasUnmade(const World& w) { return inside(w).unmade_ != nullptr; }

bool needsAllShapes(const World& w) { return bakes(w) || w.interpolates() || !photonMapsOf(w, true).empty(); }

void takeOver(const World& w, const World& before) { inside(w).prints_.goOn(inside(before).prints_); }

bool hasPrints(const World& w) { return inside(w).prints_.pending(); }

} // namespace alpenglow::transport
