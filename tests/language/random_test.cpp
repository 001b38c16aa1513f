// Random programs, the same for ever (fixed seeds): machine code against the tree-walking evaluator of tests/rsl/ir, which runs
// the IR as it was before any pass, one point at a time. The bits must agree at every point. Each program is compiled in two of
// all configurations, which take their turns. Nightly there are twice as many programs.
#include "../rsl/ir/evaluator.h"
#include "../sanitized.h"
#include "points.h"
#include "rsl/ir/build.h"
#include "rsl/ir/verify.h"
#include <gtest/gtest.h>
#include <random>

namespace alpenglow::rsl::random_test {
namespace {

constexpr int kPoints = 37;

int programs() { return kSanitized ? 50 : nightly() ? 200 : 40; }
int derivedPrograms() { return nightly() && !kSanitized ? 40 : 14; }

/// Well-typed statements over floats, colours, points and an array. Loops have at most eight turns; jumps leave one or two of
/// them.
class Generator {
public:
    explicit Generator(unsigned seed) : rng_(seed) {}

    /// With derivatives of the variables, first and second, in the outputs when `derived`.
    /// With the values of the variables and how they change, when `steps`.
    std::string shader(bool derived = false, bool steps = false) {
        std::string s = "surface random(float k = 1.5; color t = color(0.5, 0.25, 1); output varying float o = 0; output varying "
                        "point q = 0;)\n{\n";
        for (int n = pick(3); n > 0; n--) s += function();
        s += "float x = 0.1, y = u, z = -v; color c = 0.5, d = color(u, v, 0.25); point p = P, w = point(1, u, -1); float a[4] = "
             "{1, 2, -3, 0.5};\n";
        for (int n = 3 + pick(5); n > 0; n--) s += statement() + "\n";
        if (derived)
            s += "x = Du(x) + Dv(y); y = Du(Dv(z)) + Dv(Dv(z)); z = area(p); w = point(calculatenormal(w)); d = Du(d);\n";
        if (steps) return s + "Ci = color(x, y, z); q = point(Du(x), Dv(y), Du(z)); o = 0;\n}\n";
        return s + "Ci = c + d; Oi = color(x, y, z); o = a[0] + a[1] * a[2] - a[3]; q = p + w;\n}\n";
    }

private:
    std::mt19937 rng_;
    int depth_ = 0, loops_ = 0, names_ = 0;
    bool inFunction_ = false;
    int functions_ = 0, procedures_ = 0;

    int pick(int n) { return static_cast<int>(rng_() % static_cast<unsigned>(n)); }
    template <size_t N> const char* any(const char* const (&list)[N]) { return list[size_t(pick(int(N)))]; }

    std::string function() {
        inFunction_ = true;
        std::string s;
        if (pick(2)) {
            s = "float f" + std::to_string(functions_++) + "(float x, y; point p) { float z = 0.5; if (" + condition(1) +
                ") return " + number(1) + "; ";
            if (pick(2))
                s += "float i; for (i = 0; i < 4; i += 1) { z += " + number(1) + "; if (" + condition(1) + ") return z; } ";
            s += "return " + number(0) + "; }\n";
        } else {
            s = "void g" + std::to_string(procedures_++) +
                "(float x; output float y; output float z) { point p = point(x, y, z); y = " + number(1) + "; if (" +
                condition(1) + ") return; z = " + number(1) + "; }\n";
        }
        inFunction_ = false;
        return s;
    }

