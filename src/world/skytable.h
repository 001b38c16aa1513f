// A table of a sky's radiance over directions, for sampling in proportion to radiance. Works for any shader: maps of any
// projection, or arithmetic.
#pragma once
#include "texture/texture.h"
#include "world/names.h"
#include <vector>

namespace alpenglow::world {

/// Cells of latitude and longitude (poles along z of current space). A cell is sampled in proportion to its weight times its
/// solid angle, a direction within it uniformly by solid angle, or by the weights of its own finer cells. Sampling preserves the
/// stratification of its numbers.
class SkyTable {
public:
    /// A cell divided into side x side parts of equal solid angle.
    struct Refined {
        int column = 0, row = 0, side = 1; ///< position of the cell; 1: it is not divided
        std::vector<float> weights;        ///< in rows from the pole; their mean becomes the weight of the cell
    };
    /// weights: luminance of the cells, in rows from the pole, `width` numbers each. Negative values and NaN count as 0.
    /// refined: each cell at most once. Parts are sampled with at least kLeastPart of the density of their cell.
    SkyTable(int width, int height, std::vector<float> weights, std::vector<Refined> refined = {});
    static constexpr float kLeastPart = .03f;
    /// Integral of the weights over the sphere; 0: nothing can be sampled.
    double integral() const { return integral_; }
    /// Mean square over squared mean: 1 for a uniform sky, about 1 / f for one that is bright in a fraction f only.
    double concentration() const { return concentration_; }
    /// Samples a unit direction and its density per steradian, which equals pdf(w) exactly; returns false if integral() is 0.
    bool sample(Vec2 u, Vec3& w, float& density) const;
    /// Density of sample() per steradian for a unit direction.
    float pdf(const Vec3& w) const;
    /// The direction at (s, t) in a cell, both in [0, 1].
    static Vec3 direction(int column, int row, int width, int height, float s, float t);

private:
    struct Parts {
        int side = 1;
        std::vector<float> rows, columns; ///< cumulative, as those of the table
        std::vector<float> density;       ///< per steradian
    };
    size_t rowOf(double cosine) const;
    void divide(size_t cell, Refined&);
    int width_, height_;
    double integral_ = 0, concentration_ = 1;
    std::vector<double> cosines_; ///< height + 1 cosines of the angles between rows, 1 to -1
    std::vector<float> density_;  ///< by cell; < 0: a refined one, whose parts are parts_[-1 - density]
    std::vector<Parts> parts_;
    std::vector<float> rows_;    ///< cumulative, height + 1
    std::vector<float> columns_; ///< cumulative within a row: row after row, width + 1 each
};

} // namespace alpenglow::world
