// compile --json, compile -W, info: what the tools say about shaders; the manual of the shadeops is up to date.
#include "command_folder.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tools_test {

using Json = nlohmann::json;

namespace {

class Tools : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string run(const std::string& arguments) { return CommandFolder::run(arguments, "2>err"); }
    std::string errors() const {
        std::ifstream in(dir / "err");
        return {std::istreambuf_iterator<char>(in), {}};
    }
    static const Json* find(const Json& list, const std::string& id) {
        for (const Json& d : list)
            if (d["id"] == id) return &d;
        return nullptr;
    }
};

} // namespace

TEST_F(Tools, CompileJson) {
    write("a.sl", "surface a()\n{\n    Ci = mod(\"x\", 2);\n    Oi = nois(P);\n    Oi = 1\n}\n");
    const Json j = Json::parse(run("compile --json a.sl"));
    EXPECT_EQ(status, 1);
    ASSERT_EQ(j["shaders"].size(), 1u);
    EXPECT_EQ(j["shaders"][0]["ok"], false);
    const Json& list = j["diagnostics"];
    ASSERT_EQ(list.size(), 3u) << list;
    const Json* call = find(list, "no-matching-call");
    ASSERT_TRUE(call);
    EXPECT_EQ((*call)["line"], 3);
    EXPECT_EQ((*call)["column"], 10);
    EXPECT_EQ((*call)["length"], 11); // mod("x", 2)
    ASSERT_EQ((*call)["notes"].size(), 1u) << *call;
    EXPECT_EQ((*call)["notes"][0], "candidate float mod(float x, float y): argument 1 is string, not float");
    const Json* name = find(list, "no-such-function");
    ASSERT_TRUE(name);
    ASSERT_EQ((*name)["fixes"].size(), 1u);
    EXPECT_EQ((*name)["fixes"][0]["text"], "noise");
    EXPECT_EQ((*name)["fixes"][0]["length"], 4);
    const Json* semicolon = find(list, "expected-semicolon");
    ASSERT_TRUE(semicolon);
    ASSERT_EQ((*semicolon)["fixes"].size(), 1u);
    EXPECT_EQ((*semicolon)["fixes"][0]["text"], ";");
    EXPECT_EQ((*semicolon)["fixes"][0]["column"], 11);
}

TEST_F(Tools, CompileJsonOfAGoodShader) {
    write("a.sl", "light a() { solar() { Cl = 1; } }\n");
    const Json j = Json::parse(run("compile --json a.sl"));
    EXPECT_EQ(status, 0);
    EXPECT_EQ(j["diagnostics"], Json::array());
    EXPECT_EQ(j["shaders"][0]["type"], "light");
}

TEST_F(Tools, CaretRangeAndCandidates) {
    write("a.sl", "surface a()\n{\n    Ci = mod(1);\n}\n");
    run("compile a.sl");
    EXPECT_EQ(status, 1);
    const std::string e = errors();
    EXPECT_NE(e.find("[no-matching-call]"), std::string::npos) << e;
    EXPECT_NE(e.find("\n           ^~~~~~\n"), std::string::npos) << e;
    EXPECT_NE(e.find("note: candidate float mod(float x, float y): it takes 2 arguments, not 1"), std::string::npos) << e;
}

TEST_F(Tools, WarningsOnlyWhenAsked) {
    write("a.sl", "surface a(float unused = 1;)\n{\n    color c = trace(P, N);\n    Ci = c * c;\n}\n");
    run("compile a.sl");
    EXPECT_EQ(status, 0);
    EXPECT_EQ(errors().find("unused"), std::string::npos) << errors();
    const Json j = Json::parse(run("compile -W --json a.sl"));
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(find(j["diagnostics"], "unused-parameter"));
    const Json* squared = find(j["diagnostics"], "not-affine");
    ASSERT_TRUE(squared) << j;
    EXPECT_EQ((*squared)["line"], 3);
}

