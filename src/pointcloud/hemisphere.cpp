#include "pointcloud/hemisphere.h"
#include "base/exact.h"
#include "pointcloud/limits.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::pointcloud {

namespace {
constexpr int kLeastSide = 16, kMostSide = 64;
/// Pixels are as much smaller than the largest cluster that its shape is not all that is seen.
constexpr float kPixelsOfCluster = 7.6f;
/// A disk that contains P is ignored, within this tolerance.
constexpr float kOwnDisk = .02f;
/// A part so far below the plane of a disk, in disk radii, sees nothing of it.
constexpr float kEdgeOn = 1e-4f;

/// Largest height of P above a disk, in disk radii, and smallest cosine between the normals, for the disk to count as P's own
/// surface.
constexpr float kSame = .3f, kAlike = .7f;

/// Coverage of a pixel: squares of clusters do not fit together exactly, so a mostly covered pixel counts as covered; smaller
/// values are unchanged.
float closed(float part) { return part <= .4f ? part : std::min(1.f, .4f + 2 * (part - .4f)); }
} // namespace

void Hemisphere::begin(const HemisphereQuery& q) {
    q_ = q;
    q_.maxSolidAngle = std::clamp(q.maxSolidAngle, 1e-6f, 4.f);
    const int side = std::clamp(int(kPixelsOfCluster / std::sqrt(q_.maxSolidAngle)), kLeastSide, kMostSide);
    if (side != side_) {
        side_ = side;
        directions_.clear();
        angles_.clear();
        for (int face = 0; face < 6; ++face)
            for (int j = 0; j < side; ++j)
                for (int i = 0; i < side; ++i) {
                    Vec3 d(0.f);
                    d[face / 2] = face & 1 ? -1.f : 1.f;
                    d[(face / 2 + 1) % 3] = float(2 * i + 1) / float(side) - 1;
                    d[(face / 2 + 2) % 3] = float(2 * j + 1) / float(side) - 1;
                    const float l = length(d);
                    directions_.push_back(d / l);
                    angles_.push_back(4 / (float(side * side) * l * l * l));
                }
    }
    pixels_.assign(directions_.size(), Pixel{0, 1e38f, 0, 0, 0, Color(0), Color(0)});
    used_.clear();
    fragments_.clear();
    const float cone = float(exact::cos(double(std::clamp(q_.cone, 0.f, kFloatPi))));
    const bool half = dot(q_.axis, q_.axis) > 0;
    double sum = 0;
    for (size_t i = 0; i < pixels_.size(); ++i) {
        const float c = dot(directions_[i], q_.N);
        if (!(c > cone) || (half && !(dot(directions_[i], q_.axis) > 0)) || (!q_.uniform && !(c > 0))) continue;
        pixels_[i].weight = angles_[i] * (q_.uniform ? 1 : c);
        sum += double(pixels_[i].weight);
        used_.push_back(uint32_t(i));
    }
    if (used_.empty() && !half) { // narrower than a pixel
        const uint32_t i = pixelOf(q_.N);
        pixels_[i].weight = 1, sum = 1;
        used_.push_back(i);
    }
    for (const uint32_t i : used_) pixels_[i].weight = float(double(pixels_[i].weight) / sum);
    blocked_ = 0;
    light_ = Color(0);
}

float Hemisphere::fade(float d) const {
    if (!(q_.fall > 0)) return 1;
    if (!q_.polynomial) return float(exact::exp(-double(q_.fall) * double(d)));
    return d < q_.maxDistance ? float(exact::pow(1 - double(d) / double(q_.maxDistance), double(q_.fall))) : 0;
}

uint32_t Hemisphere::pixelOf(const Vec3& d) const {
    const Vec3 a(std::fabs(d.x), std::fabs(d.y), std::fabs(d.z));
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const auto place = [&](int k) { return std::clamp(int((d[k % 3] / a[axis] + 1) * .5f * float(side_)), 0, side_ - 1); };
    return uint32_t(((2 * axis + (d[axis] < 0)) * side_ + place(axis + 2)) * side_ + place(axis + 1));
}

void Hemisphere::cover(uint32_t i, float part, float distance, float kept, const Color& light) {
    Pixel& p = pixels_[i];
    if (!(p.weight > 0)) return;
    if (q_.sort) {
        fragments_.push_back({i, distance, part, light});
        if (fragments_.size() >= limits::kCloudFragments) thin();
        return;
    }
    p.geometric += part;
    p.blocked += part * kept;
    p.light += light * (part * kept);
}

