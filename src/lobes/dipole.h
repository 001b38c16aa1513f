// Diffusion below a plane: Jensen and others 2001, and d'Eon's better dipole of 2012.
#pragma once
#include "lobes/halfspace.h"

namespace alpenglow::transport {

/// How far light spreads below a plane that it enters at one point: diffusion with two sources. Lengths of current space.
class Dipole {
public:
    Dipole(const HalfSpace&, bool better, double absorption, double scattering);
    /// Light that leaves at a distance from where 1 has entered, a unit of area.
    double at(double distance) const;
    /// The mean of at() over a disk of this radius whose middle is at the distance, in the same plane.
    double over(double distance, double radius) const;
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

} // namespace alpenglow::transport
