// Shadeops of PRMan 13 to 17 that published shaders call and that need nothing new of the renderer, or only a name.
#include "shadeops/describe.h"

namespace alpenglow::rsl {
namespace {

constexpr Type kF{Base::Float, 0}, kC{Base::Color, 0};

/// `text` once for each type: '$' is its name.
std::string forTypes(const std::string& types, const std::string& text) {
    std::string all;
    for (size_t at = 0; at < types.size();) {
        const size_t end = std::min(types.find(' ', at), types.size());
        for (const char c : text) c == '$' ? all += types.substr(at, end - at) : all += c;
        at = end + 1;
    }
    return all;
}

} // namespace

std::vector<Shadeop> publishedShadeops() {
    std::vector<Shadeop> list;
    const auto add = [&](const char* name, const char* section, std::vector<Signature> signatures, Lowering lowering, const char* doc) -> Shadeop& {
        Shadeop op;
        op.section = section;
        op.source = "PRMan";
        op.name = name;
        op.signatures = std::move(signatures);
        op.contexts = kSurface | kVolume | kLight;
        op.lowering = lowering;
        op.derivative = lowering == Lowering::Rsl ? DerivativeRule::Inherent : DerivativeRule::ZeroWarn;
        op.pure = false;
        op.doc = doc;
        list.push_back(std::move(op));
        return list.back();
    };
    Shadeop& normal = add("shadingnormal", "Geometry", sigs({{"normal shadingnormal(normal n)"}}), Lowering::Rsl,
                          "n with length 1, turned toward the viewer where the surface has two sides (attribute \"Sides\").");
    list.back().examples = {{"zcomp(shadingnormal(2 * N))", "-1"}};
    normal.contexts = kSurface | kDisplacement;
    normal.rsl = R"(
normal shadingnormal(normal n) {
    extern vector I;
    float sides = 2;
    attribute("Sides", sides);
    normal one = normalize(n);
    return (sides == 1) ? one : faceforward(one, I);
}
)";
    Shadeop& reverse = add("reverse", "Arrays", each("float color point vector normal matrix string", "void reverse(output $ a[])"), Lowering::Rsl,
                           "Turns the order of the elements about.");
    list.back().examples = {{"a[0]", "3", "float a[3] = {1, 2, 3}; reverse(a);"}};
    reverse.contexts = kAnyContext;
    reverse.rsl = forTypes("float color point vector normal matrix string", R"(
void reverse(output $ a[]) {
    uniform float n = arraylength(a), i;
    for (i = 0; i < n - 1 - i; i += 1) {
        $ x = a[i];
        a[i] = a[n - 1 - i];
        a[n - 1 - i] = x;
    }
}
)");
    Shadeop& wnoise = add("wnoise", "Noise",
                          each("float color point vector normal", "$ wnoise(float x, float filterwidth; pairs)") +
                              each("float color point vector normal", "$ wnoise(float x, float y, float filterwidth; pairs)") +
                              each("float color point vector normal", "$ wnoise(point p; float filterwidth; pairs)") +
                              each("float color point vector normal", "$ wnoise(point p; float w; float filterwidth; pairs)"),
                          Lowering::Rsl,
                          "Noise of one band of frequencies, in [-1, 1] with mean 0, that fades to 0 where the filter is too wide for it: 2 noise(p) - 1, times "
                          "1 - smoothstep(0.2, 0.6, filterwidth). PRMan took wavelets, whose values are others.");
    wnoise.contexts = kAnyContext;
    wnoise.pure = true;
    wnoise.bias = Bias::Biased;
    wnoise.biasReason = "detail that is finer than the filter is left out instead of being averaged";
    wnoise.examples = {{"wnoise(point(1,2,3), 0)", "0"}, {"wnoise(0.3, 1)", "0"}};
    for (const auto& [parameters, arguments] : {std::pair<const char*, const char*>{"float x", "x"}, {"float x; float y", "x, y"},
                                                {"point p", "p"}, {"point p; float w", "p, w"}})
        wnoise.rsl += forTypes("float color point vector normal",
                               "$ wnoise(" + std::string(parameters) + "; float filterwidth) { return (1 - smoothstep(0.2, 0.6, filterwidth)) * (2 * $ noise(" +
                                   arguments + ") - $ (1)); }\n");
    add("emit", "Ray tracing", sigs({{"void emit(color light; pairs)"}}), Lowering::Unavailable,
        "Called by area lights of PRMan in their method prelighting(): the light they send without sampling. Lights here are sampled by light().");
    list.back().examples = {{"x", "2 2 2", "color x = 2; emit(x);"}};
    Shadeop& areashadow =
        add("areashadow", "Ray tracing",
            sigs({{"void areashadow(string map; vector region; pairs)"}, {"void areashadow(string map; pairs)"}, {"color areashadow(point lit; float samples)"}}),
            Lowering::Unavailable,
            "In lights that ask BMRT's ray server (rayserver.h): how much of the light that L comes from reaches the point that is lit, traced; 1 is all. "
            "The forms with a map are called by area lights of PRMan in their method shadowSamples() and are not available.");
        list.back().examples = {{"areashadow(Ps, 4)", "1 1 1", "", "a light asks and nothing stands between it and Ps"}};
    areashadow.source = "BMRT, PRMan";
    areashadow.rsl = R"(
color areashadow(point lit; float samples) {
    extern vector L;
    return transmission(lit, lit - L, "samples", samples);
}
)";
    const std::vector<OptionalParameter> results = {{kC, "diffuseresult", true, "", "light times the diffuse material"},
                                                    {kC, "specularresult", true, "", "light times the specular material"},
                                                    {kC, "unshadoweddiffuseresult", true, "", "the same without shadows"},
                                                    {kC, "unshadowedspecularresult", true, "", "the same without shadows"},
                                                    {kF, "mis", false, "1", "how samples of lights and materials are joined"}};
    for (const char* name : {"directlighting", "indirectspecular", "diffuselighting"}) {
        const std::string n = name;
        Shadeop& op = add(name, "Ray tracing",
                          sigs({{("color " + n + "(shader handle; pairs)").c_str()}, {("color " + n + "(shader handle; shader lights[]; pairs)").c_str()}}),
                          Lowering::Unavailable,
                          "Called by class surfaces of PRMan: asks the lights, or rays, and the methods generateSamples() and evaluateSamples() of the material.");
        op.contexts = kSurface;
        op.optional = results;
        op.examples = {{n + "(getshader(\"none\")" + (n == "directlighting" ? ", getlights())" : ")"), "0 0 0"}};
    }
    Shadeop& shaderinfo = add("shaderinfo", "Messages", each("float string", "float shaderinfo(string name; output $ answer)"), Lowering::Rsl,
                              "What PRMan tells about the shader that runs (\"pipelinestage\", \"shadername\"). Nothing is known by these names: the result is 0, and "
                              "answer stays as it was.");
    list.back().examples = {{"shaderinfo(\"shadername\", x)", "0", "string x = \"none\";"},
                            {"x", "none", "string x = \"none\"; shaderinfo(\"pipelinestage\", x);"}};
    shaderinfo.contexts = kAnyContext;
    shaderinfo.rsl = "float shaderinfo(string name; output float answer) { return 0; }\nfloat shaderinfo(string name; output string answer) { return 0; }\n";
    const char* const samples = "Called by class lights and materials of PRMan in generateSamples() and evaluateSamples(): directions to an environment, or "
                                "of the lobe of Ashikhmin and Shirley, and what is known about them.";
    add("generateSamplesEnv", "Ray tracing", sigs({{"void generateSamplesEnv(string map; point p; normal n; float count; pairs)"}}), Lowering::Unavailable, samples);
    list.back().examples = {{"x", "0 0 1", "normal x = N; generateSamplesEnv(\"sky.env\", P, x, 4);"}};
    add("evaluateSamplesEnv", "Ray tracing", sigs({{"void evaluateSamplesEnv(string map; point p; normal n; pairs)"}}), Lowering::Unavailable, samples);
    list.back().examples = {{"x", "0 0 1", "normal x = N; evaluateSamplesEnv(\"sky.env\", P, x);"}};
    add("generateSamplesAS", "Ray tracing",
        sigs({{"void generateSamplesAS(color response; float count, exponentU, exponentV; vector lobe, tangent, view; pairs)"}}), Lowering::Unavailable, samples);
    list.back().examples = {{"x", "2 2 2", "color x = 2; generateSamplesAS(x, 4, 10, 10, N, dPdu, I);"}};
    add("evaluateSamplesAS", "Ray tracing",
        sigs({{"void evaluateSamplesAS(color response; float exponentU, exponentV; vector lobe, tangent, view; pairs)"}}), Lowering::Unavailable, samples);
    list.back().examples = {{"x", "2 2 2", "color x = 2; evaluateSamplesAS(x, 10, 10, N, dPdu, I);"}};
    return list;
}

} // namespace alpenglow::rsl
