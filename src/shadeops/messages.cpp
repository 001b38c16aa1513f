// Message passing and information: 3Delight manual, 6.4.8. Values live in the renderer; here are the signatures.
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
namespace {

constexpr uint32_t kNoImager = kSurface | kDisplacement | kVolume | kLight;

/// "T name(string what; output T value)" for every type, arrays too.
std::vector<Signature> query(const std::string& name, const std::string& head = "string name") {
    return each(kAllTypes, "float " + name + "(" + head + "; output $ value)") +
           each(kAllTypes, "float " + name + "(" + head + "; output $ value[])");
}

/// Adds a shadeop with what most of the section have in common.
Shadeop& addMessage(std::vector<Shadeop>& list, const char* name, std::vector<Signature> signatures, Lowering lowering,
                    uint32_t contexts, const char* doc) {
    Shadeop op;
    op.section = "Messages";
    op.name = name;
    op.source = op.name.starts_with("get") ? "3Delight manual, 6.4.9" : "3Delight manual, 6.4.8"; // co-shaders
    op.signatures = std::move(signatures);
    op.contexts = contexts;
    op.lowering = lowering;
    op.derivative = DerivativeRule::ZeroWarn;
    op.pure = false; // what a message brings may change while the shader runs
    op.doc = doc;
    list.push_back(std::move(op));
    return list.back();
}

/// Adds one that fetches a value of any type by its name.
void addQuery(std::vector<Shadeop>& list, const char* name, Lowering lowering, uint32_t contexts, const std::string& doc) {
    const std::string tail =
        " 1 on success; 0, and value untouched, when the shader or the parameter is missing or the type does not fit.";
    addMessage(list, name, query(name), lowering, contexts, (doc + tail).c_str());
}

/// Adds one about the ray, without arguments.
void addRayFunction(std::vector<Shadeop>& list, const char* name, const char* doc) {
    addMessage(list, name, sigs({{(std::string("float ") + name + "()").c_str()}}), Lowering::Service, kSurface | kVolume, doc)
        .derivative = DerivativeRule::Zero; // a whole number
}

/// Parameters of the shaders about the point.
void addShaderParameters(std::vector<Shadeop>& list) {
    addQuery(list, "surface", Lowering::Service, kNoImager, "Parameter of the surface shader of the primitive being shaded.");
    list.back().examples = {
        {"surface(\"Kd\", x) + x", "1.5", "float x = 0;", "a light asks and the surface shader has a parameter Kd of 0.5"}};
    addQuery(list, "displacement", Lowering::Service, kNoImager,
             "Parameter of the displacement shader of the primitive being shaded.");
    list.back().examples = {
        {"displacement(\"amount\", x) + x", "1.5", "float x = 0;", "the displacement shader has a parameter amount of 0.5"}};
    addQuery(list, "atmosphere", Lowering::Service, kNoImager,
             "Parameter of the atmosphere shader of the primitive being shaded.");
    list.back().examples = {
        {"atmosphere(\"density\", x) + x", "1.5", "float x = 0;", "the volume shader has a parameter density of 0.5"}};
    addQuery(list, "lightsource", Lowering::Service, kSurface | kVolume,
             "Parameter of the light of the current turn; only inside illuminance.");
    list.back().examples = {{"sum", "3", "float x = 0, sum = 0; illuminance(P) sum += lightsource(\"intensity\", x) * x;",
                             "lights of intensity 1 and 2 are on"}};
    addQuery(list, "incident", Lowering::Service, kSurface,
             "Parameter of the volume shader on the side of the incident ray: Exterior, or Interior for a ray that meets the "
             "surface from inside.");
    list.back().examples = {
        {"incident(\"density\", x) + x", "1.5", "float x = 0;", "the volume before the surface has a parameter density of 0.5"}};
    addQuery(list, "opposite", Lowering::Service, kSurface,
             "Parameter of the volume shader on the other side of the surface than the incident ray.");
    list.back().examples = {
        {"opposite(\"density\", x) + x", "1.5", "float x = 0;", "the volume behind the surface has a parameter density of 0.5"}};
}

/// What is known about the primitive, the frame, the ray, and textures.
void addInformation(std::vector<Shadeop>& list) {
    addQuery(list, "attribute", Lowering::Service, kAnyContext,
             "Attribute of the primitive (\"class:name\", \"Ri:...\", \"user:...\"); with \"light:\" in front, inside "
             "illuminance, of the light.");
    list.back().examples = {
        {"attribute(\"user:size\", x) + x", "3", "float x = 0;", "Attribute \"user\" \"float size\" 2 is set"}};
    addQuery(list, "option", Lowering::Service, kAnyContext, "Option of the frame.");
    list.back().examples = {{"option(\"user:size\", x) + x", "3", "float x = 0;", "Option \"user\" \"float size\" 2 is set"}};
    addQuery(list, "rendererinfo", Lowering::Service, kAnyContext,
             "\"renderer\" string, \"version\" float[4], \"versionstring\" string.");
    list.back().examples = {
        {"name", "Alpenglow", "string name = \"\"; rendererinfo(\"renderer\", name);", "a frame is rendered"}};
    addQuery(list, "rayinfo", Lowering::Service, kNoImager,
             "About the ray that hit the point: \"type\" string (camera, specular, diffuse, transmission, light, subsurface), "
             "\"depth\", \"speculardepth\", "
             "\"diffusedepth\" float, \"label\" string, \"origin\" point, \"direction\" vector, \"length\" float, \"weight\" "
             "float: the largest "
             "components of the weights that trace() was given on its way, multiplied.");
    list.back().examples = {{"rayinfo(\"depth\", x) + x", "1", "float x = 0;", "the camera sees the point"}};
    Shadeop& textureinfo = addMessage(
        list, "textureinfo", query("textureinfo", "string texture, string field"), Lowering::Service, kAnyContext,
        "About a texture: \"resolution\" float[2], \"type\" string, \"channels\" float, \"bitsperchannel\" float, \"format\" "
        "string, \"wrapmodes\" string, \"gamma\" float, \"facecount\" float, \"hasalpha\" float (1: it has a channel a); "
        "\"viewingmatrix\" matrix from \"current\" space to the camera of a shadow map, \"projectionmatrix\" to its picture, "
        "x -1..1 and y 1..-1; \"exists\" with a literal 0 as value: 1 if the file is there and valid.");
    list.back().examples = {{"textureinfo(\"none.tex\", \"channels\", x)", "0", "float x = 3;"}};
    textureinfo.derivative = DerivativeRule::Zero; // of a map
    textureinfo.signatures = textureinfo.signatures + sigs({{"float textureinfo(string texture, string field; float none)"}});
    addRayFunction(list, "raylevel", "Depth of the ray. Deprecated: rayinfo(\"depth\").");
    list.back().examples = {{"raylevel()", "0"}};
    addRayFunction(list, "isindirectray", "1 for indirect rays. Deprecated: rayinfo(\"type\").");
    list.back().examples = {{"isindirectray()", "0"}};
    addRayFunction(list, "isshadowray", "1 for shadow rays. Deprecated: rayinfo(\"type\").");
    list.back().examples = {{"isshadowray()", "0"}};
}

/// Outputs of the shader.
void addOutputs(std::vector<Shadeop>& list) {
    addMessage(list, "isoutput", each(kAllTypes, "float isoutput($ variable)") + each(kAllTypes, "float isoutput($ variable[])"),
               Lowering::Special, kAnyContext,
               "1 if the variable, or the one of that name (\"outputs[1]\" too), is an output that a display asks for.");
    list.back().examples = {{"isoutput(\"glow\")", "0"}};
    addMessage(
        list, "outputchannel",
        each("float color point vector normal matrix", "void outputchannel(uniform string name; $ value)") +
            each("float color point vector normal matrix", "void outputchannel(uniform string name; $ value[])"),
        Lowering::Special, kAnyContext,
        "Creates an output of the main shader, zero where no call gives it a value, or assigns one that exists. Nothing is done "
        "when the types do not "
        "agree. In a co-shader or a light \"light:\" or \"local:\" before the name keep it there, out of sight of displays.");
    list.back().examples = {{"x", "2 2 2", "color x = 0; outputchannel(\"glow\", color(2)); readaov(\"glow\", x);"}};
}

/// Bounds over the micropolygon of the point.
void addGridBounds(std::vector<Shadeop>& list) {
    addMessage(
        list, "gridmin", sigs({{"float gridmin(float value)"}, {"void gridmin(float value)"}}), Lowering::Special, kNoImager,
        "Smallest value over the micropolygon of the point, du by dv: minus half of what Du() and Dv() say it changes by.");
    list.back().examples = {{"gridmin(u)", "0"}};
    addMessage(list, "gridmax", sigs({{"float gridmax(float value)"}, {"void gridmax(float value)"}}), Lowering::Special,
               kNoImager, "Largest value over the micropolygon of the point, as gridmin(): plus half of what it changes by.");
    list.back().examples = {{"gridmax(u)", "1"}};
}

/// Shaders and lights by their handles, and their members.
void addHandles(std::vector<Shadeop>& list) {
    addMessage(list, "getshader", sigs({{"shader getshader(string handle)"}}), Lowering::Special, kAnyContext,
               "Co-shader by its handle; null if absent.");
    list.back().examples = {{"(l == null) ? 1 : 0", "1", "shader l = getshader(\"none\");"}};
    addMessage(list, "getshaders", sigs({{"shader[] getshaders(pairs)"}}), Lowering::Special, kAnyContext,
               "All co-shaders, or those of a category.")
        .optional = {{{Base::String, 0}, "category", false, "\"\"", "names of categories"}};
    list.back().examples = {{"arraylength(l)", "0", "shader l[] = getshaders(\"category\", \"layer\");"}};
    addMessage(list, "getlight", sigs({{"shader getlight(string handle)"}}), Lowering::Special, kSurface | kVolume | kLight,
               "Light by its handle; null if it does not light the surface (of a light shader: the one that it lights).");
    list.back().examples = {{"(l == null) ? 1 : 0", "1", "shader l = getlight(\"none\");"}};
    addMessage(
        list, "getlights", sigs({{"shader[] getlights(pairs)"}}), Lowering::Special, kSurface | kVolume | kLight,
        "The active lights, or those of a category; each handle->light(L, Cl [, Ol]) gives one sample of its light at P, L from "
        "the light to the surface. "
        "In a light shader they are those of the surface that it lights; their parameters are there, their methods light() give "
        "nothing.")
        .optional = {
        {{Base::String, 0}, "category", false, "\"\"", "\"a\", \"-a\", \"a|b\", \"a&b\", \"a,b\", with parentheses"}};
    list.back().examples = {{"arraylength(getlights())", "2", "", "two lights are on"}};
    addMessage(list, "getvar",
               sigs({{"float getvar(shader handle; string name)"}}) +
                   each(kAllTypes, "float getvar(shader handle; string name; output $ value)") +
                   each(kAllTypes, "float getvar(shader handle; string name; output $ value[])"),
               Lowering::Special, kAnyContext,
               "Member variable of a co-shader; null handle: the primitive's variables. 1 if found.");
    list.back().examples = {{"x", "3", "float x = 3; getvar(null, \"none\", x);"}};
    addMessage(
        list, "hasmethod", sigs({{"float hasmethod(shader handle; string name)"}}), Lowering::Special, kAnyContext,
        "1 if others may call a method of that name of the shader, which the handle stands for; 0 for null. A light has the "
        "method light().")
        .source = "PRMan";
    list.back().examples = {{"hasmethod(l, \"size\")", "0", "shader l = getshader(\"none\");"}};
}

/// Variables of the primitive and outputs, by names that may be known only when the shader runs.
void addVariablesByName(std::vector<Shadeop>& list) {
    addMessage(list, "readprimvar",
               each(kAllTypes, "float readprimvar(string name; output $ value)") +
                   each(kAllTypes, "float readprimvar(string name; output $ value[])"),
               Lowering::Special, kAnyContext,
               "Variable of the primitive: getvar(null, name, value). 1 if found; else 0, and value is untouched.")
        .source = "PRMan";
    list.back().examples = {{"x", "3", "float x = 3; readprimvar(\"none\", x);"}};
    addMessage(
        list, "writeaov",
        each("float color point vector normal matrix", "void writeaov(string name; $ value)") +
            each("float color point vector normal matrix", "void writeaov(string name; $ value[])"),
        Lowering::Special, kAnyContext,
        "outputchannel(name, value), for a name that may be made when the shader runs: where it is not written out it must be "
        "that of an output that there is.")
        .source = "PRMan";
    list.back().examples = {{"x", "3", "float x = 0; writeaov(\"depths\", 3); readaov(\"depths\", x);"}};
    addMessage(
        list, "readaov",
        each("float color point vector normal matrix", "float readaov(string name; output $ value)") +
            each("float color point vector normal matrix", "float readaov(string name; output $ value[])"),
        Lowering::Special, kAnyContext,
        "What an output of the shader has been given so far, by its name. 1 if there is one of that type; else 0, and value is "
        "untouched.")
        .source = "PRMan";
    list.back().examples = {{"x", "2 2 2", "color x = 0; writeaov(\"glow\", color(2)); readaov(\"glow\", x);"}};
}

/// Names of lights and shaders.
void addNames(std::vector<Shadeop>& list) {
    addMessage(list, "islightcategory", sigs({{"float islightcategory(string category)"}}), Lowering::Special, kSurface | kVolume,
               "1 if the light of this turn of illuminance belongs to the category, as illuminance has them.")
        .source = "shaders of 3Delight";
    list.back().examples = {{"n", "1", "float n = 0; illuminance(P) n += islightcategory(\"key\");",
                             "one light of category key and one of another are on"}};
    addMessage(list, "shadername", sigs({{"string shadername()"}, {"string shadername(string type)"}}), Lowering::Service,
               kAnyContext, "Name of the shader attached.")
        .source = "PRMan";
    list.back().examples = {{"shadername()", "eval"}};
}

/// The derivatives of what is the same all over a primitive are zero.
void setFlatOnes(std::vector<Shadeop>& list) {
    for (Shadeop& op : list) // the same all over a primitive
        for (const char* name : {"attribute", "option", "rendererinfo", "shadername"})
            if (op.name == name) op.derivative = DerivativeRule::Zero;
}

} // namespace

