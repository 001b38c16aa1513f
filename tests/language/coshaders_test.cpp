// Shaders that call others through handles: methods, members, getshader, getshaders, getvar. Every number below is in the
// shaders.
#include "base/limits.h"
#include "points.h"
#include "rsl/compiler.h"
#include <gtest/gtest.h>
#include <set>

namespace alpenglow::rsl::coshaders_test {
namespace {

const char* const kLayer = R"(
class layer(float gain = 1; string __category = "";)
{
    public float calls = 0;
    float hidden = 3;
    public void construct() { hidden = hidden * gain; }
    public color tint(color c; float k) { calls += 1; return c * scaled(k); }
    public void split(float x; output float whole; output float rest) { whole = floor(x); rest = x - whole; calls += 10; }
    float scaled(float k) { return k * hidden; }
    public void options(output float r; float x; float by = gain * 10; string mode = "add"; float more[] = {1, 2})
    {
        r = (mode == "add" ? x + by : x * by) + 1000 * arraylength(more) + 10000 * more[0];
    }
})";

/// The outputs of a surface with two layers bound: "a" (gain 2, category "paint,wet") and "b" (gain 10, category "dust").
std::vector<float> shade(const std::string& body, const std::vector<std::string>& names, Diagnostics& d, int lanes = 16,
                         bool mixed = false) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    const auto layer = compiler.loadText(kLayer, "layer.sl", d);
    std::string parameters;
    for (const auto& n : names) parameters += "output varying float " + n + " = 0;";
    const auto surface = compiler.loadText("surface s(" + parameters + ") {" + body + "}", "surface.sl", d);
    if (!layer || !surface) return {};
    KernelOptions o;
    o.lanes = lanes;
    o.mixed = mixed;
    o.outputs = names;
    for (const auto& [handle, gain, category] : {std::tuple{"a", 2.0f, "paint,wet"}, std::tuple{"b", 10.0f, "dust"}}) {
        CoShader c = ShaderCompiler::coShader(layer, handle);
        c.numbers["gain"] = {gain};
        c.strings["__category"] = category;
        o.coShaders.push_back(c);
    }
    const auto kernel = compiler.kernel(surface, o, d);
    if (!kernel) return {};
    std::vector<std::vector<float>> out;
    if (!runPoints(*kernel, mixed, 1, evaluationPoint(), compiler.parameterValues(surface, d), out, d)) return {};
    std::vector<float> values;
    for (const auto& v : out) values.push_back(v[0]);
    return values;
}

using Values = std::vector<float>;

TEST(CoShaders, MethodsAndMembers) {
    for (const int lanes : {4, 8, 16})
        for (const bool mixed : {false, true}) {
            Diagnostics d;
            // scaled(k) = k * 3 * gain: 6 for "a" with k = 1, 30 for "b"; each has its own count of calls.
            EXPECT_EQ(shade(R"(shader h = getshader("a"), g = getshader("b");
                               color c = h->tint(color(1, 2, 3), 1);
                               color e = g->tint(1, 1);
                               x = c[1];
                               y = e[0];
                               h->split(2.75, z, w);
                               n = h->calls * 100 + g->calls + h->gain * 1000;)",
                            {"x", "y", "z", "w", "n"}, d, lanes, mixed),
                      (Values{12, 30, 2, 0.75f, 3101}));
            EXPECT_EQ(d.errors(), 0);
        }
}

// What a kernel says while it runs names the file in which it stands, that of the co-shader or its own.
TEST(CoShaders, PlacesAreInTheirOwnFiles) {
    Diagnostics d;
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    const auto layer = compiler.loadText("class layer()\n{\n    public void tell(float k)\n    {\n        printf(\"%f\\n\", k);\n"
                                         "    }\n}",
                                         "layer.sl", d);
    const auto surface = compiler.loadText(
        "surface s()\n{\n    shader h = getshader(\"a\");\n    h->tell(s);\n    print(\"here\", s);\n}", "surface.sl", d);
    ASSERT_TRUE(layer && surface);
    KernelOptions o;
    o.coShaders.push_back(ShaderCompiler::coShader(layer, "a"));
    const auto kernel = compiler.kernel(surface, o, d);
    ASSERT_TRUE(kernel);
    std::set<std::string> places;
    for (const ir::Site& site : kernel->sites()) {
        ASSERT_LT(size_t(site.place.file), kernel->files().size());
        places.insert(site.op + " " + kernel->files()[size_t(site.place.file)] + ":" + std::to_string(site.place.line));
    }
    EXPECT_TRUE(places.count("printf layer.sl:5"));
    EXPECT_TRUE(places.count("print surface.sl:5"));
    EXPECT_EQ(kernel->files()[0], "surface.sl");
}

