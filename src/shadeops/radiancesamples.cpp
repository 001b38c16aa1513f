// Shadeops of the shader objects of PRMan 16 and 17: samples of lights and materials, and what asks for them. Those about samples
// take an array of the structure __radiancesample (rsl/library/structures), which is its members by the time they are called.
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
namespace {

/// `text` with every `word` replaced.
std::string with(std::string text, const std::string& word, const std::string& by) {
    for (size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += by.size()) text.replace(at, word.size(), by);
    return text;
}

/// The members of an array of __radiancesample, in their order, as parameters.
constexpr const char* kMembers =
    "output vector direction[]; output float distance[]; output color radiance[]; output color materialResponse[]; "
    "output float materialPdf[]; output float lightPdf[]; output color summedResponse[]; output float summedPdf[]";

/// A signature in which SAMPLES stands for them; its text names the structure.
Signature ofSamples(const std::string& text) {
    Signature s = parseSignature(with(text, "SAMPLES", kMembers));
    s.text = with(text, "SAMPLES", "output __radiancesample samples[]");
    return s;
}

/// What the texts below have in common. GROW: room for `most` samples more, behind the first `first` ones.
std::string written(std::string text) {
    return with(with(std::move(text), "SAMPLES", kMembers), "GROW", R"(
    uniform float first = arraylength(direction), most = 0, i;
    if (count >= 1) most = min(floor(count), 4096);
    resize(direction, first + most);
    resize(distance, first + most);
    resize(radiance, first + most);
    resize(materialResponse, first + most);
    resize(materialPdf, first + most);
    resize(lightPdf, first + most);
    resize(summedResponse, first + most);
    resize(summedPdf, first + most);
    most = arraylength(direction) - first;
)");
}

/// Two axes at right angles to z, from a direction t that may be of any length.
constexpr const char* kAxes = R"(
    vector flat = t - (t . z) * z;
    if (flat . flat < 1e-12 * (t . t) || t . t == 0) flat = (abs(zcomp(z)) < 0.9) ? z ^ vector(0, 0, 1) : z ^ vector(1, 0, 0);
    vector x = normalize(flat), y = z ^ x;
)";

/// Which of four ways a direction to an environment is drawn, as their number: 0 by the light of the map, 1 by the cosine over a
/// hemisphere, 2 the same to both sides, 3 evenly over a hemisphere, 4 over the sphere.
constexpr const char* kWays = R"(
float __skyway(string map; string distribution; string integrationdomain) {
    float sphere = match("^spher", integrationdomain);
    float way = 0;
    if (distribution == "uniform") way = 3 + sphere;
    else if (distribution == "cosine" || map == "") way = 1 + sphere;
    return way;
}
float __skypdf(float way; float up) {
    float pdf = 1 / (4 * PI);
    if (way == 1) pdf = max(0, up) / PI;
    else if (way == 2) pdf = abs(up) / (2 * PI);
    else if (way == 3) pdf = (up > 0) ? 1 / (2 * PI) : 0;
    return pdf;
}
)";

