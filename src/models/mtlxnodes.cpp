// Nodes of MaterialX that reckon with numbers. MaterialX specification 1.38, "Math nodes", "Adjustment nodes", "Channel nodes",
// "Conditional nodes".
#include "models/mtlxgraph.h"
#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace alpenglow::models {

MtlxValue MtlxNodes::in(const char* name, size_t w, double byDefault) { return g.in(n, {graph}, name, w, byDefault); }
MtlxValue MtlxNodes::in(const char* name, size_t w, const MtlxValue& byDefault) { return g.in(n, {graph}, name, w, byDefault); }
std::string MtlxNodes::text(const char* name, const std::string& byDefault) { return g.text(n, {graph}, name, byDefault); }
MtlxValue MtlxNodes::emit(const MtlxValue& v) { return g.emit(v); }
size_t MtlxNodes::width() const { return std::max<size_t>(1, mtlxWidth(n.attribute("type"))); }

MtlxValue MtlxNodes::each(const std::string& expression, const std::vector<MtlxValue>& values) {
    size_t count = 0;
    for (const MtlxValue& v : values) count = std::max(count, v.size());
    MtlxValue out;
    for (size_t k = 0; k < count; ++k) {
        std::string e;
        for (size_t i = 0; i < expression.size(); ++i) {
            const size_t which = size_t(expression[i + 1 < expression.size() ? i + 1 : i] - 'a');
            if (expression[i] != '%' || which >= values.size()) {
                e += expression[i];
                continue;
            }
            const MtlxValue& v = values[which];
            e += v[std::min(k, v.size() - 1)];
            ++i;
        }
        out.push_back(e);
    }
    return emit(out);
}

/// One or two inputs, number by number.
std::optional<MtlxValue> MtlxNodes::plain() {
    static const std::map<std::string, const char*> ones = {{"absval", "abs(%a)"},
                                                            {"floor", "floor(%a)"},
                                                            {"ceil", "ceil(%a)"},
                                                            {"round", "round(%a)"},
                                                            {"sin", "sin(%a)"},
                                                            {"cos", "cos(%a)"},
                                                            {"tan", "tan(%a)"},
                                                            {"asin", "asin(clamp(%a, -1, 1))"},
                                                            {"acos", "acos(clamp(%a, -1, 1))"},
                                                            {"sqrt", "sqrt(max(%a, 0))"},
                                                            {"ln", "log(max(%a, 1e-30))"},
                                                            {"exp", "exp(%a)"},
                                                            {"sign", "sign(%a)"},
                                                            {"dot", "%a"},
                                                            {"convert", "%a"}};
    struct Two {
        const char *text, *first, *second;
        double a, b;
    };
    static const std::map<std::string, Two> twos = {{"add", {"%a + %b", "in1", "in2", 0, 0}},
                                                    {"plus", {"%a + %b", "bg", "fg", 0, 0}},
                                                    {"subtract", {"%a - %b", "in1", "in2", 0, 0}},
                                                    {"multiply", {"%a * %b", "in1", "in2", 0, 1}},
                                                    {"divide", {"%a / ((%b == 0) ? 1e-30 : %b)", "in1", "in2", 0, 1}},
                                                    {"modulo", {"mod(%a, (%b == 0) ? 1 : %b)", "in1", "in2", 0, 1}},
                                                    {"power", {"pow(max(%a, 0), %b)", "in1", "in2", 0, 1}},
                                                    {"min", {"min(%a, %b)", "in1", "in2", 0, 0}},
                                                    {"max", {"max(%a, %b)", "in1", "in2", 0, 0}},
                                                    {"screen", {"1 - (1 - %a) * (1 - %b)", "bg", "fg", 0, 0}},
                                                    {"difference", {"abs(%a - %b)", "bg", "fg", 0, 0}},
                                                    {"minus", {"%a - %b", "bg", "fg", 0, 0}},
                                                    {"inside", {"%a * %b", "in", "mask", 0, 1}},
                                                    {"outside", {"%a * (1 - %b)", "in", "mask", 0, 0}},
                                                    {"invert", {"%b - %a", "in", "amount", 0, 1}}};
    if (n.name == "convert") return emit(mtlxFit(in("in", n.attribute("type") == "float" ? 1 : width()), width()));
    if (n.name == "constant") return in("value", width());
    if (n.name == "atan2") return each("atan(%a, %b)", {in("iny", width()), in("inx", width(), 1)});
    if (const auto one = ones.find(n.name); one != ones.end()) return each(one->second, {in("in", width())});
    const auto two = twos.find(n.name);
    if (two == twos.end()) return {};
    const Two& t = two->second;
    return each(t.text, {in(t.first, width(), t.a), in(t.second, width(), t.b)});
}