// Which co-shaders stand behind a handle, only a scene knows.
TEST_F(Tools, HandlesAreNotNullWithoutAScene) {
    write("a.sl",
          "class a() { public void surface(output color Ci, Oi) { shader h = getshader(\"x\"); h->put(Ci); Oi = h->get(); } }\n");
    const Json j = Json::parse(run("compile --json a.sl"));
    EXPECT_EQ(j["shaders"][0]["ok"], true);
    EXPECT_TRUE(j["diagnostics"].empty()) << j.dump();
}

TEST_F(Tools, DialectsOfEverySubcommand) {
    write(
        "a.sl",
        "#ifdef BMRT\nsurface a(float b = 1;) { Ci = b; Oi = 1; }\n#else\nsurface a(float d = 1;) { Ci = d; Oi = 1; }\n#endif\n");
    EXPECT_NE(run("info --json a.sl").find("\"d\""), std::string::npos);
    EXPECT_NE(run("info --json --dialect bmrt a.sl").find("\"b\""), std::string::npos);
    EXPECT_EQ(status, 0);
    write("a.rib", "Format 8 8 1\nProjection \"perspective\"\nWorldBegin\nSurface \"a\" \"float b\" [.5]\nTranslate 0 0 "
                   "3\nSphere 1 -1 1 360\nWorldEnd\n");
    run("render a.rib -o a.exr");
    EXPECT_NE(errors().find("has no parameter \"b\""), std::string::npos) << errors();
    run("render --dialect bmrt a.rib -o a.exr");
    EXPECT_EQ(errors().find("has no parameter"), std::string::npos) << errors();
    EXPECT_EQ(status, 0);
    run("compile --dialect nobody a.sl");
    EXPECT_EQ(status, 2);
}

// "rispec": specular() with the exponent 1 / roughness, 8 / roughness without. h is 45 degrees off N, so that roughness 4 and .5
// give one half.
TEST_F(Tools, TheDialectRispec) {
    const std::string half = "vector(1,0,0), vector(0,0,1), vector(0,0,1)";
    for (int again = 0; again < 2; ++again) { // the second time from the cache
        EXPECT_EQ(run("eval 'specularbrdf(" + half + ", 4)'"), "0.5 0.5 0.5\n");
        EXPECT_EQ(run("eval --dialect rispec 'specularbrdf(" + half + ", .5)'"), "0.5 0.5 0.5\n");
        EXPECT_EQ(run("eval --dialect prman --setup 'float r = 8 * u;' 'specularbrdf(" + half + ", r)'"), "0.5 0.5 0.5\n");
        EXPECT_EQ(run("eval --dialect RISpec --setup 'float r = u;' 'specularbrdf(" + half + ", r)'"), "0.5 0.5 0.5\n");
    }
    write("a.sl", "surface a(color c = specularbrdf(" + half + ", .5);) { Ci = c; Oi = 1; }\n");
    // A power of the cosine of 45 degrees, in floats: 2^-1 and 2^-8.
    EXPECT_NEAR(Json::parse(run("info --json --dialect rispec a.sl"))["parameters"][0]["default"][0].get<double>(), .5, 1e-6);
    EXPECT_NEAR(Json::parse(run("info --json a.sl"))["parameters"][0]["default"][0].get<double>(), 1. / 256, 1e-8);
    run("shade --patch --dialect rispec a.sl -o a.exr");
    EXPECT_EQ(status, 0) << errors();
    write("a.rib", "Option \"shade\" \"string specular\" \"blinn\"\nFormat 8 8 1\nProjection "
                   "\"perspective\"\nWorldBegin\nTranslate 0 0 3\nSphere 1 -1 1 360\nWorldEnd\n");
    run("render a.rib -o a.exr");
    EXPECT_EQ(status, 1);
    EXPECT_NE(errors().find("a.rib:1:16: error"), std::string::npos) << errors();
    EXPECT_NE(errors().find("Option \"shade\" \"specular\" cannot be \"blinn\""), std::string::npos) << errors();
    run("probe --dialect rispec --spp 16 a.rib 0,0,2 0,0,-1");
    EXPECT_EQ(errors().find("--dialect"), std::string::npos) << errors();
}