std::string skyText() {
    return kWays + written(R"(
void generateSamplesEnv(uniform string map; point p; normal n; uniform float count; SAMPLES; uniform string environmentspace;
                        uniform string distribution; float radius; color scale; uniform string integrationdomain) {
    GROW
    float way = __skyway(map, distribution, integrationdomain);
    vector z = normalize(vector(n)), t = 0;
    AXES
    for (i = 0; i < most; i += 1) {
        float a = (i + float random()) / most, b = random(), pdf = 0;
        vector w = z;
        color light = 1;
        if (way == 0) {
            pdf = __skysample(map, a, b, w, light);
            if (environmentspace != "") w = normalize(vtransform(environmentspace, "current", w));
        } else {
            float side = 1, up;
            if (way == 2 || way == 4) {
                side = (b < 0.5) ? 1 : -1;
                b = mod(2 * b, 1);
            }
            up = (way <= 2) ? sqrt(a) : a;
            float out = sqrt(max(0, 1 - up * up));
            w = out * cos(2 * PI * b) * x + out * sin(2 * PI * b) * y + side * up * z;
            pdf = __skypdf(way, side * up);
            if (map != "") {
                vector there = (environmentspace != "") ? vtransform(environmentspace, w) : w;
                float other = __skydensity(map, there, light);
            }
        }
        direction[first + i] = w;
        distance[first + i] = (radius > 0) ? radius : 1e38;
        radiance[first + i] = (w . z > 0 || match("^spher", integrationdomain) != 0) ? light * scale : color(0);
        lightPdf[first + i] = pdf;
    }
}
)") + written(R"(
void evaluateSamplesEnv(uniform string map; point p; normal n; SAMPLES; uniform string environmentspace;
                        uniform string distribution; float radius; color scale; uniform string integrationdomain) {
    float way = __skyway(map, distribution, integrationdomain);
    uniform float i, most = arraylength(direction);
    vector z = normalize(vector(n));
    for (i = 0; i < most; i += 1) {
        vector w = normalize(direction[i]);
        color light = 1;
        float pdf = 0;
        if (map != "") pdf = __skydensity(map, (environmentspace != "") ? vtransform(environmentspace, w) : w, light);
        if (way != 0) pdf = __skypdf(way, w . z);
        distance[i] = (radius > 0) ? radius : 1e38;
        radiance[i] = (w . z > 0 || match("^spher", integrationdomain) != 0) ? light * scale : color(0);
        lightPdf[i] = pdf;
    }
}
)");
}

/// Ashikhmin and Shirley, An Anisotropic Phong BRDF Model (2000), without Fresnel: times the cosine, and the density of samples.
constexpr const char* kLobe = R"(
void __aslobe(vector x; vector y; vector z; vector v; vector l; float eu; float ev; output float answer; output float pdf) {
    answer = 0;
    pdf = 0;
    float nl = z . l, nv = z . v;
    vector h = normalize(l + v);
    float nh = z . h, lh = l . h;
    if (nl > 0 && nv > 0 && lh > 0) {
        float hu = h . x, hv = h . y, away = 1 - nh * nh;
        float e = (away > 0) ? (eu * hu * hu + ev * hv * hv) / away : 0;
        pdf = sqrt((eu + 1) * (ev + 1)) * pow(nh, e) / (8 * PI * lh);
        answer = pdf * nl / max(nl, nv);
    }
}
)";

std::string lobeText() {
    return kLobe + written(R"(
void generateSamplesAS(color response; uniform float count; float exponentU; float exponentV; vector lobe; vector tangent;
                       vector view; SAMPLES) {
    GROW
    vector z = normalize(lobe), v = normalize(view), t = tangent;
    AXES
    float eu = max(0, exponentU), ev = max(0, exponentV);
    for (i = 0; i < most; i += 1) {
        float turn = 2 * PI * (i + float random()) / most;
        float a = atan(sqrt(eu + 1) * sin(turn), sqrt(ev + 1) * cos(turn));
        float e = eu * cos(a) * cos(a) + ev * sin(a) * sin(a), up = pow(1 - float random(), 1 / (e + 1));
        float out = sqrt(max(0, 1 - up * up)), answer, pdf;
        vector h = out * cos(a) * x + out * sin(a) * y + up * z;
        vector l = normalize(2 * (v . h) * h - v);
        __aslobe(x, y, z, v, l, eu, ev, answer, pdf);
        direction[first + i] = l;
        distance[first + i] = 1e38;
        materialResponse[first + i] = response * answer;
        materialPdf[first + i] = pdf;
    }
}
)") + written(R"(
void evaluateSamplesAS(color response; float exponentU; float exponentV; vector lobe; vector tangent; vector view; SAMPLES) {
    vector z = normalize(lobe), v = normalize(view), t = tangent;
    AXES
    uniform float i, most = arraylength(direction);
    for (i = 0; i < most; i += 1) {
        float answer, pdf;
        __aslobe(x, y, z, v, normalize(direction[i]), max(0, exponentU), max(0, exponentV), answer, pdf);
        materialResponse[i] = response * answer;
        materialPdf[i] = pdf;
    }
}
)");
}

