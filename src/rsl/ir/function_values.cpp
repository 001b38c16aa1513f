// Instructions, variables, places.
#include "base/limits.h"
#include "rsl/ir/function_builder.h"
#include "rsl/passes/fold.h"
#include <algorithm>
#include <cctype>

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
    case Base::Shader:
        return Kind::String;
    default:
        return Kind::Triple;
    }
}

SourcePlace sourcePlace(const std::vector<std::string>& files, const Place& p) {
    const bool known = p.file >= 0 && static_cast<size_t>(p.file) < files.size();
    return {known ? files[static_cast<size_t>(p.file)] : std::string(), p.line, p.column};
}

void FunctionBuilder::report(const Place& p, const Raised& message, std::string hint) {
    const SourcePlace at = sourcePlace(*files_, shownPlace(p));
    if (message.message->severity == Severity::Error) {
        failed_ = true;
        return diagnostics_.report(diagnostic(message, Rie::Syntax, at, std::move(hint)));
    }
    Diagnostic d = diagnostic(message, Rie::Unimplement, at, std::move(hint));
    diagnostics_.reportOnce(at.file + std::to_string(at.line) + ":" + std::to_string(at.column) + d.message, std::move(d));
}

Inst* FunctionBuilder::emit(Op op, Kind kind, std::vector<Inst*> args, int index) {
    if (k_.pool.size() > limits::kInlinedInstructions && !failed_) {
        failed_ = true;
        diagnostics_.report(
            diagnostic(msg::kShaderTooLarge(limits::kInlinedInstructions), Rie::Limit, sourcePlace(*files_, shownPlace(place_))));
    }
    Inst* i = k_.make(op, kind, std::move(args));
    i->index = index;
    i->place = keptPlace(place_);
    if (Inst* simple = passes::simplify(k_, leaves_, i)) return simple;
    region_->body.push_back(i);
    return i;
}

Inst* FunctionBuilder::zero(Kind k) { return k == Kind::String ? leaves_.string("") : leaves_.constant(k, 0.0f); }

