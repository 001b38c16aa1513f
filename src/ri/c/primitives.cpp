// ri.h: primitives.
#include "ri/c/pairs.h"
#include "ri/c/rifcalls.h"
#include "scene/scene.h"
#include <algorithm>
#include <array>

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

/// What counts of variables follow from.
scene::Primitive kindOf(const char* kind) {
    scene::Primitive p;
    p.kind = kind;
    if (const Client* c = Client::current()) p.attributes = c->to.attributes();
    return p;
}

/// n values of everything but constant and uniform variables.
scene::VariableCounts points(int64_t n) {
    scene::VariableCounts c;
    c.varying = c.vertex = c.faceVarying = n;
    return c;
}

void quadric(const char* request, std::initializer_list<RtFloat> shape, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building(request).numbers(shape.begin(), int64_t(shape.size())).variables(n, tokens, values, kindOf(request)).run();
}

/// Nothing in a list of counts may be negative: reported. The sum.
int64_t sumOf(Building& b, const RtInt* counts, int64_t n) {
    if (!b.may(n, {counts})) return 0;
    const int64_t sum = total(counts, n);
    return b.may(sum, {}) ? sum : 0;
}

/// A scheme and the faces of a subdivision mesh.
void faces(Building& b, const char* scheme, RtInt nfaces, const RtInt* nverts, const RtInt* verts) {
    const int64_t corners = sumOf(b, nverts, nfaces);
    b.text(scheme).ints(nverts, nfaces).ints(verts, corners);
}

/// Its tags, each with `per` counts of arguments. How many integers, floats and strings all have.
std::array<int64_t, 3> tagged(Building& b, RtInt ntags, const RtToken* tags, const RtInt* nargs, int64_t per) {
    std::array<int64_t, 3> all{};
    if (!b.may(ntags, {tags, nargs})) return all;
    for (int64_t i = 0; i < per * ntags; ++i) {
        if (!b.may(nargs[i], {})) return all;
        all[size_t(i % per)] += nargs[i];
    }
    b.texts(tags, ntags).ints(nargs, per * ntags);
    return all;
}

/// Its variables, and the end of the request. They are counted as those of polygons.
void facesVariables(Building& b, RtInt nfaces, const RtInt* nverts, const RtInt* verts, RtInt n, const RtToken* tokens,
                    const RtPointer* values) {
    if (!b.client()) return;
    scene::Primitive p = kindOf("PointsPolygons");
    p.ints.assign(nverts, nverts + nfaces);
    p.ints2.assign(verts, verts + total(nverts, nfaces));
    b.variables(n, tokens, values, p).run();
}

} // namespace

