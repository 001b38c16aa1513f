// Shadeops of PRMan 13 to 17 that published shaders call and that need nothing new of the renderer, or only a name.
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
namespace {

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

/// Adds a shadeop with what most of these have in common.
Shadeop& addCompatible(std::vector<Shadeop>& list, const char* name, const char* section, std::vector<Signature> signatures,
                       Lowering lowering, const char* doc) {
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
}

void addShadingNormal(std::vector<Shadeop>& list) {
    Shadeop& normal =
        addCompatible(list, "shadingnormal", "Geometry", sigs({{"normal shadingnormal(normal n)"}}), Lowering::Rsl,
                      "n with length 1, turned toward the viewer where the surface has two sides (attribute \"Sides\").");
    list.back().examples = {{"zcomp(shadingnormal(2 * N))", "-1"}};
    normal.contexts = kSurface | kDisplacement | kLight; // lights of PRMan send along the normal of what they light
    normal.rsl = R"(
normal shadingnormal(normal n) {
    extern vector I;
    float sides = 2;
    attribute("Sides", sides);
    normal one = normalize(n);
    return (sides == 1) ? one : faceforward(one, I, one);
}
)";
}

void addReverse(std::vector<Shadeop>& list) {
    Shadeop& reverse = addCompatible(list, "reverse", "Arrays",
                                     each("float color point vector normal matrix string", "void reverse(output $ a[])"),
                                     Lowering::Rsl, "Turns the order of the elements about.");
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
}

void addWnoise(std::vector<Shadeop>& list) {
    Shadeop& wnoise = addCompatible(
        list, "wnoise", "Noise",
        each("float color point vector normal", "$ wnoise(float x, float filterwidth; pairs)") +
            each("float color point vector normal", "$ wnoise(float x, float y, float filterwidth; pairs)") +
            each("float color point vector normal", "$ wnoise(point p; float filterwidth; pairs)") +
            each("float color point vector normal", "$ wnoise(point p; float w; float filterwidth; pairs)"),
        Lowering::Rsl,
        "Noise of one band of frequencies, in [-1, 1] with mean 0, that fades to 0 where the filter is too wide for it: 2 "
        "noise(p) - 1, times "
        "1 - smoothstep(0.2, 0.6, filterwidth). With \"octaves\" the sum of so many bands, 32 at most, each \"lacunarity\" times "
        "finer and \"gain\" "
        "times weaker than the one before; \"amplitude\" multiplies the whole. PRMan took wavelets, whose values are others.");
    wnoise.contexts = kAnyContext;
    wnoise.pure = true;
    wnoise.bias = Bias::Biased;
    wnoise.biasReason = "detail that is finer than the filter is left out instead of being averaged";
    wnoise.examples = {
        {"wnoise(point(1,2,3), 0)", "0"}, {"wnoise(0.3, 1)", "0"}, {"wnoise(point(1,2,3), 0, \"octaves\", 3)", "0"}};
    // The text takes them behind its own parameters, in this order (front/calls_bind.cpp).
    wnoise.optional = {{kF, "octaves", false, "1", "bands that are added"},
                       {kF, "amplitude", false, "1", "multiplies the sum"},
                       {kF, "lacunarity", false, "2", "frequency of a band by that of the one before"},
                       {kF, "gain", false, "0.5", "weight of a band by that of the one before"}};
    for (const auto& [parameters, arguments] : {std::pair<const char*, const char*>{"float x", "x * k"},
                                                {"float x; float y", "x * k, y * k"},
                                                {"point p", "p * k"},
                                                {"point p; float w", "p * k, w * k"}})
        wnoise.rsl += forTypes("float color point vector normal",
                               "$ wnoise(" + std::string(parameters) +
                                   "; float filterwidth; float octaves; float amplitude; float lacunarity; float gain) {\n"
                                   "    $ sum = $ (0);\n"
                                   "    float k = 1, weight = amplitude, i, n = min(octaves, 32);\n"
                                   "    for (i = 0; i < n; i += 1) {\n"
                                   "        sum += weight * (1 - smoothstep(0.2, 0.6, filterwidth * k)) * (2 * $ noise(" +
                                   arguments +
                                   ") - $ (1));\n"
                                   "        k *= lacunarity;\n"
                                   "        weight *= gain;\n"
                                   "    }\n"
                                   "    return sum;\n"
                                   "}\n");
}

