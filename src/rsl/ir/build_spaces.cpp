// Spaces: matrices where their names are known, services where they are not.
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

Inst* Builder::space(const std::string& from, const std::string& to) {
    return input(InputName::space(ownSpace(leaves_.string(from))->text, ownSpace(leaves_.string(to))->text).text(),
                 {Base::Matrix, 0}, true);
}

Inst* Builder::toSpace(const std::string& from, const std::string& to, Inst* v, Base base, const Place&) {
    if (from == to) return v;
    if (from != "current") v = transformBy(space(from, "current"), v, base);
    if (to != "current") v = transformBy(space("current", to), v, base);
    return v;
}

/// The name of a space as the renderer has it: "shader" of a co-shader is where that was named.
Inst* Builder::ownSpace(Inst* name) {
    if (current_.empty() || isSelf(current_.back())) return name;
    const std::string& own = instances_[current_.back()].binding->space;
    if (own.empty()) return name;
    Inst* there = leaves_.string(own);
    if (name->op == Op::ConstString) return name->text == "shader" ? there : name;
    return emit(Op::Select, Kind::String, {emit(Op::Equal, Kind::Bool, {name, leaves_.string("shader")}), there, name});
}

/// Names that are not known at compile time: the renderer answers. Two Strings and the value.
Inst* Builder::dynamicSpace(const char* op, Inst* from, Inst* to, Inst* value, Base base) {
    if (base != Base::Color)
        for (Inst** name : {&from, &to}) *name = ownSpace(*name);
    Site s;
    s.op = op;
    s.strings = {from->op == Op::ConstString ? from->text : "", to->op == Op::ConstString ? to->text : ""};
    std::vector<Inst*> args;
    for (Inst* name : {from, to})
        if (name->op != Op::ConstString) {
            args.push_back(name);
            s.argKinds.push_back(Kind::String);
            s.argTypes.push_back({Base::String, 0});
        }
    args.push_back(value);
    s.argKinds.push_back(value->kind);
    s.argTypes.push_back({base, 0});
    s.resultKinds = {value->kind};
    s.resultNames = {""};
    s.resultType = {base, 0};
    s.pure = true;
    s.shadeop = findShadeop(op);
    return call(Op::Service, std::move(s), std::move(args))[0];
}

/// `value`, given in the space that the expression names, in current space (colours: rgb).
Inst* Builder::inSpace(const Expr& spaceName, Inst* value, Base base) {
    if (value->kind == Kind::Array) { // each of the elements
        const Lengths* known = lengths(value);
        Inst* a = known ? newResizable(base, 0) : newArray(base, arrayLength(value));
        if (known) {
            set(lengths(a)->length, resized(a, lengthOf(value)));
            set(lengths(a)->reserved, get(lengths(a)->length));
        }
        const int storage = std::min(known ? value->index : arrayLength(value), known ? a->index : arrayLength(a));
        everyElement(storage, [&](Inst* at) {
            emit(Op::ArrayStore, Kind::None, {a, at, inSpace(spaceName, emit(Op::ArrayLoad, value->element, {value, at}), base)});
        });
        if (known && unbound_)
            countLoop(constant(static_cast<float>(storage)), lengthOf(a),
                      [&](Inst* at) { storeElement(a, at, inSpace(spaceName, loadElement(value, at), base)); });
        return a;
    }
    Inst* name = expr(spaceName);
    if (base == Base::Color) {
        if (name->op == Op::ConstString) return colourSpace(name->text, "rgb", value);
        return dynamicSpace("ctransform", name, leaves_.string("rgb"), value, base);
    }
    if (name->op == Op::ConstString) return toSpace(name->text, "current", value, base, spaceName.place);
    const char* op = base == Base::Vector   ? "vtransform"
                     : base == Base::Normal ? "ntransform"
                     : base == Base::Matrix ? "mtransform"
                                            : "transform";
    return dynamicSpace(op, name, leaves_.string("current"), value, base);
}

Inst* Builder::transformCall(const Expr& e) {
    const std::string& name = e.shadeop->name;
    Base base = e.args.back()->type.base;
    if (name == "vtransform") base = Base::Vector;
    else if (name == "ntransform") base = Base::Normal;
    else if (name == "ptransform") base = Base::Point;
    std::vector<Inst*> a;
    for (const ExprPtr& x : e.args) a.push_back(expr(*x));
    place_ = e.place;
    Inst* v = coerce(a.back(), base == Base::Matrix ? Kind::Matrix : Kind::Triple);
    Inst* from = a.size() == 3 ? a[0] : leaves_.string("current");
    Inst* to = a[a.size() - 2];
    const auto between = [&](Inst* f, Inst* t) {
        if (f->op == Op::ConstString && t->op == Op::ConstString) return toSpace(f->text, t->text, v, base, e.place);
        return dynamicSpace(name == "ptransform" ? "transform" : name.c_str(), f, t, v, base);
    };
    if (to->kind == Kind::Matrix) {
        v = between(from, leaves_.string("current"));
        return transformBy(to, v, base);
    }
    return between(from, to);
}

} // namespace alpenglow::rsl::ir
