#include "cli/ball.h"
#include "base/installation.h"
#include "cli/command.h"
#include "cli/ribtext.h"
#include "render/renderer.h"
#include "ri/reader.h"
#include <algorithm>
#include <fmt/format.h>

namespace alpenglow::cli {
namespace {

/// "name" and the parameters, as a shader request has them.
std::string call(const std::string& request, const BallSettings& b, const std::string& handle = "") {
    std::string t = request + " " + ribString(b.shader) + handle;
    for (const rsl::ParameterValue& v : b.given) {
        const size_t count = std::max(v.strings.size(), v.numbers.size() / size_t(shadeops::componentCount(v.type.base)));
        t += fmt::format(" \"uniform {}{} {}\" [", shadeops::toString(v.type.element()),
                         v.type.array ? "[" + std::to_string(count) + "]" : "", v.name);
        for (const std::string& s : v.strings) t += ribString(s) + " ";
        for (const float f : v.numbers) t += fmt::format("{} ", f);
        t += "]";
    }
    return t + "\n";
}

/// A checkered floor of y = -1, a polygon a square: it needs no shader that does not ship.
std::string floorRequests() {
    std::string t = "AttributeBegin Surface \"matte\"\n";
    for (int z = -8; z < 16; ++z)
        for (int x = -8; x < 8; ++x)
            t += fmt::format("Color {} Polygon \"P\" [{} -1 {}  {} -1 {}  {} -1 {}  {} -1 {}]\n",
                             (x + z) % 2 ? "[0.08 0.08 0.08]" : "[0.68 0.65 0.61]", x, z, x, z + 1, x + 1, z + 1, x + 1, z);
    return t + "AttributeEnd\n";
}

} // namespace

std::string ballScene(const BallSettings& b) {
    using Kind = rsl::ShaderKind;
    const auto ifKind = [&](Kind k, const std::string& text, const std::string& otherwise = "") {
        return b.kind == k ? text : otherwise;
    };
    std::string t = fmt::format("Format {} {} 1\nProjection \"perspective\" \"fov\" 27\nHider \"path\"\n", b.width, b.height);
    t += ifKind(Kind::Imager, call("Imager", b));
    t += "Translate 0 -0.02 5.4\nRotate -17 1 0 0\nWorldBegin\n"
         "LightSource \"envlight\" \"sky\" \"float intensity\" 0.4 \"color lightcolor\" [0.85 0.92 1]\n"
         // The lamp above on the left looks at the ball along +z of its space.
         "TransformBegin ConcatTransform [0.8 0 -0.6 0  0.37482 0.78087 0.49976 0  0.46852 -0.6247 0.6247 0  -3 4 -4 1]\n";
    t += ifKind(Kind::Light, call("LightSource", b, " \"key\""),
                "LightSource \"pointlight\" \"key\" \"float intensity\" 38 \"color lightcolor\" [1 0.96 0.88]\n");
    t += "TransformEnd\n" + ifKind(Kind::Volume, call("Atmosphere", b)) + floorRequests();
    t += "AttributeBegin Sides 2 Surface \"plastic\" \"float Ks\" 0.3 Color [1 1 1]\n"
         "Rotate -35 0 1 0 Rotate -90 1 0 0\n"; // z of "shader" space is up
    t += ifKind(Kind::Surface, call("Surface", b));
    t += ifKind(Kind::Displacement,
                "Color [0.8 0.55 0.3] Attribute \"displacementbound\" \"float sphere\" [0.4]\n" + call("Displacement", b));
    return t + "Sphere 1 -1 1 360\nAttributeEnd\nWorldEnd\n";
}

int shadeBall(const BallSettings& b, Diagnostics& diags) {
    render::RenderSettings s;
    s.output = b.output;
    s.spp = uint32_t(std::max(0, b.spp));
    s.lanes = b.lanes;
    if (b.gamma > 0) s.gamma = b.gamma;
    s.texturePaths = {"."};
    s.texturePaths.insert(s.texturePaths.end(), b.searchPaths.begin(), b.searchPaths.end());
    s.shaderPaths = s.texturePaths;
    for (std::string& f : environmentShaders()) s.shaderPaths.push_back(std::move(f));
    s.shippedShaders = shippedShaders();
    s.dialect = b.dialect;
    s.allowExec = b.allowExec;
    s.allowRead = true; // the user named the shader and its maps
    s.stop = watchInterrupts();
    render::Progress progress(render::ProgressMode::None);
    render::Renderer renderer(s, render::transportEngine(), diags, progress, {});
    ri::ReaderOptions o;
    o.stop = s.stop;
    ri::RibReader(o, renderer, diags).readMemory(ballScene(b), "ball");
    const auto& outcome = renderer.outcome();
    if (outcome.interrupted) return kInterrupted;
    if (outcome.outputFailed) return kOutputFailed;
    if (outcome.outOfMemory) return kLimit;
    if (outcome.rendered == 0) return kNothingRendered;
    return diags.errors() ? kDoneWithErrors : kDone;
}

} // namespace alpenglow::cli