/// Under path the renderer sends a shadow ray to each sample of a light that counts, so the light itself sends none.
std::string shadowText() {
    return written(R"(
color areashadow(point lit; float samples; float raytrace; float bias; float blur; float width; uniform string label;
                 uniform string subset; uniform string hitmode) {
    extern vector L;
    return transmission(lit, lit - L, "samples", samples);
}
void areashadow(uniform string map; vector region; SAMPLES; float raytrace; float bias; float blur; float width;
                uniform string label; uniform string subset; uniform string hitmode) {
    uniform float i, most = arraylength(direction), rays = (map == "" || map == "raytrace") ? 1 : 0;
    uniform string hider = "";
    option("Hider", hider);
    point at = point(region);
    for (i = 0; i < most; i += 1) {
        if (lightPdf[i] > 0) {
            if (rays != 0 || raytrace != 0) {
                if (hider != "path")
                    radiance[i] *= transmission(at, at + min(distance[i], 1e15) * normalize(direction[i]), "bias", bias,
                                                "label", label, "subset", subset, "hitmode", hitmode);
            } else if (bias >= 0) {
                radiance[i] *= 1 - color shadow(map, at, "bias", bias, "blur", blur, "width", width);
            } else {
                radiance[i] *= 1 - color shadow(map, at, "blur", blur, "width", width);
            }
        }
    }
}
)");
}

/// directlighting() and its kin of another shader object than `this`, whose calls become methods of the class
/// (rsl/front/classlighting.cpp).
std::string lightingText() {
    std::string all = R"(
color __asked(shader handle; uniform string which; vector w; float far; color light) {
    vector direction[1];
    float distance[1], materialPdf[1], lightPdf[1], summedPdf[1];
    color radiance[1], materialResponse[1], summedResponse[1];
    direction[0] = w;
    distance[0] = far;
    radiance[0] = light;
    materialResponse[0] = 0;
    materialPdf[0] = 0;
    lightPdf[0] = 1;
    summedResponse[0] = 0;
    summedPdf[0] = 0;
    handle->evaluateSamples(which, direction, distance, radiance, materialResponse, materialPdf, lightPdf, summedResponse,
                            summedPdf);
    return materialResponse[0];
}
)";
    const struct {
        const char *name, *result;
    } kCalls[] = {{"directlighting", "diffuseresult + specularresult"},
                  {"diffuselighting", "diffuseresult"},
                  {"specularlighting", "specularresult"}};
    for (const auto& c : kCalls)
        for (const char* lights : {"", " shader lights[];"}) {
            std::string text = R"(
color NAME(shader handle;LIGHTS output color diffuseresult; output color specularresult; output color unshadoweddiffuseresult;
           output color unshadowedspecularresult; float mis; uniform string integrationdomain) {
    extern point P;
    extern normal N;
    diffuseresult = 0;
    specularresult = 0;
    illuminance(P, shadingnormal(N), match("^spher", integrationdomain) != 0 ? PI : PI / 2) {
        LISTED
        if (asked != 0) {
            diffuseresult += PI * Cl * __asked(handle, "diffuse", normalize(L), length(L), Cl);
            specularresult += PI * Cl * __asked(handle, "specular", normalize(L), length(L), Cl);
        }
    }
    unshadoweddiffuseresult = diffuseresult;
    unshadowedspecularresult = specularresult;
    return RESULT;
}
)";
            const char* const listed = "float asked = 0; uniform float k, of = arraylength(lights);\n"
                                       "        for (k = 0; k < of; k += 1) if (lights[k] == light) asked = 1;\n";
            text = with(with(with(text, "NAME", c.name), "LIGHTS", lights), "RESULT", c.result);
            all += with(text, "LISTED", *lights ? listed : "float asked = 1;\n");
        }
    return all;
}

