// Where the hidden hider shades: lattices of micropolygons over (u, v) of each primitive, or over the triangles of its mesh.
// Edges are about sqrt(ShadingRate) pixels long (RISpec, ShadingRate), so a surface is shaded about once a pixel for any number
// of samples.
//
// The step of a lattice depends only on the position of the hit, in quarters of an octave. Other samples and their order change
// no value.
#pragma once
#include "geometry/affine.h"
#include "geometry/dice.h"
#include "integrator/names.h"
#include "shading/gridpoint.h"
#include "world/impl.h"
#include <memory>
#include <optional>

namespace alpenglow::integrator {

/// Identifies a micropolygon, or a corner of micropolygons.
struct MicropolygonKey {
    uint32_t shape = 0, prim = 0; ///< as in accel::Hit
    uint16_t steps[2] = {0, 0};   ///< of the lattice along its two parameters; 0: shaded for one sample alone
    uint16_t at[2] = {0, 0};      ///< cell, or corner, in the lattice
    bool corner = false;
    bool operator==(const MicropolygonKey&) const = default;
    /// It belongs to a lattice, so several samples may see it.
    bool shared() const { return steps[0] > 0; }
    /// Of all members.
    uint64_t hash() const;
};

/// The weight, 0 to 1, of a micropolygon in a sample. b1, b2: where it is shaded on its primitive, as in accel::Hit; for a
/// shared() one set by Micropolygons::place().
struct MicropolygonShare {
    MicropolygonKey key; ///< which micropolygon
    double b1 = 0, b2 = 0;
    float weight = 1;
};

/// Pixel size and eye for all lattices: a pinhole camera at shutter open.
struct MicropolygonCamera {
    /// From resolution, projection and screen window.
    explicit MicropolygonCamera(const scene::Options&);
    bool perspective; ///< else orthographic
    float pixel;      ///< side of a pixel in camera space: at distance 1 along the axis (perspective), or anywhere (orthographic)
    /// Unit direction from the eye to a point.
    Vec3 towards(const Vec3& p) const { return perspective && dot(p, p) > 0 ? normalize(p) : Vec3(0, 0, 1); }
    /// Side of a pixel at the distance of a point, camera space.
    float pixelAt(const Vec3& p) const { return perspective ? pixel * length(p) : pixel; }
};

/// Finds the micropolygons that camera samples see. One per thread; the world must outlive it.
class Micropolygons {
public:
    /// The world has been built.
    explicit Micropolygons(const WorldImpl&);
    /// A micropolygon that a hit sees.
    struct Found {
        uint32_t hit;            ///< index of the hit
        MicropolygonShare share; ///< and its weight
    };
    /// Finds the micropolygons of each valid hit, in order of hits: one, or with ShadingInterpolation "smooth" up to four corners
    /// whose weights sum to 1. points: positions of the hits, camera space.
    void find(std::span<const accel::Hit> hits, std::span<const Vec3> points, std::vector<Found>&);
    /// Sets the position at which a micropolygon from find() is shaded.
    void place(MicropolygonShare&) const;
    /// Change of u and v over a micropolygon from find(). Lattice over parameters: its steps. Lattice over a triangle: at least
    /// the change along each edge, with a product of at least its area in (u, v). If the footprint of the ray is at least one and
    /// a half times longer, the footprint counts. Both 0: no lattice, or constant parameters.
    Vec2 stepsOf(const MicropolygonShare&, const Vec2& footprint);

private:
    enum class Kind : uint8_t {
        Single,    ///< hits without parameters for a lattice: shaded sample by sample
        Triangles, ///< rays meet the mesh
        Surface,   ///< one parametric surface, intersected exactly
        Pieces     ///< many small pieces: curves, points
    };
    typedef float Four __attribute__((vector_size(16)));
    /// dPdu and dPdv of a large surface at the corners of cells, uniform in u and v.
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
        std::optional<geometry::Affine> place; ///< from the mesh to camera space; none: identity
        float edge = 1;                        ///< of a micropolygon, pixels
        bool smooth = false, paired = false;
        bool large = false;                 ///< a surface that covers many pixels: steps come from a table,
        std::unique_ptr<Partials> partials; ///< which is made at the first hit
    };
    /// Lengths of steps at a point as seen from the eye.
    struct Seen {
        Vec3 P;
        float inverse, scale;
        Seen(const MicropolygonCamera&, const Vec3& at, float edge);
        float edges(const Vec3& step) const;       ///< length in edges of micropolygons, squared
        float edges(const Four (&steps)[3]) const; ///< the largest of four
    };
    struct Lengths {
        float u, v;
        uint32_t prim; ///< number under which all parts of a piece share their lattice
    };
    /// The triangle of the last span query; a large triangle has many cells.
    struct Corners {
        uint32_t shape = geometry::kNone, prim = 0;
        geometry::SurfacePoint at[3];
    };
    Lattice latticeOf(uint32_t shape) const;
    const Lattice& lattice(uint32_t shape);
    /// Change of u and v over a cell; 0 as in stepsOf().
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
    std::vector<std::unique_ptr<Lattice>> lattices_; ///< by shape; null: not yet hit
    std::vector<uint32_t> tabled_;                   ///< shapes with Partials
    std::unordered_map<uint64_t, Lengths> pieces_;   ///< by shape and primitive
    std::vector<geometry::SurfacePoint> surfaces_;   ///< of a run of hits of one surface
    std::vector<geometry::HitRef> run_;
    Corners corners_;
};

} // namespace alpenglow::integrator