// Aqsis's calculatenormal() is of unit length: Du(P) ^ Dv(P) of 3 P is 9 long.
TEST_F(Tools, TheDialectAqsis) {
    EXPECT_EQ(run("eval 'calculatenormal(3 * P)'"), "0 0 9\n");
    EXPECT_EQ(run("eval --dialect aqsis 'calculatenormal(3 * P)'"), "0 0 1\n");
    write("n.sl", "displacement n() { P += 0.02 * noise(8 * P) * normalize(N); N = calculatenormal (P); }\n");
    run("compile --dialect aqsis n.sl");
    EXPECT_EQ(status, 0) << errors();
}

// eval and shade have maps, what a camera ray knows, and the name of the renderer.
TEST_F(Tools, MapsAndRaysWithoutAScene) {
    write("grey.sl", "surface grey() { Ci = color(.25, .5, .75); Oi = 1; }\n");
    run("shade --patch grey.sl --format 8x8 -o map.exr");
    ASSERT_EQ(status, 0) << errors();
    EXPECT_EQ(run("eval 'color texture(\"map.exr\", .5, .5)'"), "0.25 0.5 0.75\n") << errors();
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(run("eval 'float texture(\"map.exr\"[1], s, t)'"), "0.5\n") << errors();
    EXPECT_EQ(run("eval 'color environment(\"map.exr\", vector(1, 2, 3))'"), "0.25 0.5 0.75\n") << errors();
    EXPECT_EQ(run("eval --setup 'float r[2] = {0, 0}; textureinfo(\"map.exr\", \"resolution\", r);' 'r[0] + 10 * r[1]'"), "88\n");
    EXPECT_EQ(run("eval 'textureinfo(\"nosuch\", \"exists\", 0)'"), "0\n");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(run("eval 'color texture(\"nosuch.tex\")'"), "0 0 0\n");
    EXPECT_EQ(status, 1);
    const std::string said = errors();
    EXPECT_NE(said.find("nosuch.tex"), std::string::npos) << said;
    EXPECT_NE(said.find("expression:"), std::string::npos) << said;
    EXPECT_EQ(said.find("error:"), said.rfind("error:")) << said;
    EXPECT_EQ(run("eval --setup 'float d = 3; string w = \"\"; float n = rayinfo(\"depth\", d) + rayinfo(\"type\", w); string r "
                  "= \"\"; n += rendererinfo(\"renderer\", r);' "
                  "'format(\"%f %f %s %s\", n, d, w, r)'"),
              "3.000000 0.000000 camera Alpenglow\n")
        << errors();
    EXPECT_EQ(run("eval --setup 'point o = 0; vector d = 0; float l = 0; rayinfo(\"origin\", o); rayinfo(\"direction\", d); "
                  "rayinfo(\"length\", l);' 'color(zcomp(o), zcomp(d), l)'"),
              "-1 1 1\n")
        << errors();
    write("mapped.sl",
          "surface mapped(string name = \"map.exr\";) { string t = \"\"; vector d = 0; rayinfo(\"type\", t); "
          "rayinfo(\"direction\", d);\n"
          "    color e = match(\"camera\", t) ? color texture(name) : 0; Ci = e * length(d - normalize(I)) + e; Oi = 1; }\n");
    run("shade --patch mapped.sl --format 8x8 -o a.exr");
    EXPECT_EQ(status, 0) << errors();
    run("diff map.exr a.exr --tolerance 1e-5");
    EXPECT_EQ(status, 0);
    run("shade --patch mapped.sl --param name=nosuch.tex --format 8x8 -o a.exr");
    EXPECT_EQ(status, 1);
    EXPECT_NE(errors().find("mapped.sl:2:"), std::string::npos) << errors();
}

