#include "rsl/passes/cse.h"
#include "rsl/ir/edit.h"

namespace alpenglow::rsl::passes {
namespace {

struct Merger {
    Kernel& k;
    Replacements rep;
    std::unordered_map<std::string, Inst*> known;
    int changes = 0;

    std::string key(const Inst* i) const {
        std::string s;
        const auto put = [&](const auto& v) { s.append(reinterpret_cast<const char*>(&v), sizeof v); };
        put(i->op);
        put(i->kind);
        put(i->index);
        if (i->op == Op::Service) { // sites differ in number only
            const Site& site = k.sites[static_cast<size_t>(i->site)];
            s += site.op + '\0';
            for (const auto* list : {&site.strings, &site.names, &site.pairStrings, &site.resultNames}) {
                for (const std::string& t : *list) s += t + '\0';
                s += '\1';
            }
        }
        put(i->args.size());
        for (const Inst* a : i->args) put(a->id);
        for (float f : i->numbers) put(f);
        for (Kind r : i->results) put(r);
        return s + i->text;
    }

    void region(Region& r) {
        std::vector<std::string> mine;
        std::vector<Inst*> body;
        body.reserve(r.body.size());
        for (Inst* i : r.body) {
            rep.apply(i);
            for (Region& sub : i->regions) region(sub);
            if (i->op == Op::Result || isMovable(k, *i)) {
                std::string s = key(i);
                const auto [it, fresh] = known.try_emplace(s, i);
                if (!fresh) {
                    rep.set(i, it->second);
                    ++changes;
                    continue;
                }
                mine.push_back(std::move(s));
            }
            body.push_back(i);
        }
        for (Inst*& y : r.yields) y = rep(y);
        r.body = std::move(body);
        for (const std::string& s : mine) known.erase(s);
    }
};

} // namespace

int mergeCommon(Kernel& k) {
    Merger m{k, {}, {}, 0};
    m.region(k.body);
    return m.changes;
}

} // namespace alpenglow::rsl::passes
