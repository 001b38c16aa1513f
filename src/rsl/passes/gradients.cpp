#include "rsl/passes/gradients.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/edit.h"
#include <algorithm>
#include <map>
#include <unordered_map>

namespace alpenglow::rsl::passes {
namespace {

struct Gradients {
    Kernel& k;
    Leaves leaves{k};
    Replacements rep;
    std::unordered_map<const Inst*, int> wanted; ///< services whose value carries derivatives: of which order
    std::map<std::pair<int, size_t>, int> sites; ///< with slopes, by the site without and how many

    /// The coordinates of a lookup: s and t, or the direction. Empty when they do not move. What must be computed goes to `body`.
    std::vector<Inst*> coordinates(const Inst* i, std::vector<Inst*>& body) {
        const std::vector<size_t> which = lookupCoordinates(k, i);
        std::vector<Inst*> a;
        for (const size_t n : which) a.push_back(i->args[n]);
        const auto mean = [&](std::vector<Inst*> of) {
            Inst* sum = of[0];
            for (size_t n = 1; n < of.size(); ++n) body.push_back(sum = k.make(Op::Add, sum->kind, {sum, of[n]}));
            body.push_back(sum = k.make(Op::Mul, sum->kind, {sum, leaves.constant(sum->kind, 0.25f)}));
            return sum;
        };
        std::vector<Inst*> at;
        const bool direction = !a.empty() && a[0]->kind == Kind::Triple;
        if (a.size() == (direction ? 1u : 2u)) at = a;
        else if (direction && a.size() == 4) at = {mean(a)};
        else if (a.size() == 8) at = {mean({a[0], a[2], a[4], a[6]}), mean({a[1], a[3], a[5], a[7]})};
        const bool still = std::all_of(at.begin(), at.end(), [&](const Inst* c) {
            return isConst(c) || (c->op == Op::Input && k.inputs[static_cast<size_t>(c->index)].constant);
        });
        return still ? std::vector<Inst*>() : at;
    }

    int siteWithSlopes(int site, size_t count) {
        const auto [it, fresh] = sites.try_emplace({site, count}, static_cast<int>(k.sites.size()));
        if (fresh) {
            Site s = k.sites[static_cast<size_t>(site)];
            s.resultKinds.insert(s.resultKinds.end(), count, s.resultKinds[0]);
            for (size_t n = 0; n < count; ++n) s.resultNames.push_back(OutputName::slope(std::to_string(n)).text());
            k.sites.push_back(std::move(s));
        }
        return it->second;
    }

    void lookup(Inst* i, std::vector<Inst*>& body) {
        std::vector<Inst*> before, after;
        const std::vector<Inst*> at = coordinates(i, before);
        body.insert(body.end(), before.begin(), before.end());
        body.push_back(i);
        if (at.empty()) return;
        const bool direction = at[0]->kind == Kind::Triple;
        const bool second = wanted.at(i) > 1;
        const size_t count = direction ? (second ? 9 : 3) : (second ? 5 : 2);
        const Kind kind = i->results[0];
        i->site = siteWithSlopes(i->site, count);
        i->results.insert(i->results.end(), count, kind);
        std::vector<Inst*> args;
        const auto result = [&](Inst* of, int index) {
            Inst* r = k.make(Op::Result, kind, {of});
            r->index = index;
            r->place = i->place;
            body.push_back(r);
            return r;
        };
        for (size_t n = 0; n <= count; ++n) args.push_back(result(i, static_cast<int>(n)));
        args.insert(args.end(), at.begin(), at.end());
        Inst* c = k.make(Op::Runtime, Kind::None, std::move(args));
        c->text = std::string(direction ? "al_chain3" : "al_chain2") + (second ? "c_" : "_") + (kind == Kind::Triple ? "t" : "f");
        c->results = {kind};
        c->place = i->place;
        body.push_back(c);
        chained[i] = result(c, 0);
    }
    std::unordered_map<const Inst*, Inst*> chained; ///< the replacement of the value of a lookup

    void region(Region& r) {
        std::vector<Inst*> body;
        body.reserve(r.body.size());
        for (Inst* i : r.body) {
            if (i->op == Op::Service && wanted.count(i)) {
                lookup(i, body);
                continue;
            }
            if (i->op == Op::Result)
                if (const auto it = chained.find(i->args[0]); it != chained.end()) {
                    rep.set(i, it->second);
                    continue;
                }
            for (Region& sub : i->regions) region(sub);
            body.push_back(i);
        }
        r.body = std::move(body);
    }

    void run() {
        forEach(k.body, [&](Inst* i) {
            if (i->op != Op::Result || i->order == 0 || i->args[0]->op != Op::Service) return;
            const Inst* o = i->args[0];
            const Site& s = k.sites[static_cast<size_t>(o->site)];
            if (s.shadeop && s.shadeop->derivative == DerivativeRule::Gradient && o->results.size() == 1)
                wanted[o] = std::max<int>(wanted[o], i->order);
        });
        if (wanted.empty()) return;
        region(k.body);
        leaves.flush();
        rep.apply(k.body);
    }
};

} // namespace

std::vector<size_t> lookupCoordinates(const Kernel& k, const Inst* i) {
    const Site& s = k.sites[static_cast<size_t>(i->site)];
    const auto pairs = std::count_if(s.pairStrings.begin(), s.pairStrings.end(), [](const std::string& t) { return t.empty(); });
    const size_t end = i->args.size() - std::min(static_cast<size_t>(pairs), i->args.size());
    const size_t first = end > 0 && i->args[0]->kind == Kind::String ? 1 : 0;
    const bool direction = end > first && i->args[first]->kind == Kind::Triple;
    switch (end - first) {
    case 3:
        return direction ? std::vector<size_t>{first} : std::vector<size_t>();
    case 4:
        return direction ? std::vector<size_t>{first, first + 1, first + 2, first + 3} : std::vector<size_t>();
    case 6:
        return direction ? std::vector<size_t>() : std::vector<size_t>{first, first + 1};
    case 8:
        if (direction) return {};
        return {first, first + 1, first + 2, first + 3, first + 4, first + 5, first + 6, first + 7};
    default:
        return {};
    }
}

void addGradients(Kernel& k) { Gradients{k, Leaves(k), {}, {}, {}, {}}.run(); }

} // namespace alpenglow::rsl::passes
