// References, highlights, rename, semantic tokens, formatting, defaults in hovers, and scenes.
#include "lsp_fixture.h"
#include <set>

namespace lsp_navigation_test {

namespace {

const std::string kTwo = R"(float twice(float x) { return 2 * x; }
surface a(float Kd = .5, Ks = .25 * 2;)
{
    float x = twice(Kd);
    x += Kd;
    Ci = x * Kd * noise(P); // Kd
}
surface b(float Kd = 1;) { float x = twice(Kd); Ci = x; }
)";

/// "line:begin-end" of every range in a list.
std::set<std::string> ranges(const Json& list) {
    std::set<std::string> all;
    for (const Json& j : list) {
        const Json& r = j["range"];
        all.insert(std::to_string(r["start"]["line"].get<int>()) + ":" + std::to_string(r["start"]["character"].get<int>()) +
                   "-" + std::to_string(r["end"]["character"].get<int>()));
    }
    return all;
}

/// A text with the edits of a rename.
std::string edited(std::string text, const Json& edits) {
    std::vector<std::tuple<int, int, int>> places;
    for (const Json& e : edits)
        places.emplace_back(e["range"]["start"]["line"], e["range"]["start"]["character"], e["range"]["end"]["character"]);
    std::sort(places.rbegin(), places.rend());
    for (const auto& [line, begin, end] : places) {
        size_t at = 0;
        for (int i = 0; i < line; ++i) at = text.find('\n', at) + 1;
        text.replace(at + size_t(begin), size_t(end - begin), edits[0]["newText"].get<std::string>());
    }
    return text;
}

} // namespace

class Navigation : public Server {
protected:
    Json rename(const std::string& name, int line, int character, const std::string& to, std::vector<Json>* all = nullptr) {
        const int id = request(
            "textDocument/rename",
            {{"textDocument", {{"uri", uri(name)}}}, {"position", {{"line", line}, {"character", character}}}, {"newName", to}});
        end();
        const auto out = run();
        if (all) *all = out;
        return answer(out, id);
    }
    /// The text as textDocument/formatting leaves it.
    std::string formatted(const std::string& text, int tab, bool spaces) {
        input.clear();
        ids = 0;
        begin();
        open("a.sl", text);
        const int id = request("textDocument/formatting", {{"textDocument", {{"uri", uri("a.sl")}}},
                                                           {"options", {{"tabSize", tab}, {"insertSpaces", spaces}}}});
        end();
        const Json edits = answer(run(), id);
        return edits.empty() ? text : edits[0]["newText"].get<std::string>();
    }
};

TEST_F(Navigation, ReferencesAreThoseOfTheSameVariable) {
    begin();
    open("a.sl", kTwo);
    const int kd = ask("references", "a.sl", 3, 20), f = ask("references", "a.sl", 0, 7), none = ask("references", "a.sl", 5, 31);
    end();
    const auto all = run();
    EXPECT_EQ(ranges(answer(all, kd)), (std::set<std::string>{"1:16-18", "3:20-22", "4:9-11", "5:13-15"}));
    EXPECT_EQ(ranges(answer(all, f)), (std::set<std::string>{"0:6-11", "3:14-19", "7:37-42"}));
    EXPECT_TRUE(answer(all, none).is_null()); // in a comment
}

TEST_F(Navigation, ReferencesWithoutTheDeclaration) {
    begin();
    open("a.sl", kTwo);
    const int id = request("textDocument/references", {{"textDocument", {{"uri", uri("a.sl")}}},
                                                       {"position", {{"line", 3}, {"character", 10}}},
                                                       {"context", {{"includeDeclaration", false}}}});
    end();
    EXPECT_EQ(ranges(answer(run(), id)), (std::set<std::string>{"4:4-5", "5:9-10"}));
}

TEST_F(Navigation, ReferencesCrossIncludes) {
    write("h.h", "float half(float v) { return v / 2; }\n");
    begin();
    open("a.sl", "#include \"h.h\"\nsurface a() { Ci = half(s); }\n");
    open("b.sl", "#include \"h.h\"\nsurface b() { Ci = half(t) + half(s); }\n");
    const int id = ask("references", "a.sl", 1, 20);
    end();
    std::multiset<std::string> files;
    for (const Json& j : answer(run(), id)) files.insert(fs::path(j["uri"].get<std::string>()).filename().string());
    EXPECT_EQ(files, (std::multiset<std::string>{"a.sl", "b.sl", "b.sl", "h.h"}));
}

TEST_F(Navigation, HighlightsTellReadingFromWriting) {
    begin();
    open("a.sl", kTwo);
    const int id = ask("documentHighlight", "a.sl", 3, 10);
    end();
    std::map<int, int> kinds;
    for (const Json& j : answer(run(), id)) kinds[j["range"]["start"]["line"].get<int>()] = j["kind"].get<int>();
    EXPECT_EQ(kinds, (std::map<int, int>{{3, 3}, {4, 3}, {5, 2}})); // declared, +=, read
}

