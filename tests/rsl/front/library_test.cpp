// The program's own RSL: it joins a shader's text where the shader names it, and moves no place of the shader's own.
#include "front_helpers.h"
#include "rsl/front/library.h"
#include <algorithm>
#include <gtest/gtest.h>

namespace alpenglow::rsl {
namespace {

std::vector<std::string> parameterNames(const Shader& s) {
    std::vector<std::string> all;
    for (const ShaderParameter& p : s.parameters) all.push_back(p.symbol->name);
    return all;
}

/// The methods of the shader with this name.
int methods(const Shader& s, const std::string& name) {
    return int(std::ranges::count_if(s.nested, [&](const auto& f) { return f->name == name; }));
}

std::string material(const std::string& call) {
    return "class m() {\n"
           "    public void evaluateSamples(string which; output __radiancesample s[]) { s[0]->materialResponse = 1; }\n"
           "    public void lighting(output color Ci, Oi) {\n"
           "        color c;\n"
           "        Ci = " +
           call + ";\n    }\n}\n";
}

TEST(Library, AnnotationsStayWithTheirShader) {
    // sincos() and filterregion are read before the text; the first shader begins behind the first annotation.
    const Compiled c = compileSnippet("#pragma annotation \"first\" \"1\"\n"
                                      "surface one() {\n"
                                      "    filterregion r;\n"
                                      "    float x, y;\n"
                                      "    sincos(1, x, y);\n"
                                      "    Ci = x + y;\n"
                                      "#pragma annotation \"inside\" \"2\"\n"
                                      "}\n"
                                      "#pragma annotation \"second\" \"3\"\n"
                                      "surface two() { Ci = 1; }\n"
                                      "#pragma annotation \"last\" \"4\"\n");
    ASSERT_TRUE(c.program) << c.text();
    using Pairs = std::vector<std::pair<std::string, std::string>>;
    EXPECT_EQ(c.program->shaders.at(0)->annotations, (Pairs{{"first", "1"}, {"inside", "2"}}));
    EXPECT_EQ(c.program->shaders.at(1)->annotations, (Pairs{{"second", "3"}, {"last", "4"}}));
}

TEST(Library, AShadersOwnFunctionIsTaken) {
    const Compiled c = compileSnippet("void sincos(float a; output float x; output float y) { x = a; y = a; }\n"
                                      "surface s() { float x, y; sincos(1, x, y); Ci = x; }\n");
    ASSERT_TRUE(c.program) << c.text();
    EXPECT_EQ(std::ranges::count(c.program->files, "<sincos>"), 0);
}

TEST(Library, EachClassIsRead) {
    for (const front::LibraryText& t : front::libraryTexts()) {
        if (t.kind != front::LibraryText::Kind::Class) continue;
        front::SourceSet sources;
        front::Parser parser(sources);
        front::Library library(sources, parser);
        const front::ClassDefinition c = library.classNamed(t.name, {{"PLACES", "4"}, {"HANDLES", "4"}, {"LOOP", "\"\""}});
        ASSERT_TRUE(c.shader) << t.name;
        EXPECT_EQ(c.shader->name, t.name);
        EXPECT_EQ(sources.errors(), 0) << t.name;
        EXPECT_TRUE(parser.unit().classes.empty()) << t.name;
    }
}

TEST(Library, ALightOfSamplesHasTheirPlacesFirst) {
    const std::string light = "class l(uniform float gain = 2) {\n"
                              "    public void generateSamples(string integrationdomain; output __radiancesample s[]) {}\n"
                              "    public void light(output vector L; output color Cl) { BODY }\n"
                              "}\n";
    const auto with = [&](const std::string& body) {
        std::string text = light;
        return compileSnippet(text.replace(text.find("BODY"), 4, body));
    };
    const Compiled zero = with("L = vector(0, 0, 0); Cl = 0;");
    ASSERT_TRUE(zero.program) << zero.text();
    const Shader& s = *zero.program->shaders.at(0);
    EXPECT_EQ(parameterNames(s), (std::vector<std::string>{"__sentL", "__sentCl", "__sentOnly", "gain"}));
    EXPECT_EQ(methods(s, kReplacedLight), 1);
    EXPECT_EQ(methods(s, "light"), 1);
    // A light() that says something is the light.
    const Compiled own = with("L = vector(0, 0, 1); Cl = gain;");
    ASSERT_TRUE(own.program) << own.text();
    EXPECT_EQ(parameterNames(*own.program->shaders.at(0)), std::vector<std::string>{"gain"});
    EXPECT_EQ(methods(*own.program->shaders.at(0), kReplacedLight), 0);
}

TEST(Library, EachEmissionIsAddedWhereItStands) {
    const Compiled c = compileSnippet("class e() {\n"
                                      "    public void prelighting(output color Ci, Oi) {\n"
                                      "        if (u > 0.5) emit(color(1, 2, 3));\n"
                                      "    }\n"
                                      "    public void lighting(output color Ci, Oi) { Ci = 1; }\n"
                                      "}\n");
    ASSERT_TRUE(c.program) << c.text();
    std::vector<ShaderKind> kinds;
    for (const auto& s : c.program->shaders) kinds.push_back(s->kind);
    EXPECT_TRUE(std::ranges::count(kinds, ShaderKind::Light)) << "the class is a light, too";
    for (const auto& f : c.program->shaders.at(0)->nested) {
        if (f->name != "prelighting") continue;
        const std::string text = print(*f->body);
        EXPECT_LT(text.find("__emitted"), text.find("emit(")) << text;
    }
}

TEST(Library, CallsGetOnlyTheMethodsThatTheyNeed) {
    const Compiled all = compileSnippet(material("directlighting(this, \"diffuseresult\", c)"));
    ASSERT_TRUE(all.program) << all.text();
    EXPECT_EQ(methods(*all.program->shaders.at(0), "__direct"), 1);
    EXPECT_EQ(methods(*all.program->shaders.at(0), "__directof"), 0);
    EXPECT_EQ(methods(*all.program->shaders.at(0), "evaluateSamples"), 1) << "the class has its own";
    const Compiled some = compileSnippet(material("directlighting(this, getlights()) + directlighting(this)"));
    ASSERT_TRUE(some.program) << some.text();
    EXPECT_EQ(methods(*some.program->shaders.at(0), "__direct"), 1);
    EXPECT_EQ(methods(*some.program->shaders.at(0), "__directof"), 1);
}

TEST(Library, MessagesAboutCallsStandAtTheCall) {
    const Compiled unknown = compileSnippet(material("directlighting(this, \"diffuseresult\", c, \"mix\", 1)"));
    ASSERT_EQ(unknown.messages.size(), 1u) << unknown.text();
    EXPECT_EQ(unknown.messages[0].id, "no-such-parameter");
    EXPECT_EQ(unknown.messages[0].place.line, 5);
    EXPECT_EQ(unknown.messages[0].place.column, 55); // of "mix"
    const Compiled number = compileSnippet(material("directlighting(this, \"diffuseresult\", 1)"));
    ASSERT_EQ(number.messages.size(), 1u) << number.text();
    EXPECT_EQ(number.messages[0].id, "output-argument");
    EXPECT_EQ(number.messages[0].place.line, 5);
    EXPECT_EQ(number.messages[0].place.column, 52); // of the number
}

} // namespace
} // namespace alpenglow::rsl
