// Input made from nothing: requests by the table that the reader has, programs whose types fit.
#include "mutate.h"
#include "ri/requests/request.h"
#include <array>

namespace alpenglow::fuzz {
namespace {

std::string number(Random& r, bool integer = false) {
    static const char* const special[] = {"0", "1",  "-1",   "0.5",   "360",   "-360", "1e-20", "1e20",
                                          "3", "90", "1e38", "-1e38", "0.001", "2",    "4",     "1e999"};
    if (r.once(4)) return r.of(special);
    if (integer) return std::to_string(int(r.below(9)) - (r.once(6) ? 3 : 0));
    return std::to_string(double(int64_t(r.below(4000)) - 2000) / 500);
}

std::string numbers(Random& r, size_t n, bool integer = false) {
    std::string s = "[";
    for (size_t i = 0; i < n; ++i) s += (i ? " " : "") + number(r, integer);
    return s + "]";
}

const char* const kNames[] = {"matte",
                              "plastic",
                              "P",
                              "Pw",
                              "N",
                              "st",
                              "Cs",
                              "perspective",
                              "fov",
                              "bilinear",
                              "bicubic",
                              "nonperiodic",
                              "periodic",
                              "linear",
                              "cubic",
                              "b-spline",
                              "bezier",
                              "hermite",
                              "catmull-rom",
                              "smooth",
                              "intersection",
                              "union",
                              "difference",
                              "primitive",
                              "path",
                              "hidden",
                              "raytrace",
                              "box",
                              "gaussian",
                              "rgb",
                              "rgba",
                              "rgbaz",
                              "null",
                              "a.exr",
                              "openexr",
                              "pointlight",
                              "arealight",
                              "spotlight",
                              "inside",
                              "outside",
                              "lh",
                              "rh",
                              "world",
                              "camera",
                              "object",
                              "a",
                              "mine",
                              "\x1b[2J",
                              "",
                              "catmull-clark",
                              "hole",
                              "crease",
                              "corner",
                              "interpolateboundary",
                              "Width",
                              "width",
                              "constantwidth",
                              "uniform color[3] x",
                              "varying float q",
                              "vertex point Pref",
                              "facevarying float[2] st",
                              "string texturename",
                              "a.tx",
                              "displacementbound",
                              "sphere",
                              "coordinatesystem",
                              "shade",
                              "limits",
                              "trace",
                              "visibility",
                              "light",
                              "user",
                              "searchpath"};

std::string argument(Random& r, const ri::ArgSpec& a) {
    using Form = ri::ArgSpec::Form;
    const auto one = [&]() -> std::string {
        switch (a.form) {
        case Form::String:
        case Form::Basis:
            return "\"" + std::string(r.of(kNames)) + "\"";
        case Form::Handle:
            return r.once(2) ? "1" : "\"mine\"";
        case Form::Int:
            return number(r, true);
        case Form::Number:
            break;
        }
        return number(r);
    };
    const size_t n = a.array ? r.below(20) : r.once(20) ? r.below(30) : size_t(a.count);
    if (!a.array && n == 1) return one();
    std::string s = "[";
    for (size_t i = 0; i < n; ++i) s += (i ? " " : "") + one();
    return s + "]";
}

std::string parameter(Random& r) {
    switch (r.below(6)) {
    case 0:
        return "\"P\" " + numbers(r, 3 * r.below(18));
    case 1:
        return "\"Pw\" " + numbers(r, 4 * r.below(18));
    case 2:
        return "\"st\" " + numbers(r, 2 * r.below(18));
    case 3:
        return "\"Cs\" " + numbers(r, 3 * r.below(10));
    case 4:
        return "\"Kd\" " + number(r);
    default:
        return "\"" + std::string(r.of(kNames)) + "\" " +
               (r.once(3) ? "[\"" + std::string(r.of(kNames)) + "\"]" : numbers(r, r.below(40)));
    }
}

std::string request(Random& r) {
    const ri::Request& q = r.of(ri::requestTable());
    std::string s(q.name);
    // The sample of the table is right; so is most of what grows from it.
    if (r.once(3)) return s + " " + std::string(q.sample) + "\n";
    for (const ri::ArgSpec& a : q.args)
        if (!a.optional || r.once(2)) s += " " + argument(r, a);
    if (q.parameters)
        for (size_t i = r.below(4); i-- > 0;) s += " " + parameter(r);
    return s + "\n";
}

/// Functions that a program may call: "result name(types)".
const std::vector<std::array<std::string, 5>>& functions() {
    static const std::vector<std::array<std::string, 5>> list = [] {
        std::vector<std::array<std::string, 5>> all;
        for (const char* name :
             {"sin",  "cos",   "tan",  "asin",  "acos",    "atan",    "exp",   "sqrt",      "inversesqrt", "log", "abs",
              "sign", "floor", "ceil", "round", "radians", "degrees", "noise", "cellnoise", "Du",          "Dv",  "Deriv1"})
            if (std::string(name) != "Deriv1") all.push_back({"float", name, "float"});
        for (const char* name : {"pow", "mod", "min", "max", "step", "atan", "noise", "pnoise", "filterstep"})
            all.push_back(std::string(name) == "pnoise" ? std::array<std::string, 5>{"float", name, "point", "point"}
                                                        : std::array<std::string, 5>{"float", name, "float", "float"});
        for (const char* name : {"clamp", "smoothstep", "mix"}) all.push_back({"float", name, "float", "float", "float"});
        for (const char* type : {"color", "point", "vector", "normal"}) {
            all.push_back({type, "mix", type, type, "float"});
            all.push_back({type, "clamp", type, type, type});
            all.push_back({type, std::string(type) + " noise", "point"});
            all.push_back({type, std::string(type) + " cellnoise", "float", "float"});
        }
        const std::array<std::string, 5> others[] = {{"float", "length", "vector"},
                                                     {"vector", "normalize", "vector"},
                                                     {"float", "distance", "point", "point"},
                                                     {"vector", "faceforward", "vector", "vector"},
                                                     {"vector", "reflect", "vector", "vector"},
                                                     {"vector", "refract", "vector", "vector", "float"},
                                                     {"float", "xcomp", "point"},
                                                     {"float", "comp", "color", "float"},
                                                     {"point", "rotate", "point", "float", "point"},
                                                     {"point", "transform", "matrix", "point"},
                                                     {"matrix", "translate", "matrix", "vector"},
                                                     {"float", "determinant", "matrix"},
                                                     {"color", "ctransform", "space", "color"},
                                                     {"color", "diffuse", "normal"},
                                                     {"color", "ambient"},
                                                     {"color", "specular", "normal", "vector", "float"},
                                                     {"color", "spline", "float", "color", "color"},
                                                     {"float", "area", "point"},
                                                     {"string", "concat", "string", "string"},
                                                     {"float", "match", "string", "string"},
                                                     {"string", "format", "string", "float"},
                                                     {"float", "depth", "point"},
                                                     {"normal", "calculatenormal", "point"},
                                                     {"color", "trace", "point", "vector"},
                                                     {"color", "texture", "map", "float", "float"},
                                                     {"color", "environment", "map", "vector"},
                                                     {"float", "shadow", "map", "point"},
                                                     {"vector", "Du", "point"}};
        all.insert(all.end(), std::begin(others), std::end(others));
        return all;
    }();
    return list;
}

std::string call(Random& r, const std::array<std::string, 5>& f, int depth) {
    std::string s = f[1] + "(";
    for (size_t i = 2; i < 5 && !f[i].empty(); ++i) {
        s += i > 2 ? ", " : "";
        if (f[i] == "space") s += "\"" + std::string(r.of(std::array{"hsv", "hsl", "rgb", "XYZ", "YIQ", "nowhere"})) + "\"";
        else if (f[i] == "map") s += "\"" + std::string(r.of(std::array{"a.tx", "b.tx", "a.shd", "nosuch"})) + "\"";
        else s += generateExpression(r, f[i], depth - 1);
    }
    if (f[1] == "spline") s += ", " + generateExpression(r, "color", 0) + ", " + generateExpression(r, "color", 0);
    return s + ")";
}

std::string leaf(Random& r, const std::string& type) {
    if (type == "string") return "\"" + std::string(r.of(std::array{"", "a", "%f %s\\n", "[a-z]+", "(((", "abc"})) + "\"";
    if (type == "float") return r.once(2) ? number(r) : r.of(std::array{"s", "t", "u", "v", "du", "PI", "f", "k[1]", "Kx"});
    if (type == "matrix") return r.once(2) ? "m" : "(matrix " + number(r) + ")";
    if (type == "color")
        return r.once(2) ? std::string(r.of(std::array{"Cs", "Os", "c", "color 0.5", "color(1, .5, 0)"}))
                         : "color \"hsv\" (" + number(r) + ", 1, 1)";
    if (type == "point") return r.of(std::array{"P", "E", "p", "point(1, 2, 3)", "point \"world\" (0, 0, 0)"});
    if (type == "vector") return r.of(std::array{"I", "dPdu", "dPdv", "w", "vector(0, 1, 0)", "vector 0"});
    return r.of(std::array{"N", "Ng", "n", "normal(0, 0, 1)", "normal 0"});
}

std::string statement(Random& r, int depth) {
    static const std::array<std::string, 5> types{"float", "color", "point", "vector", "normal"};
    static const std::array<std::string, 5> names{"f", "c", "p", "w", "n"};
    const size_t k = r.below(5);
    const auto assign = [&] { return names[k] + (r.once(4) ? " += " : " = ") + generateExpression(r, types[k], 3) + ";\n"; };
    if (depth <= 0) return assign();
    switch (r.below(9)) {
    case 0:
        return "if (" + generateExpression(r, "float", 2) + " < " + generateExpression(r, "float", 1) + ") {\n" +
               statement(r, depth - 1) + "} else " + statement(r, depth - 1);
    case 1: {
        const std::string i = "i" + std::to_string(depth);
        return "float " + i + "_;\nfor (" + i + "_ = 0; " + i + "_ < " + std::to_string(1 + r.below(6)) + "; " + i +
               "_ += 1) {\n" + statement(r, depth - 1) + (r.once(3) ? "if (" + i + "_ > f) break;\n" : "") + "}\n";
    }
    case 2:
        return "k[" + (r.once(3) ? generateExpression(r, "float", 1) : std::to_string(r.below(4))) +
               "] = " + generateExpression(r, "float", 2) + ";\n";
    case 3:
        return "illuminance(P, N, PI / 2) {\n" + statement(r, depth - 1) + "}\n";
    case 4:
        return "m = " + generateExpression(r, "matrix", 1) + ";\n";
    case 5:
        return "{ " + types[k] + " " + names[k] + " = " + generateExpression(r, types[k], 2) + ";\n" + statement(r, depth - 1) +
               "}\n";
    default:
        return assign();
    }
}

} // namespace

Bytes generateRib(Random& r) {
    Bytes s = "Format 8 6 1\nPixelSamples 1 1\nDisplay \"a.exr\" \"openexr\" \"rgba\"\nProjection \"perspective\" \"fov\" 40\n";
    if (r.once(3)) s += "Hider \"path\"\n";
    for (size_t i = r.below(4); i-- > 0;) s += request(r);
    s += "Translate 0 0 5\nWorldBegin\nLightSource \"ambientlight\" 1\n";
    for (size_t i = 1 + r.below(8); i-- > 0;) s += request(r);
    if (r.once(2)) s += "Surface \"plastic\"\nSphere 1 -1 1 360\n";
    return s + "WorldEnd\n";
}

std::string generateExpression(Random& r, const std::string& type, int depth) {
    if (depth <= 0 || r.once(4)) return leaf(r, type);
    const bool tuple = type != "float" && type != "string" && type != "matrix";
    switch (r.below(5)) {
    case 0:
        if (type == "float" || tuple)
            return "(" + generateExpression(r, type, depth - 1) + r.of(std::array{" + ", " - ", " * ", " / "}) +
                   generateExpression(r, r.once(3) ? "float" : type, depth - 1) + ")";
        break;
    case 1:
        if (type != "string" && type != "matrix")
            return "(" + generateExpression(r, "float", depth - 1) + r.of(std::array{" < ", " > ", " == ", " != "}) +
                   generateExpression(r, "float", depth - 1) + " ? " + generateExpression(r, type, depth - 1) + " : " +
                   generateExpression(r, type, depth - 1) + ")";
        break;
    case 2:
        if (type == "float")
            return "(" + generateExpression(r, "vector", depth - 1) + " . " + generateExpression(r, "normal", depth - 1) + ")";
        if (type == "vector")
            return "(" + generateExpression(r, "vector", depth - 1) + " ^ " + generateExpression(r, "normal", depth - 1) + ")";
        break;
    default:
        break;
    }
    for (int tries = 0; tries < 12; ++tries)
        if (const auto& f = r.of(functions()); f[0] == type) return call(r, f, depth);
    return leaf(r, type);
}

Bytes generateShader(Random& r) {
    const char* const kind = r.of(std::array{"surface", "surface", "surface", "displacement"});
    Bytes s = std::string(kind) + " z(float Kx = " + number(r) +
              "; color Cx = 1;)\n{\n    float f = 1; color c = 0; point p = P; vector w = I; normal n = N; matrix m = 1; float "
              "k[4] = {1, 2, 3, 4};\n";
    for (size_t i = 1 + r.below(8); i-- > 0;) s += statement(r, 2);
    return s + (std::string(kind) == "surface" ? "Oi = Os;\nCi = c * f + color(n . w, k[2], xcomp(p));\n}\n"
                                               : "P += 0.01 * f * normalize(N);\nN = calculatenormal(P);\n}\n");
}

} // namespace alpenglow::fuzz
