#include "render/emptyresults.h"
#include "base/printable.h"
#include "scene/scene.h"
#include <algorithm>
#include <fmt/format.h>

namespace alpenglow::render {
namespace {

using Source = OutputVariable::Source;

void warn(Diagnostics& diags, const SourcePlace& place, std::string message, std::string hint) {
    diags.report(Severity::Warning, Rie::MissingData, place, std::move(message), std::move(hint));
}

/// Hint for a camera that sees none of these shapes.
std::string unseenHint(size_t shapes, size_t before) {
    if (shapes == 0) return "the world has no primitives that are drawn";
    const std::string camera = "the camera looks along +z, and requests before WorldBegin place the world before it";
    if (before == 0) return "everything is behind the camera: " + camera + "; Translate 0 0 5, for example, moves it 5 away";
    return "check the camera: " + camera + "; " + counted(before, "shape") + " of " + std::to_string(shapes) +
           (before == 1 ? " lies" : " lie") +
           " before it, outside the picture or hidden from it by Attribute \"visibility\" or Sides 1";
}

} // namespace

void sayMissingOutputs(const OutputPlan& plan, const world::World& world, Diagnostics& diags) {
    const std::vector<std::string> missing = world.missingOutputs();
    if (missing.empty()) return;
    const std::vector<std::string> known = world.knownOutputs();
    std::vector<std::string> reported;
    for (const OutputSpec& s : plan.pictures)
        for (const OutputVariable& v : s.variables) {
            if (v.source != Source::Engine || std::find(missing.begin(), missing.end(), v.name) == missing.end() ||
                std::find(reported.begin(), reported.end(), v.name) != reported.end())
                continue;
            reported.push_back(v.name);
            const std::string near = nearestName(v.name, known);
            warn(diags, s.place, "display \"" + s.name + "\": no shader outputs \"" + v.name + "\"; its channels are 0",
                 near.empty() ? "" : "did you mean \"" + near + "\"?");
        }
}

void sayEmptyClouds(const Job& job, Diagnostics& diags) {
    const Camera& c = job.camera;
    if (job.interrupted || !job.world || c.window().width() < c.width() || c.window().height() < c.height()) return;
    for (const auto& [name, place] : job.world->cloudsFoundEmpty())
        warn(diags, place, "texture3d(): \"" + name + "\" has no point near any lookup position",
             "alpenglow ptc info shows where its points are; \"coordsystem\" must name the space in which they were baked, and "
             "normals must fit");
}

void sayTurnedAway(const Job& job, Diagnostics& diags) {
    if (job.interrupted || !job.world) return;
    for (const world::World::FlippedNormalsCall& f : job.world->callsTurnedAway()) {
        const std::string where =
            f.primitive.line > 0 ? " (" + f.primitive.file + ":" + std::to_string(f.primitive.line) + ")" : "";
        warn(diags, f.call,
             f.shadeop + "(): all over " + (f.primitives == 1 ? "a primitive" : counted(f.primitives, "primitive")) + where +
                 " its normal faces away from the viewer, and " +
                 (f.shadeop == "occlusion" ? "all its rays are blocked: it returns 1" : "the primitive itself blocks its rays"),
             "faceforward(normalize(N), I) is the normal of the side that is seen; ReverseOrientation turns those of the "
             "primitive");
    }
}

void sayOpenMedia(const Job& job, const integrator::Counters& counters, Diagnostics& diags) {
    // Rounding at the edges of a closed surface loses about one ray of a million.
    constexpr uint64_t kFew = 16, kPart = 1000;
    if (job.interrupted || !job.world) return;
    for (size_t i = 0; i < counters.media.size(); ++i) {
        const integrator::MediumSegments& m = counters.media[i];
        if (m.lost < kFew || m.lost < m.all / kPart) continue;
        const world::World::NamedMedium medium = job.world->medium(i);
        diags.report(
            Severity::Warning, Rie::Consistency, medium.place,
            fmt::format("{} of {} rays in the medium \"{}\" leave the scene: the primitive whose Interior or Exterior it is "
                        "does not enclose it; these rays see no medium",
                        m.lost, m.all, medium.shader),
            "close the surface: a medium extends from a surface to the next one behind it");
    }
}

void sayEmptyPicture(const Job& job, const scene::Frame& frame, Diagnostics& diags) {
    const Camera& c = job.camera;
    if (job.interrupted || job.shone || !job.world || !job.plan.needs(Source::Ci) || c.window().width() < c.width() ||
        c.window().height() < c.height())
        return;
    const world::World::Facts facts = job.world->facts();
    if (!job.met && frame.options.imager) return; // it may paint the complete picture
    if (!job.met) {
        warn(diags, {}, "the picture is empty: the camera sees nothing of the scene", unseenHint(facts.shapes, facts.before));
        return;
    }
    const size_t lights = frame.lights.size();
    if (lights == 0)
        warn(diags, {}, "the picture is black: the scene has no lights",
             "LightSource \"pointlight\" 1 \"from\" [0 0 0] \"intensity\" 10, for example, before the primitives");
    else
        warn(diags, {},
             "the picture is black: surfaces are seen, but " +
                 (lights == 1 ? "the light does" : "the " + counted(lights, "light") + " do") + " not show on them",
             "check that the lights are on where the surfaces are made (AttributeEnd ends a light), that they reach them, that "
             "normals which primitives give lie on the sides that are seen (a warning names primitives with many that do not, -v "
             "those with few), and what the shaders do with their light");
}

} // namespace alpenglow::render
