// compile --json, compile -W, info: what the tools say about shaders; the manual of the shadeops is up to date.
#include "command_folder.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fs = std::filesystem;
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
    write("a.sl", "class a() { public void surface(output color Ci, Oi) { shader h = getshader(\"x\"); h->put(Ci); Oi = h->get(); } }\n");
    const Json j = Json::parse(run("compile --json a.sl"));
    EXPECT_EQ(j["shaders"][0]["ok"], true);
    EXPECT_TRUE(j["diagnostics"].empty()) << j.dump();
}

TEST_F(Tools, DialectsOfEverySubcommand) {
    write("a.sl", "#ifdef BMRT\nsurface a(float b = 1;) { Ci = b; Oi = 1; }\n#else\nsurface a(float d = 1;) { Ci = d; Oi = 1; }\n#endif\n");
    EXPECT_NE(run("info --json a.sl").find("\"d\""), std::string::npos);
    EXPECT_NE(run("info --json --dialect bmrt a.sl").find("\"b\""), std::string::npos);
    EXPECT_EQ(status, 0);
    write("a.rib", "Format 8 8 1\nProjection \"perspective\"\nWorldBegin\nSurface \"a\" \"float b\" [.5]\nTranslate 0 0 3\nSphere 1 -1 1 360\nWorldEnd\n");
    run("render a.rib -o a.exr");
    EXPECT_NE(errors().find("has no parameter \"b\""), std::string::npos) << errors();
    run("render --dialect bmrt a.rib -o a.exr");
    EXPECT_EQ(errors().find("has no parameter"), std::string::npos) << errors();
    EXPECT_EQ(status, 0);
    run("compile --dialect nobody a.sl");
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
    EXPECT_NE(text.find("uniform color tint = \"hsv\" 1 1 1"), std::string::npos) << text;
    EXPECT_NE(text.find("annotation author: nobody"), std::string::npos) << text;
}

TEST_F(Tools, InfoOfAClass) {
    write("c.sl", "class c(float w[] = {}; shader layers[] = {}; shader base = null; string n = \"a\";) {\n    public float gain = 2;\n    float own = 1;\n"
                  "    public void surface(output color Ci, Oi) { Ci = gain * own; }\n    public color ask(float x;) { return x; }\n}\n");
    const Json j = Json::parse(run("info --json c.sl"));
    EXPECT_EQ(j["class"], true);
    EXPECT_EQ(j["members"], Json::array({"float gain"}));
    EXPECT_EQ(j["parameters"][0]["type"], "float[]");
    EXPECT_EQ(j["parameters"][0]["open"], true);
    EXPECT_EQ(j["parameters"][0]["default"], Json::array());
    EXPECT_EQ(j["parameters"][1]["type"], "shader[]");
    EXPECT_EQ(j["parameters"][2]["type"], "shader");
    EXPECT_EQ(j["parameters"][3]["type"], "string");
    const std::string text = run("info c.sl");
    for (const char* part : {"surface \"c\"  (class, ", "uniform shader base", "member: float gain\n", "method: color ask(float x)"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
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
