// Where a sky is bright: a table over directions, from which light samples are drawn in proportion to what the sky's shader
// gives,
// whatever it makes that of: maps of any form, or arithmetic.
#pragma once
#include "texture/texture.h"
#include <vector>

namespace alpenglow::transport {

/// Directions in cells of latitude and longitude (poles along z of current space). A cell is drawn in proportion to its weight
/// times its
/// solid angle, a direction in it evenly by solid angle. Draws keep the strata of their numbers.
class SkyTable {
public:
    /// weights: radiance of the cells as luminance, rows from the pole down, `width` numbers each. Such as are negative or no
    /// numbers count
    /// as 0.
    SkyTable(int width, int height, std::vector<float> weights);
    /// Integral of the weights over the sphere; 0: nothing can be drawn.
    double integral() const { return integral_; }
    /// Mean square over the square of the mean: 1 for an even sky, about 1 / part for one that is bright in that part of it
    /// alone.
    double concentration() const { return concentration_; }
    /// A direction of length 1 and its density per steradian, which is pdf(w) exactly; false: none.
    bool sample(Vec2 u, Vec3& w, float& density) const;
    /// Density per steradian with which sample() gives a direction of length 1.
    float pdf(const Vec3& w) const;
    /// The direction at (s, t) of a cell, both from 0 to 1.
    static Vec3 direction(int column, int row, int width, int height, float s, float t);

private:
    size_t rowOf(double cosine) const;
    int width_, height_;
    double integral_ = 0, concentration_ = 1;
    std::vector<double> cosines_; ///< height + 1: of the angles between rows, 1 to -1
    std::vector<float> density_;  ///< by cell
    std::vector<float> rows_;     ///< cumulative, height + 1
    std::vector<float> columns_;  ///< cumulative in the row, by row width + 1
};

} // namespace alpenglow::transport
