// Implementation of Accel: rules of what counts as a hit. Internal to accel.
#pragma once
#include "accel/accel.h"
#include "accel/bvh.h"
#include "accel/direct.h"
#include "accel/directblock.h"
#include "accel/solids.h"
#include "geometry/placed.h"
#include "geometry/quadricform.h"
#include <cmath>
#include <utility>

namespace alpenglow::accel {

using geometry::Shape;
using geometry::ShapeRef;

/// The nearest candidate so far, in units of the ray's direction.
struct Best {
    double t;             ///< distance in lengths of Ray::dir
    uint32_t shape, prim; ///< indices of the shape, and of the primitive in it
    double b1, b2;        ///< as Hit::b1 and b2
};

/// A ray under way, and what it has found.
struct Query {
    const Ray* ray;
    Best best;                      ///< nearest hit so far
    bool any;                       // occlusion
    const StopFlag* stop = nullptr; ///< ends long searches in solids; may be null
};

/// The order of hits: by distance, then shape, then primitive.
inline bool before(double t, uint32_t shape, uint32_t prim, const Best& b) {
    if (t != b.t) return t < b.t;
    if (shape != b.shape) return shape < b.shape;
    return prim < b.prim;
}

// Maximum number of exact shapes in a scene searched directly.
constexpr size_t kDirectExact = 4;
// Tolerance of triangle weights: twice the double error for a ray through a shared edge, so that no ray slips between two
// triangles.
constexpr double kEdge = 1e-12;
// Largest distance between hits of neighbours at their common edge: single precision, in which the first was stored.
constexpr double kSame = 1e-6;

/// Additional tolerance: double error of the weights for slivers, and for triangles that are small and far from the ray origin.
inline double edgeRoom(const Vec3d& org, const Vec3d& d, const Vec3d& fa, const Vec3d& fb, const Vec3d& fc) {
    const auto norm = [](const Vec3d& v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z); };
    const Vec3d a = fa - org, e1 = fb - fa, e2 = fc - fa;
    const double den = std::fabs(dot(cross(e1, e2), d));
    return den > 0 ? kEdge + 0x1p-48 * norm(a) * norm(d) * (norm(e1) + norm(e2)) / den : 0;
}

/// Whether a ray is finite and has a direction; others hit nothing.
inline bool usable(const Vec3& org, const Vec3& dir) {
    // An infinite far end is usual; other infinite values or NaN would traverse every box.
    constexpr float kFar = 1e18f;
    auto near = [](float c) { return std::fabs(c) < kFar; };
    // Without branches: nearly all rays pass.
    return int(near(org.x)) & int(near(org.y)) & int(near(org.z)) & int(near(dir.x)) & int(near(dir.y)) & int(near(dir.z)) &
           int((std::fabs(dir.x) + std::fabs(dir.y) + std::fabs(dir.z)) > 0);
}
inline bool usable(const Ray& r) { return bool(int(r.tnear < r.tfar) & int(usable(r.org, r.dir))); }

/// The shapes, their tree or their list, and the tests of candidates.
struct Accel::Impl {
    std::vector<ShapeRef> shapes;
    std::vector<uint32_t> visibility; ///< a mask for each shape; empty: kAll
    std::vector<Levels> levels;       ///< empty: all are visible
    geometry::Bounds bounds;          ///< of all shapes, camera space
    bool sound = true;                ///< Accel::sound()
    Bvh tree;
    std::unique_ptr<Solids> solids; ///< null: there are none
    /// Whether the shape is a part of a solid.
    bool ofSolid(uint32_t s) const { return solids && solids->in(s); }

    std::vector<geometry::QuadricForm> forms; ///< of shapes that have one
    std::vector<uint32_t> formNumbers;        ///< by shape: index in forms, or kNone; empty: no forms
    /// Fills `forms`.
    void readyForms();
    /// The equation of a shape; null: it has none.
    const geometry::QuadricForm* formOf(uint32_t s) const {
        return formNumbers.empty() || formNumbers[s] == kNone ? nullptr : &forms[formNumbers[s]];
    }