TEST(CoShaders, OptionalArgumentsOfMethods) {
    Diagnostics d;
    // In order, by name in any order, or left out: the gain of "a" is 2.
    EXPECT_EQ(shade(R"(shader h = getshader("a"); float r = 0, list[] = {3, 4, 5};
                       h->options(r, 7); x = r;
                       h->options(r, 7, 5); y = r;
                       h->options(r, 7, "mode", "times", "by", 3); z = r;
                       h->options(r, 7, 5, "more", list); w = r;
                       h->options(r, 1, 2, "times", list); q = r;)",
                    {"x", "y", "z", "w", "q"}, d),
              (Values{12027, 12012, 12021, 33012, 33002}));
    EXPECT_EQ(d.errors(), 0);
    EXPECT_TRUE(shade(R"(shader h = getshader("a"); float r = 0; h->options(r, 7, "weight", 3); x = r;)", {"x"}, d).empty());
    EXPECT_EQ(d.errors(), 1); // there is no parameter 'weight'
}

TEST(CoShaders, NullAndUnknownHandles) {
    Diagnostics d;
    EXPECT_EQ(shade(R"(shader h = getshader("nobody"); shader g = null;
                       x = (h == null) ? 1 : 2; y = (g != null) ? 1 : 2; z = (getshader("a") != null) ? 1 : 2;)",
                    {"x", "y", "z"}, d),
              (Values{1, 2, 1}));
    EXPECT_EQ(shade(R"(shader h = getshader("nobody"); x = 4; if (h != null) x = h->gain;)", {"x"}, d), (Values{4}));
    EXPECT_TRUE(d.all().empty());
}

TEST(CoShaders, ArraysOfHandlesInLoops) {
    Diagnostics d;
    // 2 + 10 of the gains; 6 + 30 of the methods; one call each.
    EXPECT_EQ(shade(R"(shader all[] = getshaders(); float i; n = arraylength(all);
                       for (i = 0; i < arraylength(all); i += 1) {
                           x += all[i]->gain;
                           color c = all[i]->tint(1, 1);
                           y += c[0];
                       }
                       shader a = getshader("a");
                       z = a->calls;)",
                    {"n", "x", "y", "z"}, d),
              (Values{2, 12, 36, 1}));
    EXPECT_EQ(shade(R"(shader wet[] = getshaders("category", "wet"); shader dry[] = getshaders("category", "-wet");
                       x = wet[0]->gain; y = dry[0]->gain; n = arraylength(wet) * 10 + arraylength(dry);)",
                    {"x", "y", "n"}, d),
              (Values{2, 10, 11}));
    EXPECT_EQ(d.errors(), 0);
}

TEST(CoShaders, GetVariable) {
    Diagnostics d;
    EXPECT_EQ(shade(R"(shader h = getshader("b"); float g = 0; x = getvar(h, "gain", g); y = g;
                       z = getvar(h, "nothing", g) + getvar(h, "hidden", g); n = g;)",
                    {"x", "y", "z", "n"}, d),
              (Values{1, 10, 0, 10}));
    EXPECT_EQ(d.errors(), 0);
}

