// Requests of PRMan 21 and later (RIS): materials, patterns, lights, integrators (docs/ris.md).
#include "ri/interpreter.h"
#include <algorithm>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

bool none(const Call& c) { return c.text(0).empty() || c.text(0) == "null"; }

void bxdf(Interpreter& in, const Call& c) {
    in.isRis();
    if (c.text(0) == "PxrVolume") { // what is inside, behind a surface that is not seen
        scene::ShaderRef s = in.network(c, scene::Keeper::Interior);
        scene::Attributes& a = in.attributes();
        a.interior = std::move(s);
        return in.expand("Surface \"null\"", c);
    }
    scene::ShaderRef s = none(c) ? nullptr : in.network(c, scene::Keeper::Surface);
    in.attributes().surface = std::move(s);
}

void displace(Interpreter& in, const Call& c) {
    scene::ShaderRef s = none(c) ? nullptr : in.network(c, scene::Keeper::Displacement);
    in.attributes().displacement = std::move(s);
}

/// What PxrPathTracer calls a path has so many rays behind the first.
void depth(Interpreter& in, const Call& c, float bounces) {
    scene::Param p;
    p.name = "maxdepth";
    p.numbers = {bounces};
    p.place = c.place;
    in.options.values["trace:maxdepth"] = std::move(p);
}

void integrator(Interpreter& in, const Call& c) {
    in.isRis();
    const std::string& name = c.text(0);
    const scene::ParamList given = in.bind(c, Use::Other);
    const auto number = [&](const char* what) -> std::optional<float> {
        const scene::Param* p = scene::find(given, what);
        return p && !p->numbers.empty() ? std::optional(p->numbers[0]) : std::nullopt;
    };
    in.integratorSurface(nullptr);
    in.headlight(name == "PxrDefault");
    const bool follows = name == "PxrPathTracer" || name == "PxrVCM" || name == "PxrUnified" || name == "PxrUPBP" ||
                         name == "PxrDefault" || name == "PxrUnidirectional" || name == "PxrBakeTexture";
    if (name == "PxrVCM" || name == "PxrUPBP")
        in.reporter.once("ri:integrator:" + name, Severity::Info, Rie::Incapable, c.place,
                         name + " is drawn by path: what it merges, path samples in other ways");
    std::optional<float> longest = number("maxPathLength");
    if (!longest) longest = number("maxIndirectBounces");
    if (follows) {
        if (longest && *longest >= 0) depth(in, c, *longest);
    } else if (name == "PxrDirectLighting" || name == "PxrDirectlighting") {
        depth(in, c, 1);
    } else if (name == "PxrOcclusion" || name == "PxrVisualizer") { // one shader for all that there is
        in.integratorSurface(in.shader(c));
    } else {
        in.reporter.once(
            "ri:integrator:" + name, Severity::Warning, Rie::Incapable, c.place,
            fmt::format("there is no integrator \"{}\": the picture is drawn by path", name),
            "PxrPathTracer, PxrVCM, PxrUnified, PxrDirectLighting, PxrOcclusion, PxrVisualizer and PxrDefault are known");
    }
}

/// What changes pictures afterwards.
void leftOut(Interpreter& in, const Call& c) {
    in.isRis();
    in.reporter.once(fmt::format("ri:{}:{}", c.request->name, c.text(0)), Severity::Warning, Rie::Incapable, c.place,
                     fmt::format("{} \"{}\" is left out: the picture is drawn without it", c.request->name, c.text(0)));
}

/// PxrCryptomatte writes a picture in addition to those of the displays.
void sampleFilter(Interpreter& in, const Call& c) {
    if (c.text(0) != "PxrCryptomatte") return leftOut(in, c);
    in.isRis();
    scene::Display d;
    d.type = "cryptomatte";
    d.place = c.place;
    d.params = in.bind(c, Use::Other);
    const scene::Param* file = scene::find(d.params, "filename");
    d.name = file && !file->strings.empty() ? file->strings[0] : "";
    std::erase_if(d.params, [](const scene::Param& p) { return p.name == "filename"; });
    if (d.name.empty())
        return in.reporter.error(Rie::MissingData, c.place, "PxrCryptomatte has no file: no matte is written",
                                 "\"string filename\" [\"matte.exr\"]");
    in.options.mattes[c.text(1)] = std::move(d);
}

} // namespace

std::vector<Request> risRequests() {
    const unsigned any = kAnywhere;
    const char* named = "string name; handle handle; ..";
    return {
        {"Bxdf", named, Kind::Shader, any, false,
         "The material: the surface shader of that name (docs/ris.md). \"reference type parameter\" [\"handle:output\"] takes an "
         "output of a Pattern, as its handle means now.",
         "\"PxrDiffuse\" \"b\" \"color diffuseColor\" [.5 .4 .3]", bxdf},
        {"Displace", named, Kind::Shader, any, false, "The displacement of what follows, with its connections as Bxdf has them.",
         "\"PxrDisplace\" \"d\" \"float dispAmount\" .1", displace},
        {"Pattern", named, Kind::Shader, any, false,
         "A shader whose outputs parameters of Bxdf, Displace and other patterns take: one for its handle, in place of an "
         "earlier.",
         "\"PxrChecker\" \"t\" \"color colorA\" [1 0 0]", [](Interpreter& in, const Call& c) { in.pattern(c); }},
        {"Light", named, Kind::Light, any, false,
         "A light that is on everywhere, also behind its AttributeEnd: one across, shining along +z.",
         "\"PxrRectLight\" \"l\" \"float intensity\" 2", [](Interpreter& in, const Call& c) { in.risLight(c); }},
        {"LightFilter", named, Kind::Light, any, false,
         "A filter of the lights that follow, up to the AttributeEnd: what it lets through (docs/ris.md).",
         "\"PxrRodLightFilter\" \"f\" \"float edge\" .1", [](Interpreter& in, const Call& c) { in.lightFilter(c); }},
        {"EnableLightFilter", "string light; string filter; int on", Kind::Light, any, false,
         "Whether a filter of a light acts on the light that the primitives that follow receive, whatever its groups.",
         "\"l\" \"f\" 1", [](Interpreter& in, const Call& c) { in.enableFilter(c); }},
        {"Integrator", named, Kind::Other, any, false,
         "How light is followed: by path, with the settings that it has, too; direct light, occlusion, or what surfaces are.",
         "\"PxrPathTracer\" \"i\" \"int maxPathLength\" 6", integrator},
        {"DisplayFilter", named, Kind::Other, any, false, "A filter of pictures: said once and left out.", "\"PxrGrade\" \"g\"",
         leftOut},
        {"SampleFilter", named, Kind::Other, any, false,
         "\"PxrCryptomatte\" writes ids and coverages of objects into a picture of its own, as Display \"cryptomatte\"; other "
         "sample filters are reported once and ignored.",
         "\"PxrCryptomatte\" \"c\" \"string filename\" [\"matte.exr\"] \"string layer\" [\"identifier:name\"]", sampleFilter},
    };
}

} // namespace alpenglow::ri