    /// Scenes of few primitives have no tree.
    struct Ball {
        uint32_t shape; ///< index in shapes
        Vec3d centre;   ///< camera space
        double radius2; ///< squared radius
    }; ///< an exact shape and its bounding sphere
    bool direct = false;
    DirectTriangles triangles;
    std::vector<Ball> balls;
    /// The bounding sphere of an exact shape.
    Ball ballAround(uint32_t shape) const;
    /// Prepares a scene without a tree; false: it has too many primitives.
    bool readyDirect();
    /// Reports that there are too many primitives for a tree; nothing is hit then.
    void refuse(Diagnostics&);
    /// Warns of triangles that Bvh::beyond() left out.
    static void sayBeyond(const Bvh&, const Shape& first, Diagnostics&);
    /// Searches the primitives of a scene without a tree.
    void intersectDirect(Query&) const;
    /// The same for blocks of rays (directblock.cpp).
    std::shared_ptr<const DirectScene> blockScene; ///< null: the scene has a tree
    bool anyOneSided = false;                      ///< some shape is one-sided
    /// Fills blockScene.
    void readyBlocks();
    /// Whether 16 rays can be searched together.
    bool takesBlocks() const;
    /// Whether a ray fits a block: new, finite, without a subset, and from both sides unless no shape is one-sided.
    bool beginsPlainly(const Ray&) const;
    /// Copies rays into a block; returns those that fit it, as bits.
    uint32_t loadBlock(std::span<const Ray>, DirectRays&) const;
    /// Accel::intersect() by blocks; rays that fit none are traced one by one.
    void nearestInBlocks(std::span<const Ray>, std::span<Hit>) const;
    /// Accel::occluded() by blocks.
    void anyInBlocks(std::span<const Ray>, std::span<uint8_t>) const;
    /// Search one block; `rays`: those of it that count, as bits.
    void nearestInBlock(const DirectRays&, uint32_t rays, const float* time, Hit*) const;
    void anyInBlock(const DirectRays&, uint32_t rays, const float* time, uint8_t*) const;

    /// Whether the ray considers a shape at all: by mask, subset and level of detail.
    bool visible(const Ray& r, uint32_t s) const {
        return (visibility[s] & r.mask) != 0 && (!r.only || r.only[s]) &&
               (levels.empty() || (r.level >= levels[s].from && r.level < levels[s].to));
    }
    /// Whether the primitive is the one that the ray ignores.
    static bool excluded(const Ray& r, uint32_t s, uint32_t prim) {
        return r.excludeShape == s && (r.excludePrim == kNone || r.excludePrim == prim);
    }

    /// A ray that continues behind a triangle through its edge has also hit the neighbours that face the same way, so that it
    /// does not hit a small distant object twice at its entry.
    bool sameCrossing(const Ray& r, uint32_t s, double t, const Vec3& a, const Vec3& b, const Vec3& c) const {
        if (!(t <= r.passed * (1 + kSame)) || r.excludeShape != s || r.excludePrim == kNone) return false;
        const geometry::TriMesh& m = shapes[s]->mesh();
        const uint32_t* last = &m.index[3 * size_t(r.excludePrim)];
        const auto side = [&](const Vec3& p, const Vec3& q, const Vec3& w) {
            return dot(cross(Vec3d(q) - Vec3d(p), Vec3d(w) - Vec3d(p)), Vec3d(r.dir)) > 0;
        };
        if (side(a, b, c) != side(m.P[last[0]], m.P[last[1]], m.P[last[2]])) return false;
        for (int k = 0; k < 3; ++k) // by position: closed meshes have a seam
            if (const Vec3& p = m.P[last[k]]; p == a || p == b || p == c) return true;
        return false;
    }

    /// Returns false if take() cannot accept a hit at t.
    static bool mayTake(const Query& q, double t) { return t > q.ray->tnear && t < q.ray->tfar && (q.any || !(t > q.best.t)); }
    /// Whether a candidate counts; q.best is then set to it. away(): component of its normal along the ray, for one-sided shapes.
    template <class Away> bool take(Query& q, uint32_t s, uint32_t prim, double t, double b1, double b2, Away away) const {
        const Ray& r = *q.ray;
        if (!mayTake(q, t)) return false;
        if (t <= r.passed && (t < r.passed || std::pair(s, prim) <= std::pair(r.excludeShape, r.excludePrim))) return false;
        if (!q.any && !before(t, s, prim, q.best)) return false;
        if (!trimmed.empty() && trimmed[s] && !trimmed[s]->keepsHit(prim, b1, b2)) return false;
        if (shapes[s]->oneSided() && r.sides != Sides::Both && (away() >= 0) != (r.sides == Sides::Back)) return false;
        if (ofSolid(s) && !solids->keeps(r, s, t, q.stop)) return false;
        q.best = {t, s, prim, b1, b2};
        return true;
    }
    /// The same where the normal is that of the shape at the hit.
    bool take(Query& q, uint32_t s, uint32_t prim, double t, double b1, double b2) const {
        return take(q, s, prim, t, b1, b2, [&] { return dot(shapes[s]->hitNormal(prim, b1, b2), Vec3d(q.ray->dir)); });
    }
    /// Whether a candidate triangle is hit and counts; q.best is then set to it.
    [[gnu::always_inline]] bool meetOne(Query& q, uint32_t s, uint32_t prim, const Vec3& a, const Vec3& b, const Vec3& c) const {
        const Ray& r = *q.ray;
        if (!visible(r, s) || excluded(r, s, prim)) return false;
        double t, b1, b2, outside;
        if (!intersectTriangle(Vec3d(r.org), Vec3d(r.dir), Vec3d(a), Vec3d(b), Vec3d(c), t, b1, b2, outside,
                               [&](double at) { return mayTake(q, at); }))
            return false;
        if (outside > kEdge && outside > edgeRoom(Vec3d(r.org), Vec3d(r.dir), Vec3d(a), Vec3d(b), Vec3d(c))) return false;
        return !sameCrossing(r, s, t, a, b, c) && take(q, s, prim, t, b1, b2);
    }

