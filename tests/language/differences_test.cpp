// Derivatives as a grid has them: differences over du and dv (KernelOptions::differences). Every shadeop: slopes_test.cpp.
#include "points.h"
#include "rsl/compiler.h"
#include <gtest/gtest.h>
#include <map>

namespace alpenglow::rsl::differences_test {
namespace {

/// A place of the unit square for each point, and its footprint.
struct Place {
    double u, v, du, dv;
};

PointValue at(const std::vector<Place>& places) {
    return [&places](const std::string& name, int component, int part, int p) {
        const Place& x = places[size_t(p)];
        if (name == "du" || name == "dv") return part == 0 ? float(name == "du" ? x.du : x.dv) : 0.0f;
        float v = 0;
        EvaluationPoint::value(name, component, part, v);
        if (part != 0) return v;
        if (name == "u" || name == "s" || (name == "P" && component == 0)) return float(x.u);
        if (name == "v" || name == "t" || (name == "P" && component == 1)) return float(x.v);
        return v;
    };
}

/// Values of the outputs r0, r1 ... of a body; [output][component * places + place].
std::vector<std::vector<float>> run(const std::string& body, const std::vector<std::string>& types,
                                    const std::vector<Place>& places, KernelOptions o, const std::string& functions = "") {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d([](const Diagnostic& m) { ADD_FAILURE() << toString(m); });
    std::string parameters;
    for (size_t k = 0; k < types.size(); ++k) {
        o.outputs.push_back("r" + std::to_string(k));
        parameters += "output varying " + types[k] + " " + o.outputs.back() + " = 0;\n";
    }
    const auto shader =
        compiler.loadText(functions + "surface differences(" + parameters + ") {\n" + body + "}\n", "differences", d);
    std::vector<std::vector<float>> out;
    EXPECT_TRUE(shader);
    const auto kernel = shader ? compiler.kernel(shader, o, d) : nullptr;
    EXPECT_TRUE(kernel);
    if (kernel) { EXPECT_TRUE(runPoints(*kernel, o.mixed, int(places.size()), at(places), {}, out, d)); }
    return out;
}

KernelOptions grid() {
    KernelOptions o;
    o.differences = true;
    return o;
}

// What falls at least as fast as the footprint: halved with it, but for rounding and the next term. The error of a first
// difference is h / 2 times the second derivative. Rounding is 1e-7 of the value over the step, of second differences over its
// square: they are looked at where the step is not too small for it.
TEST(Differences, AgreeWithTheExactFormToFirstOrder) {
    const std::vector<std::string> smooth = {
        "Du(sin(3 * u) * cos(2 * v))",
        "Dv(pow(u + 1, v + 0.5))",
        "Du(exp(u * v))",
        "Dv(noise(2 * u, 3 * v))",
        "Du(noise(P * 3))",
        "Dv(smoothstep(0, 1.1, u * v + 0.2))",
        "Deriv(sin(u + v), u * v + 2 * u)",
        "Du(Dv(u * u * v * sin(v)))",
        "Du(Du(exp(u + v)))",
        "area(P * (1 + 0.3 * sin(2 * u + v))) / (du * dv)",
        "Du(spline(u, 0, 1, 0.3, 0.5, 0.2, 1))",
        "Dv(atan(u + v, 1 + v * v))",
        "comp(calculatenormal(P + 0.1 * sin(4 * u) * cos(3 * v) * N), 0)",
        "comp(calculatenormal(P + 0.1 * noise(3 * P) * N), 1)",
        "comp(calculatenormal(P + 0.1 * smoothstep(0.1, 0.9, u) * normalize(N + 0.2 * sin(v))), 2)"};
    std::vector<Place> places;
    for (int k = 0; k < 4; ++k) places.push_back({0.37, 0.58, std::ldexp(1, -5 - k), std::ldexp(1, -5 - k)});
    std::string body;
    for (size_t k = 0; k < smooth.size(); ++k) body += "r" + std::to_string(k) + " = " + smooth[k] + ";\n";
    const std::vector<std::string> types(smooth.size(), "float");
    const auto exact = run(body, types, places, {}), coarse = run(body, types, places, grid());
    ASSERT_EQ(exact.size(), smooth.size());
    for (size_t k = 0; k < smooth.size(); ++k) {
        SCOPED_TRACE(smooth[k]);
        const auto error = [&](size_t p) { return std::fabs(double(coarse[k][p]) - double(exact[k][p])); };
        const bool second = smooth[k].find("Du(Du") == 0 || smooth[k].find("Du(Dv") == 0;
        EXPECT_LT(error(second ? 2 : 3), 0.05 * std::fabs(double(exact[k][3])) + 0.05);
        for (size_t p = second ? 0 : 1; p + 1 < (second ? 3 : places.size()); ++p) {
            const double rounding =
                4e-7 * (1 + std::fabs(double(exact[k][p]))) / places[p + 1].du / (second ? places[p + 1].du : 1);
            EXPECT_LE(error(p + 1), 0.6 * error(p) + rounding) << "footprint " << places[p + 1].du;
        }
    }
}

// Far below the footprint, where slopes say nothing.
TEST(Differences, OfFineDetailAreThoseOfItsSamples) {
    const std::vector<Place> places = {
        {0.3, 0.2, 0.05, 0.07}, {0.71, 0.9, 0.011, 0.2}, {0.5, 0.5, 0.25, 0.125}, {0.1, 0.6, 0.001, 0.03}};
    const auto f = [](double u, double v) { return std::sin(2000 * u) * std::cos(1700 * v + 1); };
    const auto out =
        run("float f = sin(2000 * u) * cos(1700 * v + 1); r0 = Du(f); r1 = Dv(f); normal n = calculatenormal(P + f * N); r2 = n;",
            {"float", "float", "normal"}, places, grid());
    ASSERT_EQ(out.size(), 3u);
    for (size_t p = 0; p < places.size(); ++p) {
        const double u = double(float(places[p].u)), v = double(float(places[p].v)), du = double(float(places[p].du)),
                     dv = double(float(places[p].dv));
        const double byU = (f(double(float(u + du)), v) - f(u, v)) / du, byV = (f(u, double(float(v + dv))) - f(u, v)) / dv;
        // The arguments are rounded at 2000: 1.2e-4 of the value.
        EXPECT_NEAR(double(out[0][p]), byU, 5e-4 / du);
        EXPECT_NEAR(double(out[1][p]), byV, 5e-4 / dv);
        EXPECT_NEAR(double(out[2][p]), -byU, 5e-4 / du); // (1, 0, fu) x (0, 1, fv)
        EXPECT_NEAR(double(out[2][places.size() + p]), -byV, 5e-4 / dv);
        EXPECT_NEAR(double(out[2][2 * places.size() + p]), 1, 1e-4);
        EXPECT_LT(std::fabs(double(out[0][p])), 2 / du + 1); // the exact slope is up to 2000
    }
}

struct Flow {
    const char* name;
    const char* body; ///< leaves its value in f; U and V are u and v
};
const Flow kFlows[] = {
    {"a branch that the neighbour does not take", "float f = 3; if (U > 0.52) f = 5 * V;"},
    {"a branch with noise on both sides",
     "float f; if (U + V > 1.02) f = noise(9 * U, V) * 2; else { f = noise(7 * V, U); f *= f + U; }"},
    {"branches in branches",
     "float f = 0; if (U > 0.4) { if (V > 0.53) f = sin(9 * U); else { f = cos(7 * V); if (U > 0.52) f += U * 3; } }"},
    {"a loop with as many turns as the place says", "float i, f = 0; for (i = 0; i < 30 * U; i += 1) f += sin(i * V);"},
    {"a loop within a loop",
     "float i, j, f = 0; for (i = 0; i < 9 * U; i += 1) for (j = 0; j < 11 * V; j += 1) f += noise(i * U, j * V);"},
    {"a loop that is left early", "float i, f = 1; for (i = 0; i < 40; i += 1) { f *= 1 + 0.1 * V; if (f > 2 + 5 * U) break; }"},
    {"a function", "float f = shape(U, V) + shape(V, U) * 2;"},
    {"a function with a condition and a loop", "float f = turns(U * 3, V);"},
    {"a function that calls one", "float f = twice(U, V);"},
    {"an array", "float a[3] = {U * V, V * V, sin(U)}; a[1] += a[0] * a[2]; float f = a[1] + a[2];"},
    {"an array of many, by a varying index",
     "float a[40]; float i; for (i = 0; i < 40; i += 1) a[i] = sin(i * V); float f = a[floor(39 * U)];"},
    {"steps and floors", "float f = floor(20 * U) + step(0.53, V) + mod(7 * U, 1) + cellnoise(9 * U, 9 * V);"},
    {"a choice", "float f = (U > 0.52) ? V : 2 * U;"},
    {"a width of a filter", "float w = abs(Du(9 * U * U)) * 0.02 + 0.01; float f = smoothstep(0.5 - w, 0.5 + w, V);"},
    {"a width in a branch", "float f = 0; if (V > 0.4) { float x = sin(3 * U); f = filterstep(0.5, x) + Du(x * x); }"},
    {"a width in a loop", "float f = 0, i; for (i = 1; i < 4 + 3 * V; i += 1) f += filterstep(0.5, mod(U * i, 1)) / i;"},
    {"a bump on a bump", "float f = comp(normalize(calculatenormal(P + 0.01 * noise(9 * U, 5 * V) * N)), 0);"},
};
const char* const kFunctions = R"(
float shape(float x, y) { if (x > 0.52) return sin(9 * x) * y; return noise(5 * x, y); }
float turns(float x, y) {
    float i, s = 0;
    for (i = 0; i < 10 * x; i += 1) { s += sin(i * y); if (s > 3) return s; }
    return s + x;
}
float twice(float x, y) { float a = shape(x, y); float b = shape(a, x * y); return a * b + turns(b, a) + Du(x * x); }
)";

// The place that is one step on gives the other value of the difference: its own branches, turns and elements, in all forms.
// Lanes, builds S and V, and who shares a batch change no bit.
TEST(Differences, NeighboursGoTheirOwnWay) {
    constexpr double h = 1.0 / 32;
    std::vector<Place> places;
    for (const auto& [u, v] : {std::pair{0.5, 0.5}, {0.25, 0.75}, {0.53125, 0.51}, {0.3125, 0.21875}})
        for (int k = 0; k < 3; ++k) places.push_back({u + (k == 1 ? h : 0), v + (k == 2 ? h : 0), h, h});
    std::string body;
    std::vector<std::string> types;
    for (const Flow& flow : kFlows) {
        const std::string n = std::to_string(types.size());
        body += "{ float U = u, V = v; " + std::string(flow.body) + " r" + n + " = f; r" + std::to_string(types.size() + 1) +
                " = Du(f); r" + std::to_string(types.size() + 2) + " = Dv(f); }\n";
        types.insert(types.end(), 3, "float");
    }
    std::map<std::pair<int, int>, std::vector<std::vector<float>>> reference; // by how the code is made
    for (KernelOptions o : allConfigurations()) {
        // For the time it takes: here one build of each width, 8 lanes only optimised.
        if (o.lanes == 8 && (o.optimize == 0 || (o.mixed && !nightly()))) continue;
        if (!nightly() && o.lanes != 8 && o.mixed == (o.lanes == 16)) continue;
        SCOPED_TRACE(describe(o));
        o.differences = true;
        const auto out = run(body, types, places, o, kFunctions);
        auto& first = reference[{o.optimize, o.outline}];
        if (first.empty()) first = out;
        ASSERT_EQ(out.size(), types.size());
        for (size_t f = 0; f < std::size(kFlows); ++f) {
            SCOPED_TRACE(kFlows[f].name);
            for (size_t k = 3 * f; k < 3 * f + 3; ++k)
                for (size_t p = 0; p < places.size(); ++p) EXPECT_TRUE(sameBits(out[k][p], first[k][p])) << "point " << p;
            for (size_t p = 0; p < places.size(); p += 3) {
                const double value = double(out[3 * f][p]), byU = (double(out[3 * f][p + 1]) - value) / h,
                             byV = (double(out[3 * f][p + 2]) - value) / h;
                EXPECT_NEAR(double(out[3 * f + 1][p]), byU, 2e-4 * (1 + std::fabs(value) + std::fabs(byU)))
                    << "Du, place " << p / 3;
                EXPECT_NEAR(double(out[3 * f + 2][p]), byV, 2e-4 * (1 + std::fabs(value) + std::fabs(byV)))
                    << "Dv, place " << p / 3;
            }
        }
    }
    const std::vector<Place> one = {places[4]};
    const auto alone = run(body, types, one, grid(), kFunctions);
    const auto& all = reference[{grid().optimize, grid().outline}];
    for (size_t k = 0; k < alone.size(); ++k) EXPECT_TRUE(sameBits(alone[k][0], all[k][4])) << kFlows[k / 3].name;
}

// Inside of a branch or a loop the neighbour goes where the point goes: what is asked there is a difference of what is there.
TEST(Differences, WithinABranchOrLoopTheNeighbourFollows) {
    const std::vector<Place> places = {{0.5, 0.25, 0.0625, 0.125}, {0.75, 0.5, 0.125, 0.25}};
    const auto out = run(R"(
        r0 = -1; if (u < 0.51) { float x = u * u; r0 = Du(x); }
        float y = u, i; r1 = 0; for (i = 0; i < 3; i += 1) { y = y * (1 + v); r1 += Du(y * y); }
        float a[2]; r2 = 0; for (i = 0; i < 3; i += 1) { a[0] = u * u * i; a[1] = a[0] + v; r2 += Du(a[1]); }
        float f(float x) { return Du(x * x); } r3 = f(u * 2);
    )",
                         {"float", "float", "float", "float"}, places, grid());
    ASSERT_EQ(out.size(), 4u);
    for (size_t p = 0; p < places.size(); ++p) {
        const double u = places[p].u, v = places[p].v, h = places[p].du;
        double sum = 0, grown = 1;
        for (int i = 0; i < 3; ++i) grown *= (1 + v) * (1 + v), sum += grown * (2 * u + h);
        EXPECT_NEAR(double(out[0][p]), u < 0.51 ? 2 * u + h : -1, 1e-5);
        EXPECT_NEAR(double(out[1][p]), sum, 1e-5 * sum);
        EXPECT_NEAR(double(out[2][p]), 3 * (2 * u + h), 1e-5);
        EXPECT_NEAR(double(out[3][p]), 4 * (2 * u + h), 1e-5);
    }
}

TEST(Differences, WithoutAFootprintAreOverASmallStep) {
    const std::vector<Place> places = {{0.5, 0.25, 0, 0}};
    const auto out = run("r0 = Du(u * u); r1 = Dv(sin(v));", {"float", "float"}, places, grid());
    ASSERT_EQ(out.size(), 2u);
    EXPECT_NEAR(double(out[0][0]), 1, 2e-3);
    EXPECT_NEAR(double(out[1][0]), std::cos(0.25), 2e-3);
}

} // namespace
} // namespace alpenglow::rsl::differences_test