constexpr const char* kSpecularText = R"(
color indirectspecular(shader handle; float bias; float maxdist; uniform string label; uniform string subset;
                       uniform string hitmode; uniform string hitsides; float samplebase; uniform string integrationdomain;
                       point position; float usemotionbias) {
    extern point P;
    point from = position[0] < 1e38 ? position : P;
    vector direction[];
    float distance[], materialPdf[], lightPdf[], summedPdf[];
    color radiance[], materialResponse[], summedResponse[];
    handle->generateSamples("specular", direction, distance, radiance, materialResponse, materialPdf, lightPdf, summedResponse,
                            summedPdf);
    uniform float i, n = arraylength(direction);
    color sum = 0;
    for (i = 0; i < n; i += 1)
        if (materialPdf[i] > 0)
            sum += trace(from, direction[i], "bias", bias, "maxdist", maxdist, "label", label, "subset", subset, "hitmode",
                         hitmode, "hitsides", hitsides) * materialResponse[i] / (n * materialPdf[i]);
    return sum;
}
)";

/// The parameters of the rays of indirectspecular().
std::vector<OptionalParameter> specularParameters() {
    return {{kF, "bias", false, "-1", "offset of the start of the rays"},
            {kF, "maxdist", false, "1e38", "no intersections beyond it"},
            {kS, "label", false, "\"\"", "label of the rays, for rayinfo()"},
            {kS, "subset", false, "\"\"", "groups of objects considered"},
            {kS, "hitmode", false, "\"default\"", "primitive, shader or default"},
            {kS, "hitsides", false, "\"\"", "front, back, both or reversed"},
            {kF, "samplebase", false, "0", "accepted and ignored: rays start at the point"},
            {kS, "integrationdomain", false, "\"\"", "accepted and ignored: the samples say where rays go"},
            {kP, "position", false, "1e38", "where the rays start; from 1e38 on: P"},
            {kF, "usemotionbias", false, "0", "accepted and ignored: rays start where the surface is at their time"}};
}

/// Adds a shadeop written in RSL; AXES in its text stands for kAxes.
Shadeop& addSampleOp(std::vector<Shadeop>& list, const char* name, std::vector<Signature> signatures, std::string text,
                     const char* doc) {
    Shadeop op;
    op.section = "Ray tracing";
    op.source = "PRMan";
    op.name = name;
    op.signatures = std::move(signatures);
    op.contexts = kSurface | kVolume | kLight;
    op.lowering = Lowering::Rsl;
    op.derivative = DerivativeRule::Inherent;
    op.pure = false;
    op.doc = doc;
    op.rsl = with(std::move(text), "AXES", kAxes);
    list.push_back(std::move(op));
    return list.back();
}

void addEmit(std::vector<Shadeop>& list) {
    Shadeop& emit = addSampleOp(
        list, "emit", sigs({{"void emit(color light; pairs)"}}),
        "void emit(color light; float specularcontribution; float diffusecontribution; float raytraceshadows; float shadowbias; "
        "float adaptiveshadow; "
        "float shadowmapbias; float shadowmapbias2; float areanormalized; string environmentmap) {}\n",
        "In the method prelighting() of a class of PRMan: the radiance that the primitive sends along its normal, all calls "
        "added up. A class "
        "that has neither light() nor generateSamples() lights by it, behind AreaLightSource; others light by those methods, and "
        "the "
        "call does nothing more. The optional parameters are hints for the sampling of another renderer, and change nothing.");
    emit.examples = {{"x", "2 2 2", "color x = 2; emit(x);"}};
    emit.optional = {{kF, "specularcontribution", false, "", "hint"},
                     {kF, "diffusecontribution", false, "", "hint"},
                     {kF, "raytraceshadows", false, "", "hint"},
                     {kF, "shadowbias", false, "", "hint"},
                     {kF, "adaptiveshadow", false, "", "hint"},
                     {kF, "shadowmapbias", false, "", "hint"},
                     {kF, "shadowmapbias2", false, "", "hint"},
                     {kF, "areanormalized", false, "0", "read over: light is the radiance, not divided by the area"},
                     {kS, "environmentmap", false, "", "hint"}};
}

