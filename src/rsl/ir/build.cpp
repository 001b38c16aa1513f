// Instructions, variables, and the frame of a kernel: parameters in, outputs out.
#include "rsl/ir/build.h"
#include "base/limits.h"
#include "rsl/ir/builder.h"
#include "rsl/passes/affine.h"
#include "rsl/passes/fold.h"
#include "rsl/passes/optimize.h"
#include <algorithm>
#include <cstdlib>
#include <functional>

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

void Builder::error(const Place& p, const std::string& text) {
    failed_ = true;
    diagnostics_.report(Severity::Error, Rie::Syntax, sourcePlace(*files_, p), text);
}

void Builder::warn(const Place& p, const std::string& text) {
    const SourcePlace at = sourcePlace(*files_, p);
    diagnostics_.reportOnce(at.file + std::to_string(at.line) + ":" + std::to_string(at.column) + text,
                            {Severity::Warning, Rie::Unimplement, at, text, {}, {}});
}

Inst* Builder::emit(Op op, Kind kind, std::vector<Inst*> args, int index) {
    if (k_.pool.size() > limits::kInlinedInstructions && !failed_) {
        failed_ = true;
        diagnostics_.report(Severity::Error, Rie::Limit, sourcePlace(program_.files, place_),
                            "the shader is too large once its functions are inlined: more than " +
                                std::to_string(limits::kInlinedInstructions) + " operations");
    }
    Inst* i = k_.make(op, kind, std::move(args));
    i->index = index;
    i->place = place_;
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
    return input("space:" + from + ">" + to, {Base::Matrix, 0}, true);
}

std::vector<Inst*> Builder::runtime(const std::string& symbol, std::vector<Inst*> args, std::vector<Kind> results) {
    Inst* i = k_.make(Op::Runtime, Kind::None, std::move(args));
    i->text = symbol;
    i->results = results;
    i->place = place_;
    if (results.size() == 1)
        if (Inst* simple = simplify(k_, leaves_, i)) return {simple};
    region_->body.push_back(i);
    std::vector<Inst*> out;
    for (size_t r = 0; r < results.size(); ++r) out.push_back(emit(Op::Result, results[r], {i}, static_cast<int>(r)));
    return out;
}

std::vector<Inst*> Builder::call(Op op, Site site, std::vector<Inst*> args) {
    site.place = place_;
    Inst* i = k_.make(op, Kind::None, std::move(args));
    i->results = site.resultKinds;
    i->place = place_;
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
    return input(name, type, uniform);
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
    a->place = place_;
    region_->body.push_back(a);
    return a;
}

/// The length where it is known; of an array that changes its length, where it is not, that of its storage.
int Builder::arrayLength(const Inst* a) const {
    if (const Lengths* l = lengths(a))
        if (const Inst* n = env_[static_cast<size_t>(l->length)]; n && isConst(n)) return static_cast<int>(n->numbers[0]);
    return a->op == Op::ArrayInput ? k_.inputs[static_cast<size_t>(a->index)].array : a->index;
}

