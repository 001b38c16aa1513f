#include "rsl/passes/fold.h"
#include "rsl/passes/zerodivision.h"
#include <cmath>
#include <cstring>

namespace alpenglow::rsl::passes {
namespace {

bool sameBits(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// The language's division: x / 0 = 0.
float divide(float a, float b) { return b == 0 ? 0 : a / b; }

float arithmetic(Op op, float a, float b) {
    switch (op) {
    case Op::Add:
        return a + b;
    case Op::Sub:
        return a - b;
    case Op::Mul:
        return a * b;
    default:
        return divide(a, b);
    }
}

bool compare(Op op, float a, float b) {
    switch (op) {
    case Op::Less:
        return a < b;
    case Op::LessEqual:
        return a <= b;
    case Op::Equal:
        return a == b;
    default:
        return a != b;
    }
}

/// Runtime calls with constant arguments and one numeric result.
Inst* foldRuntime(Leaves& leaves, const Inst* i) {
    const Kind kind = i->results.empty() ? i->kind : i->results[0];
    if (i->results.size() > 1 || kind == Kind::String || kind == Kind::None) return nullptr;
    std::vector<float> in;
    for (const Inst* a : i->args) in.insert(in.end(), a->numbers.begin(), a->numbers.end());
    std::vector<float> out(static_cast<size_t>(components(kind)));
    if (!evaluateRuntime(i->text, in.data(), static_cast<int>(in.size()), out.data(), static_cast<int>(out.size())))
        return nullptr;
    return leaves.constant(kind, out);
}

Inst* foldConstants(Leaves& leaves, const Inst* i) {
    const auto number = [&](size_t a, size_t c) { return i->args[a]->numbers[c]; };
    const size_t n = i->args.empty() ? 0 : i->args[0]->numbers.size();
    std::vector<float> r(n);
    switch (i->op) {
    case Op::Add:
    case Op::Sub:
    case Op::Mul:
    case Op::Div:
        for (size_t c = 0; c < n; ++c) r[c] = arithmetic(i->op, number(0, c), number(1, c));
        return leaves.constant(i->kind, r);
    case Op::Neg:
        for (size_t c = 0; c < n; ++c) r[c] = -number(0, c);
        return leaves.constant(i->kind, r);
    case Op::Splat:
        return leaves.constant(Kind::Triple, number(0, 0));
    case Op::Triple:
        return leaves.constant(Kind::Triple, {number(0, 0), number(1, 0), number(2, 0)});
    case Op::MatrixOf: {
        std::vector<float> m;
        for (size_t a = 0; a < 16; ++a) m.push_back(number(a, 0));
        return leaves.constant(Kind::Matrix, m);
    }
    case Op::Extract:
        return leaves.constant(Kind::Float, number(0, static_cast<size_t>(i->index)));
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::NotEqual:
        return leaves.constant(Kind::Bool, compare(i->op, number(0, 0), number(1, 0)) ? 1.0f : 0.0f);
    case Op::And:
        return leaves.constant(Kind::Bool, number(0, 0) != 0 && number(1, 0) != 0 ? 1.0f : 0.0f);
    case Op::Or:
        return leaves.constant(Kind::Bool, number(0, 0) != 0 || number(1, 0) != 0 ? 1.0f : 0.0f);
    case Op::Not:
        return leaves.constant(Kind::Bool, number(0, 0) != 0 ? 0.0f : 1.0f);
    case Op::ToFloat:
        return leaves.constant(Kind::Float, number(0, 0) != 0 ? 1.0f : 0.0f);
    case Op::Du:
    case Op::Dv:
        return leaves.constant(i->kind, 0.0f);
    case Op::Runtime:
        return foldRuntime(leaves, i);
    default:
        return nullptr;
    }
}

} // namespace

Inst* simplify(Kernel&, Leaves& leaves, Inst* i) {
    const auto a = [&](size_t n) { return i->args[n]; };
    if (waitsForWarning(*i)) return nullptr;
    bool allConst = !i->args.empty();
    for (const Inst* x : i->args) allConst = allConst && x->op == Op::Const;
    if (allConst && i->regions.empty())
        if (Inst* c = foldConstants(leaves, i)) return c;
    switch (i->op) {
    case Op::Add: // x + -0 is x for every x; x + 0 is not, for x = -0
        if (isConst(a(1), -0.0f)) return a(0);
        return isConst(a(0), -0.0f) ? a(1) : nullptr;
    case Op::Sub:
        return isConst(a(1), 0.0f) ? a(0) : nullptr;
    case Op::Mul:
        if (isConst(a(1), 1.0f)) return a(0);
        return isConst(a(0), 1.0f) ? a(1) : nullptr;
    case Op::Div:
        return isConst(a(1), 1.0f) ? a(0) : nullptr;
    case Op::Neg:
        return a(0)->op == Op::Neg ? a(0)->args[0] : nullptr;
    case Op::Extract:
        if (a(0)->op == Op::Splat) return a(0)->args[0];
        if (a(0)->op == Op::Triple || a(0)->op == Op::MatrixOf) return a(0)->args[static_cast<size_t>(i->index)];
        return nullptr;
    case Op::Triple:
        if (a(0) == a(1) && a(1) == a(2)) {
            return nullptr; // would be Splat: no cheaper
        }
        if (a(0)->op == Op::Extract && a(1)->op == Op::Extract && a(2)->op == Op::Extract && a(0)->index == 0 &&
            a(1)->index == 1 && a(2)->index == 2 && a(0)->args[0] == a(1)->args[0] && a(1)->args[0] == a(2)->args[0] &&
            a(0)->args[0]->kind == Kind::Triple)
            return a(0)->args[0];
        return nullptr;
    case Op::Equal:
    case Op::NotEqual:
        if (a(0)->op == Op::ConstString && a(1)->op == Op::ConstString)
            return leaves.constant(Kind::Bool, (a(0)->text == a(1)->text) == (i->op == Op::Equal) ? 1.0f : 0.0f);
        return nullptr;
    case Op::And:
        for (size_t n = 0; n < 2; ++n)
            if (isConst(a(n))) return a(n)->numbers[0] != 0 ? a(1 - n) : a(n);
        return a(0) == a(1) ? a(0) : nullptr;
    case Op::Or:
        for (size_t n = 0; n < 2; ++n)
            if (isConst(a(n))) return a(n)->numbers[0] != 0 ? a(n) : a(1 - n);
        return a(0) == a(1) ? a(0) : nullptr;
    case Op::Not:
        return a(0)->op == Op::Not ? a(0)->args[0] : nullptr;
    case Op::Select:
        if (isConst(a(0))) return a(0)->numbers[0] != 0 ? a(1) : a(2);
        if (a(1) == a(2)) return a(1);
        if (a(1)->op == Op::Const && a(2)->op == Op::Const && a(1)->numbers.size() == a(2)->numbers.size()) {
            for (size_t c = 0; c < a(1)->numbers.size(); ++c)
                if (!sameBits(a(1)->numbers[c], a(2)->numbers[c])) return nullptr;
            return a(1);
        }
        return nullptr;
    default:
        return nullptr;
    }
}

namespace {

struct Folder {
    Kernel& k;
    Leaves leaves{k};
    Replacements rep;
    int changes = 0;