    std::string number(int d) {
        static const char* const leaves[] = {"x", "y", "z", "u", "v", "0.5", "2", "-1.25", "0", "3", "0.1"};
        if (!inFunction_ && pick(12) == 0)
            return pick(2) ? "k" : "comp(t, 1)"; // the same for all points: another code in build S
        static const char* const unary[] = {"abs", "floor", "ceil", "round", "sign",        "sqrt",        "sin",
                                            "cos", "atan",  "exp",  "log",   "inversesqrt", "float noise", "float cellnoise",
                                            "-"};
        if (d > 3 || pick(4) == 0) return any(leaves);
        const auto e = [&] { return number(d + 1); };
        switch (pick(inFunction_ ? 14 : 17)) {
        case 0:
            return "(" + e() + " + " + e() + ")";
        case 1:
            return "(" + e() + " - " + e() + ")";
        case 2:
        case 3:
            return "(" + e() + " * " + e() + ")";
        case 4:
            return "(" + e() + " / " + e() + ")";
        case 5:
            return "((" + condition(d + 1) + ") ? " + e() + " : " + e() + ")";
        case 6:
            return std::string(any({"min", "max", "mod", "step", "pow", "atan"})) + "(" + e() + ", " + e() + ")";
        case 7:
            return std::string(any({"clamp", "mix", "smoothstep"})) + "(" + e() + ", " + e() + ", " + e() + ")";
        case 8:
        case 9:
            return std::string(any(unary)) + "(" + e() + ")";
        case 10:
            return std::string(any({"xcomp", "ycomp", "zcomp"})) + "(" + tuple(d + 1) + ")";
        case 11:
            return "length(vector(" + tuple(d + 1) + "))";
        case 12:
            return "(" + tuple(d + 1) + " . " + tuple(d + 1) + ")";
        case 13:
            return "float noise(" + tuple(d + 1) + ")";
        case 14:
            return pick(2) ? "a[" + std::to_string(pick(4)) + "]" : "a[clamp(" + e() + ", 0, 3)]";
        case 15:
            return functions_ ? "f" + std::to_string(pick(functions_)) + "(" + e() + ", " + e() + ", " + tuple(d + 1) + ")"
                              : "spline(" + e() + ", 0, " + e() + ", 1, 2)";
        default:
            return "comp(" + colour(d + 1) + ", " + std::to_string(pick(3)) + ")";
        }
    }

    std::string colour(int d) {
        if (d > 3 || pick(4) == 0) return any({"c", "d", "Cs", "t", "color(1, 0.5, 0.25)"});
        const auto e = [&] { return colour(d + 1); };
        switch (pick(8)) {
        case 0:
            return "(" + e() + " + " + e() + ")";
        case 1:
            return "(" + e() + " * " + e() + ")";
        case 2:
            return "(" + e() + " - " + number(d + 1) + ")";
        case 3:
            return "mix(" + e() + ", " + e() + ", " + number(d + 1) + ")";
        case 4:
            return "color(" + number(d + 1) + ", " + number(d + 1) + ", " + number(d + 1) + ")";
        case 5:
            return "((" + condition(d + 1) + ") ? " + e() + " : " + e() + ")";
        case 6:
            return std::string(any({"max", "min"})) + "(" + e() + ", " + e() + ")";
        default:
            return "ctransform(\"" + std::string(any({"hsv", "hsl", "yiq", "xyz"})) + "\", " + e() + ")";
        }
    }

    std::string tuple(int d) {
        if (d > 3 || pick(3) == 0) return inFunction_ ? any({"p", "point(0.5, 1, 2)"}) : any({"p", "w", "P", "point(0.5, 1, 2)"});
        const auto e = [&] { return tuple(d + 1); };
        switch (pick(6)) {
        case 0:
            return "(" + e() + " + " + e() + ")";
        case 1:
            return "(" + e() + " * " + number(d + 1) + ")";
        case 2:
            return "point(" + number(d + 1) + ", " + number(d + 1) + ", " + number(d + 1) + ")";
        case 3:
            return "point(normalize(vector(" + e() + ")))";
        case 4:
            return "point(vector(" + e() + ") ^ vector(" + e() + "))";
        default:
            return "rotate(" + e() + ", " + number(d + 1) + ", point(0, 0, 0), point(0, 1, 1))";
        }
    }

