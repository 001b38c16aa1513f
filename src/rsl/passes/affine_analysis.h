// First half of the affine proof: which values depend on ray and light results, and where that is not affine.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"
#include "rsl/passes/siteset.h"
#include <map>
#include <string>

namespace alpenglow::rsl::passes {

/// What the analysis has found of one kernel.
struct Dependence {
    /// By instruction id: the Requests that the value depends on, by ordinal. Empty: independent.
    std::vector<SiteSet> sites;
    /// By site: the number of the Request there among the sites with Requests; -1: there is none.
    std::vector<int> ordinals;
    /// Requests used in a way that is not affine, with the first reason.
    std::map<int, std::string> bad;
    /// By instruction id, of floats: bits 0 to 2, the components that the value was made of; bit 3, the float result of a
    /// Request.
    std::vector<uint8_t> channels;
    static constexpr uint8_t kGrey = 8;
    /// The Requests that a value depends on.
    const SiteSet& of(const Inst* i) const {
        static const SiteSet none;
        return i->id < sites.size() ? sites[i->id] : none;
    }
    /// The number of a Request in a SiteSet.
    size_t ordinal(const Inst* request) const { return static_cast<size_t>(ordinals[static_cast<size_t>(request->site)]); }
};

/// Either form.
Dependence analyseDependence(const Kernel&);

/// The same for one input instead of Requests: values that depend on it have a member; `bad`, when not empty, says at key -1 why
/// the kernel is not affine in it. Long form, for kernels without Requests.
Dependence analyseInput(const Kernel&, const std::string& input);

/// Runtime calls that are affine in their first two arguments: mix.
bool isMix(const Inst*);

} // namespace alpenglow::rsl::passes
