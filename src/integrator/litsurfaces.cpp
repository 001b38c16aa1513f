#include "integrator/litsurfaces.h"
#include "integrator/context.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

LitSurfaces::LitSurfaces(const StageSet& s) : Stage(s.context) {}

bool LitValues::output(const std::string& name, std::vector<float>& v) const {
    for (const auto& [known, numbers] : outputs)
        if (known->name.name == name) {
            v = numbers;
            return true;
        }
    return false;
}

LitSurface LitSurfaces::querying(std::span<const int> of) const {
    LitSurface lit;
    lit.binding = [this, of](int q) -> const SurfaceBinding* {
        const int b = of[size_t(q)] < 0 ? -1 : values[size_t(of[size_t(q)])].binding;
        return b < 0 ? nullptr : &world_.bindings()[size_t(b)];
    };
    lit.output = [this, of](int q, const std::string& name, std::vector<float>& v) {
        return of[size_t(q)] >= 0 && values[size_t(of[size_t(q)])].output(name, v);
    };
    lit.displaced = [this, of](int q, int& point) -> const KernelRun* {
        if (of[size_t(q)] < 0) return nullptr;
        point = values[size_t(of[size_t(q)])].point;
        return values[size_t(of[size_t(q)])].displaced.get();
    };
    return lit;
}

void LitSurfaces::tellPoint(ShadePoint& query, int lit) const {
    if (lit < 0) return;
    query.Ns = values[size_t(lit)].N;
    query.viewI = query.I = values[size_t(lit)].I;
}

void LitSurfaces::recordOutputs(LitValues& of, const BatchContext& c, size_t point) const {
    if (c.bound->kernel->facts().suspends) return;
    for (auto& [output, v] : of.outputs) {
        const int o = c.batch->output(output->name);
        for (size_t r = 0; o >= 0 && r < v.size(); ++r) v[r] = c.batch->value(o, int(r), int(point));
    }
}

} // namespace alpenglow::integrator
