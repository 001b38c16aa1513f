// The descriptors: complete against the 3Delight manual, 6.4, consistent with the runtime, and their examples true.
#include "shadeops/bitcode.h"
#include "shadeops/descriptor.h"
#include "shadeops/host_runtime.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <optional>
#include <regex>
#include <set>
#include <sstream>

namespace registry_test {

using namespace alpenglow::shadeops;

namespace {

int floatsOf(const Type& t) { return componentCount(t.base); }

TEST(Registry, SortedAndFound) {
    const auto all = allShadeops();
    ASSERT_GT(all.size(), 100u);
    for (size_t i = 1; i < all.size(); ++i) EXPECT_LT(all[i - 1].name, all[i].name);
    for (const Shadeop& op : all) EXPECT_EQ(findShadeop(op.name), &op);
    EXPECT_EQ(findShadeop("nosuchthing"), nullptr);
    EXPECT_EQ(findShadeop(""), nullptr);
}

TEST(Registry, EveryDescriptorIsWhole) {
    for (const Shadeop& op : allShadeops()) {
        EXPECT_FALSE(op.doc.empty()) << op.name;
        EXPECT_FALSE(op.source.empty()) << op.name;
        EXPECT_FALSE(op.section.empty()) << op.name;
        EXPECT_FALSE(op.signatures.empty()) << op.name;
        EXPECT_EQ(op.lowering == Lowering::Rsl, !op.rsl.empty()) << op.name;
        EXPECT_EQ(op.bias == Bias::Unbiased, op.biasReason.empty()) << op.name;
        EXPECT_NE(op.contexts, 0u) << op.name;
        std::set<std::string> seen;
        for (const Signature& s : op.signatures) {
            EXPECT_NE(s.text.find(op.name + "("), std::string::npos) << s.text;
            EXPECT_TRUE(seen.insert(s.text).second) << "twice: " << s.text;
            for (const Parameter& p : s.parameters) EXPECT_FALSE(p.name.empty()) << s.text;
        }
    }
}

TEST(Registry, RuntimeSignaturesMatchTheirSymbols) {
    int checked = 0;
    for (const Shadeop& op : allShadeops()) {
        for (const Signature& s : op.signatures) {
            ASSERT_EQ(op.lowering == Lowering::Runtime, !s.symbol.empty()) << s.text;
            if (s.symbol.empty()) continue;
            int in = 0, out = floatsOf(s.result);
            for (const Parameter& p : s.parameters) {
                in += floatsOf(p.type);
                out += p.output ? floatsOf(p.type) : 0;
            }
            const RuntimeShape shape = runtimeShape(s.symbol);
            EXPECT_EQ(shape.in, in) << s.text << " " << s.symbol;
            EXPECT_EQ(shape.out, out) << s.text << " " << s.symbol;
            ++checked;
        }
    }
    EXPECT_GT(checked, 100);
}

TEST(Registry, SymbolsThatTheCodeGeneratorCallsByName) {
    const struct {
        const char* symbol;
        int in, out;
    } kNamed[] = {{"al_transformpoint", 19, 3},  {"al_transformvector", 19, 3},   {"al_transformnormal", 19, 3},
                  {"al_multiply", 32, 16},       {"al_inverse", 16, 16},          {"al_rgb_to_hsv", 3, 3},
                  {"al_hsv_to_rgb", 3, 3},       {"al_rgb_to_hsl", 3, 3},         {"al_hsl_to_rgb", 3, 3},
                  {"al_rgb_to_yiq", 3, 3},       {"al_yiq_to_rgb", 3, 3},         {"al_rgb_to_xyz", 3, 3},
                  {"al_xyz_to_rgb", 3, 3},       {"al_splinesegment", 2, 2},      {"al_spline_catmullrom_f", 5, 1},
                  {"al_spline_bezier_t", 13, 3}, {"al_splinesolve_linear", 5, 1}, {"al_random_f", 1, 1},
                  {"al_random_t", 1, 3}};
    for (const auto& n : kNamed) {
        EXPECT_EQ(runtimeShape(n.symbol).in, n.in) << n.symbol;
        EXPECT_EQ(runtimeShape(n.symbol).out, n.out) << n.symbol;
    }
    float x = 0;
    EXPECT_FALSE(evaluateRuntime("al_nosuch", &x, 1, &x, 1));
    EXPECT_FALSE(evaluateRuntime("al_sin", &x, 2, &x, 1));
}

TEST(Registry, ParseSignature) {
    Signature s = parseSignature(
        "void fresnel(vector i, n; float eta; output float Kr, Kt; output uniform vector R; color c[]; string d[4]; pairs)",
        "al_x");
    EXPECT_EQ(s.result, (Type{Base::Void, 0}));
    ASSERT_EQ(s.parameters.size(), 8u);
    EXPECT_EQ(s.parameters[1].name, "n");
    EXPECT_EQ(s.parameters[1].type, (Type{Base::Vector, 0}));
    EXPECT_FALSE(s.parameters[2].output);
    EXPECT_TRUE(s.parameters[3].output);
    EXPECT_TRUE(s.parameters[4].output);
    EXPECT_EQ(s.parameters[4].name, "Kt");
    EXPECT_FALSE(s.parameters[4].uniform);
    EXPECT_TRUE(s.parameters[5].output && s.parameters[5].uniform);
    EXPECT_EQ(s.parameters[6].type, (Type{Base::Color, -1}));
    EXPECT_FALSE(s.parameters[6].output);
    EXPECT_EQ(s.parameters[7].type, (Type{Base::String, 4}));
    EXPECT_TRUE(s.pairs);
    EXPECT_FALSE(s.repeats);
    EXPECT_EQ(s.symbol, "al_x");
    s = parseSignature("color[] f(any value, ...)");
    EXPECT_EQ(s.result, (Type{Base::Color, -1}));
    EXPECT_TRUE(s.repeats);
    EXPECT_EQ(s.parameters[0].type.base, Base::Void);
    EXPECT_TRUE(parseSignature("float f()").parameters.empty());
    EXPECT_NO_FATAL_FAILURE(parseSignature("float f(")); // unfinished text ends, it does not hang
    EXPECT_NO_FATAL_FAILURE(parseSignature(""));
}

// Every function heading of the manual ("- type name ( ...") is here.
TEST(Registry, CoversTheManual) {
    std::ifstream in(std::filesystem::path(ALPENGLOW_SOURCE_DIR) / "../shared/seeds/3delight-standard-functions.txt");
    if (!in) GTEST_SKIP() << "the manual's list is not next to this checkout";
    const std::regex heading(
        R"(^- (uniform )?(type|float|color|point|vector|normal|matrix|string|void|shader)(\[\])? ([A-Za-z0-9_]+) ?\()");
    std::string line;
    int found = 0;
    while (std::getline(in, line)) {
        std::smatch m;
        if (!std::regex_search(line, m, heading)) continue;
        ++found;
        EXPECT_NE(findShadeop(m[4].str()), nullptr) << line;
    }
    EXPECT_GT(found, 90);
}

TEST(Registry, BitcodeAtEveryWidth) {
    for (const int lanes : {4, 8, 16, 32, 64}) {
        const Bitcode b = runtimeBitcode(lanes);
        ASSERT_NE(b.data, nullptr);
        ASSERT_GT(b.size, 10000u);
        EXPECT_EQ(0, std::memcmp(b.data, "BC\xC0\xDE", 4)) << lanes;
    }
    EXPECT_EQ(runtimeBitcode(5).data, nullptr);
    EXPECT_GE(runtimeHash().size(), 64u);
    EXPECT_EQ(runtimeHash(), runtimeHash(16));
    EXPECT_EQ(runtimeHash(4), runtimeHash(8)); // each holds both files
    EXPECT_NE(runtimeHash(8), runtimeHash(16));
    for (const int lanes : {4, 8, 16}) EXPECT_EQ(runtimeLack(lanes), "");
}

// A small evaluator of example expressions: calls, constructors of constants, numbers, one difference.
struct Value {
    Base base = Base::Float;
    std::vector<float> v;
};
class Evaluator {
public:
    explicit Evaluator(const std::string& text) : p_(text.c_str()) {}
    std::optional<Value> run() {
        auto a = term();
        skip();
        if (a && *p_ == '-') {
            ++p_;
            auto b = term();
            if (!b) return {};
            for (size_t i = 0; i < a->v.size(); ++i) a->v[i] -= b->v[i];
        }
        skip();
        return *p_ ? std::nullopt : a;
    }

private:
    const char* p_;
    void skip() {
        while (*p_ == ' ') ++p_;
    }
    std::optional<Value> term() {
        skip();
        if (std::isdigit(static_cast<unsigned char>(*p_)) || *p_ == '-' || *p_ == '.') {
            char* end;
            const float f = std::strtof(p_, &end);
            p_ = end;
            return Value{Base::Float, {f}};
        }
        std::string name;
        while (std::isalnum(static_cast<unsigned char>(*p_)) || *p_ == '_') name += *p_++;
        skip();
        if (*p_ != '(') return {};
        ++p_;
        std::vector<Value> args;
        for (skip(); *p_ && *p_ != ')'; skip()) {
            auto a = term();
            if (!a) return {};
            args.push_back(*a);
            skip();
            if (*p_ == ',') ++p_;
        }
        if (*p_ != ')') return {};
        ++p_;
        for (const Base base : {Base::Color, Base::Point, Base::Vector, Base::Normal, Base::Matrix})
            if (name == toString(Type{base, 0})) {
                Value r{base, {}};
                if (base == Base::Matrix && args.size() == 1)
                    for (int i = 0; i < 16; ++i) r.v.push_back(i % 5 == 0 ? args[0].v[0] : 0);
                else
                    for (const Value& a : args) r.v.push_back(a.v[0]);
                return r;
            }
        const Shadeop* op = findShadeop(name);
        if (!op || op->lowering != Lowering::Runtime) return {};
        for (const Signature& s : op->signatures) {
            bool fits = s.parameters.size() == args.size();
            for (size_t i = 0; fits && i < args.size(); ++i) fits = s.parameters[i].type.base == args[i].base;
            if (!fits) continue;
            std::vector<float> in, out(componentCount(s.result.base));
            for (const Value& a : args) in.insert(in.end(), a.v.begin(), a.v.end());
            EXPECT_TRUE(evaluateRuntime(s.symbol, in.data(), int(in.size()), out.data(), int(out.size()))) << s.text;
            return Value{s.result.base, out};
        }
        return {};
    }
};

TEST(Registry, ExamplesAreTrue) {
    int ran = 0;
    for (const Shadeop& op : allShadeops())
        for (const Example& e : op.examples) {
            EXPECT_FALSE(e.value.empty()) << e.expression;
            if (op.lowering != Lowering::Runtime || !e.setup.empty() || !e.when.empty()) continue; // `alpenglow eval` runs these
            const auto got = Evaluator(e.expression).run();
            ASSERT_TRUE(got) << "cannot evaluate " << e.expression;
            std::string text;
            for (const float f : got->v) {
                char buffer[32];
                std::snprintf(buffer, sizeof buffer, "%s%.7g", text.empty() ? "" : " ", f);
                text += buffer;
            }
            EXPECT_EQ(text, e.value) << e.expression;
            ++ran;
        }
    EXPECT_GT(ran, 50);
}

TEST(Registry, RuntimeShadeopsHaveExamples) {
    for (const Shadeop& op : allShadeops())
        if (op.lowering == Lowering::Runtime && op.name.rfind("set", 0) != 0 && op.name.rfind("__", 0) != 0 &&
            op.name != "fresnel")
            EXPECT_FALSE(op.examples.empty()) << op.name;
}

} // namespace

} // namespace registry_test
