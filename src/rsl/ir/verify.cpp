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

    bool shape(const Inst* i) {
        const auto a = [&](size_t n) { return i->args[n]; };
        const auto same = [&](size_t n) {
            if (i->args.size() != n) return fail(i, "wrong number of operands");
            for (const Inst* x : i->args)
                if (x->kind != i->kind) return fail(i, "operands of another kind than the result");
            return i->kind == Kind::Float || i->kind == Kind::Triple || fail(i, "not a kind for arithmetic");
        };
        switch (i->op) {
        case Op::Const:
            return static_cast<int>(i->numbers.size()) == components(i->kind) || fail(i, "wrong number of components");
        case Op::ConstString:
            return i->kind == Kind::String || fail(i, "not a string");
        case Op::Input:
            return static_cast<size_t>(i->index) < k.inputs.size() || fail(i, "no such input");
        case Op::ArrayInput:
            return static_cast<size_t>(i->index) < k.inputs.size() || fail(i, "no such input");
        case Op::Result: {
            if (i->args.size() != 1 || static_cast<size_t>(i->index) >= i->args[0]->results.size())
                return fail(i, "no such result");
            return i->args[0]->results[static_cast<size_t>(i->index)] == i->kind || fail(i, "result of another kind");
        }
        case Op::Add:
        case Op::Sub:
        case Op::Mul:
        case Op::Div:
            return same(2);
        case Op::Neg:
        case Op::Du:
        case Op::Dv:
            return same(1);
        case Op::Splat:
            return kinds(i, {Kind::Float});
        case Op::Triple:
            return kinds(i, {Kind::Float, Kind::Float, Kind::Float});
        case Op::MatrixOf:
            return kinds(i, std::vector<Kind>(16, Kind::Float));
        case Op::Extract:
            return i->args.size() == 1 && i->index >= 0 && i->index < components(a(0)->kind) && components(a(0)->kind) > 1
                       ? true
                       : fail(i, "no such component");
        case Op::Less:
        case Op::LessEqual:
            return kinds(i, {Kind::Float, Kind::Float});
        case Op::Equal:
        case Op::NotEqual:
            return i->args.size() == 2 && a(0)->kind == a(1)->kind && (a(0)->kind == Kind::Float || a(0)->kind == Kind::String)
                       ? true
                       : fail(i, "wrong operands");
        case Op::And:
        case Op::Or:
            return kinds(i, {Kind::Bool, Kind::Bool});
        case Op::Not:
        case Op::ToFloat:
            return kinds(i, {Kind::Bool});
        case Op::Select:
            return kinds(i, {Kind::Bool, i->kind, i->kind}) && i->kind != Kind::Array ? true : fail(i, "wrong operands");
        case Op::ArrayLoad:
            return kinds(i, {Kind::Array, Kind::Float}) && a(0)->element == i->kind ? true : fail(i, "element of another kind");
        case Op::ArrayStore:
            return kinds(i, {Kind::Array, Kind::Float, a(0)->element}) && a(0)->op == Op::ArrayNew ? true
                                                                                                   : fail(i, "wrong operands");
        case Op::Service:
        case Op::Request:
        case Op::Emit: {
            if (static_cast<size_t>(i->site) >= k.sites.size()) return fail(i, "no such site");
            const std::vector<Kind>& want = k.sites[static_cast<size_t>(i->site)].argKinds;
            const size_t from = i->op == Op::Emit ? 1 : 0;
            if (i->args.size() != want.size() + from) return fail(i, "operands do not match the site");
            return kinds(i, want, from) && (from == 0 || a(0)->kind == Kind::Triple || fail(i, "the weight is not a triple"));
        }
        case Op::If: {
            const std::vector<Kind> r = resultKinds(*i);
            return i->args.size() == 1 && kinds(i, {Kind::Bool}) && i->regions.size() == 2 && i->regions[0].params.empty() &&
                           i->regions[1].params.empty() && yields(i, i->regions[0], r, "then") &&
                           yields(i, i->regions[1], r, "else")
                       ? true
                       : fail(i, "wrong shape");
        }
        case Op::Loop: {
            const std::vector<Kind> r = resultKinds(*i);
            return i->regions.size() == 2 && i->args.size() == r.size() && kinds(i, r) && params(i, i->regions[0], r) &&
                           params(i, i->regions[1], r) && yields(i, i->regions[0], {Kind::Bool}, "while") &&
                           yields(i, i->regions[1], r, "do")
                       ? true
                       : fail(i, "wrong shape");
        }
        case Op::LightLoop: {
            const std::vector<Kind> r = resultKinds(*i);
            std::vector<Kind> p = {Kind::Triple, Kind::Triple, Kind::Triple, Kind::Float};
            p.insert(p.end(), r.begin(), r.end());
            return i->regions.size() == 1 && i->args.size() == r.size() + 3 &&
                           kinds(i, {Kind::Triple, Kind::Triple, Kind::Float}) && kinds(i, r, 3) && params(i, i->regions[0], p) &&
                           yields(i, i->regions[0], r, "body")
                       ? true
                       : fail(i, "wrong shape");
        }
        case Op::Function:
            return i->regions.size() == 1 && i->args.empty() && i->kind == Kind::None ? closed(i) : fail(i, "wrong shape");
        case Op::Call: {
            if (i->args.empty() || a(0)->op != Op::Function) return fail(i, "calls no function");
            const Region& r = a(0)->regions[0];
            std::vector<Kind> want;
            for (const Inst* p : r.params) want.push_back(p->kind);
            return i->args.size() == want.size() + 1 && kinds(i, want, 1) && yields(a(0), r, resultKinds(*i), "the function")
                       ? true
                       : fail(i, "operands do not match the function");
        }
        case Op::Output:
            return i->args.size() == 1 && static_cast<size_t>(i->index) < k.outputs.size() &&
                           a(0)->kind == k.outputs[static_cast<size_t>(i->index)].kind
                       ? true
                       : fail(i, "wrong operand");
        case Op::Rescale:
            return kinds(i, {Kind::Float, Kind::Triple});
        default:
            return true;
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
