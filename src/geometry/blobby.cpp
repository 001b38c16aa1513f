#include "geometry/blobby.h"
#include "base/limits.h"
#include "geometry/dice.h"
#include "geometry/factories.h"
#include <algorithm>
#include <bit>
#include <cmath>

namespace alpenglow::geometry {

namespace {

constexpr int kMostRoots = 4; ///< hits of a ray in one box

int largest(const Vec3d& v) {
    const double x = std::fabs(v.x), y = std::fabs(v.y), z = std::fabs(v.z);
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

} // namespace

Blobby::Now::Now(const Blobby& b, const BlobTape& tape, float time) {
    if (b.motion_) {
        b.motion_->at(tape, time, own_, ownTape_);
    } else {
        still_ = &b.field_;
        stillTape_ = &tape;
    }
}

Blobby::Blobby(ShapeSource s, BlobField field, int leaves, Diagnostics& diag)
    : KeyedShape(std::move(s)), field_(std::move(field)), leaves_(leaves) {
    toObject_ = inverse(toCamera());
    if (!source_.like) cut(diag); // later keys only supply numbers
    measure();
    takePrimvars(diag);
    takePlacedPoints();
}

bool Blobby::fits(KeyedShape& later) const {
    const scene::Primitive &a = *source_.primitive, &b = *later.source().primitive;
    if (a.ints != b.ints || a.ints2 != b.ints2 || a.numbers.size() != b.numbers.size() || a.strings != b.strings) return false;
    // Repelling planes do not move.
    for (const BlobLeaf& l : field_.leaves())
        if (l.kind == BlobLeaf::Kind::Ground && !std::equal(&a.numbers[l.at], &a.numbers[l.at] + 4, &b.numbers[l.at]))
            return false;
    return true;
}

void Blobby::joinKeys(const std::vector<float>& times, Diagnostics& diag) {
    std::vector<const std::vector<float>*> numbers;
    for (size_t k = 0; k < keys(); ++k) numbers.push_back(&key(k).source().primitive->numbers);
    if (std::any_of(numbers.begin(), numbers.end(), [&](const auto* n) { return *n != *numbers[0]; })) {
        motion_ = std::make_unique<const BlobMotion>(field_, std::move(numbers), times);
        boxes_.clear();
        tapes_.clear();
        cut(diag);
    }
    for (size_t k = 1; k < keys(); ++k) {
        auto& later = const_cast<Blobby&>(static_cast<const Blobby&>(key(k)));
        later.owner_ = this;
        later.mostWeights_ = mostWeights_;
    }
}

// ---- boxes

/// The initial boxes: all space with a nonzero field, from one key to the next.
std::vector<Blobby::Box> Blobby::roots() {
    std::vector<Box> all;
    if (motion_) {
        const std::vector<float>& times = motion_->times();
        for (size_t k = 0; k + 1 < times.size(); ++k) {
            const BlobMotion::Extent e = motion_->extent(field_.whole(), times[k], times[k + 1]);
            all.push_back({e.lo, e.hi, 0, times[k], times[k + 1]});
        }
    } else {
        Box root{Vec3d(INFINITY), Vec3d(-INFINITY)};
        for (const BlobLeaf& l : field_.leaves()) {
            if (l.kind == BlobLeaf::Kind::Ground) continue;
            for (int k = 0; k < 3; ++k) {
                root.lo[k] = std::min(root.lo[k], l.lo[k]);
                root.hi[k] = std::max(root.hi[k], l.hi[k]);
            }
        }
        all.push_back(root);
    }
    std::erase_if(all, [](const Box& b) { return !(b.lo.x < b.hi.x && b.lo.y < b.hi.y && b.lo.z < b.hi.z); });
    return all;
}

Interval Blobby::fieldBounds(const Box& of, const Vec3d& lo, const Vec3d& hi, float from, float to,
                             std::vector<Interval>& values) const {
    return motion_ ? motion_->bounds(tapeOf(of), lo, hi, from, to, values) : field_.bounds(tapeOf(of), lo, hi, values);
}

/// Longest side of a box, its length, and the smallest half axis of a blob in it. 3: time, by half of the motion of its blobs,
/// which widens bounds as much as the box itself.
int Blobby::longest(const Box& b, double& size, double& thin) const {
    int axis = largest(b.hi - b.lo);
    size = b.hi[axis] - b.lo[axis];
    thin = INFINITY;
    if (motion_) {
        constexpr float kShortest = 1e-5f; // of the shutter
        const BlobMotion::Extent e = motion_->extent(tapeOf(b), b.from, b.to);
        thin = e.thin;
        if (0.5 * e.way > size && b.to - b.from > kShortest) axis = 3, size = 0.5 * e.way;
    } else {
        for (const BlobOp& o : tapeOf(b))
            if (o.kind == BlobOp::Kind::Leaf) thin = std::min(thin, field_.leaves()[o.a].thin);
    }
    return axis;
}

/// The boxes that may hold surface, small against their blobs.
void Blobby::cut(Diagnostics& diag) {
    constexpr double kSmall = 0.3; // of the smallest half axis about
    std::vector<Box> now = roots(), next;
    if (!now.empty()) tapes_.push_back(field_.whole());
    std::vector<Interval> values;
    while (!now.empty()) {
        const bool full = boxes_.size() + 2 * now.size() > limits::kBlobBoxes;
        if (full) {
            diag.report(Severity::Info, Rie::Limit, place(),
                        "Blobby: it needs too many boxes; larger ones are used, which is slower");
            boxes_.insert(boxes_.end(), now.begin(), now.end());
            break;
        }
        next.clear();
        for (const Box& b : now) {
            double size, thin;
            const int axis = longest(b, size, thin);
            const float noon = b.from + (b.to - b.from) * 0.5f;
            const double middle = axis < 3 ? 0.5 * (b.lo[axis] + b.hi[axis]) : double(noon);
            const bool between = axis < 3 ? middle > b.lo[axis] && middle < b.hi[axis] : noon > b.from && noon < b.to;
            if (size <= kSmall * thin || !between) {
                boxes_.push_back(b);
                continue;
            }
            for (int side = 0; side < 2; ++side) {
                Box half = b;
                if (axis < 3) (side ? half.lo : half.hi)[axis] = middle;
                else (side ? half.from : half.to) = noon;
                const Interval f = fieldBounds(b, half.lo, half.hi, half.from, half.to, values);
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
    for (const BlobTape& t : tapes_) {
        int n = 0;
        for (const BlobOp& o : t) n += o.kind == BlobOp::Kind::Leaf;
        mostWeights_ = std::max(mostWeights_, n);
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

// The lowest bits of the two numbers: of the first the axis and the upper half of the third coordinate, of the second its lower
// half and, where it moves, the time within that of the box.
constexpr int kHalfBits = 12;

void Blobby::encode(uint32_t prim, const Vec3d& p, const Vec3d& gradient, float time, double& b1, double& b2) const {
    const Box& box = boxes_[prim];
    const int c = largest(gradient), a = (c + 1) % 3, b = (c + 2) % 3;
    const auto part = [&](int k) { return std::clamp((p[k] - box.lo[k]) / (box.hi[k] - box.lo[k]), 0.0, 1.0); };
    const uint64_t third = uint64_t(std::min(part(c) * double(1 << (2 * kHalfBits)), double((1 << (2 * kHalfBits)) - 1)));
    const auto with = [](double x, uint64_t low, int bits) { // from 1 to 2, where all doubles are as dense
        return std::bit_cast<double>((std::bit_cast<uint64_t>(std::min(1 + x, 0x1.fffffffffffffp0)) >> bits << bits) | low) - 1;
    };
    b1 = with(part(a), uint64_t(c) << kHalfBits | third >> kHalfBits, kHalfBits + 2);
    uint64_t low = third & ((1 << kHalfBits) - 1);
    if (motion_) {
        const double when = std::clamp((double(time) - box.from) / (double(box.to) - box.from), 0.0, 1.0);
        low |= uint64_t(when * ((1 << kHalfBits) - 1) + 0.5) << kHalfBits;
    }
    b2 = with(part(b), low, motion_ ? 2 * kHalfBits : kHalfBits);
}

/// Along the gradient to the surface, by Newton's rule; not farther than `size`.
Vec3d Blobby::onSurface(const Now& now, Vec3d p, const Vec3d& size, bool& found) const {
    const Vec3d begin = p;
    found = false;
    for (int i = 0; i < 20; ++i) {
        const BlobJet j = now.jet(p);
        const double g2 = dot(j.g, j.g), gap = kBlobThreshold - j.f;
        if (!(g2 > 0)) return begin;
        const Vec3d step = j.g * (gap / g2);
        if (!(length(p + step - begin) < length(size))) return begin;
        p = p + step;
        if (length(step) < 1e-14 * length(size)) break;
    }
    found = std::fabs(now.jet(p).f - kBlobThreshold) < 1e-9;
    return found ? p : begin;
}

/// Time of a hit with this number; the given time itself, if the number cannot distinguish them.
float Blobby::metAt(const Box& box, double b2, float time) const {
    if (!motion_) return time;
    constexpr uint64_t kAll = (uint64_t(1) << kHalfBits) - 1;
    const uint64_t bits = std::bit_cast<uint64_t>(std::clamp(1 + b2, 1.0, 0x1.fffffffffffffp0)) >> kHalfBits;
    const float span = box.to - box.from, when = box.from + span * float(bits & kAll) / float(kAll);
    return box.at(time) && std::fabs(time - when) <= span / float(kAll) ? time : when;
}

/// For shaders that run at shutter open, a hit at another time moves with the blobs.
Blobby::Found Blobby::decoded(uint32_t prim, double b1, double b2, float time) const {
    const Box& box = boxes_[std::min(size_t(prim), boxes_.size() - 1)];
    const auto bits = [](double x) { return std::bit_cast<uint64_t>(std::clamp(1 + x, 1.0, 0x1.fffffffffffffp0)); };
    const uint64_t first = bits(b1), second = bits(b2), low = (uint64_t(1) << kHalfBits) - 1;
    const int c = int(std::min<uint64_t>(first >> kHalfBits & 3, 2)), a = (c + 1) % 3, b = (c + 2) % 3;
    const auto rest = [](uint64_t v, int n) { return std::bit_cast<double>(v >> n << n) - 1; };
    Vec3d p;
    p[a] = box.lo[a] + (box.hi[a] - box.lo[a]) * rest(first, kHalfBits + 2);
    p[b] = box.lo[b] + (box.hi[b] - box.lo[b]) * rest(second, motion_ ? 2 * kHalfBits : kHalfBits);
    const double size = box.hi[c] - box.lo[c],
                 guess = (double((first & low) << kHalfBits | (second & low)) + 0.5) / double(1 << (2 * kHalfBits));
    p[c] = box.lo[c] + size * guess;
    const float met = metAt(box, b2, time);
    const Now now(*this, tapeOf(box), met);
    const double begin = p[c];
    for (int i = 0; i < 6; ++i) { // Newton from 6e-8 of the box
        const BlobJet j = now.jet(p);
        const double step = j.g[c] != 0 ? (kBlobThreshold - j.f) / j.g[c] : 0;
        if (!(std::fabs(p[c] + step - begin) < 1e-3 * size)) break;
        p[c] += step;
        if (std::fabs(step) < 1e-15 * size) break;
    }
    if (met == time) return {p, time, &tapeOf(box)};
    bool found;
    const BlobTape& tape = field_.whole().size() <= 256 ? field_.whole() : tapeOf(box); // with many blobs those of the box
    const Vec3d there = onSurface(Now(*this, tape, time), motion_->carried(tapeOf(box), p, met, time), box.hi - box.lo, found);
    if (found) return {there, time, &tape};
    return {p, met, &tapeOf(box)};
}

int Blobby::exactHitsAt(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted wanted, float time,
                        ExactHit out[4]) const {
    const Box& box = boxes_[prim];
    if (motion_ && !box.at(time)) return 0;
    Vec3d o = transformPoint(toObject_, org), d = transformVector(toObject_, dir);
    if (!(dot(d, d) > 0) || !std::isfinite(dot(o, o) + dot(d, d))) return 0;
    // From the point nearest to the box: a far origin would lose precision.
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
    if (!(t0 < t1)) return 0;
    const Now now(*this, tapeOf(box), time);
    double roots[kMostRoots];
    const int n = now.field().crossings(now.tape(), o, d, t0, t1, wanted == Wanted::All ? kMostRoots : 1, roots);
    int m = 0;
    for (int i = 0; i < n; ++i) {
        const double t = roots[i] + shift;
        if (!(t > lo && t <= hi)) continue;
        out[m].t = t;
        out[m].u = out[m].v = 0;
        if (wanted != Wanted::Any) {
            const Vec3d p = o + d * roots[i];
            encode(prim, p, now.jet(p).g, time, out[m].u, out[m].v);
        }
        ++m;
    }
    return m;
}

SurfacePoint Blobby::pointAt(uint32_t prim, double b1, double b2, float time) const {
    prim = std::min(prim, uint32_t(boxes_.size() - 1));
    const Box& box = boxes_[prim];
    const Found found = decoded(prim, b1, b2, time);
    const Vec3d& p = found.p;
    const BlobJet j = Now(*this, *found.tape, found.time).jet(p);
    SurfacePoint r;
    r.time = time;
    r.prim = prim;
    r.b1 = b1;
    r.b2 = b2;
    const Matrix& m = toCamera();
    r.P = Vec3(transformPoint(m, p));
    const double size = length(transformVector(m, box.hi - box.lo));
    r.pError = roundingError(r.P) + float((motion_ ? 1e-8 : 1e-11) * size);
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
    const auto along = [&](double second) { // F_c times the second derivative of the third coordinate cancels the field's
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

int Blobby::weights(Class c, const SurfacePoint& p, Weight w[16]) const {
    w[0] = {0, 1, 0, 0};
    const Blobby& all = owner();
    if (c == Class::Constant || c == Class::Uniform || p.prim >= all.boxes_.size()) return 1;
    std::vector<BlobField::Share> shares;
    const Box& box = all.boxes_[p.prim];
    const float time = all.metAt(box, p.b2, p.time); // a moved point has the colours from where it was hit
    const Vec3d at = all.decoded(p.prim, p.b1, p.b2, time).p;
    const Now now(all, all.tapeOf(box), time);
    now.field().shares(now.tape(), at, shares);
    // The derivatives by u and v of the point, in object space.
    const Vec3d pu = transformVector(toObject_, Vec3d(p.dPdu)), pv = transformVector(toObject_, Vec3d(p.dPdv));
    int n = 0;
    for (const auto& s : shares)
        if (n < mostWeights_) w[n++] = {s.number, s.w, dot(s.g, pu), dot(s.g, pv)};
    return std::max(n, 1);
}

/// Along the surface, the velocity of its blobs; across it, that of the field.
Vec3 Blobby::velocity(const SurfacePoint& at) const {
    if (!motion_ || at.prim >= boxes_.size()) return Vec3(0.f);
    const Found found = decoded(at.prim, at.b1, at.b2, at.time);
    const Vec3d& p = found.p;
    const float time = found.time;
    double way;
    const std::vector<float>& times = motion_->times();
    const size_t k = keyBefore(times, time, way);
    constexpr float kStep = 0x1p-11f; // exact in float; of the shutter
    const float a = std::max(time - kStep, times[k]), b = std::min(time + kStep, times[k + 1]);
    const BlobTape& tape = *found.tape;
    const Vec3d along = (motion_->carried(tape, p, time, b) - motion_->carried(tape, p, time, a)) / double(b - a);
    const Now before(*this, tape, a), after(*this, tape, b), now(*this, tape, time);
    const double change = (after.field().value(after.tape(), p) - before.field().value(before.tape(), p)) / double(b - a);
    const Vec3d g = now.jet(p).g;
    const double g2 = dot(g, g);
    return Vec3(transformVector(toCamera(), g2 > 0 ? along - g * ((change + dot(g, along)) / g2) : along));
}

void Blobby::dice(const DiceOptions& opt, Diagnostics& diag) { reportNotDisplaced(*this, opt, diag); }

ShapeRef makeBlobby(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    BlobField field;
    const int leaves = p.ints.empty() ? 0 : p.ints[0];
    const bool moves = isKey(s);
    if (!field.read(leaves, p.ints2, p.numbers, p.strings, p.toWorld.first(), p.place, diag, moves)) return nullptr;
    auto shape = std::make_shared<Blobby>(std::move(s), std::move(field), leaves, diag);
    if (moves || !shape->empty()) return shape;
    diag.report(Severity::Warning, Rie::Range, p.place,
                "Blobby: its field never reaches the threshold; there is nothing to draw");
    return nullptr;
}

} // namespace alpenglow::geometry
