// Attributes that are not shaders or transformations (RISpec 3.2, 4.2).
#include "ri/interpreter.h"
#include "ri/requests/request.h"
#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace alpenglow::ri {
namespace {

constexpr unsigned kAttributes = kAnywhere;

/// Three numbers, or as many as ColorSamples sets. One number instead of three is a grey, with a warning.
bool colorOf(Interpreter& in, const Call& c, Color& out) {
    size_t n = in.nRGB.empty() ? 3 : in.nRGB.size() / 3;
    std::vector<double> v(c.numbers(0).begin(), c.numbers(0).end());
    if (v.size() == 1 && n == 3) {
        in.reporter.warning(Rie::MissingData, c.place, fmt::format("{} with one number is taken as a grey", c.request->name));
        v.resize(3, v[0]);
    }
    if (v.size() < n) {
        in.reporter.error(Rie::MissingData, c.place, fmt::format("{} needs {} numbers, not {}", c.request->name, n, v.size()));
        return false;
    }
    if (v.size() > n)
        in.reporter.warning(Rie::Consistency, c.place,
                            fmt::format("{}: numbers after the first {} are ignored", c.request->name, n));
    std::vector<float> rgb = in.toRgb(std::vector<double>(v.begin(), v.begin() + std::ptrdiff_t(n)));
    out = {rgb[0], rgb[1], rgb[2]};
    return true;
}

void orientation(Interpreter& in, const Call& c) {
    const std::string& o = c.text(0);
    scene::Attributes& a = in.attributes();
    if (o == "outside" || o == "inside") {
        a.absoluteHandedness = false;
        a.inside = o == "inside";
    } else if (o == "lh" || o == "rh") {
        a.absoluteHandedness = true;
        a.rightHanded = o == "rh";
    } else {
        in.reporter.error(Rie::BadToken, c.place, fmt::format("Orientation: \"{}\" is not known", o),
                          "outside, inside, lh or rh");
    }
}

void reverse(Interpreter& in, const Call&) {
    scene::Attributes& a = in.attributes();
    if (a.absoluteHandedness) a.rightHanded = !a.rightHanded;
    else a.inside = !a.inside;
}

struct NamedBasis {
    const char* name;
    int step;
    double m[4][4];
};
constexpr double S = 1.0 / 6;
// RISpec 3.2, 5.2
constexpr NamedBasis kBases[] = {
    {"bezier", 3, {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}}},
    {"b-spline", 1, {{-S, 3 * S, -3 * S, S}, {3 * S, -6 * S, 3 * S, 0}, {-3 * S, 0, 3 * S, 0}, {S, 4 * S, S, 0}}},
    {"catmull-rom", 1, {{-.5, 1.5, -1.5, .5}, {1, -2.5, 2, -.5}, {-.5, 0, .5, 0}, {0, 1, 0, 0}}},
    {"hermite", 2, {{2, 1, -2, 1}, {-3, -2, 3, -1}, {0, 1, 0, 0}, {1, 0, 0, 0}}},
    {"power", 4, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}},
};

/// Some programs write the names without the hyphen.
bool isBasis(const std::string& spelled, std::string_view name) {
    const size_t hyphen = name.find('-');
    return spelled == name || (hyphen != std::string_view::npos &&
                               spelled == std::string(name.substr(0, hyphen)) + std::string(name.substr(hyphen + 1)));
}

bool oneBasis(Interpreter& in, const Call& c, size_t i, scene::Basis& out) {
    int step = c.integer(i + 1);
    if (!within(in, c, step >= 1 && step <= 4, "a step must be 1 to 4")) return false;
    out.step = step;
    if (c.arguments[i].strings.empty()) {
        out.name.clear();
        for (size_t k = 0; k < 16; ++k) out.m[k / 4][k % 4] = c.number(i, k);
        return true;
    }
    for (const NamedBasis& b : kBases) {
        if (!isBasis(c.text(i), b.name)) continue;
        out.name = b.name;
        std::copy(&b.m[0][0], &b.m[0][0] + 16, &out.m[0][0]);
        return true;
    }
    in.reporter.error(Rie::BadToken, c.place, fmt::format("Basis: \"{}\" is not known", c.text(i)),
                      "bezier, b-spline, catmull-rom, hermite, power or 16 numbers");
    return false;
}

void basis(Interpreter& in, const Call& c) {
    scene::Basis u, v;
    if (!oneBasis(in, c, 0, u) || !oneBasis(in, c, 2, v)) return;
    in.attributes().ubasis = u;
    in.attributes().vbasis = v;
}

bool boundOf(Interpreter& in, const Call& c, std::vector<float>& out) {
    out = c.reals(0);
    if (out[0] <= out[1] && out[2] <= out[3] && out[4] <= out[5]) return true;
    // A hint only, and often wrong in old files: no reason for the render to count as failed.
    in.reporter.warning(Rie::Range, c.place,
                        fmt::format("{}: a bound is xmin xmax ymin ymax zmin zmax: ignored", c.request->name));
    return false;
}