void addAreaShadow(std::vector<Shadeop>& list) {
    Shadeop& shadow =
        addSampleOp(list, "areashadow", sigs({{"color areashadow(point lit; float samples)"}}), shadowText(),
                    "The form with samples multiplies the radiance of each sample of a light by what reaches the point in "
                    "the middle of the region (a filterregion, or the "
                    "point) from there: by a shadow map, or by rays where the map is \"\" or \"raytrace\". Class lights "
                    "call it in shadowSamples(), which "
                    "runs behind their generateSamples(). Under path all lights have traced shadows, so that rays are not "
                    "sent twice. The other form is that of "
                    "BMRT's ray server (rayserver.h), in lights: how much of the light that L comes from reaches the point "
                    "that is lit, traced; 1 is all.");
    shadow.signatures.push_back(ofSamples("void areashadow(string map; vector region; SAMPLES; pairs)"));
    shadow.source = "BMRT, PRMan";
    shadow.examples = {{"areashadow(Ps, 4)", "1 1 1", "", "a light asks and nothing stands between it and Ps"}};
    shadow.optional = {{kF, "raytrace", false, "0", "not 0: rays are sent whatever the map"},
                       {kF, "bias", false, "-1", "of the rays or of the map; negative: as elsewhere in the scene"},
                       {kF, "blur", false, "0", "of the map, as shadow() has it"},
                       {kF, "width", false, "1", "of the map, as shadow() has it"},
                       {kS, "label", false, "\"\"", "of the rays, for rayinfo()"},
                       {kS, "subset", false, "\"\"", "groups of objects that the rays may meet"},
                       {kS, "hitmode", false, "\"default\"", "of the rays: primitive, shader or default"}};
}

/// Samples of an environment.
void addSkySampling(std::vector<Shadeop>& list) {
    const std::vector<OptionalParameter> sky = {
        {kS, "environmentspace", false, "\"\"", "space of the map, taken as a rotation; none: current"},
        {kS, "distribution", false, "\"\"", "cosine or uniform; all others: in proportion to the light of the map"},
        {kF, "radius", false, "0", "distance of the samples, as far as shadows are looked for; 0: endless"},
        {kC, "scale", false, "1", "multiplies the map"},
        {kS, "integrationdomain", false, "\"\"",
         "words that begin with \"spher\": all directions; else light comes from the side of n alone"}};
    addSampleOp(
        list, "generateSamplesEnv",
        {ofSamples("void generateSamplesEnv(string map; point p; normal n; uniform float count; SAMPLES; pairs)")}, skyText(),
        "Adds samples of an environment to the array: directions, distances, radiances, and lightPdf, the density per steradian "
        "with which a direction is drawn. Without "
        "a map (\"\") the radiance is \"scale\" from everywhere, drawn by the cosine to n. A light that gives the samples out of "
        "generateSamples() "
        "lights by them without bias.")
        .examples = {{"arraylength(s) * s[3]->lightPdf / max(0, s[3]->direction . normalize(N))", "1.273239",
                      "__radiancesample s[]; generateSamplesEnv(\"\", P, N, 4, s);"}};
    list.back().optional = sky;
    addSampleOp(
        list, "evaluateSamplesEnv", {ofSamples("void evaluateSamplesEnv(string map; point p; normal n; SAMPLES; pairs)")},
        skyText(),
        "Radiance, distance and lightPdf of samples whose directions are known: what generateSamplesEnv() would have said of "
        "them.")
        .examples = {{"s[0]->lightPdf", "0.3183099",
                      "__radiancesample s[1]; s[0]->direction = vector(N); evaluateSamplesEnv(\"\", P, N, s);"}};
    list.back().optional = sky;
}

