// Shader calls and lights (RISpec 3.2, 4.2).
#include "ri/interpreter.h"
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

template <scene::ShaderRef scene::Attributes::* Slot> void slot(Interpreter& in, const Call& c) {
    bool none = c.text(0).empty() || (c.text(0) == "null" && Slot != &scene::Attributes::surface);
    scene::ShaderRef s = none ? nullptr : in.shader(c);
    in.attributes().*Slot = std::move(s);
}

void coshader(Interpreter& in, const Call& c) {
    scene::ShaderRef s = in.shader(c);
    in.attributes().coshaders[c.text(1)] = std::move(s);
}

} // namespace

std::vector<Request> shaderRequests() {
    using A = scene::Attributes;
    const unsigned s = kAnywhere;
    const Kind k = Kind::Shader;
    return {
        {"Surface", "string name; ..", k, s, true, "Surface shader.", "\"plastic\" \"Kd\" .4 \"specularcolor\" [1 1 1]",
         slot<&A::surface>},
        {"Displacement", "string name; ..", k, s, true, "Displacement shader.", "\"bumpy\" \"amplitude\" .1",
         slot<&A::displacement>},
        {"Atmosphere", "string name; ..", k, s, true, "Volume shader between camera and surface.", "\"fog\" \"distance\" 5",
         slot<&A::atmosphere>},
        {"Interior", "string name; ..", k, s, true, "Volume shader inside the object.", "\"fog\"", slot<&A::interior>},
        {"Exterior", "string name; ..", k, s, true, "Volume shader outside the object.", "\"fog\"", slot<&A::exterior>},
        {"Shader", "string name; string handle; ..", k, s, true,
         "Adds a co-shader under a handle, or replaces the one of that handle.", "\"layer\" \"base\" \"uniform float gain\" 2",
         coshader},
        {"LightSource", "string name; handle light; ..", Kind::Light, s, true,
         "Adds a light, switched on up to the end of the attribute block.", "\"pointlight\" 1 \"intensity\" 10 \"from\" [0 1 0]",
         [](Interpreter& in, const Call& c) { in.light(c, false); }},
        {"AreaLightSource", "string name; handle light; ..", Kind::Light, s, true,
         "The primitives that follow in this attribute block are a light.", "\"arealight\" \"lamp\" \"intensity\" [5]",
         [](Interpreter& in, const Call& c) { in.light(c, true); }},
        {"Illuminate", "handle light; int on", Kind::Light, s, false, "Switches a light on or off.", "1 0",
         [](Interpreter& in, const Call& c) { in.illuminate(c); }},
    };
}

} // namespace alpenglow::ri