TEST(CoShaders, ErrorsHaveTheirPlaces) {
    const auto message = [](const std::string& body) {
        Diagnostics d;
        shade(body, {"x"}, d);
        std::string all;
        for (const auto& m : d.all())
            all += std::to_string(m.place.line) + ":" + std::to_string(m.place.column) + " " + m.message + "\n";
        return all;
    };
    EXPECT_NE(
        message("\nshader h = getshader(\"a\"); x = h->none(1);").find("2:33 co-shader 'a' (layer) has no public method 'none'"),
        std::string::npos);
    EXPECT_NE(
        message("\nshader h = getshader(\"a\"); x = h->hidden;").find("2:33 co-shader 'a' (layer) has no public member 'hidden'"),
        std::string::npos);
    EXPECT_NE(message("\nshader h = null; x = h->gain;").find("2:22 this handle is null here"), std::string::npos);
    EXPECT_NE(message("\nfloat f = 1; x = f->gain;").find("2:19 '->' needs a structure or a shader, not float"),
              std::string::npos);
    EXPECT_NE(message("\nshader h = getshader(\"a\"); h->tint(P, \"s\");").find("argument 2 of method 'tint'"),
              std::string::npos);
}

/// A handle that is known only when the shader runs may stand for an object without the method, if the call is not reached.
TEST(CoShaders, AMethodThatNobodyHasIsSaidWhereItIsReached) {
    const auto asking = [](const char* kind, std::vector<float>& values) {
        Diagnostics d;
        values = shade(std::string("shader all[] = getshaders(); float kind = ") + kind +
                           "; uniform float i; for (i = 0; i < arraylength(all); i += 1) {"
                           " if (kind < u - 1) n += all[i]->none(1); else x += all[i]->gain; } y = 5;",
                       {"x", "y", "n"}, d);
        std::string said;
        for (const auto& m : d.all()) said += m.message + "\n";
        return said;
    };
    std::vector<float> values;
    EXPECT_EQ(asking("0", values), "");
    EXPECT_EQ(values, (Values{12, 5, 0}));
    const std::string said = asking("-9", values);
    EXPECT_EQ(values, (Values{0, 5, 0}));
    EXPECT_NE(said.find("co-shader 'a' (layer) has no public method 'none' with 1 argument"), std::string::npos) << said;
    EXPECT_NE(said.find("the call does nothing"), std::string::npos) << said;
}

/// What a chain of n co-shaders gives, each of which calls the next.
std::string chain(int n, float& value) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    const auto link = compiler.loadText(R"(class link(string next = "";) {
        public float down(float x) {
            float y = x + 1;
            if (next != "") { shader h = getshader(next); y = h->down(y); }
            return y;
        } })",
                                        "link.sl", d);
    const auto top = compiler.loadText(
        "surface top(output varying float r = 0;) { shader h = getshader(\"0\"); r = h->down(0); }", "top.sl", d);
    KernelOptions o;
    o.outputs = {"r"};
    for (int i = 0; i < n; i++) {
        o.coShaders.push_back(ShaderCompiler::coShader(link, std::to_string(i)));
        o.coShaders.back().strings["next"] = i + 1 < n ? std::to_string(i + 1) : "";
    }
    std::vector<std::vector<float>> out;
    const auto kernel = compiler.kernel(top, o, d);
    if (kernel && runPoints(*kernel, false, 1, evaluationPoint(), compiler.parameterValues(top, d), out, d)) value = out[0][0];
    std::string all;
    for (const auto& m : d.all())
        if (m.severity >= Severity::Error) all += m.message;
    return all;
}

TEST(CoShaders, DepthAndRecursion) {
    float value = 0;
    EXPECT_EQ(chain(limits::kCoShaderDepth, value), "");
    EXPECT_EQ(value, float(limits::kCoShaderDepth));
    EXPECT_NE(chain(limits::kCoShaderDepth + 3, value).find("co-shaders call each other more than"), std::string::npos);
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    const auto loop = compiler.loadText(
        "class loop() { public float f(string to) { shader h = getshader(to); return h->f(to); } }", "loop.sl", d);
    const auto top = compiler.loadText("surface top(string to = \"0\"; output varying float r = 0;) { shader h = getshader(to);"
                                       " string x = (u > 0.3) ? \"0\" : \"1\"; r = h->f(x); }",
                                       "top.sl", d);
    ASSERT_TRUE(loop && top);
    KernelOptions o;
    for (int i = 0; i < 30; i++) o.coShaders.push_back(ShaderCompiler::coShader(loop, std::to_string(i)));
    EXPECT_EQ(compiler.kernel(top, o, d), nullptr);
    EXPECT_GT(d.errors(), 0);
}

