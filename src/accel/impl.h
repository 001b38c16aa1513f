// The inside of an Accel: what counts as a hit. Not for other rooms.
#pragma once
#include "accel/accel.h"
#include "accel/direct.h"
#include "accel/directblock.h"
#include "accel/solids.h"
#include "accel/tree.h"
#include "geometry/placed.h"
#include "geometry/quadricform.h"
#include <cmath>
#include <utility>

namespace alpenglow::accel {

using geometry::Shape;
using geometry::ShapeRef;

struct Best {
    double t;
    uint32_t shape, prim;
    double b1, b2;
};

struct Query {
    const Ray* ray;
    Best best;
    bool any; // occlusion
};

inline bool before(double t, uint32_t shape, uint32_t prim, const Best& b) {
    if (t != b.t) return t < b.t;
    if (shape != b.shape) return shape < b.shape;
    return prim < b.prim;
}

// Exact shapes of a scene that is looked through directly.
constexpr size_t kDirectExact = 4;
// Weights of a triangle may be this far outside of it: twice what double arithmetic makes of a ray through a shared edge, so that
// none slips between two triangles.
constexpr double kEdge = 1e-12;
// Neighbours that a ray meets along their edge are this far apart at most: single precision, in which they were found once.
constexpr double kSame = 1e-6;

/// Beyond kEdge: what double arithmetic can make of the weights where a triangle is a sliver, or small and far from the origin of
/// the ray.
inline double edgeRoom(const Vec3d& org, const Vec3d& d, const Vec3d& fa, const Vec3d& fb, const Vec3d& fc) {
    const auto norm = [](const Vec3d& v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z); };
    const Vec3d a = fa - org, e1 = fb - fa, e2 = fc - fa;
    const double den = std::fabs(dot(cross(e1, e2), d));
    return den > 0 ? kEdge + 0x1p-48 * norm(a) * norm(d) * (norm(e1) + norm(e2)) / den : 0;
}

inline bool usable(const Vec3& org, const Vec3& dir) {
    // An infinite far end is usual; anything else infinite or NaN would wander through every box.
    constexpr float kFar = 1e18f;
    auto near = [](float c) { return std::fabs(c) < kFar; };
    // Without branches: nearly all rays pass.
    return int(near(org.x)) & int(near(org.y)) & int(near(org.z)) & int(near(dir.x)) & int(near(dir.y)) & int(near(dir.z)) &
           int((std::fabs(dir.x) + std::fabs(dir.y) + std::fabs(dir.z)) > 0);
}
inline bool usable(const Ray& r) { return bool(int(r.tnear < r.tfar) & int(usable(r.org, r.dir))); }

struct Accel::Impl {
    std::vector<ShapeRef> shapes;
    std::vector<uint32_t> visibility;
    std::vector<Levels> levels; ///< empty: all are met
    geometry::Bounds bounds;
    bool sound = true;
    Tree tree;
    std::unique_ptr<Solids> solids; ///< null: there are none
    bool ofSolid(uint32_t s) const { return solids && solids->in(s); }

    std::vector<geometry::QuadricForm> forms; ///< of the shapes that have one
    std::vector<uint32_t> formNumbers;        ///< by shape, into forms, or kNone; empty: none has one
    void readyForms();
    const geometry::QuadricForm* formOf(uint32_t s) const {
        return formNumbers.empty() || formNumbers[s] == kNone ? nullptr : &forms[formNumbers[s]];
    }

    /// Scenes of few primitives have no tree.
    struct Ball {
        uint32_t shape;
        Vec3d centre;
        double radius2;
    }; ///< an exact shape and a sphere around it
    bool direct = false;
    DirectTriangles triangles;
    std::vector<Ball> balls;
    Ball ballAround(uint32_t shape) const;
    bool readyDirect();
    void refuse(Diagnostics&);
    static void sayBeyond(const Tree&, const Shape& first, Diagnostics&);
    void meetDirect(Query&) const;
    /// The same over blocks of rays. directblock.cpp
    std::shared_ptr<const DirectScene> blockScene; ///< null: the scene has a tree
    bool anyOneSided = false;                      ///< some shape of it
    void readyBlocks();
    bool takesBlocks() const;
    bool beginsPlainly(const Ray&) const;
    uint32_t loadBlock(std::span<const Ray>, DirectRays&) const;
    void nearestInBlocks(std::span<const Ray>, std::span<Hit>) const;
    void anyInBlocks(std::span<const Ray>, std::span<uint8_t>) const;
    void nearestInBlock(const DirectRays&, uint32_t rays, const float* time, Hit*) const;
    void anyInBlock(const DirectRays&, uint32_t rays, const float* time, uint8_t*) const;

