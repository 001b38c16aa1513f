// Arrays that change their length. The storage has a length of its own; how much of it counts, and how much was reserved, are
// values like those of variables: each point has its own. What does not fit into the storage is kept by whoever runs the kernel
// (spilledarrays.h), and reached by services; such elements have no derivatives.
#include "base/limits.h"
#include "rsl/front/visit.h"
#include "rsl/front/writes.h"
#include "rsl/ir/builder.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

/// The length where it is known; of an array that changes its length, where it is not, that of its storage.
int Builder::arrayLength(const Inst* a) const {
    if (const Lengths* l = lengths(a))
        if (const Inst* n = value(l->length); n && isConst(n)) return static_cast<int>(n->numbers[0]);
    return a->op == Op::ArrayInput ? k_.inputs[static_cast<size_t>(a->index)].array : a->index;
}

namespace {

/// What a length is with the default values of the parameters that it names; -1 where that is not to be seen.
double usualLength(const Expr& e, const std::vector<ShaderParameter>& parameters) {
    const auto of = [&](size_t n) { return usualLength(*e.args[n], parameters); };
    if (e.kind == ExprKind::Number) return e.number;
    if (e.kind == ExprKind::Variable && e.symbol)
        for (const ShaderParameter& p : parameters)
            if (p.symbol->name == e.symbol->name && p.defaultValue && p.defaultValue->kind == ExprKind::Number)
                return p.defaultValue->number;
    if (e.kind == ExprKind::Binary && e.args.size() == 2) {
        const double a = of(0), b = of(1);
        if (a < 0 || b < 0) return -1;
        switch (e.op) {
        case ExprOp::Add:
            return a + b;
        case ExprOp::Sub:
            return std::max(a - b, 0.0);
        case ExprOp::Mul:
            return a * b;
        case ExprOp::Div:
            return b > 0 ? a / b : -1;
        default:
            return -1;
        }
    }
    return -1;
}

} // namespace

/// The largest length that resize() or reserve() gives to any array of the program. Notes which variables may change
/// their length on the way.
int Builder::largestResize() {
    if (largestResize_ >= 0) return largestResize_;
    largestResize_ = 0;
    const auto wanted = [&](const Expr& e) {
        double n = usualLength(e, shader_.parameters);
        for (const CoShader& c : options_.coShaders) n = std::max(n, usualLength(e, c.shader->parameters));
        // The scene may set a value that is larger than the default; constants do not change.
        if (e.kind != ExprKind::Number) n = std::min(n, static_cast<double>(limits::kResizableArray) * 16);
        largestResize_ = std::max(largestResize_, static_cast<int>(std::clamp(n, 0.0, 1e6)));
    };
    const auto grows = [&](const Expr& a) {
        if (a.kind == ExprKind::Variable && a.symbol) grown_.insert(a.symbol);
    };
    const auto expression = [&](const Expr& e) {
        if (e.kind == ExprKind::Assign) grows(*e.args[0]);
        for (size_t n = 0; n < e.args.size(); ++n)
            if (e.args[n] && front::writesArgument(e, n) != front::Writes::No) grows(*e.args[n]);
        if (e.shadeop && e.shadeop->name == "push") unbound_ = true;
        const bool sizes = e.shadeop && (e.shadeop->name == "resize" || e.shadeop->name == "reserve") && e.args.size() == 2;
        if (sizes) wanted(*e.args[1]);
        if (sizes) unbound_ |= e.args[1]->kind != ExprKind::Number || e.args[1]->number > limits::kShaderArray;
    };
    const auto body = [&](const Stmt& s) { front::everyExpr(s, expression); };
    const auto program = [&](const Program& p, const Shader& s) {
        front::everyBody(s, body);
        for (const auto& f : p.functions) front::everyFunctionBody(*f, body);
    };
    program(program_, shader_);
    for (const CoShader& c : options_.coShaders) program(*c.program, *c.shader);
    return largestResize_;
}

