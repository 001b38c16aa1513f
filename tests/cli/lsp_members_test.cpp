// The language server: members, names near errors, texts that are open, and streams that lose their place.
#include "lsp_fixture.h"

namespace lsp_members_test {

namespace {

const std::string kClass =
    "class c(float k = 1;) {\n    public float gain = 2;\n    float own = 1;\n    public color ask(float x) { return x; }\n"
    "    public void surface(output color Ci, Oi) { ";
const std::string kStruct =
    "/* A ray. */\nstruct Ray { point o; vector d[2]; float len() { return 1; } };\nsurface a() {\n    Ray q; ";

std::string hoverText(const Json& j) { return j.is_object() ? j["contents"]["value"].get<std::string>() : ""; }

} // namespace

TEST_F(Server, MembersOfThisClass) {
    auto l = labels(ask("completion", kClass + "Ci = this->|; }\n}\n"));
    std::sort(l.begin(), l.end());
    EXPECT_EQ(l, (std::vector<std::string>{"ask", "gain", "k", "own", "surface"}));
}
TEST_F(Server, MembersOfAHandleArePublic) {
    auto l = labels(ask("completion", kClass + "shader h = getshader(\"x\"); Ci = h->|; }\n}\n"));
    std::sort(l.begin(), l.end());
    EXPECT_EQ(l, (std::vector<std::string>{"ask", "gain", "k", "surface"}));
}
TEST_F(Server, HoverOfAMethodBehindAHandle) {
    EXPECT_NE(hoverText(ask("hover", kClass + "shader h = getshader(\"x\"); Ci = h->as|k(1); }\n}\n")).find("color ask(float x)"),
              std::string::npos);
}
TEST_F(Server, DefinitionOfAMethodBehindAHandle) {
    const Json d = ask("definition", kClass + "shader h = getshader(\"x\"); Ci = h->as|k(1); }\n}\n");
    EXPECT_EQ(d["range"], span(3, 17, 20));
}
TEST_F(Server, MembersOfAStructure) {
    EXPECT_EQ(labels(ask("completion", kStruct + "Ci = color q->|; }\n")), (std::vector<std::string>{"o", "d", "len"}));
}
// Structures of the same members are distinguished by their type.
const std::string kAlike =
    "struct A { float x; float fromA() { return x; } };\nstruct B { float x; float fromB() { return x; } };\n"
    "struct Both { A first; B second; };\nsurface a() {\n    Both both; B q; ";
TEST_F(Server, MembersOfOneOfTwoLikeStructures) {
    EXPECT_EQ(labels(ask("completion", kAlike + "Ci = color q->|; }\n")), (std::vector<std::string>{"x", "fromB"}));
}
TEST_F(Server, MembersOfAStructureInAnother) {
    EXPECT_EQ(labels(ask("completion", kAlike + "Ci = color both->second->|; }\n")), (std::vector<std::string>{"x", "fromB"}));
}
TEST_F(Server, HoverOfAMemberOfAStructure) {
    const std::string t = hoverText(ask("hover", kStruct + "Ci = color q->|o; }\n"));
    EXPECT_NE(t.find("point o"), std::string::npos) << t;
    EXPECT_NE(t.find("member of Ray"), std::string::npos) << t;
}
TEST_F(Server, HoverOfAVariableOfAStructure) {
    const std::string t = hoverText(ask("hover", kStruct + "Ray many[3]; Ci = color ma|ny[1]->o; }\n"));
    EXPECT_NE(t.find("Ray many[3]"), std::string::npos) << t;
}
TEST_F(Server, StructuresAreOfferedAsOneVariable) {
    const auto l = labels(ask("completion", kStruct + "q->o = P; Ci = |; }\n"));
    EXPECT_TRUE(has(l, "q"));
    EXPECT_FALSE(has(l, "q->o"));
}
TEST_F(Server, HoverOfAStructure) {
    const std::string t = hoverText(
        ask("hover", "/* A ray. */\nstruct Ray { point o; vector d[2]; };\nsurface a() { R|ay q; q->o = P; Ci = 1; }\n"));
    EXPECT_NE(t.find("struct Ray {\n    point o;\n    vector[2] d;\n}"), std::string::npos) << t;
    EXPECT_NE(t.find("A ray."), std::string::npos) << t;
}
TEST_F(Server, DefinitionOfAStructure) {
    const Json d = ask("definition", "struct Ray { point o; };\nsurface a() { R|ay q; q->o = P; Ci = 1; }\n");
    EXPECT_EQ(d["range"], span(0, 7, 10));
}
// The members themselves, not the structure around them; those of a structure that is a member, and those that are inherited,
// too.
const std::string kNested = "struct Seed {\n    float at;\n};\nstruct Tree : Seed {\n    Seed inner;\n    color leaf = 1;\n    "
                            "float height() { return 2; }\n};\n";
TEST_F(Server, DefinitionOfAMemberOfAStructure) {
    EXPECT_EQ(ask("definition", kNested + "surface a() { Tree t; Ci = t->le|af; }\n")["range"], span(5, 10, 14));
}
TEST_F(Server, DefinitionOfAMemberOfAMember) {
    EXPECT_EQ(ask("definition", kNested + "surface a() { Tree t; Ci = t->inner->a|t; }\n")["range"], span(1, 10, 12));
}
TEST_F(Server, DefinitionOfAMethodOfAStructure) {
    EXPECT_EQ(ask("definition", kNested + "surface a() { Tree t; Ci = t.hei|ght(); }\n")["range"], span(6, 10, 16));
}
TEST_F(Server, TheDotIsAlsoTheDotProduct) { EXPECT_TRUE(has(labels(ask("completion", "surface a() { Ci = P.|N; }")), "N")); }
TEST_F(Server, NothingBehindAComparison) { EXPECT_TRUE(ask("completion", "surface a() { if (u >| 1) Ci = 1; }").empty()); }
TEST_F(Server, HandlesAreOfTypeShader) {
    EXPECT_NE(hoverText(ask("hover", "surface a(shader co = null;) { float x = c|o->gain; Ci = x; }")).find("uniform shader co"),
              std::string::npos);
}

// Names near an error, in the statement with it, and in a shader whose structure is broken.
TEST_F(Server, HoverBesideAnError) {
    EXPECT_NE(hoverText(ask("hover", "surface a(float rough = 1;) {\n    float q = ro|ugh;\n    Ci = ((;\n}\n"))
                  .find("uniform float rough"),
              std::string::npos);
}
TEST_F(Server, HoverInAStatementWithAnError) {
    EXPECT_NE(hoverText(ask("hover", "surface a(float rough = 1;) {\n    float q = rough;\n    Ci = nosuch(|q) + ;\n}\n"))
                  .find("float q"),
              std::string::npos);
}
TEST_F(Server, HoverInAShaderThatDoesNotEnd) {
    EXPECT_NE(
        hoverText(ask("hover", "surface a(float rough = 1;) {\n    if (ro|ugh {\n    Ci = 1;\n")).find("uniform float rough"),
        std::string::npos);
}
TEST_F(Server, DefinitionInAStatementWithAnError) {
    const Json d = ask("definition", "surface a(float rough = 1;) {\n    Ci = nosuch(1) + |rough +;\n}\n");
    EXPECT_EQ(d["range"], span(0, 16, 21));
}

// What the editor shows counts, not what the disk has, and a shader is looked at again when its header changes.
TEST_F(Server, OpenHeadersAreIncluded) {
    write("f.h", "float twice(float x) { return 2 * x; }\n");
    const std::string shader = "#include \"f.h\"\nsurface a() { Ci = thrice(1); }\n";
    begin();
    open("f.h", "float thrice(float x) { return 3 * x; }\n");
    open("a.sl", shader);
    const int known = ask("hover", "a.sl", 1, 21);
    notify("textDocument/didChange", {{"textDocument", {{"uri", uri("f.h")}, {"version", 2}}},
                                      {"contentChanges", {{{"text", "float other(float x) { return x; }\n"}}}}});
    const int unknown = ask("hover", "a.sl", 1, 21);
    open("g.h", "float late(float x) { return x; }\n"); // on no disk
    open("b.sl", "#include \"g.h\"\nsurface b() { Ci = late(1); }\n");
    end();
    const auto all = run();
    EXPECT_NE(hoverText(answer(all, known)).find("float thrice(float x)"), std::string::npos);
    EXPECT_TRUE(answer(all, unknown).is_null());
    const Json d = published(all, "a.sl");
    ASSERT_EQ(d.size(), 1u) << d;
    EXPECT_EQ(d[0]["code"], "no-such-function");
    EXPECT_TRUE(published(all, "b.sl").empty());
}

TEST_F(Server, RenamedTexts) {
    begin();
    open("a.sl", "surface a(float rough = 1;) { Ci = rough; }\n");
    notify("workspace/didRenameFiles", {{"files", {{{"oldUri", uri("a.sl")}, {"newUri", uri("b.sl")}}}}});
    const int before = ask("hover", "a.sl", 0, 36), after = ask("hover", "b.sl", 0, 36);
    end();
    const auto all = run();
    EXPECT_TRUE(answer(all, before).is_null());
    EXPECT_NE(hoverText(answer(all, after)).find("float rough"), std::string::npos);
}

TEST_F(Server, CancelledRequestsAreAnsweredAsCancelled) {
    begin();
    open("a.sl", "surface a() { Ci = 1; }\n");
    notify("$/cancelRequest", {{"id", 3}}); // there is none yet
    const int first = ask("hover", "a.sl", 0, 15), second = ask("hover", "a.sl", 0, 15);
    notify("$/cancelRequest", {{"id", second}});
    end();
    const auto all = run();
    EXPECT_FALSE(answer(all, first).contains("code"));
    EXPECT_EQ(answer(all, second)["code"], -32800);
    EXPECT_EQ(status, 0);
}

// Whatever stands where a length should be: one error, and the next message is understood.
TEST_F(Server, StreamsThatLoseTheirPlace) {
    begin();
    const std::vector<std::pair<std::string, int>> faults = {{"Content-Length: 99999999999999999999999\r\n\r\n{}", -32600},
                                                             {"Content-Length: 4000000000\r\n\r\n{\"x\": 1}", -32600},
                                                             {"Content-Length: -5\r\n\r\n{\"x\": 1}", -32700},
                                                             {"Content-Length: 12 bytes\r\n\r\n{\"x\": 1}", -32700},
                                                             {"Content-Type: text\r\n\r\n{\"x\": 1}", -32700},
                                                             {"Content-Length: 3\r\n\r\n{\"x\": [1, 2, 3]}", -32700},
                                                             {"Content-Length: 0\r\n\r\n", -32700}};
    std::vector<int> asked;
    for (const auto& f : faults) {
        raw(f.first);
        asked.push_back(request("textDocument/paint", Json::object()));
    }
    const int again = request("initialize", {{"capabilities", Json::object()}});
    raw(framed(R"({"id": {"a": 1}, "method": "textDocument/hover"})"));
    end();
    const auto all = run();
    EXPECT_EQ(status, 0);
    for (const int id : asked) EXPECT_EQ(answer(all, id)["code"], -32601);
    EXPECT_EQ(answer(all, again)["code"], -32600);
    std::vector<int> codes, expected;
    for (const Json& j : all)
        if (j.contains("error") && j["id"].is_null()) codes.push_back(j["error"]["code"].get<int>());
    for (const auto& f : faults) expected.push_back(f.second);
    expected.push_back(-32600);
    EXPECT_EQ(codes, expected);
}

TEST_F(Server, PluginsAreLoadedWhenTheyMayBe) {
    const std::string shader = "plugin \"nothing\";\nsurface a() { Ci = 1; }\n";
    begin();
    open("a.sl", shader);
    end();
    Json d = published(run(), "a.sl");
    ASSERT_EQ(d.size(), 1u);
    EXPECT_EQ(d[0]["code"], "plugin-refused");
    input.clear();
    arguments = "--allow-exec";
    begin();
    open("a.sl", shader);
    end();
    d = published(run(), "a.sl");
    ASSERT_EQ(d.size(), 1u);
    EXPECT_EQ(d[0]["code"], "plugin-missing");
}

} // namespace lsp_members_test
