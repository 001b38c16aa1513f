// Calls: which functions and shadeops fit, which fits best, and what the call then means.
#include "base/limits.h"
#include "rsl/front/checker.h"
#include "rsl/front/headers.h"
#include <algorithm>
#include <utility>

namespace alpenglow::rsl::front {

namespace {

std::string unknownFunctionHint(const std::string& name, const std::vector<std::string>& known) {
    if (const std::string_view dialect = dialectOfFunction(name); !dialect.empty())
        return "--dialect " + std::string(dialect) + " reads shaders that call it";
    const std::string near = nearestName(name, known);
    return near.empty() ? "" : "did you mean '" + near + "'?";
}

} // namespace

/// What the renderer's own functions take for handles stands in their texts; arrays and what is put out can be either.
std::vector<Checker::ParameterView> Checker::views(const Signature& s, const Shadeop& op) {
    std::vector<ParameterView> v;
    for (const auto& p : s.parameters) {
        const bool any = p.output || p.type.array != 0 || op.section == "Arrays" || op.name == "isoutput";
        v.push_back({p.type, p.output, any && isStringLike(p.type.base)});
    }
    return v;
}

std::vector<Checker::ParameterView> Checker::views(const Function& f) {
    std::vector<ParameterView> v;
    for (const Symbol* p : f.parameters) v.push_back({p->type, p->output, false});
    return v;
}

/// The type to which the argument is resolved. A parameter that takes strings and handles takes the argument's own type.
Type Checker::wantedType(const ParameterView& p, const Expr& argument) const {
    if (!p.anyText) return p.type;
    const Base other = p.type.base == Base::String ? Base::Shader : Base::String;
    const auto isOther = [&](const Info& i) {
        return i.array.array ? i.array.base == other : i.cost[int(other)] < i.cost[int(p.type.base)];
    };
    const Info& info = infos_.at(&argument);
    const bool list = info.listLength > 0 && argument.kind == ExprKind::ArrayList;
    return {isOther(list ? infos_.at(argument.args[0].get()) : info) ? other : p.type.base, p.type.array};
}

/// The cost of passing this argument to a parameter of that type; kNever if it does not convert.
int Checker::argumentCost(Expr& argument, const ParameterView& parameter, bool ignoreOutputs) {
    const Info& info = infos_.at(&argument);
    if (info.any) return 0;
    if (isStruct(parameter.type)) return structureCost(argument, parameter, ignoreOutputs);
    if (isStructure(info)) return kNever;
    const Type wanted = wantedType(parameter, argument);
    const bool output = parameter.output;
    if (output && !isVariable(argument) && !ignoreOutputs) return kNever;
    if (wanted.base == Base::Void) return info.listLength >= 0 ? kNever : 0; // any value
    if (wanted.array != 0) {
        if (argument.kind == ExprKind::Member && !output) return kConversion;
        if (info.listLength >= 0 && !output) {
            if (wanted.array > 0 && info.listLength > wanted.array) return kNever;
            int cost = 0;
            for (auto& a : argument.args) cost = std::min(kNever, cost + costTo(infos_.at(a.get()), wanted.base));
            return cost;
        }
        const bool fits = info.array.base == wanted.base && info.array.array != 0 &&
                          (wanted.array < 0 || info.array.array < 0 || wanted.array == info.array.array);
        return fits ? (wanted.array < 0 ? kConversion : 0) : kNever;
    }
    if (info.array.array || info.listLength >= 0) return kNever;
    if (output) {
        const Base have = cheapest(info);
        if (have == wanted.base) return 0;
        return have != Base::Void && implicitCost(have, wanted.base) == kConversion ? kConversion
                                                                                    : kNever; // among point, vector, normal
    }
    return costTo(info, wanted.base);
}

/// The cost of passing a structure; what is put out must be a variable of it.
int Checker::structureCost(const Expr& argument, const ParameterView& parameter, bool ignoreOutputs) const {
    if (parameter.output && !ignoreOutputs && !isVariable(argument)) return kNever;
    const int cost = costToStructure(argument, parameter.type);
    return cost < kNever && parameter.type.array < 0 ? cost + kConversion : cost;
}

/// Whether it is a string and can be nothing else.
bool Checker::isText(const Expr& e) const {
    if (e.kind == ExprKind::String) return true;
    const Info& text = infos_.at(&e);
    return text.cost[int(Base::String)] == 0 && cheapest(text) == Base::String;
}

bool Checker::match(const std::vector<ParameterView>& parameters, bool repeats, bool pairs, Expr& call, Choice& choice,
                    bool ignoreOutputs) {
    const size_t n = call.args.size();
    if (n < parameters.size()) return false;
    choice.cost = 0;
    size_t i = 0;
    for (; i < parameters.size(); ++i) {
        const int c = argumentCost(*call.args[i], parameters[i], ignoreOutputs || isReceiver(call, i));
        if (c >= kNever) return false;
        choice.cost = std::min(kNever - 1, choice.cost + c);
    }
    if (repeats && !parameters.empty())
        for (; i < n; ++i) {
            // A string where a number would repeat begins the pairs.
            if (pairs && isText(*call.args[i]) && parameters.back().type.base != Base::String) break;
            const int c = argumentCost(*call.args[i], parameters.back(), ignoreOutputs);
            if (c >= kNever) return false;
            choice.cost = std::min(kNever - 1, choice.cost + c);
        }
    choice.positional = i;
    if (i == n) return true;
    if (!pairs || (n - i) % 2) return false;
    for (; i < n; i += 2) { // a name may be in a variable, too: see resolvePairs()
        const Expr& name = *call.args[i];
        if (name.kind == ExprKind::String) continue;
        if (!choice.shadeop || !isText(name)) return false;
        choice.cost = std::min(kNever - 1, choice.cost + kLastResort);
    }
    return true;
}

/// shadow(map, P, "source", p1, p2, p3, p4): the four corners of an area light stand behind one token. Each gets a token of its
/// own.
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

/// photonmap(map, P) of Pixie, unless it is a function of the shader: about the normal of the surface.
static void addNormal(Expr& e, const Unit& unit) {
    if (e.text != "photonmap" || e.args.size() < 2 || (e.args.size() > 2 && e.args[2]->kind != ExprKind::String)) return;
    for (const auto& f : unit.functions)
        if (f->name == e.text) return;
    auto normal = std::make_unique<Expr>();
    normal->kind = ExprKind::Variable;
    normal->place = e.args[1]->place;
    normal->text = "N";
    e.args.insert(e.args.begin() + 2, std::move(normal));
}

/// The candidates for one call, and why those that do not fit do not.
struct Checker::Candidates {
    Checker& c;
    Expr& call;
    Info& info;
    const bool broken; ///< an argument is wrong, which has been reported
    bool known = false;
    bool outputsOnly = false; ///< one would fit if it were not for its output parameters
    std::vector<std::string> texts{}, notes{};
    std::vector<const Function*> functions{};

