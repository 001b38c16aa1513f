// Derivatives: 3Delight manual, 6.4.1, 6.4.3. Du and Dv are known to the code generator, or differences
// (rsl/passes/differences.h); the rest is RSL over them.
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
namespace {

/// Adds a shadeop with its text in RSL, if it has one.
Shadeop& addDerivative(std::vector<Shadeop>& list, const char* name, std::vector<Signature> signatures, Lowering lowering,
                       const char* doc, const char* rsl) {
    Shadeop op;
    op.section = "Derivatives";
    op.source = "3Delight manual, 6.4.1 and 6.4.3";
    op.name = name;
    op.signatures = std::move(signatures);
    op.contexts = kSurface | kDisplacement | kVolume | kLight | kImager;
    op.lowering = lowering;
    op.derivative = DerivativeRule::Inherent;
    op.doc = doc;
    op.rsl = rsl;
    list.push_back(std::move(op));
    return list.back();
}

/// By the parameters of the surface.
void addParameterDerivatives(std::vector<Shadeop>& list) {
    for (const char* name : {"Du", "Dv"}) {
        const std::string n = name;
        Shadeop& op = addDerivative(list, name, {}, Lowering::Special, "", "");
        op.doc = "Derivative of the argument per unit of the surface parameter " + std::string(n == "Du" ? "u" : "v") +
                 ": exact under path, the difference over du or dv under hidden and raytrace (docs/language.md); in an imager " +
                 (n == "Du" ? "u runs from 0 to 1 across" : "v runs from 0 to 1 down") +
                 " the picture. Results of rays and lights count as constant; those of maps have the slope of the map (texture).";
        op.signatures = sigs({{("float " + n + "(float x)").c_str()},
                              {("color " + n + "(color x)").c_str()},
                              {("vector " + n + "(point x)").c_str()},
                              {("vector " + n + "(vector x)").c_str()},
                              {("vector " + n + "(normal x)").c_str()}});
        op.examples = {n == "Du" ? Example{"Du(u * u)", "1"} : Example{"Dv(u * v)", "0.5"}};
    }
}

/// Derivatives of one value by another, and the surface from them.
void addSurfaceDerivatives(std::vector<Shadeop>& list) {
    addDerivative(list, "Deriv",
                  sigs({{"float Deriv(float num; float den)"},
                        {"color Deriv(color num; float den)"},
                        {"vector Deriv(point num; float den)"},
                        {"vector Deriv(vector num; float den)"},
                        {"vector Deriv(normal num; float den)"}}),
                  Lowering::Rsl, "Du(num) / Du(den) + Dv(num) / Dv(den); a quotient by 0 counts as 0.", R"(
float Deriv(float num; float den) { return Du(num) / Du(den) + Dv(num) / Dv(den); }
color Deriv(color num; float den) { return Du(num) / Du(den) + Dv(num) / Dv(den); }
vector Deriv(point num; float den) { return Du(num) / Du(den) + Dv(num) / Dv(den); }
vector Deriv(vector num; float den) { return Du(num) / Du(den) + Dv(num) / Dv(den); }
vector Deriv(normal num; float den) { return Du(num) / Du(den) + Dv(num) / Dv(den); }
)")
        .source = "3Delight manual, 6.4.1; RISpec 3.2, 15.1";
    list.back().examples = {{"Deriv(u * u, u)", "1"}};
    addDerivative(
        list, "area", sigs({{"float area(point p)"}, {"float area(point p; string strategy)"}}), Lowering::Rsl,
        "Area of one micropolygon of the surface p: length(Du(p) ^ Dv(p)) du dv; of the footprint of a sample that has none. "
        "Both strategies, \"shading\" and \"dicing\", give this.",
        R"(
float area(point p) { extern float du, dv; return length(Du(p) ^ Dv(p)) * abs(du * dv); }
float area(point p; string strategy) { extern float du, dv; return length(Du(p) ^ Dv(p)) * abs(du * dv); }
)");
    list.back().examples = {{"area(2 * P)", "4"}};
    addDerivative(
        list, "calculatenormal", sigs({{"normal calculatenormal(point p)"}}), Lowering::Rsl,
        "Normal of the surface p: Du(p) ^ Dv(p), not normalised, on the side that the orientation of the primitive says (that of "
        "Ng).",
        R"(
normal calculatenormal(point p) {
    extern vector dPdu, dPdv;
    extern normal Ng;
    normal n = Du(p) ^ Dv(p);
    return ((dPdu ^ dPdv) . Ng) < 0 ? -n : n;
}
)")
        .contexts = kSurface | kDisplacement;
    list.back().examples = {{"calculatenormal(P)", "0 0 1"}};
}

void addFilterstep(std::vector<Shadeop>& list) {
    Shadeop& filterstep =
        addDerivative(list, "filterstep",
                      sigs({{"float filterstep(float edge, float value; pairs)"},
                            {"float filterstep(float edge, float value1, float value2; pairs)"}}),
                      Lowering::Rsl,
                      "step(edge, value) filtered over the footprint of the sample, or over value1..value2. The "
                      "\"filter\" chooses which of the functions "
                      "__filterstep_catmullrom (default), __filterstep_box, __filterstep_triangle, __filterstep_gaussian "
                      "gets (edge, value1, value2); "
                      "\"width\" widens the interval about its middle. In an imager the footprint is a pixel; in volumes "
                      "du and dv are 0 and the result is step().",
                      R"(
float filterstep(float edge, value) {
    extern float du, dv;
    float w = abs(Du(value) * du) + abs(Dv(value) * dv);
    return __filterstep_catmullrom(edge, value - 0.5 * w, value + 0.5 * w);
}
float filterstep(float edge, value1, value2) { return __filterstep_catmullrom(edge, value1, value2); }
)");
    filterstep.optional = {{{Base::String, 0}, "filter", false, "\"catmull-rom\"", "gaussian, box, triangle or catmull-rom"},
                           {{Base::Float, 0}, "width", false, "1", "multiplies the width of the filter"}};
    filterstep.examples = {{"filterstep(0, -1, 1)", "0.5"}};
}

} // namespace

std::vector<Shadeop> derivativeShadeops() {
    std::vector<Shadeop> list;
    addParameterDerivatives(list);
    addSurfaceDerivatives(list);
    addFilterstep(list);
    return list;
}

} // namespace alpenglow::shadeops
