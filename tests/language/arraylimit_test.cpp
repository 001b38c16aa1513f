// Arrays that grow: beyond the memory of a kernel, each point its own; up to a limit, which is said.
#include "base/limits.h"
#include "rsl/evaluate.h"
#include "rsl/spilledarrays.h"
#include <bit>
#include <gtest/gtest.h>

namespace alpenglow::rsl::arraylimit_test {
namespace {

float valueOf(const std::string& setup, const std::string& expression) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    const Evaluation e = evaluate(compiler, setup, expression, {}, d);
    EXPECT_TRUE(e.ok) << setup;
    EXPECT_EQ(d.errors(), 0) << (d.all().empty() ? "" : d.all()[0].message);
    return e.ok && !e.numbers.empty() ? e.numbers[0] : -1;
}

// u is .5 at the point.
TEST(ArrayLimit, NoneForPush) {
    const std::string push = "float a[], i; for (i = 0; i < u * 6000; i += 1) push(a, 2 * i);";
    EXPECT_EQ(valueOf(push, "arraylength(a)"), 3000);
    for (const int n : {0, limits::kResizableArray - 1, limits::kResizableArray, limits::kResizableArray + 1, 2999})
        EXPECT_EQ(valueOf(push, "a[" + std::to_string(n) + " * 2 * u]"), 2 * n) << n;
    EXPECT_EQ(valueOf(push, "a[1e6]"), 5998); // the last
    EXPECT_EQ(valueOf(push + "float sum = 0; while (arraylength(a) > 0) sum += pop(a);", "sum"), 2999.f * 3000.f);
    EXPECT_EQ(valueOf(push + "a[2000] = 7; float b[] = a; a[2000] = 8; a[2] = 0;", "b[2000] + b[2] + b[2999]"), 7 + 4 + 5998);
}

TEST(ArrayLimit, NoneForResize) {
    const std::string resize = "float a[]; resize(a, u * 40000); ";
    EXPECT_EQ(valueOf(resize, "arraylength(a)"), 20000);
    EXPECT_EQ(valueOf(resize + "a[19999] = 3; a[17000] = 5;", "a[19999] * a[17000] + a[12345]"), 15);
    EXPECT_EQ(valueOf(resize + "a[19999] = 3; resize(a, 10); ", "arraylength(a)"), 10);
    EXPECT_EQ(valueOf("float a[]; reserve(a, u * 40000); push(a, 1);", "capacity(a) + arraylength(a)"), 20001);
}

TEST(ArrayLimit, NoneForTypesAndFunctions) {
    const std::string fill = "void fill(output TYPE x[]; float n) { float i; for (i = 0; i < n; i += 1) push(x, VALUE); }"
                             "TYPE last(TYPE x[]) { return x[arraylength(x) - 1]; } TYPE a[]; fill(a, 400 * u);";
    const auto of = [&](const std::string& type, const std::string& value) {
        std::string s = fill;
        for (const auto& [word, text] : {std::pair<std::string, std::string>{"TYPE", type}, {"VALUE", value}})
            for (size_t at; (at = s.find(word)) != s.npos;) s.replace(at, word.size(), text);
        return s;
    };
    EXPECT_EQ(valueOf(of("color", "color(i, 1, 2 * i)"), "comp(last(a), 2)"), 398);
    EXPECT_EQ(valueOf(of("point", "point(i, 1, 2 * i)"), "ycomp(last(a)) + xcomp(a[150 * 2 * u])"), 151);
    EXPECT_EQ(valueOf(of("matrix", "translate(1, vector(i, 0, 0))"), "comp(last(a), 3, 0)"), 199);
    EXPECT_EQ(valueOf(of("string", "format(\"%d\", i)"), "last(a) == \"199\" ? 1 : 0"), 1);
    EXPECT_EQ(valueOf("struct Grown { float x[]; }; Grown g; float i; for (i = 0; i < 400 * u; i += 1) push(g->x, i);",
                      "g->x[180] + arraylength(g->x)"),
              380);
}

// Site and arguments of a service, one lane after the other.
ir::Site siteOf(const char* op) {
    ir::Site s;
    s.op = op;
    s.argKinds = {ir::Kind::Float, ir::Kind::Float, ir::Kind::Float, ir::Kind::Float};
    s.resultKinds = {ir::Kind::Float};
    return s;
}

TEST(ArrayLimit, EndsWithAMessage) {
    SpilledArrays arrays(4096);
    Diagnostics d;
    float out[4];
    const float resize[] = {0, 0, 0, 0, 64, 64, 64, 64, 100, 70, 2000, 64, 1, 1, 1, 1}; // array, storage, wanted, width
    ASSERT_TRUE(arrays.answer(siteOf("arrayresize"), 0, 0xf, 4, resize, out, d, nullptr));
    EXPECT_EQ(out[0], 100);
    EXPECT_EQ(out[1], 70); // lanes have lengths of their own
    EXPECT_EQ(out[2], 64); // 1936 floats are more than 4096 bytes
    EXPECT_EQ(out[3], 64);
    ASSERT_EQ(d.errors(), 1);
    EXPECT_NE(d.all()[0].message.find("may grow to"), std::string::npos);
    EXPECT_LE(arrays.bytes(), 4096u);
    const float store[] = {0, 0, 0, 0, 64, 64, 64, 64, 80, 69, 64, 64, 5, 6, 7, 8};
    ASSERT_TRUE(arrays.answer(siteOf("arraystore"), 0, 0x3, 4, store, out, d, nullptr));
    const float load[] = {0, 0, 0, 0, 64, 64, 64, 64, 80, 69, 64, 64};
    ASSERT_TRUE(arrays.answer(siteOf("arrayload"), 0, 0xf, 4, load, out, d, nullptr));
    EXPECT_EQ(out[0], 5);
    EXPECT_EQ(out[1], 6);
    EXPECT_EQ(out[2], 0);
    EXPECT_FALSE(arrays.answer(siteOf("printf"), 0, 0xf, 4, load, out, d, nullptr));
    arrays.clear();
    EXPECT_EQ(arrays.bytes(), 0u);
}

} // namespace
} // namespace alpenglow::rsl::arraylimit_test