void trimCurve(Interpreter& in, const Call& c) {
    static constexpr const char* kNames[] = {"ncurves", "order", "knot", "min", "max", "n", "u", "v", "w"};
    std::vector<int> ncurves = c.ints(0);
    if (ncurves.empty()) { // no loops: no trim
        in.attributes().trimCurve = nullptr;
        return;
    }
    double curves = 0, points = 0, knots = 0;
    bool good = true;
    for (int n : ncurves) {
        good = good && n >= 1;
        curves += n;
    }
    auto order = c.ints(1), n = c.ints(5);
    good = good && order.size() == curves && n.size() == curves && c.numbers(3).size() == curves && c.numbers(4).size() == curves;
    for (size_t i = 0; good && i < n.size(); ++i) {
        good = order[i] >= 2 && n[i] >= order[i];
        points += n[i];
        knots += double(n[i]) + order[i];
    }
    good = good && c.numbers(2).size() == knots && c.numbers(6).size() == points && c.numbers(7).size() == points &&
           c.numbers(8).size() == points;
    if (!good) {
        std::string sums; // known where the arrays before them fit
        if (points > 0)
            sums = fmt::format(": {} knots, and n + order of its curves is {}; {} u, {} v and {} w, and n of its curves is {}",
                               c.numbers(2).size(), knots, c.numbers(6).size(), c.numbers(7).size(), c.numbers(8).size(), points);
        in.reporter.error(Rie::Consistency, c.place, "TrimCurve: the lengths of its arrays do not fit each other" + sums);
        return;
    }
    auto list = std::make_shared<scene::ParamList>();
    for (size_t i = 0; i < 9; ++i) {
        scene::Param p;
        p.name = kNames[i];
        p.cls = scene::Class::Constant;
        p.type = i == 0 || i == 1 || i == 5 ? scene::Type::Integer : scene::Type::Float;
        p.numbers = c.reals(i);
        p.arrayLength = int(p.numbers.size());
        p.place = c.place;
        list->push_back(std::move(p));
    }
    in.attributes().trimCurve = std::move(list);
}

/// "+a" adds, "-a" removes, anything else replaces; comma separated (docs/options.md).
std::string membership(const std::string& before, const std::string& change) {
    if (change.empty() || (change[0] != '+' && change[0] != '-')) return change;
    auto split = [](const std::string& s) {
        std::vector<std::string> v;
        std::string item;
        for (char ch : s + ",") {
            if (ch != ',' && ch != ' ') item += ch;
            else if (!item.empty()) {
                v.push_back(item);
                item.clear();
            }
        }
        return v;
    };
    std::vector<std::string> groups = split(before);
    for (const std::string& g : split(change.substr(1))) {
        std::erase(groups, g);
        if (change[0] == '+') groups.push_back(g);
    }
    std::string out;
    for (const std::string& g : groups) out += (out.empty() ? "" : ",") + g;
    return out;
}

void attribute(Interpreter& in, const Call& c) {
    const std::string& category = c.text(0);
    if (category == "lightfilter") in.linksFilters();
    for (scene::Param& p : in.bind(c, Use::Attribute, category)) {
        std::string key = category + ":" + p.name;
        auto& values = in.attributes().values;
        if (key == "grouping:membership" && !p.strings.empty()) {
            auto i = values.find(key);
            p.strings[0] = membership(i == values.end() || i->second.strings.empty() ? "" : i->second.strings[0], p.strings[0]);
        }
        values[key] = std::move(p);
    }
}

void approximation(Interpreter& in, const Call& c) {
    static const std::vector<std::string> kTypes = {"motionfactor",    "focusfactor",    "flatness",
                                                    "normaldeviation", "pointdeviation", "tessellation"};
    if (std::find(kTypes.begin(), kTypes.end(), c.text(0)) == kTypes.end()) {
        std::string near = nearestName(c.text(0), kTypes);
        in.reporter.report(Severity::Warning, Rie::BadToken, c.place,
                           fmt::format("GeometricApproximation: \"{}\" is not known: it does nothing", c.text(0)),
                           near.empty() ? "" : "did you mean " + near + "?");
        return;
    }
    scene::Param p;
    p.name = c.text(0);
    p.numbers = {c.real(1)};
    p.place = c.place;
    in.attributes().values["GeometricApproximation:" + p.name] = std::move(p);
}

