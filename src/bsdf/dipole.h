// Diffusion below a plane: Jensen and others 2001, and d'Eon's better dipole of 2012.
#pragma once
#include "bsdf/albedoinversion.h"

namespace alpenglow::bsdf {

/// Spread of light below a plane that it enters at one point: diffusion with two sources. Lengths in current space.
class Dipole {
public:
    /// better: the dipole of 2012. absorption, scattering (reduced): coefficients per unit of length.
    Dipole(const AlbedoInversion&, bool better, double absorption, double scattering);
    /// Exitant flux per unit of area at a distance from where unit flux enters.
    double at(double distance) const;
    /// Mean of at() over a disk in the plane with this radius and centre at the distance.
    double over(double distance, double radius) const;
    /// Its integral over the plane.
    double total() const;
    /// density(): sampling density at a distance, per unit of area; choose(): samples a distance from numbers in [0, 1).
    double density(double distance) const;
    /// A distance from two numbers in [0, 1), with that density.
    double choose(float which, float u) const;

private:
    /// Depth of the source below the surface; height of its image; effective attenuation coefficient
    double depth_ = 0, image_ = 0, fall_ = 0;
    double fluence_ = 0, flux_ = 0;  ///< factors of both
    double albedo_ = 0, spread_ = 0; ///< spread: diffusion coefficient
};

} // namespace alpenglow::bsdf