    std::string condition(int d) {
        switch (d > 3 ? 0 : pick(6)) {
        case 0:
        case 1:
            return number(d + 1) + " < " + number(d + 1);
        case 2:
            return number(d + 1) + " >= " + number(d + 1);
        case 3:
            return number(d + 1) + " == " + number(d + 1);
        case 4:
            return "(" + condition(d + 1) + ") && (" + condition(d + 1) + ")";
        default:
            return "!(" + condition(d + 1) + ") || (" + condition(d + 1) + ")";
        }
    }

    std::string block() {
        std::string s = "{ ";
        for (int n = 1 + pick(3); n > 0; n--) s += statement() + " ";
        return s + "}";
    }

    std::string statement() {
        depth_++;
        std::string s;
        switch (pick(depth_ > 3 ? 6 : 10)) {
        case 0:
        case 1:
            s = std::string(any({"x", "y", "z"})) + any({" = ", " += ", " *= ", " -= "}) + number(0) + ";";
            break;
        case 2:
            s = std::string(any({"c", "d"})) + any({" = ", " += ", " *= "}) + colour(1) + ";";
            break;
        case 3:
            s = std::string(any({"p", "w"})) + any({" = ", " += "}) + tuple(1) + ";";
            break;
        case 4:
            s = (pick(2) ? "a[" + std::to_string(pick(4)) + "]" : "a[clamp(" + number(2) + ", 0, 3)]") + any({" = ", " += "}) +
                number(1) + ";";
            break;
        case 5:
            if (loops_ > 0) {
                s = "if (" + condition(1) + ") " + any({"break", "continue"}) + (loops_ > 1 && pick(2) ? " 2;" : ";");
            } else if (procedures_ > 0) {
                s = "g" + std::to_string(pick(procedures_)) + "(" + number(1) + ", x, " + any({"y", "z", "a[1]"}) + ");";
            } else {
                s = "c[" + std::to_string(pick(3)) + "] = " + number(1) + ";";
            }
            break;
        case 6:
        case 7:
            s = "if (" + condition(0) + ") " + block() + (pick(2) ? " else " + block() : "");
            break;
        default: {
            const std::string i = "i" + std::to_string(names_++);
            const std::string bound = pick(2) ? std::to_string(1 + pick(4)) : "clamp(" + number(2) + ", 0, 4)";
            loops_++;
            if (loops_ > 2) s = block();
            else if (pick(4) == 0)
                s = "{ float " + i + " = " + number(2) + "; while (" + i + " > 0 && " + i + " < 6) { " + i + " += 1; " +
                    statement() + " } }";
            else
                s = "{ float " + i + "; for (" + i + " = 0; " + i + " < 8 && " + i + " < " + bound + "; " + i + " += 1) " +
                    block() + " }";
            loops_--;
        }
        }
        depth_--;
        return s;
    }