    bool visible(const Ray& r, uint32_t s) const {
        return (visibility[s] & r.mask) != 0 && (!r.only || r.only[s]) &&
               (levels.empty() || (r.level >= levels[s].from && r.level < levels[s].to));
    }
    static bool excluded(const Ray& r, uint32_t s, uint32_t prim) {
        return r.excludeShape == s && (r.excludePrim == kNone || r.excludePrim == prim);
    }

    /// A ray that goes on behind a triangle through its edge has met the neighbours as well, those that show it the same side: it
    /// leaves a small thing far away right behind where it came in.
    bool sameCrossing(const Ray& r, uint32_t s, double t, const Vec3& a, const Vec3& b, const Vec3& c) const {
        if (!(t <= r.passed * (1 + kSame)) || r.excludeShape != s || r.excludePrim == kNone) return false;
        const geometry::TriMesh& m = shapes[s]->mesh();
        const uint32_t* last = &m.index[3 * size_t(r.excludePrim)];
        const auto side = [&](const Vec3& p, const Vec3& q, const Vec3& w) {
            return dot(cross(Vec3d(q) - Vec3d(p), Vec3d(w) - Vec3d(p)), Vec3d(r.dir)) > 0;
        };
        if (side(a, b, c) != side(m.P[last[0]], m.P[last[1]], m.P[last[2]])) return false;
        for (int k = 0; k < 3; ++k) // by place: meshes have a seam where they close
            if (const Vec3& p = m.P[last[k]]; p == a || p == b || p == c) return true;
        return false;
    }

    /// False: take() will not, whatever is met there.
    static bool mayTake(const Query& q, double t) { return t > q.ray->tnear && t < q.ray->tfar && (q.any || !(t > q.best.t)); }
    /// Whether a candidate counts; then q.best is it. t is ours. away(): how far its normal points along the ray, if one-sided.
    template <class Away> bool take(Query& q, uint32_t s, uint32_t prim, double t, double b1, double b2, Away away) const {
        const Ray& r = *q.ray;
        if (!mayTake(q, t)) return false;
        if (t <= r.passed && (t < r.passed || std::pair(s, prim) <= std::pair(r.excludeShape, r.excludePrim))) return false;
        if (!q.any && !before(t, s, prim, q.best)) return false;
        if (!trimmed.empty() && trimmed[s] && !trimmed[s]->keepsHit(prim, b1, b2)) return false;
        if (shapes[s]->oneSided() && r.sides != Sides::Both && (away() >= 0) != (r.sides == Sides::Back)) return false;
        if (ofSolid(s) && !solids->keeps(r, s, t)) return false;
        q.best = {t, s, prim, b1, b2};
        return true;
    }
    bool take(Query& q, uint32_t s, uint32_t prim, double t, double b1, double b2) const {
        return take(q, s, prim, t, b1, b2, [&] { return dot(shapes[s]->hitNormal(prim, b1, b2), Vec3d(q.ray->dir)); });
    }
    /// Whether a candidate triangle is met and counts: then q.best is it.
    [[gnu::always_inline]] bool meetOne(Query& q, uint32_t s, uint32_t prim, const Vec3& a, const Vec3& b, const Vec3& c) const {
        const Ray& r = *q.ray;
        if (!visible(r, s) || excluded(r, s, prim)) return false;
        double t, b1, b2, outside;
        if (!meetTriangle(Vec3d(r.org), Vec3d(r.dir), Vec3d(a), Vec3d(b), Vec3d(c), t, b1, b2, outside,
                          [&](double at) { return mayTake(q, at); }))
            return false;
        if (outside > kEdge && outside > edgeRoom(Vec3d(r.org), Vec3d(r.dir), Vec3d(a), Vec3d(b), Vec3d(c))) return false;
        return !sameCrossing(r, s, t, a, b, c) && take(q, s, prim, t, b1, b2);
    }

