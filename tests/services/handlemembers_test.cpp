// Members by handles that are known only when the shader runs: every co-shader that may be meant is looked at, and only the one
// that is meant has to have the member. Arrays of texts of attributes and options.
#include "integrator/harness.h"

namespace handlemembers_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2]\n";

/// What the body makes of Ci, with "a" and "b" (two of one class) and "k" (of another) bound; and what was said.
struct Asked {
    Color seen;
    std::string said;
};

Asked ask(const std::string& name, const std::string& body, const std::string& before = "") {
    writeShader(
        "listing",
        "class listing(float amount = 2; string name = \"n\"; float numbers[3] = {1, 2, 3}; string __category = \"list\";) {\n"
        "    public string words[];\n"
        "    public void construct() { push(words, \"first\"); push(words, name); }\n"
        "    public void grow(output float all[]) { push(all, amount); }\n}\n");
    writeShader("weighing", "class weighing(float weight = 5; string words = \"one text\"; float numbers = 4;) { public float "
                            "heavy() { return weight; } }\n");
    writeShader(name, "class " + name +
                          "() {\n    shader all[];\n    public void surface(output color Ci, Oi) {\n        uniform float i; Oi "
                          "= 1; Ci = 0;\n" +
                          "        all = getshaders();\n" + body + "\n    }\n}\n");
    Scene s(before +
            "WorldBegin\nShader \"listing\" \"a\" \"string name\" [\"x\"]\nShader \"listing\" \"b\" \"float amount\" [7] "
            "\"string name\" [\"y\"]\n" +
            "Shader \"weighing\" \"k\"\nSurface \"" + name +
            "\"\nAttribute \"user\" \"string[3] names\" [\"p\" \"q\" \"r\"] \"string one\" [\"alone\"]\n" + kSquare +
            "WorldEnd\n");
    const Color c = s.one(rayTo({0, 0, 0}, {.2f, .3f, 2}));
    return {c, s.messages()};
}

TEST(HandleMembers, OnlyTheShaderThatIsMeantNeedsTheMember) {
    // amount 2 and 7, weight 5; numbers[2] twice; words[1] is "x" and "y"; two arrays of two words.
    const Asked a = ask("meant", R"(
        for (i = 0; i < arraylength(all); i += 1) {
            if (hasmethod(all[i], "heavy") == 1) Ci += color(all[i]->weight, 0, 0);
            else {
                string copy[] = all[i]->words;
                Ci += color(all[i]->amount, all[i]->numbers[2], arraylength(all[i]->words) * 10);
                if (all[i]->words[1] == "y" || copy[1] == "x") Ci += color(0, 0, 1);
            }
        })");
    EXPECT_EQ(a.said, "");
    EXPECT_FLOAT_EQ(a.seen.x, 14);
    EXPECT_FLOAT_EQ(a.seen.y, 6);
    EXPECT_FLOAT_EQ(a.seen.z, 42);
}

TEST(HandleMembers, OneThatLacksItSaysSoWhenTheShaderRuns) {
    const Asked a =
        ask("lacking", "        for (i = 0; i < arraylength(all); i += 1) Ci += color(all[i]->amount, 1, all[i]->numbers[0]);");
    EXPECT_NE(a.said.find("co-shader 'k' (weighing) has no public member 'amount'; the value is nothing"), std::string::npos)
        << a.said;
    EXPECT_NE(a.said.find("co-shader 'k' (weighing) has 'numbers' as float, not an array of float; the value is nothing"),
              std::string::npos)
        << a.said;
    EXPECT_FLOAT_EQ(a.seen.x, 9);
    EXPECT_FLOAT_EQ(a.seen.y, 3);
    EXPECT_FLOAT_EQ(a.seen.z, 2);
}

