// Nodes of MaterialX that look at the surface or at pictures, and patterns. MaterialX specification 1.38, "Geometric nodes",
// "Texture nodes", "Procedural nodes".
#include "base/file.h"
#include "models/mtlxgraph.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace alpenglow::models {

namespace fs = std::filesystem;

namespace {

Wrap addressMode(const std::string& m) {
    return m == "clamp" || m == "constant" ? Wrap::Clamp : m == "mirror" ? Wrap::Mirror : Wrap::Repeat;
}

MtlxValue parts(MtlxGraph&, const std::string& variable, const char* function) {
    if (std::string(function) == "comp")
        return {"comp(" + variable + ", 0)", "comp(" + variable + ", 1)", "comp(" + variable + ", 2)"};
    return {"xcomp(" + variable + ")", "ycomp(" + variable + ")", "zcomp(" + variable + ")"};
}

} // namespace

std::optional<MtlxValue> MtlxNodes::geometry() {
    const std::string space = text("space", "object");
    if (n.name == "texcoord") {
        if (text("index", "0") != "0") g.warn(n, "only the first set of texture coordinates is there");
        const MtlxValue uv = g.coordinates();
        return width() == 3 ? MtlxValue{uv[0], uv[1], "0"} : uv;
    }
    if (n.name == "position")
        return emit(
            parts(g, g.variable("point", fmt::format("transform(\"{}\", P)", space == "world" ? "world" : "object")), "xcomp"));
    if (n.name == "normal")
        return emit(
            parts(g, g.variable("normal", fmt::format("normalize(ntransform(\"{}\", N))", space == "world" ? "world" : "object")),
                  "xcomp"));
    if (n.name == "tangent" || n.name == "bitangent")
        return emit(parts(g, g.variable("vector", n.name == "tangent" ? "normalize(dPdu)" : "normalize(dPdv)"), "xcomp"));
    if (n.name == "viewdirection") return emit(parts(g, g.variable("vector", "normalize(I)"), "xcomp"));
    if (n.name == "geomcolor") return emit(mtlxFit({"comp(Cs, 0)", "comp(Cs, 1)", "comp(Cs, 2)"}, width()));
    if (n.name == "time") return emit({"time"});
    if (n.name == "frame") return emit({"24 * time"});
    if (n.name == "geompropvalue") {
        const std::string prop = text("geomprop", "");
        if (prop == "UV0" || prop == "st" || prop == "uv") return g.coordinates();
        if (prop == "Cs" || prop == "displayColor") return emit(mtlxFit({"comp(Cs, 0)", "comp(Cs, 1)", "comp(Cs, 2)"}, width()));
        g.warn(n, fmt::format("the variable \"{}\" of meshes is not read; its default is taken", prop));
        return in("default", width());
    }
    return {};
}

/// A map, looked up at texture coordinates whose second grows upward.
MtlxValue MtlxNodes::picture() {
    MtlxValue uv = in("texcoord", 2, g.coordinates());
    if (n.name == "tiledimage") uv = each("%a * %b - %c", {uv, in("uvtiling", 2, 1), in("uvoffset", 2)});
    std::string prefix;
    for (const XmlElement* e : {graph, &g.root_})
        if (e && prefix.empty()) prefix = e->attribute("fileprefix");
    const std::string file = prefix + text("file", "");
    const fs::path folder = fs::path(g.file_).parent_path();
    std::string found;
    std::error_code e;
    for (const fs::path& p : {folder / file, folder / fs::path(file).filename()})
        if (found.empty() && fs::is_regular_file(p, e) && liesBelow(p.string(), {folder.empty() ? "." : folder.string()}))
            found = p.string();
    if (found.empty()) {
        g.warn(n, fmt::format("picture \"{}\" is not there, or not below the file's folder; its default is taken",
                              file.substr(0, 200)));
        return in("default", width());
    }
    const bool colour =
        width() >= 3 && n.attribute("type").rfind("color", 0) == 0 && g.spaceOfColours(n, {graph}).rfind("srgb", 0) == 0;
    const std::string name =
        g.maps_({found, colour, addressMode(text("uaddressmode", "periodic")), addressMode(text("vaddressmode", "periodic"))});
    if (name.empty()) return in("default", width());
    std::string quoted = "\"";
    for (const char c : name) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    quoted += "\"";
    const MtlxValue at = emit({uv[0], "1 - " + uv[1]});
    const std::string where = at[0] + ", " + at[1] + ")";
    MtlxValue out;
    if (width() >= 3) {
        out = parts(g, g.variable("color", "color texture(" + quoted + ", " + where), "comp");
        if (width() == 4) out.push_back("float texture(" + quoted + "[3], " + where);
    } else {
        for (size_t k = 0; k < width(); ++k) out.push_back(fmt::format("float texture({}[{}], {}", quoted, k, where));
    }
    return emit(out);
}

