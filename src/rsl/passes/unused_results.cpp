#include "rsl/passes/unused_results.h"
#include "rsl/ir/edit.h"
#include <map>

namespace alpenglow::rsl::passes {

void removeUnusedResults(Kernel& k) {
    std::map<int, std::vector<char>> read; // by site
    forEach(k.body, [&](Inst* i) {
        if (i->op != Op::Request) return;
        const std::string& op = k.sites[static_cast<size_t>(i->site)].op;
        if (op == "trace" || op == "occlusion") read[i->site].resize(i->results.size());
    });
    forEach(k.body, [&](Inst* i) {
        if (i->op != Op::Result || i->args[0]->op != Op::Request) return;
        const auto of = read.find(i->args[0]->site);
        if (of != read.end()) of->second[static_cast<size_t>(i->index)] = 1;
    });
    std::map<int, std::vector<int>> now; // by site: the new number of a result
    for (const auto& [site, used] : read) {
        Site& s = k.sites[static_cast<size_t>(site)];
        if (s.resultKinds.size() != used.size() || s.resultNames.size() != used.size()) continue;
        std::vector<Kind> kinds;
        std::vector<std::string> names;
        std::vector<int>& numbers = now[site];
        for (size_t n = 0; n < used.size(); ++n) {
            numbers.push_back(static_cast<int>(kinds.size()));
            if (!used[n]) continue;
            kinds.push_back(s.resultKinds[n]);
            names.push_back(s.resultNames[n]);
        }
        if (kinds.empty() || kinds.size() == used.size()) {
            now.erase(site);
            continue;
        }
        s.resultKinds = std::move(kinds);
        s.resultNames = std::move(names);
    }
    forEach(k.body, [&](Inst* i) {
        if (i->op == Op::Request && now.count(i->site)) i->results = k.sites[static_cast<size_t>(i->site)].resultKinds;
        if (i->op == Op::Result && i->args[0]->op == Op::Request)
            if (const auto of = now.find(i->args[0]->site); of != now.end()) i->index = of->second[static_cast<size_t>(i->index)];
    });
}

} // namespace alpenglow::rsl::passes