    void region(Region& r) {
        std::vector<Inst*> body;
        body.reserve(r.body.size());
        for (Inst* i : r.body) inst(i, body);
        for (Inst*& y : r.yields) y = rep(y);
        r.body = std::move(body);
    }

    void inst(Inst* i, std::vector<Inst*>& body) {
        rep.apply(i);
        if (i->op == Op::Result) {
            Inst* owner = i->args[0];
            if (owner->op == Op::If && isConst(owner->args[0])) {
                rep.set(i, rep(owner->regions[owner->args[0]->numbers[0] != 0 ? 0 : 1].yields[static_cast<size_t>(i->index)]));
                return;
            }
            if (owner->op == Op::Runtime && owner->text == "al_comp" &&
                isConst(owner->args[1])) { // light can be followed through it
                const float n = owner->args[1]->numbers[0];
                if (n == 0 || n == 1 || n == 2) {
                    Inst* part = k.make(Op::Extract, Kind::Float, {owner->args[0]});
                    part->index = static_cast<int>(n);
                    part->place = i->place;
                    body.push_back(part);
                    rep.set(i, part);
                    ++changes;
                    return;
                }
            }
            if (owner->op == Op::Runtime && owner->results.size() == 1) {
                if (Inst* to = simplify(k, leaves, owner)) {
                    rep.set(i, to);
                    ++changes;
                    return;
                }
            }
            body.push_back(i);
            return;
        }
        if (i->op == Op::If && isConst(i->args[0])) {
            Region& taken = i->regions[i->args[0]->numbers[0] != 0 ? 0 : 1];
            const std::vector<Inst*> inner = std::move(taken.body);
            taken.body.clear();
            for (Inst* sub : inner) inst(sub, body);
            for (Inst*& y : taken.yields) y = rep(y);
            ++changes;
            return;
        }
        for (Region& sub : i->regions) region(sub);
        if (i->op != Op::Runtime) {
            if (Inst* to = simplify(k, leaves, i)) {
                rep.set(i, to);
                ++changes;
                return;
            }
        }
        body.push_back(i);
    }
};

} // namespace

int fold(Kernel& k) {
    Folder f{k};
    f.region(k.body);
    return f.changes;
}

} // namespace alpenglow::rsl::passes
