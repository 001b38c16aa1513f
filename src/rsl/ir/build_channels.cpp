// outputchannel(), writeaov() and readaov(): outputs that no parameter declares. Each is a variable of the kernel, zero until a
// call gives it a value. A name that is made when the shader runs means one of those that displays ask for: each point may have
// its own. Whether a point has it is an output, too ("given:NAME"), as a zero that was given hides what others give and one that
// was not does not. Lights and volumes tell it of all their names: where a condition keeps them from the call, what others gave
// to the surface stays.
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"

namespace alpenglow::rsl::ir {

namespace {

/// The output that is 1 where a call has set the channel of this key.
std::string flagOf(const std::string& key) { return OutputName::given(key).text(); }
bool isFlag(const std::string& key) { return !OutputName::givenName(key).empty(); }

bool alike(Type a, Type b) { return kindOf(a.element()) == kindOf(b.element()) && (a.array != 0) == (b.array != 0); }

} // namespace

void Builder::beginChannels() {
    const auto make = [&](std::string name, Type type, bool flag) {
        if (type.array < 0) return; // of open length: displays would not know how many
        if (channels_.count(name))
            name += kAnyChannel + toString(type); // the same name for several types: channelValue() decides
        if (channels_.count(name)) return;
        if (flag) channels_[flagOf(name)] = {newSlot(constant(0)), {Base::Float, 0}};
        if (!type.array) {
            channels_[name] = {newSlot(zero(kindOf(type))), type};
            return;
        }
        Inst* a = newArray(type.base, type.array);
        for (int n = 0; n < type.array; ++n)
            emit(Op::ArrayStore, Kind::None, {a, constant(static_cast<float>(n)), zero(a->element)});
        channels_[name] = {newSlot(a), type};
    };
    if (options_.light == kEntering) make(kEntering, {Base::Color, 0}, true);
    std::vector<const Program*> programs{&program_};
    for (const CoShader& c : options_.coShaders) programs.push_back(c.program);
    const bool oneOfMany = shader_.kind == ShaderKind::Light || shader_.kind == ShaderKind::Volume;
    const auto isParameter = [&](const std::string& name) {
        return std::any_of(shader_.parameters.begin(), shader_.parameters.end(),
                           [&](const ShaderParameter& p) { return p.symbol->output && p.symbol->name == name; });
    };
    for (const Program* p : programs)
        for (const auto& [name, type] : p->channels)
            if (name[0] != kAnyChannel && !channels_.count(name)) make(name, type, oneOfMany && !isParameter(name));
    for (const Program* p : programs)
        for (const auto& [key, type] : p->channels) {
            if (key[0] != kAnyChannel) continue;
            for (const std::string& output : options_.outputs) {
                const std::string name = output.substr(0, output.find('['));
                const bool declared = std::any_of(shader_.parameters.begin(), shader_.parameters.end(),
                                                  [&](const ShaderParameter& q) { return q.symbol->name == name; });
                const auto written = [&](const Program* q) { return q->channels.count(name) > 0; };
                if (!declared && std::none_of(programs.begin(), programs.end(), written) && name.find(':') == std::string::npos &&
                    !hasGlobal(name.c_str()))
                    make(name, type, true);
            }
        }
}

/// Every output that a call with such a value can mean: names and slots.
std::vector<std::pair<std::string, int>> Builder::channelsFor(Type type) {
    std::vector<std::pair<std::string, int>> all;
    for (const ShaderParameter& p : shader_.parameters)
        if (p.symbol->output && alike(p.symbol->type, type)) all.emplace_back(p.symbol->name, slot(p.symbol));
    for (const auto& [name, c] : channels_)
        if (!isFlag(name) && alike(c.second, type) && !hasGlobal(name.c_str()))
            all.emplace_back(name.substr(0, name.find(kAnyChannel)), c.first);
    return all;
}

/// The output of that name, of the type of the calls that set it; null if there is none.
const std::pair<int, Type>* Builder::channelNamed(const std::string& name) {
    const std::pair<int, Type>* found = nullptr;
    for (auto c = channels_.lower_bound(name); c != channels_.end() && c->first.rfind(name, 0) == 0; ++c)
        if ((c->first == name || c->first[name.size()] == kAnyChannel) && (!found || isConst(get(found->first))))
            found = &c->second;
    return found;
}

/// Its value at the end. Of one that was given a colour here and a float there the colour comes first, and the float is grey.
Inst* Builder::channelValue(const std::string& name, Type& type) {
    const auto* c = channelNamed(name);
    if (!c || hasGlobal(name.c_str())) return nullptr;
    type = c->second;
    const std::pair<int, Type>*triple = nullptr, *grey = nullptr;
    std::string tripleKey, greyKey;
    for (const auto& [key, of] : channels_) {
        if (key.substr(0, key.find(kAnyChannel)) != name || of.second.array || !channels_.count(flagOf(key))) continue;
        const bool isTriple = kindOf(of.second) == Kind::Triple;
        if (!isTriple && kindOf(of.second) != Kind::Float) continue;
        (isTriple ? triple : grey) = &of;
        (isTriple ? tripleKey : greyKey) = key;
    }
    if (!triple || !grey || type.array) return get(c->first);
    // Names that are known when the shader is compiled leave calls of the other type without effect.
    const auto never = [&](const std::string& key) { return isConst(get(channels_.at(flagOf(key)).first), 0); };
    if (never(tripleKey) || never(greyKey)) {
        const auto* only = never(tripleKey) ? grey : triple;
        type = only->second;
        return get(only->first);
    }
    const auto given = [&](const std::string& key) {
        return emit(Op::NotEqual, Kind::Bool, {get(channels_.at(flagOf(key)).first), constant(0)});
    };
    type = triple->second;
    Inst* floats = emit(Op::Select, Kind::Triple, {given(greyKey), coerce(get(grey->first), Kind::Triple), zero(Kind::Triple)});
    return emit(Op::Select, Kind::Triple, {given(tripleKey), get(triple->first), floats});
}

/// "given:NAME": 1 where a call has given that output a value; null for other names, and where its name is no matter of running.
Inst* Builder::channelGiven(const std::string& text) {
    Inst* all = nullptr;
    const std::string_view name = OutputName::givenName(text);
    for (const auto& [key, flag] : channels_) {
        const std::string_view of = OutputName::givenName(key);
        if (name.empty() || of.empty() || of.substr(0, of.find(kAnyChannel)) != name) continue;
        Inst* one = get(flag.first);
        all = all ? emit(Op::Select, Kind::Float, {emit(Op::NotEqual, Kind::Bool, {one, constant(0)}), one, all}) : one;
    }
    return all;
}

/// Of kEntering, its value and its flag; empty in kernels that are not for it.
std::vector<int> Builder::enteringSlots() const {
    if (options_.light != kEntering) return {};
    return {channels_.at(kEntering).first, channels_.at(flagOf(kEntering)).first};
}

/// The irradiance that enters by subsurface(); of several calls the first one's.
void Builder::enters(Inst* irradiance) {
    const std::vector<int> slots = enteringSlots();
    if (slots.empty()) return;
    Inst* had = emit(Op::NotEqual, Kind::Bool, {get(slots[1]), constant(0)});
    set(slots[0], emit(Op::Select, Kind::Triple, {had, get(slots[0]), coerce(irradiance, Kind::Triple)}));
    set(slots[1], constant(1));
}

/// The slot that a call assigns: of a parameter of the main shader, or of a channel. -1: nothing is assigned.
int Builder::channelSlot(const std::string& text, Type type) {
    const auto [name, kept] = ChannelName::parse(text);
    if (kept && (handleDepth_ > 0 || shader_.kind == ShaderKind::Light)) return -1; // it stays with the co-shader or the light
    for (const auto& [known, n] : channelsFor(type))
        if (known == name) return n;
    return -1;
}

/// Stores the value in output `n` where `condition` holds (null: everywhere).
void Builder::giveChannel(int n, const Expr& value, Inst* whole, Inst* condition) {
    for (const auto& [key, channel] : channels_)
        if (const auto flag = channels_.find(flagOf(key)); channel.first == n && flag != channels_.end()) {
            const int at = flag->second.first;
            set(at, condition ? emit(Op::Select, Kind::Float, {condition, constant(1), get(at)}) : constant(1));
        }
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
        for (const std::string_view prefix : kKeptChannels)
            if (!keeps)
                is = emit(Op::Or, Kind::Bool,
                          {is, emit(Op::Equal, Kind::Bool, {name, leaves_.string(std::string(prefix) + known)})});
        giveChannel(n, given, value, is);
    }
    return constant(0);
}

/// writeaov(name, value): gives the value to an output of that name and type; if there is none, no display shows it.
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
            emit(Op::Equal, Kind::Bool, {name, leaves_.string(known)}),
            [&] { return std::vector<Inst*>{constant(take(at) ? 1.0f : 0.0f)}; }, [&] { return std::vector<Inst*>{found}; })[0];
    }
    return found;
}

} // namespace alpenglow::rsl::ir
