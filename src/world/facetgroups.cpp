#include "world/facetgroups.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::world {

using geometry::Shape;
using geometry::SurfacePoint;

namespace {
constexpr uint32_t kFewestFacets = 32, kMostFacets = 1u << 22;

/// Where a number lies in an interval, 0 to 1.
double restOf(double x, double begin, double end) { return end > begin ? std::clamp((x - begin) / (end - begin), 0.0, 1.0) : .5; }
} // namespace

bool FacetGroups::has(const Shape& s) {
    if (s.exact() || s.placed() || s.trimmed() || s.facesRays() || !s.source().primitive) return false;
    const uint32_t n = s.mesh().triangles();
    static_assert(kFewestFacets >= kGroups); // each group has a facet
    return n >= kFewestFacets && n <= kMostFacets;
}

struct FacetGroups::Builder {
    struct Facet {
        Vec3d centre, normal; ///< normal: unit, or 0
        double area = 0;
    };
    FacetGroups& to;
    std::vector<Facet> facets;
    double extent = 0; ///< makes places comparable to normals

    double coordinate(uint32_t t, int k) const { return k < 3 ? facets[t].centre[k] : .5 * extent * facets[t].normal[k - 3]; }
    std::pair<int, int> widest(std::span<const uint32_t>) const;
    void sort(std::span<uint32_t>, int coordinate) const;
    void makeStrips(std::span<uint32_t>, double area);
    void split(std::span<uint32_t>, int group, int groups);
    void finish(int group, std::span<uint32_t>);
};

/// The two coordinates in which some facets vary most, of the place or of the normal.
std::pair<int, int> FacetGroups::Builder::widest(std::span<const uint32_t> some) const {
    std::array<std::pair<double, int>, 6> variance;
    for (int k = 0; k < 6; ++k) {
        double sum = 0, squares = 0, area = 0;
        for (const uint32_t t : some) {
            const double x = coordinate(t, k), a = facets[t].area;
            sum += a * x;
            squares += a * x * x;
            area += a;
        }
        variance[size_t(k)] = {area > 0 ? sum * sum / (area * area) - squares / area : 0, k};
    }
    std::sort(variance.begin(), variance.end());
    return {variance[0].second, variance[1].second};
}

void FacetGroups::Builder::sort(std::span<uint32_t> some, int k) const {
    std::sort(some.begin(), some.end(), [&](uint32_t a, uint32_t b) {
        const double x = coordinate(a, k), y = coordinate(b, k);
        return x != y ? x < y : a < b;
    });
}

/// Divides facets into `groups` groups, numbered from `group` on, of about equal area.
void FacetGroups::Builder::split(std::span<uint32_t> some, int group, int groups) {
    if (groups == 1) return finish(group, some);
    sort(some, widest(some).first);
    double area = 0, until = 0;
    for (const uint32_t t : some) area += facets[t].area;
    size_t half = 0;
    while (half < some.size() && until + facets[some[half]].area <= area / 2) until += facets[some[half++]].area;
    const size_t least = size_t(groups) / 2;
    half = std::clamp(half, least, some.size() - least);
    split(some.first(half), group, groups / 2);
    split(some.subspan(half), group + groups / 2, groups / 2);
}

/// About as many strips as each has facets.
void FacetGroups::Builder::makeStrips(std::span<uint32_t> some, double area) {
    const auto [across, along] = widest(some);
    sort(some, across);
    const double strips = std::max(1., std::floor(std::sqrt(double(some.size()))));
    double until = 0;
    for (size_t first = 0, end = 0; first < some.size(); first = end) {
        const double wanted = until + area / strips;
        do until += facets[some[end++]].area;
        while (end < some.size() && until < wanted);
        sort(some.subspan(first, end - first), along);
        to.strips_.push_back({to.order_.size(), to.order_.size() + (end - first), until});
        double ofStrip = 0;
        for (size_t i = first; i < end; ++i) {
            to.order_.push_back(some[i]);
            to.cumulative_.push_back(ofStrip += facets[some[i]].area);
        }
    }
}

void FacetGroups::Builder::finish(int group, std::span<uint32_t> some) {
    const size_t g = size_t(group);
    to.firstStrip_[g] = to.strips_.size();
    Vec3d centre(0.0), normal(0.0);
    double area = 0;
    for (const uint32_t t : some) {
        const Facet& f = facets[t];
        to.groupOf_[t] = uint8_t(group);
        centre += f.centre * f.area;
        normal += f.normal * f.area;
        area += f.area;
    }
    makeStrips(some, area);
    to.firstStrip_[g + 1] = to.strips_.size();
    to.area_[g] = float(area);
    if (!(area > 0)) return;
    centre = centre / area;
    normal = dot(normal, normal) > 0 ? normalize(normal) : Vec3d(0.0);
    double radius2 = 0, least = 1;
    for (const uint32_t t : some) {
        radius2 = std::max(radius2, double(dot(facets[t].centre - centre, facets[t].centre - centre)));
        if (facets[t].area > 0) least = std::min(least, double(dot(facets[t].normal, normal)));
    }
    for (int k = 0; k < 3; ++k) to.centre_[k][g] = float(centre[k]), to.normal_[k][g] = float(normal[k]);
    to.radius2_[g] = float(radius2);
    to.spread_[g] = least > 0 ? float(std::sqrt(std::max(0.0, 1 - least * least))) : 1;
}

