// The rounds in which a kernel is built.
#include "rsl/ir/build.h"
#include "rsl/ir/builder.h"
#include "rsl/passes/affine.h"
#include "rsl/passes/optimize.h"
#include <string_view>

namespace alpenglow::rsl {

using namespace ir;

static std::unique_ptr<Kernel> newKernel(const Program& p, const Shader& s) {
    auto k = std::make_unique<Kernel>();
    k->name = s.name;
    k->kind = s.kind;
    k->files = p.files;
    return k;
}

static std::unique_ptr<Kernel> buildOnce(const Program& p, const Shader& s, const KernelOptions& o, Diagnostics& d,
                                         const DirectSet& direct) {
    auto k = newKernel(p, s);
    k->light = o.light;
    bool good = false;
    {
        Builder b(*k, p, s, o, d, direct);
        good = b.buildShader();
    }
    if (!good) return nullptr;
    toShortForm(*k);
    return k;
}

/// Requests that there is no other form of.
static const std::set<std::string_view> kNoLobes = {"trace",  "transmission",    "occlusion", "subsurface",
                                                    "gather", "lightvisibility", "ambient"};

std::unique_ptr<Kernel> buildKernel(const Program& p, const Shader& s, const KernelOptions& o, Diagnostics& d) {
    DirectSet direct;
    auto k = buildOnce(p, s, o, d, direct);
    if (!k || !o.path) return k;
    // Lobe calls whose result is not used affinely are inlined instead; one of them may have hidden another, so again until none
    // is left.
    std::vector<KernelFacts::NonLinear> nonLinear;
    for (int round = 0; round < 16; ++round) {
        const auto lobe = [](const Inst* i, const Kernel& kernel) {
            const std::string& op = kernel.sites[static_cast<size_t>(i->site)].op;
            return i->op == Op::Request && !kNoLobes.count(op);
        };
        bool any = false;
        forEach(k->body, [&](Inst* i) { any = any || (i->site >= 0 && lobe(i, *k)); });
        if (!any) break;
        Diagnostics silent;
        auto trial = buildOnce(p, s, o, silent, direct);
        KernelOptions probe = o;
        probe.suspend = false;
        passes::optimize(*trial, probe, silent);
        const size_t before = direct.size();
        for (const auto& [site, why] : passes::nonAffineSites(*trial)) {
            const Site& at = trial->sites[static_cast<size_t>(site)];
            if (kNoLobes.count(at.op)) continue;
            if (direct.emplace(at.place.file, at.place.line, at.place.column).second) {
                nonLinear.push_back({at.op, why, at.place});
            }
        }
        if (direct.size() == before) break;
        Diagnostics quiet;
        k = buildOnce(p, s, o, quiet, direct);
    }
    k->facts.direct = nonLinear;
    k->facts.nonLinear = std::move(nonLinear);
    return k;
}

std::vector<OutputLight> lightOfOutputs(const Program& p, const Shader& s, const KernelOptions& o) {
    Diagnostics quiet; // reported when the kernel is made
    const auto k = buildOnce(p, s, o, quiet, {});
    return k ? passes::lightOfOutputs(*k, o) : std::vector<OutputLight>();
}

std::unique_ptr<Kernel> buildDefaults(const Program& p, const Shader& s, Diagnostics& d,
                                      const std::vector<ParameterValue>& given) {
    auto k = newKernel(p, s);
    k->name += ":defaults";
    bool good = false;
    {
        const KernelOptions o;
        const DirectSet none;
        Builder b(*k, p, s, o, d, none);
        good = b.buildDefaults(given);
    }
    if (!good) return nullptr;
    toShortForm(*k);
    return k;
}

} // namespace alpenglow::rsl
