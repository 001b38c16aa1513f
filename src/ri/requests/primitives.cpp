// Polygons, patches, meshes, points, curves and the rest (RISpec 3.2, section 5).
#include "ri/interpreter.h"
#include "ri/models/model.h"
#include "ri/ris.h"
#include "ri/teapot.h"
#include <fmt/format.h>
#include <map>

namespace alpenglow::ri {
namespace {

scene::Param argument(const char* name, scene::Type type, const Call& c) {
    scene::Param p;
    p.name = name;
    p.cls = scene::Class::Constant;
    p.type = type;
    p.place = c.place;
    return p;
}

/// An argument that travels among the parameters (scene/scene.h).
void carry(scene::Primitive& p, const char* name, scene::Type type, const Call& c, size_t i) {
    scene::Param a = argument(name, type, c);
    if (type == scene::Type::String) a.strings = c.strings(i);
    else a.numbers = c.reals(i);
    a.arrayLength = int(std::max(a.numbers.size(), a.strings.size()));
    p.params.push_back(std::move(a));
}

bool wrap(Interpreter& in, const Call& c, const std::string& given, std::string& out) {
    out = given == "nowrap" ? "nonperiodic" : given;
    if (out == "periodic" || out == "nonperiodic") return true;
    in.reporter.error(Rie::BadToken, c.place, fmt::format("{}: wrap \"{}\" is not known", c.request->name, given),
                      "periodic or nonperiodic");
    return false;
}

bool oneOf(Interpreter& in, const Call& c, const std::string& given, const char* a, const char* b) {
    if (given == a || given == b) return true;
    in.reporter.error(Rie::BadToken, c.place, fmt::format("{}: type \"{}\" is not known", c.request->name, given),
                      fmt::format("{} or {}", a, b));
    return false;
}

scene::Primitive start(Interpreter& in, const Call& c) {
    scene::Primitive p;
    p.params = in.bind(c, Use::Primitive);
    return p;
}

void polygon(Interpreter& in, const Call& c) { in.emit(start(in, c), c); }

void indexed(Interpreter& in, const Call& c) {
    scene::Primitive p = start(in, c);
    p.ints = c.ints(0);
    if (c.arguments.size() > 1) p.ints2 = c.ints(1);
    if (c.arguments.size() > 2) p.ints3 = c.ints(2);
    in.emit(std::move(p), c);
}

void patch(Interpreter& in, const Call& c) {
    if (!oneOf(in, c, c.text(0), "bilinear", "bicubic")) return;
    scene::Primitive p = start(in, c);
    p.strings = {c.text(0)};
    in.emit(std::move(p), c);
}

void patchMesh(Interpreter& in, const Call& c) {
    std::string u, v;
    if (!oneOf(in, c, c.text(0), "bilinear", "bicubic") || !wrap(in, c, c.text(2), u) || !wrap(in, c, c.text(4), v)) return;
    scene::Primitive p = start(in, c);
    p.strings = {c.text(0), u, v};
    p.ints = {c.integer(1), c.integer(3)};
    in.emit(std::move(p), c);
}

void nuPatch(Interpreter& in, const Call& c) {
    scene::Primitive p = start(in, c);
    p.ints = {c.integer(0), c.integer(1), c.integer(5), c.integer(6)};
    p.numbers = {c.real(3), c.real(4), c.real(8), c.real(9)};
    carry(p, "uknot", scene::Type::Float, c, 2);
    carry(p, "vknot", scene::Type::Float, c, 7);
    in.emit(std::move(p), c);
}

void subdivision(Interpreter& in, const Call& c) {
    scene::Primitive p = start(in, c);
    p.strings = {c.text(0)};
    p.ints = c.ints(1);
    p.ints2 = c.ints(2);
    if (c.given(3)) { // the tag group
        p.strings.insert(p.strings.end(), c.strings(3).begin(), c.strings(3).end());
        if (c.given(4)) p.ints3 = c.ints(4);
        if (c.given(5)) carry(p, "intargs", scene::Type::Integer, c, 5);
        if (c.given(6)) carry(p, "floatargs", scene::Type::Float, c, 6);
        if (c.given(7)) carry(p, "stringargs", scene::Type::String, c, 7);
    }
    in.emit(std::move(p), c);
}

void curves(Interpreter& in, const Call& c) {
    std::string w;
    if (!oneOf(in, c, c.text(0), "linear", "cubic") || !wrap(in, c, c.text(2), w)) return;
    scene::Primitive p = start(in, c);
    p.strings = {c.text(0), w};
    p.ints = c.ints(1);
    in.emit(std::move(p), c);
}

void blobby(Interpreter& in, const Call& c) {
    scene::Primitive p = start(in, c);
    p.ints = {c.integer(0)};
    p.ints2 = c.ints(1);
    p.numbers = c.reals(2);
    if (c.given(3)) p.strings = c.strings(3);
    for (std::string& s : p.strings) s = in.depthMap(s, c.place);
    in.emit(std::move(p), c);
}

void geometry(Interpreter& in, const Call& c) {
    static const std::map<std::string, const std::string& (*)()> kShapes = {
        {"teapot", teapotRequests}, {"cube", cubeRequests}, {"sphere", sphereRequests}};
    const std::string& name = c.text(0);
    if (const auto light = lightGeometry(name)) return in.expand(std::string(*light), c);
    const auto shape = kShapes.find(name);
    const bool file = name == "ply" || name == "obj" || namedAsModel(name);
    if (file || (shape != kShapes.end() && !in.gatheringMotion())) {
        scene::ParamList everywhere;
        std::string filename = name;
        if (!namedAsModel(name)) filename.clear();
        for (scene::Param& p : in.bind(c, Use::Primitive)) {
            if (file && p.name == "filename" && !p.strings.empty()) {
                filename = p.strings[0];
                continue;
            }
            const bool one = p.cls == scene::Class::Constant || p.cls == scene::Class::Uniform;
            if (one) p.cls = scene::Class::Constant; // per-shape values are constant for the whole primitive
            if (one) everywhere.push_back(std::move(p));
            else in.incapable(c, "Geometry \"" + name + "\" has no variables but constant and uniform ones");
        }
        if (!file) return in.expand(shape->second(), c, std::move(everywhere));
        if (filename.empty())
            in.reporter.error(Rie::MissingData, c.place, fmt::format("Geometry \"{}\" needs \"string filename\"", name));
        else in.drawModel(filename, c, everywhere);
        return;
    }
    scene::Primitive p = start(in, c);
    p.strings = {name};
    in.emit(std::move(p), c);
}

void procedural(Interpreter& in, const Call& c) {
    const std::string& kind = c.text(0);
    if (kind != "DelayedReadArchive" && kind != "RunProgram" && kind != "DynamicLoad") {
        in.reporter.error(Rie::BadToken, c.place, fmt::format("Procedural: \"{}\" is not known", kind),
                          "DelayedReadArchive, RunProgram or DynamicLoad");
        return;
    }
    in.procedural(kind, c.strings(1), c.reals(2), c);
}

} // namespace

std::vector<Request> primitiveRequests() {
    const Kind k = Kind::Primitive;
    const unsigned s = kWorld | kObject;
    const char* mesh = "\"catmull-clark\" [3 3] [0 1 2 0 2 3] [\"crease\"] [2 1] [0 1] [10] \"P\" [0 0 0 1 0 0 1 1 0 0 1 0]";
    const char* hierarchical =
        "\"catmull-clark\" [3 3] [0 1 2 0 2 3] [\"hole\"] [1 0 0] [1] [] [] \"P\" [0 0 0 1 0 0 1 1 0 0 1 0]";
    return {
        {"Polygon", "..", k, s, true, "A convex planar polygon.", "\"P\" [0 0 0 1 0 0 1 1 0]", polygon},
        {"GeneralPolygon", "int[] nverts; ..", k, s, true, "A planar polygon; the loops after the first are holes.",
         "[3] \"P\" [0 0 0 1 0 0 1 1 0]", indexed},
        {"PointsPolygons", "int[] nverts; int[] verts; ..", k, s, true, "Convex polygons that share points.",
         "[3] [0 1 2] \"P\" [0 0 0 1 0 0 1 1 0]", indexed},
        {"PointsGeneralPolygons", "int[] nloops; int[] nverts; int[] verts; ..", k, s, true,
         "Polygons with holes that share points.", "[1] [3] [0 1 2] \"P\" [0 0 0 1 0 0 1 1 0]", indexed},
        {"Patch", "string type; ..", k, s, true, "A bilinear (4 points) or bicubic (16) patch.",
         "\"bilinear\" \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]", patch},
        {"PatchMesh", "string type; int nu; string uwrap; int nv; string vwrap; ..", k, s, true, "A mesh of patches.",
         "\"bilinear\" 2 \"nonperiodic\" 2 \"nonperiodic\" \"Pz\" [0 0 0 1]", patchMesh},
        {"NuPatch",
         "int nu; int uorder; number[] uknot; number umin; number umax; int nv; int vorder; number[] vknot; number vmin; number "
         "vmax; ..",
         k, s, true, "A NURBS surface.", "2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]", nuPatch},
        {"SubdivisionMesh",
         "string scheme; int[] nverts; int[] verts; string[] tags?; int[] nargs?; int[] intargs?; number[] floatargs?; ..", k, s,
         true, "A subdivision surface.", mesh, subdivision},
        {"HierarchicalSubdivisionMesh",
         "string scheme; int[] nverts; int[] verts; string[] tags?; int[] nargs?; int[] intargs?; number[] floatargs?; string[] "
         "stringargs?; ..",
         k, s, true, "A subdivision surface with edits at any level.", hierarchical, subdivision},
        {"Points", "..", k, s, true, "Particles: discs that face the eye, or by \"type\" spheres and squares.",
         "\"P\" [0 0 0 1 0 0] \"constantwidth\" [.1]", polygon},
        {"Curves", "string type; int[] nvertices; string wrap; ..", k, s, true,
         "Thin ribbons, flat by \"N\", or tubes (Attribute \"dice\" \"roundcurve\" 1).",
         "\"cubic\" [4] \"nonperiodic\" \"P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"width\" [.1 .2]", curves},
        {"Blobby", "int nleaf; int[] code; number[] floats; string[] strings?; ..", k, s, true,
         "An implicit surface of blobs: constants, ellipsoids, segments, repelling planes and all operators.",
         "1 [1001 0] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] [\"\"]", blobby},
        {"Geometry", "string name; ..", k, s, true,
         "A shape the renderer knows: \"teapot\" (Newell's: on z = 0 about the z axis, spout to +x, largest radius 2, 3 high), "
         "\"cube\" (side 1), \"sphere\" (radius 1); \"rectlight\", \"disklight\", \"spherelight\", "
         "\"cylinderlight\" (1 across); or the polygons of a file of .ply or .obj.",
         "\"teapot\"", geometry},
        {"Volume", "string type; number[6] bound; int[] dimensions; ..", k, s, true,
         "A region that the Interior, or without one the Atmosphere, fills: \"box\", \"ellipsoid\", or along z \"cylinder\" and "
         "\"cone\", as large "
         "as its bound. Constant variables are parameters of the shader. \"blobbydso:impl_openvdb\": a grid of OpenVDB in a box.",
         "\"box\" [-1 1 -1 1 -1 1] [0 0 0]", [](Interpreter& in, const Call& c) { in.volume(c); }},
        {"Procedural", "string kind; string[] arguments; number[6] bound; ..", k, s, false,
         "Content from an archive (\"DelayedReadArchive\"), or with --allow-exec from a program (\"RunProgram\") or a "
         "library (\"DynamicLoad\", docs/plugins.md).",
         "\"RunProgram\" [\"maker\" \"data\"] [-1 1 -1 1 -1 1]", procedural},
        {"ObjectInstance", "handle object; ..", Kind::Other, s, false, "Draws a stored object.", "1",
         [](Interpreter& in, const Call& c) { in.instance(c); }},
    };
}

} // namespace alpenglow::ri
