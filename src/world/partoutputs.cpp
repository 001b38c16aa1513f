// Selects the outputs that displays request and that receive light; they get kernels of their own (integrator/lightoutputs.cpp).
#include "world/surfaces.h"
#include <algorithm>
#include <tuple>

namespace alpenglow::world {

namespace {

/// Identity of a call, independent of its place in the text. Arguments are compared by value at run time.
auto callOf(const rsl::ir::Site& s) {
    std::vector<std::pair<std::string_view, std::string_view>> pairs; // without the pairs that the compiler adds
    for (size_t k = 0; k < s.names.size(); ++k)
        if (s.names[k] != rsl::kPairApart) pairs.emplace_back(s.names[k], s.pairStrings[k]);
    return std::tuple(s.op, s.strings, std::move(pairs), s.argKinds);
}

/// For each call site of `of`, the first site of `in` with the same call; -1: none.
std::vector<int> sameCalls(const BoundKernel& of, const BoundKernel& in) {
    std::vector<int> same;
    for (const SiteInfo& s : of.sites) {
        const auto found =
            std::find_if(in.sites.begin(), in.sites.end(), [&](const SiteInfo& t) { return callOf(*s.site) == callOf(*t.site); });
        same.push_back(found == in.sites.end() ? -1 : int(found - in.sites.begin()));
    }
    return same;
}

} // namespace

void SurfaceBinder::partLightOutputs(SurfaceBinding& b, Names& outputs, const Names& varying) {
    b.lightOutputs.clear();
    b.inLightOutputs.clear();
    const std::vector<rsl::OutputName>& wanted = world_.wanted_;
    const auto asked = [&](const std::string& name) {
        return std::find(wanted.begin(), wanted.end(), rsl::OutputName::parse(name)) != wanted.end();
    };
    if (std::none_of(outputs.begin() + 2, outputs.end(), asked)) return; // Ci and Oi are the first two
    const auto slots = world_.lightOfOutputs(*b.surface, outputs, varying, path_);
    Names plain = outputs, parameters{};
    for (const std::string& name : outputs)
        if (rsl::OutputName::parse(name).parameter) parameters.push_back(name); // lights query it
    std::vector<char> inLightOutputs(wanted.size(), 0);
    for (size_t k = 0; k < wanted.size(); ++k) {
        bool light = false, good = true;
        int component = 0;
        std::vector<LightOutput> found;
        std::vector<LightOutputPlace> places;
        for (const auto& [output, lit] : slots) {
            const rsl::OutputName name = rsl::OutputName::parse(output.name);
            const bool element = wanted[k].element < 0 && name.element >= 0 &&
                                 name == rsl::OutputName{wanted[k].what, false, false, false, wanted[k].name, name.element, 0};
            if (name != wanted[k] && !element) continue;
            const int size = rsl::ir::components(output.kind);
            light |= lit;
            good &= output.kind == rsl::ir::Kind::Float || output.kind == rsl::ir::Kind::Triple;
            LightOutput& o = found.emplace_back();
            o.slot = name;
            o.outputs = parameters;
            o.outputs.insert(o.outputs.begin(), output.name);
            places.push_back({name, int(k), component, size});
            component += size;
        }
        if (!light || !good || wanted[k] == rsl::OutputName::of("Ci") || wanted[k] == rsl::OutputName::of("Oi")) continue;
        inLightOutputs[k] = 1;
        std::erase(plain, wanted[k].text());
        for (size_t i = 0; i < found.size(); ++i) {
            const auto same = [&](const LightOutputPlace& p) {
                return p.aov == places[i].aov && p.component == places[i].component && p.size == places[i].size;
            };
            const auto known = std::find_if(world_.lightOutputs_.begin(), world_.lightOutputs_.end(), same);
            found[i].number = int(known - world_.lightOutputs_.begin());
            if (known == world_.lightOutputs_.end()) world_.lightOutputs_.push_back(places[i]);
            b.lightOutputs.push_back(std::move(found[i]));
        }
    }
    if (b.lightOutputs.empty()) return;
    if (!path_) { // a kernel that waits computes all of them at once, with the same rays
        const BoundKernel alone = world_.kernel(*b.surface, plain, varying, false, path_, diagnostics_);
        if (alone && alone.kernel->facts().suspends) return b.lightOutputs.clear();
    }
    b.inLightOutputs = std::move(inLightOutputs);
    outputs = std::move(plain);
}

bool SurfaceBinder::bindEntering() {
    for (size_t i = 0; i < world_.bindings_.size(); ++i) bindEntering(world_.bindings_[i], asked_[i].varying);
    return true;
}

void SurfaceBinder::bindEntering(SurfaceBinding& b, const Names& varying) {
    const auto says = [](const SiteInfo& s) { return s.kind == SiteKind::Subsurface && s.text.count(rsl::kPairEntering) > 0; };
    const auto site = std::find_if(b.surfaceS.sites.begin(), b.surfaceS.sites.end(), says);
    if (site == b.surfaceS.sites.end()) return;
    Names outputs{rsl::kEntering, rsl::OutputName::given(rsl::kEntering).text()};
    for (const std::string& name : outputsOf(b))
        if (rsl::OutputName::parse(name).parameter) outputs.push_back(name); // lights query it
    b.entering = world_.kernel(*b.surface, outputs, varying, true, path_, diagnostics_, rsl::kEntering);
    if (!b.entering || !b.entering.kernel->facts().suspends) return;
    const SourcePlace place = placeOf(*site->site, *b.surfaceS.kernel);
    diagnostics_.reportOnce("entering:" + place.file + std::to_string(place.line),
                            {Severity::Warning,
                             Rie::Unimplement,
                             place,
                             "subsurface(): its \"irradiance\" waits for rays (" + b.entering.kernel->facts().whyNot +
                                 "), so it is not used: the entering light is computed from the lights",
                             "sums and products with what does not depend on light need not wait",
                             {}});
    b.entering = {};
}

LightOutput::Kernel SurfaceBinder::lightKernel(const SurfaceBinding& b, const LightOutput& o, const Names& varying, bool mixed) {
    LightOutput::Kernel k;
    k.bound = world_.kernel(*b.surface, o.outputs, varying, mixed, path_, diagnostics_, o.slot.text());
    if (!k.bound) return k;
    const BoundKernel& main = mixed ? b.surfaceV : b.surfaceS;
    k.main = sameCalls(main, main);
    k.own = sameCalls(k.bound, main);
    if (const auto& direct = k.bound.kernel->facts().direct; !direct.empty())
        diagnostics_.reportOnce(
            "direct:" + b.surface->name + ":" + o.slot.text(),
            {Severity::Warning,
             Rie::NoError,
             b.surface->place,
             "output \"" + o.slot.text() + "\" of shader \"" + b.surface->name + "\" holds only the direct light of " +
                 direct[0].text(),
             "Ci has all of it; sums and products with what does not depend on light give an output its indirect light, too",
             {}});
    return k;
}

} // namespace alpenglow::world
