// Blobby nleaf code floats strings: the surface where the field of its blobs is 0.421875 (blob_field.h).
//
// Rays meet the surface itself. Space is cut into boxes until each is small against the blobs in it, boxes that the surface
// provably misses are dropped, and each that is left is an exact primitive with the part of the field that matters there.
// Polygons would need to be as small as the thinnest part of the thinnest blob; boxes may be larger, because roots along a ray
// are isolated by bounds and none is lost.
//
// A point has u and v like a polygon's: the two coordinates of object space across the axis that its normal is nearest to. What
// an exact hit gives (two numbers) are those coordinates within its box, with the third, coarse, in their last bits: from there
// Newton finds the surface again.
#include "base/limits.h"
#include "geometry/blob_field.h"
#include "geometry/dice.h"
#include "geometry/factories.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>

namespace alpenglow::geometry {
namespace {

using scene::Class;

struct Box {
    Vec3d lo, hi;
    uint32_t tape = 0;
};

class Blobby final : public Shape {
public:
    Blobby(ShapeSource s, BlobField field, int leaves, Diagnostics& diag);
    bool empty() const { return boxes_.empty(); }

    uint32_t exactPrims() const override { return uint32_t(boxes_.size()); }
    Bounds exactBounds(uint32_t prim) const override { return boundsOf(boxes_[prim].lo, boxes_[prim].hi); }
    Bounds bounds() const override { return all_; }
    int exactHits(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted,
                  ExactHit out[4]) const override;
    SurfacePoint evaluate(int face, double u, double v) const override;
    double area() const override { return areas().sum; }
    SurfacePoint sampleArea(double xi1, double xi2) const override;
    double sampleDensity(const SurfacePoint&) const override;
    void dice(const DiceOptions& opt, Diagnostics& diag) override { reportNotDisplaced(*this, opt, diag); }

protected:
    size_t classCount(Class c) const override { return c == Class::Constant || c == Class::Uniform ? 1 : size_t(leaves_); }
    int weights(Class, const SurfacePoint&, Weight w[16]) const override;
    SurfacePoint evaluateLocal(uint32_t prim, double b1, double b2) const override;

private:
    struct Areas {
        double sum = 0;
        std::vector<double> cumulative; ///< by box, to 1
        std::once_flag made;
    };
    const Areas& areas() const;
    void cut(Diagnostics&);
    Bounds boundsOf(const Vec3d& lo, const Vec3d& hi) const;
    const BlobTape& tapeOf(const Box& b) const { return tapes_[b.tape]; }
    Vec3d decoded(uint32_t prim, double b1, double b2) const;
    void encode(uint32_t prim, const Vec3d& p, const Vec3d& gradient, double& b1, double& b2) const;
    int alongAxis(const Box&, int axis, const Vec3d& through, double* out) const;
    double densityObject(uint32_t prim, const Vec3d& p, const Vec3d& normal) const;
    double stretch(const Vec3d& normal) const;

