#include "scene/primitivekinds.h"
#include "base/exact.h"
#include <limits>

namespace alpenglow::scene {
namespace {

constexpr int64_t kMax = std::numeric_limits<int>::max();

bool fail(std::string* why, std::string text) {
    if (why) *why = std::move(text);
    return false;
}

/// Points given by P, Pw or Pz, whichever is there.
int64_t points(const Primitive& p) {
    if (auto* v = find(p.params, "P")) return int64_t(v->numbers.size() / 3);
    if (auto* v = find(p.params, "Pw")) return int64_t(v->numbers.size() / 4);
    if (auto* v = find(p.params, "Pz")) return int64_t(v->numbers.size());
    return 0;
}

/// Sum of counts that must each be at least `least`.
bool sum(const std::vector<int>& n, int least, int64_t* total, const char* what, std::string* why) {
    int64_t s = 0;
    for (int v : n) {
        if (v < least) return fail(why, std::string(what) + " contains " + std::to_string(v));
        s += v;
    }
    *total = s;
    return true;
}

bool faces(const std::vector<int>& nverts, const std::vector<int>& verts, VariableCounts* c, std::string* why) {
    int64_t total = 0;
    if (!sum(nverts, 3, &total, "a face's vertex count", why)) return false;
    if (total != int64_t(verts.size()))
        return fail(why, "the faces need " + std::to_string(total) + " vertex indices, not " + std::to_string(verts.size()));
    int64_t most = -1;
    for (int v : verts) {
        if (v < 0) return fail(why, "vertex index " + std::to_string(v) + " is negative");
        most = std::max<int64_t>(most, v);
    }
    c->varying = c->vertex = most + 1;
    c->faceVarying = total;
    return true;
}

/// Patches and varying corners along one direction of a bicubic mesh. A periodic one takes its first points again behind its
/// last, so it may have fewer than four.
bool cubicSpan(int64_t n, int step, bool periodic, const char* dir, int64_t* patches, int64_t* corners, std::string* why) {
    if (n < (periodic ? 2 : 4) || (periodic ? n : n - 4) % step != 0)
        return fail(why, std::to_string(n) + " control points in " + dir + " do not fit a basis of step " + std::to_string(step));
    *patches = periodic ? n / step : (n - 4) / step + 1;
    *corners = periodic ? *patches : *patches + 1;
    return true;
}

bool patchMesh(const Primitive& p, VariableCounts* c, std::string* why) {
    int64_t n[2] = {p.ints[0], p.ints[1]}, patches[2], corners[2];
    bool cubic = p.strings[0] == "bicubic";
    for (int i = 0; i < 2; ++i) {
        bool periodic = p.strings[size_t(i) + 1] == "periodic";
        const char* dir = i == 0 ? "u" : "v";
        if (cubic) {
            int step = !p.attributes ? 3 : i == 0 ? p.attributes->ubasis.step : p.attributes->vbasis.step;
            if (!cubicSpan(n[i], std::max(step, 1), periodic, dir, &patches[i], &corners[i], why)) return false;
        } else {
            if (n[i] < 2) return fail(why, std::string("fewer than 2 control points in ") + dir);
            patches[i] = periodic ? n[i] : n[i] - 1;
            corners[i] = n[i];
        }
    }
    c->uniform = patches[0] * patches[1];
    c->varying = c->faceVarying = corners[0] * corners[1];
    c->vertex = n[0] * n[1];
    return true;
}

bool nuPatch(const Primitive& p, VariableCounts* c, std::string* why) {
    const Param* knots[2] = {find(p.params, "uknot"), find(p.params, "vknot")};
    int64_t segments[2];
    for (int i = 0; i < 2; ++i) {
        int64_t n = p.ints[size_t(i) * 2], order = p.ints[size_t(i) * 2 + 1];
        const char* dir = i == 0 ? "u" : "v";
        if (order < 1 || n < order)
            return fail(why, std::to_string(n) + " control points in " + dir + " for order " + std::to_string(order));
        if (!knots[i] || int64_t(knots[i]->numbers.size()) != n + order)
            return fail(why, std::string("the ") + dir + " knot vector needs " + std::to_string(n + order) + " values");
        if (!std::is_sorted(knots[i]->numbers.begin(), knots[i]->numbers.end()))
            return fail(why, std::string("the ") + dir + " knots decrease");
        segments[i] = n - order + 1;
    }
    c->uniform = segments[0] * segments[1];
    c->varying = c->faceVarying = (segments[0] + 1) * (segments[1] + 1);
    c->vertex = int64_t(p.ints[0]) * p.ints[2];
    return true;
}

bool curves(const Primitive& p, VariableCounts* c, std::string* why) {
    bool cubic = p.strings[0] == "cubic", periodic = p.strings[1] == "periodic";
    int step = std::max(p.attributes ? p.attributes->vbasis.step : 3, 1);
    c->uniform = int64_t(p.ints.size());
    for (int n : p.ints) {
        if (n < 2) return fail(why, "a curve has " + std::to_string(n) + " points");
        int64_t segments, corners = n;
        if (cubic && !cubicSpan(n, step, periodic, "a curve", &segments, &corners, why)) return false;
        c->varying += corners;
        c->vertex += n;
    }
    c->faceVarying = c->varying;
    return true;
}

bool subdivision(const Primitive& p, VariableCounts* c, std::string* why) {
    c->uniform = int64_t(p.ints.size());
    if (!faces(p.ints, p.ints2, c, why)) return false;
    size_t tags = p.strings.size() - 1, per = p.kind == "SubdivisionMesh" ? 2 : 3;
    if (p.ints3.size() != per * tags)
        return fail(why, std::to_string(tags) + " tags need " + std::to_string(per * tags) + " argument counts, not " +
                             std::to_string(p.ints3.size()));
    int64_t needed[3] = {0, 0, 0};
    for (size_t i = 0; i < p.ints3.size(); ++i) {
        if (p.ints3[i] < 0) return fail(why, "a tag has a negative argument count");
        needed[i % per] += p.ints3[i];
    }
    const Param *ints = find(p.params, "intargs"), *floats = find(p.params, "floatargs");
    if (needed[0] != int64_t(ints ? ints->numbers.size() : 0))
        return fail(why, "the tags' integer arguments do not match their counts");
    if (needed[1] != int64_t(floats ? floats->numbers.size() : 0))
        return fail(why, "the tags' float arguments do not match their counts");
    const Param* strings = find(p.params, "stringargs");
    if (needed[2] != int64_t(strings ? strings->strings.size() : 0))
        return fail(why, "the tags' string arguments do not match their counts");
    return true;
}

bool all(int64_t n, VariableCounts* c) {
    c->varying = c->vertex = c->faceVarying = n;
    return true;
}
bool corners(const Primitive&, VariableCounts* c, std::string*) { return all(4, c); }
bool single(const Primitive&, VariableCounts* c, std::string*) { return all(1, c); }
bool cloud(const Primitive& p, VariableCounts* c, std::string*) { return all(points(p), c); }

bool polygon(const Primitive& p, VariableCounts* c, std::string* why) {
    all(points(p), c);
    return c->vertex >= 3 || fail(why, "a polygon needs at least 3 points");
}
bool generalPolygon(const Primitive& p, VariableCounts* c, std::string* why) {
    int64_t n = 0;
    if (p.ints.empty()) return fail(why, "there are no loops");
    return sum(p.ints, 3, &n, "a loop's vertex count", why) && all(n, c);
}
bool polygons(const Primitive& p, VariableCounts* c, std::string* why) {
    c->uniform = int64_t(p.ints.size());
    return (!p.ints.empty() || fail(why, "there are no faces")) && faces(p.ints, p.ints2, c, why);
}
bool generalPolygons(const Primitive& p, VariableCounts* c, std::string* why) {
    int64_t loops = 0;
    if (p.ints.empty()) return fail(why, "there are no faces");
    if (!sum(p.ints, 1, &loops, "a face's loop count", why)) return false;
    if (loops != int64_t(p.ints2.size()))
        return fail(why, "the faces need " + std::to_string(loops) + " loops, not " + std::to_string(p.ints2.size()));
    c->uniform = int64_t(p.ints.size());
    return faces(p.ints2, p.ints3, c, why);
}
bool patch(const Primitive& p, VariableCounts* c, std::string*) {
    all(4, c);
    if (p.strings[0] == "bicubic") c->vertex = 16;
    return true;
}
bool blobs(const Primitive& p, VariableCounts* c, std::string* why) {
    const int64_t leaves = p.ints.empty() ? 0 : p.ints[0];
    if (leaves < 0 || leaves > kMax) return fail(why, "a negative number of leaves");
    return all(leaves, c);
}

using Numbers = std::span<const float>;
float at(Numbers n, size_t i) { return i < n.size() ? n[i] : 0.f; }

void sphereBox(Numbers n, ObjectBox& box) {
    const float r = std::fabs(at(n, 0));
    box.turn(r, std::clamp(at(n, 1), -r, r), std::clamp(at(n, 2), -r, r));
}
void coneBox(Numbers n, ObjectBox& box) { box.turn(at(n, 1), 0, at(n, 0)); }
void sweptBox(Numbers n, ObjectBox& box) { box.turn(at(n, 0), at(n, 1), at(n, 2)); }
void hyperboloidBox(Numbers n, ObjectBox& box) {
    box.turn(std::max(exact::hypot(at(n, 0), at(n, 1)), exact::hypot(at(n, 3), at(n, 4))), at(n, 2), at(n, 5));
}
void diskBox(Numbers n, ObjectBox& box) { box.turn(at(n, 1), at(n, 0), at(n, 0)); }
void torusBox(Numbers n, ObjectBox& box) {
    const float r = std::fabs(at(n, 1));
    box.turn(std::fabs(at(n, 0)) + r, -r, r);
}
void volumeBox(Numbers n, ObjectBox& box) {
    if (n.size() < 6) return;
    box.add(n[0], n[2], n[4]);
    box.add(n[1], n[3], n[5]);
}

constexpr std::string_view kKnots[] = {"uknot", "vknot"}, kTagArguments[] = {"intargs", "floatargs", "stringargs"};

constexpr PrimitiveKind kPrimitiveKinds[] = {
    {"Sphere", kSurface | kQuadric, corners, sphereBox},
    {"Cone", kSurface | kQuadric, corners, coneBox},
    {"Cylinder", kSurface | kQuadric, corners, sweptBox},
    {"Hyperboloid", kSurface | kQuadric, corners, hyperboloidBox},
    {"Paraboloid", kSurface | kQuadric, corners, sweptBox},
    {"Disk", kSurface | kQuadric, corners, diskBox},
    {"Torus", kSurface | kQuadric, corners, torusBox},
    {"Polygon", kSurface | kHasPoints, polygon},
    {"GeneralPolygon", kSurface | kHasPoints, generalPolygon},
    {"PointsPolygons", kSurface | kMesh | kHasPoints | kMayBeEmpty, polygons},
    {"PointsGeneralPolygons", kSurface | kMesh | kHasPoints | kMayBeEmpty, generalPolygons},
    {"Patch", kSurface | kHasPoints | kPatch | kTakesBasis, patch},
    {"PatchMesh", kSurface | kHasPoints | kPatch | kTakesBasis, patchMesh},
    {"NuPatch", kSurface | kHasPoints, nuPatch, nullptr, kKnots},
    {"SubdivisionMesh", kSurface | kMesh | kHasPoints | kMayBeEmpty, subdivision, nullptr, kTagArguments},
    {"HierarchicalSubdivisionMesh", kSurface | kMesh | kHasPoints, subdivision, nullptr, kTagArguments},
    {"Points", kSurface | kHasPoints | kPieces | kTurnsToEye | kMayBeEmpty, cloud},
    {"Curves", kSurface | kHasPoints | kTakesBasis | kPieces | kTurnsToEye | kMayBeEmpty, curves},
    {"Blobby", kSurface | kPieces, blobs},
    {"Geometry", kSurface, single},
    {"Volume", 0, single, volumeBox},
};

} // namespace

const PrimitiveKind* primitiveKind(std::string_view name) {
    const auto found = std::find_if(std::begin(kPrimitiveKinds), std::end(kPrimitiveKinds),
                                    [&](const PrimitiveKind& k) { return k.name == name; });
    return found == std::end(kPrimitiveKinds) ? nullptr : found;
}

} // namespace alpenglow::scene