    /// Points of an exact primitive count behind this t. The one that the ray goes on behind may be met again (a ball twice),
    /// another that lies at its place and comes after it is yet to be met there.
    static double exactFrom(const Ray& r, uint32_t s, uint32_t prim) {
        const double near = r.tnear;
        if (r.passed < 0) return near;
        if (s == r.excludeShape && prim == r.excludePrim)
            return std::max(near, double(std::nextafter(float(r.passed), INFINITY)));
        return std::max(near,
                        std::pair(s, prim) < std::pair(r.excludeShape, r.excludePrim) ? r.passed : std::nextafter(r.passed, 0.0));
    }
    Shape::Wanted wantedOf(const Query& q, uint32_t s, const Shape& shape) const {
        return (shape.oneSided() && q.ray->sides != Sides::Both) || ofSolid(s) ? Shape::Wanted::All
               : q.any                                                         ? Shape::Wanted::Any
                                                                               : Shape::Wanted::Nearest;
    }
    /// Tries all points of one primitive of an exact shape, or of a shape that is placed; true when one was taken.
    bool meetExact(Query& q, uint32_t s, uint32_t prim) const {
        const Ray& r = *q.ray;
        if (!visible(r, s)) return false;
        if (isPlaced(s)) return meetPlaced(q, s);
        if (r.passed < 0 && excluded(r, s, prim)) return false;
        geometry::ExactHit h[4];
        const Shape& shape = *shapes[s];
        const double from = exactFrom(r, s, prim), to = std::min(double(r.tfar), q.best.t);
        int n = shape.exactHits(prim, Vec3d(r.org), Vec3d(r.dir), from, to, wantedOf(q, s, shape), h);
        bool taken = false;
        for (int i = 0; i < n; ++i) {
            taken |= take(q, s, prim, h[i].t, h[i].u, h[i].v);
            if (taken && q.any) break;
        }
        return taken;
    }

    /// A geometry, in its own space, for all its places.
    struct Geometry {
        ShapeRef shape;
        Tree tree; ///< empty: one exact primitive
    };
    std::vector<std::unique_ptr<Geometry>> geometries;
    std::vector<uint32_t> geometryOf; ///< by shape: into geometries, or kNone; empty: nothing is placed
    bool isPlaced(uint32_t s) const { return !geometryOf.empty() && geometryOf[s] != kNone; }
    const Geometry& geometryAt(uint32_t s) const { return *geometries[geometryOf[s]]; } ///< of a shape that is placed
    /// A shape whose geometry has a tree, as rays come into it.
    struct alignas(128) Place {
        geometry::Affine in; ///< to the geometry's space, where it stands still
        const Geometry* geometry;
        const geometry::Placed* placed;
        const geometry::Deforming* deforming; ///< or null
        uint32_t shape;
        bool moves;
    };
    std::vector<Place> places; ///< Tree::Exact::shape of a part is into it
    bool placesMove = false;   ///< some of them do, or are of what deforms
    void readyPlaced();
    /// Boxes of what is placed, each of a part of its geometry's tree: a ray comes to the parts that it may meet, the nearest
    /// first, and passes what overlaps them (Benthin, Woop, Wald, Afra, "Improved Two-Level BVHs using Partial Re-Braiding",
    /// HPG 2017).
    std::vector<Tree::Part> partsOfPlaces();
    void buildTree(Building b = Building::Best) { tree.build(shapes, {}, {}, partsOfPlaces(), b); } ///< after readyPlaced()
    std::vector<const Shape*> trimmed; ///< by shape: who knows what of it is cut away, or null; empty: nothing is
    void readyTrimmed();
    /// A ray in the space of a placed geometry.
    struct Inside {
        const Geometry* geometry;
        const geometry::Placed* place;
        uint32_t shape;
        Vec3d org, dir;
    };
    /// A placed geometry that has no tree; others are walked into (tree_walk.inc).
    bool meetPlaced(Query&, uint32_t s) const;
    bool meetInside(Query&, const Inside&, uint32_t prim, const Vec3d& a, const Vec3d& b, const Vec3d& c) const;
    bool meetInside(Query&, const Inside&, uint32_t prim) const; ///< one primitive of an exact geometry
    bool sameCrossing(const Query&, const Inside&, double t, const Vec3d corner[3]) const;

    bool intersectOne(const Ray&, Hit&) const;
    bool occludedOne(const Ray&) const;
    /// plain: with the instructions that every processor has.
    void walkNearest(std::span<const Ray>, std::span<Hit>, bool plain = false, const StopFlag* stop = nullptr) const;
    void walkNearestTogether(std::span<const Ray>, std::span<Hit>, bool plain = false, const StopFlag* stop = nullptr) const;
    void walkAny(std::span<const Ray>, std::span<uint8_t>, const StopFlag* stop = nullptr) const;
};

} // namespace alpenglow::accel