std::vector<Request> appearanceRequests() {
    const Kind k = Kind::Attribute;
    const unsigned s = kAttributes;
    return {
        {"Color", "number[] color", k, s, true, "Surface colour, three numbers or as many as ColorSamples says.", "[1 .5 0]",
         [](Interpreter& in, const Call& c) {
             if (Color v; colorOf(in, c, v)) in.attributes().color = v;
         }},
        {"Opacity", "number[] color", k, s, true, "Surface opacity by colour; 1 is opaque.", ".5 .5 .5",
         [](Interpreter& in, const Call& c) {
             if (Color v; colorOf(in, c, v)) in.attributes().opacity = v;
         }},
        {"TextureCoordinates", "number[8] st", k, s, false,
         "(s,t) at the corners (u,v) = (0,0) (1,0) (0,1) (1,1) of parametric surfaces.", "0 0 1 0 0 1 1 1",
         [](Interpreter& in, const Call& c) {
             auto v = c.reals(0);
             std::copy(v.begin(), v.end(), in.attributes().textureCoordinates);
         }},
        {"ShadingRate", "number size", k, s, false,
         "Area in pixels of a micropolygon: of what hidden shades once for all samples that see it, of diced facets, and of the "
         "footprint that textures and derivatives see.",
         ".5", [](Interpreter& in, const Call& c) { in.attributes().shadingRate = c.real(0); }},
        {"ShadingInterpolation", "string type", k, s, false,
         "\"constant\": one colour a micropolygon; \"smooth\": linear between corners (on micropolygons).", "\"smooth\"",
         [](Interpreter& in, const Call& c) {
             if (c.text(0) == "smooth" || c.text(0) == "constant") in.attributes().smoothShading = c.text(0) == "smooth";
             else
                 in.reporter.error(Rie::BadToken, c.place, fmt::format("ShadingInterpolation: \"{}\" is not known", c.text(0)),
                                   "constant or smooth");
         }},
        {"Matte", "int on", k, s, false, "The object hides what is behind it and is itself not seen.", "1",
         [](Interpreter& in, const Call& c) { in.attributes().matte = c.integer(0) != 0; }},
    };
}

std::vector<Request> shapeRequests() {
    const Kind k = Kind::Attribute;
    const unsigned s = kAttributes;
    return {
        {"Bound", "number[6] bound", k, s, true,
         "Object-space box around what follows. Without effect: shapes know their bounds.", "[-1 1 -1 1 -1 1]",
         [](Interpreter& in, const Call& c) {
             if (std::vector<float> b; boundOf(in, c, b)) in.attributes().bound = b;
         }},
        {"Detail", "number[6] bound", k, s, true, "Object-space box whose size in the image chooses the level of detail.",
         "-1 1 -1 1 -1 1",
         [](Interpreter& in, const Call& c) {
             if (std::vector<float> b; boundOf(in, c, b)) {
                 in.attributes().detail = b;
                 in.attributes().detailSpace = in.state.ctm.first();
             }
         }},
        {"DetailRange", "number[4] range", k, s, false, "minvisible lowertransition uppertransition maxvisible, in pixels.",
         "0 10 100 200",
         [](Interpreter& in, const Call& c) {
             auto v = c.reals(0);
             if (within(in, c, std::is_sorted(v.begin(), v.end()), "the four sizes must not decrease"))
                 std::copy(v.begin(), v.end(), in.attributes().detailRange);
         }},
        {"GeometricApproximation", "string type; number value", k, s, false,
         "How closely shapes are followed. \"motionfactor\": what moves is diced by ShadingRate times this times a 16th of the "
         "pixels that "
         "it moves. \"flatness\": pixels that facets of patches and subdivision surfaces without displacement may stray from the "
         "surface, 0.05 "
         "by itself (quadrics and curves have no facets). \"focusfactor\", \"normaldeviation\", \"pointdeviation\" and "
         "\"tessellation\" are kept "
         "for shaders: what is out of focus is diced as finely as the rest.",
         "\"motionfactor\" 1", approximation},
        {"GeometricRepresentation", "string type", k, s, false, "Of RISpec 3.0; has no effect.", "\"primitive\"",
         [](Interpreter& in, const Call& c) {
             if (c.text(0) != "primitive") in.incapable(c, "GeometricRepresentation has no effect");
         }},
        {"Orientation", "string orientation", k, s, false, "Which side is outside: outside, inside, lh or rh.", "\"outside\"",
         orientation},
        {"ReverseOrientation", "", k, s, false, "The other side is outside.", "", reverse},
        {"Sides", "int sides", k, s, false, "1: only the outside is seen; 2: both sides.", "2",
         [](Interpreter& in, const Call& c) {
             if (within(in, c, c.integer(0) == 1 || c.integer(0) == 2, "it is 1 or 2")) in.attributes().sides = c.integer(0);
         }},
        {"Basis", "basis u; int ustep; basis v; int vstep", k, s, false, "Cubic bases and steps of patches and curves.",
         "\"bezier\" 3 \"b-spline\" 1", basis},
        {"TrimCurve",
         "int[] ncurves; int[] order; number[] knot; number[] min; number[] max; int[] n; number[] u; number[] v; number[] w", k,
         s, false,
         "Loops of rational curves in the (u,v) of the next NuPatch; inside them the patch is cut away, or "
         "outside with Attribute \"trimcurve\" \"sense\" \"outside\".",
         "[1] [2] [0 0 1 2 2] [0] [2] [3] [0 1 0] [0 0 0] [1 1 1]", trimCurve},
        {"Attribute", "string class; ..", k, s, false, "Attributes of this renderer, by class and name (docs/options.md).",
         "\"identifier\" \"name\" \"ball\"", attribute},
    };
}

} // namespace

std::vector<Request> attributeRequests() {
    std::vector<Request> all = appearanceRequests();
    for (Request& r : shapeRequests()) all.push_back(std::move(r));
    return all;
}

} // namespace alpenglow::ri
