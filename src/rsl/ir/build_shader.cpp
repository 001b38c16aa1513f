// The frame of a kernel: parameters in, outputs out.
#include "base/limits.h"
#include "rsl/front/leftmembers.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/build.h"
#include "rsl/ir/builder.h"
#include <algorithm>
#include <cstdlib>
#include <functional>

namespace alpenglow::rsl::ir {

/// Value text of KernelOptions::stringParameters for a numeric parameter: one number, or three.
Inst* Builder::constantParameter(const Symbol& s, const std::string& text) {
    if (isStringLike(s.type.base)) return leaves_.string(text);
    std::vector<float> numbers;
    const char* p = text.c_str();
    for (char* end = nullptr;; p = end) {
        const float f = std::strtof(p, &end);
        if (end == p) break;
        numbers.push_back(f);
    }
    const Kind k = kindOf(s.type);
    if (k == Kind::Array || k == Kind::Matrix || numbers.empty()) return nullptr;
    numbers.resize(static_cast<size_t>(components(k)), numbers[0]);
    return leaves_.constant(k, numbers);
}

/// The array of texts whose elements are given as "name[0]", "name[1]", ...; null when the first is not.
Inst* Builder::constantTexts(const std::string& name, int length, std::span<const std::pair<std::string, std::string>> given) {
    const auto element = [&](int e) -> const std::string* {
        const std::string wanted = name + "[" + std::to_string(e) + "]";
        for (const auto& [n, text] : given)
            if (n == wanted) return &text;
        return nullptr;
    };
    if (!element(0)) return nullptr;
    Inst* a = newArray(Base::String, length);
    for (int e = 0; e < length; ++e) {
        const std::string* text = element(e);
        emit(Op::ArrayStore, Kind::None, {a, constant(static_cast<float>(e)), leaves_.string(text ? *text : "")});
    }
    return a;
}

/// The length of a parameter's array: declared, given by the instance (KernelOptions::stringParameters, "name[]"), or that of its
/// default.
int Builder::parameterLength(const ShaderParameter& p, std::span<const std::pair<std::string, std::string>> given) const {
    if (p.symbol->type.array >= 0 && !p.symbol->open) return p.symbol->type.array;
    for (const auto& [name, value] : given)
        if (name == lengthParameter(p.symbol->name)) return std::clamp(std::atoi(value.c_str()), 0, limits::kShaderArray);
    if (!p.defaultValue) return 0;
    if (p.defaultValue->kind == ExprKind::ArrayList)
        return p.defaultValue->text == "{}" ? 0 : static_cast<int>(p.defaultValue->args.size());
    return std::max(1, p.defaultValue->type.array);
}

Inst* Builder::parameterValue(const ShaderParameter& p) {
    Inst* usual = ownValue(p);
    const auto sent = std::find_if(options_.sentParameters.begin(), options_.sentParameters.end(),
                                   [&](const SentParameter& s) { return s.name == p.symbol->name; });
    Inst* v = sent == options_.sentParameters.end() ? usual : sentValue(p, usual, sent->room);
    if ((p.symbol->type.array < 0 || p.symbol->open) && !lengths(v)) given_[v] = parameterLength(p, options_.stringParameters);
    return v;
}

/// The value that gather() has sent, or the usual one. Of an array of fixed length the elements that came; an open one has the
/// length of what came.
Inst* Builder::sentValue(const ShaderParameter& p, Inst* usual, int room) {
    const Symbol& s = *p.symbol;
    Inst* came = input(InputName::sent(s.name, true).text(), {Base::Float, 0}, false); // one more than there are
    if (!s.type.array)
        return emit(Op::Select, usual->kind,
                    {emit(Op::Less, Kind::Bool, {constant(0), came}),
                     input(InputName::sent(s.name).text(), {s.type.base, 0}, false), usual});
    const bool open = s.type.array < 0 || s.open;
    const int length = open ? parameterLength(p, options_.stringParameters) : arrayLength(usual);
    Inst* sent = input(InputName::sent(s.name).text(), {s.type.base, room}, false);
    Inst* a = newArray(s.type.base, std::max(open ? room : 1, length));
    for (int e = 0; e < arrayLength(a); ++e) {
        Inst* at = constant(static_cast<float>(e));
        Inst* v = e < length ? emit(Op::ArrayLoad, a->element, {usual, at}) : zero(a->element);
        if (e < room)
            v = emit(Op::Select, a->element,
                     {emit(Op::Less, Kind::Bool, {constant(static_cast<float>(e + 1)), came}),
                      emit(Op::ArrayLoad, a->element, {sent, at}), v});
        emit(Op::ArrayStore, Kind::None, {a, at, v});
    }
    if (!open) return a;
    Inst* n = emit(Op::Select, Kind::Float,
                   {emit(Op::Less, Kind::Bool, {constant(0), came}), emit(Op::Sub, Kind::Float, {came, constant(1)}),
                    constant(static_cast<float>(length))});
    lengths_[a] = {newSlot(n), newSlot(n), growing_++};
    return a;
}

/// The value of a parameter from the scene, the primitive or its default.
Inst* Builder::ownValue(const ShaderParameter& p) {
    const Symbol& s = *p.symbol;
    Type type = s.type;
    const int length = parameterLength(p, options_.stringParameters);
    if (type.array) type.array = std::max(1, length); // storage
    if (Inst* v = connectedParameter(s)) return v;
    if (const auto& over = options_.varyingParameters;
        storedType(type) == Type{Base::String, 0} && std::find(over.begin(), over.end(), s.name) != over.end()) {
        // The primitive has a variable of this name, which counts more.
        Site site;
        site.op = "getvar";
        site.shadeop = findShadeop("getvar");
        site.resultType = {Base::Float, 0};
        site.resultKinds = {Kind::Float, Kind::String};
        site.resultNames = {"", "value"};
        site.strings = {s.name};
        return call(Op::Service, std::move(site), {})[1];
    }
    if (type.array > 0 && isStringLike(type.base)) {
        if (Inst* a = constantTexts(s.name, type.array, options_.stringParameters)) {
            noteTexts(a, s, length, options_.stringParameters);
            return a;
        }
    } else {
        for (const auto& [name, value] : options_.stringParameters)
            if (name == s.name)
                if (Inst* c = constantParameter(s, value)) return c;
    }
    if (storedType(type) == Type{Base::String, 0} && (!p.defaultValue || p.defaultValue->kind == ExprKind::String))
        return leaves_.string(p.defaultValue ? p.defaultValue->text : "");
    const auto& computed = options_.computedParameters;
    if (std::find(computed.begin(), computed.end(), s.name) != computed.end()) return defaultValue(p, length);
    const auto& v = options_.varyingParameters;
    const bool varying = s.storage == Storage::Varying || std::find(v.begin(), v.end(), s.name) != v.end();
    return input(InputName::parameter(s.name).text(), type, !varying);
}

/// A value that is known from outside as a constant.
Inst* Builder::givenValue(const Symbol& s, const ParameterValue& v) {
    const Kind kind = kindOf(s.type.element());
    const size_t each = kind == Kind::String ? 1 : static_cast<size_t>(components(kind));
    const size_t count = kind == Kind::String ? v.strings.size() : v.numbers.size() / each;
    const auto element = [&](size_t e) -> Inst* {
        if (e >= count) return zero(kind);
        if (kind == Kind::String) return leaves_.string(v.strings[e]);
        const auto first = v.numbers.begin() + static_cast<std::ptrdiff_t>(e * each);
        return leaves_.constant(kind, std::vector<float>(first, first + static_cast<std::ptrdiff_t>(each)));
    };
    if (!s.type.array) return element(0);
    Inst* a = newArray(s.type.base, std::max<int>(1, s.type.array > 0 && !s.open ? s.type.array : static_cast<int>(count)));
    for (int e = 0; e < arrayLength(a); ++e)
        emit(Op::ArrayStore, Kind::None, {a, constant(static_cast<float>(e)), element(static_cast<size_t>(e))});
    return a;
}

/// The value of a parameter without a default. `length`: of an array.
Inst* Builder::defaultValue(const ShaderParameter& p, int length) {
    const Symbol& s = *p.symbol;
    if (s.type.array) {
        Inst* a = newArray(s.type.base, std::max(1, length));
        if (p.defaultValue) copyArray(a, *p.defaultValue);
        return a;
    }
    return p.defaultValue ? expr(*p.defaultValue, kindOf(s.type)) : zero(kindOf(s.type));
}

bool Builder::buildDefaults(const std::vector<ParameterValue>& given) {
    region_ = &k_.body;
    std::vector<std::pair<const Symbol*, Inst*>> values;
    frames_.push_back({});
    for (const ShaderParameter& p : shader_.parameters) {
        place_ = p.symbol->place;
        const auto known =
            std::find_if(given.begin(), given.end(), [&](const ParameterValue& v) { return v.name == p.symbol->name; });
        int n = p.symbol->type.array;
        if (n < 0)
            n = p.defaultValue && p.defaultValue->kind == ExprKind::ArrayList
                    ? std::max<int>(1, static_cast<int>(p.defaultValue->args.size()))
                    : 1;
        set(slot(p.symbol), known != given.end() ? givenValue(*p.symbol, *known) : defaultValue(p, n));
        values.emplace_back(p.symbol, get(slot(p.symbol)));
    }
    for (const auto& [s, v] : values) {
        const int n = v->kind == Kind::Array ? arrayLength(v) : 1;
        for (int e = 0; e < n; ++e) {
            Inst* value = v->kind == Kind::Array ? emit(Op::ArrayLoad, v->element, {v, constant(static_cast<float>(e))}) : v;
            k_.outputs.push_back({OutputName::parameterOf(s->name, v->kind == Kind::Array ? e : -1).text(), value->kind,
                                  storedType(s->type.element())});
            emit(Op::Output, Kind::None, {value}, static_cast<int>(k_.outputs.size()) - 1);
        }
    }
    k_.body.body.insert(k_.body.body.begin(), functions_.begin(), functions_.end());
    return !failed_;
}

Inst* Builder::initialGlobal(const std::string& name, Type type) {
    const ShaderKind kind = shader_.kind;
    if (kind == ShaderKind::Surface && name == "Ci") return zero(Kind::Triple);
    if (kind == ShaderKind::Surface && name == "Oi") return input("Os", {Base::Color, 0}, false);
    if (kind == ShaderKind::Light && (name == "Cl" || name == "Ol"))
        return leaves_.constant(Kind::Triple, name == "Cl" ? 0.0f : 1.0f);
    bool uniform = false;
    for (const GlobalVariable& g : globalVariables(kind))
        if (name == g.name) uniform = g.uniform;
    Inst* i = input(name, type, uniform);
    // Uniform in RSL, where a grid has one time and one eye. Points of a batch each have their own.
    if (name == "time" || name == "dtime" || name == "E") k_.inputs[size_t(i->index)].uniform = false;
    return i;
}

/// Storage for the elements of an array input, which is read-only.
Inst* Builder::copyOfInput(Inst* array, Base base) {
    Inst* copy = newArray(base, arrayLength(array));
    for (int e = 0; e < arrayLength(array); ++e) {
        Inst* at = constant(e);
        emit(Op::ArrayStore, Kind::None, {copy, at, emit(Op::ArrayLoad, array->element, {array, at})});
    }
    if (given_.count(array)) given_[copy] = given_[array];
    return copy;
}

/// Gives the parameters their values. `assigned`: slots that the shader sets.
void Builder::bindParameters(const std::set<int>& assigned) {
    const auto& asked = options_.messages;
    for (const ShaderParameter& p : shader_.parameters) {
        const Symbol& s = *p.symbol;
        place_ = s.place;
        const int n = slot(p.symbol);
        Inst* v = parameterValue(p);
        value(n) = v->op == Op::ArrayInput && assigned.count(n) ? copyOfInput(v, s.type.base) : v;
        if (s.output && !s.type.array && !isStringLike(s.type.base) &&
            std::find(asked.begin(), asked.end(), s.name) != asked.end())
            messageSlots_[s.name] = {n, s.type};
    }
}

bool Builder::buildShader() {
    region_ = &k_.body;
    place_ = shader_.place;
    frames_.push_back({});
    frames_.back().returned = newSlot(boolean(false));
    beginChannels();
    beginCoShaders();
    std::set<int> assigned;
    std::set<const Function*> seen;
    if (shader_.body) scanAssigned(*shader_.body, assigned, seen);
    assignedAnywhere_ = assigned;
    for (const auto& option : options_.stringParameters)
        if (const InputName parsed = InputName::parse(option.first); parsed.member)
            if (const Symbol* s = ownMember(shader_, parsed.name)) assigned.insert(slot(s));
    bindParameters(assigned);
    lightBlocks_.clear();
    blockRan_ = newSlot(boolean(false));
    if (shader_.kind == ShaderKind::Light && shader_.body) findBlocks(*shader_.body);
    const bool opacityOnly = std::any_of(options_.stringParameters.begin(), options_.stringParameters.end(),
                                         [](const auto& p) { return p.first == kOpacityAlone; });
    if (shader_.body && shader_.object) objectBody(opacityOnly);
    else if (shader_.body) statement(*shader_.body);
    place_ = shader_.place;
    if (shader_.kind == ShaderKind::Light) noteBlocks();
    for (const std::string& name : options_.outputs.empty() ? usualOutputs() : options_.outputs) output(name);
    k_.body.body.insert(k_.body.body.begin(), functions_.begin(), functions_.end());
    k_.facts.writes.assign(writes_.begin(), writes_.end());
    forEach(k_.body, [&](Inst* i) { k_.facts.lightLoops = k_.facts.lightLoops || i->op == Op::LightLoop; });
    return !failed_;
}

} // namespace alpenglow::rsl::ir
