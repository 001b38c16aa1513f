// Calls of shadeops with arguments that vary smoothly over the surface, made from their signatures: what slopes_test.cpp
// differentiates.
#pragma once
#include "shadeops/descriptor.h"
#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace alpenglow::rsl {

/// Statements that leave a value in f. U and V stand for the surface's parameters, or for numbers where an argument is held fast.
struct Slope {
    std::string what, statements;
    Type type; ///< of f
};

/// The arguments that a shadeop needs to be where it is smooth and defined; by name of the parameter. Others are the usual ones.
using Arguments = std::map<std::string, std::string>;

/// A float near 0.5, a tuple that is no other's, or a matrix that is not singular; each of its own, by number.
inline std::string usualArgument(Base base, int number) {
    const auto n = [](double x) {
        char s[32];
        std::snprintf(s, sizeof s, "%.6g", x);
        return std::string(s);
    };
    const double k = number % 5;
    const std::string a = n(0.42 + 0.09 * k) + " + " + n(0.3 - 0.04 * k) + " * U - " + n(0.2 + 0.03 * k) + " * V + 0.15 * U * V";
    const std::string b = n(0.2 + 0.3 * k) + " + 0.4 * U * V - 0.1 * V",
                      c = n(0.9 - 0.17 * k) + " - 0.25 * V + " + n(0.1 + 0.05 * k) + " * U * U";
    switch (base) {
    case Base::Float:
        return "(" + a + ")";
    case Base::Color:
        return "color(" + a + ", " + b + ", " + c + ")";
    case Base::Point:
        return number % 2 ? "point(" + b + ", " + a + ", " + c + ")" : "point(" + c + ", " + b + ", " + a + ")";
    case Base::Vector:
        return number % 2 ? "vector(" + c + ", " + a + ", " + b + ")" : "vector(" + a + ", " + b + ", " + c + ")";
    case Base::Normal:
        return number % 2 ? "normal(" + b + ", " + c + ", " + a + ")" : "normal(" + b + ", " + a + ", " + c + ")";
    case Base::Matrix:
        return "matrix(1 + 0.2 * U, " + a + ", 0.1, 0, 0.2, 1.5 - 0.1 * V, 0.3 * U * V, 0, " + n(0.1 * k) + ", 0.3, 2 + " +
               n(0.2 * k) + " * V, 0, U, 0.5 * V, 1, 1)";
    default:
        return "\"\"";
    }
}

/// Every U and V as a number.
inline std::string fixedAt(const std::string& text, double u, double v) {
    std::string s;
    for (size_t i = 0; i < text.size(); ++i) {
        const auto letter = [&](size_t k) {
            return k < text.size() && (std::isalnum(static_cast<unsigned char>(text[k])) || text[k] == '_' || text[k] == '"');
        };
        const bool alone = !letter(i + 1) && !(i > 0 && letter(i - 1));
        if (alone && (text[i] == 'U' || text[i] == 'V')) s += text[i] == 'U' ? std::to_string(u) : std::to_string(v);
        else s += text[i];
    }
    return s;
}

/// The calls of one signature: with all arguments varying, and with each alone; for its result and for all that it puts out.
inline std::vector<Slope> slopesOf(const Shadeop& op, const Signature& s, const Arguments& given, const std::string& pairs,
                                   double u, double v) {
    std::vector<Parameter> parameters = s.parameters;
    if (s.repeats) // a spline needs four points, others show with three that all count
        while (parameters.size() < (op.name == "spline" ? (s.parameters[0].type.base == Base::String ? 6u : 5u) : 3u))
            parameters.push_back(s.parameters.back());
    std::vector<std::string> texts;
    int number = 0;
    for (const Parameter& p : parameters) {
        const auto g = given.find(p.name);
        const std::string own = usualArgument(p.type.base, number++);
        texts.push_back(g != given.end() ? g->second : p.type.array ? "" : own);
    }
    std::vector<Slope> all;
    const int n = int(parameters.size());
    for (int only = -1; only < n; ++only) {
        if (only >= 0 &&
            (n == 1 || (parameters[size_t(only)].type.base != Base::Void && !parameters[size_t(only)].type.isNumeric())))
            continue;
        if (only >= 0 && texts[size_t(only)] == fixedAt(texts[size_t(only)], u, v) && !parameters[size_t(only)].type.array)
            continue; // held fast always
        std::string before, call = op.name + "(";
        std::vector<std::pair<std::string, Type>> results;
        for (int i = 0; i < n; ++i) {
            const Parameter& p = parameters[size_t(i)];
            const bool free = only < 0 || only == i;
            std::string text = free ? texts[size_t(i)] : fixedAt(texts[size_t(i)], u, v);
            const std::string name = "x" + std::to_string(i);
            if (p.type.array) {
                std::string list;
                for (int k = 0; k < 4; ++k) {
                    const std::string e = usualArgument(p.type.base, k);
                    list += (k ? ", " : "") + (free ? e : fixedAt(e, u, v));
                }
                before += toString(p.type.element()) + " " + name + "[4] = {" + list + "}; ";
                text = name;
                if (p.output) results.emplace_back(name + "[1]", p.type.element());
            } else if (p.output) {
                before += toString(p.type) + " " + name + " = " + text + "; ";
                text = name;
                results.emplace_back(name, p.type);
            }
            call += (i ? ", " : "") + text;
        }
        call += pairs + ")";
        const std::string what =
            s.text + (pairs.empty() ? "" : " with" + pairs) + (only < 0 ? ", all" : ", argument " + std::to_string(only + 1));
        const std::string shown = given.count("basis") ? " " + given.at("basis") : "";
        const auto add = [&](const std::string& statements, const std::string& value, Type type) {
            if (type.base == Base::Matrix) { // by three of its elements
                all.push_back(
                    {what + shown,
                     before + statements + "matrix r = " + value + "; f = vector(comp(r, 0, 1), comp(r, 2, 0), comp(r, 3, 1));",
                     {Base::Vector, 0}});
                return;
            }
            if (type.isNumeric()) all.push_back({what + shown, before + statements + "f = " + value + ";", type});
        };
        if (s.result.base != Base::Void && s.result.array == 0) add("", call, s.result);
        for (const auto& [name, type] : results)
            add(s.result.base == Base::Void ? call + "; " : "float got = " + call + "; ", name, type);
    }
    return all;
}

} // namespace alpenglow::rsl