std::optional<MtlxValue> MtlxNodes::ranges() {
    const size_t w = width();
    if (n.name == "mix") return each("%a * (1 - %c) + %b * %c", {in("bg", w), in("fg", w), in("mix", w)});
    if (n.name == "clamp") return each("clamp(%a, %b, %c)", {in("in", w), in("low", w), in("high", w, 1)});
    if (n.name == "smoothstep") return each("smoothstep(%b, %c, %a)", {in("in", w), in("low", w), in("high", w, 1)});
    if (n.name == "contrast") return each("(%a - %c) * %b + %c", {in("in", w), in("amount", w, 1), in("pivot", w, .5)});
    if (n.name != "remap" && n.name != "range") return {};
    const MtlxValue low = in("inlow", w), span = each("(%b == %a) ? 1 : %b - %a", {low, in("inhigh", w, 1)});
    MtlxValue x = each("(%a - %b) / %c", {in("in", w), low, span});
    if (n.name == "range") {
        x = each("pow(max(%a, 0), 1 / max(%b, 1e-6))", {x, in("gamma", w, 1)});
        if (text("doclamp", "false") == "true") x = each("clamp(%a, 0, 1)", {x});
    }
    return each("%b + %a * (%c - %b)", {x, in("outlow", w), in("outhigh", w, 1)});
}

std::optional<MtlxValue> MtlxNodes::vectors() {
    const auto sum = [&](const MtlxValue& a, const MtlxValue& b) {
        std::string e;
        for (size_t k = 0; k < a.size(); ++k) e += (k ? " + " : "") + a[k] + " * " + b[k];
        return e;
    };
    const auto most = [&](const char* name) { // of an input whose type the node's own does not tell
        for (const XmlElement& c : n.children)
            if (c.attribute("name") == name) return std::max<size_t>(1, mtlxWidth(c.attribute("type")));
        return size_t(3);
    };
    if (n.name == "dotproduct") return emit({sum(in("in1", most("in1")), in("in2", most("in1")))});
    if (n.name == "magnitude" || n.name == "normalize") {
        const MtlxValue v = in("in", n.name == "magnitude" ? most("in") : width());
        const MtlxValue length = emit({"sqrt(" + sum(v, v) + ")"});
        if (n.name == "magnitude") return length;
        return each("%a / max(%b, 1e-30)", {v, length});
    }
    if (n.name == "crossproduct") {
        const MtlxValue a = in("in1", 3), b = in("in2", 3);
        return emit({a[1] + " * " + b[2] + " - " + a[2] + " * " + b[1], a[2] + " * " + b[0] + " - " + a[0] + " * " + b[2],
                     a[0] + " * " + b[1] + " - " + a[1] + " * " + b[0]});
    }
    if (n.name == "rotate2d") {
        const MtlxValue v = in("in", 2), turn = emit({"radians(" + in("amount", 1)[0] + ")"}), c = emit({"cos(" + turn[0] + ")"}),
                        s = emit({"sin(" + turn[0] + ")"});
        return emit({c[0] + " * " + v[0] + " + " + s[0] + " * " + v[1], c[0] + " * " + v[1] + " - " + s[0] + " * " + v[0]});
    }
    if (n.name == "place2d") {
        const MtlxValue uv = in("texcoord", 2, g.coordinates()), pivot = in("pivot", 2), scale = in("scale", 2, 1),
                        offset = in("offset", 2), turn = emit({"radians(" + in("rotate", 1)[0] + ")"}),
                        c = emit({"cos(" + turn[0] + ")"}), s = emit({"sin(" + turn[0] + ")"});
        const MtlxValue x = each("(%a - %b) / ((%c == 0) ? 1 : %c)", {uv, pivot, scale});
        const MtlxValue r =
            emit({c[0] + " * " + x[0] + " + " + s[0] + " * " + x[1], c[0] + " * " + x[1] + " - " + s[0] + " * " + x[0]});
        return each("%a - %b + %c", {r, offset, pivot});
    }
    return {};
}

