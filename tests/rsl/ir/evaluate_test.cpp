// The passes against the evaluator: on values worked out by hand, then on random programs.
#include "../../nightly.h"
#include "compile.h"
#include "evaluator.h"
#include <cmath>
#include <random>

namespace evaluate_test {

using namespace alpenglow;
using namespace alpenglow::rsl;
using namespace alpenglow::rsl::ir;

namespace {

std::vector<float> run(const Compiled& c, const std::string& output, std::map<std::string, std::vector<float>> inputs = {}) {
    Evaluator e(*c.kernel);
    e.inputs = std::move(inputs);
    e.run();
    return e.outputs[output];
}

TEST(Evaluate, ControlFlow) {
    const std::tuple<const char*, float> cases[] = {
        {"float x = 0; float i; for (i = 0; i < s; i += 1) { if (i == 2) continue; if (i == 5) break; x += i; } Ci = x;",
         0 + 1 + 3 + 4},
        {"float x = 0; float i; float j; for (i = 0; i < s; i += 1) for (j = 0; j < 3; j += 1) { if (i + j == 4) break 2; x += "
         "1; } Ci = x;",
         8},
        {"float x = 0; float i; float j; for (i = 0; i < 3; i += 1) { for (j = 0; j < s; j += 1) { if (j == 1) continue 2; x += "
         "1; } x += 100; } Ci = x;",
         3},
        {"float f(float a) { if (a > 2) return 10; a += 1; if (a > 2) return 20; return a; } Ci = f(s) + 100 * f(2) + 10000 * "
         "f(0);",
         10 + 2000 + 10000},
        {"float f(float a) { float i; for (i = 0; i < 100; i += 1) if (i * i > a) return i; return -1; } Ci = f(s);", 4},
        {"void g(output float a, b) { a += 1; b = a * 2; } float p = 3, q = 0; g(p, q); Ci = p + 10 * q;", 84},
        {"float a[3] = {1, 2, 3}; float i; float x = 0; for (i = 0; i < 3; i += 1) { a[i] = a[i] * s; x += a[i]; } Ci = x;", 60},
        {"color c = 1; c[1] = 5; c[s - 8] = 7; Ci = c[0] + c[1] + c[2];", 13},
        {"float x = 1; while (x < s) x *= 2; Ci = x;", 16},
        {"Ci = (s > 5) ? 1 : 2;", 1},
        {"float a = 2; float g() { extern float a; a += 1; return a; } float r = g(); Ci = r * 10 + a;", 33},
        {"Ci = 7 / (s - 10);", 0},
    };
    for (const auto& [body, expected] : cases) {
        SCOPED_TRACE(body);
        const std::string text = body;
        const size_t split = text.find("} Ci");
        (void)split;
        for (const bool optimise : {false, true}) {
            const Compiled c = compile("surface t() { " + text + " }", {}, optimise);
            if (c.kernel) EXPECT_EQ(run(c, "Ci", {{"s", {10}}}), std::vector<float>(3, expected)) << c.text();
        }
    }
}

/// Random statements over three floats, two colours and rays; only terminating loops.
struct Generator {
    std::mt19937 rng;
    int depth = 0, loops = 0;
    bool rays = false;
    int pick(int n) { return static_cast<int>(rng() % static_cast<unsigned>(n)); }
    std::string f(int d = 0) {
        static const char* const leaf[] = {"s", "t", "x", "y", "z", "0.5", "1", "-0.25", "param"};
        if (d > 2 || pick(3) == 0) return leaf[pick(9)];
        switch (pick(7)) {
        case 0:
            return "(" + f(d + 1) + " + " + f(d + 1) + ")";
        case 1:
            return "(" + f(d + 1) + " - " + f(d + 1) + ")";
        case 2:
            return "(" + f(d + 1) + " * " + f(d + 1) + ")";
        case 3:
            return "(" + f(d + 1) + " / " + f(d + 1) + ")";
        case 4:
            return "((" + f(d + 1) + " < " + f(d + 1) + ") ? " + f(d + 1) + " : " + f(d + 1) + ")";
        case 5:
            return "min(" + f(d + 1) + ", " + f(d + 1) + ")";
        default:
            return "a[" + std::to_string(pick(3)) + "]";
        }
    }
    /// Affine in a, b and rays.
    std::string c(int d = 0) {
        if (d > 2 || pick(3) == 0) return pick(2) ? "a1" : pick(2) ? "b1" : "Cs";
        switch (pick(rays ? 6 : 5)) {
        case 0:
            return "(" + c(d + 1) + " + " + c(d + 1) + ")";
        case 1:
            return "(" + c(d + 1) + " - " + c(d + 1) + ")";
        case 2:
            return "(" + c(d + 1) + " * " + f(d + 1) + ")";
        case 3:
            return "mix(" + c(d + 1) + ", " + c(d + 1) + ", " + f(d + 1) + ")";
        case 4:
            return "((" + f(d + 1) + " < " + f(d + 1) + ") ? " + c(d + 1) + " : " + c(d + 1) + ")";
        default:
            return "trace(P, vector(" + f(2) + ", " + f(2) + ", 1))";
        }
    }
    std::string statement() {
        ++depth;
        std::string r;
        switch (depth > 4 ? pick(3) : pick(6)) {
        case 0:
            r = std::string(1, "xyz"[pick(3)]) + " = " + f() + ";";
            break;
        case 1:
            r = std::string(pick(2) ? "a1" : "b1") + (pick(2) ? " += " : " = ") + c() + ";";
            break;
        case 2:
            r = "a[" + std::to_string(pick(3)) + "] = " + f() + ";";
            break;
        case 3:
            r = "if (" + f() + " < " + f() + ") { " + block() + "} else { " + block() + "}";
            break;
        case 4: {
            const std::string i = "i" + std::to_string(loops++);
            const std::string n = pick(2) ? "3" : "param * 4";
            const std::string jump = pick(3) ? "" : "if (" + f() + " < " + f() + ") " + (pick(2) ? "break; " : "continue; ");
            r = "float " + i + "; for (" + i + " = 0; " + i + " < " + n + "; " + i + " += 1) { " + block() + jump + block() + "}";
            break;
        }
        default:
            r = block();
        }
        --depth;
        return r;
    }
    std::string block() {
        std::string r;
        for (int n = pick(3) + 1; n > 0; --n) r += statement() + " ";
        return r;
    }
    std::string shader() {
        return "surface t(float param = 0.5) { float x = 0.1, y = s, z = 0; color a1 = 0, b1 = Cs; float a[3] = {1, 2, 3}; " +
               block() + block() + "Ci = a1 + b1 * 0.5; Oi = x + y + z; }";
    }
};

bool close(const std::vector<float>& a, const std::vector<float>& b, float tolerance) {
    for (size_t n = 0; n < a.size(); ++n) {
        if (!std::isfinite(a[n]) || std::fabs(a[n]) > 1e20f) continue;
        if (!(std::fabs(a[n] - b[n]) <= tolerance * (1 + std::fabs(a[n])))) return false;
    }
    return a.size() == b.size();
}

TEST(Evaluate, PassesKeepValuesOfRandomPrograms) {
    for (unsigned seed = 1; seed <= (nightly() ? 400u : 150u); ++seed) {
        Generator g;
        g.rng.seed(seed);
        const std::string source = g.shader();
        SCOPED_TRACE(source);
        const Compiled plain = compile(source, {}, false), fast = compile(source);
        if (!plain.kernel || !fast.kernel) return;
        const std::vector<float> a = run(plain, "Ci"), b = run(fast, "Ci");
        ASSERT_EQ(0, std::memcmp(a.data(), b.data(), a.size() * sizeof(float))) << plain.text() << fast.text();
        ASSERT_TRUE(close(run(plain, "Oi"), run(fast, "Oi"), 0)) << plain.text() << fast.text();
    }
}

TEST(Evaluate, AffineFormGivesTheSameSum) {
    int affine = 0;
    const unsigned programs = nightly() ? 400 : 150;
    for (unsigned seed = 1; seed <= programs; ++seed) {
        Generator g;
        g.rays = true;
        g.rng.seed(seed * 7919);
        const std::string source = g.shader();
        SCOPED_TRACE(source);
        const Compiled plain = compile(source, {}, false), fast = compile(source);
        if (!plain.kernel || !fast.kernel) return;
        if (fast.kernel->facts.affine) {
            ++affine;
            EXPECT_EQ(fast.count(Op::Request), 0);
        }
        const std::vector<float> a = run(plain, "Ci"), b = run(fast, "Ci");
        bool huge = false;
        for (float x : a) huge = huge || !(std::fabs(x) < 1e4f); // cancellation of large terms says nothing
        if (!huge)
            ASSERT_TRUE(close(a, b, 2e-3f)) << a[0] << " " << a[1] << " " << a[2] << " / " << b[0] << " " << b[1] << " " << b[2]
                                            << "\n"
                                            << plain.text() << fast.text();
    }
    EXPECT_GT(affine,
              int(programs /
                  4)); // every colour is affine, but many loops of these programs couple two sums, which is left to suspension
}

} // namespace

} // namespace evaluate_test