TEST_F(Navigation, RenameChangesOneVariable) {
    begin();
    open("a.sl", kTwo);
    const Json r = rename("a.sl", 4, 9, "diffuseness");
    std::string want = kTwo;
    for (size_t at = want.find("Kd"); at < want.find("// Kd") && at < want.find("surface b"); at = want.find("Kd", at + 3))
        want.replace(at, 2, "diffuseness");
    EXPECT_EQ(edited(kTwo, r["changes"][uri("a.sl")]), want);
}

TEST_F(Navigation, RenameReachesHeadersAndOtherTexts) {
    write("h.h", "float half(float v) { return v / 2; }\n");
    begin();
    open("a.sl", "#include \"h.h\"\nsurface a() { Ci = half(s); }\n");
    open("b.sl", "#include \"h.h\"\nsurface b() { Ci = half(t); }\n");
    const Json changes = rename("b.sl", 1, 20, "halved")["changes"];
    EXPECT_EQ(changes.size(), 3u);
    EXPECT_EQ(edited("float half(float v) { return v / 2; }\n", changes[uri("h.h")]),
              "float halved(float v) { return v / 2; }\n");
    EXPECT_EQ(edited("#include \"h.h\"\nsurface a() { Ci = half(s); }\n", changes[uri("a.sl")]),
              "#include \"h.h\"\nsurface a() { Ci = halved(s); }\n");
}

TEST_F(Navigation, RenameThatWouldBreakIsRefused) {
    struct Case {
        int line, character;
        const char* to;
        const char* why;
    };
    for (const Case& c :
         {Case{5, 20, "n", "belongs to the language"}, // noise
          Case{5, 4, "x2", "belongs to the language"}, // Ci
          Case{4, 9, "2x", "is no name"}, Case{4, 9, "float", "belongs to the language"},
          Case{4, 9, "P", "belongs to the language"}, Case{4, 9, "x", "is used already"}, Case{5, 31, "y", "no name here"}}) {
        input.clear();
        ids = 0;
        begin();
        open("a.sl", kTwo);
        const Json r = rename("a.sl", c.line, c.character, c.to);
        ASSERT_TRUE(r.contains("message")) << c.to << r;
        EXPECT_NE(r["message"].get<std::string>().find(c.why), std::string::npos) << r["message"];
    }
    // Another shader may have the name.
    input.clear();
    ids = 0;
    begin();
    open("a.sl", kTwo);
    EXPECT_TRUE(rename("a.sl", 7, 16, "Ks").contains("changes"));
}

TEST_F(Navigation, RenameSeesMacros) {
    begin();
    open("a.sl", "#define SCALE (2 * Kd)\nsurface a(float Kd = 1;) { Ci = Kd + SCALE; }\n");
    const Json r = rename("a.sl", 1, 17, "Kq");
    EXPECT_NE(r["message"].get<std::string>().find("macro"), std::string::npos) << r;
    input.clear();
    ids = 0;
    begin();
    open("a.sl", "#define SCALE (2 * Kd)\nsurface a(float Kd = 1;) { Ci = Kd + SCALE; }\n");
    EXPECT_EQ(rename("a.sl", 1, 38, "TIMES")["changes"][uri("a.sl")].size(), 2u);
}

TEST_F(Navigation, TokensAreWhatNamesAre) {
    begin();
    open("a.sl", "float f(float v) { return v; }\nsurface a(float Kd = .5;) { float x = f(Kd); Ci = noise(P) * x; }\n");
    const int id = request("textDocument/semanticTokens/full", {{"textDocument", {{"uri", uri("a.sl")}}}});
    end();
    const auto all = run();
    const Json legend = answer(all, 1)["capabilities"]["semanticTokensProvider"]["legend"]["tokenTypes"];
    const Json data = answer(all, id)["data"];
    std::vector<std::string> got;
    int line = 0, column = 0;
    for (size_t i = 0; i + 4 < data.size(); i += 5) {
        const int down = data[i].get<int>(), right = data[i + 1].get<int>();
        line += down;
        column = down ? right : column + right;
        got.push_back(std::to_string(line) + ":" + std::to_string(column) + " " +
                      legend[data[i + 3].get<size_t>()].get<std::string>() + " " + std::to_string(data[i + 4].get<int>()));
    }
    // 1 declaration, 2 cannot be written, 4 of the language
    EXPECT_EQ(got, (std::vector<std::string>{"0:6 function 1", "0:14 parameter 1", "0:26 parameter 0", "1:8 class 1",
                                             "1:16 parameter 1", "1:34 variable 1", "1:38 function 0", "1:40 parameter 0",
                                             "1:45 variable 4", "1:50 function 4", "1:56 variable 6", "1:61 variable 0"}));
}