/// Value text of KernelOptions::stringParameters for a numeric parameter: one number, or three.
Inst* Builder::constantParameter(const Symbol& s, const std::string& text) {
    if (s.type.base == Base::String) return leaves_.string(text);
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

Inst* Builder::parameterValue(const ShaderParameter& p) {
    const Symbol& s = *p.symbol;
    Type type = s.type;
    if (type.array < 0)
        type.array = p.defaultValue && p.defaultValue->type.array > 0 ? p.defaultValue->type.array
                     : p.defaultValue && p.defaultValue->kind == ExprKind::ArrayList
                         ? std::max<int>(1, static_cast<int>(p.defaultValue->args.size()))
                         : 1;
    if (type.array > 0 && type.base == Base::String) {
        if (Inst* a = constantTexts(s.name, type.array, options_.stringParameters)) return a;
    } else {
        for (const auto& [name, value] : options_.stringParameters)
            if (name == s.name)
                if (Inst* c = constantParameter(s, value)) return c;
    }
    if (type == Type{Base::String, 0} && (!p.defaultValue || p.defaultValue->kind == ExprKind::String))
        return leaves_.string(p.defaultValue ? p.defaultValue->text : "");
    const auto& v = options_.varyingParameters;
    const bool varying = s.storage == Storage::Varying || std::find(v.begin(), v.end(), s.name) != v.end();
    return input("param:" + s.name, type, !varying);
}

bool Builder::buildDefaults() {
    region_ = &k_.body;
    std::vector<std::pair<const Symbol*, Inst*>> values;
    frames_.push_back({});
    for (const ShaderParameter& p : shader_.parameters) {
        place_ = p.symbol->place;
        if (p.symbol->type.array) {
            int n = p.symbol->type.array;
            if (n < 0)
                n = p.defaultValue && p.defaultValue->kind == ExprKind::ArrayList
                        ? std::max<int>(1, static_cast<int>(p.defaultValue->args.size()))
                        : 1;
            Inst* a = newArray(p.symbol->type.base, n);
            if (p.defaultValue) copyArray(a, *p.defaultValue);
            set(slot(p.symbol), a);
        } else {
            set(slot(p.symbol), p.defaultValue ? expr(*p.defaultValue, kindOf(p.symbol->type)) : zero(kindOf(p.symbol->type)));
        }
        values.emplace_back(p.symbol, get(slot(p.symbol)));
    }
    for (const auto& [s, v] : values) {
        const int n = v->kind == Kind::Array ? arrayLength(v) : 1;
        for (int e = 0; e < n; ++e) {
            Inst* value = v->kind == Kind::Array ? emit(Op::ArrayLoad, v->element, {v, constant(static_cast<float>(e))}) : v;
            k_.outputs.push_back({"param:" + s->name + (v->kind == Kind::Array ? "[" + std::to_string(e) + "]" : ""), value->kind,
                                  s->type.element()});
            emit(Op::Output, Kind::None, {value}, static_cast<int>(k_.outputs.size()) - 1);
        }
    }
    k_.body.body.insert(k_.body.body.begin(), functions_.begin(), functions_.end());
    return !failed_;
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
    for (const ShaderParameter& p : shader_.parameters) {
        place_ = p.symbol->place;
        const int n = slot(p.symbol);
        Inst* v = parameterValue(p);
        if (v->op == Op::ArrayInput && assigned.count(n)) { // inputs are read-only: a copy takes the stores
            Inst* copy = newArray(p.symbol->type.base, arrayLength(v));
            for (int e = 0; e < arrayLength(v); ++e) {
                Inst* at = constant(static_cast<float>(e));
                emit(Op::ArrayStore, Kind::None, {copy, at, emit(Op::ArrayLoad, v->element, {v, at})});
            }
            v = copy;
        }
        env_[static_cast<size_t>(n)] = v;
        const Symbol& parameter = *p.symbol;
        const auto& asked = options_.messages;
        if (parameter.output && !parameter.type.array && parameter.type.base != Base::String &&
            std::find(asked.begin(), asked.end(), parameter.name) != asked.end())
            messageSlots_[parameter.name] = {n, parameter.type};
    }
    // Zero on every way through conditions (a block puts Cl back to what it was, so both sides of an if may give zero).
    const std::function<bool(const Inst*)> isZero = [&](const Inst* v) {
        if (isConst(v)) return std::all_of(v->numbers.begin(), v->numbers.end(), [](float f) { return f == 0; });
        if (v->op != Op::Result || v->args[0]->op != Op::If) return false;
        const Inst* branch = v->args[0];
        return std::all_of(branch->regions.begin(), branch->regions.end(), [&](const Region& r) { return isZero(r.yields[static_cast<size_t>(v->index)]); });
    };
    lightBlocks_.clear();
    blockRan_ = newSlot(boolean(false));
    if (shader_.kind == ShaderKind::Light && shader_.body) findBlocks(*shader_.body);
    if (shader_.body) statement(*shader_.body);
    place_ = shader_.place;

    const auto output = [&](const std::string& name, Inst* value, Type type) {
        if (value->kind == Kind::Array) return;
        k_.outputs.push_back({name, value->kind, type});
        emit(Op::Output, Kind::None, {value}, static_cast<int>(k_.outputs.size()) - 1);
    };
    const Type color{Base::Color, 0}, vector{Base::Vector, 0}, real{Base::Float, 0};
    std::vector<std::string> wanted = options_.outputs;
    const bool light = shader_.kind == ShaderKind::Light;
    if (light) {
        k_.facts.ambientLight = lightBlocks_.empty();
        for (const LightBlock& b : lightBlocks_)
            k_.facts.blocks.push_back(!b.solar ? "illuminate" : b.stmt->exprs.empty() ? "solar()" : b.cone ? "solar cone" : "solar");
        // Where no block has run, Cl is ambient light.
        const auto cl = globals_.find("Cl");
        const Inst* ran = get(blockRan_);
        const bool always = isConst(ran) && ran->numbers[0] != 0;
        if (!lightBlocks_.empty() && !always && cl != globals_.end() && !isZero(get(cl->second))) k_.facts.blocks.push_back("outside");
    }
    if (wanted.empty()) {
        switch (shader_.kind) {
        case ShaderKind::Displacement:
            wanted = {"P", "N"};
            break;
        case ShaderKind::Transformation:
            wanted = {"P"};
            break;
        case ShaderKind::Imager:
            wanted = {"Ci", "Oi", "alpha"};
            break;
        case ShaderKind::Light:
            if (lightBlocks_.empty()) wanted = {"Cl", "Ol"};
            for (size_t b = 0; b < lightBlocks_.size(); ++b)
                for (const char* n : {"L", "Cl", "Ol", "lit"})
                    wanted.push_back(n + (b ? "#" + std::to_string(b) : std::string()));
            if (!k_.facts.blocks.empty() && k_.facts.blocks.back() == "outside") wanted.push_back("Cl#" + std::to_string(lightBlocks_.size()));
            break;
        default:
            wanted = {"Ci", "Oi"};
        }
    }
    for (const std::string& name : wanted) {
        if (light && !lightBlocks_.empty()) {
            bool found = false;
            for (size_t b = 0; b < lightBlocks_.size(); ++b) {
                const std::string tail = b ? "#" + std::to_string(b) : std::string();
                const LightBlock& l = lightBlocks_[b];
                if (name == "L" + tail) output(name, get(l.L), vector), found = true;
                if (name == "Cl" + tail) output(name, get(l.only ? globals_.at("Cl") : l.Cl), color), found = true;
                if (name == "Ol" + tail) output(name, get(l.only ? globals_.at("Ol") : l.Ol), color), found = true;
                if (name == "lit" + tail) output(name, get(l.lit), real), found = true;
            }
            if (name == "Cl#" + std::to_string(lightBlocks_.size()) && k_.facts.blocks.back() == "outside") {
                output(name, emit(Op::Select, Kind::Triple, {get(blockRan_), zero(Kind::Triple), get(globals_.at("Cl"))}), color);
                continue;
            }
            if (found) continue;
        }
        bool found = false;
        for (const ShaderParameter& p : shader_.parameters)
            if (name == "param:" + p.symbol->name || (p.symbol->output && name == p.symbol->name)) {
                output(name, get(slot(p.symbol)), p.symbol->type);
                found = true;
                break;
            }
        if (found) continue;
        if (const auto c = channels_.find(name); c != channels_.end() && !hasGlobal(name.c_str())) {
            output(name, get(c->second.first), c->second.second);
            continue;
        }
        for (const GlobalVariable& g : globalVariables(shader_.kind))
            if (name == g.name) {
                const auto it = globals_.find(name);
                output(name, it == globals_.end() ? initialGlobal(name, g.type) : get(it->second), g.type);
                break;
            } else if (name == "Du:" + std::string(g.name) || name == "Dv:" + std::string(g.name)) { // d/du and d/dv of it at the end
                const auto it = globals_.find(g.name);
                Inst* value = it == globals_.end() ? initialGlobal(g.name, g.type) : get(it->second);
                output(name, emit(name[1] == 'u' ? Op::Du : Op::Dv, value->kind, {value}), g.type);
                break;
            }
    }
    k_.body.body.insert(k_.body.body.begin(), functions_.begin(), functions_.end());
    k_.facts.writes.assign(writes_.begin(), writes_.end());
    forEach(k_.body, [&](Inst* i) { k_.facts.lightLoops = k_.facts.lightLoops || i->op == Op::LightLoop; });
    return !failed_;
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
    bool good = false;
    {
        Builder b(*k, p, s, o, d, direct);
        good = b.buildShader();
    }
    if (!good) return nullptr;
    toShortForm(*k);
    return k;
}

std::unique_ptr<Kernel> buildKernel(const Program& p, const Shader& s, const KernelOptions& o, Diagnostics& d) {
    DirectSet direct;
    auto k = buildOnce(p, s, o, d, direct);
    if (!k || !o.path) return k;
    // Lobe calls whose result is not used affinely are inlined instead; one of them may have hidden another, so again until none
    // is left.
    std::vector<std::string> notes;
    Place first;
    for (int round = 0; round < 16; ++round) {
        const auto lobe = [](const Inst* i, const Kernel& kernel) {
            const std::string& op = kernel.sites[static_cast<size_t>(i->site)].op;
            return i->op == Op::Request && op != "trace" && op != "transmission" && op != "lightvisibility" && op != "ambient";
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
            if (at.op == "trace" || at.op == "transmission" || at.op == "lightvisibility" || at.op == "ambient") continue;
            if (direct.emplace(at.place.file, at.place.line, at.place.column).second) {
                if (notes.empty()) first = at.place;
                notes.push_back(at.op + ", line " + std::to_string(at.place.line) + ": " + why);
            }
        }
        if (direct.size() == before) break;
        Diagnostics quiet;
        k = buildOnce(p, s, o, quiet, direct);
    }
    k->facts.direct = notes;
    k->facts.directPlace = first;
    return k;
}

std::unique_ptr<Kernel> buildDefaults(const Program& p, const Shader& s, Diagnostics& d) {
    auto k = newKernel(p, s);
    k->name += ":defaults";
    bool good = false;
    {
        const KernelOptions o;
        const DirectSet none;
        Builder b(*k, p, s, o, d, none);
        good = b.buildDefaults();
    }
    if (!good) return nullptr;
    toShortForm(*k);
    return k;
}

} // namespace alpenglow::rsl