/// Slopes of a picture about N, as layerNormalMap() of shaders/include/layermaps.h takes them.
MtlxValue MtlxNodes::normalMap() {
    const MtlxValue x = in("in", 3, MtlxValue{"0.5", "0.5", "1"}), scale = in("scale", 1, 1);
    const std::string nn = g.variable("normal", "normalize(N)"), along = g.variable("vector", "layerDpds()"),
                      u = g.variable("vector", fmt::format("normalize({0} - ({0} . {1}) * vector({1}))", along, nn)),
                      v0 = g.variable("vector", fmt::format("vector({}) ^ {}", nn, u)),
                      det = g.variable("float", "Du(s) * Dv(t) - Dv(s) * Du(t)"),
                      up = g.variable("vector", fmt::format("normalize(sign({}) * (dPdv * Du(s) - dPdu * Dv(s)))", det)),
                      v = g.variable("vector", fmt::format("({0} . {1} > 0) ? -{0} : {0}", v0, up)),
                      r = g.variable("vector",
                                     fmt::format("normalize((2 * {} - 1) * {} * {} + (2 * {} - 1) * {} * {} + max(2 * {} - 1, "
                                                 ".01) * vector({}))",
                                                 x[0], scale[0], u, x[1], scale[0], v, x[2], nn));
    return emit(parts(g, r, "xcomp"));
}

std::optional<MtlxValue> MtlxNodes::patterns() {
    const size_t w = width();
    if (n.name == "image" || n.name == "tiledimage") return picture();
    if (n.name == "normalmap") return normalMap();
    if (n.name == "ramplr" || n.name == "ramptb" || n.name == "splitlr" || n.name == "splittb" || n.name == "ramp4") {
        const MtlxValue uv = in("texcoord", 2, g.coordinates());
        const auto mixed = each("clamp(%a, 0, 1)", {uv});
        const std::string blend = "%a * (1 - %c) + %b * %c";
        if (n.name == "ramp4") {
            const MtlxValue top = each(blend, {in("valuetl", w), in("valuetr", w), {mixed[0]}}),
                            bottom = each(blend, {in("valuebl", w), in("valuebr", w), {mixed[0]}});
            return each(blend, {bottom, top, {mixed[1]}});
        }
        const bool right = n.name == "ramplr" || n.name == "splitlr";
        const MtlxValue a = in(right ? "valuel" : "valueb", w), b = in(right ? "valuer" : "valuet", w);
        if (n.name[0] == 'r') return each(blend, {a, b, {mixed[right ? 0 : 1]}});
        return each("(%c < %d) ? %a : %b", {a, b, {uv[right ? 0 : 1]}, in("center", 1, .5)});
    }
    return {};
}

/// RSL's noises in place of MaterialX's: of the same kind and range, another pattern.
std::optional<MtlxValue> MtlxNodes::noises() {
    const bool cell = n.name == "cellnoise2d" || n.name == "cellnoise3d",
               flat = !n.name.empty() && n.name.find("2d") != n.name.npos;
    const bool once = n.name == "noise2d" || n.name == "noise3d", fractal = n.name == "fractal3d" || n.name == "fractal2d";
    if (!cell && !once && !fractal) return {};
    std::string at;
    if (flat) {
        const MtlxValue uv = in("texcoord", 2, g.coordinates());
        at = g.variable("point", fmt::format("point ({}, {}, 0)", uv[0], uv[1]));
    } else {
        const MtlxValue p = in("position", 3, parts(g, "transform(\"object\", P)", "xcomp"));
        at = g.variable("point", fmt::format("point ({}, {}, {})", p[0], p[1], p[2]));
    }
    const size_t w = width();
    if (cell) return emit(MtlxValue(w, "float cellnoise(" + at + ")"));
    const int octaves = fractal ? std::clamp(std::atoi(text("octaves", "3").c_str()), 1, 16) : 1;
    const MtlxValue lacunarity = in("lacunarity", 1, 2), diminish = in("diminish", 1, .5);
    MtlxValue sum(w, "0");
    std::string frequency = "1", strength = "1";
    for (int k = 0; k < octaves; ++k) {
        MtlxValue more;
        for (size_t c = 0; c < w; ++c)
            more.push_back(fmt::format("{} + {} * (2 * float noise({} * {} + vector ({}, 0, 0)) - 1)", sum[c], strength,
                                       frequency, at, 19.1 * double(c)));
        sum = emit(more);
        if (k + 1 == octaves) break;
        frequency = g.variable("float", frequency + " * " + lacunarity[0]);
        strength = g.variable("float", strength + " * " + diminish[0]);
    }
    if (fractal) return each("%a * %b", {sum, in("amplitude", w, 1)});
    return each("%a * %b + %c", {sum, in("amplitude", w, 1), in("pivot", 1)});
}

} // namespace alpenglow::models
