// First half of the affine proof: which values depend on ray and light results, and where that is not affine.
#pragma once
#include "rsl/ir/ir.h"
#include <map>
#include <string>

namespace alpenglow::rsl::ir {

struct Dependence {
    /// By instruction id: bit (site % 64) of every Request the value depends on. 0: independent.
    std::vector<uint64_t> sites;
    /// Requests used in a way that is not affine, with the first reason.
    std::map<int, std::string> bad;
    uint64_t of(const Inst* i) const { return i->id < sites.size() ? sites[i->id] : 0; }
};

/// Either form.
Dependence analyseDependence(const Kernel&);

/// The same for one input instead of Requests: values that depend on it have bits set; `bad`, when not empty, says at key -1 why the
/// kernel is not affine in it. Long form, for kernels without Requests.
Dependence analyseInput(const Kernel&, const std::string& input);

/// Runtime calls that are affine in their first two arguments: mix.
bool isMix(const Inst*);

} // namespace alpenglow::rsl::ir