// What a terminal obeys is shown by its bytes, in messages and in what shaders print.
TEST_F(Tools, EscapesAreNotObeyed) {
    EXPECT_EQ(run("eval --setup 'string e = \"\\033[31m\"; printf(\"a\\t%sb\\n\", e);' 1"), "a\t\\x1b[31mb\n1\n");
    run("render $'no\\x1b[2Jsuch.rib'");
    EXPECT_EQ(errors().find('\x1b'), std::string::npos) << errors();
    run("eval \"$(printf 'x\\033[31m')\"");
    EXPECT_EQ(errors().find('\x1b'), std::string::npos) << errors();
    EXPECT_EQ(status, 1);
    run("eval --lanes \"$(printf '\\033[31m')\" 1");
    EXPECT_EQ(errors().find('\x1b'), std::string::npos) << errors();
    EXPECT_EQ(status, 2);
}

TEST_F(Tools, Info) {
    write("a.sl", "#pragma annotation \"author\" \"nobody\"\n"
                  "surface a(float Kd = 0.5; color tint = color \"hsv\" (0, 0, 1); point from = point \"world\" (1, 2, 3);\n"
                  "    float knots[3] = {1, 2, 3}; output varying color layer = 0;)\n"
                  "{\n    layer = Cs;\n    Ci = layer * Kd * tint * knots[1] + color(from);\n}\n");
    const Json j = Json::parse(run("info --json a.sl"));
    ASSERT_EQ(status, 0);
    EXPECT_EQ(j["type"], "surface");
    const Json& p = j["parameters"];
    ASSERT_EQ(p.size(), 5u);
    EXPECT_EQ(p[0]["name"], "Kd");
    EXPECT_EQ(p[0]["default"], Json::array({0.5}));
    EXPECT_EQ(p[0]["storage"], "uniform");
    EXPECT_EQ(p[1]["space"], "hsv");
    EXPECT_EQ(p[1]["default"], Json::array({1.0, 1.0, 1.0})); // no saturation, full value: white
    EXPECT_EQ(p[2]["space"], "world");
    EXPECT_EQ(p[3]["arraySize"], 3);
    EXPECT_EQ(p[4]["output"], true);
    EXPECT_EQ(p[4]["storage"], "varying");
    EXPECT_EQ(j["annotations"]["author"], "nobody");
    EXPECT_TRUE(j["methods"].is_array());
    const std::string text = run("info a.sl");
    EXPECT_NE(text.find("uniform color tint = color \"hsv\" (0, 0, 1)  (rgb 1 1 1)"), std::string::npos) << text;
    EXPECT_NE(text.find("uniform point from = \"world\" 1 2 3"), std::string::npos) << text;
    EXPECT_NE(text.find("annotation author: nobody"), std::string::npos) << text;
}

