#include "geometry/build.h"
#include "base/limits.h"
#include "geometry/factories.h"
#include "geometry/instance_attributes.h"
#include <cmath>
#include <cstring>

namespace alpenglow::geometry {
namespace {

struct Entry { const char* kind; ShapeRef (*make)(ShapeSource, Diagnostics&); };
constexpr Entry kTable[] = {
    {"Sphere", makeSphere},
    {"Cone", makeCone},
    {"Cylinder", makeCylinder},
    {"Hyperboloid", makeHyperboloid},
    {"Paraboloid", makeParaboloid},
    {"Disk", makeDisk},
    {"Torus", makeTorus},
    {"Polygon", makePolygon},
    {"GeneralPolygon", makeGeneralPolygon},
    {"PointsPolygons", makePointsPolygons},
    {"PointsGeneralPolygons", makePointsGeneralPolygons},
    {"Patch", makePatch},
    {"PatchMesh", makePatchMesh},
    {"NuPatch", makeNuPatch},
    {"Curves", makeCurves},
    {"Points", makePoints},
    {"SubdivisionMesh", makeSubdivisionMesh},
    {"HierarchicalSubdivisionMesh", makeSubdivisionMesh},
    {"Blobby", makeBlobby},
};

void once(Diagnostics& diag, const std::string& key, Rie code, const SourcePlace& place, const std::string& message) {
    Diagnostic d;
    d.severity = Severity::Warning;
    d.code = code;
    d.place = place;
    d.message = message;
    diag.reportOnce("geometry:" + key, d);
}

bool unset(const scene::Basis& b) {
    for (auto& row : b.m)
        for (double x : row)
            if (x != 0) return false;
    return true;
}

// RenderMan's defaults where a caller gave no attributes or no basis.
void fillBasis(scene::Basis& b) {
    if (!unset(b)) return;
    static constexpr double bezier[4][4] = {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}};
    std::memcpy(b.m, bezier, sizeof bezier);
    b.step = 3;
}

} // namespace

ShapeRef buildShape(const scene::PrimitiveRef& prim, const scene::AttributesRef& given, const Matrix& toCamera, int instance,
                    Diagnostics& diag, Facing facing) {
    const Entry* entry = nullptr;
    for (const Entry& e : kTable)
        if (prim->kind == e.kind) entry = &e;
    if (!entry) {
        std::string what = prim->kind;
        if (what == "Geometry" && !prim->strings.empty()) what += " \"" + prim->strings[0] + "\"";
        once(diag, "kind:" + what, Rie::Unimplement, prim->place, what + " is not yet drawn");
        return nullptr;
    }
    // Exporters invert matrices in single precision: what is left of that in the last column is no perspective.
    constexpr double noise = 1e-7;
    bool affine = std::fabs(toCamera.m[0][3]) < noise && std::fabs(toCamera.m[1][3]) < noise &&
                  std::fabs(toCamera.m[2][3]) < noise && std::fabs(toCamera.m[3][3] - 1) < noise;
    bool finite = true;
    for (auto& row : toCamera.m)
        for (double x : row) finite = finite && std::isfinite(x);
    if (!finite || determinant3(toCamera) == 0) {
        diag.report(Severity::Warning, Rie::Math, prim->place,
                    prim->kind + " has a transformation without inverse; it is not drawn");
        return nullptr;
    }
    if (!affine)
        once(diag, "projective", Rie::Incapable, prim->place,
             "a transformation of this " + prim->kind + " holds a perspective; derivatives and quadrics ignore it");
    ShapeSource s;
    s.primitive = prim;
    s.toCamera = toCamera;
    s.instance = instance;
    s.facing = facing;
    s.attributes = given;
    const bool patch = prim->kind == "Patch" || prim->kind == "PatchMesh" || prim->kind == "Curves";
    if (!given || (patch && (unset(given->ubasis) || unset(given->vbasis)))) {
        auto a = given ? std::make_shared<scene::Attributes>(*given) : std::make_shared<scene::Attributes>();
        fillBasis(a->ubasis);
        fillBasis(a->vbasis);
        s.attributes = std::move(a);
    }
    return entry->make(std::move(s), diag);
}

std::vector<ShapeRef> buildShapes(const scene::Frame& f, Diagnostics& diag, size_t most) {
    std::vector<ShapeRef> out;
    const Matrix& camera = f.options.worldToCamera.first();
    // REYES turned them to the eye once; where rays come from everywhere they turn to each.
    const Facing facing = f.options.hider != "hidden" ? Facing::Ray : f.options.projection == "perspective" ? Facing::Eye : Facing::Picture;
    auto sayMotion = [&](const scene::Primitive& p, bool moves) {
        if (moves || !p.motionKeys.empty() || p.toWorld.moves())
            once(diag, "motion", Rie::Unimplement, p.place,
                 "primitives that move are drawn where they are at their first time: their motion is not drawn yet");
    };
    auto full = [&](const SourcePlace& place) {
        if (out.size() < most) return false;
        once(diag, "limit", Rie::Limit, place,
             "the frame has more than " + std::to_string(most) + " primitives; the rest is not drawn");
        return true;
    };
    auto add = [&](const scene::PrimitiveRef& p, const scene::AttributesRef& a, const Matrix& m, int instance) {
        if (full(p->place)) return;
        if (ShapeRef s = buildShape(p, a, m, instance, diag, facing)) out.push_back(std::move(s));
    };
    for (const scene::PrimitiveRef& p : f.primitives) {
        if (!p) continue;
        sayMotion(*p, false); // a moving camera is the renderer's: it moves
        add(p, p->attributes, p->toWorld.first() * camera, -1);
    }
    for (size_t i = 0; i < f.instances.size(); ++i) {
        const scene::Instance& inst = f.instances[i];
        if (inst.object < 0 || size_t(inst.object) >= f.objects.size()) {
            diag.report(Severity::Error, Rie::BadHandle, inst.place, "ObjectInstance of an object that does not exist");
            continue;
        }
        if (full(inst.place)) break;
        const scene::Primitive* last = nullptr; // of a row of primitives with the same attributes
        scene::AttributesRef attributes;
        for (const scene::PrimitiveRef& p : f.objects[size_t(inst.object)].primitives) {
            if (!p) continue;
            sayMotion(*p, inst.toWorld.moves());
            if (!last || last->attributes != p->attributes || last->attributesBefore != p->attributesBefore)
                attributes = instanceAttributes(*p, inst);
            last = p.get();
            add(p, attributes, p->toWorld.first() * (inst.toWorld.first() * camera), int(i));
        }
    }
    return out;
}

} // namespace alpenglow::geometry
