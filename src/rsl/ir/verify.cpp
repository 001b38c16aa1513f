#include "rsl/ir/verify.h"
#include "rsl/ir/edit.h"
#include <fmt/format.h>
#include <functional>

namespace alpenglow::rsl::ir {
namespace {

struct Verifier {
    const Kernel& k;
    std::vector<char> visible; ///< by id: defined in a region around the current place
    std::string error;

    bool fail(const Inst* i, const std::string& why) {
        if (error.empty()) error = fmt::format("{} (id {}, line {}): {}", name(i->op), i->id, i->place.line, why);
        return false;
    }

    bool kinds(const Inst* i, const std::vector<Kind>& want, size_t from = 0) {
        if (i->args.size() < from + want.size()) return fail(i, "too few operands");
        for (size_t a = 0; a < want.size(); ++a)
            if (i->args[from + a]->kind != want[a]) return fail(i, fmt::format("operand {} has the wrong kind", from + a));
        return true;
    }

    bool yields(const Inst* i, const Region& r, const std::vector<Kind>& want, const char* what) {
        if (r.yields.size() != want.size())
            return fail(i, fmt::format("{} yields {} values, {} wanted", what, r.yields.size(), want.size()));
        for (size_t y = 0; y < want.size(); ++y)
            if (r.yields[y]->kind != want[y]) return fail(i, fmt::format("{}: yield {} has the wrong kind", what, y));
        return true;
    }

    bool params(const Inst* i, const Region& r, const std::vector<Kind>& want) {
        if (r.params.size() != want.size()) return fail(i, "wrong number of region parameters");
        for (size_t p = 0; p < want.size(); ++p)
            if (r.params[p]->kind != want[p] || r.params[p]->op != Op::RegionParam)
                return fail(i, fmt::format("region parameter {} is wrong", p));
        return true;
    }

    /// The body of a function uses leaves and other functions from outside, nothing else.
    bool closed(const Inst* f) {
        std::vector<char> own(k.pool.size());
        const std::function<void(const Region&)> define = [&](const Region& r) {
            for (const Inst* p : r.params) own[p->id] = 1;
            for (const Inst* i : r.body) {
                own[i->id] = 1;
                for (const Region& sub : i->regions) define(sub);
            }
        };
        define(f->regions[0]);
        bool good = true;
        const auto check = [&](const Inst* x) { good = good && (own[x->id] || isLeaf(x) || x->op == Op::Function); };
        const std::function<void(const Region&)> walk = [&](const Region& r) {
            for (const Inst* i : r.body) {
                for (const Inst* x : i->args) check(x);
                for (const Region& sub : i->regions) walk(sub);
            }
            for (const Inst* y : r.yields) check(y);
        };
        walk(f->regions[0]);
        return good || fail(f, "its body uses values from outside");
    }

    /// Arithmetic: `n` operands of the kind of the result.
    bool same(const Inst* i, size_t n) {
        if (i->args.size() != n) return fail(i, "wrong number of operands");
        for (const Inst* x : i->args)
            if (x->kind != i->kind) return fail(i, "operands of another kind than the result");
        return i->kind == Kind::Float || i->kind == Kind::Triple || fail(i, "not a kind for arithmetic");
    }

    bool hold(const Inst* i, bool good, const char* why) { return good || fail(i, why); }

    bool result(const Inst* i) {
        if (i->args.size() != 1 || static_cast<size_t>(i->index) >= i->args[0]->results.size()) return fail(i, "no such result");
        return hold(i, i->args[0]->results[static_cast<size_t>(i->index)] == i->kind, "result of another kind");
    }

    bool extract(const Inst* i) {
        const int n = i->args.size() == 1 ? components(i->args[0]->kind) : 0;
        return hold(i, i->index >= 0 && i->index < n && n > 1, "no such component");
    }

    bool equality(const Inst* i) {
        if (i->args.size() != 2) return fail(i, "wrong operands");
        const Kind a = i->args[0]->kind, b = i->args[1]->kind;
        return hold(i, a == b && (a == Kind::Float || a == Kind::String), "wrong operands");
    }

    /// Everything that only computes a value.
    bool value(const Inst* i) {
        switch (i->op) {
        case Op::Const:
            return hold(i, static_cast<int>(i->numbers.size()) == components(i->kind), "wrong number of components");
        case Op::ConstString:
            return hold(i, i->kind == Kind::String, "not a string");
        case Op::Input:
        case Op::ArrayInput:
            return hold(i, static_cast<size_t>(i->index) < k.inputs.size(), "no such input");
        case Op::Result:
            return result(i);
        case Op::Add:
        case Op::Sub:
        case Op::Mul:
        case Op::Div:
            return same(i, 2);
        case Op::Neg:
        case Op::Du:
        case Op::Dv:
            return same(i, 1);
        case Op::Splat:
            return kinds(i, {Kind::Float});
        case Op::Triple:
            return kinds(i, {Kind::Float, Kind::Float, Kind::Float});
        case Op::MatrixOf:
            return kinds(i, std::vector<Kind>(16, Kind::Float));
        case Op::Extract:
            return extract(i);
        case Op::Less:
        case Op::LessEqual:
            return kinds(i, {Kind::Float, Kind::Float});
        case Op::Equal:
        case Op::NotEqual:
            return equality(i);
        case Op::And:
        case Op::Or:
            return kinds(i, {Kind::Bool, Kind::Bool});
        case Op::Not:
        case Op::ToFloat:
            return kinds(i, {Kind::Bool});
        case Op::Select:
            return hold(i, kinds(i, {Kind::Bool, i->kind, i->kind}) && i->kind != Kind::Array, "wrong operands");
        default:
            return true;
        }
    }

