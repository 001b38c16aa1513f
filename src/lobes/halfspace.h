// What a half space gives back that scatters evenly in all directions: the relation between the albedo of single scattering and
// the reflectance that is seen.
#pragma once
#include <vector>

namespace alpenglow::transport {

/// Reflection of unpolarised light at a smooth boundary, seen from inside; `index`: of refraction of the inside relative to the
/// outside, > 0; `cosine`: of the angle inside, 0 to 1. 1 where all is reflected.
double fresnelInside(double cosine, double index);

/// A half space below a smooth boundary. Light enters as from outside evenly from all directions, as much of it as passes the
/// boundary; what comes back up is reflected in part there, the rest leaves. Exact: Chandrasekhar's H function of isotropic
/// scattering, by quadrature.
class HalfSpace {
public:
    explicit HalfSpace(double index);
    /// The part of what entered that leaves again, for the albedo of single scattering, 0 to 1; error below 1e-5.
    double reflectance(double albedo) const;
    /// The albedo that has this reflectance, 0 to 1.
    double albedo(double reflectance) const;
    /// Means of the reflection inside over the hemisphere: 2 and 3 times the integrals of F cos and F cos^2.
    double first() const { return first_; }
    double second() const { return second_; }
    double index() const { return index_; }

private:
    double solve(double albedo) const;
    struct Node {
        double cosine, weight, inside, entering;
    }; ///< inside: fresnelInside(); entering: radiance for a flux of 1
    std::vector<Node> nodes_;
    std::vector<double> table_; ///< by sqrt(1 - albedo), evenly
    double index_ = 1, first_ = 0, second_ = 0;
};

} // namespace alpenglow::transport
