// Requests of later renderers (PRMan 13 on, Aqsis; those of RIS are in ris.cpp): recognised so that the rest of their
// files renders. Requests with an equivalent here take effect; each of the others is reported once.
#include "ri/interpreter.h"
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

void notDone(Interpreter& in, const Call& c) { in.incapable(c, fmt::format("{} is not done by this version", c.request->name)); }

/// A volume primitive shader: the volume shader of the primitive.
template <scene::ShaderRef scene::Attributes::* Slot> void volumeShader(Interpreter& in, const Call& c) {
    in.attributes().*Slot = c.text(0).empty() || c.text(0) == "null" ? nullptr : in.shader(c);
}

/// The layers of a type run one after the other, so the last one leaves its result: it is the shader of the primitive.
void layer(Interpreter& in, const Call& c) {
    using A = scene::Attributes;
    constexpr std::pair<std::string_view, scene::ShaderRef A::*> kSlots[] = {
        {"surface", &A::surface},   {"displacement", &A::displacement}, {"atmosphere", &A::atmosphere},
        {"volume", &A::atmosphere}, {"interior", &A::interior},         {"exterior", &A::exterior}};
    for (const auto& [type, slot] : kSlots)
        if (c.text(0) == type) {
            Call shader = c;
            shader.arguments.erase(shader.arguments.begin());
            in.attributes().*slot = in.shader(shader);
            return;
        }
    in.reporter.error(Rie::BadToken, c.place, fmt::format("ShaderLayer: \"{}\" is not known", c.text(0)),
                      "surface, displacement, atmosphere, interior or exterior");
}

void connectLayers(Interpreter& in, const Call& c) {
    in.incapable(
        c, fmt::format("layers of shaders are not connected by this version: \"{}\" of the layer \"{}\" keeps its own value; "
                       "a co-shader (Shader) can give it",
                       c.text(4), c.text(3)));
}

/// The procedurals by named parameters: "DelayedReadArchive2" and its kin.
void procedural2(Interpreter& in, const Call& c) {
    std::string kind = c.text(0);
    if (kind.size() > 1 && kind.back() == '2') kind.pop_back();
    if (kind != "DelayedReadArchive" && kind != "RunProgram" && kind != "DynamicLoad") {
        in.reporter.error(Rie::BadToken, c.place, fmt::format("Procedural2: \"{}\" is not known", c.text(0)),
                          "DelayedReadArchive2, RunProgram2 or DynamicLoad2");
        return;
    }
    std::string name, data;
    std::vector<float> bound;
    for (const scene::Param& p : in.bind(c, Use::Other)) {
        const bool text = !p.strings.empty();
        if (text && (p.name == "filename" || p.name == "command" || p.name == "program" || p.name == "programname" ||
                     p.name == "dsoname"))
            name = p.strings[0];
        else if (text && (p.name == "data" || p.name == "params" || p.name == "string")) data = p.strings[0];
        else if ((p.name == "bound" || p.name == "__bound") && p.numbers.size() == 6) bound = p.numbers;
    }
    if (name.empty() && (kind == "DelayedReadArchive" || in.settings.allowExec)) {
        in.reporter.error(Rie::MissingData, c.place,
                          kind == "DelayedReadArchive" ? "Procedural2: the archive has no \"string filename\""
                                                       : "Procedural2: there is no \"string command\"");
        return;
    }
    in.procedural(kind, {name, data}, bound, c);
}

} // namespace

std::vector<Request> foreignRequests() {
    using A = scene::Attributes;
    const unsigned any = kAnywhere;
    return {
        {"VPAtmosphere", "string name; ..", Kind::Shader, any, true, "Atmosphere under its later name.", "\"fog\"",
         volumeShader<&A::atmosphere>},
        {"VPInterior", "string name; ..", Kind::Shader, any, true, "Interior under its later name.", "\"fog\"",
         volumeShader<&A::interior>},
        {"VPSurface", "string name; ..", Kind::Shader, any, true, "The shader at the bound of a volume: not done.", "\"fog\"",
         notDone},
        {"ShaderLayer", "string type; string name; string layer; ..", Kind::Shader, any, false,
         "A layer of a shader network (Aqsis, 3Delight). The last one of a type is the shader of what follows.",
         "\"surface\" \"plastic\" \"base\" \"Kd\" .4", layer},
        {"ConnectShaderLayers", "string type; string layer1; string variable1; string layer2; string variable2", Kind::Shader,
         any, false, "Connects two layers of a shader network (Aqsis, 3Delight): not done.",
         "\"surface\" \"a\" \"Ci\" \"b\" \"Cs\"", connectLayers},
        {"Procedural2", "string subdivide; string bound; ..", Kind::Primitive, kWorld | kObject, false,
         "Content from an archive (\"DelayedReadArchive2\"), by named parameters, or with --allow-exec from a program "
         "(\"RunProgram2\": \"string command\", \"string data\") or a library (\"DynamicLoad2\": \"string dsoname\", \"string "
         "data\").",
         "\"RunProgram2\" \"SimpleBound\" \"float[6] bound\" [-1 1 -1 1 -1 1]", procedural2},
        {"PixelSampleImager", "string name; ..", Kind::Other, any, false, "An imager for samples: not done.", "\"bg\"", notDone},
    };
}

} // namespace alpenglow::ri
