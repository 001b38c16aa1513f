// Reflectance of an isotropically scattering half space: relation between single-scattering albedo and diffuse reflectance.
#pragma once
#include <vector>

namespace alpenglow::bsdf {

/// Fresnel reflectance for unpolarised light at a smooth boundary, from inside; `index`: of refraction of the inside relative to
/// the outside, > 0; `cosine`: of the angle inside, 0 to 1. 1 for total reflection.
double fresnelInside(double cosine, double index);

/// A half space below a smooth boundary. Light enters from a uniform hemisphere outside, as far as the boundary transmits it;
/// light from below is partly reflected at the boundary, the rest leaves. Exact: Chandrasekhar's H function for isotropic
/// scattering, by quadrature.
class AlbedoInversion {
public:
    /// index: of refraction of the inside relative to the outside, > 0.
    explicit AlbedoInversion(double index);
    /// Fraction of the entering light that leaves again, for a single-scattering albedo from 0 to 1; error below 1e-5.
    double reflectance(double albedo) const;
    /// The albedo with this reflectance, 0 to 1.
    double albedo(double reflectance) const;
    /// Means of the internal reflectance over the hemisphere: 2 and 3 times the integrals of F cos and F cos^2.
    double first() const { return first_; }
    double second() const { return second_; }
    /// As given to the constructor.
    double index() const { return index_; }

private:
    double solve(double albedo) const;
    struct Node {
        double cosine, weight, inside, entering;
    }; ///< inside: fresnelInside(); entering: radiance for a flux of 1
    std::vector<Node> nodes_;
    std::vector<double> table_; ///< by sqrt(1 - albedo), uniform
    double index_ = 1, first_ = 0, second_ = 0;
};

} // namespace alpenglow::bsdf