extern "C" {

RtVoid RiPolygonV(RtInt nvertices, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b("Polygon");
    const scene::VariableCounts counts = points(nvertices);
    if (b.may(nvertices, {})) b.parameters(n, tokens, values, &counts).run();
}

RtVoid RiGeneralPolygonV(RtInt nloops, RtInt nverts[], RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b("GeneralPolygon");
    const scene::VariableCounts counts = points(sumOf(b, nverts, nloops));
    b.ints(nverts, nloops).parameters(n, tokens, values, &counts).run();
}

RtVoid RiPointsPolygonsV(RtInt npolys, RtInt nverts[], RtInt verts[], RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b("PointsPolygons");
    const int64_t corners = sumOf(b, nverts, npolys);
    b.ints(nverts, npolys).ints(verts, corners);
    if (!b.client()) return;
    scene::Primitive p = kindOf("PointsPolygons");
    p.ints.assign(nverts, nverts + npolys);
    p.ints2.assign(verts, verts + corners);
    b.variables(n, tokens, values, p).run();
}

RtVoid RiPointsGeneralPolygonsV(RtInt npolys, RtInt nloops[], RtInt nverts[], RtInt verts[], RtInt n, RtToken tokens[],
                                RtPointer values[]) {
    Building b("PointsGeneralPolygons");
    const int64_t loops = sumOf(b, nloops, npolys), corners = sumOf(b, nverts, loops);
    b.ints(nloops, npolys).ints(nverts, loops).ints(verts, corners);
    if (!b.client()) return;
    scene::Primitive p = kindOf("PointsGeneralPolygons");
    p.ints.assign(nloops, nloops + npolys);
    p.ints2.assign(nverts, nverts + loops);
    p.ints3.assign(verts, verts + corners);
    b.variables(n, tokens, values, p).run();
}

RtVoid RiPatchV(RtToken type, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b("Patch");
    b.text(type);
    if (!b.client()) return;
    scene::Primitive p = kindOf("Patch");
    p.strings = {type};
    b.variables(n, tokens, values, p).run();
}

RtVoid RiPatchMeshV(RtToken type, RtInt nu, RtToken uwrap, RtInt nv, RtToken vwrap, RtInt n, RtToken tokens[],
                    RtPointer values[]) {
    Building b("PatchMesh");
    b.text(type).number(nu).text(uwrap).number(nv).text(vwrap);
    if (!b.client()) return;
    scene::Primitive p = kindOf("PatchMesh");
    p.strings = {type, uwrap, vwrap};
    p.ints = {nu, nv};
    b.variables(n, tokens, values, p).run();
}

RtVoid RiNuPatchV(RtInt nu, RtInt uorder, RtFloat uknot[], RtFloat umin, RtFloat umax, RtInt nv, RtInt vorder, RtFloat vknot[],
                  RtFloat vmin, RtFloat vmax, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b("NuPatch");
    const int64_t uknots = int64_t(nu) + uorder, vknots = int64_t(nv) + vorder;
    b.number(nu).number(uorder).numbers(uknot, uknots).number(umin).number(umax);
    b.number(nv).number(vorder).numbers(vknot, vknots).number(vmin).number(vmax);
    if (!b.client()) return;
    scene::Primitive p = kindOf("NuPatch");
    p.ints = {nu, uorder, nv, vorder};
    p.params.resize(2);
    p.params[0].name = "uknot";
    p.params[0].numbers.assign(uknot, uknot + uknots);
    p.params[1].name = "vknot";
    p.params[1].numbers.assign(vknot, vknot + vknots);
    b.variables(n, tokens, values, p).run();
}

RtVoid RiSubdivisionMeshV(RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[], RtInt nargs[],
                          RtInt intargs[], RtFloat floatargs[], RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b("SubdivisionMesh");
    faces(b, scheme, nfaces, nverts, verts);
    const auto args = tagged(b, ntags, tags, nargs, 2);
    b.ints(intargs, args[0]).numbers(floatargs, args[1]);
    facesVariables(b, nfaces, nverts, verts, n, tokens, values);
}

RtVoid RiHierarchicalSubdivisionMeshV(RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[],
                                      RtInt nargs[], RtInt intargs[], RtFloat floatargs[], RtToken stringargs[], RtInt n,
                                      RtToken tokens[], RtPointer values[]) {
    Building b("HierarchicalSubdivisionMesh");
    faces(b, scheme, nfaces, nverts, verts);
    const auto args = tagged(b, ntags, tags, nargs, 3);
    b.ints(intargs, args[0]).numbers(floatargs, args[1]).texts(stringargs, args[2]);
    facesVariables(b, nfaces, nverts, verts, n, tokens, values);
}

RtVoid RiSphereV(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]) {
    quadric("Sphere", {radius, zmin, zmax, thetamax}, n, tokens, values);
}
RtVoid RiConeV(RtFloat height, RtFloat radius, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]) {
    quadric("Cone", {height, radius, thetamax}, n, tokens, values);
}
RtVoid RiCylinderV(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]) {
    quadric("Cylinder", {radius, zmin, zmax, thetamax}, n, tokens, values);
}
RtVoid RiHyperboloidV(RtPoint a, RtPoint b, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]) {
    if (!Building("Hyperboloid").may(1, {a, b})) return;
    quadric("Hyperboloid", {a[0], a[1], a[2], b[0], b[1], b[2], thetamax}, n, tokens, values);
}
RtVoid RiParaboloidV(RtFloat rmax, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]) {
    quadric("Paraboloid", {rmax, zmin, zmax, thetamax}, n, tokens, values);
}
RtVoid RiDiskV(RtFloat height, RtFloat radius, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]) {
    quadric("Disk", {height, radius, thetamax}, n, tokens, values);
}
RtVoid RiTorusV(RtFloat major, RtFloat minor, RtFloat phimin, RtFloat phimax, RtFloat thetamax, RtInt n, RtToken tokens[],
                RtPointer values[]) {
    quadric("Torus", {major, minor, phimin, phimax, thetamax}, n, tokens, values);
}

