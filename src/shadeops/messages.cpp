// Message passing and information: rsl.md 11.1 (seed 6.4.8). Values live in the renderer; here are the signatures.
#include "shadeops/describe.h"

namespace alpenglow::rsl {
namespace {

constexpr uint32_t kNoImager = kSurface | kDisplacement | kVolume | kLight;

/// "T name(string what; output T value)" for every type, arrays too.
std::vector<Signature> query(const std::string& name, const std::string& head = "string name") {
    return each(kAllTypes, "float " + name + "(" + head + "; output $ value)") + each(kAllTypes, "float " + name + "(" + head + "; output $ value[])");
}

} // namespace

std::vector<Shadeop> messageShadeops() {
    std::vector<Shadeop> list;
    const auto add = [&](const char* name, std::vector<Signature> signatures, Lowering lowering, uint32_t contexts, const char* doc) -> Shadeop& {
        Shadeop op;
        op.section = "Messages";
        op.source = "seed";
        op.name = name;
        op.signatures = std::move(signatures);
        op.contexts = contexts;
        op.lowering = lowering;
        op.derivative = DerivativeRule::ZeroWarn;
        op.pure = false; // what a message brings may change while the shader runs
        op.doc = doc;
        list.push_back(std::move(op));
        return list.back();
    };
    const std::string tail = " 1 on success; 0, and value untouched, when the shader or the parameter is missing or the type does not fit.";
    const auto message = [&](const char* name, Lowering lowering, uint32_t contexts, const std::string& doc) {
        add(name, query(name), lowering, contexts, (doc + tail).c_str());
    };
    message("surface", Lowering::Service, kNoImager, "Parameter of the surface shader of the primitive being shaded.");
    message("displacement", Lowering::Service, kNoImager, "Parameter of the displacement shader of the primitive being shaded.");
    message("atmosphere", Lowering::Service, kNoImager, "Parameter of the atmosphere shader of the primitive being shaded.");
    message("lightsource", Lowering::Service, kSurface | kVolume, "Parameter of the light of the current turn; only inside illuminance.");
    message("incident", Lowering::Service, kSurface,
            "Parameter of the volume shader on the side of the incident ray: Exterior, or Interior for a ray that meets the surface from inside.");
    message("opposite", Lowering::Service, kSurface, "Parameter of the volume shader on the other side of the surface than the incident ray.");
    message("attribute", Lowering::Service, kAnyContext,
            "Attribute of the primitive (\"class:name\", \"Ri:...\", \"user:...\"); with \"light:\" in front, inside illuminance, of the light.");
    message("option", Lowering::Service, kAnyContext, "Option of the frame.");
    message("rendererinfo", Lowering::Service, kAnyContext, "\"renderer\" string, \"version\" float[4], \"versionstring\" string.");
    message("rayinfo", Lowering::Service, kNoImager,
            "About the ray that hit the point: \"type\" string (camera, specular, diffuse, transmission, light, subsurface), \"depth\", \"speculardepth\", "
            "\"diffusedepth\" float, \"label\" string, \"origin\" point, \"direction\" vector, \"length\" float.");
    Shadeop& textureinfo = add("textureinfo", query("textureinfo", "string texture, string field"), Lowering::Service, kAnyContext,
                               "About a texture: \"resolution\" float[2], \"type\" string, \"channels\" float, \"viewingmatrix\" and \"projectionmatrix\" matrix; "
                               "\"exists\" with a literal 0 as value: 1 if the file is there and valid.");
    textureinfo.signatures = textureinfo.signatures + sigs({{"float textureinfo(string texture, string field; float none)"}});
    const auto rayFunction = [&](const char* name, const char* doc) {
        add(name, sigs({{(std::string("float ") + name + "()").c_str()}}), Lowering::Service, kSurface | kVolume, doc);
    };
    rayFunction("raylevel", "Depth of the ray. Deprecated: rayinfo(\"depth\").");
    rayFunction("isindirectray", "1 for indirect rays. Deprecated: rayinfo(\"type\").");
    rayFunction("isshadowray", "1 for shadow rays. Deprecated: rayinfo(\"type\").");
    add("isoutput", each(kAllTypes, "float isoutput($ variable)") + each(kAllTypes, "float isoutput($ variable[])"), Lowering::Special, kAnyContext,
        "1 if the variable, or the one of that name (\"outputs[1]\" too), is an output that a display asks for.");
    add("outputchannel", each("float color point vector normal matrix", "void outputchannel(uniform string name; $ value)"), Lowering::Special,
        kAnyContext,
        "Creates an output of the main shader, zero where no call gives it a value, or assigns one that exists. Nothing is done when the types do not "
        "agree. In a co-shader or a light \"light:\" or \"local:\" before the name keep it there, out of sight of displays.");
    add("gridmin", sigs({{"float gridmin(float value)"}, {"void gridmin(float value)"}}), Lowering::Special, kNoImager,
        "Smallest value over the grid. A hit is a grid of one point: the value minus half its footprint.");
    add("gridmax", sigs({{"float gridmax(float value)"}, {"void gridmax(float value)"}}), Lowering::Special, kNoImager,
        "Largest value over the grid: the value plus half its footprint.");
    add("getshader", sigs({{"shader getshader(string handle)"}}), Lowering::Special, kNoImager, "Co-shader by its handle; null if absent.");
    add("getshaders", sigs({{"shader[] getshaders(pairs)"}}), Lowering::Special, kAnyContext, "All co-shaders, or those of a category.").optional = {
        {{Base::String, 0}, "category", false, "\"\"", "names of categories"}};
    add("getlight", sigs({{"shader getlight(string handle)"}}), Lowering::Special, kSurface | kVolume,
        "Light by its handle; null if it does not light the surface.");
    add("getlights", sigs({{"shader[] getlights(pairs)"}}), Lowering::Special, kSurface | kVolume,
        "The active lights, or those of a category; each handle->light(L, Cl [, Ol]) gives one sample of its light at P, L from the light to the surface.")
        .optional = {{{Base::String, 0}, "category", false, "\"\"", "\"a\", \"-a\", \"a|b\", \"a&b\", \"a,b\", with parentheses"}};
    add("getvar", sigs({{"float getvar(shader handle; string name)"}}) + each(kAllTypes, "float getvar(shader handle; string name; output $ value)"),
        Lowering::Special, kAnyContext, "Member variable of a co-shader; null handle: the primitive's variables. 1 if found.");
    add("hasmethod", sigs({{"float hasmethod(shader handle; string name)"}}), Lowering::Special, kAnyContext,
        "1 if others may call a method of that name of the shader, which the handle stands for; 0 for null. A light has the method light().")
        .source = "PRMan";
    add("readprimvar", each(kAllTypes, "float readprimvar(string name; output $ value)"), Lowering::Special, kAnyContext,
        "Variable of the primitive: getvar(null, name, value). 1 if found; else 0, and value is untouched.")
        .source = "PRMan";
    add("writeaov", each("float color point vector normal matrix", "void writeaov(string name; $ value)"), Lowering::Special, kAnyContext,
        "outputchannel(name, value), for a name that may be made when the shader runs: where it is not written out it must be that of an output that there is.")
        .source = "PRMan";
    add("readaov", each("float color point vector normal matrix", "float readaov(string name; output $ value)"), Lowering::Special, kAnyContext,
        "What an output of the shader has been given so far, by its name. 1 if there is one of that type; else 0, and value is untouched.")
        .source = "PRMan";
    add("islightcategory", sigs({{"float islightcategory(string category)"}}), Lowering::Special, kSurface | kVolume,
        "1 if the light of this turn of illuminance belongs to the category, as illuminance has them.").source = "seen in 3Delight shaders";
    add("shadername", sigs({{"string shadername()"}, {"string shadername(string type)"}}), Lowering::Service, kAnyContext, "Name of the shader attached.")
        .source = "(k)";
    return list;
}

std::vector<Shadeop> arrayShadeops() {
    std::vector<Shadeop> list;
    const auto add = [&](const char* name, std::vector<Signature> signatures, Lowering lowering, const char* doc) {
        Shadeop op;
        op.section = "Arrays";
        op.source = "seed";
        op.name = name;
        op.signatures = std::move(signatures);
        op.lowering = lowering;
        op.derivative = lowering == Lowering::Special ? DerivativeRule::Zero : DerivativeRule::ZeroWarn;
        op.pure = lowering == Lowering::Special;
        op.doc = doc;
        list.push_back(std::move(op));
    };
    add("arraylength", each(kAllTypes, "float arraylength($ a[])"), Lowering::Special, "Number of elements.");
    add("resize", each(kAllTypes, "void resize(output $ a[]; uniform float length)"), Lowering::Special, "Sets the length; new elements are undefined.");
    add("reserve", each(kAllTypes, "void reserve(output $ a[]; uniform float length)"), Lowering::Special, "Sets the capacity.");
    add("push", each(kAllTypes, "void push(output $ a[]; $ value)"), Lowering::Special, "Appends a value.");
    add("pop", each(kAllTypes, "$ pop(output $ a[])"), Lowering::Special, "Removes and returns the last element.");
    add("capacity", each(kAllTypes, "float capacity($ a[])"), Lowering::Special, "Elements that fit without new memory.");
    return list;
}

} // namespace alpenglow::rsl
