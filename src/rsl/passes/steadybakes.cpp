#include "rsl/passes/steadybakes.h"
#include "rsl/front/protocol.h"
#include <algorithm>
#include <map>
#include <unordered_map>

namespace alpenglow::rsl::passes {

namespace {

class Steadiness {
public:
    explicit Steadiness(Kernel& k) : k_(k) {}
    void run() {
        walk(k_.body, true);
        for (const auto& [site, steady] : bakes_) {
            if (!steady) continue;
            Site& s = k_.sites[static_cast<size_t>(site)];
            s.names.push_back(kPairSteady);
            s.pairStrings.push_back("1");
        }
    }

private:
    bool steady(const Inst* i) const {
        if (i->op == Op::Result) return result(i->args[0], static_cast<size_t>(i->index));
        return result(i, 0);
    }
    bool result(const Inst* i, size_t n) const {
        const auto of = steady_.find(i);
        return of != steady_.end() && n < of->second.size() && of->second[n];
    }
    bool argsSteady(const Inst* i) const {
        return std::all_of(i->args.begin(), i->args.end(), [&](const Inst* a) { return steady(a); });
    }

    bool asks(const Inst* i) const {
        const Site& s = k_.sites[static_cast<size_t>(i->site)];
        const std::string name = s.strings.empty() ? "" : s.strings[0];
        if (s.op == "attribute") return name.starts_with("user:");
        if (s.op == "rayinfo") return name == "type" || name == "depth" || name == "speculardepth" || name == "diffusedepth";
        return s.op == "option" || s.op == "rendererinfo" || s.op == "match" || s.op == "concat" || s.op == "format";
    }

    /// reached: all points get here, or none.
    void walk(const Region& region, bool reached) {
        for (const Inst* i : region.body) {
            if (i->op == Op::If) {
                const bool decided = steady(i->args[0]);
                for (const Region& r : i->regions) walk(r, reached && decided);
                std::vector<char>& results = steady_[i];
                results.assign(i->regions[0].yields.size(), char(decided));
                for (const Region& r : i->regions)
                    for (size_t n = 0; n < std::min(results.size(), r.yields.size()); ++n)
                        results[n] = char(results[n] && steady(r.yields[n]));
                continue;
            }
            for (const Region& r : i->regions) walk(r, false);
            if (i->op == Op::Service && isBake(i)) {
                const auto [at, first] = bakes_.try_emplace(i->site, true);
                at->second = at->second && reached && sameKind(i);
            } else if (i->op != Op::Result && follows(i)) {
                steady_[i].assign(std::max<size_t>(1, i->results.size()), 1);
            }
        }
    }

    /// Whether all points write the same file, and as many of them corners or middles of micropolygons.
    bool sameKind(const Inst* i) const {
        const Site& s = k_.sites[static_cast<size_t>(i->site)];
        if (!i->args.empty() && i->args[0]->kind == Kind::String && !steady(i->args[0])) return false;
        size_t values = 0, at = 0; // of pairs; constant strings have none
        for (size_t n = 0; n < s.names.size(); ++n) {
            if (!s.pairStrings[n].empty()) continue;
            if (s.names[n] == "coordsystem") return false; // empty or computed
            ++values;
            if (s.names[n] == "interpolate") at = values;
        }
        return at == 0 || (values <= i->args.size() && steady(i->args[i->args.size() - values + at - 1]));
    }

    bool isBake(const Inst* i) const {
        const std::string& op = k_.sites[static_cast<size_t>(i->site)].op;
        return op == "bake" || op == "bake3d";
    }

    /// Whether a value is the same at all points of a primitive.
    bool follows(const Inst* i) const {
        switch (i->op) {
        case Op::Const:
        case Op::ConstString:
            return true;
        case Op::Input:
        case Op::ArrayInput: {
            const Input& in = k_.inputs[static_cast<size_t>(i->index)];
            return in.constant && InputName::parse(in.name).kind == InputName::Kind::Parameter;
        }
        case Op::Service:
            return asks(i) && argsSteady(i);
        case Op::RegionParam:
        case Op::Function:
        case Op::Call:
        case Op::Request:
        case Op::Emit:
        case Op::Mark:
        case Op::Rescale:
        case Op::Du:
        case Op::Dv:
        case Op::ArrayNew:
        case Op::Loop:
        case Op::LightLoop:
            return false;
        default:
            return argsSteady(i);
        }
    }

    Kernel& k_;
    std::unordered_map<const Inst*, std::vector<char>> steady_; ///< by result
    std::map<int, bool> bakes_;                                 ///< by site
};

} // namespace

void markSteadyBakes(Kernel& k) { Steadiness(k).run(); }

} // namespace alpenglow::rsl::passes
