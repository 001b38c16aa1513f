// Du and Dv of every shadeop against central differences of its own values. The table of shadeops is walked: each signature of a
// shadeop through which derivatives pass is called with smooth arguments, all varying and each alone; a shadeop that is neither
// called here nor named below with a reason fails.
#include "points.h"
#include "slopes.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <set>

namespace alpenglow::rsl::slopes_test {
namespace {

/// In the middle of nothing: no lattice point of noise, no end of a spline, no edge of a hue.
constexpr double kU = 0.4375, kV = 0.5625;
/// A power of two, so that the places are exact. The error of the difference of fourth order is h^4 / 30 times the fifth
/// derivative, below 1e-5 for what is called here; that of rounding is about 1e-7 / h = 6e-6 times the value.
constexpr double kStep = 1.0 / 64;
/// What is left for both, times 1 + |f| + |slope|: functions of functions (noise through wnoise, areas, distributions with high
/// powers) have fifth derivatives in the thousands. A slope that misses a term is wrong by a tenth and more.
constexpr double kTolerance = 1e-3;

/// The centre, then two steps to each side along u, then along v.
constexpr int kPlaces = 9;
double uOf(int p) { return kU + (p >= 1 && p <= 4 ? kStep * (p <= 2 ? p - 3 : p - 2) : 0); }
double vOf(int p) { return kV + (p >= 5 ? kStep * (p <= 6 ? p - 7 : p - 6) : 0); }

float place(const std::string& name, int component, int part, int p) {
    const bool isU = name == "u" || name == "s", isV = name == "v" || name == "t";
    if (isU || isV) return part == 0 ? float(isU ? uOf(p) : vOf(p)) : part == (isU ? 1 : 2) ? 1.0f : 0.0f;
    if (name == "P" || name == "I") { // the eye at (0.2, 0.1, -1)
        if (part > 0) return part == component + 1 && component < 2 ? 1.0f : 0.0f;
        const double x[3] = {uOf(p), vOf(p), 0}, eye[3] = {0.2, 0.1, -1};
        return float(x[component] - (name == "I" ? eye[component] : 0));
    }
    float v = 0;
    EvaluationPoint::value(name, component, part, v);
    return v;
}

/// Arguments that differ from the usual ones, and pairs behind them; several where one place does not see all.
struct Special {
    Arguments arguments;
    std::string pairs;
};

const std::multimap<std::string, Special>& specials() {
    static const std::multimap<std::string, Special> all = [] {
        std::multimap<std::string, Special> m;
        m.insert({"clamp", {{{"lo", ""}, {"hi", ""}}, ""}}); // each type its own: see special()
        m.insert({"mod", {{{"x", "(3.4 + 2 * U - V)"}, {"y", "(0.8 + 0.1 * U)"}}, ""}});
        m.insert({"smoothstep", {{{"lo", ""}, {"hi", ""}}, ""}});
        m.insert({"asin", {{{"a", "(0.3 * U - 0.7 * V * V)"}}, ""}});
        m.insert({"log", {{{"base", "(2 + U)"}}, ""}});
        for (const char* name : {"comp", "setcomp"})
            m.insert({name, {{{"i", "1"}, {"row", "1"}, {"column", "2"}}, ""}}); // an index is cut to an integer
        m.insert({"pnoise", {{{"period", ""}, {"xperiod", "3"}, {"yperiod", "4"}, {"wperiod", "5"}}, ""}}); // rounded to integers
        for (const char* basis : {"catmull-rom", "bspline", "bezier", "hermite", "linear"})
            m.insert({"spline", {{{"basis", "\"" + std::string(basis) + "\""}}, ""}});
        for (const char* space : {"hsv", "hsl", "yiq", "xyz"}) {
            m.insert({"ctransform", {{{"tospace", "\"" + std::string(space) + "\""}, {"fromspace", "\"rgb\""}}, ""}});
            m.insert({"ctransform", {{{"tospace", "\"rgb\""}, {"fromspace", "\"" + std::string(space) + "\""}}, ""}});
        }
        for (const char* name : {"transform", "ptransform", "vtransform", "ntransform", "mtransform"})
            m.insert({name, {{{"tospace", "\"world\""}, {"fromspace", "\"shader\""}}, ""}});
        m.insert({"area", {{{"strategy", "\"dicing\""}}, ""}});
        for (const char* filter : {"box", "triangle", "gaussian", "catmull-rom"})
            m.insert({"filterstep",
                      {{{"value1", "(0.3 + 0.2 * U - 0.1 * V)"}, {"value2", "(1 + 0.3 * U * V)"}},
                       ", \"filter\", \"" + std::string(filter) + "\", \"width\", 1.5"}});
        const std::string wo = ", \"wo\", normalize(vector(0.3 * U, 0.2, 1))", r = ", \"roughness\", 0.3 + 0.2 * U";
        for (const std::string d : {"uniform", "cosine"})
            m.insert({"bsdf", {{}, ", \"distribution\", \"" + d + "\", \"samplecone\", 1.2"}});
        for (const std::string d : {"oren-nayar", "blinn", "cook-torrance", "glass-ggx"})
            m.insert({"bsdf", {{}, ", \"distribution\", \"" + d + "\"" + r + wo}});
        for (const std::string d : {"ashikhmin-shirley", "ward", "hair"})
            m.insert({"bsdf",
                      {{},
                       ", \"distribution\", \"" + d + "\"" + r + ", \"roughnessv\", 0.4 + 0.1 * V, \"udir\", vector(1, 0.2, 0)" +
                           wo}});
        return m;
    }();
    return all;
}

/// With what depends on the type of the signature filled in.
Arguments filled(const Shadeop& op, const Signature& s, Arguments a) {
    const Base base = s.parameters.empty() ? Base::Float : s.parameters[0].type.base;
    const auto value = [&](const std::string& x, const std::string& y, const std::string& z) {
        return base == Base::Float ? x : toString(Type{base, 0}) + "(" + x + ", " + y + ", " + z + ")";
    };
    if (op.name == "clamp" || op.name == "smoothstep") {
        a["lo"] = value("(0.1 + 0.05 * U)", "(0.05 * V)", "(0.1 - 0.1 * U * V)"); // below and above what is between
        a["hi"] = value("(1.1 + 0.1 * U * V)", "(1.2 + 0.2 * V)", "(1.5 - 0.1 * U)");
        if (op.name == "clamp")
            a["x"] = value("(0.5 + 0.2 * U * V)", "(2 + U)", "(V - 2)"); // a component in each of the three ranges
        if (op.name == "clamp" && base == Base::Float) a["x"] = "(0.5 + 0.2 * U * V)";
        if (op.name == "smoothstep") a["value"] = value("(0.4 + 0.2 * U)", "(0.3 + 0.3 * V)", "(0.6 + 0.2 * U * V)");
    }
    if (op.name == "pnoise") a["period"] = base == Base::Float ? "3" : "point(3, 4, 5)";
    return a;
}

/// Derivatives pass through these where no table of calls can show it.
const std::map<std::string, std::string>& elsewhere() {
    static const std::map<std::string, std::string> all = {
        {"texture", "needs a map: tests/integrator/derivatives_test.cpp"},
        {"environment", "needs a map: tests/integrator/derivatives_test.cpp"},
        {"bump", "RSL over texture(), which needs a map: tests/integrator/derivatives_test.cpp"},
        {"visibility", "what rays bring counts as constant"},
        {"rayhittest", "what rays bring counts as constant"},
        {"fulltrace", "what rays bring counts as constant"},
        {"shaderinfo", "gives nothing that varies"},
        {"emit", "gives nothing"},
        {"areashadow", "what rays bring counts as constant"},
        {"generateSamplesEnv", "samples are drawn"},
        {"evaluateSamplesEnv", "what a map of the sky shows counts as constant"},
        {"generateSamplesAS", "samples are drawn"},
        {"evaluateSamplesAS", "takes an array of structures: tests/integrator/radiancesamples_test.cpp"},
        {"directlighting", "asks lights and another shader: tests/integrator/materialresponse_test.cpp"},
        {"diffuselighting", "asks lights and another shader: tests/integrator/materialresponse_test.cpp"},
        {"specularlighting", "asks lights and another shader: tests/integrator/materialresponse_test.cpp"},
        {"indirectspecular", "what rays bring counts as constant"},
    };
    return all;
}

/// Rule Zero: they jump, or cannot be said to have a slope. Du and Dv must be 0 exactly.
bool flat(const Shadeop& op) { return op.derivative == DerivativeRule::Zero; }
/// But of a variable that stays as it was where nothing is found: its slope stays, too.
bool fills(const Signature& s) {
    return std::any_of(s.parameters.begin(), s.parameters.end(), [](const Parameter& p) { return p.output; });
}

struct Measured {
    Slope slope;
    bool zero = false;
    const Signature* signature = nullptr;
};

std::vector<Measured> table() {
    std::vector<Measured> all;
    for (const Shadeop& op : allShadeops()) {
        if (op.name.rfind("__", 0) == 0 || elsewhere().count(op.name)) continue;
        const bool passes = op.derivative == DerivativeRule::Jet || op.derivative == DerivativeRule::Inherent ||
                            op.derivative == DerivativeRule::Gradient;
        if (!passes && !flat(op)) continue;
        if (op.lowering == Lowering::Unavailable || (flat(op) && (op.section == "Arrays" || op.section == "Strings"))) continue;
        for (const Signature& s : op.signatures) {
            if (s.result.base == Base::String) continue;
            std::vector<Special> ways;
            const auto [from, to] = specials().equal_range(op.name);
            for (auto k = from; k != to; ++k) ways.push_back(k->second);
            if (ways.empty()) ways.push_back({});
            std::set<std::string> seen;
            for (const Special& way : ways)
                for (const Slope& x : slopesOf(op, s, filled(op, s, way.arguments), way.pairs, kU, kV))
                    if (seen.insert(x.statements).second) all.push_back({x, flat(op) && !fills(s), &s});
        }
    }
    const auto extra = [&](const char* what, const char* statements, Base type) {
        all.push_back({{what, statements, {type, 0}}, false});
    };
    const char* const rise[] = {"solvecatmull-rom", "solvebspline", "solvebezier", "solvelinear"};
    for (const char* basis : rise) // the value, and the points: rising, so that they can be solved
        all.push_back({{std::string("spline ") + basis,
                        std::string("f = spline(\"") + basis +
                            "\", 1.3 + 0.3 * U - 0.2 * V * V, 0.1 * U, 1 - 0.2 * V, 2 + 0.1 * U * V, 3);",
                        {Base::Float, 0}},
                       false});
    extra("color[] bsdf",
          "color parts[2] = bsdf(vector(0.2, 0.1 * V, 0.9), normal(0.1 * U, 0, 1), \"distribution\", \"glass-ggx\", "
          "\"roughness\", 0.4 + 0.1 * U, "
          "\"wo\", normalize(vector(0.3, 0.2 * V, 1))); f = parts[0] + 2 * parts[1];",
          Base::Color);
    extra("push and pop", "float a[] = {1}; push(a, U * U * V); push(a, U); float last = pop(a); f = pop(a) * last;",
          Base::Float);
    extra("an element by a varying index", "float a[3] = {U * U, V * U, V}; f = a[floor(2 * U + 1)] * a[2];", Base::Float);
    return all;
}

/// Runs the whole table at the places: look(entry, f, Du(f), Dv(f)), each component after component.
template <class Look> void measure(const std::vector<Measured>& all, bool differences, const Look& look) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    constexpr size_t kTogether = 24;
    for (size_t begin = 0; begin < all.size(); begin += kTogether) {
        const size_t end = std::min(all.size(), begin + kTogether);
        std::string parameters, body;
        KernelOptions o;
        o.lanes = 16;
        o.optimize = 0; // the bits are those of every other level: runner_test.cpp
        o.differences = differences;
        for (size_t k = begin; k < end; ++k) {
            const Slope& s = all[k].slope;
            const std::string type = toString(s.type), slope = s.type.isPointLike() ? "vector" : type,
                              n = std::to_string(k - begin);
            parameters += "output varying " + type + " f" + n + " = 0; output varying " + slope + " a" + n +
                          " = 0; output varying " + slope + " b" + n + " = 0;\n";
            body += "{ " + type + " f = 0; float U = u, V = v; " + s.statements + " f" + n + " = f; a" + n + " = Du(f); b" + n +
                    " = Dv(f); }\n";
            for (const char* q : {"f", "a", "b"}) o.outputs.push_back(q + n);
        }
        Diagnostics d([](const Diagnostic& m) {
            if (m.severity >= Severity::Error) ADD_FAILURE() << toString(m);
        });
        const auto shader = compiler.loadText("surface slopes(" + parameters + ") {\n" + body + "}\n", "slopes", d);
        if (!shader) {
            ADD_FAILURE() << body;
            continue;
        }
        const auto kernel = compiler.kernel(shader, o, d);
        ASSERT_TRUE(kernel);
        std::vector<std::vector<float>> out;
        const auto at = [&](const std::string& name, int component, int part, int p) {
            if (differences && (name == "du" || name == "dv")) return part == 0 ? float(kStep) : 0.0f;
            return place(name, component, part, p);
        };
        ASSERT_TRUE(runPoints(*kernel, false, kPlaces, at, compiler.parameterValues(shader, d), out, d));
        for (size_t k = begin; k < end; ++k) {
            SCOPED_TRACE(all[k].slope.what + ": " + all[k].slope.statements);
            const size_t first = 3 * (k - begin);
            look(all[k], out[first], out[first + 1], out[first + 2]);
        }
    }
}

TEST(Slopes, OfEveryShadeopAreThoseOfItsValues) {
    const std::vector<Measured> all = table();
    std::set<const Signature*> met;
    measure(all, false,
            [&](const Measured& m, const std::vector<float>& f, const std::vector<float>& du, const std::vector<float>& dv) {
                bool moves = false;
                for (size_t c = 0; c < f.size(); c += kPlaces) {
                    const auto at = [&](int p) { return double(f[c + size_t(p)]); };
                    const double value = at(0), byU = (8 * (at(3) - at(2)) - (at(4) - at(1))) / (12 * kStep),
                                 byV = (8 * (at(7) - at(6)) - (at(8) - at(5))) / (12 * kStep);
                    const double gotU = double(du[c]), gotV = double(dv[c]);
                    EXPECT_TRUE(std::isfinite(value)) << "component " << c / kPlaces;
                    if (m.zero) {
                        EXPECT_EQ(gotU, 0);
                        EXPECT_EQ(gotV, 0);
                        continue;
                    }
                    EXPECT_NEAR(gotU, byU, kTolerance * (1 + std::fabs(value) + std::fabs(byU)))
                        << "Du, component " << c / kPlaces;
                    EXPECT_NEAR(gotV, byV, kTolerance * (1 + std::fabs(value) + std::fabs(byV)))
                        << "Dv, component " << c / kPlaces;
                    moves |= std::fabs(byU) + std::fabs(byV) > 1e-3;
                }
                if (moves) met.insert(m.signature);
            });
    // Each signature must have been seen to move: what stays the same proves nothing.
    for (const Shadeop& op : allShadeops()) {
        const bool passes = op.derivative == DerivativeRule::Jet || op.derivative == DerivativeRule::Inherent ||
                            op.derivative == DerivativeRule::Gradient;
        if (op.name.rfind("__", 0) == 0 || !passes || op.lowering == Lowering::Unavailable || elsewhere().count(op.name))
            continue;
        for (const Signature& s : op.signatures)
            if (s.result.array == 0 && s.text != "void reverse(output string a[])")
                EXPECT_TRUE(met.count(&s)) << "nothing moves in " << s.text; // parts in an array: extra, above
    }
    RecordProperty("slopes", int(all.size()));
    EXPECT_GT(all.size(), 500u);
}

// As a grid has them, they are the differences of the values at the next place, whatever lies between; those that jump too. What
// is left is rounding: 1e-7 of the value over the step, a few times where functions of functions magnify it.
TEST(Slopes, AsDifferencesAreThoseOfTheNextPlace) {
    size_t moved = 0;
    measure(table(), true,
            [&](const Measured&, const std::vector<float>& f, const std::vector<float>& du, const std::vector<float>& dv) {
                bool moves = false;
                for (size_t c = 0; c < f.size(); c += kPlaces) {
                    const double value = double(f[c]), byU = (double(f[c + 3]) - value) / kStep,
                                 byV = (double(f[c + 7]) - value) / kStep;
                    EXPECT_NEAR(double(du[c]), byU, 1e-4 * (1 + std::fabs(value) + std::fabs(byU)))
                        << "Du, component " << c / kPlaces;
                    EXPECT_NEAR(double(dv[c]), byV, 1e-4 * (1 + std::fabs(value) + std::fabs(byV)))
                        << "Dv, component " << c / kPlaces;
                    moves |= std::fabs(byU) + std::fabs(byV) > 1e-3;
                }
                moved += moves;
            });
    EXPECT_GT(moved, 500u);
}

// The list of exceptions names what there is, and nothing for which the rule of its descriptor speaks already.
TEST(Slopes, ExceptionsAreShadeopsThroughWhichDerivativesPass) {
    for (const auto& [name, why] : elsewhere()) {
        const Shadeop* op = findShadeop(name);
        ASSERT_TRUE(op) << name;
        EXPECT_FALSE(why.empty());
        EXPECT_TRUE(op->derivative == DerivativeRule::Inherent || op->derivative == DerivativeRule::Gradient) << name;
    }
    for (const auto& [name, special] : specials()) EXPECT_TRUE(findShadeop(name)) << name;
}

} // namespace
} // namespace alpenglow::rsl::slopes_test
