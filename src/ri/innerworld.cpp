// Scenes inside worlds: an archive that is read in a world and has options and a world of its own. What its world holds is added
// to the open one, whose camera, displays and other options stay.
#include "ri/interpreter.h"
#include <fmt/format.h>

namespace alpenglow::ri {

/// The open archive that was read first in the open world; nothing: the world is open in the archive itself, or there is none.
std::optional<size_t> Interpreter::archiveInWorld() const {
    if (!inWorld() || making_) return {};
    const Block* world = innermost(BlockKind::World);
    const size_t above = world ? size_t(world - blocks_.data()) + 1 : 0; // null: its End was mended away
    for (size_t i = 0; world && i < barriers_.size(); ++i)
        if (barriers_[i] >= above) return i;
    return {};
}

bool Interpreter::waitsForInnerWorld(const Call& call) {
    if (call.request->kind != Kind::Option) return false;
    if (!inner_) {
        const auto archive = archiveInWorld();
        if (!archive) return false;
        inner_ = InnerOptions{*archive, options, {}};
    }
    inner_->calls.emplace_back(call.request, call.place);
    return true;
}

void Interpreter::endInnerOptions() {
    if (!inner_ || barriers_.size() > inner_->archive) return;
    const InnerOptions done = std::move(*inner_);
    inner_.reset();
    for (const auto& [request, place] : done.calls) sayOutOfScope(*request, kWorld, place);
}

bool Interpreter::innerWorld(const Call& call) {
    if (!archiveInWorld()) return false;
    std::string message = "WorldBegin inside a world: what it holds is added to the open one";
    if (inner_ && !inner_->calls.empty()) {
        message += fmt::format("; {} and other options of the archive have no effect", inner_->calls.front().first->name);
        inner_->calls.clear();
        options = inner_->before;
        for (Block& b : blocks_) // FrameEnd in the archive restores them
            if (&b > innermost(BlockKind::World) && b.options) *b.options = options;
    }
    reporter.once("ri:innerworld", Severity::Warning, Rie::Nesting, call.place, message);
    if (begin(BlockKind::Attribute, call)) {
        blocks_.back().kind = BlockKind::World;
        blocks_.back().inner = true;
    }
    return true;
}

} // namespace alpenglow::ri