TEST(CoShaders, TakeAndChangeStructures) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    const std::string pair = "struct pair { float a = 2; color c = 0; }\n";
    const auto layer = compiler.loadText(
        pair + "class layer() { public void fill(output pair p; float k) { p->c = p->a * k; p->a = 7; } }", "layer.sl", d);
    const auto top =
        compiler.loadText(pair + "surface top(output varying float r = 0;) { pair p; shader h = getshader(\"layer\");"
                                 " if (h != null) h->fill(p, 3); r = p->a * 10 + comp(p->c, 1); }",
                          "top.sl", d);
    ASSERT_TRUE(layer && top);
    KernelOptions o;
    o.outputs = {"r"};
    o.coShaders.push_back(ShaderCompiler::coShader(layer, "layer"));
    std::vector<std::vector<float>> out;
    const auto kernel = compiler.kernel(top, o, d);
    ASSERT_TRUE(kernel && runPoints(*kernel, false, 1, evaluationPoint(), compiler.parameterValues(top, d), out, d));
    EXPECT_EQ(out[0][0], 76);
    EXPECT_EQ(d.errors(), 0);
}

TEST(CoShaders, GiveStructures) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    const std::string pair = "struct pair { float a = 2; color c = 0; }\n";
    const auto layer = compiler.loadText(pair + R"(class layer(float gain = 5) {
        public pair give(float k) { pair p; p->a = k * gain; p->c = color(1, k, 3); return p; }
        public pair turned(pair p; float k) { pair t; t->a = comp(p->c, 1); t->c = p->a + k; return t; } })",
                                         "layer.sl", d);
    const auto top = compiler.loadText(pair + R"(float sum(pair p) { return p->a + 10 * comp(p->c, 1); }
        pair of(shader h) { return h->give(4); }
        surface top(output varying float r = 0, q = 0, s = 0, t = 0;)
        {
            shader h = getshader("layer");
            pair p, x = of(h);
            p = h->give(2);
            r = p->a * 10 + comp(p->c, 1);
            q = sum(h->give(3));
            s = x->a + 100 * comp(x->c, 1);
            p = h->turned(p, 1);
            t = p->a + 10 * comp(p->c, 2);
        })",
                                       "top.sl", d);
    ASSERT_TRUE(layer && top);
    KernelOptions o;
    o.outputs = {"r", "q", "s", "t"};
    CoShader c = ShaderCompiler::coShader(layer, "layer");
    c.numbers["gain"] = {5};
    o.coShaders.push_back(c);
    std::vector<std::vector<float>> out;
    const auto kernel = compiler.kernel(top, o, d);
    ASSERT_TRUE(kernel && runPoints(*kernel, false, 1, evaluationPoint(), compiler.parameterValues(top, d), out, d));
    EXPECT_EQ(out[0][0], 102); // a = 2 * 5, c = (1, 2, 3)
    EXPECT_EQ(out[1][0], 45);  // a = 3 * 5, c = (1, 3, 3)
    EXPECT_EQ(out[2][0], 420); // a = 4 * 5, c = (1, 4, 3)
    EXPECT_EQ(out[3][0], 112); // a = 2, c = 10 + 1
    EXPECT_EQ(d.errors(), 0);
}

TEST(Structures, AtMostSoMany) {
    std::string text;
    for (int i = 0; i <= limits::kStructs; i++) text += "struct s" + std::to_string(i) + " { float x; }\n";
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    EXPECT_EQ(compiler.loadText(text + "surface s() {}", "many.sl", d), nullptr);
    ASSERT_EQ(d.errors(), 1);
    EXPECT_EQ(d.all()[0].place.line, limits::kStructs + 1);
}

} // namespace
} // namespace alpenglow::rsl::coshaders_test