TEST_F(Navigation, FormattingIndentsAndKeepsWhatLinesSay) {
    const std::string want = R"(#define A(x) \
        (x + \
   1)
/* a comment
      as it was */
float
f(float a,
    b)
{
    return a
        + b;
}
surface s(float Kd = 1;
    color c = color(1,
        2, 3);
)
{
    if (Kd > 0)
        for (Kd = 0; Kd < 1; Kd += 1)
            Ci = 1;
    else {
        Ci = "}" == "{" ? 1 : 0; // } {
    }

    illuminance(P) {
        Ci += Cl;
    }
}
)";
    std::string flat; // every line outside of directives and comments without its blanks
    for (size_t at = 0, n = 0; at < want.size(); ++n) {
        const size_t end = want.find('\n', at);
        std::string line = want.substr(at, end - at);
        if (n > 4) line.erase(0, line.find_first_not_of(' ') == std::string::npos ? line.size() : line.find_first_not_of(' '));
        flat += line + (n > 4 ? " \t\n" : "\n");
        at = end + 1;
    }
    EXPECT_EQ(formatted(flat + "\n\n", 4, true), want);
    EXPECT_EQ(formatted(want, 4, true), want);
    EXPECT_EQ(formatted("surface a() {\nCi = 1;\n}", 8, false), "surface a() {\n\tCi = 1;\n}\n");
    EXPECT_EQ(formatted("", 4, true), "");
}

TEST_F(Navigation, HoverHasDefaults) {
    const Json h = ask("hover", "surface a(float K|d = .5 + .25;) { Ci = Kd; }\n");
    EXPECT_NE(h["contents"]["value"].get<std::string>().find("float Kd = .5 + .25"), std::string::npos) << h;
}

TEST_F(Navigation, ScenesAreChecked) {
    begin();
    open("a.rib", "WorldBegin\nSpere 1 -1 1 360\nWorldEnd\n");
    open("b.rib", "WorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
    end();
    const auto all = run();
    const Json d = published(all, "a.rib");
    ASSERT_EQ(d.size(), 1u);
    EXPECT_EQ(d[0]["range"]["start"]["line"], 1);
    EXPECT_NE(d[0]["message"].get<std::string>().find("Sphere"), std::string::npos) << d;
    EXPECT_TRUE(published(all, "b.rib").empty());
}

TEST_F(Navigation, LargeScenesAreNotChecked) {
    begin();
    open("a.rib", "Spere 1 -1 1 360\n" + std::string(alpenglow::limits::kServerScene, '#'));
    end();
    const Json d = published(run(), "a.rib");
    ASSERT_EQ(d.size(), 1u);
    EXPECT_EQ(d[0]["severity"], 3);
}

TEST_F(Navigation, ScenesAreCompletedAndExplained) {
    write("mine.sl", "// Mine.\nsurface mine(float shine = .1;) { Ci = shine; }\n");
    write("other.rib", "# empty\n");
    const std::string text = "Option \"trace\" \"int maxdepth\" 3\nSurface \"mine\" \"shine\" [.5]\nReadArchive \"other.rib\"\n";
    begin();
    open("a.rib", text);
    const int requests = ask("completion", "a.rib", 0, 2), categories = ask("completion", "a.rib", 0, 9);
    const int names = ask("completion", "a.rib", 0, 16), shaders = ask("completion", "a.rib", 1, 10);
    const int parameters = ask("completion", "a.rib", 1, 17);
    const int request = ask("hover", "a.rib", 1, 3), option = ask("hover", "a.rib", 0, 24), shader = ask("hover", "a.rib", 1, 11);
    const int file = ask("definition", "a.rib", 1, 11), archive = ask("definition", "a.rib", 2, 15);
    const int symbols = this->request("textDocument/documentSymbol", {{"textDocument", {{"uri", uri("a.rib")}}}});
    end();
    const auto all = run();
    EXPECT_TRUE(has(labels(answer(all, requests)), "Option"));
    EXPECT_TRUE(has(labels(answer(all, categories)), "trace"));
    EXPECT_TRUE(has(labels(answer(all, names)), "int maxdepth"));
    EXPECT_TRUE(has(labels(answer(all, shaders)), "mine"));
    EXPECT_TRUE(has(labels(answer(all, shaders)), "plastic"));
    EXPECT_EQ(labels(answer(all, parameters)), std::vector<std::string>{"shine"});
    EXPECT_NE(answer(all, request)["contents"]["value"].get<std::string>().find("Surface"), std::string::npos);
    EXPECT_NE(answer(all, option)["contents"]["value"].get<std::string>().find("trace:maxdepth"), std::string::npos);
    EXPECT_NE(answer(all, shader)["contents"]["value"].get<std::string>().find("float shine = .1"), std::string::npos);
    EXPECT_EQ(fs::path(answer(all, file)["uri"].get<std::string>()).filename(), "mine.sl");
    EXPECT_EQ(fs::path(answer(all, archive)["uri"].get<std::string>()).filename(), "other.rib");
    EXPECT_EQ(answer(all, symbols)[0]["name"], "Surface \"mine\" \"shine\" [.5]");
}

// The extension for VS Code, against a stand-in for the editor.
TEST(VsCode, ClientAndGrammars) {
    if (std::system("node --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "node is not installed";
    const std::string source = ALPENGLOW_SOURCE_DIR;
    EXPECT_EQ(
        std::system(
            ("node '" + source + "/tests/cli/vscode_client.js' '" + source + "/editors/vscode' '" ALPENGLOW_PROGRAM "'").c_str()),
        0);
}

} // namespace lsp_navigation_test