    void offer(Choice, const std::vector<ParameterView>&, bool repeats, bool pairs, const std::string& text);
    void offer(Function&, const Unit* unit);
    void offer(const Shadeop*);
    void offerFunctions();
    void offerShadeops();
};

void Checker::Candidates::offer(Choice choice, const std::vector<ParameterView>& parameters, bool repeats, bool pairs,
                                const std::string& text) {
    known = true;
    texts.push_back(text);
    if (c.match(parameters, repeats, pairs, call, choice, false)) return info.choices.push_back(choice);
    outputsOnly |= c.match(parameters, repeats, pairs, call, choice, true);
    if (!broken && notes.size() < size_t(limits::kCandidateNotes))
        notes.push_back("candidate " + text + ": " + c.whyNot(parameters, repeats, pairs, call));
}

/// `unit`: where the function is defined; null for a nested one.
void Checker::Candidates::offer(Function& f, const Unit* unit) {
    Choice choice;
    choice.function = &f;
    choice.nested = !unit;
    choice.unit = unit;
    choice.result = f.result;
    functions.push_back(&f);
    offer(choice, views(f), false, false, c.signatureText(f));
}

void Checker::Candidates::offer(const Shadeop* op) {
    if (!op) return;
    for (const Signature& s : op->signatures) {
        Choice choice;
        choice.shadeop = op;
        choice.signature = &s;
        choice.result = s.result;
        offer(choice, views(s, *op), s.repeats, s.pairs, s.text);
    }
}

/// Functions of the shader: the innermost scope that has one that fits, then those of the file.
void Checker::Candidates::offerFunctions() {
    for (size_t i = c.scopes_.size(); i-- > 0 && info.choices.empty();) {
        const auto [from, to] = c.scopes_[i].functions.equal_range(call.text);
        for (auto f = from; f != to; ++f) offer(*f->second, nullptr);
    }
    if (!info.choices.empty()) return;
    for (const auto& f : c.unit_->functions) {
        // A shadeop written in RSL may call the shadeop of its own name with other arguments, not itself.
        const bool itself = c.unit_ != &c.main_ && c.checking_.count(f.get());
        if (f->name == call.text && !itself) offer(*f, c.unit_);
    }
}

/// A function of the shader's own joins those of its name, and the one that fits best is called; among functions that fit equally
/// well the first counts: the shader's, then those of plug-ins.
void Checker::Candidates::offerShadeops() {
    if (c.unit_ == &c.main_)
        for (const auto& p : c.program_.plugins) offer(p->find(call.text));
    if (c.unit_ == &c.main_ || info.choices.empty()) offer(findShadeop(call.text));
}

void Checker::unknownFunction(const Expr& e) {
    if (unit_->hides(e.text)) return;
    std::vector<std::string> names;
    for (const auto& f : unit_->functions) names.push_back(f->name);
    for (const auto& s : scopes_)
        for (const auto& [name, f] : s.functions) names.push_back(name);
    std::sort(names.begin(), names.end());
    for (const Shadeop& s : allShadeops())
        if (s.name.rfind("__", 0) != 0) names.push_back(s.name);
    sources_.report(e.place, msg::kNoSuchFunction(e.text), unknownFunctionHint(e.text, names));
}

/// The types that the call can have by its choices, and what each costs.
void Checker::inferResults(const Expr& e, Info& info) {
    for (Choice& c : info.choices)
        if (c.shadeop && c.result.array == 0 && std::ranges::count(c.shadeop->lastResort, c.result.base)) c.cost += kLastResort;
    for (Choice& c : info.choices) // pop() of an array of handles
        if (c.result.base == Base::String && c.shadeop && c.shadeop->section == "Arrays" && !e.args.empty() &&
            infos_.at(e.args[0].get()).array.base == Base::Shader)
            c.result.base = Base::Shader;
    for (const Choice& c : info.choices) {
        if (isStruct(c.result)) {
            if (c.result.array && !info.array.array) info.array = c.result;
            else if (!c.result.array && info.structure < 0) info.structure = c.result.structure;
            continue;
        }
        if (c.result.array != 0) {
            info.array = c.result;
            continue;
        }
        int& cost = info.cost[int(c.result.base)];
        cost = std::min(cost, c.cost);
    }
    // A call with forms that return one value and forms that return an array returns one value unless an array is expected.
    if (info.array.array && std::ranges::any_of(info.cost, [](int c) { return c < kNever; })) info.array = {};
    if (!info.array.array) info.either = eitherOf(e, info, infos_);
}

void Checker::inferCall(Expr& e, Info& info, size_t inferred) {
    nameSources(e), addNormal(e, *unit_);
    for (size_t i = inferred; i < e.args.size(); ++i) infer(*e.args[i]);
    if (inferStructureCall(e, info)) return;
    const bool broken = std::ranges::any_of(e.args, [&](const ExprPtr& a) { return infos_.at(a.get()).any; });
    if (e.text.empty()) {
        info.any = true;
        return; // what is called was reported
    }
    Candidates candidates{*this, e, info, broken};
    candidates.offerFunctions();
    candidates.offerShadeops();
    if (!info.choices.empty()) {
        bestByArguments(info.choices);
        return inferResults(e, info);
    }
    info.any = true;
    if (!candidates.functions.empty() && wrongStructure(e, candidates.functions)) return;
    if (candidates.known && broken) return; // what went wrong inside was reported
    if (candidates.known) return noMatch(e, candidates.texts, std::move(candidates.notes), candidates.outputsOnly);
    unknownFunction(e);
}

/// Info::either of a call: it has the same parameters for a float and a tuple; or its arguments make it either, as in
/// max(noise(P), noise(Q)).
const Expr* Checker::eitherOf(const Expr& call, const Info& info, const std::unordered_map<const Expr*, Info>& infos) {
    const auto mayBeBoth = [](const Info& i) {
        return i.cost[int(Base::Float)] < kNever &&
               (i.cost[int(Base::Color)] < kNever || i.cost[int(Base::Point)] < kNever || i.cost[int(Base::Vector)] < kNever);
    };
    if (!mayBeBoth(info)) return nullptr;
    for (const Choice& a : info.choices) {
        if (a.shadeop && (a.shadeop->section == "Texture" || a.shadeop->section == "Ray tracing")) return nullptr;
        if (a.result != Type{Base::Float, 0}) continue;
        const auto parameters = a.signature ? views(*a.signature, *a.shadeop) : views(*a.function);
        for (const Choice& b : info.choices) {
            if (!b.result.isTuple() || b.positional != a.positional) continue;
            const auto others = b.signature ? views(*b.signature, *b.shadeop) : views(*b.function);
            if (std::equal(parameters.begin(), parameters.end(), others.begin(), others.end(),
                           [](const auto& x, const auto& y) { return x.type == y.type; }))
                return &call;
        }
    }
    const Expr* found = nullptr;
    for (const auto& a : call.args) {
        const Info& i = infos.at(a.get());
        if (i.either) found = found ? found : i.either;
        else if (mayBeBoth(i)) return nullptr;
    }
    return found;
}

/// The types of the arguments decide first: what is wanted chooses only among functions that take them equally well. A function
/// that fits worse stays where no better one gives anything that becomes what it gives.
void Checker::bestByArguments(std::vector<Choice>& choices) {
    const std::vector<Choice> all = choices;
    std::erase_if(choices, [&](const Choice& c) {
        return std::any_of(all.begin(), all.end(), [&](const Choice& better) {
            if (better.cost / kConversion >= c.cost / kConversion || (better.result.array != 0) != (c.result.array != 0))
                return false;
            if (isStruct(better.result) || isStruct(c.result)) return better.result == c.result;
            return better.result == c.result || (c.result.array == 0 && implicitCost(better.result.base, c.result.base) < kNever);
        });
    });
}

/// An array is expected: among the forms of the call those that return one are taken.
void Checker::preferArray(const Expr& e, Type wanted) {
    Info& info = infos_.at(&e);
    if (info.array.array || info.any) return;
    if (e.kind == ExprKind::Member) { // of another shader: how long it is is known when that is bound
        info.array = {wanted.base, -1};
        info.cost.fill(kNever);
    }
    for (const Choice& c : info.choices)
        if (c.result.array) {
            info.array = c.result;
            info.cost.fill(kNever);
        }
}

void Checker::resolveCall(ExprPtr& pointer, Type result) {
    Expr& e = *pointer;
    if (isArrayCall(e)) return resolveArrayCall(e);
    const Info& info = infos_.at(&e);
    const Choice* best = nullptr;
    int least = kNever;
    for (const Choice& c : info.choices) {
        const int steps = isStruct(result) ? structures_.extensions(c.result, result) : 0;
        const bool fits = isStruct(result)    ? steps >= 0
                          : result.array != 0 ? c.result.base == result.base && c.result.array != 0
                                              : c.result == result;
        const int cost = std::min(c.cost + steps * kConversion, kNever - 1);
        if (!fits || cost >= least) continue;
        best = &c;
        least = cost;
    }
    if (!best) return; // an array where only single values are; reported by the caller's conversion
    const Choice choice = *best;
    std::vector<ParameterView> parameters =
        choice.signature ? views(*choice.signature, *choice.shadeop) : views(*choice.function);
    for (size_t i = 0; i < choice.positional; ++i) {
        const ParameterView p = parameters[std::min(i, parameters.size() - 1)];
        ExprPtr& a = e.args[i];
        if (infos_.at(a.get()).any) {
            resolveCheapest(a);
            continue;
        }
        if (p.output) {
            resolveVariable(a);
            if (isStruct(p.type) && isStruct(a->type) && a->type.structure != p.type.structure)
                convert(a, {Base::Struct, a->type.array, p.type.structure});
            written(*a);
        } else if (infos_.at(a.get()).channel && choice.shadeop && i == 0) {
            // texture(name[channel]); (name)[channel] too.
            e.channel = std::move(a->args[1]);
            ExprPtr name = std::move(a->args[0]);
            resolveTypes(e.channel, {Base::Float, 0});
            resolveTypes(name, {Base::String, 0});
            a = std::move(name);
        } else {
            resolveTypes(a, wantedType(p, *a));
            // printf("%s", h->name): the type of another shader's member is known when the kernel is built.
            const bool element = a->kind == ExprKind::Index && a->args[0]->kind == ExprKind::Member;
            const bool member = a->kind == ExprKind::Member || a->kind == ExprKind::Method || element;
            if (member && p.type.base == Base::Void && choice.shadeop && choice.shadeop->section == "Strings")
                a->type = {Base::Void, 0};
        }
    }
    resolvePairs(e, choice.positional, choice.shadeop);
    // A result of open length takes the expected length.
    e.type = choice.result.array < 0 && result.array > 0 ? result : choice.result;
    finish(e);
    for (const auto& p : e.pairs) e.varying |= p.value->varying;
    if (choice.shadeop) return bindShadeop(e, choice);
    e.kind = ExprKind::FunctionCall;
    if (choice.nested) {
        e.function = choice.function;
        if (checking_.count(choice.function)) sources_.report(e.place, msg::kRecursion(e.text));
    } else {
        e.function = instance(*choice.function, *choice.unit, {}, e.place);
    }
    if (e.function && callHeight_[e.function] >= limits::kCallDepth) { // methods and functions inside of functions, too
        sources_.report(e.place, msg::kCallsTooDeep(limits::kCallDepth));
        e.function = nullptr;
    }
    if (e.function && function_) callHeight_[function_] = std::max(callHeight_[function_], callHeight_[e.function] + 1);
    if (e.function && varyingFunctions_.count(e.function)) {
        e.varying = true;
        readsPoint(e, "what '" + e.text + "' gives");
    }
}

} // namespace alpenglow::rsl::front
