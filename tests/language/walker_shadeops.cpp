// Shadeops by their definitions, one float at a time. Where a definition says how it is rounded (one fused multiplication here,
// two roundings there) it is written so; nothing here comes in lanes or carries derivatives.
#include "walker.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <regex>
#include <stdexcept>

namespace alpenglow::rsl {
namespace {

using V3 = std::array<float, 3>;
using Arguments = std::vector<Walked>;
using Definition = std::function<Walked(Arguments&)>;

constexpr float kPi = 0x1.921fb6p+1f;

Walked real(float x) {
    Walked w;
    w.n[0] = x;
    return w;
}
V3 three(const Walked& w) { return {w.n[0], w.n[1], w.n[2]}; }
Walked tuple(const V3& v) {
    Walked w;
    w.base = Base::Vector;
    std::copy(v.begin(), v.end(), w.n.begin());
    return w;
}

int width(Base b) { return b == Base::String ? 1 : componentCount(b); }
float over(float a, float b) { return b == 0 ? 0 : a / b; }
float lesser(float a, float b) { return a < b ? a : b; }
float greater(float a, float b) { return a > b ? a : b; }
float root(float x) { return std::sqrt(greater(x, 0)); }
float dot(const V3& a, const V3& b) { return std::fma(a[0], b[0], std::fma(a[1], b[1], a[2] * b[2])); }
V3 minus(const V3& a, const V3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
V3 times(const V3& a, float k) { return {a[0] * k, a[1] * k, a[2] * k}; }
/// By a power of two to where squares are in range: 1, unless the length is far from it.
float midRange(const V3& a) {
    const float square = dot(a, a);
    return square < 0x1p-100f ? 0x1p100f : square > 0x1p120f ? 0x1p-70f : 1;
}
float length(const V3& a) {
    const V3 b = times(a, midRange(a));
    return root(dot(b, b)) / midRange(a);
}
float clampedIndex(float i, float last) { return lesser(greater(std::trunc(i), 0), last); }

float modulo(float x, float y) {
    const float q = over(x, y), n = std::floor(q);
    if (!(std::fabs(q) < 16777216.0f) || y == 0) return 0;
    const float r = std::fma(-n, y, x);
    return (y < 0 ? -r : r) < 0 ? r + y : r;
}

float rounded(float x) {
    const float t = std::trunc(x);
    return std::fabs(x - t) >= 0.5f ? t + std::copysign(1.0f, x) : t;
}

float smooth(float lo, float hi, float x) {
    if (x < lo) return 0;
    if (x >= hi) return 1;
    const float t = over(x - lo, hi - lo);
    return t * t * (3 - t * 2);
}

float blend(float x, float y, float alpha) { return std::fma(y, alpha, x * (1 - alpha)); }

float segmentDistance(const V3& a, const V3& b, const V3& q) {
    const V3 d = minus(b, a), e = minus(q, a), dm = times(d, midRange(d)), em = times(e, midRange(e));
    const float t = over(dot(dm, em), dot(dm, dm)) * midRange(d) / midRange(e);
    return length(minus(e, times(d, greater(0, lesser(t, 1)))));
}

V3 refracted(const V3& i, const V3& n, float eta) {
    const float d = dot(i, n), k = 1 - eta * eta * (1 - d * d);
    return k < 0 ? V3{} : minus(times(i, eta), times(n, eta * d + root(k)));
}

V3 transformed(const Walked& m, const V3& p, Base rule) {
    const auto at = [&](int r, int c) { return m.n[size_t(r * 4 + c)]; };
    const auto column = [&](int c) {
        const float last = rule == Base::Vector ? p[2] * at(2, c) : std::fma(p[2], at(2, c), at(3, c));
        return std::fma(p[0], at(0, c), std::fma(p[1], at(1, c), last));
    };
    if (rule == Base::Vector) return {column(0), column(1), column(2)};
    const float w = column(3);
    return {over(column(0), w), over(column(1), w), over(column(2), w)};
}

float cubic(const std::string& basis, float t, float p, float q, float r, float s) {
    float a, b, c, d;
    if (basis == "bezier") a = p, b = (q - p) * 3, c = (p + r) * 3 - q * 6, d = (s - p) + (q - r) * 3;
    else if (basis == "b-spline" || basis == "bspline")
        a = (p + q * 4 + r) * (1.0f / 6), b = (r - p) * 0.5f, c = (p + r) * 0.5f - q, d = ((s - p) + (q - r) * 3) * (1.0f / 6);
    else if (basis == "hermite") a = p, b = q, c = (r - p) * 3 - q * 2 - s, d = (p - r) * 2 + q + s;
    else if (basis == "linear") a = q, b = r - q, c = 0, d = 0;
    else a = q, b = (r - p) * 0.5f, c = p + r * 2 - q * 2.5f - s * 0.5f, d = (s - p) * 0.5f + (q - r) * 1.5f;
    return std::fma(std::fma(std::fma(d, t, c), t, b), t, a);
}

Walked spline(Arguments& a) {
    const bool named = a[0].base == Base::String;
    const std::string basis = named ? a[0].s : "catmull-rom";
    if (basis.rfind("solve", 0) == 0) throw std::runtime_error("the walker does not invert splines");
    const float v = a[named ? 1 : 0].n[0];
    const Walked* p = &a[named ? 2 : 1];
    if (int(a.size()) - (named ? 2 : 1) < 4) return Walked(); // no segment
    const int n = int(a.size()) - (named ? 2 : 1), step = basis == "bezier" ? 3 : basis == "hermite" ? 2 : 1;
    const int segments = (n - 4) / step + 1;
    const float inside = greater(0, lesser(v, 1)) * float(segments), s = lesser(std::floor(inside), float(segments - 1));
    const Walked* at = p + int(s) * step;
    Walked r = *p;
    for (size_t c = 0; c < 3; c++) r.n[c] = cubic(basis, inside - s, at[0].n[c], at[1].n[c], at[2].n[c], at[3].n[c]);
    return r;
}

/// Floats and strings. %d is %.0f; %g is %f with a precision, and without one seven digits.
Walked format(Arguments& a) {
    Walked r;
    r.base = Base::String;
    size_t next = 1;
    const std::string& p = a[0].s;
    for (size_t i = 0; i < p.size(); i++) {
        if (p[i] != '%' || p[i + 1] == '%') {
            i += p[i] == '%';
            r.s += p[i];
            continue;
        }
        const size_t end = p.find_first_of("efgds", i);
        if (end == std::string::npos || next >= a.size() || width(a[next].base) > 1)
            throw std::runtime_error("the walker does not know this pattern: " + p);
        const Walked& v = a[next++];
        std::string conversion = p.substr(i, end - i);
        const bool precise = conversion.find('.') != std::string::npos;
        char text[1000];
        if (p[end] == 's') {
            std::snprintf(text, sizeof text, (conversion + "s").c_str(), v.s.c_str());
        } else {
            conversion += p[end] == 'd' ? ".0f" : p[end] == 'g' ? (precise ? "f" : ".7g") : std::string(1, p[end]);
            std::snprintf(text, sizeof text, conversion.c_str(), std::fabs(double(v.n[0])) >= 0 ? double(v.n[0]) : NAN);
            // 100000 is longer than 1e+05.
            if (p[end] == 'g' && !precise && v.n[0] != 0 && std::isfinite(v.n[0]) && !std::strchr(text, 'e')) {
                const int power = int(std::floor(std::log10(std::fabs(double(v.n[0]))) + 1e-6));
                const double digit = double(v.n[0]) / std::pow(10.0, power);
                char mantissa[40], both[80], plain[80];
                std::snprintf(mantissa, sizeof mantissa, conversion.find('+') != std::string::npos ? "%+.7g" : "%.7g", digit);
                std::snprintf(both, sizeof both, "%se%c%02d", mantissa, power < 0 ? '-' : '+', std::abs(power));
                std::snprintf(plain, sizeof plain, conversion.find('+') != std::string::npos ? "%+.7g" : "%.7g", double(v.n[0]));
                const std::string wide = conversion.substr(0, conversion.size() - 3) + "s";
                if (std::strlen(both) < std::strlen(plain)) std::snprintf(text, sizeof text, wide.c_str(), both);
            }
        }
        r.s += text;
        i = end;
    }
    return r;
}

/// By the shadeop's own code at one point.
Walked own(const std::string& symbol, Base result, const Arguments& a) {
    std::vector<float> in, out(size_t(componentCount(result)));
    for (const Walked& w : a) in.insert(in.end(), w.n.begin(), w.n.begin() + componentCount(w.base));
    if (!evaluateRuntime(symbol, in.data(), int(in.size()), out.data(), int(out.size())))
        throw std::runtime_error("the walker does not know " + symbol);
    Walked r;
    r.base = result;
    std::copy(out.begin(), out.end(), r.n.begin());
    return r;
}

Walked colourSpace(Arguments& a) {
    Walked c = a.back();
    const std::string from = a.size() == 3 ? a[0].s : "rgb", to = a[a.size() - 2].s;
    if (from == to) return c;
    if (from != "rgb") c = own("al_" + from + "_to_rgb", Base::Color, {c});
    return to == "rgb" ? c : own("al_rgb_to_" + to, Base::Color, {c});
}

/// f over the components of arguments of one type; numbers among them count for every component.
template <class F> Definition each(F f) {
    return [f](Arguments& a) {
        Walked r = a[0];
        for (size_t c = 0; c < 3; c++) {
            const auto at = [&](size_t i) { return a[i].n[a[i].base == Base::Float ? 0 : c]; };
            if constexpr (std::is_invocable_v<F, float>) r.n[c] = f(at(0));
            else if constexpr (std::is_invocable_v<F, float, float>) {
                r.n[c] = at(0);
                for (size_t i = 1; i < a.size(); i++) r.n[c] = f(r.n[c], at(i));
            } else r.n[c] = f(at(0), at(1), at(2));
        }
        return r;
    };
}

Definition componentOf(size_t c) {
    return [c](Arguments& a) { return real(a[0].n[c]); };
}
Definition setComponent(size_t c) {
    return [c](Arguments& a) {
        a[0].n[c] = a[1].n[0];
        return Walked{};
    };
}

Definition transformBy(Base rule) {
    return [rule](Arguments& a) {
        if (a.size() != 2 || a[0].base != Base::Matrix) throw std::runtime_error("the walker does not know named spaces");
        const Base by = rule != Base::Void ? rule : a[1].base;
        if (by == Base::Normal) return own("al_transformnormal", Base::Normal, a);
        Walked r = tuple(transformed(a[0], three(a[1]), by));
        r.base = a[1].base;
        return r;
    };
}

/// Of numbers, or of tuples component by component.
std::map<std::string, Definition> ofNumbers() {
    return {
        {"radians", each([](float x) { return x * (kPi / 180); })},
        {"degrees", each([](float x) { return x * (180 / kPi); })},
        {"sqrt", each(root)},
        {"inversesqrt", each([](float x) { return x > 0 ? 1 / std::sqrt(x) : 1e38f; })},
        {"sign", each([](float x) { return x < 0 ? -1.0f : 1.0f; })},
        {"abs", each([](float x) { return std::fabs(x); })},
        {"floor", each([](float x) { return std::floor(x); })},
        {"ceil", each([](float x) { return std::ceil(x); })},
        {"round", each(rounded)},
        {"mod", each(modulo)},
        {"min", each(lesser)},
        {"max", each(greater)},
        {"clamp", each([](float x, float lo, float hi) { return x < lo   ? lo
                                                                : x > hi ? hi
                                                                         : x; })},
        {"step", each([](float edge, float x) { return x < edge ? 0.0f : 1.0f; })},
        {"smoothstep", each(smooth)},
        {"mix", each(blend)},
    };
}

/// Of tuples, and of parts of them.
std::map<std::string, Definition> ofTuples() {
    return {
        {"xcomp", componentOf(0)},
        {"ycomp", componentOf(1)},
        {"zcomp", componentOf(2)},
        {"setxcomp", setComponent(0)},
        {"setycomp", setComponent(1)},
        {"setzcomp", setComponent(2)},
        {"comp",
         [](Arguments& a) {
             if (a[0].base == Base::Matrix)
                 return real(a[0].n[size_t(clampedIndex(a[1].n[0], 3) * 4 + clampedIndex(a[2].n[0], 3))]);
             return real(a[0].n[size_t(clampedIndex(a[1].n[0], 2))]);
         }},
        {"setcomp",
         [](Arguments& a) {
             if (a[0].base == Base::Matrix)
                 a[0].n[size_t(clampedIndex(a[1].n[0], 3) * 4 + clampedIndex(a[2].n[0], 3))] = a[3].n[0];
             else a[0].n[size_t(clampedIndex(a[1].n[0], 2))] = a[2].n[0];
             return Walked{};
         }},
        {"luminance", [](Arguments& a) { return real(a[0].n[0] * 0.2126f + (a[0].n[1] * 0.7152f + a[0].n[2] * 0.0722f)); }},
        {"length", [](Arguments& a) { return real(length(three(a[0]))); }},
        {"distance", [](Arguments& a) { return real(length(minus(three(a[1]), three(a[0])))); }},
        {"normalize",
         [](Arguments& a) {
             const V3 v = times(three(a[0]), midRange(three(a[0])));
             return tuple(times(v, over(1, root(dot(v, v)))));
         }},
        {"ptlined", [](Arguments& a) { return real(segmentDistance(three(a[0]), three(a[1]), three(a[2]))); }},
        {"reflect",
         [](Arguments& a) {
             const V3 i = three(a[0]), n = three(a[1]);
             const float k = dot(i, n) * -2;
             return tuple({std::fma(n[0], k, i[0]), std::fma(n[1], k, i[1]), std::fma(n[2], k, i[2])});
         }},
        {"refract", [](Arguments& a) { return tuple(refracted(three(a[0]), three(a[1]), a[2].n[0])); }},
    };
}

std::map<std::string, Definition> ofMatricesAndSpaces() {
    return {
        {"translate",
         [](Arguments& a) {
             Walked r = a[0];
             const auto at = [&](size_t row, size_t c) { return a[0].n[row * 4 + c]; };
             for (size_t c = 0; c < 4; c++)
                 r.n[12 + c] =
                     std::fma(a[1].n[0], at(0, c), std::fma(a[1].n[1], at(1, c), std::fma(a[1].n[2], at(2, c), at(3, c))));
             return r;
         }},
        {"scale",
         [](Arguments& a) {
             Walked r = a[0];
             for (size_t i = 0; i < 12; i++) r.n[i] = a[1].n[i / 4] * a[0].n[i];
             return r;
         }},
        {"transform", transformBy(Base::Void)},
        {"ptransform", transformBy(Base::Point)},
        {"vtransform", transformBy(Base::Vector)},
        {"ntransform", transformBy(Base::Normal)},
        {"ctransform", colourSpace},
    };
}

std::map<std::string, Definition> ofTextsAndSplines() {
    return {
        {"spline", spline},
        {"format", format},
        {"concat",
         [](Arguments& a) {
             Walked r = a[0];
             for (size_t i = 1; i < a.size(); i++) r.s += a[i].s;
             return r;
         }},
        {"match",
         [](Arguments& a) { return real(std::regex_search(a[1].s, std::regex(a[0].s, std::regex::extended)) ? 1.0f : 0.0f); }},
    };
}

const std::map<std::string, Definition>& definitions() {
    static const std::map<std::string, Definition> all = [] {
        std::map<std::string, Definition> sum = ofNumbers();
        for (auto more : {ofTuples(), ofMatricesAndSpaces(), ofTextsAndSplines()}) sum.merge(more);
        return sum;
    }();
    return all;
}

} // namespace

Walked walkedProduct(const Walked& a, const Walked& b) {
    Walked r;
    r.base = Base::Matrix;
    for (size_t i = 0; i < 16; i++) {
        float sum = a.n[i / 4 * 4] * b.n[i % 4];
        for (size_t k = 1; k < 4; k++) sum = sum + a.n[i / 4 * 4 + k] * b.n[k * 4 + i % 4];
        r.n[i] = sum;
    }
    return r;
}

Walked walkShadeop(const Shadeop& op, const Signature& s, std::vector<Walked>& arguments) {
    const auto it = definitions().find(op.name);
    Walked r;
    if (it != definitions().end()) r = it->second(arguments);
    else if (!s.symbol.empty() && !s.repeats) r = own(s.symbol, s.result.base, arguments);
    else throw std::runtime_error("the walker does not know " + op.name);
    if (s.result.base != Base::Void) r.base = s.result.base;
    return r;
}

} // namespace alpenglow::rsl
