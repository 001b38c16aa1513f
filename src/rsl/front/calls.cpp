// Calls: which functions and shadeops fit, which fits best, and what the call then means.
#include "base/limits.h"
#include "rsl/front/checker.h"
#include <algorithm>
#include <utility>

namespace alpenglow::rsl::front {

namespace {

std::string typeText(Type t, bool handle) { return handle ? "shader" + toString(t).substr(6) : toString(t); }

std::string signatureText(const Function& f) {
    std::string s = typeText(f.result, f.handle) + " " + f.name + "(";
    for (const Symbol* p : f.parameters)
        s += (p == f.parameters[0] ? "" : ", ") + std::string(p->output ? "output " : "") + typeText(p->type, p->handle);
    return s + ")";
}

} // namespace

/// What the renderer's own functions take for handles stands in their texts; arrays and what is put out can be either.
std::vector<Checker::ParameterView> Checker::views(const Signature& s, const Shadeop& op) {
    std::vector<ParameterView> v;
    for (const auto& p : s.parameters) {
        const bool handle = p.name == "handle" && s.text.find("shader handle") != std::string::npos &&
                            s.text.find("(string handle") == std::string::npos;
        const bool either = p.output || p.type.base == Base::Void || p.type.array != 0 || op.section == "Arrays" || op.name == "isoutput";
        v.push_back({p.type, p.output, either ? Handle::Either : handle ? Handle::Shader : Handle::Text});
    }
    return v;
}

std::vector<Checker::ParameterView> Checker::views(const Function& f) {
    std::vector<ParameterView> v;
    for (const Symbol* p : f.parameters) v.push_back({p->type, p->output, p->handle ? Handle::Shader : Handle::Text});
    return v;
}

/// What it costs to give this argument to a parameter of that type; kNever if it cannot be.
int Checker::argumentCost(Expr& argument, const ParameterView& parameter, bool ignoreOutputs) {
    const Info& info = infos_.at(&argument);
    const Type wanted = parameter.type;
    const bool output = parameter.output;
    if (info.any) return 0;
    if (wanted.base == Base::String && !alike(info.handle, parameter.handle)) return kNever;
    if (output && !isVariable(argument) && !ignoreOutputs) return kNever;
    if (wanted.base == Base::Void) return info.listLength >= 0 ? kNever : 0; // any value
    if (wanted.array != 0) {
        if (info.listLength >= 0 && !output) {
            if (wanted.array > 0 && info.listLength > wanted.array) return kNever;
            int cost = 0;
            for (auto& a : argument.args) cost = std::min(kNever, cost + costTo(infos_.at(a.get()), wanted.base));
            return cost;
        }
        const bool fits = info.array.base == wanted.base && info.array.array != 0 &&
                          (wanted.array < 0 || info.array.array < 0 || wanted.array == info.array.array);
        return fits ? (wanted.array < 0 ? 1 : 0) : kNever;
    }
    if (info.array.array || info.listLength >= 0) return kNever;
    if (output) {
        const Base have = cheapest(info);
        if (have == wanted.base) return 0;
        return have != Base::Void && implicitCost(have, wanted.base) == 1 ? 1 : kNever; // among point, vector, normal
    }
    return costTo(info, wanted.base);
}

bool Checker::match(const std::vector<ParameterView>& parameters, bool repeats, bool pairs, Expr& call, Choice& choice,
                    bool ignoreOutputs) {
    const size_t n = call.args.size();
    if (n < parameters.size()) return false;
    choice.cost = 0;
    size_t i = 0;
    for (; i < parameters.size(); ++i) {
        const int c = argumentCost(*call.args[i], parameters[i], ignoreOutputs);
        if (c >= kNever) return false;
        choice.cost += c;
    }
    if (repeats && !parameters.empty())
        for (; i < n; ++i) {
            // A string where a number would repeat begins the pairs.
            if (pairs && call.args[i]->kind == ExprKind::String && parameters.back().type.base != Base::String) break;
            const int c = argumentCost(*call.args[i], parameters.back(), ignoreOutputs);
            if (c >= kNever) return false;
            choice.cost += c;
        }
    choice.positional = i;
    if (i == n) return true;
    if (!pairs || (n - i) % 2) return false;
    for (; i < n; i += 2)
        if (call.args[i]->kind != ExprKind::String) return false;
    return true;
}

/// shadow(map, P, "source", p1, p2, p3, p4): the four corners of an area light stand behind one token. Each gets a token of its own.
static void nameSources(Expr& e) {
    if (e.text != "shadow" && e.text != "environment") return;
    const auto text = [&](size_t i) { return e.args[i]->kind == ExprKind::String; };
    for (size_t i = 2; i + 4 < e.args.size(); ++i) {
        if (!text(i) || e.args[i]->text != "source" || text(i + 1) || text(i + 2) || text(i + 3) || text(i + 4)) continue;
        for (size_t n = 2; n <= 4; ++n) {
            auto token = std::make_unique<Expr>();
            token->kind = ExprKind::String;
            token->place = e.args[i]->place;
            token->text = "source" + std::to_string(n);
            e.args.insert(e.args.begin() + long(i + 2 * n - 2), std::move(token));
        }
        return;
    }
}

void Checker::surveyCall(Expr& e, Info& info) {
    nameSources(e);
    bool broken = false;
    for (auto& a : e.args) broken |= survey(*a).any;
    if (e.text.empty()) { info.any = true; return; } // what is called was reported
    std::vector<std::string> candidates, notes;
    bool known = false, outputsOnly = false;
    const auto offer = [&](Choice choice, const std::vector<ParameterView>& parameters, bool repeats, bool pairs,
                           const std::string& text) {
        known = true;
        candidates.push_back(text);
        if (match(parameters, repeats, pairs, e, choice, false)) {
            info.choices.push_back(choice);
        } else {
            outputsOnly |= match(parameters, repeats, pairs, e, choice, true);
            if (!broken && notes.size() < size_t(limits::kCandidateNotes))
                notes.push_back("candidate " + text + ": " + whyNot(parameters, repeats, pairs, e));
        }
    };
    for (size_t i = scopes_.size(); i-- > 0 && info.choices.empty();) {
        const auto [from, to] = scopes_[i].functions.equal_range(e.text);
        for (auto f = from; f != to; ++f) {
            Choice c;
            c.function = f->second;
            c.nested = true;
            c.result = f->second->result;
            offer(c, views(*f->second), false, false, signatureText(*f->second));
        }
    }
    if (info.choices.empty())
        for (const auto& f : unit_->functions) {
            if (f->name != e.text) continue;
            Choice c;
            c.function = f.get();
            c.unit = unit_;
            c.result = f->result;
            // A shadeop written in RSL may call the shadeop of its own name with other arguments, not itself.
            if (unit_ != &main_ && checking_.count(f.get())) continue;
            offer(c, views(*f), false, false, signatureText(*f));
        }
    const auto offerAll = [&](const Shadeop* op) {
        if (!op) return;
        for (const Signature& s : op->signatures) {
            Choice c;
            c.shadeop = op;
            c.signature = &s;
            c.result = s.result;
            offer(c, views(s, *op), s.repeats, s.pairs, s.text);
        }
    };
    // A function of the shader's own joins those of its name, and the one that fits best is called; among functions that fit equally well
    // the first counts: the shader's, then those of plug-ins.
    if (unit_ == &main_)
        for (const auto& p : program_.plugins) offerAll(p->find(e.text));
    if (unit_ == &main_ || info.choices.empty()) offerAll(findShadeop(e.text));
    if (info.choices.empty()) {
        info.any = true;
        if (known && broken) return; // what went wrong inside was reported
        if (known) return noMatch(e, candidates, std::move(notes), outputsOnly);
        if (unit_->hides(e.text)) return;
        std::vector<std::string> names;
        for (const auto& f : unit_->functions) names.push_back(f->name);
        for (const auto& s : scopes_)
            for (const auto& [name, f] : s.functions) names.push_back(name);
        std::sort(names.begin(), names.end());
        for (const Shadeop& s : shadeops())
            if (s.name.rfind("__", 0) != 0) names.push_back(s.name);
        const std::string near = nearestName(e.text, names);
        sources_.error(e.place, "there is no function '" + e.text + "'", near.empty() ? "" : "did you mean '" + near + "'?");
        return;
    }
    for (const Choice& c : info.choices)
        if (c.result.base == Base::String) {
            const bool fromArray = c.shadeop && c.shadeop->section == "Arrays" && !e.args.empty();
            const bool handle = c.function ? c.function->handle : c.signature->text.compare(0, 6, "shader") == 0;
            info.handle = fromArray ? infos_.at(e.args[0].get()).handle : handle ? Handle::Shader : Handle::Text;
        }
    for (const Choice& c : info.choices) {
        if (c.result.array != 0) { info.array = c.result; continue; }
        int& cost = info.cost[int(c.result.base)];
        cost = std::min(cost, c.cost);
    }
    // Of a call that can give one value or several, the single value is meant unless an array is wanted.
    if (info.array.array) {
        bool single = false;
        for (int c : info.cost) single |= c < kNever;
        if (single) info.array = {};
    }
}

/// The other way about: an array is wanted.
void Checker::preferArray(const Expr& e) {
    Info& info = infos_.at(&e);
    if (info.array.array || info.any) return;
    for (const Choice& c : info.choices)
        if (c.result.array) {
            info.array = c.result;
            info.cost.fill(kNever);
        }
}

void Checker::noMatch(Expr& e, const std::vector<std::string>& candidates, std::vector<std::string> notes,
                      bool outputsOnly) {
    std::string given;
    for (auto& a : e.args) given += (given.empty() ? "" : ", ") + describe(*a);
    std::string hint = "it can be called as";
    for (size_t i = 0; i < candidates.size() && i < 6; ++i) hint += (i ? "; " : " ") + candidates[i];
    if (candidates.size() > 6) hint += "; and " + std::to_string(candidates.size() - 6) + " more";
    const std::string what = outputsOnly ? "an output argument of '" + e.text + "' must be a variable of the same type"
                             : e.args.empty() ? "'" + e.text + "' cannot be called without arguments"
                                              : "'" + e.text + "' cannot be called with (" + given + ")";
    sources_.error(e.place, what, hint, std::move(notes));
}

void Checker::settleCall(ExprPtr& pointer, Type result) {
    Expr& e = *pointer;
    const Info& info = infos_.at(&e);
    const Choice* best = nullptr;
    for (const Choice& c : info.choices) {
        const bool fits = result.array != 0 ? c.result.base == result.base && c.result.array != 0 : c.result == result;
        if (fits && (!best || c.cost < best->cost)) best = &c;
    }
    if (!best) return; // an array where only single values are; reported by the caller's conversion
    const Choice choice = *best;
    std::vector<ParameterView> parameters =
        choice.signature ? views(*choice.signature, *choice.shadeop) : views(*choice.function);
    for (size_t i = 0; i < choice.positional; ++i) {
        const ParameterView p = parameters[std::min(i, parameters.size() - 1)];
        ExprPtr& a = e.args[i];
        if (infos_.at(a.get()).any) { settleCheapest(a); continue; }
        if (p.output) {
            settleVariable(a);
            written(*a);
        } else if (infos_.at(a.get()).channel && choice.shadeop && i == 0) {
            // texture(name[channel]); (name)[channel] too.
            e.channel = std::move(a->args[1]);
            ExprPtr name = std::move(a->args[0]);
            settle(e.channel, {Base::Float, 0});
            settle(name, {Base::String, 0});
            a = std::move(name);
        } else {
            settle(a, p.type, p.handle);
        }
    }
    settlePairs(e, choice.positional, choice.shadeop);
    // A shadeop with a result that is an array of open length gets the length that is wanted.
    e.type = choice.result.array < 0 && result.array > 0 ? result : choice.result;
    finish(e);
    for (const auto& p : e.pairs) e.varying |= p.value->varying;
    if (choice.shadeop) return bindShadeop(e, choice);
    e.kind = ExprKind::FunctionCall;
    if (choice.nested) {
        e.function = choice.function;
        if (checking_.count(choice.function))
            sources_.error(e.place, "function '" + e.text + "' calls itself; recursion is not allowed");
    } else {
        e.function = instance(*choice.function, *choice.unit, {}, e.place);
    }
    if (e.function && varyingFunctions_.count(e.function)) {
        e.varying = true;
        readsPoint(e, "what '" + e.text + "' gives");
    }
}

/// What is the same for all points when the arguments are: whether a message was found, what a file or the frame says, a length, and
/// a picture read where the arguments say. What an argument holds that is put out does not count.
bool Checker::uniformResult(const Expr& e, const Choice& choice) const {
    const Shadeop& op = *choice.shadeop;
    if (op.name == "arraylength" || op.name == "capacity" || op.name == "textureinfo") return e.kind == ExprKind::ShadeopCall;
    if (op.section == kPluginSection) return true;
    if (op.section == "Messages") return op.name != "gridmin" && op.name != "gridmax" && op.name != "rayinfo" && op.name != "getvar";
    return (op.name == "texture" || op.name == "environment") && e.args.size() > 1;
}

void Checker::bindShadeop(Expr& e, const Choice& choice) {
    const Shadeop& op = *choice.shadeop;
    e.shadeop = &op;
    e.signature = choice.signature;
    if (op.name == "outputchannel" && e.args[0]->kind == ExprKind::String) {
        std::string name = e.args[0]->text;
        if (name.rfind("light:", 0) == 0 || name.rfind("local:", 0) == 0) name.erase(0, 6);
        program_.channels.emplace(name, e.args[1]->type);
    }
    if (op.name == "getvar" && e.args[1]->kind == ExprKind::String)
        program_.primitiveVariables.emplace(e.args[1]->text, e.args.size() > 2 ? e.args[2]->type : Type{});
    program_.handles |= op.name == "getshader" || op.name == "getshaders" || op.name == "getvar";
    if (op.name == "resize" || op.name == "reserve" || op.name == "push" || op.name == "pop") {
        const Symbol* s = e.args.empty() ? nullptr : e.args[0]->symbol;
        const bool open = s && (s->resizable || (s->origin == Symbol::Origin::FunctionParameter && s->type.array == -1));
        if (s && !open && s->type.base != Base::Void)
            sources_.error(e.args[0]->place, "the length of '" + s->name + "' is fixed",
                           s->origin == Symbol::Origin::Local ? "declare it as " + toString(s->type.element()) + " " + s->name + "[]"
                                                              : "only local arrays and parameters of functions can change theirs");
    }
    if (op.name == "push" && e.args.size() == 2 && e.args[0]->symbol && e.args[1]->type.base == Base::String) {
        const Handle array = e.args[0]->symbol->handle ? Handle::Shader : Handle::Text;
        if (const Info& value = infos_.at(e.args[1].get()); !alike(array, value.handle))
            sources_.error(e.args[1]->place, "expected a " + named({Base::String, 0}, array) + ", not " + describe(*e.args[1]));
    }
    if (kind_ && !(op.contexts & contextOf(*kind_)) && !(function_ && function_->anywhere)) {
        std::string where;
        for (int k = 0; k < 6; ++k)
            if (op.contexts & contextOf(ShaderKind(k)))
                where += (where.empty() ? "" : ", ") + std::string(toString(ShaderKind(k)));
        sources_.error(e.place, "'" + op.name + "' cannot be used in a " + toString(*kind_) + " shader", "it can in: " + where);
        return; // its text would be wrong here line by line
    }
    if (uniformResult(e, choice)) {
        e.varying = false; // a length is that of all points
        for (size_t i = 0; i < e.args.size() && op.section != "Arrays"; ++i)
            if (!choice.signature->parameters[std::min(i, choice.signature->parameters.size() - 1)].output) e.varying |= e.args[i]->varying;
    } else if (op.lowering != Lowering::Runtime && op.lowering != Lowering::Special && op.lowering != Lowering::Rsl &&
               op.name != "format" && op.name != "concat") {
        e.varying = true;
        if (e.type.base != Base::Void) readsPoint(e, "what '" + op.name + "' gives");
    }
    if (op.lowering == Lowering::Unavailable && reportedUnavailable_.insert(&op).second)
        sources_.warning(e.place, "'" + op.name + "' is not yet available; " +
                                      (e.type.base == Base::Void ? "the call does nothing" : "its value is 0"));
    if (op.lowering != Lowering::Rsl) return;
    std::pair<std::string, std::string> rename;
    for (const NamedArg& p : e.pairs) {
        // The one shadeop in RSL with a choice of kernels.
        if (op.name == "filterstep" && p.name == "filter" && p.value->kind == ExprKind::String) {
            std::string filter = p.value->text;
            filter.erase(std::remove(filter.begin(), filter.end(), '-'), filter.end());
            if (findShadeop("__filterstep_" + filter)) rename = {"__filterstep_catmullrom", "__filterstep_" + filter};
            else sources_.warning(p.place, "there is no filter \"" + p.value->text + "\"; catmull-rom is used");
        } else if (op.name != "filterstep" || (p.name != "filter" && p.name != "width")) {
            sources_.warning(p.place, "\"" + p.name + "\" of '" + op.name + "' is not yet available and ignored");
        }
    }
    const Unit& unit = rslUnit(op);
    for (const auto& f : unit.functions) {
        bool same = f->name == op.name && f->result == choice.signature->result &&
                    f->parameters.size() == choice.signature->parameters.size();
        for (size_t i = 0; same && i < f->parameters.size(); ++i)
            same = f->parameters[i]->type == choice.signature->parameters[i].type;
        if (!same) continue;
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
    sources_.error(e.place, "the text of '" + op.name + "' has no function for " + choice.signature->text);
}

/// "name", value, ... behind the positional arguments.
void Checker::settlePairs(Expr& e, size_t positional, const Shadeop* op) {
    for (size_t i = positional; i + 1 < e.args.size(); i += 2) {
        NamedArg pair;
        pair.place = e.args[i]->place;
        pair.name = e.args[i]->text;
        // "uniform float blur" declares in place; the name is the last word.
        if (const size_t space = pair.name.find_last_of(" \t"); space != std::string::npos) pair.name.erase(0, space + 1);
        ExprPtr value = std::move(e.args[i + 1]);
        const Info& info = infos_.at(value.get());
        const OptionalParameter* optional = nullptr;
        std::vector<std::string> names;
        for (const auto& o : op->optional) {
            names.push_back(o.name);
            if (o.name == pair.name) optional = &o;
        }
        if (info.any) {
            settleCheapest(value);
        } else if (!optional) {
            // Names with a prefix are messages ("light:x"), those of bake3d and texture3d are channels.
            const bool channels = op->name == "bake3d" || op->name == "texture3d";
            const std::string near = nearestName(pair.name, names);
            if (pair.name.find(':') == std::string::npos && !channels && op->lowering != Lowering::Unavailable)
                sources_.warning(pair.place, "'" + op->name + "' has no parameter \"" + pair.name + "\"; it is ignored",
                                 near.empty() ? "" : "did you mean \"" + near + "\"?");
            settleCheapest(value);
        } else if (optional->output) {
            pair.output = true;
            const int cost = argumentCost(*value, {optional->type, true, Handle::Either}, false);
            const bool array = info.array.array && info.array.base == optional->type.base;
            if (cost >= kNever && !array) {
                sources_.error(value->place, "\"" + pair.name + "\" gives a " + toString(optional->type) +
                                                 ": it needs a variable of that type");
            } else {
                settleVariable(value);
                written(*value);
            }
        } else if (optional->type.array != 0 && !info.array.array && info.listLength < 0) {
            settle(value, costTo(info, optional->type.base) < kNever && cheapest(info) != Base::Float ? optional->type.element()
                                                                                                   : Type{cheapest(info), 0});
        } else {
            settle(value, optional->type);
        }
        pair.value = std::move(value);
        e.pairs.push_back(std::move(pair));
    }
    if (positional < e.args.size()) e.args.resize(positional);
}

} // namespace alpenglow::rsl::front