    const char* any(std::initializer_list<const char*> list) { return list.begin()[pick(int(list.size()))]; }
};

float value(const std::string& name, int component, int point) {
    float v = 0;
    EvaluationPoint::value(name, component, 0, v);
    const float a = float((point * 17 + 5) % kPoints) / kPoints, b = float((point * 23 + 1) % kPoints) / kPoints;
    if (name == "param:k") return 1.5f;
    if (name == "param:t") return component == 0 ? 0.5f : component == 1 ? 0.25f : 1.0f;
    if (name == "u" || (name == "P" && component == 0)) return a;
    if (name == "v" || (name == "P" && component == 1)) return b;
    return v;
}

TEST(RandomPrograms, MachineCodeAndEvaluatorAgree) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    const std::vector<KernelOptions> all = allConfigurations();
    const std::vector<std::string> outputs = {"Ci", "Oi", "o", "q"};
    int compared = 0;
    for (unsigned seed = 1; seed <= unsigned(programs()); seed++) {
        const std::string source = Generator(seed).shader();
        SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + source);
        Diagnostics d([](const Diagnostic& m) {
            if (m.severity >= Severity::Error) ADD_FAILURE() << toString(m);
        });
        const auto shader = compiler.loadText(source, "random", d);
        ASSERT_TRUE(shader);
        KernelOptions plain;
        plain.outputs = outputs;
        const auto tree = buildKernel(shader->program(), shader->shader(), plain, d);
        ASSERT_TRUE(tree);
        ASSERT_EQ(ir::verify(*tree), "");
        std::vector<std::map<std::string, std::vector<float>>> expected;
        for (int p = 0; p < kPoints; p++) {
            ir::Evaluator e(*tree);
            for (const ir::Input& i : tree->inputs)
                for (int c = 0; c < ir::components(i.kind); c++) e.inputs[i.name].push_back(value(i.name, c, p));
            ASSERT_NO_THROW(e.run());
            expected.push_back(e.outputs);
        }
        for (unsigned turn = 0; turn < 2; turn++) {
            KernelOptions o = all[(seed + turn * 5) % all.size()];
            SCOPED_TRACE(describe(o));
            o.outputs = outputs;
            const auto kernel = compiler.kernel(shader, o, d);
            ASSERT_TRUE(kernel);
            std::vector<std::vector<float>> got;
            const auto at = [](const std::string& name, int component, int part, int point) {
                return part == 0 ? value(name, component, point) : 0.0f;
            };
            ASSERT_TRUE(runPoints(*kernel, o.mixed, kPoints, at, compiler.parameterValues(shader, d), got, d));
            for (size_t k = 0; k < got.size(); k++)
                for (size_t x = 0; x < got[k].size(); x++) {
                    const float want = expected[x % kPoints].at(kernel->outputs()[k].name).at(x / kPoints);
                    ASSERT_TRUE(sameBits(got[k][x], want) || (got[k][x] == 0 && want == 0))
                        << kernel->outputs()[k].name << "[" << x / kPoints << "] at point " << x % kPoints << ": " << got[k][x]
                        << ", not " << want;
                    compared++;
                }
        }
    }
    EXPECT_EQ(compared, programs() * 2 * kPoints * 10); // Ci, Oi and q have three components, o one
}

// The evaluator knows no derivatives; here the configurations are compared with each other. Their values have closed forms in
// derivatives.rsl.
TEST(RandomPrograms, DerivativesHaveTheSameBitsEverywhere) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    const std::vector<KernelOptions> all = allConfigurations();
    int compared = 0;
    for (unsigned seed = 1; seed <= unsigned(derivedPrograms()); seed++) {
        const std::string source = Generator(seed * 7919).shader(true);
        SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + source);
        Diagnostics d([](const Diagnostic& m) {
            if (m.severity >= Severity::Error) ADD_FAILURE() << toString(m);
        });
        const auto shader = compiler.loadText(source, "random", d);
        ASSERT_TRUE(shader);
        std::vector<std::vector<float>> first;
        for (unsigned turn = 0; turn < 4; turn++) {
            KernelOptions o = all[(seed + turn * 5) % all.size()];
            SCOPED_TRACE(describe(o));
            o.outputs = {"Ci", "Oi", "o", "q"};
            const auto kernel = compiler.kernel(shader, o, d);
            ASSERT_TRUE(kernel);
            std::vector<std::vector<float>> got;
            const auto at = [](const std::string& name, int component, int part, int point) {
                float v = 0;
                EvaluationPoint::value(name, component, part, v);
                return part == 0 ? value(name, component, point) : v;
            };
            ASSERT_TRUE(runPoints(*kernel, o.mixed, kPoints, at, compiler.parameterValues(shader, d), got, d));
            if (first.empty()) first = got;
            for (size_t k = 0; k < got.size(); k++)
                for (size_t x = 0; x < got[k].size(); x++) {
                    ASSERT_TRUE(sameBits(got[k][x], first[k][x]) || (got[k][x] == 0 && first[k][x] == 0))
                        << kernel->outputs()[k].name << "[" << x / kPoints << "] at point " << x % kPoints << ": " << got[k][x]
                        << ", not " << first[k][x];
                    compared++;
                }
        }
    }
    EXPECT_EQ(compared, derivedPrograms() * 4 * kPoints * 10);
}

