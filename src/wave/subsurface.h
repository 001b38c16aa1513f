// Light that walks below surfaces: subsurface().
#pragma once
#include "wave/engine.h"
#include "wave/halfspace.h"

namespace alpenglow::transport {

/// What Attribute "subsurface" says; < 0: nothing.
struct Engine::SubsurfaceOfShape {
    Color scattering{-1}, absorption{-1}, path{-1}, reflectance{-1};
    float index = 1.3f, scale = 1;
    int samples = -1;
    int group = 0;
};

/// How far light spreads below a plane that it enters at one point: diffusion with two sources. Lengths of current space.
class Dipole {
public:
    Dipole(const HalfSpace&, bool better, double absorption, double scattering);
    /// Light that leaves at a distance from where 1 has entered, a unit of area.
    double at(double distance) const;
    /// Its integral over the plane.
    double total() const;
    /// With how much of it points are chosen at a distance, a unit of area; a distance for numbers of [0, 1).
    double density(double distance) const;
    double choose(float which, float u) const;

private:
    double depth_ = 0, image_ = 0, fall_ = 0; ///< of the source below the surface, of its image above; 1 / diffuse mean free path
    double fluence_ = 0, flux_ = 0;           ///< factors of both
    double albedo_ = 0, spread_ = 0;          ///< spread: the diffusion coefficient
};

/// The walks that a batch has asked for, and where they come out: points that gather light as diffuse() does.
class Walks {
public:
    Walks(Engine& e, BatchContext& c, std::span<const WalkAsked> asked, std::span<const Below> below)
        : e_(e), c_(c), asked_(asked), below_(below) {}
    void run(Sched&);

private:
    struct Walker {
        int asked;
        Vec3 at, dir;
        Color weight, begin;
        uint32_t vertex;
        int inside = 1, steps = 0;
    };
    struct Exit {
        int asked;
        Color weight;
        uint32_t vertex;
        uint32_t shape;
        geometry::SurfacePoint point;
        Vec3 out; ///< unit normal of the surface, away from its inside
    };
    void start(int asked);
    void step();
    bool scatter(Walker&, double distance);
    bool meet(Walker&, const accel::Hit&, double reached);
    void probe(int asked);
    void weigh(Walker&, double way, bool scatters) const;
    double distance(const Walker&) const;
    void gatherAt(std::span<const Exit>, Sched&);
    void skies(const BatchContext&, Sched&);
    bool belongs(uint32_t shape, int group) const;
    accel::Ray rayOf(const Walker&, double length) const;

    Engine& e_;
    BatchContext& c_;
    std::span<const WalkAsked> asked_;
    std::span<const Below> below_;
    std::vector<Walker> walkers_, going_;
    std::vector<Exit> exits_;
};

} // namespace alpenglow::transport