FacetGroups::FacetGroups(const Shape& s, bool bothSides) : shape_(&s), bothSides_(bothSides) {
    const geometry::TriMesh& m = s.mesh();
    const uint32_t n = m.triangles();
    Builder b{*this, {}};
    b.facets.resize(n);
    groupOf_.resize(n);
    std::vector<uint32_t> all(n);
    Vec3d middle(0.0), through(0.0), low(1e300), high(-1e300);
    double area = 0;
    for (uint32_t t = 0; t < n; ++t) {
        Builder::Facet& f = b.facets[t];
        const auto corner = [&](size_t i) { return Vec3d(m.P[m.index[3 * size_t(t) + i]]); };
        f.centre = (corner(0) + corner(1) + corner(2)) / 3;
        f.area = .5 * length(cross(corner(1) - corner(0), corner(2) - corner(0)));
        const Vec3d normal = s.hitNormal(t, 1 / 3., 1 / 3.);
        if (const double squared = dot(normal, normal); squared > 0 && std::isfinite(squared)) f.normal = normalize(normal);
        if (!std::isfinite(f.area) || !std::isfinite(dot(f.centre, f.centre))) f = {}; // it has no order among the others
        for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], f.centre[k]), high[k] = std::max(high[k], f.centre[k]);
        middle += f.centre * f.area;
        through += f.normal * f.area;
        area += f.area;
        all[t] = t;
    }
    if (!(area > 0)) return;
    middle = middle / area;
    b.extent = length(high - low);
    // The normals of a closed surface, times areas, add up to nothing; those that point outwards enclose a positive volume.
    constexpr double kClosed = 1e-3;
    closed_ = length(through) < kClosed * area;
    double volume = 0;
    for (const Builder::Facet& f : b.facets) volume += f.area * dot(f.normal, f.centre - middle);
    outward_ = volume < 0 ? -1.f : 1.f;
    b.split(all, 0, kGroups);
    shinesTo(0);
}

void FacetGroups::shinesTo(int side) {
    constexpr float kUnseen = .02f, kInside = .1f; // a lit point inside a closed mesh sees none of its outside
    either_ = bothSides_ || (side == 0 && !closed_);
    side_ = side ? float(side) : outward_;
    floor_ = side == 0 && closed_ ? kInside : kUnseen;
}

float FacetGroups::weigh(const Vec3& from, Row& weights) const {
    const float both = either_ ? 1.f : 0.f;
    for (size_t g = 0; g < kGroups; ++g) { // no sum and no branch in it, so that it runs in lanes
        const float x = from.x - centre_[0][g], y = from.y - centre_[1][g], z = from.z - centre_[2][g];
        const float d2 = std::max(x * x + y * y + z * z, 1e-30f), r2 = radius2_[g];
        const float c = side_ * (x * normal_[0][g] + y * normal_[1][g] + z * normal_[2][g]) / std::sqrt(d2);
        // The mean of max(0, t), or of |t|, over cosines t that are even between c - s and c + s.
        const float s = std::max(spread_[g] + std::sqrt(r2 / std::max(d2, r2)) * .5f, 1e-3f),
                    clamped = std::max(std::min(c, s), -s);
        const float one = (clamped + s) * (clamped + s) / (4 * s) + std::max(c - s, 0.f);
        const float other = (clamped - s) * (clamped - s) / (4 * s) + std::max(-c - s, 0.f);
        weights[g] = area_[g] * std::max(one + both * other, floor_) / std::max(d2, std::max(r2, 1e-30f));
    }
    float sum = 0;
    for (const float w : weights) sum += w;
    return sum;
}

double FacetGroups::place(const Vec3& from, Vec2 u, float time, SurfacePoint& point, uint32_t needs) const {
    if (strips_.empty()) return 0;
    Row weights;
    const float sum = weigh(from, weights);
    double left = double(u.x) * sum;
    size_t g = 0;
    while (g + 1 < kGroups && !(left < weights[g])) left -= weights[g++];
    while (g > 0 && !(weights[g] > 0)) --g; // rounding led to an empty one
    const double within = weights[g] > 0 ? std::clamp(left / weights[g], 0.0, 1 - 0x1p-53) : .5;
    // A strip by what is left of the first number, a facet by the second; what is left of both is uniform on the facet.
    const Strip* const strips = strips_.data() + firstStrip_[g];
    const size_t count = firstStrip_[g + 1] - firstStrip_[g];
    const double at = within * strips[count - 1].until;
    const auto ends = [](double x, const Strip& s) { return x < s.until; };
    const Strip& strip = *std::upper_bound(strips, strips + count - 1, at, ends);
    const double across = restOf(at, &strip == strips ? 0 : (&strip)[-1].until, strip.until);
    const double* const areas = cumulative_.data() + strip.first;
    const size_t facets = strip.end - strip.first;
    const double along = double(u.y) * areas[facets - 1];
    const size_t k = size_t(std::upper_bound(areas, areas + facets - 1, along) - areas);
    const double side = std::sqrt(restOf(along, k ? areas[k - 1] : 0, areas[k])); // uniform over a triangle
    const geometry::HitRef hit{order_[strip.first + k], side * (1 - across), side * across, &point, time};
    shape_->points({&hit, 1}, needs);
    return densityOf(g, weights, sum);
}

double FacetGroups::density(const SurfacePoint& p, const Vec3& from) const {
    const uint32_t t = p.facet != geometry::kNone ? p.facet : p.prim;
    if (t >= groupOf_.size()) return 0;
    Row weights;
    const float sum = weigh(from, weights);
    return densityOf(groupOf_[t], weights, sum);
}

double FacetGroups::densityOf(size_t g, const Row& weights, float sum) const {
    return sum > 0 && area_[g] > 0 ? double(weights[g]) / sum / area_[g] : 0;
}

} // namespace alpenglow::world