/// Whether the variable is an array that does change its length; what looks like one but never does is an ordinary array.
bool Builder::grows(const Stmt::Declarator& d) {
    largestResize();
    const bool measured = d.init && d.init->text != "{}" && (d.init->kind == ExprKind::ArrayList || d.init->type.array > 0);
    return d.symbol->resizable && (grown_.count(d.symbol) || !measured);
}

/// Storage for an array that begins with `length` elements.
Inst* Builder::newResizable(Base base, int length) {
    const int room = std::clamp(std::max(length, largestResize()), limits::kResizableArray, limits::kShaderArray);
    Inst* a = newArray(base, room);
    Inst* n = constant(static_cast<float>(length));
    lengths_[a] = {newSlot(n), newSlot(n), growing_++};
    return a;
}

/// A service on the part of an array that does not fit into its storage (spilledarrays.h): of an element `at`, or of a length.
Inst* Builder::spilled(const char* op, const Inst* a, Inst* at, Inst* value) {
    Site s;
    s.op = op;
    s.place = keptPlace(place_);
    s.pure = false;
    s.resultType = {Base::Float, 0};
    s.resultKinds = {value || at == nullptr ? Kind::Float : a->element};
    s.resultNames = {""};
    std::vector<Inst*> args;
    const Type real{Base::Float, 0};
    addArgument(s, args, constant(static_cast<float>(lengths(a)->id)), real);
    addArgument(s, args, constant(static_cast<float>(a->index)), real); // its storage
    addArgument(s, args, at, real);
    if (value) addArgument(s, args, value, real);
    return call(Op::Service, std::move(s), std::move(args))[0];
}

/// The element of an index that is below the length.
Inst* Builder::loadElement(Inst* a, Inst* index) {
    Inst* v = emit(Op::ArrayLoad, a->element, {a, index});
    if (!lengths(a) || !unbound_) return v;
    Inst* behind = emit(Op::Less, Kind::Bool, {constant(static_cast<float>(a->index) - 0.5f), index});
    return branch(
        behind, [&] { return std::vector<Inst*>{spilled("arrayload", a, index, nullptr)}; },
        [&] { return std::vector<Inst*>{v}; })[0];
}

void Builder::storeElement(Inst* a, Inst* index, Inst* value) {
    const auto store = [&] {
        emit(Op::ArrayStore, Kind::None, {a, index, value});
        return std::vector<Inst*>{};
    };
    if (!lengths(a) || !unbound_) {
        store();
        return;
    }
    branch(
        emit(Op::Less, Kind::Bool, {constant(static_cast<float>(a->index) - 0.5f), index}),
        [&] {
            spilled("arraystore", a, index, value);
            return std::vector<Inst*>{};
        },
        store);
}

/// The new length of an array that is resized to `wanted`: less if its memory is exhausted, which is reported at run time.
Inst* Builder::resized(const Inst* a, Inst* wanted) {
    if (!unbound_) return limitLength(a, wanted);
    return branch(
        emit(Op::Less, Kind::Bool, {constant(static_cast<float>(a->index)), wanted}),
        [&] {
            Site s;
            s.op = "arrayresize";
            s.place = keptPlace(place_);
            s.pure = false;
            s.resultType = {Base::Float, 0};
            s.resultKinds = {Kind::Float};
            s.resultNames = {""};
            std::vector<Inst*> args;
            const Type real{Base::Float, 0};
            addArgument(s, args, constant(static_cast<float>(lengths(a)->id)), real);
            addArgument(s, args, constant(static_cast<float>(a->index)), real);
            addArgument(s, args, wanted, real);
            addArgument(s, args, constant(static_cast<float>(components(a->element))), real);
            return std::vector<Inst*>{call(Op::Service, std::move(s), std::move(args))[0]};
        },
        [&] { return std::vector<Inst*>{wanted}; })[0];
}

/// Copies what lies behind the storage of either array, up to the length.
void Builder::copyBehind(Inst* to, Inst* from, Inst* length) {
    if (!unbound_) return;
    countLoop(constant(static_cast<float>(std::min(to->index, arrayLength(from)))), length,
              [&](Inst* at) { storeElement(to, at, coerce(loadElement(from, at), to->element)); });
}