std::optional<MtlxValue> MtlxNodes::colours() {
    const auto grey = [&](const MtlxValue& v) {
        return emit({"0.2126 * " + v[0] + " + 0.7152 * " + v[1] + " + 0.0722 * " + v[2]});
    };
    if (n.name == "luminance") return mtlxFit(grey(in("in", 3)), width());
    if (n.name == "saturate") {
        const MtlxValue v = in("in", 3);
        return mtlxFit(each("%b + %c * (%a - %b)", {v, grey(v), in("amount", 1, 1)}), width());
    }
    if (n.name == "hsvtorgb" || n.name == "rgbtohsv") {
        const MtlxValue v = in("in", 3);
        const bool to = n.name == "hsvtorgb";
        const std::string c = g.variable("color", fmt::format("ctransform(\"{}\", \"{}\", color ({}, {}, {}))",
                                                              to ? "hsv" : "rgb", to ? "rgb" : "hsv", v[0], v[1], v[2]));
        return mtlxFit(emit({"comp(" + c + ", 0)", "comp(" + c + ", 1)", "comp(" + c + ", 2)"}), width());
    }
    return {};
}

std::optional<MtlxValue> MtlxNodes::channels() {
    const auto place = [](char c) -> size_t {
        return c == 'r' || c == 'x' ? 0 : c == 'g' || c == 'y' ? 1 : c == 'b' || c == 'z' ? 2 : 3;
    };
    if (n.name == "combine2" || n.name == "combine3" || n.name == "combine4" || n.name == "combine") {
        MtlxValue all;
        for (const char* name : {"in1", "in2", "in3", "in4"}) {
            if (all.size() >= width()) break;
            const bool more = n.name == "combine2" && width() == 4; // color3 and a float
            const MtlxValue v = in(name, more && all.empty() ? 3 : 1);
            all.insert(all.end(), v.begin(), v.end());
        }
        return mtlxFit(all, width());
    }
    if (n.name == "separate2" || n.name == "separate3" || n.name == "separate4") {
        const MtlxValue v = in("in", size_t(n.name.back() - '0'));
        const size_t k = output.size() > 3 ? place(output.back()) : 0; // "outr", "outx"
        return MtlxValue{k < v.size() ? v[k] : "0"};
    }
    if (n.name == "extract") {
        const MtlxValue v = in("in", 4);
        const size_t k = size_t(std::clamp(std::atoi(text("index", "0").c_str()), 0, 3));
        return MtlxValue{v[k]};
    }
    if (n.name == "swizzle") {
        const MtlxValue v = in("in", 4);
        MtlxValue out;
        for (const char c : text("channels", "rgb")) out.push_back(c == '0' ? "0" : c == '1' ? "1" : v[place(c)]);
        return mtlxFit(out, width());
    }
    return {};
}

std::optional<MtlxValue> MtlxNodes::choices() {
    const char* relation = n.name == "ifgreater" ? ">" : n.name == "ifgreatereq" ? ">=" : n.name == "ifequal" ? "==" : nullptr;
    if (relation)
        return each(fmt::format("(%a {} %b) ? %c : %d", relation),
                    {in("value1", 1, n.name == "ifequal" ? 0 : 1), in("value2", 1), in("in1", width()), in("in2", width())});
    if (n.name != "switch") return {};
    MtlxValue v = in("in1", width());
    const MtlxValue which = in("which", 1);
    for (const char* k : {"2", "3", "4", "5"}) {
        const std::string name = std::string("in") + k;
        v = each(fmt::format("(%c >= {}) ? %b : %a", k[0] - '1'), {v, in(name.c_str(), width()), which});
    }
    return v;
}

std::optional<MtlxValue> MtlxNodes::value() {
    for (const auto kind : {&MtlxNodes::plain, &MtlxNodes::ranges, &MtlxNodes::vectors, &MtlxNodes::colours, &MtlxNodes::channels,
                            &MtlxNodes::choices, &MtlxNodes::geometry, &MtlxNodes::patterns, &MtlxNodes::noises})
        if (auto v = (this->*kind)()) return mtlxFit(*v, std::max(width(), n.attribute("type") == "multioutput" ? v->size() : 1));
    return {};
}

} // namespace alpenglow::models
