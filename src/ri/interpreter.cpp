// Dispatch: recording, conditionals, motion blocks, scopes, then the handler.
#include "ri/interpreter.h"
#include "base/limits.h"
#include "ri/parser.h"
#include <fmt/format.h>

namespace alpenglow::ri {

Interpreter::Interpreter(ReaderOptions o, scene::FrameConsumer& c, Diagnostics& d)
    : reporter(d), settings(std::move(o)), consumer(c) {
    state.attributes = std::make_shared<scene::Attributes>();
    state.scoped = std::make_shared<NamedSystems>();
    base_ = lasting();
}

Interpreter::Lasting Interpreter::lasting() const {
    return {declarations, options,  state,           nRGB,   lights_,      handles_, systems_,
            resources_,   objects_, inlineArchives_, abort_, errorsBefore_};
}

void Interpreter::nextScene() {
    shared_ = true; // base_ holds the attributes too
    if (worldSerial_ == baseWorld_) {
        base_ = lasting();
        return;
    }
    restore(base_);
    errorsBefore_ = abort_ ? reporter.errors() : 0;
    archiveReads_ = 0;
    objectCopies_ = replayedCalls_ = 0;
    archivesRead_.clear();
    shelf_.forgetPlaces();
    baseWorld_ = worldSerial_;
    ris_ = false;
    headlight_ = true;
    integratorSurface_ = nullptr;
}

scene::Attributes& Interpreter::attributes() {
    if (shared_) state.attributes = std::make_shared<scene::Attributes>(*state.attributes);
    shared_ = false;
    return *state.attributes;
}

scene::AttributesRef Interpreter::snapshot() {
    shared_ = true;
    return state.attributes;
}

void Interpreter::run(Parser& parser) {
    auto outer = std::move(reporter.lineText);
    reporter.lineText = [&](const SourcePlace& p) { return parser.lineText(p); };
    parser.unknown = settings.unknown;
    Call call;
    while (!stopped() && parser.next(call) && !stopped() && mayReplay(call)) execute(call);
    reporter.lineText = std::move(outer);
}

void Interpreter::expand(const std::string& requests, const Call& call, scene::ParamList everywhere) {
    everywhere_.swap(everywhere);
    Parser parser(memorySource(requests), call.place.file, reporter);
    Call c;
    while (parser.next(c)) {
        c.place = call.place;
        execute(c);
    }
    everywhere_.swap(everywhere);
}

void Interpreter::readStream(std::unique_ptr<ByteSource> raw, const std::string& name) {
    SourcePlace end{name, 0, 0};
    sceneFolder_ = folderOf(name);
    ahead_ = ReadAhead();
    shelf_.forgetPlaces();
    unscanned_ = name;
    {
        auto outer = reporter.lineText;
        Parser parser(inflating(std::move(raw)), name, reporter, settings.comments);
        run(parser);
        end = parser.here();
        reporter.lineText = outer;
    }
    if (aborted()) reporter.report(Severity::Warning, Rie::IllState, end, "ErrorHandler \"abort\": the rest is not read");
    finish(end);
}

void Interpreter::finish(const SourcePlace& end) {
    closeOpenEnds(0, end);
    unwind(0, end, false);
    overflow_ = 0;
    reporter.flush(end);
}

void Interpreter::execute(const Call& call) {
    if (record(call) || conditional(call)) return;
    if (!conditions_.empty() && !conditions_.back().active) return;
    if (settings.executed && !telling_) tell(call);
    else perform(call);
}

void Interpreter::perform(const Call& call) {
    if (motion_ && call.request->name != "MotionEnd") {
        std::string_view n = call.request->name;
        if (n == "ReadArchive" || n == "Declare" || n == "version" || n == "ArchiveRecord") return dispatch(call);
        if (call.request->motion) {
            if (motion_->calls.size() < size_t(limits::kStackDepth)) motion_->calls.push_back(call);
            return;
        }
        reporter.error(Rie::BadMotion, call.place, fmt::format("{} cannot be in a motion block", n));
        if (call.request->kind != Kind::Structure) return;
        endMotion(call); // its MotionEnd was forgotten
    }
    dispatch(call);
}

void Interpreter::dispatch(const Call& call) {
    checkScope(call);
    call.request->handler(*this, call);
}

unsigned Interpreter::scope() const {
    for (auto b = blocks_.rbegin(); b != blocks_.rend(); ++b) {
        if (b->kind == BlockKind::Object) return kObject;
        if (b->kind == BlockKind::World) return kWorld;
        if (b->kind == BlockKind::Frame) return inWorld() ? unsigned(kWorld) : unsigned(kFrame);
    }
    return kBase;
}

/// Out of scope is executed as meant, with one warning for each request (docs/design/ri.md).
void Interpreter::checkScope(const Call& call) {
    const Request& r = *call.request;
    unsigned s = scope();
    if (r.scopes & s || (s == kWorld && waitsForInnerWorld(call))) return;
    if (r.name == "WorldBegin" && inWorld()) return;                    // which says what is done
    if (r.kind == Kind::Primitive && !(s & (kWorld | kObject))) return; // emit() refuses it with an error
    sayOutOfScope(r, s, call.place);
}

void Interpreter::sayOutOfScope(const Request& r, unsigned s, const SourcePlace& place) {
    Rie code = Rie::IllState;
    if (r.kind == Kind::Option) code = Rie::NotOptions;
    else if (r.kind == Kind::Primitive) code = Rie::NotPrims;
    else if (r.kind == Kind::Attribute || r.kind == Kind::Shader || r.kind == Kind::Light || r.kind == Kind::Transform)
        code = Rie::NotAttribs;
    else if (r.kind == Kind::Structure) code = Rie::Nesting;
    const char* where = s == kBase    ? "outside frame and world"
                        : s == kFrame ? "before WorldBegin"
                        : s == kWorld ? "inside the world"
                                      : "inside an object";
    reporter.once(fmt::format("ri:scope:{}:{}", r.name, s), Severity::Warning, code, place,
                  fmt::format("{} does not belong {}: it is done as if it were in its place", r.name, where));
}

void Interpreter::incapable(const Call& call, const std::string& what) {
    reporter.once("ri:incapable:" + what, Severity::Warning, Rie::Incapable, call.place, what);
}

bool Interpreter::conditional(const Call& call) {
    std::string_view n = call.request->name;
    bool active = conditions_.empty() || conditions_.back().active;
    if (n == "IfBegin") {
        if (conditions_.size() >= size_t(limits::kStackDepth)) {
            reporter.error(Rie::Limit, call.place, "IfBegin is nested too deeply");
            return true;
        }
        bool yes = active && evaluate(call);
        conditions_.push_back({call.place, active, yes, yes, false});
        return true;
    }
    if (n != "ElseIf" && n != "Else" && n != "IfEnd") return false;
    if (conditions_.empty()) {
        reporter.error(Rie::Nesting, call.place, fmt::format("{} without IfBegin", n));
        return true;
    }
    Condition& c = conditions_.back();
    if (n == "IfEnd") {
        conditions_.pop_back();
        return true;
    }
    if (c.elseSeen) reporter.error(Rie::Nesting, call.place, fmt::format("{} after Else", n));
    bool may = c.outer && !c.taken && !c.elseSeen;
    if (n == "Else") c.elseSeen = true;
    c.active = may && (n == "Else" || evaluate(call));
    c.taken = c.taken || c.active;
    return true;
}

bool Interpreter::evaluate(const Call& call) {
    auto lookup = [&](const std::string& name) -> std::optional<ConditionValue> {
        auto from = [](const std::map<std::string, scene::Param>& m, const std::string& key) -> std::optional<ConditionValue> {
            auto i = m.find(key);
            if (i == m.end()) return {};
            const scene::Param& p = i->second;
            if (!p.strings.empty()) return ConditionValue{true, 0, p.strings[0]};
            if (!p.numbers.empty()) return ConditionValue{false, double(p.numbers[0]), {}};
            return {};
        };
        if (name.starts_with("Attribute:")) return from(state.attributes->values, name.substr(10));
        if (name == "Option:Frame" || name == "Frame") return ConditionValue{false, double(options.frameNumber), {}};
        if (name.starts_with("Option:")) return from(options.values, name.substr(7));
        if (auto v = from(state.attributes->values, name)) return v;
        return from(options.values, name);
    };
    return evaluateCondition(call.text(0), lookup, reporter, call.place);
}

void Interpreter::closeOpenEnds(size_t conditions, const SourcePlace& where) {
    if (recording_ && openArchives_.empty()) {
        reporter.error(Rie::Nesting, recording_->place, "ArchiveBegin without ArchiveEnd: the archive is dropped");
        recording_.reset();
    }
    if (motion_) {
        if (!interrupted()) reporter.error(Rie::Nesting, motion_->place, "MotionBegin without MotionEnd");
        tellName("MotionEnd", where);
        Call end;
        end.place = where;
        endMotion(end);
    }
    while (conditions_.size() > conditions) {
        if (!interrupted()) reporter.error(Rie::Nesting, conditions_.back().place, "IfBegin without IfEnd");
        conditions_.pop_back();
    }
}

} // namespace alpenglow::ri