/// Reports, when the shader runs, that an array is longer than the part of it that can be passed on.
void Builder::refuseLonger(const Inst* a, const Place& place, const std::string& where) {
    if (!lengths(a) || !unbound_) return;
    branch(
        emit(Op::Less, Kind::Bool, {constant(static_cast<float>(a->index)), lengthOf(a)}),
        [&] {
            complain(place, msg::kArrayPassed(where, a->index));
            return std::vector<Inst*>{};
        },
        [] { return std::vector<Inst*>{}; });
}

const Builder::Lengths* Builder::lengths(const Inst* a) const {
    const auto it = lengths_.find(a);
    return it == lengths_.end() ? nullptr : &it->second;
}

/// The number of elements, as a value.
Inst* Builder::lengthOf(const Inst* a) {
    if (const Lengths* l = lengths(a)) return get(l->length);
    if (const auto it = given_.find(a); it != given_.end()) return constant(static_cast<float>(it->second));
    return constant(static_cast<float>(arrayLength(a)));
}

/// An index that stays below the length that counts.
Inst* Builder::elementOf(const Inst* a, Inst* index) {
    const Lengths* l = lengths(a);
    if (!l) return index;
    if (isConst(get(l->length)) && isConst(index)) // behind the length there may still be storage
        return constant(std::min(index->numbers[0], std::max(0.0f, get(l->length)->numbers[0] - 1)));
    Inst* last = emit(Op::Sub, Kind::Float, {get(l->length), constant(1)});
    // In this order an index that is no number stays none, and element 0 is meant, as in arrays of fixed length.
    return runtime1("al_min_f", {last, index}, Kind::Float);
}

/// Reports, when the shader runs, that an array wants more than its storage holds; gives what it gets.
Inst* Builder::limitLength(const Inst* a, Inst* wanted) {
    Inst* room = constant(static_cast<float>(a->index));
    branch(
        emit(Op::Less, Kind::Bool, {room, wanted}),
        [&] {
            Site s;
            s.op = "arraylimit";
            std::vector<Inst*> args;
            addArgument(s, args, room, {Base::Float, 0});
            call(Op::Service, std::move(s), std::move(args));
            return std::vector<Inst*>{};
        },
        [] { return std::vector<Inst*>{}; });
    return runtime1("al_min_f", {wanted, room}, Kind::Float);
}

/// Copies everything that counts.
void Builder::copyResizable(Inst* to, const Expr& from) {
    const Lengths l = *lengths(to);
    const auto setLength = [&](Inst* n) {
        set(l.length, n);
        set(l.reserved, runtime1("al_max_f", {get(l.reserved), n}, Kind::Float));
    };
    if (from.kind == ExprKind::ArrayList) {
        const int n = from.text == "{}" ? 0 : std::min(static_cast<int>(from.args.size()), to->index);
        setLength(constant(static_cast<float>(n)));
    } else if (from.kind == ExprKind::Variable || from.kind == ExprKind::Cast || from.kind == ExprKind::Member ||
               returnsArray(from)) {
        Inst* a = array(from);
        if (a == to) return;
        Inst* n = lengthOf(a);
        if (!isConst(n)) { // as far as either storage goes, then what lies behind
            everyElement(std::min(to->index, a->index),
                         [&](Inst* at) { emit(Op::ArrayStore, Kind::None, {to, at, emit(Op::ArrayLoad, a->element, {a, at})}); });
            n = resized(to, n);
            copyBehind(to, a, n);
            return setLength(n);
        }
        n = resized(to, n);
        setLength(n);
        copyArray(to, from);
        if (!isConst(n) || n->numbers[0] > static_cast<float>(std::min(to->index, a->index))) copyBehind(to, a, n);
        return;
    } else if (from.kind == ExprKind::ShadeopCall && from.shadeop && from.shadeop->name == "getshaders") {
        std::vector<Inst*> when;
        const size_t all = handlesOf(from, &when).size();
        if (when.empty()) setLength(limitLength(to, constant(static_cast<float>(all))));
        else setLength(storeHandles(to, from));
        if (!when.empty()) return;
    } else if (from.kind == ExprKind::ShadeopCall && from.shadeop && from.shadeop->name == "getlights") {
        const std::vector<Inst*> all = lightHandles(from);
        setLength(limitLength(to, all[0]));
        for (int i = 0; i < to->index && i + 1 < static_cast<int>(all.size()); ++i)
            emit(Op::ArrayStore, Kind::None, {to, constant(static_cast<float>(i)), all[static_cast<size_t>(i) + 1]});
        return;
    }
    if (from.kind == ExprKind::ShadeopCall && from.shadeop && (from.shadeop->name == "bsdf" || from.shadeop->name == "trace")) {
        const std::vector<Inst*> parts = from.shadeop->name == "bsdf" ? bsdf(from) : traceParts(from);
        setLength(limitLength(to, constant(static_cast<float>(parts.size()))));
        for (size_t i = 0; i < parts.size(); ++i)
            emit(Op::ArrayStore, Kind::None, {to, constant(static_cast<float>(i)), coerce(parts[i], to->element)});
        return;
    }
    copyArray(to, from);
}