RtVoid RiPointsV(RtInt npoints, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b("Points");
    const scene::VariableCounts counts = points(npoints);
    if (b.may(npoints, {})) b.parameters(n, tokens, values, &counts).run();
}

RtVoid RiCurvesV(RtToken type, RtInt ncurves, RtInt nvertices[], RtToken wrap, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b("Curves");
    b.text(type).ints(nvertices, ncurves).text(wrap);
    if (!b.client()) return;
    scene::Primitive p = kindOf("Curves");
    p.strings = {type, wrap};
    p.ints.assign(nvertices, nvertices + ncurves);
    b.variables(n, tokens, values, p).run();
}

RtVoid RiBlobbyV(RtInt nleaf, RtInt ncode, RtInt code[], RtInt nfloats, RtFloat floats[], RtInt nstrings, RtString strings[],
                 RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b("Blobby");
    const scene::VariableCounts counts = points(nleaf);
    if (!b.may(nleaf, {})) return;
    b.number(nleaf)
        .ints(code, ncode)
        .numbers(floats, nfloats)
        .texts(strings, nstrings)
        .parameters(n, tokens, values, &counts)
        .run();
}

RtVoid RiVolumeV(RtToken type, RtBound bound, RtInt dimensions[], RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b("Volume");
    b.text(type).numbers(bound, 6).ints(dimensions, 3);
    if (!b.client()) return;
    int64_t cells = 1;
    for (int i = 0; i < 3; ++i) cells *= std::clamp<int64_t>(dimensions[i], 0, 1 << 20);
    const scene::VariableCounts counts = points(cells);
    b.parameters(n, tokens, values, &counts).run();
}

RtVoid RiGeometryV(RtToken type, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building("Geometry").text(type).variables(n, tokens, values, kindOf("Geometry")).run();
}

#define ALPENGLOW_BOTH(name, parameters, arguments, last)                                                                        \
    RtVoid name parameters {                                                                                                     \
        ALPENGLOW_PAIRS(last);                                                                                                   \
        name##V arguments;                                                                                                       \
    }
ALPENGLOW_BOTH(RiPolygon, (RtInt nvertices, ...), (nvertices, ALPENGLOW_LIST), nvertices)
ALPENGLOW_BOTH(RiGeneralPolygon, (RtInt nloops, RtInt nverts[], ...), (nloops, nverts, ALPENGLOW_LIST), nverts)
ALPENGLOW_BOTH(RiPointsPolygons, (RtInt npolys, RtInt nverts[], RtInt verts[], ...), (npolys, nverts, verts, ALPENGLOW_LIST),
               verts)
ALPENGLOW_BOTH(RiPointsGeneralPolygons, (RtInt npolys, RtInt nloops[], RtInt nverts[], RtInt verts[], ...),
               (npolys, nloops, nverts, verts, ALPENGLOW_LIST), verts)
ALPENGLOW_BOTH(RiPatch, (RtToken type, ...), (type, ALPENGLOW_LIST), type)
ALPENGLOW_BOTH(RiPatchMesh, (RtToken type, RtInt nu, RtToken uwrap, RtInt nv, RtToken vwrap, ...),
               (type, nu, uwrap, nv, vwrap, ALPENGLOW_LIST), vwrap)
ALPENGLOW_BOTH(RiNuPatch,
               (RtInt nu, RtInt uorder, RtFloat uknot[], RtFloat umin, RtFloat umax, RtInt nv, RtInt vorder, RtFloat vknot[],
                RtFloat vmin, RtFloat vmax, ...),
               (nu, uorder, uknot, umin, umax, nv, vorder, vknot, vmin, vmax, ALPENGLOW_LIST), vmax)
