// Where the hidden hider shades: lattices of micropolygons over (u, v) of each primitive, or over the triangles of its mesh.
// Edges are about sqrt(ShadingRate) pixels long (RISpec, ShadingRate), so that a surface is shaded about once a pixel, however
// many samples see it.
//
// The steps of a lattice follow from where a ray meets the surface, in quarters of an octave, and from nothing else: which other
// samples there are, and in which order they come, changes no value.
#pragma once
#include "geometry/affine.h"
#include "geometry/dice.h"
#include "shading/gridpoint.h"
#include "world/impl.h"
#include <memory>
#include <optional>

namespace alpenglow::transport {

/// Names a micropolygon, or a corner of some, among all.
struct MicropolygonKey {
    uint32_t shape = 0, prim = 0;
    uint16_t steps[2] = {0, 0}; ///< of the lattice along its two parameters; 0: the point is shaded for one sample alone
    uint16_t at[2] = {0, 0};    ///< its cell, or corner, of the lattice
    bool corner = false;
    bool operator==(const MicropolygonKey&) const = default;
    bool shared() const { return steps[0] > 0; }
    uint64_t hash() const;
};

/// What a sample takes of a micropolygon: `weight`, 0 to 1, of what it shows. b1, b2: where on its primitive it is shaded, as
/// accel::Hit has them; of one that is shared(), after Micropolygons::place().
struct MicropolygonShare {
    MicropolygonKey key;
    double b1 = 0, b2 = 0;
    float weight = 1;
};

/// A pixel and the eye, as all lattices see them: the lens is a point, the shutter has just opened.
struct MicropolygonCamera {
    explicit MicropolygonCamera(const scene::Options&);
    bool perspective;
    float pixel; ///< side of a pixel at distance 1 along the axis; orthographic: anywhere; camera space
    /// Unit direction in which the eye sees a point.
    Vec3 towards(const Vec3& p) const { return perspective && dot(p, p) > 0 ? normalize(p) : Vec3(0, 0, 1); }
    /// Side of a pixel at a point.
    float pixelAt(const Vec3& p) const { return perspective ? pixel * length(p) : pixel; }
};

/// Finds the micropolygons that camera samples see. Of one thread; the world must outlive it.
class Micropolygons {
public:
    explicit Micropolygons(const WorldImpl&);
    struct Found {
        uint32_t hit; ///< number
        MicropolygonShare share;
    };
    /// Finds what each valid hit takes of micropolygons: of one, or with ShadingInterpolation "smooth" of up to four corners,
    /// whose weights sum to 1. By hit in their order. points: where the hits are, camera space.
    void find(std::span<const accel::Hit> hits, std::span<const Vec3> points, std::vector<Found>&);
    /// Says where a micropolygon that was found is shaded.
    void place(MicropolygonShare&) const;
    /// What u and v change by over a micropolygon that find() has named. Of a lattice over parameters: its steps. Of one over a
    /// triangle: as much as along either of its edges, and so that their product is no less than its area in (u, v). Where the
    /// footprint of the ray is longer by half and more, it counts. Both 0: it has no lattice, or its parameters do not change.
    Vec2 stepsOf(const MicropolygonShare&, const Vec2& footprint);

private:
    enum class Kind : uint8_t {
        Single,    ///< its hits have no parameters that a lattice could have: shaded sample by sample
        Triangles, ///< rays meet the mesh
        Surface,   ///< one parametric surface, met exactly
        Pieces     ///< many small ones: curves, points
    };
    typedef float Four __attribute__((vector_size(16)));
    /// dPdu and dPdv of a surface that covers many pixels, at the corners of cells evenly spaced over u and v.
    struct Partials {
        static constexpr int kCells = 16; ///< along each parameter
        struct Cell {
            Four u[3], v[3]; ///< by component, then corner
        };
        Cell cells[kCells][kCells]; ///< by v, then u
    };
    struct Lattice {
        Kind kind = Kind::Single;
        const geometry::TriMesh* mesh = nullptr;
        std::optional<geometry::Affine> place; ///< of the mesh, to camera space; none: it is there
        float edge = 1;                        ///< of a micropolygon, pixels
        bool smooth = false, paired = false;
        bool large = false;                 ///< a surface that covers many pixels: steps are from a table,
        std::unique_ptr<Partials> partials; ///< which is made when it is met
    };
    /// How the eye sees steps at a point.
    struct Seen {
        Vec3 P;
        float inverse, scale;
        Seen(const MicropolygonCamera&, const Vec3& at, float edge);
        float edges(const Vec3& step) const;       ///< its length in edges of micropolygons, squared
        float edges(const Four (&steps)[3]) const; ///< the greatest of four
    };
    struct Lengths {
        float u, v;
        uint32_t prim; ///< under which all parts of a piece that rays meet one by one have their lattice
    };
    /// Of the triangle whose span was asked for last: a large one has many cells.
    struct Corners {
        uint32_t shape = geometry::kNone, prim = 0;
        geometry::SurfacePoint at[3];
    };
    Lattice latticeOf(uint32_t shape) const;
    const Lattice& lattice(uint32_t shape);
    /// What u and v change by over a cell; 0 as stepsOf().
    Vec2 spanOf(const Lattice&, const MicropolygonShare&);
    Vec2 spanOfTriangle(const Lattice&, const MicropolygonShare&);
    template <class Take> void ofTriangle(const Lattice&, const accel::Hit&, const Vec3& P, Take) const;
    const Partials& partialsOf(uint32_t shape);
    template <class Take> void ofSurfaces(const Lattice&, std::span<const accel::Hit>, std::span<const Vec3> P, Take);
    template <class Take> void ofParameters(const Lattice&, MicropolygonShare, Take) const;
    bool pair(const geometry::TriMesh&, MicropolygonShare&) const;
    struct Triangle {
        Vec3 p[3];
    };
    Triangle triangleOf(const Lattice&, uint32_t prim) const;
    Lengths lengthsOf(uint32_t shape, uint32_t prim);
    const WorldImpl& world_;
    MicropolygonCamera camera_;
    std::vector<std::unique_ptr<Lattice>> lattices_; ///< by shape; null: no ray has met it
    std::vector<uint32_t> tabled_;                   ///< shapes that have Partials
    std::unordered_map<uint64_t, Lengths> pieces_;   ///< by shape and primitive
    std::vector<geometry::SurfacePoint> surfaces_;   ///< of a run of hits of one surface
    std::vector<geometry::HitRef> run_;
    Corners corners_;
};

} // namespace alpenglow::transport