/// Samples of the lobe of Ashikhmin and Shirley.
void addLobeSamples(std::vector<Shadeop>& list) {
    addSampleOp(
        list, "generateSamplesAS",
        {ofSamples("void generateSamplesAS(color response; uniform float count; float exponentU, exponentV; vector lobe, "
                   "tangent, view; SAMPLES)")},
        lobeText(),
        "Adds samples of the glossy lobe of Ashikhmin and Shirley to the array: directions, materialResponse (response times the "
        "lobe and the cosine to "
        "`lobe`, which is its axis; no Fresnel) and materialPdf, the density per steradian of the facets that mirror view there.")
        .examples = {{"comp(s[0]->materialResponse, 0) / (s[0]->materialPdf * s[0]->direction . N)", "2",
                      "__radiancesample s[]; generateSamplesAS(2, 1, 1000, 1000, vector(N), dPdu, vector(N), s);"}};
    addSampleOp(
        list, "evaluateSamplesAS",
        {ofSamples("void evaluateSamplesAS(color response; float exponentU, exponentV; vector lobe, tangent, view; SAMPLES)")},
        lobeText(), "materialResponse and materialPdf of samples whose directions are known, as generateSamplesAS() gives them.")
        .examples = {
        {"s[0]->materialPdf", "0.4376761",
         "__radiancesample s[1]; s[0]->direction = vector(N); evaluateSamplesAS(1, 10, 10, vector(N), dPdu, vector(N), s);"}};
}

/// What asks a shader object about the light of all lights, or of rays.
void addLightSums(std::vector<Shadeop>& list) {
    const std::vector<OptionalParameter> results = {
        {kC, "diffuseresult", true, "", "light times the diffuse material"},
        {kC, "specularresult", true, "", "light times the specular material"},
        {kC, "unshadoweddiffuseresult", true, "", "the same, with the shadows that the lights have"},
        {kC, "unshadowedspecularresult", true, "", "the same, with the shadows that the lights have"},
        {kF, "mis", false, "1", "read over: lights here are sampled once for all lobes"},
        {kS, "integrationdomain", false, "\"\"",
         "words that begin with \"spher\": lights from all sides; else from that of the normal"}};
    const struct {
        const char *name, *doc;
    } kSums[] = {{"directlighting",
                  "Light of the lights, each times PI and what the method evaluateSamples(\"diffuse\", samples) and then "
                  "(\"specular\", samples) of the shader object says of its direction. `this`, or "
                  "any handle. lights: those of the list only, else all."},
                 {"diffuselighting", "The diffuse part of directlighting()."},
                 {"specularlighting", "The specular part of directlighting()."}};
    for (const auto& sum : kSums) {
        const std::string n = sum.name;
        Shadeop& op = addSampleOp(list, sum.name,
                                  sigs({{("color " + n + "(shader handle; pairs)").c_str()},
                                        {("color " + n + "(shader handle; shader lights[]; pairs)").c_str()}}),
                                  lightingText(), sum.doc);
        op.contexts = kSurface;
        op.optional = results;
        op.examples = {{n + "(getshader(\"none\"))", "0 0 0"}};
    }
    Shadeop& specular =
        addSampleOp(list, "indirectspecular", sigs({{"color indirectspecular(shader handle; pairs)"}}), kSpecularText,
                    "Light along the directions that the method generateSamples(\"specular\", samples) of the shader "
                    "object gives, by trace(): the mean of materialResponse "
                    "over materialPdf times what arrives from there. `this`, or any handle.");
    specular.contexts = kSurface;
    specular.optional = specularParameters();
    specular.examples = {{"indirectspecular(getshader(\"none\"))", "0 0 0"}};
}

} // namespace

std::vector<Shadeop> radianceSampleShadeops() {
    std::vector<Shadeop> list;
    addEmit(list);
    addAreaShadow(list);
    addSkySampling(list);
    addLobeSamples(list);
    addLightSums(list);
    return list;
}

} // namespace alpenglow::shadeops
