// Splines: rsl.md 10.1 (seed 6.4.1). The code generator chooses the four control points; the code here places and evaluates.
#pragma once
//CODE
#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::rsl {
std::vector<Shadeop> splineShadeops() {
    Shadeop op;
    op.section = "Mathematics";
    op.name = "spline";
    for (const char* type : {"float", "color", "point", "vector", "normal"}) {
        const std::string t = type;
        op.signatures.push_back(parseSignature(t + " spline(float v; " + t + " p, ...)"));
        op.signatures.push_back(parseSignature(t + " spline(string basis; float v; " + t + " p, ...)"));
        op.signatures.push_back(parseSignature(t + " spline(float v; " + t + " p[])"));
        op.signatures.push_back(parseSignature(t + " spline(string basis; float v; " + t + " p[])"));
    }
    op.lowering = Lowering::Special;
    op.derivative = DerivativeRule::Inherent;
    op.doc =
        "Point on a curve through or near control points; v in [0,1], outside it is clamped. Bases: catmull-rom (default), bezier, bspline, "
        "hermite, linear; an unknown name means linear. Segment s uses the points p[s step .. s step + 3], step = 1 for catmull-rom, bspline "
        "and linear (which ignores the first and the last), 3 for bezier, 2 for hermite (point, tangent, point, tangent); the number of segments "
        "is (n - 4) / step + 1. al_splinesegment(v, segments) gives s and the local parameter t; al_spline_<basis>_f and _t(t, p0, p1, p2, p3) "
        "evaluate, basis spelled catmullrom, bezier, bspline, hermite, linear. The prefix \"solve\" (floats only) inverts: the v for which the spline "
        "has the given value, for control points that rise or fall; the first such segment; outside the range the nearer end, 0 or 1. A segment "
        "contains the value when it lies between the segment's values at t = 0 and t = 1; al_splinesolve_<basis>(value, p0, p1, p2, p3) then "
        "gives t, and v = (s + t) / segments.";
    op.source = "seed; point counts (k)";
    op.examples = {{"spline(0.5, 0, 0, 1, 1)", "0.5"}, {"spline(\"linear\", 0.25, 9, 0, 1, 9)", "0.25"}};
    return {op};
}
} // namespace alpenglow::rsl
#endif