std::vector<Shadeop> messageShadeops() {
    std::vector<Shadeop> list;
    addShaderParameters(list);
    addInformation(list);
    addOutputs(list);
    addGridBounds(list);
    addHandles(list);
    addVariablesByName(list);
    addNames(list);
    setFlatOnes(list);
    return list;
}

std::vector<Shadeop> arrayShadeops() {
    std::vector<Shadeop> list;
    const auto add = [&](const char* name, std::vector<Signature> signatures, Lowering lowering, const char* doc) {
        Shadeop op;
        op.section = "Arrays";
        op.source = "3Delight manual, 6.4.10";
        op.name = name;
        op.signatures = std::move(signatures);
        op.lowering = lowering;
        op.derivative = lowering == Lowering::Special ? DerivativeRule::Zero : DerivativeRule::ZeroWarn;
        op.pure = lowering == Lowering::Special;
        op.doc = doc;
        list.push_back(std::move(op));
    };
    add("arraylength", each(kAllTypes, "float arraylength($ a[])"), Lowering::Special, "Number of elements.");
    list.back().examples = {{"arraylength(a)", "3", "float a[3];"}};
    add("resize", each(kAllTypes, "void resize(output $ a[]; uniform float length)"), Lowering::Special,
        "Sets the length; new elements are undefined.");
    list.back().examples = {{"arraylength(a)", "5", "float a[]; resize(a, 5);"}};
    add("reserve", each(kAllTypes, "void reserve(output $ a[]; uniform float length)"), Lowering::Special, "Sets the capacity.");
    list.back().examples = {{"arraylength(a)", "0", "float a[]; reserve(a, 4);"}};
    add("push", each(kAllTypes, "void push(output $ a[]; $ value)"), Lowering::Special, "Appends a value.");
    list.back().examples = {{"a[1]", "2", "float a[] = {1}; push(a, 2);"}};
    add("pop", each(kAllTypes, "$ pop(output $ a[])"), Lowering::Special, "Removes and returns the last element.");
    list.back().examples = {{"pop(a)", "2", "float a[] = {1, 2};"}};
    add("capacity", each(kAllTypes, "float capacity($ a[])"), Lowering::Special, "Elements that fit without new memory.");
    list.back().examples = {{"capacity(a)", "4", "float a[]; reserve(a, 4);"}};
    return list;
}

} // namespace alpenglow::shadeops
