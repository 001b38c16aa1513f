// What lies below a surface, as subsurface() and Attribute "subsurface" say it.
#pragma once
#include "lobes/halfspace.h"
#include "world/sites.h"

namespace alpenglow::transport {

/// Coefficients a unit of length of current space.
struct Below {
    Color absorption{0}, scattering{0}, extinction{0};
    float anisotropy = 0, index = 1; ///< index: of refraction, relative to outside
    SubsurfaceSite::Model model = SubsurfaceSite::Model::Walk;
    int group = 0; ///< SubsurfaceWalks::ofShape(): of the shapes that bound it
    Vec3 normal;   ///< about which light enters, unit, out of the surface; 0: that of the geometry
    Vec3 from;     ///< where it enters, if not at the shaded point
    bool elsewhere = false;
};

/// What Attribute "subsurface" says of a shape; < 0: nothing.
struct SubsurfaceValues {
    Color scattering{-1}, absorption{-1}, path{-1}, reflectance{-1};
    float index = 1.3f, scale = 1;
    int samples = -1;
    explicit SubsurfaceValues(const scene::Attributes&);
};

/// Half spaces by their index of refraction. One a thread.
class HalfSpaces {
public:
    const HalfSpace& of(float index);
    /// The albedo of single scattering that gives this reflectance under a model.
    double albedoOf(const Below&, double reflectance);

private:
    std::map<int, HalfSpace> kept_; ///< in 32nds
};

/// What a call says, at a point whose rows are f(row). The group is left to the caller.
Below belowOf(const SubsurfaceSite&, const SubsurfaceValues&, const std::function<float(int)>& f, HalfSpaces&);

} // namespace alpenglow::transport