TEST_F(Tools, InfoOfAClass) {
    write("c.sl",
          "class c(float w[] = {}; shader layers[] = {}; shader base = null; string n = \"a\";) {\n    public float gain = 2;\n  "
          "  float own = 1;\n"
          "    public void surface(output color Ci, Oi) { Ci = gain * own; }\n    public color ask(float x;) { return x; }\n}\n");
    const Json j = Json::parse(run("info --json c.sl"));
    EXPECT_EQ(j["class"], true);
    ASSERT_EQ(j["members"].size(), 2u);
    EXPECT_EQ(j["members"][0]["name"], "gain");
    EXPECT_EQ(j["members"][0]["type"], "float");
    EXPECT_EQ(j["members"][0]["public"], true);
    EXPECT_EQ(j["members"][1]["public"], false);
    EXPECT_EQ(j["parameters"][0]["type"], "float[]");
    EXPECT_EQ(j["parameters"][0]["open"], true);
    EXPECT_EQ(j["parameters"][0]["default"], Json::array());
    EXPECT_EQ(j["parameters"][1]["type"], "shader[]");
    EXPECT_EQ(j["parameters"][2]["type"], "shader");
    EXPECT_EQ(j["parameters"][3]["type"], "string");
    const std::string text = run("info c.sl");
    for (const char* part : {"surface \"c\"  (class, ", "uniform shader base = null", "member: public varying float gain\n",
                             "method: public color ask(float x)"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

// What a default is, as it is written and as a number; what only a scene can say is not shown as a number.
TEST_F(Tools, InfoOfDefaults) {
    write("a.sl",
          "surface a(float k = 0.5 * 2; float twice = k * 2; color c = color \"hsv\" (0.5, 1, 1); point p = transform(\"world\", "
          "point(1, 2, 3));\n"
          "    color list[2] = {0, color \"hsv\" (0, 1, 1)}; vector v = normalize(vector(3, 0, 4)); string s = \"a\\\"b\";)\n"
          "{ Ci = k + twice + c + color p + list[1] + color v; if (s == \"\") Ci = 0; }\n");
    const Json j = Json::parse(run("info --json a.sl"));
    const Json& p = j["parameters"];
    ASSERT_EQ(p.size(), 7u);
    EXPECT_EQ(p[0]["default"], Json::array({1.0}));
    EXPECT_EQ(p[0]["written"], "0.5 * 2");
    EXPECT_EQ(p[1]["default"], Json::array({2.0}));
    EXPECT_EQ(p[2]["default"], Json::array({0.0, 1.0, 1.0})); // hue one half: cyan
    EXPECT_EQ(p[2]["defaultInSpace"], Json::array({0.5, 1.0, 1.0}));
    EXPECT_EQ(p[2]["written"], "color \"hsv\" (0.5, 1, 1)");
    EXPECT_EQ(p[3]["computed"], true);
    EXPECT_FALSE(p[3].contains("default"));
    EXPECT_EQ(p[4]["default"], Json::array({0.0, 0.0, 0.0, 1.0, 0.0, 0.0}));
    EXPECT_FLOAT_EQ(p[5]["default"][0].get<float>(), 0.6f);
    EXPECT_FLOAT_EQ(p[5]["default"][2].get<float>(), 0.8f);
    EXPECT_EQ(p[6]["default"], Json::array({"a\"b"}));
    const std::string text = run("info a.sl");
    for (const char* part : {"float k = 1\n", "float twice = k * 2  (2)\n", "color c = color \"hsv\" (0.5, 1, 1)  (rgb 0 1 1)\n",
                             "point p = transform(\"world\", point(1, 2, 3))  (computed)\n", "string s = \"a\\\"b\"\n"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST_F(Tools, InfoShowsWhatWasWrittenNotWhatTheCompilerMadeOfIt) {
    write("l.sl", "#include <stdrsl/RadianceSample.h>\nstruct S { float a; color b; }\n"
                  "class l(color c = 1;) {\n"
                  "    public void generateSamples(string domain; output __radiancesample samples[]) { resize(samples, 1); }\n"
                  "    public void light(output vector L; output color Cl) { L = 0; Cl = 0; }\n"
                  "    public S mine(S one; output S two[3]; float k) { return one; }\n}\n");
    const Json j = Json::parse(run("info --json l.sl"));
    EXPECT_EQ(j["types"][0], "light");
    ASSERT_EQ(j["parameters"].size(), 1u) << j["parameters"];
    EXPECT_EQ(j["methods"],
              Json::array({"void generateSamples(string domain; output __radiancesample samples[])",
                           "void light(output vector L; output color Cl)", "S mine(S one; output S two[3]; float k)"}));
    EXPECT_EQ(j["publicMethods"], Json::array({"generateSamples", "light", "mine"}));
}

TEST_F(Tools, InfoOfAClassOfSeveralKinds) {
    write("c.sl",
          "#pragma annotation \"author\" \"x\"\n#pragma annotation \"tag\" \"1\"\n#pragma annotation \"tag\" \"2\"\n"
          "struct Ray { point from; vector d[2]; float size() { return 1; } };\n"
          "class c(string __category = \"key,fill\"; float k = 1;) {\n    public constant float gain = 2;\n    uniform Ray own;\n"
          "    public void displacement(output point P; output normal N) { P += k * N * gain; }\n"
          "    public void opacity(output color Oi) { Oi = own->from[0]; }\n    float mine(shader who; output string list[];) { "
          "return 1; }\n}\n");
    const Json j = Json::parse(run("info --json c.sl"));
    EXPECT_EQ(j["types"], Json::array({"surface", "displacement"}));
    ASSERT_EQ(j["kinds"].size(), 2u);
    EXPECT_EQ(j["kinds"][0]["writes"], Json::array({"Oi"}));
    const Json both = j["kinds"][1]["writes"];
    EXPECT_NE(std::find(both.begin(), both.end(), Json("P")), both.end()) << both;
    EXPECT_EQ(j["methods"], Json::array({"void displacement(output point P; output normal N)", "void opacity(output color Oi)",
                                         "float mine(shader who; output string list[])"}));
    EXPECT_EQ(j["publicMethods"], Json::array({"displacement", "opacity"}));
    EXPECT_EQ(j["annotations"]["author"], "x");
    EXPECT_EQ(j["annotations"]["tag"], Json::array({"1", "2"}));
    EXPECT_EQ(j["categories"], Json::array({"key", "fill"}));
    EXPECT_EQ(j["members"][0]["constant"], true);
    EXPECT_EQ(j["structs"][0]["name"], "Ray");
    EXPECT_EQ(j["structs"][0]["members"][1]["type"], "vector[2]");
    EXPECT_EQ(j["structs"][0]["methods"], Json::array({"size"}));
    const std::string text = run("info c.sl");
    for (const char* part : {"surface, displacement \"c\"", "struct Ray { point from; vector[2] d; }", "displacement writes:",
                             "categories: key fill", "(run by the renderer)", "member: public constant float gain"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

// A patch of a class shows the kind that is asked for, and what cannot be shown is named.
TEST_F(Tools, ShadeOfAClass) {
    write("c.sl", "class c(float k = 1;) {\n    public void displacement(output point P; output normal N) { P += k * N; }\n"
                  "    public void opacity(output color Oi) { Oi = 0.5; }\n}\n");
    run("shade --patch c.sl -o a.exr --format 4x4");
    EXPECT_EQ(status, 0) << errors();
    run("shade --patch c.sl --kind displacement -o b.exr --format 4x4");
    EXPECT_EQ(status, 0) << errors();
    run("shade --patch c.sl --kind light -o c.exr --format 4x4");
    EXPECT_EQ(status, 2);
    EXPECT_NE(errors().find("it is: surface, displacement"), std::string::npos) << errors();
    run("shade --patch c.sl --kind displacement -o d.png --format 4x4");
    EXPECT_EQ(status, 3);
    EXPECT_NE(errors().find("writes no Ci for a PNG picture, only"), std::string::npos) << errors();
}

TEST_F(Tools, CompileJsonWhateverTheInput) {
    Json j = Json::parse(run("compile --json nowhere.sl"));
    EXPECT_EQ(status, 1);
    ASSERT_EQ(j["diagnostics"].size(), 1u);
    EXPECT_EQ(j["diagnostics"][0]["file"], "nowhere.sl");
    EXPECT_EQ(j["diagnostics"][0]["severity"], "error");
    EXPECT_EQ(j["shaders"][0]["ok"], false);
    write("a.sl", "surface a() { Ci = Kq; }\n");
    write("b.sl", "surface b() { Ci = 1; }\n");
    j = Json::parse(run("compile --json a.sl b.sl nowhere.sl"));
    EXPECT_EQ(status, 1);
    ASSERT_EQ(j["shaders"].size(), 3u);
    EXPECT_EQ(j["shaders"][0]["ok"], false);
    EXPECT_EQ(j["shaders"][1]["ok"], true);
    EXPECT_EQ(j["diagnostics"].size(), 2u);
    j = Json::parse(run("compile --json - < a.sl"));
    EXPECT_EQ(status, 1);
    EXPECT_EQ(j["diagnostics"][0]["file"], "<stdin>");
    EXPECT_EQ(j["diagnostics"][0]["column"], 20);
    EXPECT_EQ(j["diagnostics"][0]["length"], 2);
    j = Json::parse(run("compile --json - < b.sl"));
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(j["diagnostics"].empty()) << j;
    // Messages of the code behind the checker have their line, too.
    write("s.sl", "surface s()\n{\n    Ci = spline(s, 1, 2);\n}\n");
    run("compile s.sl");
    EXPECT_NE(errors().find("    Ci = spline(s, 1, 2);\n           ^~~~~~\n"), std::string::npos) << errors();
}

TEST_F(Tools, AllLightUsedNonLinearlyIsNamed) {
    write("a.sl", "surface a()\n{\n    color d = diffuse(N);\n    color t = trace(P, N);\n    Ci = pow(d[0], 2) + t * t;\n}\n");
    const Json j = Json::parse(run("compile -W --json a.sl"));
    std::vector<int> lines;
    for (const Json& d : j["diagnostics"])
        if (d["id"] == "not-affine") {
            lines.push_back(d["line"].get<int>());
            EXPECT_EQ(d["message"].get<std::string>().find("al_"), std::string::npos) << d;
        }
    EXPECT_EQ(lines, (std::vector<int>{3, 4}));
}

TEST_F(Tools, ManualOfOneShadeop) {
    const std::string text = run("info --shadeops smoothstep");
    EXPECT_EQ(status, 0);
    for (const char* part :
         {"float smoothstep(float", "Examples", "  gives  ", "Derivatives: ", "Usable in: any shader", "unbiased"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    const Json j = Json::parse(run("info --shadeops diffuse --json"));
    EXPECT_EQ(j["contexts"], Json::array({"surface", "volume"}));
    run("info --shadeops smothstep");
    EXPECT_EQ(status, 1);
    EXPECT_NE(errors().find("smoothstep"), std::string::npos);
}

TEST_F(Tools, ManualIsUpToDate) {
    std::ifstream in(ALPENGLOW_SOURCE_DIR "/docs/shadeops.md", std::ios::binary);
    ASSERT_TRUE(in.good());
    const std::string page{std::istreambuf_iterator<char>(in), {}};
    EXPECT_TRUE(page == run("info --shadeops --markdown")) << "make it again: cmake --build ... --target shadeops_manual";
}

// A file of several shaders: each is compiled, a fault in one is its own, and info describes all of them, beginning with the
// one that has the file's name.
TEST_F(Tools, AFileOfSeveralShaders) {
    write("wood.sl", "float ring(float x) { return mod(x, 1); }\nlight lamp(float k = 2;) { solar() { Cl = k; } }\nsurface "
                     "wood(float rings = 3;) { Ci = ring(rings * u); Oi = 1; }\n"
                     "class grain(float fine = 4;) { public void surface(output color Ci, Oi) { Ci = fine; } public void "
                     "displacement(output point P; output normal N) { P += fine * N; } }\n");
    Json j = Json::parse(run("compile --json wood.sl"));
    EXPECT_EQ(status, 0) << j;
    ASSERT_EQ(j["shaders"].size(), 3u) << j;
    const std::pair<const char*, const char*> expected[] = {{"lamp", "light"}, {"wood", "surface"}, {"grain", ""}};
    for (size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(j["shaders"][k]["name"], expected[k].first);
        EXPECT_EQ(j["shaders"][k]["file"], "wood.sl");
        EXPECT_EQ(j["shaders"][k]["ok"], true);
        if (*expected[k].second) EXPECT_EQ(j["shaders"][k]["type"], expected[k].second);
    }
    const std::string ir = run("compile --dump-ir wood.sl");
    for (const char* name : {"lamp", "wood", "grain"}) EXPECT_NE(ir.find(name), std::string::npos) << name;
    j = Json::parse(run("info --json wood.sl"));
    EXPECT_EQ(j["name"], "wood");
    ASSERT_EQ(j["others"].size(), 2u) << j;
    EXPECT_EQ(j["others"][0]["name"], "lamp");
    EXPECT_EQ(j["others"][1]["parameters"][0]["name"], "fine");
    const std::string text = run("info wood.sl");
    EXPECT_NE(text.find("light \"lamp\""), std::string::npos) << text;
    EXPECT_LT(text.find("surface \"wood\""), text.find("light \"lamp\""));
    // By its name a shader is found in a file of another name, alone.
    EXPECT_EQ(run("info lamp").rfind("light \"lamp\"", 0), 0u);
    EXPECT_EQ(run("info lamp").find("wood\"  ("), std::string::npos);
}

} // namespace tools_test
