// Handles of shaders are a type: `shader`, next to strings and not one of them.
#include "rsl/front/ast.h"
#include <gtest/gtest.h>

namespace alpenglow::rsl {
namespace {

std::string messages(const std::string& text) {
    Diagnostics d;
    compileText(text, "test.sl", {}, d);
    std::string all;
    for (const Diagnostic& m : d.all()) all += toString(m);
    return all;
}

std::string inShader(const std::string& statements) {
    return "struct Pair { shader of; string name; }\n"
           "shader itself(shader x) { return x; }\n"
           "void fill(output shader x; output string y) { x = null; y = \"a\"; }\n"
           "surface s(float size = 1) { shader h = null, g = null, many[2] = {null, h}; string text = \"a\", texts[2] = {\"a\", "
           "text};\n"
           "float f = 0; color c = 0; Pair pair;\n" +
           statements + "\n}";
}

TEST(Handles, DoNotMixWithOtherTypes) {
    const struct {
        const char *statement, *id;
    } cases[] = {{"h = text;", "bad-assignment"},
                 {"h = \"a\";", "bad-assignment"},
                 {"text = h;", "bad-assignment"},
                 {"f = h;", "bad-assignment"},
                 {"h = 1;", "bad-assignment"},
                 {"many = texts;", "bad-assignment"},
                 {"texts = many;", "bad-assignment"},
                 {"many[0] = text;", "bad-assignment"},
                 {"pair->of = pair->name;", "bad-assignment"},
                 {"text = itself(h);", "bad-assignment"},
                 {"if (h == text) f = 1;", "bad-operands"},
                 {"text = text + h;", "bad-operands"},
                 {"h = h + g;", "bad-operands"},
                 {"h += g;", "bad-operands"},
                 {"f = -h;", "bad-operands"},
                 {"if (h < g) f = 1;", "bad-operands"},
                 {"if (h) f = 1;", "bad-condition"},
                 {"h = f > 0 ? h : text;", "bad-alternatives"},
                 {"h = shader text;", "bad-conversion"},
                 {"text = string h;", "bad-conversion"},
                 {"c = color h;", "bad-conversion"},
                 {"c = color h (1, 2, 3);", "space-name"},
                 {"f = text->size;", "member-of-nothing"},
                 {"f = many->size;", "member-of-nothing"},
                 {"f = h[0];", "no-elements"},
                 {"shader k[2] = {\"a\", h};", "type-mismatch"},
                 {"shader k = \"a\";", "type-mismatch"},
                 {"shader open[]; push(open, \"a\");", "type-mismatch"},
                 {"string open[]; push(open, h);", "type-mismatch"},
                 {"shader wrong() { return \"a\"; } h = wrong();", "type-mismatch"},
                 {"h = itself(text);", "no-matching-call"},
                 {"getvar(text, \"size\", f);", "no-matching-call"},
                 {"fill(h, g);", "no-matching-call"},
                 {"void inner() { extern string h; h = \"a\"; } inner();", "extern-type"}};
    for (const auto& c : cases) {
        const std::string m = messages(inShader(c.statement));
        EXPECT_NE(m.find(std::string("[") + c.id + "]"), std::string::npos) << c.statement << "\n" << m;
    }
}

TEST(Handles, AreAssignedComparedAndGivenAsWhatTheyAre) {
    for (const char* statement :
         {"h = g; many[1] = h; h = many[0]; many = many;", "if (h == null || h != g) f = 1;", "h = f > 0 ? g : null;",
          "h = itself(itself(h)); fill(h, text); fill(many[1], texts[0]);", "pair->of = h; h = pair->of;",
          "shader open[] = getshaders(); push(open, h); h = pop(open); f = arraylength(open);",
          "getvar(h, \"name\", text); getvar(h, \"next\", g); getvar(null, \"size\", f);",
          "h = getshader(\"a\"); shader all[] = getlights();", "printf(\"%h %s\", h, text);", "h = shader g;",
          "void inner() { extern shader h; h = null; } inner();"})
        EXPECT_EQ(messages(inShader(statement)), "") << statement;
}

/// What other shaders give is whatever is wanted.
TEST(Handles, MembersOfOthersAreTextsAndHandles) {
    for (const char* statement :
         {"text = h->name; h = h->next; f = h->size; c = h->tint;", "if (h->next == g) f = 1; if (h->name == text) f = 2;",
          "h = h->next->next; f = h->next->size;", "text = string h->name; h = shader h->next;",
          "h = itself(h->next); fill(h, text);", "many = h->all; texts = h->names;"})
        EXPECT_EQ(messages(inShader(statement)), "") << statement;
}

TEST(Handles, HaveTheirTypeInTheCheckedTree) {
    Diagnostics d;
    const auto p = compileText("struct Pair { shader of; string name; }\n"
                               "surface s(shader one = null; shader list[2] = {null, null}; string text = \"\")\n"
                               "{ Pair pair; pair->of = one; shader open[] = getshaders(); }",
                               "test.sl", {}, d);
    ASSERT_TRUE(p);
    const Shader& s = *p->shaders[0];
    EXPECT_EQ(s.parameters[0].symbol->type, (Type{Base::Shader, 0}));
    EXPECT_EQ(s.parameters[1].symbol->type, (Type{Base::Shader, 2}));
    EXPECT_EQ(s.parameters[2].symbol->type, (Type{Base::String, 0}));
    int members = 0;
    for (const auto& x : s.symbols) members += x->name == "pair->of" && x->type == Type{Base::Shader, 0};
    EXPECT_EQ(members, 1);
    EXPECT_EQ(toString(Type{Base::Shader, -1}), "shader[]");
    EXPECT_EQ(storedType({Base::Shader, 2}), (Type{Base::String, 2}));
    EXPECT_EQ(storedType({Base::Color, 0}), (Type{Base::Color, 0}));
}

} // namespace
} // namespace alpenglow::rsl
