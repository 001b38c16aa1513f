// Values of a kernel at neighbours of the point while differences are taken: where each stands, and what inputs are there
// (differences.cpp).
#pragma once
#include "rsl/ir/edit.h"
#include "rsl/passes/names.h"
#include "rsl/passes/neighbours.h"
#include <functional>
#include <tuple>

namespace alpenglow::rsl::passes {

/// The step where there is no footprint: small against the surface, large against rounding.
inline constexpr float kStep = 1.0f / 1024;
/// A footprint of this or less is none: those of rays without a width are given as 1e-12.
inline constexpr float kNoFootprint = 1e-11f;

/// Makes instructions in the scopes that are open, innermost last, and remembers what stands for which value at which neighbour.
class NeighbourValues {
protected:
    explicit NeighbourValues(Kernel& k) : k_(k), motion_(k), leaves_(k) {}

    using At = std::pair<const Inst*, Neighbour>;
    /// Which instruction gives result k of a construct or a call, and as which of its results.
    using Results = std::vector<std::pair<Inst*, int>>;
    struct Scope {
        std::vector<Inst*> out;
        std::map<At, Inst*> values;
        std::map<At, Results> results;
        std::map<std::tuple<const Inst*, Neighbour, bool>, Inst*> slopes; ///< differences along v or u; null: zero
    };

    // What there is so far

    Inst* put(Inst* i) {
        scopes_.back()->out.push_back(i);
        return i;
    }
    Inst* make(Op op, Kind kind, std::vector<Inst*> args) { return put(k_.make(op, kind, std::move(args))); }
    Inst* atRoot(Op op, Kind kind, std::vector<Inst*> args) {
        Inst* i = k_.make(op, kind, std::move(args));
        scopes_.front()->out.push_back(i);
        return i;
    }
    /// A copy with other arguments.
    Inst* like(const Inst* i, std::vector<Inst*> args) {
        Inst* c = k_.make(i->op, i->kind);
        const uint32_t id = c->id;
        *c = *i;
        c->id = id;
        c->args = std::move(args);
        c->regions.clear();
        return c;
    }
    void set(const Inst* i, Neighbour n, Inst* value) { scopes_.back()->values[{i, n}] = value; }

    Inst* value(Inst* i, Neighbour n) {
        if (isLeaf(i)) return leafAt(i, n);
        for (auto s = scopes_.rbegin(); s != scopes_.rend(); ++s)
            if (const auto it = (*s)->values.find({i, n}); it != (*s)->values.end()) return it->second;
        return done_(i); // the point's own, and what is the same at all neighbours
    }
    std::vector<Inst*> values(const std::vector<Inst*>& list, Neighbour n) {
        std::vector<Inst*> all;
        for (Inst* i : list) all.push_back(value(i, n));
        return all;
    }

    // Inputs and steps

    Inst* constant(Kind kind, float v) { return leaves_.constant(kind, v); }
    Inst* rootValue(Inst* key, Neighbour n, const std::function<Inst*()>& make) {
        Inst*& v = scopes_.front()->values[{key, n}];
        if (!v) {
            Inst* made = make();
            return scopes_.front()->values[{key, n}] = made;
        }
        return v;
    }
    Inst* footprint(bool v) {
        Inst*& leaf = footprint_[v];
        if (leaf) return leaf;
        const char* name = v ? "dv" : "du";
        for (Inst* i : k_.body.body)
            if (i->op == Op::Input && k_.inputs[static_cast<size_t>(i->index)].name == name) leaf = i;
        if (leaf) return leaf;
        Input in;
        in.name = name;
        in.kind = Kind::Float;
        in.type = {Base::Float, 0};
        leaf = k_.make(Op::Input, Kind::Float);
        leaf->index = static_cast<int>(k_.inputs.size());
        k_.inputs.push_back(std::move(in));
        leaves_.add(leaf);
        return leaf;
    }
    Inst* step(bool v) {
        return rootValue(footprint(v), Neighbour::U, [&] {
            Inst* h = footprint(v);
            Inst* none = atRoot(Op::LessEqual, Kind::Bool, {h, constant(Kind::Float, kNoFootprint)});
            return atRoot(Op::Select, Kind::Float, {none, constant(Kind::Float, kStep), h});
        });
    }
    Inst* steps(bool v, float count) {
        return count == 1 ? step(v) : atRoot(Op::Mul, Kind::Float, {step(v), constant(Kind::Float, count)});
    }
    Inst* perStep(bool v) {
        return rootValue(footprint(v), Neighbour::V,
                         [&] { return atRoot(Op::Div, Kind::Float, {constant(Kind::Float, 1), step(v)}); });
    }
    /// a + b k.
    Inst* plus(Inst* a, Inst* b, Inst* k) {
        if (b->kind == Kind::Triple) k = atRoot(Op::Splat, Kind::Triple, {k});
        return atRoot(Op::Add, a->kind, {a, atRoot(Op::Mul, a->kind, {b, k})});
    }
    /// P and I are all whose second derivatives are known.
    bool bends(const Inst* in) const {
        const std::string& name = k_.inputs[static_cast<size_t>(in->index)].name;
        return name == "P" || name == "I";
    }
    Inst* slope(Inst* in, bool v) { return atRoot(v ? Op::Dv : Op::Du, in->kind, {in}); }
    Inst* second(Inst* in, bool v, bool w) { return atRoot(w ? Op::Dv : Op::Du, in->kind, {slope(in, v)}); }

    /// Newton's form: its differences are the derivatives that are given.
    Inst* leafAt(Inst* in, Neighbour n) {
        if (n == Neighbour::Here || !motion_.moves(in)) return in;
        return rootValue(in, n, [&] {
            const int a = kStepsU[static_cast<int>(n)], b = kStepsV[static_cast<int>(n)];
            Inst* x = in;
            if (a) x = plus(x, slope(in, false), steps(false, static_cast<float>(a)));
            if (b) x = plus(x, slope(in, true), steps(true, static_cast<float>(b)));
            if (a + b < 2 || !bends(in)) return x;
            return plus(x, second(in, a < 2, b > 0), atRoot(Op::Mul, Kind::Float, {step(a < 2), step(b > 0)}));
        });
    }
    Inst* slopeAt(Inst* in, bool v, Neighbour n) {
        Inst* d = slope(in, v);
        if (n == Neighbour::Here || !bends(in)) return d;
        const int a = kStepsU[static_cast<int>(n)], b = kStepsV[static_cast<int>(n)];
        if (a) d = plus(d, second(in, v, false), steps(false, static_cast<float>(a)));
        if (b) d = plus(d, second(in, v, true), steps(true, static_cast<float>(b)));
        return d;
    }

    Kernel& k_;
    Motion motion_;
    Leaves leaves_;
    Replacements done_; ///< the replacement of each Du and Dv at the point
    std::vector<Scope*> scopes_;

private:
    Inst* footprint_[2] = {};
};

} // namespace alpenglow::rsl::passes