// As differences: the passes leave sound code, lanes and builds S and V have the same bits; and where the value is no neighbour's
// by chance of rounding, the derivative is the difference of the values at the place and one step on, whatever branches, loops,
// functions and arrays lie between. Arrays that are written within a branch or a loop follow the point there, and a condition can
// turn by rounding: a few places in a hundred may differ.
TEST(RandomPrograms, DifferencesAreThoseOfTheNextPlace) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    constexpr double h = 1.0 / 64;
    constexpr int kPlaces = 36; // in threes: the place, its neighbours along u and v
    const auto at = [&](const std::string& name, int component, int part, int point) {
        float v = 0;
        EvaluationPoint::value(name, component, part, v);
        if (name == "du" || name == "dv") return part == 0 ? float(h) : 0.0f;
        if (part != 0) return v;
        const int place = point / 3, turn = point % 3;
        const float x = float((place * 5 % 12) / 12.0 + (turn == 1 ? h : 0)),
                    y = float((place * 7 % 12) / 12.0 + (turn == 2 ? h : 0));
        if (name == "u" || name == "s" || (name == "P" && component == 0)) return x;
        if (name == "v" || name == "t" || (name == "P" && component == 1)) return y;
        return v;
    };
    int compared = 0, differ = 0;
    for (unsigned seed = 1; seed <= unsigned(derivedPrograms()); seed++) {
        const std::string source = Generator(seed * 104729).shader(false, true);
        SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + source);
        Diagnostics d([](const Diagnostic& m) {
            if (m.severity >= Severity::Error) ADD_FAILURE() << toString(m);
        });
        const auto shader = compiler.loadText(source, "random", d);
        ASSERT_TRUE(shader);
        std::vector<std::vector<float>> first;
        for (const int lanes : {16, 8, 4}) {
            KernelOptions o;
            o.lanes = lanes;
            o.mixed = lanes == 8;
            o.optimize = seed % 2 ? 2 : 0;
            o.outline = seed % 3 ? o.outline : 0;
            o.differences = true;
            o.outputs = {"Ci", "q", "o"};
            const auto tree = compiler.analyse(*shader, o, d);
            ASSERT_TRUE(tree);
            ASSERT_EQ(ir::verify(*tree), "");
            const auto kernel = compiler.kernel(shader, o, d);
            ASSERT_TRUE(kernel);
            std::vector<std::vector<float>> got;
            ASSERT_TRUE(runPoints(*kernel, o.mixed, kPlaces, at, compiler.parameterValues(shader, d), got, d));
            if (first.empty()) first = got;
            for (size_t k = 0; k < got.size(); k++)
                for (size_t x = 0; x < got[k].size(); x++)
                    ASSERT_TRUE(sameBits(got[k][x], first[k][x])) << "output " << k << ", value " << x;
        }
        for (size_t c = 0; c < 3; c++) // Ci = (x, y, z), q = (Du(x), Dv(y), Du(z))
            for (size_t p = 0; p < size_t(kPlaces); p += 3) {
                const double here = double(first[0][c * kPlaces + p]),
                             next = double(first[0][c * kPlaces + p + (c == 1 ? 2 : 1)]);
                const double got = double(first[1][c * kPlaces + p]);
                if (!std::isfinite(here) || !std::isfinite(next) || std::fabs(here) + std::fabs(next) > 1e4) continue;
                ++compared;
                differ += !(std::fabs(got - (next - here) / h) <= 2e-3 * (1 + std::fabs(here) + std::fabs(next - here) / h));
            }
    }
    EXPECT_GT(compared, 20 * derivedPrograms());
    EXPECT_LT(differ, compared / 25) << compared;
}

} // namespace
} // namespace alpenglow::rsl::random_test
