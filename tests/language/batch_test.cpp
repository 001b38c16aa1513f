// Points that differ: masks that some lanes leave early, against plain C++ doing the same for one point; and a mixed batch, which
// must give each point the bits that it has alone.
#include "points.h"
#include <cmath>
#include <gtest/gtest.h>

namespace alpenglow::rsl::batch_test {
namespace {

constexpr int kPoints = 83; // no multiple of any width

float coordinate(int axis, int point) { return float((point * (axis ? 29 : 17) + 5) % kPoints) / float(kPoints); }

/// u and v scattered over the unit square, s = u, t = v, P = (u, v, 0).
PointValue scattered(int only = -1) {
    return [only](const std::string& name, int component, int part, int point) {
        if (only >= 0) point = only;
        float v = 0;
        EvaluationPoint::value(name, component, part, v);
        if (part != 0) return v;
        if (name == "u" || name == "s" || (name == "P" && component == 0)) return coordinate(0, point);
        if (name == "v" || name == "t" || (name == "P" && component == 1)) return coordinate(1, point);
        return v;
    };
}

std::unique_ptr<ShaderCompiler> makeCompiler() {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    return std::make_unique<ShaderCompiler>(settings);
}

struct Masked {
    const char* name;
    const char* body; ///< leaves its result in r
    float (*expected)(float u, float v);
};

const Masked kMasked[] = {
    {"while with a varying bound", "float i = 0; while (i < u * 20) { i += 1; r += i; }",
     [](float u, float) {
         float r = 0, i = 0;
         while (i < u * 20) {
             i += 1;
             r += i;
         }
         return r;
     }},
    {"break by point", "float i; for (i = 0; i < 12; i += 1) { if (i > v * 10) break; r += 1; }",
     [](float, float v) {
         float r = 0;
         for (float i = 0; i < 12; i += 1) {
             if (i > v * 10) break;
             r += 1;
         }
         return r;
     }},
    {"continue by point", "float i; for (i = 0; i < 12; i += 1) { if (mod(i, 1 + floor(u * 4)) == 0) continue; r += i; }",
     [](float u, float) {
         float r = 0, m = 1 + std::floor(u * 4);
         for (float i = 0; i < 12; i += 1) {
             if (i - m * std::floor(i / m) == 0) continue;
             r += i;
         }
         return r;
     }},
    {"break 2 by point",
     "float i, j; for (i = 0; i < 6; i += 1) for (j = 0; j < 6; j += 1) { if (i * 6 + j > u * 40) break 2; r += 1 + i; }",
     [](float u, float) {
         float r = 0;
         for (float i = 0; i < 6; i += 1)
             for (float j = 0; j < 6; j += 1) {
                 if (i * 6 + j > u * 40) return r;
                 r += 1 + i;
             }
         return r;
     }},
    {"continue 2 by point",
     "float i, j; for (i = 0; i < 6; i += 1) { for (j = 0; j < 6; j += 1) { if (i + j > v * 10) continue 2; r += 1; } r += 100; "
     "}",
     [](float, float v) {
         float r = 0;
         for (float i = 0; i < 6; i += 1) {
             bool left = false;
             for (float j = 0; j < 6 && !left; j += 1) {
                 if (i + j > v * 10) left = true;
                 else r += 1;
             }
             if (!left) r += 100;
         }
         return r;
     }},
    {"break and continue together",
     "float i; for (i = 0; i < 30; i += 1) { if (i > 25 * u) break; if (mod(i, 3) == 0) continue; if (i > 20 * v) { r += 1000; "
     "break; } r += i; }",
     [](float u, float v) {
         float r = 0;
         for (int i = 0; i < 30; i++) {
             if (float(i) > 25 * u) break;
             if (i % 3 == 0) continue;
             if (float(i) > 20 * v) {
                 r += 1000;
                 break;
             }
             r += float(i);
         }
         return r;
     }},
    {"return by point",
     "float f(float x) { if (x < 0.25) return 1; if (x < 0.5) { if (v > 0.5) return 2; return 3; } return 4; } r = f(u) * 10 + "
     "f(v);",
     [](float u, float v) {
         const auto f = [v](float x) { return x < 0.25f ? 1.0f : x < 0.5f ? (v > 0.5f ? 2.0f : 3.0f) : 4.0f; };
         return f(u) * 10 + f(v);
     }},
    {"return out of loops",
     "float f(float x, y) { float i, j; for (i = 0; i < 5; i += 1) for (j = 0; j < 5; j += 1) { if (i > 5 * x) return i * 10 + "
     "j; if (j > 5 * y) break; } return -1; } r = f(u, v);",
     [](float u, float v) {
         for (int i = 0; i < 5; i++)
             for (int j = 0; j < 5; j++) {
                 if (float(i) > 5 * u) return float(i * 10 + j);
                 if (float(j) > 5 * v) break;
             }
         return -1.0f;
     }},
    {"return from a void function",
     "void f(float x; output float y) { y = 1; if (x > 0.5) return; y = 2; if (x > 0.25) return; y = 3; } float a, b; f(u, a); "
     "f(v, b); r = a * 10 + b;",
     [](float u, float v) {
         const auto f = [](float x) { return x > 0.5f ? 1.0f : x > 0.25f ? 2.0f : 3.0f; };
         return f(u) * 10 + f(v);
     }},
    {"array written at a varying place",
     "float a[8]; float i; for (i = 0; i < 8; i += 1) a[i] = i; a[floor(u * 8)] = 100; a[floor(v * 8)] += 50; for (i = 0; i < 8; "
     "i += 1) r += a[i] * (1 + i);",
     [](float u, float v) {
         float a[8], r = 0;
         for (int i = 0; i < 8; i++) a[i] = float(i);
         a[int(std::floor(u * 8))] = 100;
         a[int(std::floor(v * 8))] += 50;
         for (int i = 0; i < 8; i++) r += a[i] * float(1 + i);
         return r;
     }},
    {"array written under a mask",
     "float a[4] = {1, 2, 3, 4}; if (u > 0.5) a[1] = 10; else if (v > 0.5) a[floor(u * 4)] = 20; r = a[0] + 100 * a[1] + 10000 * "
     "a[2];",
     [](float u, float v) {
         float a[4] = {1, 2, 3, 4};
         if (u > 0.5f) a[1] = 10;
         else if (v > 0.5f) a[int(std::floor(u * 4))] = 20;
         return a[0] + 100 * a[1] + 10000 * a[2];
     }},
    {"output argument under a mask",
     "void bump(output float x) { x += 1; } float a = 0; if (u > 0.5) bump(a); if (v > 0.5) { bump(a); bump(a); } r = a;",
     [](float u, float v) { return (u > 0.5f ? 1.0f : 0.0f) + (v > 0.5f ? 2.0f : 0.0f); }},
    {"do loop", "float i = 0; do { i += 1; r += i; } while (i < u * 10);",
     [](float u, float) {
         float r = 0, i = 0;
         do {
             i += 1;
             r += i;
         } while (i < u * 10);
         return r;
     }},
    {"nested conditions",
     "if (u < 0.3) { if (v < 0.3) r = 1; else if (v < 0.6) r = 2; else r = 3; } else if (u < 0.7 && v > 0.5) r = 4; else r = (u "
     "> v) ? 5 : 6;",
     [](float u, float v) {
         if (u < 0.3f) return v < 0.3f ? 1.0f : v < 0.6f ? 2.0f : 3.0f;
         if (u < 0.7f && v > 0.5f) return 4.0f;
         return u > v ? 5.0f : 6.0f;
     }},
    {"Mandelbrot",
     "float x = 0, y = 0; while (r < 40 && x * x + y * y < 4) { float t = x * x - y * y + (u * 3 - 2); y = 2 * x * y + (v * 2 - "
     "1); x = t; r += 1; }",
     [](float u, float v) {
         float x = 0, y = 0, r = 0;
         while (r < 40 && x * x + y * y < 4) {
             const float t = x * x - y * y + (u * 3 - 2);
             y = 2 * x * y + (v * 2 - 1);
             x = t;
             r += 1;
         }
         return r;
     }},
    {"Collatz", "float n = floor(u * 60) + 1; while (n != 1) { if (mod(n, 2) == 0) n /= 2; else n = 3 * n + 1; r += 1; }",
     [](float u, float) {
         int n = int(std::floor(u * 60)) + 1, r = 0;
         while (n != 1) {
             n = n % 2 == 0 ? n / 2 : 3 * n + 1;
             r++;
         }
         return float(r);
     }},
    {"string by point",
     "string w = \"x\"; if (u > 0.5) w = \"y\"; else if (v > 0.5) w = concat(w, \"y\"); r = (w == \"y\") ? 1 : (w == \"xy\") ? 2 "
     ": 3;",
     [](float u, float v) { return u > 0.5f   ? 1.0f
                                   : v > 0.5f ? 2.0f
                                              : 3.0f; }},
};

TEST(Masks, EveryPointGoesItsOwnWay) {
    const auto compiler = makeCompiler();
    Diagnostics d([](const Diagnostic& m) { ADD_FAILURE() << toString(m); });
    std::string parameters, body;
    std::vector<std::string> names;
    for (const Masked& m : kMasked) {
        names.push_back("r" + std::to_string(names.size()));
        parameters += "output varying float " + names.back() + " = 0;\n";
        body += "{ float r = 0; " + std::string(m.body) + " " + names.back() + " = r; }\n";
    }
    const auto shader = compiler->loadText("surface masks(" + parameters + ") {\n" + body + "}\n", "masks", d);
    ASSERT_TRUE(shader);
    for (KernelOptions o : configurations()) {
        SCOPED_TRACE(describe(o));
        o.outputs = names;
        const auto kernel = compiler->kernel(shader, o, d);
        ASSERT_TRUE(kernel);
        std::vector<std::vector<float>> out;
        ASSERT_TRUE(runPoints(*kernel, o.mixed, kPoints, scattered(), {}, out, d));
        for (size_t k = 0; k < names.size(); k++) {
            SCOPED_TRACE(kMasked[k].name);
            for (int p = 0; p < kPoints; p++)
                ASSERT_EQ(out[k][size_t(p)], kMasked[k].expected(coordinate(0, p), coordinate(1, p)))
                    << "u = " << coordinate(0, p) << ", v = " << coordinate(1, p);
        }
    }
}

// Noise, derivatives, loops and branches: what a shader is made of. Nothing may depend on who shares a batch.
const char* const kMixture = R"(
surface mixture(output varying float a = 0; output varying color b = 0; output varying normal c = 0; output varying float e = 0;)
{
    float fbm(point p; float octaves)
    {
        float sum = 0, f = 1, i;
        for (i = 0; i < octaves; i += 1) { sum += noise(p * f) / f; f *= 2.03; }
        return sum;
    }
    a = fbm(P * 7, 2 + 6 * u);
    if (a > 0.9) b = color noise(P * 3) * sin(20 * v);
    else { float i; for (i = 0; i < 9 * v; i += 1) b += cellnoise(point(i, u * 5, v * 5)); }
    c = normalize(calculatenormal(P + noise(P * 4) * normalize(N)));
    e = filterstep(0.5, mod(u * 9, 1)) + Du(Du(pow(u + 0.1, 2.5))) + spline(u, 0, 1, v, 2, 4);
}
)";

TEST(Batches, MixedGivesTheBitsOfSingle) {
    const auto compiler = makeCompiler();
    Diagnostics d([](const Diagnostic& m) { ADD_FAILURE() << toString(m); });
    const auto shader = compiler->loadText(kMixture, "mixture", d);
    ASSERT_TRUE(shader);
    std::vector<std::vector<float>> reference;
    for (KernelOptions o : configurations()) {
        SCOPED_TRACE(describe(o));
        o.outputs = {"a", "b", "c", "e"};
        const auto kernel = compiler->kernel(shader, o, d);
        ASSERT_TRUE(kernel);
        std::vector<std::vector<float>> all;
        ASSERT_TRUE(runPoints(*kernel, o.mixed, kPoints, scattered(), {}, all, d));
        if (reference.empty()) reference = all;
        for (size_t k = 0; k < all.size(); k++)
            for (size_t x = 0; x < all[k].size(); x++) ASSERT_TRUE(sameBits(all[k][x], reference[k][x])) << k << " " << x;
        for (int p = 0; p < kPoints; p += 7) {
            std::vector<std::vector<float>> alone;
            ASSERT_TRUE(runPoints(*kernel, o.mixed, 1, scattered(p), {}, alone, d));
            for (size_t k = 0; k < all.size(); k++)
                for (size_t c = 0; c < alone[k].size(); c++)
                    ASSERT_TRUE(sameBits(alone[k][c], all[k][c * kPoints + size_t(p)]))
                        << "output " << k << " component " << c << " of point " << p;
        }
    }
}

TEST(Evaluation, RandomIsInTheUnitIntervalAndAnotherAtEveryCall) {
    const auto compiler = makeCompiler();
    Diagnostics d([](const Diagnostic& m) { ADD_FAILURE() << toString(m); });
    const Evaluation one = evaluate(*compiler, "color a = random(); float b = random();", "vector(a[0], a[1], b)", {}, d);
    ASSERT_EQ(one.numbers.size(), 3u);
    for (float x : one.numbers) {
        EXPECT_GE(x, 0.0f);
        EXPECT_LT(x, 1.0f);
    }
    EXPECT_NE(one.numbers[0], one.numbers[1]);
    EXPECT_NE(one.numbers[0], one.numbers[2]);
    EXPECT_EQ(evaluate(*compiler, "color a = random(); float b = random();", "vector(a[0], a[1], b)", {}, d).numbers,
              one.numbers);
}

} // namespace
} // namespace alpenglow::rsl::batch_test
