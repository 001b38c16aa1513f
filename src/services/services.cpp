#include "services/services.h"

namespace alpenglow::services {

Services::Services(const WorldImpl& world, Diagnostics& d, LightEvaluator* lights, bool building)
    : world_(&world), diagnostics_(d), lightEvaluator_(lights), building_(building), seed_(world.settings().seed),
      noSample_(Sampler(seed_, 0, 0), 0) {}

void KernelRun::forget() {
    bound = nullptr;
    binding = nullptr;
    rays.clear();
    bindings.clear();
    light = nullptr;
    lit = nullptr;
    volume = nullptr;
    lightOutput = nullptr;
    subsurface = between = again = dark = forShadow = false;
    displaced.reset();
    for (LightLoop& loop : loops) loop.reset(-1);
    ambient.clear();
    for (LightSheet& sheet : sheets) sheet.made = sheet.refused = false;
    draws.clear();
    spilled.clear();
    lightChannels.clear();
    lightReach.clear();
    gathers.clear();
}

ServiceCall::ServiceCall(KernelRun& context, Diagnostics& reported, int number, int firstPoint, uint64_t points, int width,
                         const float* arguments, float* results)

    : c(context), diagnostics(reported), s(context.bound->sites[size_t(number)]), d(*s.site), site(number), first(firstPoint),
      lanes(width), mask(points), in(arguments), out(results) {
    for (int r = 0; r < s.resultRowCount; ++r)
        for (int lane = 0; lane < lanes; ++lane)
            if (mask >> lane & 1) put(r, lane, 0);
}

std::string ServiceCall::name(int lane) const {
    if (!d.strings.empty() && !d.strings[0].empty()) return d.strings[0];
    return d.argKinds.empty() || d.argKinds[0] != rsl::ir::Kind::String
               ? std::string()
               : rsl::internedString(std::bit_cast<int32_t>(at(0, lane)));
}

int32_t ServiceCall::nameId(int lane) const {
    if (s.nameId) return s.nameId;
    return d.argKinds.empty() || d.argKinds[0] != rsl::ir::Kind::String ? 0 : std::bit_cast<int32_t>(at(0, lane));
}

SourcePlace ServiceCall::place() const {
    const auto& files = c.bound->kernel->files();
    return {d.place.file < int(files.size()) ? files[size_t(d.place.file)] : "", d.place.line, d.place.column};
}

const SurfaceBinding* ServiceCall::binding(const WorldImpl& world, int lane) const {
    if (c.lit) return c.lit->binding(first + lane);
    return c.bindings.empty() ? c.binding : &world.bindings()[size_t(c.bindings[size_t(first + lane)])];
}

void ServiceCall::answer(int lane, const ShaderValue& t) const {
    using rsl::ir::Kind;
    if (d.resultKinds.size() < 2) return; // only its presence was queried
    const bool open = s.open, array = s.array;
    const size_t before = open ? 2 : 1;                             // rows
    if (open && d.resultKinds.size() == before && t.elements > 0) { // only its length was queried
        put(1, lane, float(t.elements));
        put(0, lane, 1);
    }
    if (d.resultKinds.size() <= before) return;
    const Kind wanted = d.resultKinds[before];
    if (t.kind && (*t.kind != wanted || (t.elements > 0) != array)) return;
    if (t.varying && wanted != Kind::String && s.uniform) {
        const SourcePlace at = place();
        diagnostics.reportOnce("uniform:" + at.file + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ":" +
                                   name(lane),
                               {Severity::Warning,
                                Rie::Consistency,
                                at,
                                d.op + "(): \"" + name(lane) +
                                    "\" is varying and the destination is uniform: it is not changed, and the result is 0",
                                "a varying variable takes it",
                                {}});
        return;
    }
    const size_t size = size_t(rsl::ir::components(wanted)), rows = size_t(s.resultRowCount) - before;
    // A number for a colour, a point or a matrix, as the language converts one.
    if (!t.kind && wanted != Kind::String && !array && size > 1 && rows == size && t.numbers.size() == 1) {
        for (size_t r = 0; r < rows; ++r) put(int(before + r), lane, size == 16 && r % 5 != 0 ? 0 : t.numbers[0]);
        return put(0, lane, 1);
    }
    const size_t have = wanted == Kind::String ? t.texts.size() : t.numbers.size();
    if (!t.kind && (have == 0 || (array ? have % size != 0 : have != rows))) return;
    if (!open && have < rows) return;
    if (open) put(1, lane, float(have / size));
    for (size_t r = 0; r < std::min(rows, have); ++r) {
        if (wanted == Kind::String) putText(int(before + r), lane, t.texts[r]);
        else put(int(before + r), lane, t.numbers[r]);
    }
    put(0, lane, 1);
}

} // namespace alpenglow::services
