// Ids, ranges, candidates and fix-its of the messages, and the warnings of `compile -W`.
#include "base/limits.h"
#include "front_helpers.h"
#include "rsl/front/inspect.h"
#include "rsl/front/visit.h"
#include "rsl/messages/messages.h"
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

namespace messages_test {

using namespace alpenglow;
using namespace alpenglow::rsl;

namespace {

/// The only message about this body, which stands on line 2.
Diagnostic only(const std::string& body) {
    const auto c = compileBody(body);
    EXPECT_EQ(c.messages.size(), 1u) << body << "\n" << c.text();
    return c.messages.empty() ? Diagnostic{} : c.messages[0];
}

/// Ids and lines of the messages about a program, "id:line", with the warnings for who writes shaders.
std::vector<std::string> linted(const std::string& text) {
    FrontOptions o;
    o.lint = true;
    std::vector<std::string> list;
    for (const Diagnostic& d : compileSnippet(text, o).messages) list.push_back(d.id + ":" + std::to_string(d.place.line));
    return list;
}
using Ids = std::vector<std::string>;

} // namespace

TEST(Messages, IdsAreWordsJoinedByHyphens) {
    const std::regex form("[a-z][a-z0-9]*(-[a-z0-9]+)*");
    std::set<std::string> seen;
    for (const MessageKind* k : messageKinds()) {
        EXPECT_TRUE(std::regex_match(k->id, form)) << k->id;
        EXPECT_TRUE(seen.insert(k->id).second) << k->id << " is there twice";
        EXPECT_EQ(messageKind(k->id), k);
    }
    EXPECT_EQ(messageKind("rsl-error"), nullptr);
}

TEST(Messages, EveryKindHasItsOwnTexts) {
    std::set<const MessageKind*> kinds;
    std::set<std::string> texts;
    for (const MessageText* t : messageTexts()) {
        kinds.insert(&t->kind);
        EXPECT_TRUE(texts.insert(std::string(t->kind.id) + ": " + t->text).second) << t->kind.id << ": " << t->text;
    }
    EXPECT_EQ(kinds.size(), messageKinds().size());
    for (const MessageKind* k : messageKinds()) EXPECT_TRUE(kinds.count(k)) << k->id << " has no text";
}

TEST(Messages, ArgumentsFillTheTextInOrder) {
    const Raised r = msg::kMacroArguments("f{}", 2, size_t(3)); // braces of an argument are not filled
    EXPECT_EQ(r.text(), "macro 'f{}' takes 2 arguments, not 3");
    const Raised none = msg::kMemberDot;
    EXPECT_EQ(none.text(), "'.' is the dot product");
    const Diagnostic d = diagnostic(none, Rie::Syntax, {"a.sl", 2, 3});
    EXPECT_EQ(d.id, "member-dot");
    EXPECT_EQ(d.severity, Severity::Error);
    EXPECT_EQ(d.hint, "a member of a structure is read by '->'");
    EXPECT_EQ(diagnostic(none, Rie::Syntax, {}, "another").hint, "another");
    EXPECT_EQ(countArguments("a list {...} of '{}' and {}"), 2);
}

TEST(Messages, EveryExpectedErrorOfTheLanguageHasAnId) {
    // The snippets quote the beginnings of messages; whole ones are in the compiler. Here the programs themselves are compiled.
    const std::filesystem::path folder = std::filesystem::path(ALPENGLOW_SOURCE_DIR) / "tests/language";
    std::set<std::string> ids;
    int files = 0;
    for (const auto& e : std::filesystem::directory_iterator(folder)) {
        if (e.path().extension() != ".rsl") continue;
        ++files;
        std::ifstream in(e.path());
        std::string line, text;
        const auto check = [&] {
            for (const Diagnostic& d : compileSnippet(text).messages) {
                EXPECT_TRUE(messageKind(d.id)) << e.path() << ": " << d.message << " [" << d.id << "]";
                ids.insert(d.id);
            }
            text.clear();
        };
        while (std::getline(in, line)) {
            if (line.rfind("// program:", 0) == 0) check();
            else if (line.rfind("// ", 0) != 0) text += line + "\n";
        }
        check();
    }
    EXPECT_GT(files, 5);
    EXPECT_GT(ids.size(), 30u);
}

TEST(Messages, Ranges) {
    EXPECT_EQ(only("f = nosuchname;").length, 10);
    EXPECT_EQ(only("f = f ^ 2;").length, 1);
    EXPECT_EQ(only("f = sqrt(c);").length, 7);  // the whole call
    EXPECT_EQ(only("f = \"text\";").length, 1); // at the '='
}

TEST(Messages, CandidatesSayWhyNot) {
    Diagnostic d = only("f = mod(c, 1);");
    EXPECT_EQ(d.id, "no-matching-call");
    EXPECT_EQ(d.notes, (Ids{"candidate float mod(float x, float y): argument 1 is color, not float"}));
    d = only("f = mod(1);");
    EXPECT_EQ(d.notes, (Ids{"candidate float mod(float x, float y): it takes 2 arguments, not 1"}));
    d = only("f = mod(1, 2, 3);");
    EXPECT_EQ(d.notes, (Ids{"candidate float mod(float x, float y): it takes 2 arguments, not 3"}));
    d = only("fresnel(v1, n, 1, 0.5, f);");
    EXPECT_EQ(d.id, "output-argument");
    ASSERT_FALSE(d.notes.empty());
    EXPECT_NE(d.notes[0].find("argument 4 is an output and must be a variable"), std::string::npos) << d.notes[0];
    const auto c = compileSnippet("float half(float a) { return a / 2; }\nfloat half(point a) { return 1; }\n"
                                  "surface s() { Ci = half(\"x\"); }\n");
    ASSERT_EQ(c.messages.size(), 1u) << c.text();
    EXPECT_EQ(c.messages[0].notes, (Ids{"candidate float half(float): argument 1 is string, not float",
                                        "candidate float half(point): argument 1 is string, not point"}));
}

/// By the time calls are checked a structure is as many values as it has members; who reads the message wrote one.
TEST(Messages, StructuresInCallsAreWhatWasWritten) {
    const std::string structs =
        "struct S { float a = 1; color b = 2; float k[3]; public void put(float x; color c) { a = x; } }\n"
        "struct T { S s[2]; float t; }\n"
        "float f(S s; float x) { return x * s->a; }\n"
        "T g(output S s[]; string t) { T r; return r; }\n";
    const auto errorOf = [&](const std::string& statements) {
        const auto c = compileSnippet(structs + "surface s() { S s, q[3]; " + statements + " }\n");
        EXPECT_EQ(c.errors(), 1) << c.text();
        return c.messages.empty() ? Diagnostic{} : c.messages[0];
    };
    Diagnostic d = errorOf("s->put(1);");
    EXPECT_EQ(d.message, "'S->put' cannot be called with (float)");
    EXPECT_EQ(d.notes, (Ids{"candidate void S->put(float, color): it takes 2 arguments, not 1"}));
    EXPECT_EQ(d.hint, "it can be called as void S->put(float, color)");
    d = errorOf("q[1]->put(\"x\", 1);");
    EXPECT_EQ(d.notes, (Ids{"candidate void S->put(float, color): argument 1 is string, not float"}));
    d = errorOf("s->put();");
    EXPECT_EQ(d.message, "'S->put' cannot be called without arguments");
    d = errorOf("Ci = f(s);");
    EXPECT_EQ(d.message, "'f' cannot be called with (S)");
    EXPECT_EQ(d.notes, (Ids{"candidate float f(S, float): it takes 2 arguments, not 1"}));
    d = errorOf("Ci = f(s, \"x\");");
    EXPECT_EQ(d.notes, (Ids{"candidate float f(S, float): argument 2 is string, not float"}));
    d = errorOf("T r = g(q, 1);");
    EXPECT_EQ(d.message, "'g' cannot be called with (S[3], float)");
    EXPECT_EQ(d.hint, "it can be called as T g(output S[], string)");
}

TEST(Messages, WhatWasSaidToBeUnknownIsNoAdvice) {
    const auto c = compileSnippet("surface s() { Ci = list; Ci += lost; }\n");
    ASSERT_EQ(c.messages.size(), 2u) << c.text();
    EXPECT_EQ(c.messages[1].hint, "");
}

TEST(Messages, SpacesOfMapsAreNamesOrMatrices) {
    const auto c = compileSnippet("surface s(matrix m = 1; string e = \"\") {\n"
                                  "    Ci = trace(P, I, \"environmentmap\", e, \"environmentspace\", m) +\n"
                                  "         occlusion(P, N, 16, \"environmentmap\", e, \"environmentspace\", m) +\n"
                                  "         occlusion(P, N, 16, \"environmentspace\", \"shader\");\n}\n");
    EXPECT_EQ(c.errors(), 0) << c.text();
    EXPECT_EQ(compileSnippet("surface s() { Ci = trace(P, I, \"environmentspace\", N); }\n").errors(), 1);
}

TEST(Messages, CandidatesAreBounded) {
    std::string text;
    for (int k = 1; k < 3 * limits::kCandidateNotes; ++k) {
        text += "float f(";
        for (int i = 0; i < k; ++i) text += std::string(i ? ", " : "") + "float a" + std::to_string(i);
        text += ") { return 1; }\n";
    }
    const auto c = compileSnippet(text + "surface s() { Ci = f(\"x\"); }\n");
    ASSERT_EQ(c.errors(), 1) << c.text();
    for (const Diagnostic& d : c.messages)
        if (d.severity == Severity::Error) EXPECT_EQ(d.notes.size(), size_t(limits::kCandidateNotes));
}

TEST(Messages, StructuresAreBounded) {
    std::string text;
    for (int k = 0; k <= limits::kStructs; ++k) text += "struct S" + std::to_string(k) + " { float a; }\n";
    const auto c = compileSnippet(text + "surface s() { Ci = 1; }\n");
    ASSERT_GE(c.errors(), 1);
    EXPECT_EQ(c.messages[0].id, "struct-count");
    EXPECT_EQ(c.messages[0].place.line, limits::kStructs + 1);
}

TEST(Messages, FixIts) {
    Diagnostic d = only("f = nois(p);");
    ASSERT_EQ(d.fixes.size(), 1u);
    EXPECT_EQ(d.fixes[0].text, "noise");
    EXPECT_EQ(d.fixes[0].place.column, 5);
    EXPECT_EQ(d.fixes[0].length, 4);
    d = only("f = 1.5f;");
    ASSERT_EQ(d.fixes.size(), 1u);
    EXPECT_EQ(d.fixes[0].text, "1.5");
    d = only("f = max(1; 2);");
    ASSERT_EQ(d.fixes.size(), 1u);
    EXPECT_EQ(d.fixes[0].text, ",");
    EXPECT_EQ(d.fixes[0].place.column, 10);
    EXPECT_TRUE(only("f = f ^ 2;").fixes.empty());
}

TEST(Inspect, ProgramsWithErrorsComeBack) {
    Diagnostics d;
    const auto p = inspectText("float f(float a) { return a; }\n"
                               "surface s(float k = 1;) { float g = f(k); Ci = g * nosuch; }",
                               "s.sl", {}, d);
    EXPECT_EQ(d.errors(), 1);
    ASSERT_EQ(p->shaders.size(), 1u);
    EXPECT_EQ(p->shaders[0]->parameters.size(), 1u);
    EXPECT_EQ(p->functions.size(), 1u);
    Diagnostics e;
    EXPECT_TRUE(inspectText("((((", "s.sl", {}, e));
    EXPECT_GT(e.errors(), 0);
}

// Tools read structures as they are written, kernels are built from their members. A call in one form is bound to a function of
// the same form, also where a function calls another and where a method of a structure is called.
TEST(Inspect, StructuresInBothForms) {
    Diagnostics d;
    const auto p = inspectText("struct S { float a; float b; float sum() { return a + b; } }\n"
                               "float twice(S q) { return 2 * q->sum(); }\n"
                               "surface s(S k = S(1, 2);) { Ci = twice(k); }",
                               "s.sl", {}, d);
    EXPECT_TRUE(d.all().empty());
    const auto names = [](const Program& of) {
        std::vector<std::string> all;
        for (const auto& x : of.shaders.at(0)->parameters) all.push_back(x.symbol->name);
        return all;
    };
    EXPECT_EQ(names(asWritten(*p)), std::vector<std::string>{"k"});
    EXPECT_EQ(names(*p), (std::vector<std::string>{"k->a", "k->b"}));
    for (const Program* of : {&asWritten(*p), static_cast<const Program*>(p.get())}) {
        std::set<const Function*> own;
        front::everyFunction(*of, [&](const Function& f) { own.insert(&f); });
        int calls = 0;
        front::everyBody(*of, [&](const Stmt& b) {
            front::everyExpr(b, [&](const Expr& e) {
                if (!e.function) return;
                ++calls;
                EXPECT_TRUE(own.count(e.function)) << e.text;
            });
        });
        EXPECT_EQ(calls, 2);
    }
    const auto plain = inspectText("surface s() { Ci = 1; }", "s.sl", {}, d);
    EXPECT_EQ(&asWritten(*plain), plain.get());
}

TEST(Lint, Unused) {
    EXPECT_EQ(linted("surface s(\nfloat a = 1;\nfloat b = 1;)\n{\nfloat c;\nfloat d = b;\nCi = d;\n}\n"),
              (Ids{"unused-parameter:2", "unused-variable:5"}));
    EXPECT_EQ(linted("float f(float a;\nfloat b) { return a; }\nsurface s() { Ci = f(1, 2); }\n"), (Ids{"unused-parameter:2"}));
    // What is put out, what another default needs, and what a function reaches for are used.
    EXPECT_EQ(linted("surface s(output float a = 0; float b = 1; float c = b;) { a = c; Ci = 1; }"), Ids());
    EXPECT_EQ(linted("float f() { extern float k; return k; }\nsurface s(float k = 1;) { Ci = f(); }"), Ids());
    EXPECT_EQ(linted("surface s(string __category = \"x\";) { Ci = 1; }"), Ids());
}

TEST(Lint, AShaderUsesWhatAnyOfItsKindsUses) {
    // In one file a function serves two shaders; only one of them reads k by it.
    EXPECT_EQ(linted("float f(float a; float b) { return a * b; }\n"
                     "surface s() { Ci = f(1, 2); }\ndisplacement d() { P += N * f(1, 2); }\n"),
              Ids());
    EXPECT_EQ(linted("class c(float k = 1; float h = 1;)\n{\n"
                     "    public void surface(output color Ci; output color Oi) { Ci = k; Oi = 1; }\n"
                     "    public void displacement(output point P; output normal N) { P += h * N; }\n}\n"),
              Ids());
}

// A member is used where its name is behind "->" or ".", or bare in a method. What other shaders see they may use.
TEST(Lint, UnusedMembers) {
    const std::string s = "struct S {\nfloat a = 1;\nfloat b = 2;\n}\n";
    EXPECT_EQ(linted(s + "surface t() { S q; Ci = q->a; }"), Ids{"unused-member:3"});
    EXPECT_EQ(linted(s + "surface t() { S q = S(1, 2); q->b = 3; S r = q; Ci = r->a; }"), Ids());
    EXPECT_EQ(linted(s + "surface t() { Ci = 1; }"), Ids()) << "no structure of this kind";
    EXPECT_EQ(linted(s + "surface t(output S q = S(1, 2);) { Ci = q->a; }"), Ids()) << "an output of the shader";
    EXPECT_EQ(linted(s + "surface t(shader h = null;) { S q; if (h != null) h->take(q); Ci = q->a; }"), Ids());
    EXPECT_EQ(linted("struct S {\nfloat a = 1;\nfloat b = 2;\nfloat get() { return b; }\n}\nsurface t() { S q; Ci = q->a; }"),
              Ids());
    // Inherited members are those of the structure that declares them.
    EXPECT_EQ(linted(s + "struct T : S {\nfloat c = 3;\n}\nsurface t() { T q; Ci = q->a; }"),
              (Ids{"unused-member:3", "unused-member:6"}));
    // Where something is wrong, what could not be read may use it.
    EXPECT_EQ(linted(s + "surface t() {\nS q;\nCi = q->a + nosuch;\n}"), Ids{"undeclared:7"});
}

TEST(Lint, MembersReadBeforeTheyHaveAValue) {
    const std::string s = "struct In { float x; float y; }\nstruct S { In in; string t; float a[2]; }\n";
    const auto said = [&](const std::string& body) {
        FrontOptions o;
        o.lint = true;
        std::vector<std::string> list;
        for (const Diagnostic& d : compileSnippet(s + "float f(In i) { return i->x + i->y; }\n" + body, o).messages)
            if (d.id.ends_with("uninitialised")) list.push_back(d.message.substr(0, d.message.find(" read")));
        return list;
    };
    EXPECT_EQ(said("surface t() { S q; q->t = \"\"; q->a[0] = 1; q->in->x = 1; Ci = q->in->x + q->a[1]; printf(q->t); }"), Ids());
    EXPECT_EQ(said("surface t() { S q; q->in->x = 1; Ci = q->in->x + q->in->y; }"), Ids{"'q->in->y' is"});
    EXPECT_EQ(said("surface t() { S q; q->in->x = 1; Ci = f(q->in); }"), Ids{"'q->in->y' is"});
    EXPECT_EQ(said("surface t() { S q; q->a[0] = 1; Ci = q->a[0] + f(q->in); }"), Ids{"'q->in' is"});
    EXPECT_EQ(said("surface t() { S q, r; r = q; Ci = r->a[0]; }"), Ids{"'q' is"});
    EXPECT_EQ(said("surface t() { S q; if (u > .5) q->in->x = 1; Ci = q->in->x; }"), Ids{"'q->in->x' may be"});
}

TEST(Lint, MembersGivenToTwoOutputs) {
    const std::string s = "struct S { float x; float y; }\nvoid two(output float a, b) { a = u; b = a; }\n"
                          "void set(output S a; output float b) { a->x = 1; a->y = 2; b = a->y; }\n";
    EXPECT_EQ(linted(s + "surface t() { S q = S(0, 0); two(q->x, q->y); Ci = q->x; }"), Ids());
    EXPECT_EQ(linted(s + "surface t() { S q = S(0, 0); two(q->x, q->x); Ci = q->y; }"), Ids{"shared-output:4"});
    EXPECT_EQ(linted(s + "surface t() { S q = S(0, 0); set(q, q->y); Ci = q->x; }"), Ids{"shared-output:4"});
}

TEST(Lint, NothingUnlessAsked) { EXPECT_EQ(compileSnippet("surface s(float a = 1;) { float x; Ci = x; }").messages.size(), 0u); }

TEST(Lint, Uninitialised) {
    EXPECT_EQ(linted("surface s() {\nfloat x;\nCi = x;\n}"), (Ids{"uninitialised:3"}));
    EXPECT_EQ(linted("surface s() {\nfloat x;\nif (u > 0.5) x = 1;\nCi = x;\n}"), (Ids{"maybe-uninitialised:4"}));
    EXPECT_EQ(linted("surface s() {\nfloat x;\nif (u > 0.5) x = 1; else x = 2;\nCi = x;\n}"), Ids());
    EXPECT_EQ(linted("surface s() {\nfloat x;\nx += 1;\nCi = x;\n}"), (Ids{"uninitialised:3"}));
    EXPECT_EQ(linted("surface s() {\nfloat x, i;\nfor (i = 0; i < 3; i += 1) x = i;\nCi = x;\n}"),
              (Ids{"maybe-uninitialised:4"}));
    EXPECT_EQ(linted("surface s() {\ncolor c;\nilluminance(P) { c += Cl; }\nCi = c;\n}"), (Ids{"maybe-uninitialised:3"}));
    EXPECT_EQ(linted("surface s() {\nfloat a, b;\nfresnel(I, N, 1.5, a, b);\nCi = a + b;\n}"), Ids());
    EXPECT_EQ(linted("surface s() {\nfloat a[2];\na[0] = 1;\nCi = a[0];\n}"), Ids());
    EXPECT_EQ(linted("float f(float t) {\nfloat x;\nif (t > 1) return 2;\nelse x = 1;\nreturn x;\n}\nsurface s() { Ci = f(u); }"),
              Ids());
}

TEST(Lint, UniformUnderVaryingConditions) {
    EXPECT_EQ(linted("surface s() {\nuniform float n = 0;\nif (u > 0.5)\nn = 1;\nCi = n;\n}"), (Ids{"uniform-in-varying:4"}));
    EXPECT_EQ(linted("surface s(float k = 1;) {\nuniform float n = 0;\nif (k > 0.5)\nn = 1;\nCi = n;\n}"), Ids());
}

TEST(Lint, CallsWithUniformArgumentsAreUniform) {
    EXPECT_EQ(linted("surface s(string a = \"x\";) {\nuniform float n = match(\"x\", a) + stringhash(a);\nCi = n;\n}"), Ids());
}

} // namespace messages_test