Inst* FunctionBuilder::input(const std::string& name, Type type, bool uniform) {
    Inst*& i = inputs_[name];
    if (!i) {
        Input in;
        in.name = name;
        in.type = storedType(type);
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

std::vector<Inst*> FunctionBuilder::runtime(const std::string& symbol, std::vector<Inst*> args, std::vector<Kind> results) {
    Inst* i = k_.make(Op::Runtime, Kind::None, std::move(args));
    i->text = symbol;
    i->results = results;
    i->place = keptPlace(place_);
    if (results.size() == 1)
        if (Inst* simple = passes::simplify(k_, leaves_, i)) return {simple};
    region_->body.push_back(i);
    std::vector<Inst*> out;
    for (size_t r = 0; r < results.size(); ++r) out.push_back(emit(Op::Result, results[r], {i}, static_cast<int>(r)));
    return out;
}

std::vector<Inst*> FunctionBuilder::call(Op op, Site site, std::vector<Inst*> args) {
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

Inst* FunctionBuilder::coerce(Inst* v, Kind k) {
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

Inst* FunctionBuilder::coerce(Inst* v, Type t) { return coerce(v, kindOf(t)); }

Inst* FunctionBuilder::isNot0(Inst* v) { return emit(Op::NotEqual, Kind::Bool, {v, constant(0)}); }

Inst* FunctionBuilder::negative(Inst* v) {
    if (v->kind == Kind::Matrix) {
        std::vector<Inst*> m;
        for (int n = 0; n < 16; ++n) m.push_back(emit(Op::Neg, Kind::Float, {emit(Op::Extract, Kind::Float, {v}, n)}));
        return emit(Op::MatrixOf, Kind::Matrix, m);
    }
    if (v->kind == Kind::Bool) v = coerce(v, Kind::Float);
    return emit(Op::Neg, v->kind, {v});
}

Inst* FunctionBuilder::component(Inst* v, Inst* at) {
    const auto c = [&](int n) { return emit(Op::Extract, Kind::Float, {v}, n); };
    if (isConst(at)) return c(at->numbers[0] >= 2 ? 2 : at->numbers[0] >= 1 ? 1 : 0);
    Inst* low = emit(Op::Select, Kind::Float, {emit(Op::LessEqual, Kind::Bool, {constant(1), at}), c(1), c(0)});
    return emit(Op::Select, Kind::Float, {emit(Op::LessEqual, Kind::Bool, {constant(2), at}), c(2), low});
}

Inst* FunctionBuilder::withComponent(Inst* old, Inst* at, Inst* value) {
    std::vector<Inst*> c;
    for (int n = 0; n < 3; ++n) {
        Inst* is =
            n == 0   ? emit(Op::Not, Kind::Bool, {emit(Op::LessEqual, Kind::Bool, {constant(1), at})})
            : n == 2 ? emit(Op::LessEqual, Kind::Bool, {constant(2), at})
                     : emit(Op::And, Kind::Bool,
                            {emit(Op::LessEqual, Kind::Bool, {constant(1), at}), emit(Op::Less, Kind::Bool, {at, constant(2)})});
        c.push_back(emit(Op::Select, Kind::Float, {is, value, emit(Op::Extract, Kind::Float, {old}, n)}));
    }
    return emit(Op::Triple, Kind::Triple, c);
}

int FunctionBuilder::newSlot(Inst* value) {
    env_.push_back(value);
    symbols_.push_back(nullptr);
    return static_cast<int>(env_.size()) - 1;
}

int FunctionBuilder::slot(const Symbol* s) {
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

Inst* FunctionBuilder::get(int n) {
    Inst*& v = value(n);
    if (v) return v;
    const Symbol* s = symbol(n);
    if (!s) return constant(0);
    if (s->origin == Symbol::Origin::Global)
        return v = initialGlobal(s->name, s->type); // a leaf: known everywhere, so not an assignment
    if (s->type.array) return newArray(s->type.base, std::max(s->type.array, 1));
    return zero(kindOf(s->type));
}

void FunctionBuilder::set(int n, Inst* v) {
    if (isGlobal(n)) {
        get(n);
        writes_.insert(symbol(n)->name);
    }
    log_.emplace_back(n, value(n));
    value(n) = v;
}

Inst* FunctionBuilder::newArray(Base base, int length) {
    Inst* a = k_.make(Op::ArrayNew, Kind::Array);
    a->element = kindOf({base, 0});
    a->index = length;
    a->place = keptPlace(place_);
    region_->body.push_back(a);
    return a;
}

void FunctionBuilder::addArgument(Site& s, std::vector<Inst*>& args, Inst* v, Type t) {
    args.push_back(v);
    s.argKinds.push_back(v->kind);
    s.argTypes.push_back(storedType(t));
}

void FunctionBuilder::addPair(Site& s, const std::string& name, const std::string& text) {
    s.names.push_back(name);
    s.pairStrings.push_back(text);
}

void FunctionBuilder::addPair(Site& s, std::vector<Inst*>& args, const std::string& name, Inst* v, Type t) {
    addPair(s, name, v->op == Op::ConstString ? v->text : "");
    if (v->op != Op::ConstString) addArgument(s, args, v, t);
}

Inst* FunctionBuilder::parameter(Region& r, Kind k) {
    Inst* p = k_.make(Op::RegionParam, k);
    p->index = static_cast<int>(r.params.size());
    r.params.push_back(p);
    return p;
}

Inst* FunctionBuilder::load(Inst* array, int index) { return emit(Op::ArrayLoad, array->element, {array, constant(index)}); }

void FunctionBuilder::store(Inst* array, int index, Inst* v) { emit(Op::ArrayStore, Kind::None, {array, constant(index), v}); }

Inst* FunctionBuilder::dot(Inst* a, Inst* b) {
    Inst* p = emit(Op::Mul, Kind::Triple, {a, b});
    Inst* xy = emit(Op::Add, Kind::Float, {emit(Op::Extract, Kind::Float, {p}, 0), emit(Op::Extract, Kind::Float, {p}, 1)});
    return emit(Op::Add, Kind::Float, {xy, emit(Op::Extract, Kind::Float, {p}, 2)});
}

Inst* FunctionBuilder::cross(Inst* a, Inst* b) {
    std::vector<Inst*> c;
    for (int n = 0; n < 3; ++n) {
        const int i = (n + 1) % 3, j = (n + 2) % 3;
        const auto product = [&](int p, int q) {
            return emit(Op::Mul, Kind::Float, {emit(Op::Extract, Kind::Float, {a}, p), emit(Op::Extract, Kind::Float, {b}, q)});
        };
        c.push_back(emit(Op::Sub, Kind::Float, {product(i, j), product(j, i)}));
    }
    return emit(Op::Triple, Kind::Triple, c);
}

Inst* FunctionBuilder::multiply(Inst* a, Inst* b) {
    std::vector<Inst*> m;
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) {
            Inst* sum = nullptr;
            for (int n = 0; n < 4; ++n) {
                Inst* p = emit(Op::Mul, Kind::Float,
                               {emit(Op::Extract, Kind::Float, {a}, r * 4 + n), emit(Op::Extract, Kind::Float, {b}, n * 4 + c)});
                sum = sum ? emit(Op::Add, Kind::Float, {sum, p}) : p;
            }
            m.push_back(sum);
        }
    return emit(Op::MatrixOf, Kind::Matrix, m);
}

Inst* FunctionBuilder::transformBy(Inst* m, Inst* v, Base base) {
    switch (base) {
    case Base::Vector:
        return runtime1("al_transformvector", {m, v}, Kind::Triple);
    case Base::Normal:
        return runtime1("al_transformnormal", {m, v}, Kind::Triple);
    case Base::Matrix:
        return multiply(v, m);
    default:
        return runtime1("al_transformpoint", {m, v}, Kind::Triple);
    }
}

static std::string lower(std::string s) {
    for (char& c : s) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return s;
}

Inst* FunctionBuilder::colourSpace(const std::string& from, const std::string& to, Inst* v) {
    const std::string f = lower(from), t = lower(to);
    const auto known = [](const std::string& s) { return s == "hsv" || s == "hsl" || s == "yiq" || s == "xyz"; };
    if (f == t || (!known(f) && f != "rgb") || (!known(t) && t != "rgb")) return v; // an unknown space leaves the colour as it is
    if (f != "rgb") v = runtime1("al_" + f + "_to_rgb", {v}, Kind::Triple);
    return t == "rgb" ? v : runtime1("al_rgb_to_" + t, {v}, Kind::Triple);
}

void FunctionBuilder::goBackTo(const Environment& e) {
    region_ = e.region;
    log_.resize(e.log);
    std::fill(env_.begin(), env_.end(), nullptr);
    std::copy(e.values.begin(), e.values.end(), env_.begin());
}

} // namespace alpenglow::rsl::ir
