// outputchannel(), writeaov() and readaov(): outputs that no parameter declares. Each is a variable of the kernel, zero until a call gives it a value.
// A name that is made when the shader runs means one of those that displays ask for: each point may have its own.
#include "rsl/ir/builder.h"

namespace alpenglow::rsl::ir {

namespace {

constexpr char kAnyName = '?'; ///< before the type of calls whose names are not written in them (front/calls_bind.cpp)

/// The name without "light:" or "local:"; `kept` tells of such a prefix.
std::string bareName(const std::string& name, bool& kept) {
    kept = name.rfind("light:", 0) == 0 || name.rfind("local:", 0) == 0;
    return kept ? name.substr(6) : name;
}

bool alike(Type a, Type b) { return kindOf(a.element()) == kindOf(b.element()) && (a.array != 0) == (b.array != 0); }

} // namespace

void Builder::beginChannels() {
    const auto make = [&](std::string name, Type type) {
        if (type.array < 0) return; // of open length: displays would not know how many
        if (channels_.count(name)) name += kAnyName + toString(type); // the same name for several types: the one that is given a value shows
        if (channels_.count(name)) return;
        if (!type.array) {
            channels_[name] = {newSlot(zero(kindOf(type))), type};
            return;
        }
        Inst* a = newArray(type.base, type.array);
        for (int n = 0; n < type.array; ++n) emit(Op::ArrayStore, Kind::None, {a, constant(static_cast<float>(n)), zero(a->element)});
        channels_[name] = {newSlot(a), type};
    };
    std::vector<const Program*> programs{&program_};
    for (const CoShader& c : options_.coShaders) programs.push_back(c.program);
    for (const Program* p : programs)
        for (const auto& [name, type] : p->channels)
            if (name[0] != kAnyName && !channels_.count(name)) make(name, type);
    for (const Program* p : programs)
        for (const auto& [key, type] : p->channels) {
            if (key[0] != kAnyName) continue;
            for (const std::string& output : options_.outputs) {
                const std::string name = output.substr(0, output.find('['));
                const bool declared = std::any_of(shader_.parameters.begin(), shader_.parameters.end(), [&](const ShaderParameter& q) { return q.symbol->name == name; });
                const auto written = [&](const Program* q) { return q->channels.count(name) > 0; };
                if (!declared && std::none_of(programs.begin(), programs.end(), written) && name.find(':') == std::string::npos && !hasGlobal(name.c_str())) make(name, type);
            }
        }
}

/// Every output that a call with such a value can mean: names and slots.
std::vector<std::pair<std::string, int>> Builder::channelsFor(Type type) {
    std::vector<std::pair<std::string, int>> all;
    for (const ShaderParameter& p : shader_.parameters)
        if (p.symbol->output && alike(p.symbol->type, type)) all.emplace_back(p.symbol->name, slot(p.symbol));
    for (const auto& [name, c] : channels_)
        if (alike(c.second, type) && !hasGlobal(name.c_str())) all.emplace_back(name.substr(0, name.find(kAnyName)), c.first);
    return all;
}

/// The output of that name, of the type that some call gives it; null when there is none.
const std::pair<int, Type>* Builder::channelNamed(const std::string& name) {
    const std::pair<int, Type>* found = nullptr;
    for (auto c = channels_.lower_bound(name); c != channels_.end() && c->first.rfind(name, 0) == 0; ++c)
        if ((c->first == name || c->first[name.size()] == kAnyName) && (!found || isConst(get(found->first)))) found = &c->second;
    return found;
}

/// The slot that a call assigns: of a parameter of the main shader, or of a channel. -1: nothing is assigned.
int Builder::channelSlot(const std::string& text, Type type) {
    bool kept = false;
    const std::string name = bareName(text, kept);
    if (kept && (handleDepth_ > 0 || shader_.kind == ShaderKind::Light)) return -1; // it stays with the co-shader or the light
    for (const auto& [known, n] : channelsFor(type))
        if (known == name) return n;
    return -1;
}

/// The value goes to the output `n`, where `condition` (null: everywhere).
void Builder::giveChannel(int n, const Expr& value, Inst* whole, Inst* condition) {
    if (whole) {
        Inst* old = get(n);
        return set(n, condition ? emit(Op::Select, old->kind, {condition, coerce(whole, old->kind), old}) : whole);
    }
    Inst* to = get(n);
    Inst* from = array(value);
    if (to->op != Op::ArrayNew) return;
    for (int k = 0; k < std::min(arrayLength(to), lengths(from) ? from->index : arrayLength(from)); ++k) {
        Inst* at = constant(static_cast<float>(k));
        Inst* v = emit(Op::ArrayLoad, to->element, {from, at});
        if (condition) v = emit(Op::Select, to->element, {condition, v, emit(Op::ArrayLoad, to->element, {to, at})});
        emit(Op::ArrayStore, Kind::None, {to, at, v});
    }
}

Inst* Builder::outputChannel(const Expr& e) {
    const Expr& given = *e.args[1];
    Inst* name = expr(*e.args[0]);
    Inst* value = given.type.array ? nullptr : expr(given);
    if (value && value->kind == Kind::Bool) value = coerce(value, Kind::Float);
    place_ = e.place;
    if (name->op == Op::ConstString) {
        if (const int n = channelSlot(name->text, given.type); n >= 0) giveChannel(n, given, value, nullptr);
        return constant(0);
    }
    const bool keeps = handleDepth_ > 0 || shader_.kind == ShaderKind::Light; // what "light:" and "local:" say
    for (const auto& [known, n] : channelsFor(given.type)) {
        Inst* is = emit(Op::Equal, Kind::Bool, {name, leaves_.string(known)});
        for (const char* prefix : {"light:", "local:"})
            if (!keeps) is = emit(Op::Or, Kind::Bool, {is, emit(Op::Equal, Kind::Bool, {name, leaves_.string(prefix + known)})});
        giveChannel(n, given, value, is);
    }
    return constant(0);
}

/// writeaov(name, value): an output of that name and type is given the value; where there is none nobody asks for it.
Inst* Builder::writeAov(const Expr& e) { return outputChannel(e); }

Inst* Builder::readAov(const Expr& e) {
    const Expr& to = *e.args[1];
    Inst* name = expr(*e.args[0]);
    place_ = e.place;
    const auto take = [&](int n) {
        if (to.type.array) return takeArray(to, get(n));
        assign(to, get(n));
        return true;
    };
    if (name->op == Op::ConstString) {
        const int n = channelSlot(name->text, to.type);
        return constant(n >= 0 && take(n) ? 1.0f : 0.0f);
    }
    Inst* found = constant(0);
    for (const auto& [known, n] : channelsFor(to.type)) {
        const int at = n;
        found = branch(
            emit(Op::Equal, Kind::Bool, {name, leaves_.string(known)}), [&] { return std::vector<Inst*>{constant(take(at) ? 1.0f : 0.0f)}; },
            [&] { return std::vector<Inst*>{found}; })[0];
    }
    return found;
}

} // namespace alpenglow::rsl::ir