ALPENGLOW_BOTH(RiSubdivisionMesh,
               (RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[], RtInt nargs[],
                RtInt intargs[], RtFloat floatargs[], ...),
               (scheme, nfaces, nverts, verts, ntags, tags, nargs, intargs, floatargs, ALPENGLOW_LIST), floatargs)
ALPENGLOW_BOTH(RiHierarchicalSubdivisionMesh,
               (RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[], RtInt nargs[],
                RtInt intargs[], RtFloat floatargs[], RtToken stringargs[], ...),
               (scheme, nfaces, nverts, verts, ntags, tags, nargs, intargs, floatargs, stringargs, ALPENGLOW_LIST), stringargs)
ALPENGLOW_BOTH(RiVolume, (RtToken type, RtBound bound, RtInt dimensions[], ...), (type, bound, dimensions, ALPENGLOW_LIST),
               dimensions)
ALPENGLOW_BOTH(RiSphere, (RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, ...),
               (radius, zmin, zmax, thetamax, ALPENGLOW_LIST), thetamax)
ALPENGLOW_BOTH(RiCone, (RtFloat height, RtFloat radius, RtFloat thetamax, ...), (height, radius, thetamax, ALPENGLOW_LIST),
               thetamax)
ALPENGLOW_BOTH(RiCylinder, (RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, ...),
               (radius, zmin, zmax, thetamax, ALPENGLOW_LIST), thetamax)
ALPENGLOW_BOTH(RiHyperboloid, (RtPoint a, RtPoint b, RtFloat thetamax, ...), (a, b, thetamax, ALPENGLOW_LIST), thetamax)
ALPENGLOW_BOTH(RiParaboloid, (RtFloat rmax, RtFloat zmin, RtFloat zmax, RtFloat thetamax, ...),
               (rmax, zmin, zmax, thetamax, ALPENGLOW_LIST), thetamax)
ALPENGLOW_BOTH(RiDisk, (RtFloat height, RtFloat radius, RtFloat thetamax, ...), (height, radius, thetamax, ALPENGLOW_LIST),
               thetamax)
ALPENGLOW_BOTH(RiTorus, (RtFloat major, RtFloat minor, RtFloat phimin, RtFloat phimax, RtFloat thetamax, ...),
               (major, minor, phimin, phimax, thetamax, ALPENGLOW_LIST), thetamax)
ALPENGLOW_BOTH(RiPoints, (RtInt npoints, ...), (npoints, ALPENGLOW_LIST), npoints)
ALPENGLOW_BOTH(RiCurves, (RtToken type, RtInt ncurves, RtInt nvertices[], RtToken wrap, ...),
               (type, ncurves, nvertices, wrap, ALPENGLOW_LIST), wrap)
ALPENGLOW_BOTH(RiBlobby,
               (RtInt nleaf, RtInt ncode, RtInt code[], RtInt nfloats, RtFloat floats[], RtInt nstrings, RtString strings[], ...),
               (nleaf, ncode, code, nfloats, floats, nstrings, strings, ALPENGLOW_LIST), strings)
ALPENGLOW_BOTH(RiGeometry, (RtToken type, ...), (type, ALPENGLOW_LIST), type)

} // extern "C"

std::span<const RifFunction> alpenglow::ri::rifPrimitives() {
#define RIF(member) ALPENGLOW_RIF(member)
    static const RifFunction kList[] = {RIF(PolygonV),
                                        RIF(GeneralPolygonV),
                                        RIF(PointsPolygonsV),
                                        RIF(PointsGeneralPolygonsV),
                                        RIF(PatchV),
                                        RIF(PatchMeshV),
                                        RIF(NuPatchV),
                                        RIF(SubdivisionMeshV),
                                        RIF(HierarchicalSubdivisionMeshV),
                                        RIF(SphereV),
                                        RIF(ConeV),
                                        RIF(CylinderV),
                                        RIF(HyperboloidV),
                                        RIF(ParaboloidV),
                                        RIF(DiskV),
                                        RIF(TorusV),
                                        RIF(PointsV),
                                        RIF(CurvesV),
                                        RIF(BlobbyV),
                                        RIF(GeometryV),
                                        RIF(VolumeV)};
#undef RIF
    return kList;
}