TEST(HandleMembers, OneThatNoShaderHasIsSaidOnlyWhereItIsReached) {
    // Without lights the loop has no turn; the co-shaders are not what its handles mean.
    const Asked none = ask("unlit", R"(
        shader lamps[] = getlights();
        for (i = 0; i < arraylength(lamps); i += 1) Ci += color(lamps[i]->strength, 0, 0);
        Ci += color(0, 4, 0);)");
    EXPECT_EQ(none.said, "");
    EXPECT_FLOAT_EQ(none.seen.x, 0);
    EXPECT_FLOAT_EQ(none.seen.y, 4);
    const Asked reached = ask("reached", "        for (i = 0; i < 1; i += 1) Ci += color(all[i]->strength, 4, 0);");
    EXPECT_NE(reached.said.find("has no public member 'strength'; the value is nothing"), std::string::npos) << reached.said;
    EXPECT_FLOAT_EQ(reached.seen.y, 4);
}

TEST(HandleMembers, WhatPrintsTakesElementsOfAnyType) {
    const Asked a = ask("printed", R"(
        shader h = getshader("b");
        if (format("%s %s %g", h->words[0], h->words[1], h->numbers[1]) == "first y 2") Ci += color(1, 0, 0);
        if (format("%s", all[0]->words[1]) == "x") Ci += color(0, 1, 0);)");
    EXPECT_EQ(a.said, "");
    EXPECT_FLOAT_EQ(a.seen.x, 1);
    EXPECT_FLOAT_EQ(a.seen.y, 1);
}

TEST(HandleMembers, AMethodMakesAnArrayLongerThatBeganWithValues) {
    const Asked a = ask("longer", R"(
        float list[] = {9};
        for (i = 0; i < 2; i += 1) all[i]->grow(list);
        Ci = color(arraylength(list), list[1], list[2]);)");
    EXPECT_EQ(a.said, "");
    EXPECT_FLOAT_EQ(a.seen.x, 3);
    EXPECT_FLOAT_EQ(a.seen.y, 2);
    EXPECT_FLOAT_EQ(a.seen.z, 7);
}

TEST(HandleMembers, ANullHandleBehindItsTestIsNotSpokenOf) {
    const Asked a = ask("tested", R"(
        shader none = getshader("nobody");
        if (none != null && none->amount > 0) Ci += color(1, 0, 0);
        if (none == null || none->amount > 0) Ci += color(0, 1, 0);)");
    EXPECT_EQ(a.said, "");
    EXPECT_FLOAT_EQ(a.seen.x, 0);
    EXPECT_FLOAT_EQ(a.seen.y, 1);
}

TEST(HandleMembers, ArraysOfTextsOfAttributesAndOptions) {
    const Asked a = ask("texts", R"(
        uniform string three[3], two[2], open[], single = "unset", wide[4];
        Ci = color(attribute("user:names", three) + attribute("user:names", open) * 10 + attribute("user:one", single) * 100,
                   0, 0);
        if (three[0] == "p" && three[2] == "r" && arraylength(open) == 3 && open[1] == "q" && single == "alone")
            Ci += color(0, 1, 0);
        uniform string given[];
        if (option("user:groups", given) == 1 && arraylength(given) == 2 && given[1] == "fill") Ci += color(0, 0, 1);
        if (attribute("user:names", single) == 0 && single == "alone") Ci += color(0, 2, 0);
        if (attribute("user:names", wide) == 0 && wide[0] == "") Ci += color(0, 4, 0);
        uniform float number = 3;
        if (attribute("user:names", number) == 0 && number == 3) Ci += color(0, 8, 0);)",
                        "Option \"user\" \"string[2] groups\" [\"key\" \"fill\"]\n");
    EXPECT_EQ(a.said, "");
    EXPECT_FLOAT_EQ(a.seen.x, 111);
    EXPECT_FLOAT_EQ(a.seen.y, 15);
    EXPECT_FLOAT_EQ(a.seen.z, 1);
}