void addRandomstrat(std::vector<Shadeop>& list) {
    Shadeop& randomstrat = addCompatible(
        list, "randomstrat", "Mathematics",
        each("float color point vector normal", "void randomstrat(uniform float first, uniform float end; output $ a[])"),
        Lowering::Rsl,
        "Fills the elements of a from the element `first` to the one before `end` with random numbers from 0 to 1 that are "
        "spread evenly, in "
        "random order: of n floats one lies in each nth of the range; of tuples the first two components cover the square, "
        "the third is 0. "
        "An array that may change its length becomes long enough.");
    randomstrat.examples = {{"floor(4 * min(a[0], a[1], a[2], a[3])) + floor(4 * max(a[0], a[1], a[2], a[3]))", "3",
                             "float a[4]; randomstrat(0, 4, a);"}};
    randomstrat.contexts = kAnyContext;
    randomstrat.derivative = DerivativeRule::ZeroWarn;
    // In a square: x from strata, y from multiples of the golden ratio, begun anywhere. Each call is in an order of its own, so
    // that what two calls give for one element has nothing to do with each other.
    for (const auto& [types, value] :
         {std::pair<const char*, const char*>{"float", "(i + float random()) / n"},
          {"color point vector normal", "$ ((i + float random()) / n, mod(start + 0.618033989 * i, 1), 0)"}})
        randomstrat.rsl += forTypes(types, R"(
void randomstrat(uniform float first; uniform float end; output $ a[]) {
    if (arraylength(a) < end) resize(a, end);
    uniform float i, n = min(end, arraylength(a)) - first;
    float start = random();
    for (i = 0; i < n; i += 1) a[first + i] = )" +
                                               std::string(value) + R"(;
    for (i = n - 1; i > 0; i -= 1) {
        float other = first + min(floor((i + 1) * float random()), i);
        $ x = a[first + i];
        a[first + i] = a[other];
        a[other] = x;
    }
}
)");
}

void addPtransform(std::vector<Shadeop>& list) {
    Shadeop& ptransform = addCompatible(
        list, "ptransform", "Geometry",
        sigs({{"point ptransform(string tospace; point p)"},
              {"point ptransform(string fromspace, string tospace; point p)"},
              {"point ptransform(matrix m; point p)"},
              {"point ptransform(string fromspace; matrix m; point p)"}}),
        Lowering::Special,
        "transform() by the rule of points, whatever the type of the argument: its name in texts of the first years.");
    ptransform.source = "first RenderMan texts";
    ptransform.contexts = kAnyContext;
    ptransform.derivative = DerivativeRule::Inherent;
    ptransform.pure = true;
    ptransform.examples = {{"ptransform(translate(matrix(1), point(1, 2, 3)), point(1, 1, 1))", "2 3 4"}};
}

/// What a shader asks about itself.
void addQuestions(std::vector<Shadeop>& list) {
    Shadeop& evalparam =
        addCompatible(list, "evalparam", "Messages",
                      each(kAllTypes, "float evalparam(string name; output $ value)") +
                          each(kAllTypes, "float evalparam(string name; output $ value[])"),
                      Lowering::Special,
                      "Parameter of the shader itself, or of the co-shader whose method runs. 1 on success; 0, and value "
                      "untouched, when there is none of "
                      "that name or the type does not fit.");
    evalparam.contexts = kAnyContext;
    evalparam.examples = {{"evalparam(\"none\", x) + x", "3", "float x = 3;"}};
    Shadeop& shaderinfo = addCompatible(
        list, "shaderinfo", "Messages", each("float string", "float shaderinfo(string name; output $ answer)"), Lowering::Rsl,
        "What PRMan says about the shader that runs (\"pipelinestage\", \"shadername\"). Nothing is known by these names: "
        "the result is 0, and "
        "answer stays as it was.");
    list.back().examples = {{"shaderinfo(\"shadername\", x)", "0", "string x = \"none\";"},
                            {"x", "none", "string x = \"none\"; shaderinfo(\"pipelinestage\", x);"}};
    shaderinfo.contexts = kAnyContext;
    shaderinfo.rsl = "float shaderinfo(string name; output float answer) { return 0; }\nfloat shaderinfo(string name; output "
                     "string answer) { return 0; }\n";
}

} // namespace

std::vector<Shadeop> compatibilityShadeops() {
    std::vector<Shadeop> list;
    addShadingNormal(list);
    addReverse(list);
    addWnoise(list);
    addRandomstrat(list);
    addPtransform(list);
    addQuestions(list);
    return list;
}

} // namespace alpenglow::shadeops
