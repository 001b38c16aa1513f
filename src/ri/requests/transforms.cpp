// Transformations and coordinate systems (RISpec 3.2, 4.3).
#include "ri/interpreter.h"
#include "ri/motion.h"
#include <cmath>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

Matrix sixteen(const Call& c) {
    Matrix m;
    for (size_t i = 0; i < 16; ++i) m.m[i / 4][i % 4] = c.number(0, i);
    return m;
}

std::optional<Matrix> bad(Interpreter& in, const Call& c, const char* what) {
    in.reporter.error(Rie::Range, c.place, fmt::format("{}: {}", c.request->name, what));
    return {};
}

std::optional<Matrix> identity(Interpreter&, const Call&) { return Matrix{}; }
std::optional<Matrix> given(Interpreter&, const Call& c) { return sixteen(c); }

std::optional<Matrix> perspective(Interpreter& in, const Call& c) {
    double fov = c.number(0);
    if (!(fov > 0 && fov < 180)) return bad(in, c, "the field of view must lie between 0 and 180 degrees");
    return perspectiveMatrix(fov);
}

std::optional<Matrix> translate(Interpreter& in, const Call& c) {
    if (c.numbers(0).size() == 16) { // seen in old files
        in.reporter.once("ri:translate16", Severity::Warning, Rie::Consistency, c.place,
                         "Translate with a matrix is read as ConcatTransform");
        return sixteen(c);
    }
    return translateMatrix(c.number(0, 0), c.number(0, 1), c.number(0, 2));
}

std::optional<Matrix> scale(Interpreter&, const Call& c) { return scaleMatrix(c.number(0, 0), c.number(0, 1), c.number(0, 2)); }

std::optional<Matrix> rotate(Interpreter& in, const Call& c) {
    double x = c.number(0, 1), y = c.number(0, 2), z = c.number(0, 3);
    if (x == 0 && y == 0 && z == 0) {
        if (c.number(0, 0) == 0) return Matrix{};
        return bad(in, c, "the axis is zero");
    }
    return rotateMatrix(c.number(0, 0), x, y, z);
}

std::optional<Matrix> skew(Interpreter& in, const Call& c) {
    Vec3d a(c.number(0, 1), c.number(0, 2), c.number(0, 3)), b(c.number(0, 4), c.number(0, 5), c.number(0, 6));
    Vec3d n = cross(a, b);
    if (!(dot(n, n) > 0)) return bad(in, c, "the two directions must not be parallel");
    Matrix m = skewMatrix(c.number(0, 0), a, b);
    if (!finite(m)) return bad(in, c, "the angle is not less than the angle between the directions");
    return m;
}

void concat(Interpreter& in, const Call& c) {
    if (auto m = c.request->matrix(in, c)) in.concat(scene::Transform(*m), c);
}
void replace(Interpreter& in, const Call& c) {
    if (auto m = c.request->matrix(in, c)) in.replaceCtm(scene::Transform(*m), c);
}

void coordSysTransform(Interpreter& in, const Call& c) {
    if (auto m = in.namedSystem(c.text(0))) in.replaceCtm(*m, c);
    else
        in.reporter.error(Rie::BadToken, c.place,
                          fmt::format("CoordSysTransform: there is no coordinate system \"{}\"", c.text(0)));
}

} // namespace

std::vector<Request> transformRequests() {
    const Kind k = Kind::Transform;
    const unsigned s = kAnywhere;
    return {
        {"Identity", "", k, s, true, "Back to world space; before WorldBegin to camera space.", "", replace, identity},
        {"Transform", "number[16] matrix", k, s, true, "Replaces the current transformation.",
         "[1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1]", replace, given},
        {"ConcatTransform", "number[16] matrix", k, s, true, "Applies a matrix before the current transformation.",
         "[2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1]", concat, given},
        {"Perspective", "number fov", k, s, true, "Applies a perspective of this field of view, in degrees.", "45", concat,
         perspective},
        {"Translate", "number[3/16] offset", k, s, true, "Moves by x y z.", "1 2 3", concat, translate},
        {"Rotate", "number[4] rotation", k, s, true, "Turns by degrees about an axis: angle x y z.", "90 0 0 1", concat, rotate},
        {"Scale", "number[3] factors", k, s, true, "Scales by x y z.", "2 2 2", concat, scale},
        {"Skew", "number[7] skew", k, s, true, "Shifts along d2 so that d1 turns by degrees toward d2: angle d1 d2.",
         "45 0 1 0 1 0 0", concat, skew},
        {"Deformation", "string name; ..", k, s, false, "Transformation shader; has no effect.", "\"bend\"",
         [](Interpreter& in, const Call& c) { in.incapable(c, "transformation shaders (Deformation) have no effect"); }},
        {"CoordinateSystem", "string name", k, s, false, "Names the current space, for shaders and CoordSysTransform.",
         "\"lamp\"", [](Interpreter& in, const Call& c) { in.nameSystem(c.text(0), false); }},
        {"ScopedCoordinateSystem", "string name", k, s, false, "The same up to the end of the attribute block.", "\"lamp\"",
         [](Interpreter& in, const Call& c) { in.nameSystem(c.text(0), true); }},
        {"CoordSysTransform", "string name", k, s, false, "Makes a named space the current one.", "\"camera\"",
         coordSysTransform},
    };
}

} // namespace alpenglow::ri