/// A square of this solid angle about a direction.
void Hemisphere::splat(const Vec3& d, float solidAngle, float distance, const Color& light) {
    const Vec3 a(std::fabs(d.x), std::fabs(d.y), std::fabs(d.z));
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2, ku = (axis + 1) % 3, kv = (axis + 2) % 3;
    if (!(a[axis] > 0)) return; // too far away for a direction in float
    const float sign = d[axis] < 0 ? -1.f : 1.f, u = d[ku] / a[axis], v = d[kv] / a[axis];
    const float q = 1 + u * u + v * v, pixel = 4 / (float(side_ * side_) * q * std::sqrt(q));
    const float side = std::clamp(std::sqrt(solidAngle / pixel), 1.f, float(side_));
    const float density = std::min(solidAngle / (side * side * pixel), 1e6f), kept = fade(distance);
    const float x = (u + 1) * .5f * float(side_) - side / 2, y = (v + 1) * .5f * float(side_) - side / 2;
    const uint32_t face = uint32_t(2 * axis + (sign < 0));
    for (int j = int(std::floor(y)); float(j) < y + side; ++j) {
        const float high = std::min(y + side, float(j + 1)) - std::max(y, float(j));
        for (int i = int(std::floor(x)); float(i) < x + side; ++i) {
            const float wide = std::min(x + side, float(i + 1)) - std::max(x, float(i));
            const float part = wide * high * density;
            if (!(part > 0)) continue;
            uint32_t at;
            if (i >= 0 && i < side_ && j >= 0 && j < side_) {
                at = (face * uint32_t(side_) + uint32_t(j)) * uint32_t(side_) + uint32_t(i);
            } else { // over the edge
                Vec3 beyond(0.f);
                beyond[axis] = sign;
                beyond[ku] = float(2 * i + 1) / float(side_) - 1;
                beyond[kv] = float(2 * j + 1) / float(side_) - 1;
                at = pixelOf(beyond);
            }
            cover(at, part, distance, kept, light);
        }
    }
}

void Hemisphere::cluster(const PointOctree::Node& n, const Vec3& to, float distance) {
    Color sent;
    const Vec3 d = to / distance;
    const float area = PointOctree::seenFrom(n, -d, q_.sides, q_.colours ? &sent : nullptr);
    if (area > 0) splat(d, area / (distance * distance), distance, q_.colours ? sent / area : Color(0));
}

void Hemisphere::point(const PointOctree::Point& p) {
    const Vec3 to = p.P - q_.P;
    const float d2 = dot(to, to), r = p.radius();
    if (!std::isfinite(d2)) return; // floats have no area of it
    if (d2 > q_.maxDistance * q_.maxDistance || (q_.cone <= 1.5708f && dot(to, q_.N) < -r)) return;
    // Larger than a pixel, or so near that its tilt is seen: as a disk.
    if (p.area > .5f * d2 * (4 / float(side_ * side_)) || d2 < 16 * r * r) return draw(p, to);
    const float d = std::sqrt(d2);
    if (d < q_.bias) return;
    float area = p.area;
    if (dot(p.N, p.N) > 0) {
        const float c = -dot(p.N, to) / d;
        if ((q_.sides == DiskSides::Front && c < 0) || (q_.sides == DiskSides::Back && c > 0)) return;
        area *= std::fabs(c);
    }
    if (area > 0) splat(to / d, area / d2, d, p.light);
}

void Hemisphere::draw(const PointOctree::Point& p, const Vec3& to) {
    if (dot(p.N, p.N) > 0) {
        const float r = p.radius(), height = std::fabs(dot(to, p.N));
        if (height < kEdgeOn * r) return;
        // On a curved surface P is below the surrounding disks of the same surface.
        if (height < kSame * r && dot(to, to) < 4 * r * r && std::fabs(dot(p.N, q_.N)) > kAlike) return;
    }
    for (int face = 0; face < 6; ++face) drawOnFace(p, to, face);
}

void Hemisphere::drawOnFace(const PointOctree::Point& p, const Vec3& to, int face) {
    const int axis = face / 2, ku = (axis + 1) % 3, kv = (axis + 2) % 3;
    const float r = p.radius(), depth = face & 1 ? -to[axis] : to[axis];
    if (depth + r <= 0 || std::fabs(to[ku]) - r > depth + r || std::fabs(to[kv]) - r > depth + r) return; // outside of the face
    const auto range = [&](float at, int& first, int& last) {
        first = 0, last = side_ - 1;
        if (depth - r <= 0) return; // it may be anywhere on the face
        const float near = depth - r, far = depth + r, lo = at - r, hi = at + r;
        const float least = std::min(lo / near, lo / far), most = std::max(hi / near, hi / far);
        first = std::clamp(int(std::floor((std::max(least, -1.f) + 1) * .5f * float(side_) - .5f)), 0, side_);
        last = std::clamp(int(std::ceil((std::min(most, 1.f) + 1) * .5f * float(side_))), -1, side_ - 1);
        if (least > 1 || most < -1) last = -1;
    };
    int i0, i1, j0, j1;
    range(to[ku], i0, i1);
    range(to[kv], j0, j1);
    const bool ball = !(dot(p.N, p.N) > 0);
    const float height = dot(to, p.N), least = std::max(q_.bias, kOwnDisk * r);
    for (int j = j0; j <= j1; ++j)
        for (int i = i0; i <= i1; ++i) {
            const uint32_t at = (uint32_t(face) * uint32_t(side_) + uint32_t(j)) * uint32_t(side_) + uint32_t(i);
            Pixel& pixel = pixels_[at];
            if (!(pixel.weight > 0)) continue;
            const Vec3 d = directions_[at];
            const float c = ball ? 1 : dot(d, p.N);
            if (c == 0 || (q_.sides == DiskSides::Front && !ball && c > 0) || (q_.sides == DiskSides::Back && !ball && c < 0))
                continue;
            const float t = ball ? dot(to, d) : height / c;
            if (!(t > least) || !(t < pixel.near) || t > q_.maxDistance) continue;
            const Vec3 off = d * t - to;
            if (dot(off, off) > r * r) continue;
            pixel.near = t;
            pixel.nearLight = p.light;
        }
}

