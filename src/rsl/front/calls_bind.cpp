// What a call means once it is known which shadeop it is: the arguments become what its parameters are, tokens are looked up.
#include "base/limits.h"
#include "rsl/front/checker.h"
#include "rsl/front/protocol.h"
#include "rsl/front/writes.h"
#include <algorithm>
#include <cstdlib>
#include <set>
#include <string_view>
#include <utility>

namespace alpenglow::rsl::front {

namespace {
/// How many optional parameters the text of a shadeop takes behind its own.
size_t optionalInText(const Shadeop& op) {
    static const std::set<std::string_view> kOps = {"bump",
                                                    "visibility",
                                                    "rayhittest",
                                                    "fulltrace",
                                                    "wnoise",
                                                    "emit",
                                                    "areashadow",
                                                    "generateSamplesEnv",
                                                    "directlighting",
                                                    "diffuselighting",
                                                    "specularlighting",
                                                    "evaluateSamplesEnv",
                                                    "indirectspecular"};
    return kOps.count(op.name) ? op.optional.size() : 0;
}

/// Whether a text has conversions of printf().
bool converts(const std::string& pattern) {
    for (size_t i = 0; i + 1 < pattern.size(); ++i) {
        if (pattern[i] != '%') continue;
        if (pattern[i + 1] != '%') return true;
        ++i; // "%%" is one sign
    }
    return false;
}

/// print() of values: they get the pattern that shows each, with blanks between them. Returns `signature`.
const Signature* withPattern(Expr& e, const Shadeop& op, const Signature* signature) {
    if (op.name != "print") return signature;
    const auto text = [](const Expr& a) { return a.type.base == Base::String; };
    const Expr& first = *e.args[0];
    if (text(first) && (e.args.size() == 1 || first.kind != ExprKind::String || converts(first.text))) return signature;
    auto pattern = std::make_unique<Expr>();
    pattern->kind = ExprKind::String;
    pattern->place = first.place;
    pattern->type = {Base::String, 0};
    pattern->varying = false;
    for (const ExprPtr& a : e.args) pattern->text += std::string(pattern->text.empty() ? "" : " ") + (text(*a) ? "%s" : "%g");
    e.args.insert(e.args.begin(), std::move(pattern));
    return signature;
}
} // namespace

/// What is the same for all points when the arguments are: whether a message was found, what a file or the frame says, a length,
/// what a text is like, and a picture read where the arguments say. What an argument holds that is put out does not count.
bool Checker::uniformResult(const Expr& e, const Choice& choice) const {
    const Shadeop& op = *choice.shadeop;
    if (op.name == "arraylength" || op.name == "capacity" || op.name == "textureinfo") return e.kind == ExprKind::ShadeopCall;
    if (op.section == kPluginSection || op.name == "match" || op.name == "stringhash") return true;
    static const std::set<std::string_view> kOfThePoint = {"gridmin", "gridmax", "readaov", "evalparam"};
    if (op.section == "Messages") return !kOfThePoint.count(op.name);
    return (op.name == "texture" || op.name == "environment") && e.args.size() > 1;
}

/// outputchannel() and writeaov() make an output of that name.
void Checker::bindChannel(const Expr& e) {
    const Type type = e.args[1]->type;
    const bool written = e.args[0]->kind == ExprKind::String; // else it can be any name that displays request
    const std::string name = written ? ChannelName::parse(e.args[0]->text).name : kAnyChannel + toString(type);
    const bool parameter = written && shaderParameters_.count(name) > 0;
    if (type.array < 0 && !parameter) {
        sources_.report(e.args[1]->place, msg::kChannelOpen);
        return;
    }
    const auto [i, fresh] = program_.channels.emplace(name, type);
    const Type first = i->second;
    if (!fresh && !parameter &&
        (componentCount(first.base) != componentCount(type.base) || (first.array != 0) != (type.array != 0)))
        sources_.report(e.args[1]->place, msg::kChannelTypes(name, toString(first), toString(type)));
}

void Checker::bindPrimitiveVariable(const Expr& e) {
    const std::string& op = e.shadeop->name;
    if (op == "getvar" && e.args[1]->kind == ExprKind::String)
        program_.primitiveVariables.emplace(e.args[1]->text, e.args.size() > 2 ? e.args[2]->type : Type{});
    if (op == "readprimvar" && e.args[0]->kind == ExprKind::String)
        program_.primitiveVariables.emplace(e.args[0]->text, e.args[1]->type);
}

/// resize() and the like change the length of an array, which must be open.
void Checker::bindArrayChange(const Expr& e) {
    if (!e.args.empty() && e.args[0]->kind == ExprKind::Part) changesLength(*e.args[0]);
    const Symbol* s = e.args.empty() ? nullptr : e.args[0]->symbol;
    const bool open = s && (s->resizable || (s->origin == Symbol::Origin::FunctionParameter && s->type.array == -1));
    if (s && !open && s->type.base != Base::Void)
        sources_.report(e.args[0]->place, msg::kFixedLength(s->name),
                        s->origin == Symbol::Origin::Local ? "declare it as " + toString(s->type.element()) + " " + s->name + "[]"
                                                           : "only local arrays and parameters of functions can change theirs");
    if (e.shadeop->name == "push" && e.args.size() == 2 && s && isStringLike(s->type.base) &&
        isStringLike(e.args[1]->type.base)) {
        const Info& value = infos_.at(e.args[1].get());
        if (value.cost[int(s->type.base)] >= kNever)
            sources_.report(e.args[1]->place, msg::kTypeMismatch(toString(s->type.element()), describe(*e.args[1])));
    }
}

/// Whether shaders of this kind may call it; reported if not.
bool Checker::allowedHere(const Expr& e) {
    const Shadeop& op = *e.shadeop;
    if (!kind_ || (op.contexts & contextOf(*kind_)) || (function_ && function_->anywhere)) return true;
    std::string where;
    for (int k = 0; k < 6; ++k)
        if (op.contexts & contextOf(ShaderKind(k))) where += (where.empty() ? "" : ", ") + std::string(toString(ShaderKind(k)));
    sources_.report(e.place, msg::kWrongShaderKind(op.name, toString(*kind_)), "it can in: " + where);
    return false;
}

/// Whether the result is uniform or varying.
void Checker::classOfResult(Expr& e, const Choice& choice) {
    const Shadeop& op = *e.shadeop;
    if (uniformResult(e, choice)) {
        e.varying = false; // a length is that of all points
        for (size_t i = 0; i < e.args.size() && op.section != "Arrays"; ++i)
            if (writesArgument(e, i) == Writes::No) e.varying |= e.args[i]->varying;
    } else if (op.lowering != Lowering::Runtime && op.lowering != Lowering::Special && op.lowering != Lowering::Rsl &&
               op.name != "format" && op.name != "concat") {
        e.varying = true;
        if (e.type.base != Base::Void) readsPoint(e, "what '" + op.name + "' gives");
    }
    if (op.name == "rayinfo") readsPoint(e, "what 'rayinfo' gives", false); // the same for the points of one batch, but of a ray
}

/// Tokens of a shadeop whose text is RSL. A choice among texts gives what is renamed in the one that is called.
std::pair<std::string, std::string> Checker::checkTextPairs(const Expr& e) {
    const Shadeop& op = *e.shadeop;
    std::pair<std::string, std::string> rename;
    for (const NamedArg& p : e.pairs) {
        // The one shadeop in RSL with a choice of kernels.
        if (op.name == "filterstep" && p.name == "filter" && p.value->kind == ExprKind::String) {
            std::string filter = p.value->text;
            filter.erase(std::remove(filter.begin(), filter.end(), '-'), filter.end());
            if (findShadeop("__filterstep_" + filter)) rename = {"__filterstep_catmullrom", "__filterstep_" + filter};
            else sources_.report(p.place, msg::kNoSuchStepFilter(p.value->text));
        } else if (optionalInText(op) == 0 && op.name != "filterstep" &&
                   std::ranges::any_of(op.optional, [&](const OptionalParameter& o) { return o.name == p.name; })) {
            sources_.report(p.place, msg::kParameterNotAvailable(p.name, op.name));
        }
    }
    return rename;
}

/// The call becomes one of the function that is the text of the shadeop.
void Checker::bindText(Expr& e, const Choice& choice) {
    const Shadeop& op = *e.shadeop;
    const auto rename = checkTextPairs(e);
    const Unit& unit = rslUnit(op);
    const size_t behind = optionalInText(op);
    const size_t count = choice.signature->parameters.size();
    for (const auto& f : unit.functions) {
        bool same = f->name == op.name && f->result == choice.signature->result && f->parameters.size() == count + behind;
        for (size_t i = 0; same && i < count; ++i) same = f->parameters[i]->type == choice.signature->parameters[i].type;
        if (!same) continue;
        if (behind) optionalArguments(e, op);
        e.kind = ExprKind::FunctionCall;
        // Its globals are visible whatever the shader calls its own variables; nothing of the shader is.
        auto parameters = std::exchange(shaderParameters_, {});
        e.function = instance(*f, unit, rename, e.place);
        shaderParameters_ = std::move(parameters);
        if (e.function && varyingFunctions_.count(e.function)) {
            e.varying = true;
            readsPoint(e, "what '" + op.name + "' gives");
        }
        return;
    }
    sources_.report(e.place, msg::kNoText(op.name, choice.signature->text));
}

void Checker::bindShadeop(Expr& e, const Choice& choice) {
    const Shadeop& op = *choice.shadeop;
    e.shadeop = &op;
    e.signature = withPattern(e, op, choice.signature);
    if (op.name == "outputchannel" || op.name == "writeaov") bindChannel(e);
    bindPrimitiveVariable(e);
    static const std::set<std::string_view> kOfHandles = {"getshader", "getshaders", "getvar", "readprimvar", "hasmethod"};
    program_.handles |= kOfHandles.count(op.name) > 0;
    if (op.name == "resize" || op.name == "reserve" || op.name == "push" || op.name == "pop") bindArrayChange(e);
    if (!allowedHere(e)) return; // its text would be wrong here line by line
    classOfResult(e, choice);
    // shadow("raytrace", ...) sends rays. A map by that name is known here only where it is written down.
    const bool rays =
        op.name == "shadow" && !e.args.empty() && e.args[0]->kind == ExprKind::String && e.args[0]->text == "raytrace";
    if (op.lowering == Lowering::Unavailable && !rays && reportedUnavailable_.insert(&op).second)
        sources_.report(
            e.place, msg::kShadeopNotAvailable(op.name, e.type.base == Base::Void ? "the call does nothing" : "its value is 0"));
    if (op.lowering == Lowering::Rsl) bindText(e, choice);
}

/// The tokens become the last arguments, in the order of the descriptor.
void Checker::optionalArguments(Expr& e, const Shadeop& op) {
    for (const OptionalParameter& o : op.optional) {
        ExprPtr given;
        for (NamedArg& p : e.pairs)
            if (p.name == o.name) given = std::move(p.value);
        if (!given) {
            given = std::make_unique<Expr>();
            const bool text = isStringLike(o.type.base); // every string's default is none
            given->kind = text ? ExprKind::String : ExprKind::Number;
            if (!text) given->number = std::strtod(o.defaultText.c_str(), nullptr);
            given->type = o.type;
            given->varying = false;
            given->place = e.place;
        }
        e.height = std::max(e.height, given->height + 1);
        e.args.push_back(std::move(given));
    }
    e.pairs.clear();
}

/// A pair whose name is no literal: two pairs, that of the name first. What its value must be is known when the kernel is built.
void Checker::madeName(Expr& e, size_t at, const Shadeop& op) {
    NamedArg name, given;
    name.named = NamedArg::Name::Made;
    given.named = NamedArg::Name::ByMade;
    name.place = given.place = e.args[at]->place;
    resolveTypes(e.args[at], {Base::String, 0});
    // A text in RSL takes its parameters here, and its names must be literals.
    const bool ignored = op.lowering == Lowering::Unavailable || op.lowering == Lowering::Rsl;
    if (op.lowering == Lowering::Rsl)
        sources_.report(name.place, msg::kMadeName(op.name), "'" + op.name + "' is a function in RSL");
    ExprPtr& value = e.args[at + 1];
    refuseStructure(*value);
    const bool variable = isVariable(*value) && !infos_.at(value.get()).any;
    if (variable && !ignored) resolveVariable(value);
    else resolveCheapest(value);
    if (ignored) return;
    given.output = variable && (op.name == "texture3d" || std::any_of(op.optional.begin(), op.optional.end(), [&](const auto& o) {
                                    return o.output && o.type.base == value->type.base;
                                }));
    name.value = std::move(e.args[at]);
    given.value = std::move(value);
    e.pairs.push_back(std::move(name));
    e.pairs.push_back(std::move(given));
}

/// "name", value, ... behind the positional arguments.
void Checker::resolvePairs(Expr& e, size_t positional, const Shadeop* op) {
    for (size_t i = positional; i + 1 < e.args.size(); i += 2) {
        if (e.args[i]->kind != ExprKind::String) {
            madeName(e, i, *op);
            continue;
        }
        NamedArg pair;
        pair.place = e.args[i]->place;
        pair.name = e.args[i]->text;
        // "uniform float blur" declares in place; the name is the last word.
        if (const size_t space = pair.name.find_last_of(" \t"); space != std::string::npos) pair.name.erase(0, space + 1);
        ExprPtr value = std::move(e.args[i + 1]);
        refuseStructure(*value);
        const Info& info = infos_.at(value.get());
        const OptionalParameter* optional = nullptr;
        std::vector<std::string> names;
        for (const auto& o : op->optional) {
            names.push_back(o.name);
            if (o.name == pair.name) optional = &o;
        }
        // A space is a name or, as in PRMan, a matrix.
        const bool space =
            optional && optional->type == Type{Base::String, 0} && pair.name.ends_with("space") && cheapest(info) == Base::Matrix;
        if (info.any || space) {
            resolveCheapest(value);
        } else if (!optional) {
            // Names with a prefix are messages ("light:x"), those of bake3d and texture3d are channels.
            const bool channels = op->name == "bake3d" || op->name == "texture3d";
            const std::string near = nearestName(pair.name, names);
            if (pair.name.find(':') == std::string::npos && !channels && op->lowering != Lowering::Unavailable)
                sources_.report(pair.place, msg::kNoSuchParameter(op->name, pair.name),
                                near.empty() ? "" : "did you mean \"" + near + "\"?");
            pair.output = op->name == "texture3d" && isVariable(*value); // filled from the file
            if (pair.output) {
                resolveVariable(value);
                written(*value);
            } else {
                resolveCheapest(value);
            }
        } else if (optional->output) {
            pair.output = true;
            const int cost = argumentCost(*value, {optional->type, true, isStringLike(optional->type.base)}, false);
            const bool array = info.array.array && info.array.base == optional->type.base;
            if (cost >= kNever && !array) {
                sources_.report(value->place, msg::kOutputPair(pair.name, toString(optional->type)));
            } else {
                resolveVariable(value);
                written(*value);
            }
        } else if (optional->type.array != 0 && !info.array.array && info.listLength < 0) {
            resolveTypes(value, costTo(info, optional->type.base) < kNever && cheapest(info) != Base::Float
                                    ? optional->type.element()
                                    : Type{cheapest(info), 0});
        } else {
            resolveTypes(value, optional->type);
        }
        pair.value = std::move(value);
        e.pairs.push_back(std::move(pair));
    }
    if (positional < e.args.size()) e.args.resize(positional);
}

} // namespace alpenglow::rsl::front