    bool array(const Inst* i) {
        if (!kinds(i, {Kind::Array, Kind::Float})) return false;
        const Inst* a = i->args[0];
        if (i->op == Op::ArrayLoad) return hold(i, a->element == i->kind, "element of another kind");
        return hold(i, kinds(i, {Kind::Array, Kind::Float, a->element}) && a->op == Op::ArrayNew, "wrong operands");
    }

    /// Service, Request and Emit.
    bool atSite(const Inst* i) {
        if (static_cast<size_t>(i->site) >= k.sites.size()) return fail(i, "no such site");
        const std::vector<Kind>& want = k.sites[static_cast<size_t>(i->site)].argKinds;
        const size_t from = i->op == Op::Emit ? 1 : 0;
        if (i->args.size() != want.size() + from) return fail(i, "operands do not match the site");
        return kinds(i, want, from) && (from == 0 || hold(i, i->args[0]->kind == Kind::Triple, "the weight is not a triple"));
    }

    bool branch(const Inst* i) {
        const std::vector<Kind> r = resultKinds(*i);
        const auto side = [&](size_t n, const char* what) {
            return i->regions[n].params.empty() && yields(i, i->regions[n], r, what);
        };
        return hold(i,
                    i->args.size() == 1 && kinds(i, {Kind::Bool}) && i->regions.size() == 2 && side(0, "then") && side(1, "else"),
                    "wrong shape");
    }

    bool loop(const Inst* i) {
        const std::vector<Kind> r = resultKinds(*i);
        return hold(i,
                    i->regions.size() == 2 && i->args.size() == r.size() && kinds(i, r) && params(i, i->regions[0], r) &&
                        params(i, i->regions[1], r) && yields(i, i->regions[0], {Kind::Bool}, "while") &&
                        yields(i, i->regions[1], r, "do"),
                    "wrong shape");
    }

    bool lightLoop(const Inst* i) {
        const std::vector<Kind> r = resultKinds(*i);
        std::vector<Kind> p = {Kind::Triple, Kind::Triple, Kind::Triple, Kind::Float};
        p.insert(p.end(), r.begin(), r.end());
        return hold(i,
                    i->regions.size() == 1 && i->args.size() == r.size() + 3 &&
                        kinds(i, {Kind::Triple, Kind::Triple, Kind::Float}) && kinds(i, r, 3) && params(i, i->regions[0], p) &&
                        yields(i, i->regions[0], r, "body"),
                    "wrong shape");
    }

    bool call(const Inst* i) {
        if (i->args.empty() || i->args[0]->op != Op::Function) return fail(i, "calls no function");
        const Inst* f = i->args[0];
        std::vector<Kind> want;
        for (const Inst* p : f->regions[0].params) want.push_back(p->kind);
        return hold(i,
                    i->args.size() == want.size() + 1 && kinds(i, want, 1) &&
                        yields(f, f->regions[0], resultKinds(*i), "the function"),
                    "operands do not match the function");
    }

    bool output(const Inst* i) {
        return hold(i,
                    i->args.size() == 1 && static_cast<size_t>(i->index) < k.outputs.size() &&
                        i->args[0]->kind == k.outputs[static_cast<size_t>(i->index)].kind,
                    "wrong operand");
    }

    bool shape(const Inst* i) {
        switch (i->op) {
        case Op::ArrayLoad:
        case Op::ArrayStore:
            return array(i);
        case Op::Service:
        case Op::Request:
        case Op::Emit:
            return atSite(i);
        case Op::If:
            return branch(i);
        case Op::Loop:
            return loop(i);
        case Op::LightLoop:
            return lightLoop(i);
        case Op::Function:
            return hold(i, i->regions.size() == 1 && i->args.empty() && i->kind == Kind::None, "wrong shape") && closed(i);
        case Op::Call:
            return call(i);
        case Op::Output:
            return output(i);
        case Op::Rescale:
            return kinds(i, {Kind::Float, Kind::Triple});
        default:
            return value(i);
        }
    }

    bool region(const Region& r) {
        std::vector<const Inst*> mine;
        const auto define = [&](const Inst* i) {
            if (visible[i->id]) return fail(i, "appears twice");
            visible[i->id] = 1;
            mine.push_back(i);
            return true;
        };
        for (const Inst* p : r.params)
            if (!define(p)) return false;
        for (const Inst* i : r.body) {
            for (const Inst* x : i->args)
                if (!visible[x->id]) return fail(i, fmt::format("operand {} (id {}) is not defined here", name(x->op), x->id));
            for (const Region& sub : i->regions)
                if (!region(sub)) return false;
            if (!shape(i) || !define(i)) return false;
        }
        for (const Inst* y : r.yields)
            if (!visible[y->id]) return fail(y, "yielded but not defined here");
        for (const Inst* i : mine) visible[i->id] = 0;
        return true;
    }
};

} // namespace

std::string verify(const Kernel& k) {
    Verifier v{k, std::vector<char>(k.pool.size()), {}};
    v.region(k.body);
    return v.error;
}

} // namespace alpenglow::rsl::ir