    BlobField field_;
    int leaves_;
    std::vector<Box> boxes_;
    std::vector<BlobTape> tapes_;
    Matrix toObject_;
    Bounds all_;
    mutable Areas areas_;
};

constexpr int kMost = 4; ///< hits that one box gives a ray

int largest(const Vec3d& v) {
    const double x = std::fabs(v.x), y = std::fabs(v.y), z = std::fabs(v.z);
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

Blobby::Blobby(ShapeSource s, BlobField field, int leaves, Diagnostics& diag)
    : Shape(std::move(s)), field_(std::move(field)), leaves_(leaves) {
    toObject_ = inverse(toCamera());
    cut(diag);
    for (const Box& b : boxes_) all_.add(boundsOf(b.lo, b.hi));
    for (const BlobTape& t : tapes_) {
        int n = 0;
        for (const BlobOp& o : t) n += o.kind == BlobOp::Kind::Leaf;
        mostWeights_ = std::max(mostWeights_, n);
    }
    takePrimvars(diag);
}

/// The boxes that may hold surface, small against their blobs.
void Blobby::cut(Diagnostics& diag) {
    constexpr double kSmall = 0.3; // of the smallest half axis about
    Box root{Vec3d(INFINITY), Vec3d(-INFINITY), 0};
    for (const BlobLeaf& l : field_.leaves()) {
        if (l.kind == BlobLeaf::Kind::Ground) continue;
        for (int k = 0; k < 3; ++k) {
            root.lo[k] = std::min(root.lo[k], l.lo[k]);
            root.hi[k] = std::max(root.hi[k], l.hi[k]);
        }
    }
    if (!(root.lo.x < root.hi.x && root.lo.y < root.hi.y && root.lo.z < root.hi.z)) return;
    tapes_.push_back(field_.whole());
    std::vector<Box> now{root}, next;
    std::vector<Interval> values;
    while (!now.empty()) {
        const bool full = boxes_.size() + 2 * now.size() > limits::kBlobBoxes;
        if (full) {
            diag.report(Severity::Info, Rie::Limit, place(),
                        "Blobby: its boxes are larger than would be fast, for there would be too many");
            boxes_.insert(boxes_.end(), now.begin(), now.end());
            break;
        }
        next.clear();
        for (const Box& b : now) {
            double thin = INFINITY;
            for (const BlobOp& o : tapeOf(b))
                if (o.kind == BlobOp::Kind::Leaf) thin = std::min(thin, field_.leaves()[o.a].thin);
            const int axis = largest(b.hi - b.lo);
            const double middle = 0.5 * (b.lo[axis] + b.hi[axis]);
            if (b.hi[axis] - b.lo[axis] <= kSmall * thin || !(middle > b.lo[axis] && middle < b.hi[axis])) {
                boxes_.push_back(b);
                continue;
            }
            for (int side = 0; side < 2; ++side) {
                Box half = b;
                (side ? half.lo : half.hi)[axis] = middle;
                const Interval f = field_.bounds(tapeOf(b), half.lo, half.hi, values);
                constexpr double kRounding = 1e-10;
                if (f.hi < kBlobThreshold - kRounding || f.lo > kBlobThreshold + kRounding) continue;
                BlobTape t = BlobField::simplified(tapeOf(b), values);
                if (t.size() < tapeOf(b).size()) {
                    half.tape = uint32_t(tapes_.size());
                    tapes_.push_back(std::move(t));
                }
                next.push_back(half);
            }
        }
        now.swap(next);
    }
}

Bounds Blobby::boundsOf(const Vec3d& lo, const Vec3d& hi) const {
    Bounds b;
    Vec3d reach(0.0);
    for (int i = 0; i < 8; ++i) {
        const Vec3d c = transformPoint(toCamera(), Vec3d(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z));
        for (int k = 0; k < 3; ++k) reach[k] = std::max(reach[k], std::fabs(c[k]));
        b.add(Vec3(c));
    }
    for (int k = 0; k < 3; ++k) { // rounding to float, and the width that hits on a face of the box may be off
        const float e = float(reach[k] * 2.4e-7 + 1e-37);
        b.lo[k] -= e;
        b.hi[k] += e;
    }
    return b;
}

// ---- hits
// -----------------------------------------------------------------------------------------------------------------------

// The lowest bits of the two numbers: of the first the axis and the upper half of the third coordinate, of the second its lower
// half.
constexpr int kHalfBits = 12;

void Blobby::encode(uint32_t prim, const Vec3d& p, const Vec3d& gradient, double& b1, double& b2) const {
    const Box& box = boxes_[prim];
    const int c = largest(gradient), a = (c + 1) % 3, b = (c + 2) % 3;
    const auto part = [&](int k) { return std::clamp((p[k] - box.lo[k]) / (box.hi[k] - box.lo[k]), 0.0, 1.0); };
    const uint64_t third = uint64_t(std::min(part(c) * double(1 << (2 * kHalfBits)), double((1 << (2 * kHalfBits)) - 1)));
    const auto with = [](double x, uint64_t low, int bits) { // from 1 to 2, where all doubles are as dense
        return std::bit_cast<double>((std::bit_cast<uint64_t>(std::min(1 + x, 0x1.fffffffffffffp0)) >> bits << bits) | low) - 1;
    };
    b1 = with(part(a), uint64_t(c) << kHalfBits | third >> kHalfBits, kHalfBits + 2);
    b2 = with(part(b), third & ((1 << kHalfBits) - 1), kHalfBits);
}

Vec3d Blobby::decoded(uint32_t prim, double b1, double b2) const {
    const Box& box = boxes_[std::min(size_t(prim), boxes_.size() - 1)];
    const auto bits = [](double x) { return std::bit_cast<uint64_t>(std::clamp(1 + x, 1.0, 0x1.fffffffffffffp0)); };
    const uint64_t first = bits(b1), second = bits(b2), low = (uint64_t(1) << kHalfBits) - 1;
    const int c = int(std::min<uint64_t>(first >> kHalfBits & 3, 2)), a = (c + 1) % 3, b = (c + 2) % 3;
    const auto rest = [](uint64_t v, int n) { return std::bit_cast<double>(v >> n << n) - 1; };
    Vec3d p;
    p[a] = box.lo[a] + (box.hi[a] - box.lo[a]) * rest(first, kHalfBits + 2);
    p[b] = box.lo[b] + (box.hi[b] - box.lo[b]) * rest(second, kHalfBits);
    const double size = box.hi[c] - box.lo[c],
                 guess = (double((first & low) << kHalfBits | (second & low)) + 0.5) / double(1 << (2 * kHalfBits));
    p[c] = box.lo[c] + size * guess;
    const double begin = p[c];
    for (int i = 0; i < 6; ++i) { // Newton from 6e-8 of the box
        const BlobJet j = field_.jet(tapeOf(box), p);
        const double step = j.g[c] != 0 ? (kBlobThreshold - j.f) / j.g[c] : 0;
        if (!(std::fabs(p[c] + step - begin) < 1e-3 * size)) break;
        p[c] += step;
        if (std::fabs(step) < 1e-15 * size) break;
    }
    return p;
}

int Blobby::exactHits(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted wanted,
                      ExactHit out[4]) const {
    const Box& box = boxes_[prim];
    Vec3d o = transformPoint(toObject_, org), d = transformVector(toObject_, dir);
    if (!(dot(d, d) > 0) || !std::isfinite(dot(o, o) + dot(d, d))) return 0;
    // From the point nearest the box: a far origin would take the digits of what is near.
    const Vec3d middle = (box.lo + box.hi) * 0.5;
    const double shift = dot(middle - o, d) / dot(d, d);
    o = o + d * shift;
    double t0 = lo - shift, t1 = hi - shift;
    for (int k = 0; k < 3; ++k) {
        const double room = 1e-9 * (box.hi[k] - box.lo[k]); // neighbours overlap: none is lost between them
        const double a = box.lo[k] - room - o[k], b = box.hi[k] + room - o[k];
        if (d[k] == 0) {
            if (a > 0 || b < 0) return 0;
            continue;
        }
        t0 = std::max(t0, std::min(a / d[k], b / d[k]));
        t1 = std::min(t1, std::max(a / d[k], b / d[k]));
    }
    double roots[kMost];
    const int n = field_.crossings(tapeOf(box), o, d, t0, t1, wanted == Wanted::All ? kMost : 1, roots);
    int m = 0;
    for (int i = 0; i < n; ++i) {
        const double t = roots[i] + shift;
        if (!(t > lo && t <= hi)) continue;
        out[m].t = t;
        out[m].u = out[m].v = 0;
        if (wanted != Wanted::Any) {
            const Vec3d p = o + d * roots[i];
            encode(prim, p, field_.jet(tapeOf(box), p).g, out[m].u, out[m].v);
        }
        ++m;
    }
    return m;
}

SurfacePoint Blobby::evaluateLocal(uint32_t prim, double b1, double b2) const {
    prim = std::min(prim, uint32_t(boxes_.size() - 1));
    const Box& box = boxes_[prim];
    const Vec3d p = decoded(prim, b1, b2);
    const BlobJet j = field_.jet(tapeOf(box), p);
    SurfacePoint r;
    r.prim = prim;
    r.b1 = b1;
    r.b2 = b2;
    const Matrix& m = toCamera();
    r.P = Vec3(transformPoint(m, p));
    const double size = length(transformVector(m, box.hi - box.lo));
    r.pError = roundingError(r.P) + float(1e-11 * size);
    r.orientation = orientation_;
    // Outside the field is less.
    const Vec3d g = dot(j.g, j.g) > 0 ? j.g * -1.0 : Vec3d(0, 0, 1);
    const int c = largest(g);
    int a = (c + 1) % 3, b = (c + 2) % 3;
    if (g[c] < 0) std::swap(a, b); // dPdu x dPdv leaves the blob
    const double full[3][3] = {{j.h[0], j.h[3], j.h[4]}, {j.h[3], j.h[1], j.h[5]}, {j.h[4], j.h[5], j.h[2]}};
    const auto bent = [&](const Vec3d& x) {
        return Vec3d(full[0][0] * x.x + full[0][1] * x.y + full[0][2] * x.z,
                     full[1][0] * x.x + full[1][1] * x.y + full[1][2] * x.z,
                     full[2][0] * x.x + full[2][1] * x.y + full[2][2] * x.z);
    };
    Vec3d pu(0.0), pv(0.0);
    pu[a] = 1, pu[c] = -g[a] / g[c];
    pv[b] = 1, pv[c] = -g[b] / g[c];
    const Vec3d hu = bent(pu), hv = bent(pv);
    const auto along = [&](double second) { // F_c times what the third coordinate bends cancels what the field does
        Vec3d x(0.0);
        x[c] = second / g[c];
        return Vec3(transformVector(m, x));
    };
    r.dPdu = Vec3(transformVector(m, pu));
    r.dPdv = Vec3(transformVector(m, pv));
    r.Puu = along(dot(pu, hu));
    r.Puv = along(dot(pu, hv));
    r.Pvv = along(dot(pv, hv));
    const auto normalOut = [&](const Vec3d& n) { // by the inverse transposed
        const auto& i = toObject_.m;
        return Vec3d(i[0][0] * n.x + i[0][1] * n.y + i[0][2] * n.z, i[1][0] * n.x + i[1][1] * n.y + i[1][2] * n.z,
                     i[2][0] * n.x + i[2][1] * n.y + i[2][2] * n.z);
    };
    const double side = determinant3(m) < 0 ? -orientation_ : orientation_;
    const Vec3d n0 = normalOut(g) * side, nu = normalOut(hu) * -side, nv = normalOut(hv) * -side;
    const double l = length(n0);
    const Vec3d n = n0 / l;
    r.n = Vec3(n);
    r.Ng = cross(r.dPdu, r.dPdv) * orientation_;
    r.dNdu = Vec3((nu - n * dot(n, nu)) / l);
    r.dNdv = Vec3((nv - n * dot(n, nv)) / l);
    r.u = float(p[a]);
    r.v = float(p[b]);
    finishPoint(r, false);
    return r;
}

SurfacePoint Blobby::evaluate(int, double u, double v) const {
    // No two numbers name all points of such a surface: (u, v) of the unit square go round it as samples do.
    return sampleArea(std::clamp(u, 0.0, 0x1.fffffffffffffp-1), std::clamp(v, 0.0, 0x1.fffffffffffffp-1));
}

int Blobby::weights(Class c, const SurfacePoint& p, Weight w[16]) const {
    w[0] = {0, 1, 0, 0};
    if (c == Class::Constant || c == Class::Uniform || p.prim >= boxes_.size()) return 1;
    std::vector<BlobField::Share> shares;
    const Vec3d at = decoded(p.prim, p.b1, p.b2);
    field_.shares(tapeOf(boxes_[p.prim]), at, shares);
    // The derivatives by u and v of the point, in object space.
    const Vec3d pu = transformVector(toObject_, Vec3d(p.dPdu)), pv = transformVector(toObject_, Vec3d(p.dPdv));
    int n = 0;
    for (const auto& s : shares)
        if (n < mostWeights_) w[n++] = {s.number, s.w, dot(s.g, pu), dot(s.g, pv)};
    return std::max(n, 1);
}

// ---- as a light
// -----------------------------------------------------------------------------------------------------------------

int Blobby::alongAxis(const Box& box, int axis, const Vec3d& through, double* out) const {
    Vec3d o = through, d(0.0);
    o[axis] = 0;
    d[axis] = 1;
    return field_.crossings(tapeOf(box), o, d, box.lo[axis], box.hi[axis], 2 * kMost, out);
}

/// Area in camera space over area in object space, for a surface with this normal in object space.
double Blobby::stretch(const Vec3d& n) const {
    const auto& i = toObject_.m;
    const Vec3d c(i[0][0] * n.x + i[0][1] * n.y + i[0][2] * n.z, i[1][0] * n.x + i[1][1] * n.y + i[1][2] * n.z,
                  i[2][0] * n.x + i[2][1] * n.y + i[2][2] * n.z);
    return length(c) / length(n) * std::fabs(determinant3(toCamera()));
}

/// Lines along the axes through a box meet the surface; what each root stands for is shared by the three directions.
const Blobby::Areas& Blobby::areas() const {
    std::call_once(areas_.made, [&] {
        // By side of a box; few boxes get many, for lines at the edge of what they see count for much.
        const int lines = std::clamp(int(std::sqrt(2e5 / (3.0 * double(boxes_.size())))), 4, 32);
        areas_.cumulative.reserve(boxes_.size());
        double chances = 0;
        for (const Box& b : boxes_) {
            const Vec3d size = b.hi - b.lo;
            double area = 0;
            // Boxes lie in rows: lines at the same places of each would see a ball as the same few circles.
            const double turn = double(areas_.cumulative.size()) * 0.7548776662466927, shiftA = turn - std::floor(turn);
            const double other = double(areas_.cumulative.size()) * 0.5698402909980532, shiftB = other - std::floor(other);
            for (int axis = 0; axis < 3; ++axis)
                for (int k = 0; k < lines * lines; ++k) {
                    Vec3d p = b.lo;
                    p[(axis + 1) % 3] += size[(axis + 1) % 3] * (k % lines + shiftA) / lines;
                    p[(axis + 2) % 3] += size[(axis + 2) % 3] * (k / lines + shiftB) / lines;
                    double roots[2 * kMost];
                    for (int n = alongAxis(b, axis, p, roots), i = 0; i < n; ++i) {
                        p[axis] = roots[i];
                        const Vec3d g = normalize(field_.jet(tapeOf(b), p).g);
                        // A third of them by the square of its part of the normal: nothing at the edges that a direction sees.
                        area += size[(axis + 1) % 3] * size[(axis + 2) % 3] / (lines * lines) * std::fabs(g[axis]) * stretch(g);
                    }
                }
            areas_.sum += area;
            // A box that the lines missed may hold a corner of the surface: it has a chance as well.
            const double face = size.x * size.y + size.y * size.z + size.z * size.x;
            areas_.cumulative.push_back(chances += area + 1e-3 * face * stretch(Vec3d(0, 0, 1)));
        }
        for (double& c : areas_.cumulative) c /= chances;
    });
    return areas_;
}

/// Density by area in object space of sampleArea() at a point.
double Blobby::densityObject(uint32_t prim, const Vec3d& p, const Vec3d& normal) const {
    const Areas& all = areas();
    const double chance = all.cumulative[prim] - (prim ? all.cumulative[prim - 1] : 0);
    const Box& b = boxes_[prim];
    const Vec3d size = b.hi - b.lo;
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        double roots[2 * kMost];
        const int n = std::max(1, alongAxis(b, axis, p, roots)); // the point itself is one of them
        sum += std::fabs(normal[axis]) / (n * size[(axis + 1) % 3] * size[(axis + 2) % 3]);
    }
    return chance * sum / 3;
}

SurfacePoint Blobby::sampleArea(double xi1, double xi2) const {
    const Areas& all = areas();
    const size_t prim =
        size_t(std::min(std::upper_bound(all.cumulative.begin(), all.cumulative.end(), xi1) - all.cumulative.begin(),
                        ptrdiff_t(boxes_.size() - 1)));
    const double before = prim ? all.cumulative[prim - 1] : 0, share = all.cumulative[prim] - before;
    // What is left of the numbers chooses the axis, the line, and one of its roots.
    double x = share > 0 ? std::clamp((xi1 - before) / share, 0.0, 0x1.fffffffffffffp-1) : 0.5, y = xi2;
    const int axis = std::min(2, int(y * 3));
    y = y * 3 - axis;
    const Box& b = boxes_[prim];
    Vec3d p = b.lo;
    p[(axis + 1) % 3] += (b.hi[(axis + 1) % 3] - b.lo[(axis + 1) % 3]) * x;
    p[(axis + 2) % 3] += (b.hi[(axis + 2) % 3] - b.lo[(axis + 2) % 3]) * y;
    double roots[2 * kMost];
    const int n = alongAxis(b, axis, p, roots);
    if (n == 0) { // nothing on this line: a point without a chance
        SurfacePoint none;
        none.P = Vec3(transformPoint(toCamera(), p));
        none.n = none.N = none.Ng = Vec3(0, 0, 1);
        none.prim = kNone;
        return none;
    }
    const double scrambled = x * 4096 - std::floor(x * 4096); // bits of x that the place of the line hardly sees
    p[axis] = roots[std::min(n - 1, int(scrambled * n))];
    double b1, b2;
    encode(uint32_t(prim), p, field_.jet(tapeOf(b), p).g, b1, b2);
    return evaluateLocal(uint32_t(prim), b1, b2);
}

double Blobby::sampleDensity(const SurfacePoint& s) const {
    if (s.prim >= boxes_.size()) return 0;
    const Vec3d p = decoded(s.prim, s.b1, s.b2), g = field_.jet(tapeOf(boxes_[s.prim]), p).g;
    const double l = length(g);
    return l > 0 ? densityObject(s.prim, p, g / l) / stretch(g) : 0;
}

} // namespace

ShapeRef makeBlobby(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    BlobField field;
    const int leaves = p.ints.empty() ? 0 : p.ints[0];
    if (!field.read(leaves, p.ints2, p.numbers, p.strings, p.toWorld.first(), p.place, diag)) return nullptr;
    auto shape = std::make_shared<Blobby>(std::move(s), std::move(field), leaves, diag);
    if (!shape->empty()) return shape;
    diag.report(Severity::Warning, Rie::Range, p.place,
                "Blobby: its field never reaches the threshold; there is nothing to draw");
    return nullptr;
}

} // namespace alpenglow::geometry
