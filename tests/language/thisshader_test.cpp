// `this` as a value: handed to functions, to co-shaders, kept in variables and arrays; what others call back; what members of a
// type that is not known until they are bound give to format().
#include "points.h"
#include "rsl/compiler.h"
#include <algorithm>
#include <bit>
#include <gtest/gtest.h>

namespace alpenglow::rsl::thisshader_test {
namespace {

const char* const kLayer = R"(
class layer(float gain = 5;)
{
    public float own = 9;
    public string word = "hello";
    public varying color tint = color(1, 2, 3);
    float asked = 0;
    public float ask(shader who) { asked += 1; return who->twice(gain) + back(this) * 100; }
    public float back(shader other) { return other->own; }
    public float among(shader who) { shader me = this; return me == this && who != me ? me->gain + asked : 0; }
    public float round(shader who) { return who->around(this); }
    public string name() { return format("%h", this); }
})";

/// Outputs of a class whose method surface() has this body, with one layer (gain 7) under the handle "coat".
std::vector<float> shade(const std::string& body, const std::string& outputs, const std::vector<std::string>& names,
                         Diagnostics& d, int lanes = 16) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    const auto layer = compiler.loadText(kLayer, "layer.sl", d);
    const auto surface = compiler.loadText("class asker(float gain = 2; " + outputs + R"()
{
    public float count = 3;
    public float twice(float x) { count += 1; return x * 2; }
    public float around(shader who) { return who->round(this); }
    float gainOf(shader who) { return who->gain; }
    public void surface(output color Ci, Oi) { )" +
                                               body + "}\n}",
                                           "asker.sl", d);
    if (!layer || !surface) return {};
    KernelOptions o;
    o.lanes = lanes;
    o.outputs = names;
    CoShader c = ShaderCompiler::coShader(layer, "coat");
    c.numbers["gain"] = {7};
    o.coShaders.push_back(c);
    const auto kernel = compiler.kernel(surface, o, d);
    if (!kernel) return {};
    std::vector<std::vector<float>> out;
    if (!runPoints(*kernel, false, 1, evaluationPoint(), compiler.parameterValues(surface, d), out, d)) return {};
    std::vector<float> values;
    for (const auto& v : out) values.push_back(v[0]);
    return values;
}

using Values = std::vector<float>;

TEST(ThisShader, IsAHandleLikeOthers) {
    for (const int lanes : {4, 8, 16}) {
        Diagnostics d;
        // ask(): twice(7) of this shader, and 9 of the layer's own; twice() counts, and so it does when it is called by name.
        EXPECT_EQ(shade(R"(shader me = this, coat = getshader("coat");
                           shader all[2]; all[0] = this; all[1] = coat;
                           float i, s = 0;
                           for (i = 0; i < 2; i += 1) s += all[i]->gain;
                           a = gainOf(this) * 10 + gainOf(me);
                           b = s;
                           c = coat->ask(this);
                           e = me->twice(4) + count * 100;
                           f = (this == me) + 10 * (coat == this) + 100 * coat->among(this);)",
                        "output varying float a = 0, b = 0, c = 0, e = 0, f = 0;", {"a", "b", "c", "e", "f"}, d, lanes),
                  (Values{22, 9, 914, 508, 801}));
        EXPECT_EQ(d.errors(), 0);
    }
}

TEST(ThisShader, GetvarAndHasmethod) {
    Diagnostics d;
    EXPECT_EQ(shade(
                  R"(float v = 0; float found = getvar(this, "count", v); a = found * 10 + v;
               b = hasmethod(this, "twice") * 10 + hasmethod(this, "gainOf");)",
                  "output varying float a = 0, b = 0;", {"a", "b"}, d),
              (Values{13, 10}));
    EXPECT_EQ(d.errors(), 0);
}

TEST(ThisShader, NamesOfHandlesAndUntypedMembers) {
    Diagnostics d;
    const auto v = shade(R"(shader coat = getshader("coat"); a = format("%h %h %h", this, coat, null);
                            b = format("%s %g %c %s", coat->word, coat->own, coat->tint, coat->name());)",
                         "output varying string a = \"\", b = \"\";", {"a", "b"}, d);
    ASSERT_EQ(v.size(), 2u);
    EXPECT_EQ(internedString(std::bit_cast<int32_t>(v[0])), "<surface> coat <null>");
    EXPECT_EQ(internedString(std::bit_cast<int32_t>(v[1])), "hello 9 [1.000000 2.000000 3.000000] coat");
    EXPECT_EQ(d.errors(), 0);
}

/// construct() runs once by the book: what it prints is marked, and printed once (rsl/printlog.h); what others print is not.
TEST(ThisShader, PrintsOfConstructAreMarked) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    const auto shader = compiler.loadText(R"(class talker() {
        public void construct() { printf("constructed\n"); helper(); }
        void helper() { printf("helped\n"); }
        public void begin() { printf("begun %f\n", u); }
        public void surface(output color Ci, Oi) { printf("shaded\n"); helper(); } })",
                                          "talker.sl", d);
    ASSERT_TRUE(shader);
    const auto kernel = compiler.kernel(shader, {}, d);
    ASSERT_TRUE(kernel);
    std::vector<int> marked;
    for (const auto& s : kernel->sites())
        if (s.op == "printf") marked.push_back(int(std::count(s.names.begin(), s.names.end(), "__once")));
    EXPECT_EQ(marked, (std::vector<int>{1, 1, 0, 0, 0}));
}

TEST(ThisShader, WhatItHasNotIsAnError) {
    Diagnostics d;
    EXPECT_EQ(shade("shader me = this; a = me->thrice(2);", "output varying float a = 0;", {"a"}, d), Values{});
    ASSERT_EQ(d.errors(), 1);
    EXPECT_NE(d.all().back().message.find("'thrice'"), std::string::npos);
}

/// The error stands at the call that closes the circle, the first time round, and names the calls on the way.
TEST(ThisShader, CirclesEndWhereTheyClose) {
    struct {
        const char *body, *file, *way;
    } const circles[] = {
        {"shader me = this; me->surface(Ci, Oi);", "asker.sl", ": surface() > surface()"},
        {"shader coat = getshader(\"coat\"); a = coat->round(this);", "asker.sl", ": coat->round() > around() > coat->round()"},
        {"shader coat = getshader(\"coat\"); a = around(coat);", "layer.sl", ": around() > coat->round() > around()"}};
    for (const auto& c : circles) {
        Diagnostics d;
        EXPECT_EQ(shade(c.body, "output varying float a = 0;", {"a"}, d), Values{}) << c.body;
        ASSERT_EQ(d.errors(), 1) << c.body;
        const Diagnostic said = d.all().back();
        EXPECT_EQ(said.place.file, c.file) << said.message;
        EXPECT_TRUE(said.message.ends_with(c.way)) << said.message;
    }
}

} // namespace
} // namespace alpenglow::rsl::thisshader_test