    /// Smallest t of valid hits on an exact primitive. The primitive that the ray continues behind may be hit again (a sphere
    /// twice); another one at the same position that comes later in order has yet to be hit.
    static double exactFrom(const Ray& r, uint32_t s, uint32_t prim) {
        const double near = r.tnear;
        if (r.passed < 0) return near;
        if (s == r.excludeShape && prim == r.excludePrim)
            return std::max(near, double(std::nextafter(float(r.passed), INFINITY)));
        return std::max(near,
                        std::pair(s, prim) < std::pair(r.excludeShape, r.excludePrim) ? r.passed : std::nextafter(r.passed, 0.0));
    }
    /// Which hits on an exact primitive are needed: all where a rule may reject the nearest.
    Shape::Wanted wantedOf(const Query& q, uint32_t s, const Shape& shape) const {
        return (shape.oneSided() && q.ray->sides != Sides::Both) || ofSolid(s) ? Shape::Wanted::All
               : q.any                                                         ? Shape::Wanted::Any
                                                                               : Shape::Wanted::Nearest;
    }
    /// Tries all hits of one primitive of an exact or instanced shape; returns true if one was accepted.
    bool intersectExact(Query& q, uint32_t s, uint32_t prim) const {
        const Ray& r = *q.ray;
        if (!visible(r, s)) return false;
        if (isPlaced(s)) return intersectPlaced(q, s);
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

    /// A geometry in its own space, for all its instances.
    struct Geometry {
        ShapeRef shape; ///< in its own space
        Bvh tree;       ///< empty: one exact primitive
    };
    std::vector<std::unique_ptr<Geometry>> geometries;
    std::vector<uint32_t> geometryOf; ///< by shape: index in geometries, or kNone; empty: no instances
    /// Whether the shape is an instanced geometry.
    bool isPlaced(uint32_t s) const { return !geometryOf.empty() && geometryOf[s] != kNone; }
    const Geometry& geometryAt(uint32_t s) const { return *geometries[geometryOf[s]]; } ///< of an instanced shape
    /// An instance of a geometry with a tree, prepared for rays.
    struct alignas(128) Place {
        geometry::Affine in; ///< to the geometry's space, if it does not move
        const Geometry* geometry;
        const geometry::Placed* placed;       ///< the instance
        const geometry::Deforming* deforming; ///< or null
        uint32_t shape;                       ///< index in shapes
        bool moves;                           ///< its place changes during the shutter
    };
    std::vector<Place> places; ///< Bvh::Exact::shape of a part is an index in it
    bool placesMove = false;   ///< some of them move or deform
    /// Fills geometries and places.
    void readyPlaced();
    /// Boxes of instances, each of a part of the geometry's tree: a ray visits the parts that it may hit, nearest first, and
    /// skips overlapping ones (Benthin, Woop, Wald, Afra, "Improved Two-Level BVHs using Partial Re-Braiding", HPG 2017).
    std::vector<Bvh::Part> partsOfPlaces();
    void buildTree(Building b = Building::Best) { tree.build(shapes, {}, {}, partsOfPlaces(), b); } ///< after readyPlaced()
    std::vector<const Shape*> trimmed; ///< by shape: trim information, or null; empty: none
    /// Fills `trimmed`.
    void readyTrimmed();
    /// A ray in the space of an instanced geometry.
    struct Inside {
        const Geometry* geometry;
        const geometry::Placed* place; ///< the instance
        uint32_t shape;                ///< index in shapes of the instance
        Vec3d org, dir;                ///< in the space of the geometry; t is that of the ray in camera space
    };
    /// An instanced geometry without a tree; others are traversed (bvh_walk.inc).
    bool intersectPlaced(Query&, uint32_t s) const;
    /// One triangle of an instanced geometry.
    bool intersectInside(Query&, const Inside&, uint32_t prim, const Vec3d& a, const Vec3d& b, const Vec3d& c) const;
    bool intersectInside(Query&, const Inside&, uint32_t prim) const; ///< one primitive of an exact geometry
    /// sameCrossing() for corners in the space of the geometry.
    bool sameCrossing(const Query&, const Inside&, double t, const Vec3d corner[3]) const;

    /// One ray, by tree or list.
    bool intersectOne(const Ray&, Hit&) const;
    /// One ray, whether it hits anything.
    bool occludedOne(const Ray&) const;
    /// plain: with the baseline instruction set.
    void walkNearest(std::span<const Ray>, std::span<Hit>, bool plain = false, const StopFlag* stop = nullptr) const;
    /// The same for coherent rays, and for occlusion.
    void walkNearestTogether(std::span<const Ray>, std::span<Hit>, bool plain = false, const StopFlag* stop = nullptr) const;
    void walkAny(std::span<const Ray>, std::span<uint8_t>, const StopFlag* stop = nullptr) const;
};

} // namespace alpenglow::accel
