// What the language server answers, and what it says of a text by itself.
#include "lsp_fixture.h"
#include <random>

namespace lsp_test {

TEST_F(Server, LifeOfAServer) {
    begin();
    end();
    const auto all = run();
    const Json c = answer(all, 1)["capabilities"];
    EXPECT_EQ(c["positionEncoding"], "utf-16");
    EXPECT_EQ(c["hoverProvider"], true);
    EXPECT_EQ(c["textDocumentSync"]["change"], 2);
    EXPECT_TRUE(answer(all, 2).is_null());
    EXPECT_EQ(status, 0);
}

TEST_F(Server, WithoutShutdownTheStatusIsOne) {
    begin();
    notify("exit", nullptr);
    run();
    EXPECT_EQ(status, 1);
    input.clear();
    begin();
    run(); // the pipe is closed
    EXPECT_EQ(status, 1);
}

TEST_F(Server, DiagnosticsAsOneTypes) {
    begin();
    open("a.sl", "surface a()\n{\n    Ci = nois(P);\n}\n");
    const int hover = ask("hover", "a.sl", 0, 0); // an answer between, so that both states are looked at
    notify("textDocument/didChange", {{"textDocument", {{"uri", uri("a.sl")}, {"version", 2}}},
                                      {"contentChanges", {{{"range", span(2, 9, 13)}, {"text", "noize"}}}}});
    const int actions = request(
        "textDocument/codeAction",
        {{"textDocument", {{"uri", uri("a.sl")}}}, {"range", span(2, 0, 0)}, {"context", {{"diagnostics", Json::array()}}}});
    end();
    const auto all = run();
    answer(all, hover);
    const Json d = published(all, "a.sl");
    ASSERT_EQ(d.size(), 1u);
    EXPECT_EQ(d[0]["code"], "no-such-function");
    EXPECT_EQ(d[0]["severity"], 1);
    EXPECT_EQ(d[0]["range"]["start"]["line"], 2);
    EXPECT_EQ(d[0]["range"]["start"]["character"], 9);
    EXPECT_EQ(d[0]["range"]["end"]["character"], 14); // "noize"
    const Json a = answer(all, actions);
    ASSERT_EQ(a.size(), 1u);
    EXPECT_EQ(a[0]["edit"]["changes"][uri("a.sl")][0]["newText"], "noise");
    EXPECT_EQ(status, 0);
}

TEST_F(Server, CorrectedAndClosedTextsHaveNoDiagnostics) {
    begin();
    open("a.sl", "surface a() { Ci = }");
    notify("textDocument/didChange", {{"textDocument", {{"uri", uri("a.sl")}, {"version", 2}}},
                                      {"contentChanges", {{{"text", "surface a() { Ci = 1; }"}}}}});
    end();
    auto all = run();
    EXPECT_EQ(published(all, "a.sl"), Json::array());
    input.clear();
    begin();
    open("a.sl", "surface a() { Ci = }");
    notify("textDocument/didClose", {{"textDocument", {{"uri", uri("a.sl")}}}});
    end();
    all = run();
    EXPECT_EQ(published(all, "a.sl"), Json::array());
}

TEST_F(Server, PositionsAreUtf16) {
    // The letter before takes two bytes and one unit, the face four bytes and two units.
    begin();
    open("a.sl", "surface a() { /* \xC3\xA9\xF0\x9F\x98\x80 */ Ci = Kq; }");
    end();
    const Json d = published(run(), "a.sl");
    ASSERT_EQ(d.size(), 1u);
    EXPECT_EQ(d[0]["range"]["start"]["character"], 29); // 17 before the letter, 1 + 2, 3 of " */", " Ci = " 6
}

TEST_F(Server, UnusedAndUninitialised) {
    begin();
    open("a.sl", "surface a(float Kd = 1;)\n{\n    float x;\n    Ci = x;\n}\n");
    end();
    const Json d = published(run(), "a.sl");
    ASSERT_EQ(d.size(), 2u);
    EXPECT_EQ(d[0]["code"], "unused-parameter");
    EXPECT_EQ(d[0]["tags"][0], 1);
    EXPECT_EQ(d[1]["code"], "uninitialised");
    EXPECT_EQ(d[1]["range"]["start"]["line"], 3);
}

TEST_F(Server, LightUsedNonLinearly) {
    begin();
    open("a.sl", "surface a()\n{\n    color c = trace(P, N);\n    Ci = c * c;\n}\n");
    open("b.sl", "surface b()\n{\n    color c = trace(P, N);\n    Ci = c * Cs;\n}\n");
    end();
    const auto all = run();
    const Json d = published(all, "a.sl");
    ASSERT_EQ(d.size(), 1u);
    EXPECT_EQ(d[0]["code"], "not-affine");
    EXPECT_EQ(d[0]["range"]["start"]["line"], 2);
    EXPECT_EQ(published(all, "b.sl").size(), 0u);
}

TEST_F(Server, Dialect) {
    begin();
    open("a.sl", "#ifndef PRMAN\n#error another\n#endif\nsurface a() { Ci = 1; }\n");
    end();
    EXPECT_EQ(published(run(), "a.sl").size(), 1u);
    input.clear();
    arguments = "--dialect prman";
    begin();
    open("a.sl", "#ifndef PRMAN\n#error another\n#endif\nsurface a() { Ci = 1; }\n");
    end();
    EXPECT_EQ(published(run(), "a.sl").size(), 0u);
}

TEST_F(Server, CompletionOfNames) {
    const auto l = labels(ask("completion", "surface a(float roughness = 1;)\n{\n    float roundish = 2;\n    Ci = ro|\n}\n"));
    EXPECT_TRUE(has(l, "roughness"));
    EXPECT_TRUE(has(l, "roundish"));
    EXPECT_TRUE(has(l, "round"));
    EXPECT_TRUE(has(l, "rotate"));
    EXPECT_FALSE(has(l, "noise"));
}

TEST_F(Server, CompletionKnowsTheKindOfShader) {
    const auto l = labels(ask("completion", "light a()\n{\n    illuminate(point(0,0,0)) { Cl = |; }\n}\n"));
    EXPECT_TRUE(has(l, "Cl"));
    EXPECT_TRUE(has(l, "Ps"));
    EXPECT_FALSE(has(l, "Ci"));
    EXPECT_FALSE(has(l, "diffuse"));
}

TEST_F(Server, CompletionOfOptionalParameters) {
    const auto l = labels(ask("completion", "surface a()\n{\n    Ci = color texture(\"x.tx\", \"|\");\n}\n"));
    EXPECT_TRUE(has(l, "blur"));
    EXPECT_FALSE(has(l, "noise"));
}

TEST_F(Server, CompletionInACommentIsEmpty) { EXPECT_TRUE(ask("completion", "surface a() { /* no| */ }").empty()); }

TEST_F(Server, HoverOfAShadeop) {
    const Json h = ask("hover", "surface a()\n{\n    float f = smo|othstep(0, 1, u);\n    Ci = f;\n}\n");
    ASSERT_TRUE(h.is_object());
    const std::string text = h["contents"]["value"];
    EXPECT_NE(text.find("float smoothstep(float"), std::string::npos) << text;
    EXPECT_EQ(h["range"]["start"]["character"], 14);
    EXPECT_EQ(h["range"]["end"]["character"], 24);
}

TEST_F(Server, HoverOfAVariable) {
    Json h = ask("hover", "surface a(output varying color layer = 0;)\n{\n    lay|er = Cs;\n    Ci = layer;\n}\n");
    ASSERT_TRUE(h.is_object());
    EXPECT_NE(h["contents"]["value"].get<std::string>().find("output varying color layer"), std::string::npos);
    input.clear(), ids = 0;
    h = ask("hover", "surface a() { Ci = C|s; }");
    ASSERT_TRUE(h.is_object());
    EXPECT_NE(h["contents"]["value"].get<std::string>().find("varying color Cs"), std::string::npos);
}

TEST_F(Server, HoverOfAFunctionShowsTheCommentAbove) {
    const Json h = ask("hover", "// Half of it.\nfloat half(float x) { return x / 2; }\nsurface a() { Ci = ha|lf(u); }\n");
    ASSERT_TRUE(h.is_object());
    const std::string text = h["contents"]["value"];
    EXPECT_NE(text.find("float half(float x)"), std::string::npos) << text;
    EXPECT_NE(text.find("Half of it."), std::string::npos) << text;
}

TEST_F(Server, DefinitionOfALocal) {
    const Json l = ask("definition", "surface a()\n{\n    float f = 1;\n    { float f = 2; Oi = f; }\n    Ci = |f;\n}\n");
    ASSERT_TRUE(l.is_object()) << l;
    EXPECT_EQ(l["uri"], uri("a.sl"));
    EXPECT_EQ(l["range"]["start"]["line"], 2);
    EXPECT_EQ(l["range"]["start"]["character"], 10);
}

TEST_F(Server, DefinitionThroughAnInclude) {
    write("tools.h", "#define HALF 0.5\n\nfloat twice(float x)\n{\n    return 2 * x;\n}\n");
    const Marked call("#include \"tools.h\"\nsurface a() { Ci = |twice(u) * HALF; }\n");
    begin();
    open("a.sl", call.text);
    const int function = ask("definition", "a.sl", call.line, call.character);
    const int macro = ask("definition", "a.sl", 1, call.character + 12);
    const int file = ask("definition", "a.sl", 0, 12);
    end();
    const auto all = run();
    EXPECT_EQ(published(all, "a.sl"), Json::array());
    EXPECT_EQ(answer(all, function)["uri"], uri("tools.h"));
    EXPECT_EQ(answer(all, function)["range"]["start"]["line"], 2);
    EXPECT_EQ(answer(all, function)["range"]["start"]["character"], 6);
    EXPECT_EQ(answer(all, macro)["uri"], uri("tools.h"));
    EXPECT_EQ(answer(all, macro)["range"]["start"]["line"], 0);
    EXPECT_EQ(answer(all, file)["uri"], uri("tools.h"));
}

TEST_F(Server, FaultsOfAnIncludeStandAtIt) {
    write("bad.h", "float bad(float x) { return x + nosuch; }\n");
    begin();
    open("a.sl", "\n#include \"bad.h\"\nsurface a() { Ci = bad(u); }\n");
    end();
    const Json d = published(run(), "a.sl");
    ASSERT_EQ(d.size(), 1u);
    EXPECT_EQ(d[0]["range"]["start"]["line"], 1);
    EXPECT_NE(d[0]["message"].get<std::string>().find("bad.h:1:33"), std::string::npos) << d[0];
}

TEST_F(Server, Symbols) {
    const Json s =
        ask("documentSymbol", "float half(float x) { return x / 2; }\n|surface a(float Kd = 1;)\n{\n    Ci = half(Kd);\n}\n");
    ASSERT_EQ(s.size(), 2u);
    const Json& shader = s[0]["name"] == "a" ? s[0] : s[1];
    const Json& function = s[0]["name"] == "a" ? s[1] : s[0];
    EXPECT_EQ(shader["detail"], "surface");
    EXPECT_EQ(shader["children"][0]["name"], "Kd");
    EXPECT_EQ(shader["range"]["start"]["line"], 1);
    EXPECT_EQ(shader["range"]["end"]["line"], 4);
    EXPECT_EQ(function["name"], "half");
}

TEST_F(Server, SignatureHelp) {
    Json s = ask("signatureHelp", "surface a() { Ci = smoothstep(0, max(1, 2), |u); }");
    ASSERT_TRUE(s.is_object());
    EXPECT_EQ(s["activeParameter"], 2);
    const std::string active = s["signatures"][s["activeSignature"].get<size_t>()]["label"];
    EXPECT_NE(active.find("smoothstep("), std::string::npos);
    input.clear(), ids = 0;
    s = ask("signatureHelp", "float f(float a; color b) { return a; }\nsurface a() { Ci = f(1, |Cs); }");
    ASSERT_TRUE(s.is_object());
    EXPECT_EQ(s["signatures"][0]["label"], "float f(float a; color b)");
    EXPECT_EQ(s["signatures"][0]["parameters"][1]["label"], (Json{17, 24}));
    input.clear(), ids = 0;
    s = ask("signatureHelp",
            "struct S { float a; public float g(S b; float c[]) { return a; } }\nsurface a() { S s; Ci = s->g(s, |1); }");
    ASSERT_EQ(s["signatures"].size(), 1u) << s;
    EXPECT_EQ(s["signatures"][0]["label"], "float S->g(S b; float c[])");
    EXPECT_EQ(s["activeParameter"], 1);
}

TEST_F(Server, GarbageIsAnswered) {
    raw("\r\nhello\r\nContent-Length: many\r\n");
    raw(framed("{ not json"));
    raw(framed("[1, 2]"));
    raw(framed("\"text\""));
    raw(framed(Json{{"id", 777}, {"method", "textDocument/hover"}}.dump())); // before initialize
    begin();
    const int unknown = request("textDocument/paint", Json::object());
    const int bad = request("textDocument/hover", Json::array({1, 2}));
    const int worse = request("textDocument/hover", {{"textDocument", {{"uri", 5}}}, {"position", "there"}});
    const int closed = ask("hover", "never-opened.sl", 1, 1);
    open("a.sl", "surface a() { Ci = 1; }");
    const int beyond = ask("hover", "a.sl", 1000000, 2000000000);
    const int negative = ask("hover", "a.sl", -1, 0);
    notify("textDocument/didChange", {{"textDocument", {{"uri", uri("a.sl")}}}, {"contentChanges", "all"}});
    end();
    const auto all = run();
    EXPECT_EQ(answer(all, unknown)["code"], -32601);
    EXPECT_EQ(answer(all, bad)["code"], -32602);
    EXPECT_EQ(answer(all, worse)["code"], -32602);
    EXPECT_TRUE(answer(all, closed).is_null());
    EXPECT_TRUE(answer(all, beyond).is_null());
    EXPECT_EQ(answer(all, negative)["code"], -32602);
    std::vector<int> codes;
    for (const Json& j : all)
        if (j.contains("error")) codes.push_back(j["error"]["code"].get<int>());
    EXPECT_EQ(std::count(codes.begin(), codes.end(), -32700), 2) << "the header and the text that is no JSON";
    EXPECT_EQ(std::count(codes.begin(), codes.end(), -32002), 1);
    EXPECT_EQ(status, 0);
}

TEST_F(Server, RandomTextsAndPlacesDoNoHarm) {
    std::mt19937 random(20261121);
    const std::string words[] = {"surface ", "a",  "(",  ")",  "{",          "}",           ";",    "float ", "color ", "\"",
                                 "/*",       "*/", "//", "\n", "#define X(", "#include \"", "=",    "+",      "noise",  "texture",
                                 "if",       "[",  "]",  ",",  "1",          "\\",          "\xC3", "\xFF",   "extern "};
    begin();
    for (int k = 0; k < 60; ++k) {
        std::string text;
        for (int n = int(random() % 60); n > 0; --n) text += words[random() % std::size(words)];
        // Not every text is UTF-8: such messages are no JSON, and answered as such.
        const Json doc = {{"uri", uri("a.sl")}, {"languageId", "rsl"}, {"version", 1}};
        std::string body = Json{{"method", "textDocument/didOpen"}, {"params", {{"textDocument", doc}}}}.dump();
        std::string quoted = "\"";
        for (char c : text) quoted += c == '"' ? "\\\"" : c == '\\' ? "\\\\" : c == '\n' ? "\\n" : std::string(1, c);
        body.insert(body.find("\"uri\""), "\"text\":" + quoted + "\",");
        raw(framed(body));
        for (const char* m : {"completion", "hover", "definition", "documentSymbol", "signatureHelp"})
            ask(m, "a.sl", int(random() % 4), int(random() % 30));
    }
    end();
    const auto all = run();
    EXPECT_EQ(status, 0);
    for (int id = 1; id <= ids; ++id) answer(all, id);
}

TEST_F(Server, LimitOnMessages) {
    begin();
    raw(framed(std::string(alpenglow::limits::kServerMessage + 1, 'x')));
    end();
    const auto all = run();
    EXPECT_EQ(status, 0);
    int refused = 0;
    for (const Json& j : all) refused += j.contains("error") && j["error"]["code"] == -32600;
    EXPECT_EQ(refused, 1);
}

TEST_F(Server, LimitOnDocumentsAndDiagnostics) {
    begin();
    for (size_t k = 0; k <= alpenglow::limits::kServerDocuments; ++k) open("a" + std::to_string(k) + ".sl", "surface a() {}");
    std::string many = "surface b() {\n";
    for (int k = 0; k < alpenglow::limits::kServerDiagnostics + 10; ++k) many += "float x" + std::to_string(k) + ";\n";
    open("a0.sl", many + "}\n"); // it is open already, and takes no other's place
    end();
    const auto all = run();
    EXPECT_EQ(published(all, "a0.sl").size(), size_t(alpenglow::limits::kServerDiagnostics));
    const std::string last = uri("a" + std::to_string(alpenglow::limits::kServerDocuments) + ".sl");
    int count = 0;
    for (const Json& j : all)
        count += j.value("method", "") == "window/logMessage" &&
                 j["params"]["message"].get<std::string>().find(last) != std::string::npos;
    EXPECT_EQ(count, 1);
    EXPECT_EQ(status, 0);
}

} // namespace lsp_test
