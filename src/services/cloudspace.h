// Conversion between spaces of shaders and of point cloud files.
#pragma once
#include "base/direction.h"
#include "base/exact.h"
#include "pointcloud/shear.h"
#include "services/services.h"
#include "world/information.h"
#include <utility>

namespace alpenglow::services {

/// Three rows of arguments from this one on; zero if row is negative.
inline Vec3 tripleAt(const ServiceCall& call, int row, int lane) {
    return row < 0 ? Vec3(0.f) : Vec3(call.at(row, lane), call.at(row + 1, lane), call.at(row + 2, lane));
}

/// From "current" to the named space, or to the space named in a row of the lane.
inline Matrix toCloudSpace(Services& answers, const ServiceCall& call, const std::string& name, int row, int lane,
                           const ShadePoint& p) {
    const std::string space = row < 0 ? name : rsl::internedString(std::bit_cast<int32_t>(call.at(row, lane)));
    return spaceAt(answers.world(), "current", space.empty() ? "world" : space, p, call.binding(answers.world(), lane));
}

/// Mean scale factor of lengths by a matrix.
inline float growth(const Matrix& m) { return float(exact::pow(std::fabs(determinant3(m)), 1.0 / 3)); }

/// n with length 1; zero where it has no direction.
inline Vec3 unitOr0(const Vec3& n) { return directionOr(n, Vec3(0.f)); }

/// A normal in the space that m leads to, unit or zero.
inline Vec3 normalTo(const Matrix& m, const Vec3& n) { return unitOr0(Vec3(transformNormal(m, Vec3d(n)))); }

/// Conversion from "current" to the space of a file, for the points of a call; computed once if it is the same for all.
/// `straight`: to a space with the angles of "current", if the file's differ (pointcloud/shear.h).
class CloudSpace {
public:
    /// row: of the argument that names the space, or -1.
    CloudSpace(Services& answers, const ServiceCall& call, const std::string& name, int row, bool straight = false)
        : services_(answers), call_(call), name_(name), row_(row), same_(row < 0 && name != "object" && name != "shader"),
          straight_(straight) {}
    /// For the point of a lane; valid until the next call.
    const Matrix& at(int lane, const ShadePoint& p) {
        if (!known_ || !same_) {
            to_ = toCloudSpace(services_, call_, name_, row_, lane, p);
            growth_ = services::growth(to_);
            shear_ = pointcloud::shearOf(to_);
            if (straight_ && shear_) to_ = to_ * shear_->matrix();
            known_ = true, turned_ = false;
        }
        return to_;
    }
    float growth() const { return growth_; } ///< of lengths
    /// Scale factor of an area with unit normal `n`. Not for straight ones.
    float areaGrowth(const Vec3& n) const { return shear_ && dot(n, n) > 0 ? pointcloud::areaGrowth(to_, n) : growth_ * growth_; }
    /// Nothing: the space has the angles of "current".
    const std::optional<pointcloud::Shear>& shear() const { return shear_; }
    /// The inverse of the last at().
    const Matrix& back() {
        if (!std::exchange(turned_, true)) back_ = inverse(to_);
        return back_;
    }

private:
    Services& services_;
    const ServiceCall& call_;
    const std::string& name_;
    const int row_;
    const bool same_, straight_;
    bool known_ = false, turned_ = false;
    Matrix to_, back_;
    float growth_ = 1;
    std::optional<pointcloud::Shear> shear_;
};

} // namespace alpenglow::services
