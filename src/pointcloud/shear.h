// Point clouds in a space that is not a similarity transform of the scene's: visibility uses angles of the scene.
#pragma once
#include "base/matrix.h"
#include "pointcloud/pointcloud.h"
#include <array>
#include <optional>

namespace alpenglow::pointcloud {

/// p * matrix() has the distances between points of the scene, but for one factor: a lower triangular matrix of determinant 1.
struct Shear {
    std::array<int64_t, 6> entries{}; ///< in rows, in units of 2^-14
    /// The entries as a matrix.
    Matrix matrix() const;
    auto operator<=>(const Shear&) const = default;
};

/// For the transformation from the scene to a cloud's space. Unset: it preserves angles, or has no inverse.
std::optional<Shear> shearOf(const Matrix& toCloud);

/// How much larger the area of a surface is behind a matrix; `n`: its unit normal.
float areaGrowth(const Matrix&, const Vec3& n);

/// Points, normals, radii and areas of a cloud behind a matrix.
void transform(PointCloud&, const Matrix&);

} // namespace alpenglow::pointcloud