TEST(HandleMembers, AClassLightWithoutTheArrayLeavesThePlainOneItsOwn) {
    writeShader("bare", "class bare() { public float once() { return 8; } public void light(output vector L; output color Cl;) { "
                        "L = vector(0, 0, 1); Cl = 1; } }\n");
    writeShader("listed", "light listed(uniform float steps[2] = {3, 4}; color tint = color(5, 6, 7); string words[2] = {\"a\", "
                          "\"b\"};) { illuminate(point \"world\" (0, 0, 0)) Cl = 1; }\n");
    writeShader(
        "readslights",
        "class readslights() {\n    public void surface(output color Ci, Oi) {\n        shader all[] = getlights(); uniform "
        "float i; Oi = 1; Ci = 0;\n"
        "        for (i = 0; i < arraylength(all); i += 1) {\n"
        "            if (i == 0) Ci += color(all[i]->once(), 0, 0); else Ci += color(0, all[i]->steps[1] + "
        "arraylength(all[i]->steps) * 10, all[i]->tint[2] + (all[i]->words[1] == \"b\" ? 20 : 0));\n        }\n    }\n}\n");
    Scene s(std::string("WorldBegin\nLightSource \"bare\" 1\nLightSource \"listed\" 2\nSurface \"readslights\"\n") + kSquare +
            "WorldEnd\n");
    const Color c = s.one(rayTo({0, 0, 0}, {.2f, .3f, 2}));
    EXPECT_EQ(s.messages(), "");
    EXPECT_FLOAT_EQ(c.x, 8);
    EXPECT_FLOAT_EQ(c.y, 24);
    EXPECT_FLOAT_EQ(c.z, 27);
}

TEST(HandleMembers, ElementsOfLightsByANumberThatTheRunMakes) {
    writeShader("list3", "light list3(uniform float steps[3] = {3, 4, 5}; color tint = color(10, 20, 30); string words[2] = "
                         "{\"a\", \"b\"};) { illuminate(point \"world\" (0, 0, 0)) Cl = 1; }\n");
    writeShader("readlist", "class readlist() {\n    public void surface(output color Ci, Oi) {\n        shader all[] = "
                            "getlights(); Oi = 1; Ci = 0; float k; float half = u - u + 0.5;\n"
                            "        for (k = half; k < 3; k += 1) Ci += color(all[0]->steps[k], all[0]->tint[k], 0);\n"
                            "        if (all[0]->words[half + 1] == \"b\" && all[0]->words[-half] == \"a\" && all[0]->steps[half "
                            "- 3] == 3) Ci += color(0, 0, 7);\n    }\n}\n");
    Scene s(std::string("WorldBegin\nLightSource \"list3\" 1\nSurface \"readlist\"\n") + kSquare + "WorldEnd\n");
    const Color c = s.one(rayTo({0, 0, 0}, {.2f, .3f, 2}));
    EXPECT_EQ(s.messages(), "");
    EXPECT_FLOAT_EQ(c.x, 12);
    EXPECT_FLOAT_EQ(c.y, 60);
    EXPECT_FLOAT_EQ(c.z, 7);
}

TEST(HandleMembers, LightsArePrintedByTheHandleOfTheirDeclaration) { // seed, format(): %h
    writeShader("named",
                "class named() {\n    public void surface(output color Ci, Oi) {\n        shader all[] = getlights(); Oi = 1;\n"
                "        Ci = color(format(\"%h %h\", all[0], all[1]) == \"key 7\", getlight(\"key\") == all[0], getlight(\"7\") "
                "== all[1] && all[0] != all[1]);\n    }\n}\n");
    Scene s(std::string("WorldBegin\nLightSource \"pointlight\" \"key\"\nLightSource \"pointlight\" 7\nSurface \"named\"\n") +
            kSquare + "WorldEnd\n");
    const Color c = s.one(rayTo({0, 0, 0}, {.2f, .3f, 2}));
    EXPECT_FLOAT_EQ(c.x, 1);
    EXPECT_FLOAT_EQ(c.y, 1);
    EXPECT_FLOAT_EQ(c.z, 1);
}

} // namespace

} // namespace handlemembers_test
