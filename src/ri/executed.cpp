// Passes requests one by one to ReaderOptions::executed as they are executed.
#include "ri/interpreter.h"
#include <fmt/format.h>
#include <utility>

namespace alpenglow::ri {

/// A request without arguments that the stream does not have, or has under another name.
void Interpreter::announceName(std::string_view request, const SourcePlace& place) {
    if (!settings.executed) return;
    Call call;
    call.request = findRequest(request);
    call.place = place;
    settings.executed(call);
}

void Interpreter::announceHeld() {
    if (inner_) return;
    for (const Call& c : std::exchange(held_, {})) settings.executed(c);
}

void Interpreter::announce(const Call& call) {
    const std::string_view name = call.request->name;
    const bool archive = name == "ReadArchive";
    if (archive && (inlineArchives_.count(call.text(0)) || locateArchive(call.text(0), call.place))) return perform(call);
    if (name == "ArchiveBegin") return perform(call); // its contents are passed on when ReadArchive reads it
    if (name == "Procedural") return announceProcedural(call, call.text(0));
    if (name == "Procedural2") {
        std::string kind = call.text(0);
        if (kind.ends_with('2')) kind.pop_back();
        return announceProcedural(call, kind);
    }
    // A world within the world becomes what it is taken as (innerworld.cpp).
    const Block* world = name == "WorldEnd" ? innermost(BlockKind::World) : nullptr;
    if (name == "WorldBegin" && archiveInWorld()) {
        held_.clear();
        announceName("AttributeBegin", call.place);
    } else if (world && world->inner) announceName("AttributeEnd", call.place);
    else if (call.request->kind == Kind::Option && archiveInWorld()) held_.push_back(call);
    else settings.executed(call);
    if (archive) return; // it was not found, which has been reported
    announcing_ = true;
    perform(call);
    announcing_ = false;
}

/// The contents of a procedural have a graphics state of their own.
void Interpreter::announceProcedural(const Call& call, const std::string& kind) {
    const bool foreign = kind == "RunProgram" || kind == "DynamicLoad";
    if (foreign && !settings.allowExec) {
        reporter.once("ri:unexpanded:" + kind, Severity::Warning, Rie::Incapable, call.place,
                      fmt::format("{} \"{}\" runs foreign code: it is left as it is", call.request->name, kind),
                      "--allow-exec puts what it makes into its place");
        settings.executed(call);
        return;
    }
    announceName("AttributeBegin", call.place);
    perform(call);
    announceName("AttributeEnd", call.place);
}

} // namespace alpenglow::ri
