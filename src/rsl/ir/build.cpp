// Instructions, variables, and the rounds in which a kernel is built.
#include "rsl/ir/build.h"
#include "base/limits.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include "rsl/passes/affine.h"
#include "rsl/passes/fold.h"
#include "rsl/passes/optimize.h"
#include <algorithm>
#include <string_view>

namespace alpenglow::rsl::ir {

Kind kindOf(Type t) {
    if (t.array != 0) return Kind::Array;
    switch (t.base) {
    case Base::Void:
        return Kind::None;
    case Base::Bool:
        return Kind::Bool;
    case Base::Float:
        return Kind::Float;
    case Base::Matrix:
        return Kind::Matrix;
    case Base::String:
        return Kind::String;
    default:
        return Kind::Triple;
    }
}

SourcePlace sourcePlace(const std::vector<std::string>& files, const Place& p) {
    const bool known = p.file >= 0 && static_cast<size_t>(p.file) < files.size();
    return {known ? files[static_cast<size_t>(p.file)] : std::string(), p.line, p.column};
}

void Builder::report(const Place& p, const Raised& message, std::string hint) {
    const SourcePlace at = sourcePlace(*files_, shownPlace(p));
    if (message.message->severity == Severity::Error) {
        failed_ = true;
        return diagnostics_.report(diagnostic(message, Rie::Syntax, at, std::move(hint)));
    }
    Diagnostic d = diagnostic(message, Rie::Unimplement, at, std::move(hint));
    diagnostics_.reportOnce(at.file + std::to_string(at.line) + ":" + std::to_string(at.column) + d.message, std::move(d));
}

Inst* Builder::emit(Op op, Kind kind, std::vector<Inst*> args, int index) {
    if (k_.pool.size() > limits::kInlinedInstructions && !failed_) {
        failed_ = true;
        diagnostics_.report(diagnostic(msg::kShaderTooLarge(limits::kInlinedInstructions), Rie::Limit,
                                       sourcePlace(program_.files, shownPlace(place_))));
    }
    Inst* i = k_.make(op, kind, std::move(args));
    i->index = index;
    i->place = keptPlace(place_);
    if (Inst* simple = simplify(k_, leaves_, i)) return simple;
    region_->body.push_back(i);
    return i;
}

Inst* Builder::zero(Kind k) { return k == Kind::String ? leaves_.string("") : leaves_.constant(k, 0.0f); }

Inst* Builder::input(const std::string& name, Type type, bool uniform) {
    Inst*& i = inputs_[name];
    if (!i) {
        Input in;
        in.name = name;
        in.type = type;
        in.kind = kindOf(type.element());
        in.array = type.array;
        in.constant = uniform;
        in.uniform = uniform && !options_.mixed;
        i = k_.make(type.array ? Op::ArrayInput : Op::Input, kindOf(type));
        i->element = type.array ? in.kind : Kind::None;
        i->index = static_cast<int>(k_.inputs.size());
        k_.inputs.push_back(std::move(in));
        leaves_.add(i);
    }
    return i;
}

Inst* Builder::space(const std::string& from, const std::string& to) {
    return input(InputName::space(ownSpace(leaves_.string(from))->text, ownSpace(leaves_.string(to))->text).text(),
                 {Base::Matrix, 0}, true);
}

std::vector<Inst*> Builder::runtime(const std::string& symbol, std::vector<Inst*> args, std::vector<Kind> results) {
    Inst* i = k_.make(Op::Runtime, Kind::None, std::move(args));
    i->text = symbol;
    i->results = results;
    i->place = keptPlace(place_);
    if (results.size() == 1)
        if (Inst* simple = simplify(k_, leaves_, i)) return {simple};
    region_->body.push_back(i);
    std::vector<Inst*> out;
    for (size_t r = 0; r < results.size(); ++r) out.push_back(emit(Op::Result, results[r], {i}, static_cast<int>(r)));
    return out;
}

std::vector<Inst*> Builder::call(Op op, Site site, std::vector<Inst*> args) {
    site.place = keptPlace(place_);
    Inst* i = k_.make(op, Kind::None, std::move(args));
    i->results = site.resultKinds;
    i->place = keptPlace(place_);
    i->site = static_cast<int>(k_.sites.size());
    k_.sites.push_back(std::move(site));
    region_->body.push_back(i);
    std::vector<Inst*> out;
    for (size_t r = 0; r < i->results.size(); ++r) out.push_back(emit(Op::Result, i->results[r], {i}, static_cast<int>(r)));
    return out;
}

Inst* Builder::coerce(Inst* v, Kind k) {
    if (v->kind == k) return v;
    if (v->kind == Kind::Bool) return coerce(emit(Op::ToFloat, Kind::Float, {v}), k);
    if (v->kind == Kind::Float && k == Kind::Triple) return emit(Op::Splat, Kind::Triple, {v});
    if (v->kind == Kind::Float && k == Kind::Matrix) {
        std::vector<Inst*> m;
        for (int n = 0; n < 16; ++n) m.push_back(n % 5 == 0 ? v : constant(0));
        return emit(Op::MatrixOf, Kind::Matrix, m);
    }
    if (v->kind == Kind::Float && k == Kind::Bool) return emit(Op::NotEqual, Kind::Bool, {v, constant(0)});
    if (v->kind == Kind::Triple && k == Kind::Bool) {
        Inst* any = boolean(false);
        for (int c = 0; c < 3; ++c)
            any = emit(Op::Or, Kind::Bool,
                       {any, emit(Op::NotEqual, Kind::Bool, {emit(Op::Extract, Kind::Float, {v}, c), constant(0)})});
        return any;
    }
    return zero(k); // after a reported error, or a void value
}

Inst* Builder::coerce(Inst* v, Type t) { return coerce(v, kindOf(t)); }

int Builder::newSlot(Inst* value) {
    env_.push_back(value);
    symbols_.push_back(nullptr);
    return static_cast<int>(env_.size()) - 1;
}

int Builder::slot(const Symbol* s) {
    const auto it = slots_.find(s);
    if (it != slots_.end()) return it->second;
    if (s->origin == Symbol::Origin::Global) {
        const auto g = globals_.find(s->name);
        if (g != globals_.end()) return slots_[s] = g->second;
    }
    const int n = newSlot(nullptr);
    symbols_.back() = s;
    slots_[s] = n;
    if (s->origin == Symbol::Origin::Global) globals_[s->name] = n;
    return n;
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

Inst* Builder::get(int n) {
    Inst*& v = env_[static_cast<size_t>(n)];
    if (v) return v;
    const Symbol* s = symbols_[static_cast<size_t>(n)];
    if (!s) return constant(0);
    if (s->origin == Symbol::Origin::Global)
        return v = initialGlobal(s->name, s->type); // a leaf: known everywhere, so not an assignment
    if (s->type.array) return newArray(s->type.base, std::max(s->type.array, 1));
    return zero(kindOf(s->type));
}

void Builder::set(int n, Inst* value) {
    const Symbol* s = symbols_[static_cast<size_t>(n)];
    if (s && s->origin == Symbol::Origin::Global) {
        get(n);
        writes_.insert(s->name);
    }
    log_.emplace_back(n, env_[static_cast<size_t>(n)]);
    env_[static_cast<size_t>(n)] = value;
}

Inst* Builder::newArray(Base base, int length) {
    Inst* a = k_.make(Op::ArrayNew, Kind::Array);
    a->element = kindOf({base, 0});
    a->index = length;
    a->place = keptPlace(place_);
    region_->body.push_back(a);
    return a;
}

/// The length where it is known; of an array that changes its length, where it is not, that of its storage.
int Builder::arrayLength(const Inst* a) const {
    if (const Lengths* l = lengths(a))
        if (const Inst* n = env_[static_cast<size_t>(l->length)]; n && isConst(n)) return static_cast<int>(n->numbers[0]);
    return a->op == Op::ArrayInput ? k_.inputs[static_cast<size_t>(a->index)].array : a->index;
}

} // namespace alpenglow::rsl::ir

namespace alpenglow::rsl {

using namespace ir;

static std::unique_ptr<Kernel> newKernel(const Program& p, const Shader& s) {
    auto k = std::make_unique<Kernel>();
    k->name = s.name;
    k->kind = s.kind;
    k->files = p.files;
    return k;
}

static std::unique_ptr<Kernel> buildOnce(const Program& p, const Shader& s, const KernelOptions& o, Diagnostics& d,
                                         const DirectSet& direct) {
    auto k = newKernel(p, s);
    k->light = o.light;
    bool good = false;
    {
        Builder b(*k, p, s, o, d, direct);
        good = b.buildShader();
    }
    if (!good) return nullptr;
    toShortForm(*k);
    return k;
}

/// Requests that there is no other form of.
static const std::set<std::string_view> kNoLobes = {"trace",  "transmission",    "occlusion", "subsurface",
                                                    "gather", "lightvisibility", "ambient"};

std::unique_ptr<Kernel> buildKernel(const Program& p, const Shader& s, const KernelOptions& o, Diagnostics& d) {
    DirectSet direct;
    auto k = buildOnce(p, s, o, d, direct);
    if (!k || !o.path) return k;
    // Lobe calls whose result is not used affinely are inlined instead; one of them may have hidden another, so again until none
    // is left.
    std::vector<KernelFacts::NonLinear> nonLinear;
    for (int round = 0; round < 16; ++round) {
        const auto lobe = [](const Inst* i, const Kernel& kernel) {
            const std::string& op = kernel.sites[static_cast<size_t>(i->site)].op;
            return i->op == Op::Request && !kNoLobes.count(op);
        };
        bool any = false;
        forEach(k->body, [&](Inst* i) { any = any || (i->site >= 0 && lobe(i, *k)); });
        if (!any) break;
        Diagnostics silent;
        auto trial = buildOnce(p, s, o, silent, direct);
        KernelOptions probe = o;
        probe.suspend = false;
        optimize(*trial, probe, silent);
        const size_t before = direct.size();
        for (const auto& [site, why] : nonAffineSites(*trial)) {
            const Site& at = trial->sites[static_cast<size_t>(site)];
            if (kNoLobes.count(at.op)) continue;
            if (direct.emplace(at.place.file, at.place.line, at.place.column).second) {
                nonLinear.push_back({at.op, why, at.place});
            }
        }
        if (direct.size() == before) break;
        Diagnostics quiet;
        k = buildOnce(p, s, o, quiet, direct);
    }
    k->facts.direct = nonLinear;
    k->facts.nonLinear = std::move(nonLinear);
    return k;
}

std::vector<OutputLight> lightOfOutputs(const Program& p, const Shader& s, const KernelOptions& o) {
    Diagnostics quiet; // the messages come when the kernel is made
    const auto k = buildOnce(p, s, o, quiet, {});
    return k ? lightOfOutputs(*k, o) : std::vector<OutputLight>();
}

std::unique_ptr<Kernel> buildDefaults(const Program& p, const Shader& s, Diagnostics& d,
                                      const std::vector<ParameterValue>& given) {
    auto k = newKernel(p, s);
    k->name += ":defaults";
    bool good = false;
    {
        const KernelOptions o;
        const DirectSet none;
        Builder b(*k, p, s, o, d, none);
        good = b.buildDefaults(given);
    }
    if (!good) return nullptr;
    toShortForm(*k);
    return k;
}

} // namespace alpenglow::rsl
