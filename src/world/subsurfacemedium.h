// Materials below surfaces: subsurface() and Attribute "subsurface".
#pragma once
#include "bsdf/albedoinversion.h"
#include "world/sites.h"

namespace alpenglow::world {

/// Coefficients per unit of length in current space.
struct SubsurfaceMedium {
    Color absorption{0}, scattering{0}, extinction{0};         ///< by channel
    float anisotropy = 0, index = 1;                           ///< index: relative index of refraction
    SubsurfaceSite::Model model = SubsurfaceSite::Model::Walk; ///< how light spreads
    int group = 0;          ///< SubsurfaceWalks::ofShape(): group of the shapes that bound the material
    Vec3 normal;            ///< unit outward normal where light enters; 0: the surface's
    Vec3 from;              ///< where light enters, if not at the shaded point
    bool ownOrigin = false; ///< `from` counts
};

/// Attribute "subsurface" of a shape; < 0: not set.
struct SubsurfaceValues {
    /// Coefficients per unit of length; mean free path; diffuse reflectance.
    Color scattering{-1}, absorption{-1}, path{-1}, reflectance{-1};
    float index = 1.3f, scale = 1; ///< relative index of refraction; unit of length in current space
    int samples = -1;              ///< of a call
    /// Of the attributes, or none.
    explicit SubsurfaceValues(const scene::Attributes&);
};

/// AlbedoInversion by index of refraction. Use one a thread.
class AlbedoInversions {
public:
    /// Computed at first use.
    const AlbedoInversion& of(float index);
    /// Single-scattering albedo with this diffuse reflectance under a model (albedo inversion).
    double albedoOf(const SubsurfaceMedium&, double reflectance);

private:
    std::map<int, AlbedoInversion> kept_; ///< by index of refraction in 32nds
};

/// Reads the arguments of a call; f(row) gives its rows at a point. Does not set the group.
SubsurfaceMedium subsurfaceMediumOf(const SubsurfaceSite&, const SubsurfaceValues&, const std::function<float(int)>& f,
                                    AlbedoInversions&);

} // namespace alpenglow::world