void Hemisphere::add(const PointOctree& octree) {
    const auto& nodes = octree.nodes();
    if (nodes.empty()) return;
    stack_.assign(1, 0);
    while (!stack_.empty()) {
        const PointOctree::Node& n = nodes[stack_.back()];
        stack_.pop_back();
        const Vec3 to = n.centre - q_.P;
        const float d2 = dot(to, to), d = std::sqrt(d2);
        if (d - n.reach > q_.maxDistance) continue;
        if (q_.cone <= 1.5708f && dot(to, q_.N) < -n.reach) continue; // below the plane
        const bool cut = d + n.reach > q_.maxDistance || d - n.reach < q_.bias;
        if (!cut && d > 2 * n.reach && solidAngleOf(n.reach, d2) < q_.maxSolidAngle) {
            cluster(n, to, d);
        } else if (n.children) {
            for (uint32_t k = n.children; k-- > 0;) stack_.push_back(n.first + k);
        } else {
            for (uint32_t i = n.begin; i < n.end; ++i) point(octree.points()[i]);
        }
    }
}

void Hemisphere::sortFragments() {
    std::stable_sort(fragments_.begin(), fragments_.end(), [](const Fragment& a, const Fragment& b) {
        return a.pixel != b.pixel ? a.pixel < b.pixel : a.distance < b.distance;
    });
}

/// Removes fragments behind a full pixel, which nothing can make visible. If many remain, each covers little of its pixel;
/// neighbours are then merged in pairs.
void Hemisphere::thin() {
    constexpr size_t kMany = 32;
    static_assert(kMany * 6 * kMostSide * kMostSide <= limits::kCloudFragments * 3 / 4);
    sortFragments();
    size_t to = 0;
    for (size_t i = 0, end; i < fragments_.size(); i = end) {
        for (end = i + 1; end < fragments_.size() && fragments_[end].pixel == fragments_[i].pixel;) ++end;
        size_t seen = end;
        float full = 0;
        for (size_t k = i; k < end && q_.clamp; ++k) {
            Fragment& f = fragments_[k];
            if (!(full < 1)) {
                seen = k;
                break;
            }
            f.cover = std::min(f.cover, 1 - full);
            full += f.cover;
        }
        const size_t step = seen - i > kMany ? 2 : 1;
        for (size_t k = i; k < seen; k += step) {
            Fragment f = fragments_[k];
            if (step == 2 && k + 1 < seen) {
                const Fragment& next = fragments_[k + 1];
                const float cover = f.cover + next.cover, part = cover > 0 ? next.cover / cover : .5f;
                f = {f.pixel, f.distance + (next.distance - f.distance) * part, cover, f.light * (1 - part) + next.light * part};
            }
            fragments_[to++] = f;
        }
    }
    fragments_.resize(to);
}

/// Composites the fragments of each pixel, nearest first, until it is full.
void Hemisphere::compose() {
    for (const uint32_t i : used_)
        if (pixels_[i].near < 1e38f) fragments_.push_back({i, pixels_[i].near, 1, pixels_[i].nearLight});
    sortFragments();
    for (const Fragment& f : fragments_) {
        Pixel& p = pixels_[f.pixel];
        const float part = q_.clamp ? std::min(f.cover, 1 - p.geometric) : f.cover, kept = fade(f.distance);
        if (!(part > 0)) continue;
        p.geometric += part;
        p.blocked += part * kept;
        p.light += f.light * (part * kept);
    }
}

void Hemisphere::finish() {
    if (q_.sort) compose();
    double blocked = 0, light[3] = {};
    for (const uint32_t i : used_) {
        Pixel& p = pixels_[i];
        if (!q_.sort && p.near < 1e38f) { // it hides fragments behind it
            const float kept = fade(p.near);
            if (q_.clamp) p.geometric = 1, p.blocked = kept, p.light = p.nearLight * kept;
            else p.blocked += kept, p.light += p.nearLight * kept;
        }
        const float over = q_.clamp && p.geometric > 0 ? closed(p.geometric) / p.geometric : 1;
        p.blocked *= over;
        p.open = p.weight * std::clamp(1 - p.blocked, 0.f, 1.f);
        blocked += double(p.weight * p.blocked);
        for (int k = 0; k < 3; ++k) light[k] += double(p.weight * p.light[k] * over);
    }
    blocked_ = float(blocked);
    light_ = Color(float(light[0]), float(light[1]), float(light[2]));
}

} // namespace alpenglow::pointcloud