Inst* Builder::resizing(const Expr& e) {
    const std::string& name = e.shadeop->name;
    Inst* a = array(*e.args[0]);
    place_ = e.place;
    const Lengths* known = lengths(a);
    const Kind element = a->element;
    if (name == "capacity") return known ? get(known->reserved) : constant(static_cast<float>(arrayLength(a)));
    if (!known) {
        report(e.place, msg::kFixedLengthHere(name));
        return name == "pop" ? zero(element) : constant(0);
    }
    const Lengths l = *known;
    const auto reserve = [&](Inst* n) { set(l.reserved, runtime1("al_max_f", {get(l.reserved), n}, Kind::Float)); };
    if (name == "push") {
        Inst* v = coerce(expr(*e.args[1]), element);
        place_ = e.place;
        Inst* n = get(l.length);
        Inst* longer = branch(
            emit(Op::Less, Kind::Bool, {n, constant(static_cast<float>(a->index))}),
            [&] {
                emit(Op::ArrayStore, Kind::None, {a, n, v});
                return std::vector<Inst*>{emit(Op::Add, Kind::Float, {n, constant(1)})};
            },
            [&] { return std::vector<Inst*>{spilled("arraystore", a, n, v)}; })[0]; // n where there is no memory
        set(l.length, longer);
        reserve(longer);
        return constant(0);
    }
    if (name == "pop") {
        Inst* shorter =
            runtime1("al_max_f", {emit(Op::Sub, Kind::Float, {get(l.length), constant(1)}), constant(0)}, Kind::Float);
        Inst* empty = emit(Op::LessEqual, Kind::Bool, {get(l.length), constant(0)});
        Inst* v = loadElement(a, shorter);
        v = emit(Op::Select, element, {empty, zero(element), v});
        set(l.length, shorter);
        return v;
    }
    Inst* wanted = expr(*e.args[1], Kind::Float);
    place_ = e.place;
    wanted = runtime1("al_max_f", {runtime1("al_floor", {wanted}, Kind::Float), constant(0)}, Kind::Float);
    wanted = name == "resize" ? resized(a, wanted) : unbound_ ? wanted : limitLength(a, wanted);
    if (name == "reserve") {
        reserve(wanted);
        return constant(0);
    }
    set(l.length, wanted);
    reserve(wanted);
    Inst* none = emit(Op::LessEqual, Kind::Bool, {wanted, constant(0)}); // length 0 gives the memory back
    set(l.reserved, emit(Op::Select, Kind::Float, {none, constant(0), get(l.reserved)}));
    return constant(0);
}

/// With the arrays that are changed in a loop go their lengths.
void Builder::addLengths(std::set<int>& slots) const {
    std::set<int> more;
    for (int n : slots)
        if (const Inst* v = value(n))
            if (const Lengths* l = lengths(v)) more.insert({l->length, l->reserved});
    slots.insert(more.begin(), more.end());
}

} // namespace alpenglow::rsl::ir
