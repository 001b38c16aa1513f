// Examples of the shadeops that need more than an expression: statements before it, lights, maps or other surfaces. The others have
// theirs beside their descriptors.
#include "shadeops/describe.h"
#include <algorithm>

namespace alpenglow::rsl {
namespace {

struct Entry {
    const char* shadeop;
    const char* setup;
    const char* expression;
    const char* value;
    const char* when = ""; ///< what must be there besides the point of `alpenglow eval`
};

constexpr const char* kOneLight = "one light with Cl = 1 stands straight over N";
constexpr const char* kWhite = "all rays meet a surface with Ci = 1";
constexpr const char* kNothing = "nothing stands there";

constexpr Entry kEntries[] = {
    {"Deriv", "", "Deriv(u * u, u)", "1"},
    {"Du", "", "Du(u * u)", "1"},
    {"Dv", "", "Dv(u * v)", "0.5"},
    {"ambient", "", "ambient()", "0.2 0.2 0.2", "there is one light \"ambientlight\" of intensity 0.2"},
    {"area", "", "area(2 * P)", "4"},
    {"areashadow", "", "areashadow(Ps, 4)", "1 1 1", "a light asks and nothing stands between it and Ps"},
    {"arraylength", "float a[3];", "arraylength(a)", "3"},
    {"atmosphere", "float x = 0;", "atmosphere(\"density\", x) + x", "1.5", "the volume shader has a parameter density of 0.5"},
    {"attribute", "float x = 0;", "attribute(\"user:size\", x) + x", "3", "Attribute \"user\" \"float size\" 2 is set"},
    {"bake", "float x = 7; bake(\"none.bake\", s, t, x);", "x", "7"},
    {"bake3d", "", "bake3d(\"light.ptc\", \"\", P, N, \"light\", Cs)", "0"},
    {"bump", "", "bump(\"bumps.tex\", N, dPdu, dPdv)", "0 0 0", "the map is the same everywhere"},
    {"calculatenormal", "", "calculatenormal(P)", "0 0 1"},
    {"capacity", "float a[]; reserve(a, 4);", "capacity(a)", "4"},
    {"caustic", "", "color caustic(P, N)", "0 0 0"},
    {"depth", "", "depth(P)", "0.5", "P stands in the middle between the planes of clipping"},
    {"diffuse", "", "diffuse(N)", "1 1 1", kOneLight},
    {"diffuselighting", "", "diffuselighting(getshader(\"none\"))", "0 0 0"},
    {"directlighting", "", "directlighting(getshader(\"none\"), getlights())", "0 0 0"},
    {"displacement", "float x = 0;", "displacement(\"amount\", x) + x", "1.5", "the displacement shader has a parameter amount of 0.5"},
    {"emit", "color x = 2; emit(x);", "x", "2 2 2"},
    {"environment", "", "color environment(\"sky.env\", N)", "0.5 0.7 1", "the map has this colour everywhere"},
    {"evaluateSamplesAS", "color x = 2; evaluateSamplesAS(x, 10, 10, N, dPdu, I);", "x", "2 2 2"},
    {"evaluateSamplesEnv", "normal x = N; evaluateSamplesEnv(\"sky.env\", P, x);", "x", "0 0 1"},
    {"fresnel", "float kr = 0, kt = 0; fresnel(vector(0, 0, 1), vector(0, 0, -1), 0.5, kr, kt);", "round(kr * 9)", "1"},
    {"fulltrace", "color c = 0; float d = 0; point p = 0, m = 0; vector n = 0, r = 0;", "fulltrace(P, N, c, d, p, n, m, r)", "0", kNothing},
    {"gather", "color c = 0, one = 0; gather(\"illuminance\", P, N, 0.5, 4, \"surface:Ci\", one) c += one;", "c", "4 4 4", kWhite},
    {"generateSamplesAS", "color x = 2; generateSamplesAS(x, 4, 10, 10, N, dPdu, I);", "x", "2 2 2"},
    {"generateSamplesEnv", "normal x = N; generateSamplesEnv(\"sky.env\", P, x, 4);", "x", "0 0 1"},
    {"getlight", "shader l = getlight(\"none\");", "(l == null) ? 1 : 0", "1"},
    {"getlights", "", "arraylength(getlights())", "2", "two lights are on"},
    {"getshader", "shader l = getshader(\"none\");", "(l == null) ? 1 : 0", "1"},
    {"getshaders", "shader l[] = getshaders(\"category\", \"layer\");", "arraylength(l)", "0"},
    {"getvar", "float x = 3; getvar(null, \"none\", x);", "x", "3"},
    {"gridmax", "", "gridmax(u)", "1"},
    {"gridmin", "", "gridmin(u)", "0"},
    {"hasmethod", "shader l = getshader(\"none\");", "hasmethod(l, \"size\")", "0"},
    {"incident", "float x = 0;", "incident(\"density\", x) + x", "1.5", "the volume before the surface has a parameter density of 0.5"},
    {"indirectdiffuse", "", "indirectdiffuse(P, N, 16)", "1 1 1", kWhite},
    {"indirectspecular", "", "indirectspecular(getshader(\"none\"))", "0 0 0"},
    {"isindirectray", "", "isindirectray()", "0"},
    {"islightcategory", "float n = 0; illuminance(P) n += islightcategory(\"key\");", "n", "1", "one light of category key and one of another are on"},
    {"isoutput", "", "isoutput(\"glow\")", "0"},
    {"isshadowray", "", "isshadowray()", "0"},
    {"lightsource", "float x = 0, sum = 0; illuminance(P) sum += lightsource(\"intensity\", x) * x;", "sum", "3", "lights of intensity 1 and 2 are on"},
    {"match", "", "match(\"a.c\", \"abc\")", "1"},
    {"ntransform", "", "ntransform(scale(matrix(1), point(2, 1, 1)), normal(1, 0, 0))", "0.5 0 0"},
    {"occlusion", "", "occlusion(P, N, 16)", "0", kNothing},
    {"opposite", "float x = 0;", "opposite(\"density\", x) + x", "1.5", "the volume behind the surface has a parameter density of 0.5"},
    {"option", "float x = 0;", "option(\"user:size\", x) + x", "3", "Option \"user\" \"float size\" 2 is set"},
    {"outputchannel", "color x = 0; outputchannel(\"glow\", color(2)); readaov(\"glow\", x);", "x", "2 2 2"},
    {"phong", "", "phong(N, N, 10)", "1 1 1", kOneLight},
    {"photonmap", "", "photonmap(\"none.map\", P, N)", "0"},
    {"pop", "float a[] = {1, 2};", "pop(a)", "2"},
    {"print", "", "print(\"u is %g\", u)", "u is 0.5"},
    {"printf", "", "printf(\"u is %g\", u)", "u is 0.5"},
    {"ptexture", "", "ptexture(\"none.ptx\", 0, 0)", "0"},
    {"push", "float a[] = {1}; push(a, 2);", "a[1]", "2"},
    {"random", "float x = random();", "x >= 0 && x < 1", "1"},
    {"rayhittest", "point p = 0; vector n = 0;", "rayhittest(P, N, p, n)", "2", "a surface stands 2 away along N"},
    {"rayinfo", "float x = 0;", "rayinfo(\"depth\", x) + x", "1", "the camera sees the point"},
    {"raylevel", "", "raylevel()", "0"},
    {"readaov", "color x = 0; writeaov(\"glow\", color(2)); readaov(\"glow\", x);", "x", "2 2 2"},
    {"readprimvar", "float x = 3; readprimvar(\"none\", x);", "x", "3"},
    {"rendererinfo", "string name = \"\"; rendererinfo(\"renderer\", name);", "name", "Alpenglow", "a frame is rendered"},
    {"reserve", "float a[]; reserve(a, 4);", "arraylength(a)", "0"},
    {"resize", "float a[]; resize(a, 5);", "arraylength(a)", "5"},
    {"reverse", "float a[3] = {1, 2, 3}; reverse(a);", "a[0]", "3"},
    {"setcomp", "matrix m = 0; setcomp(m, 0, 3, 2);", "comp(m, 0, 3)", "2"},
    {"setxcomp", "point p = 0; setxcomp(p, 2);", "p", "2 0 0"},
    {"setycomp", "point p = 0; setycomp(p, 2);", "p", "0 2 0"},
    {"setzcomp", "point p = 0; setzcomp(p, 2);", "p", "0 0 2"},
    {"shaderinfo", "string x = \"none\";", "shaderinfo(\"shadername\", x)", "0"},
    {"shadername", "", "shadername()", "eval"},
    {"shaderinfo", "string x = \"none\"; shaderinfo(\"pipelinestage\", x);", "x", "none"},
    {"shadingnormal", "", "zcomp(shadingnormal(2 * N))", "-1"},
    {"shadow", "", "shadow(\"light.shd\", P)", "1", "P is in the shadow that the map shows"},
    {"specular", "", "specular(N, N, 0.1)", "1 1 1", kOneLight},
    {"specularstd", "", "specularstd(N, N, 0.1)", "1 1 1", kOneLight},
    {"stringhash", "", "stringhash(\"a\") == stringhash(\"a\") && stringhash(\"a\") != stringhash(\"b\")", "1"},
    {"subsurface", "", "subsurface(P)", "0 0 0"},
    {"surface", "float x = 0;", "surface(\"Kd\", x) + x", "1.5", "a light asks and the surface shader has a parameter Kd of 0.5"},
    {"texture", "", "color texture(\"wood.tex\", s, t)", "0.5 0.3 0.1", "the map has this colour everywhere"},
    {"texture3d", "float x = 3;", "texture3d(\"none.ptc\", P, N, \"light\", x)", "0"},
    {"textureinfo", "float x = 3;", "textureinfo(\"none.tex\", \"channels\", x)", "0"},
    {"trace", "", "trace(P, N)", "1 1 1", kWhite},
    {"transform", "", "transform(translate(matrix(1), point(1, 2, 3)), P)", "1 2 3"},
    {"transmission", "", "transmission(P, P + N)", "1 1 1", kNothing},
    {"visibility", "", "visibility(P, P + N)", "1 1 1", kNothing},
    {"vtransform", "", "vtransform(scale(matrix(1), point(2, 3, 4)), vector(1, 1, 1))", "2 3 4"},
    {"writeaov", "float x = 0; writeaov(\"depths\", 3); readaov(\"depths\", x);", "x", "3"},
};

} // namespace

void addExamples(std::vector<Shadeop>& all) {
    for (const Entry& e : kEntries)
        for (Shadeop& op : all)
            if (op.name == e.shadeop) op.examples.push_back({e.expression, e.value, e.setup, e.when});
}

} // namespace alpenglow::rsl
