// Dispatch: recording, conditionals, motion blocks, scopes, then the handler.
#include "ri/interpreter.h"
#include "base/knownoptions.h"
#include "base/limits.h"
#include "ri/parser.h"
#include <cstdlib>
#include <fmt/format.h>

namespace alpenglow::ri {

Interpreter::Interpreter(ReaderOptions o, scene::FrameConsumer& c, Diagnostics& d)
    : reporter(d), settings(std::move(o)), consumer(c) {
    state.attributes = std::make_shared<scene::Attributes>();
    state.scoped = std::make_shared<NamedSystems>();
    base_ = lasting();
}

Interpreter::Lasting Interpreter::lasting() const {
    return {declarations, options,  state,           nRGB,        lights_,       handles_,          systems_,
            resources_,   objects_, inlineArchives_, errorStyle_, errorsBefore_, errorsOfAllBefore_};
}

void Interpreter::setErrorStyle(ErrorStyle style) {
    if ((errorStyle_ == ErrorStyle::Ignore) != (style == ErrorStyle::Ignore)) reporter.ignore(style == ErrorStyle::Ignore);
    errorStyle_ = style;
    errorsBefore_ = reporter.errors();
    errorsOfAllBefore_ = reporter.errorsOfAll();
}

void Interpreter::nextScene() {
    shared_ = true; // base_ holds the attributes too
    if (worldSerial_ == baseWorld_) {
        base_ = lasting();
        return;
    }
    restore(base_);
    setErrorStyle(base_.errorStyle);
    archiveReads_ = 0;
    objectCopies_ = replayedCalls_ = 0;
    archivesRead_.clear();
    shelf_.forgetPlaces();
    baseWorld_ = worldSerial_;
    ris_ = linksFilters_ = false;
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
        take(c);
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
    if (aborted())
        reporter.report(Severity::Warning, Rie::IllState, end,
                        "ErrorHandler \"abort\": the rest is not read, nor a picture finished");
    finish(end);
}

void Interpreter::finish(const SourcePlace& end) {
    closeOpenEnds(0, end);
    unwind(0, end, false);
    overflow_ = 0;
    leftOutEdits_ = 0;
    editsWorld_ = false;
    reporter.flush(end);
}

void Interpreter::execute(const Call& call) {
    if (!settings.filter) return take(call);
    std::vector<Call> by;
    settings.filter(call, by);
    for (size_t i = 0; i < by.size() && !stopped(); ++i) take(by[i]);
}

void Interpreter::take(const Call& given) {
    std::optional<Call> substituted;
    if (hasVariables_ && !holdsBack()) substituted = withVariables(given);
    const Call& call = substituted ? *substituted : given;
    if (record(call) || conditional(call)) return;
    if (passesOver() || leftOutEdit(call)) return;
    if (settings.executed && !announcing_) announce(call);
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

/// Requests out of scope are executed, with one warning for each request (docs/design/ri.md).
void Interpreter::checkScope(const Call& call) {
    const Request& r = *call.request;
    unsigned s = scope();
    if (r.scopes & s || (s == kWorld && waitsForInnerWorld(call))) return;
    if (r.name == "WorldBegin" && inWorld()) return;                    // the request reports it itself
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
        if (deepConditions_ > 0 || conditions_.size() >= size_t(limits::kStackDepth)) {
            if (deepConditions_++ == 0)
                reporter.error(
                    Rie::Limit, call.place,
                    fmt::format("IfBegin is nested deeper than {}: what is in deeper ones is passed over", limits::kStackDepth));
            return true;
        }
        bool yes = active && evaluate(call);
        conditions_.push_back({call.place, active, yes, yes, false});
        return true;
    }
    if (n != "ElseIf" && n != "Else" && n != "IfEnd") return false;
    if (deepConditions_ > 0) {
        deepConditions_ -= n == "IfEnd";
        return true;
    }
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

std::optional<ConditionValue> Interpreter::variable(const std::string& name, bool standard) const {
    const auto value = [](const auto& numbers, const auto& texts) -> std::optional<ConditionValue> {
        if (!texts.empty()) return ConditionValue{true, 0, texts[0]};
        if (!numbers.empty()) return ConditionValue{false, double(numbers[0]), {}};
        return {};
    };
    const auto set = [&](const std::map<std::string, scene::Param>& m, const std::string& key) -> std::optional<ConditionValue> {
        const auto i = m.find(key);
        return i == m.end() ? std::nullopt : value(i->second.numbers, i->second.strings);
    };
    const auto unset = [&](std::span<const known::OptionDescription> table,
                           const std::string& key) -> std::optional<ConditionValue> {
        const known::OptionDescription* d = known::findKnown(table, key);
        if (!d || d->answer.empty()) return {};
        const known::PlainValue v =
            known::plainValue(options.hider == "path" && !d->answerUnderPath.empty() ? d->answerUnderPath : d->answer);
        return value(v.numbers, v.texts);
    };
    const bool attribute = name.starts_with("Attribute:"), option = name.starts_with("Option:");
    const std::string key = attribute ? name.substr(10) : option ? name.substr(7) : name;
    if (key == "Frame" && !attribute) return ConditionValue{false, double(options.frameNumber), {}};
    std::optional<ConditionValue> v;
    // A name without a class is one of the user's, or of the environment (PRMan).
    for (const std::string& k : {key, key.find(':') == key.npos ? "user:" + key : std::string()}) {
        if (!v && !option) v = set(state.attributes->values, k);
        if (!v && !attribute) v = set(options.values, k);
    }
    if (!v && standard && !option) v = unset(known::knownAttributes(), key);
    if (!v && standard && !attribute) v = unset(known::knownOptions(), key);
    const char* environment = v || key.find(':') != key.npos ? nullptr : std::getenv(key.c_str());
    if (environment) v = ConditionValue{true, 0, std::string(environment).substr(0, limits::kTokenBytes)};
    return v;
}

bool Interpreter::evaluate(const Call& call) {
    return evaluateCondition(
        call.text(0), [this](const std::string& name, bool standard) { return variable(name, standard); }, reporter, call.place);
}

void Interpreter::closeOpenEnds(size_t conditions, const SourcePlace& where) {
    if (recording_ && openArchives_.empty()) {
        reporter.error(Rie::Nesting, recording_->place, "ArchiveBegin without ArchiveEnd: the archive is dropped");
        recording_.reset();
    }
    if (motion_) {
        if (!stopped()) reporter.error(Rie::Nesting, motion_->place, "MotionBegin without MotionEnd");
        announceName("MotionEnd", where);
        Call end;
        end.place = where;
        endMotion(end);
    }
    if (conditions_.size() > conditions) deepConditions_ = 0;
    while (conditions_.size() > conditions) {
        if (!stopped()) reporter.error(Rie::Nesting, conditions_.back().place, "IfBegin without IfEnd");
        conditions_.pop_back();
    }
}

} // namespace alpenglow::ri
