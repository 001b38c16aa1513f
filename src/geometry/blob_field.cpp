// Fields of Blobbies: values, derivatives and bounds of their tapes.
#include "geometry/blob_field.h"
#include "geometry/tape_results.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

namespace {

using Kind = BlobOp::Kind;

BlobJet operator+(const BlobJet& a, const BlobJet& b) {
    BlobJet r{a.f + b.f, a.g + b.g, {}};
    for (int k = 0; k < 6; ++k) r.h[k] = a.h[k] + b.h[k];
    return r;
}
BlobJet operator*(const BlobJet& a, double s) {
    BlobJet r{a.f * s, a.g * s, {}};
    for (int k = 0; k < 6; ++k) r.h[k] = a.h[k] * s;
    return r;
}
BlobJet product(const BlobJet& a, const BlobJet& b) {
    BlobJet r{a.f * b.f, a.g * b.f + b.g * a.f, {}};
    for (int k = 0; k < 6; ++k) {
        const int i = kBlobJetRow[k], j = kBlobJetColumn[k];
        r.h[k] = a.h[k] * b.f + b.h[k] * a.f + a.g[i] * b.g[j] + a.g[j] * b.g[i];
    }
    return r;
}
BlobJet inverse(const BlobJet& a) {
    const double q = a.f != 0 ? 1 / a.f : 0;
    BlobJet r{q, a.g * (-q * q), {}};
    for (int k = 0; k < 6; ++k) r.h[k] = -a.h[k] * q * q + 2 * a.g[kBlobJetRow[k]] * a.g[kBlobJetColumn[k]] * q * q * q;
    return r;
}

/// The value of every step of a tape; ofLeaf: the field of a leaf, by its number.
template <class OfLeaf> void stepValues(const BlobTape& tape, TapeResults<double>& v, OfLeaf ofLeaf) {
    for (size_t i = 0; i < tape.size(); ++i) {
        const BlobOp& o = tape[i];
        switch (o.kind) {
        case Kind::Constant:
            v[i] = o.c;
            break;
        case Kind::Leaf:
            v[i] = ofLeaf(o.a);
            break;
        case Kind::Add:
            v[i] = v[o.a] + v[o.b];
            break;
        case Kind::Multiply:
            v[i] = v[o.a] * v[o.b];
            break;
        case Kind::Maximum:
            v[i] = std::max(v[o.a], v[o.b]);
            break;
        case Kind::Minimum:
            v[i] = std::min(v[o.a], v[o.b]);
            break;
        case Kind::Subtract:
            v[i] = v[o.a] - v[o.b];
            break;
        case Kind::Divide:
            v[i] = v[o.b] != 0 ? v[o.a] / v[o.b] : 0;
            break;
        case Kind::Negate:
            v[i] = -v[o.a];
            break;
        }
    }
}

} // namespace

double BlobField::value(const BlobTape& tape, const Vec3d& p) const {
    TapeResults<double> v(tape.size());
    stepValues(tape, v, [&](uint32_t leaf) { return blobLeafValue(leaves_[leaf], p); });
    return v[tape.size() - 1];
}

BlobJet BlobField::jet(const BlobTape& tape, const Vec3d& p) const {
    TapeResults<BlobJet> v(tape.size());
    for (size_t i = 0; i < tape.size(); ++i) {
        const BlobOp& o = tape[i];
        switch (o.kind) {
        case Kind::Constant:
            v[i] = {o.c, Vec3d(0.0), {}};
            break;
        case Kind::Leaf:
            v[i] = blobLeafJet(leaves_[o.a], p);
            break;
        case Kind::Add:
            v[i] = v[o.a] + v[o.b];
            break;
        case Kind::Multiply:
            v[i] = product(v[o.a], v[o.b]);
            break;
        case Kind::Maximum:
            v[i] = v[o.a].f >= v[o.b].f ? v[o.a] : v[o.b];
            break;
        case Kind::Minimum:
            v[i] = v[o.a].f <= v[o.b].f ? v[o.a] : v[o.b];
            break;
        case Kind::Subtract:
            v[i] = v[o.a] + v[o.b] * -1.0;
            break;
        case Kind::Divide:
            v[i] = product(v[o.a], inverse(v[o.b]));
            break;
        case Kind::Negate:
            v[i] = v[o.a] * -1.0;
            break;
        }
    }
    return v[tape.size() - 1];
}

void BlobField::shares(const BlobTape& tape, const Vec3d& p, std::vector<Share>& out) const {
    out.clear();
    // A maximum has the colour of its larger side, a difference or quotient of its first: subtracted blobs have none.
    TapeResults<double> v(tape.size());
    std::vector<bool> shown(tape.size());
    stepValues(tape, v, [&](uint32_t leaf) { return blobLeafJet(leaves_[leaf], p).f; });
    shown[tape.size() - 1] = true;
    double sum = 0;
    Vec3d slope(0.0);
    for (size_t i = tape.size(); i-- > 0;) {
        if (!shown[i]) continue;
        const BlobOp& o = tape[i];
        switch (o.kind) {
        case Kind::Constant:
            break;
        case Kind::Leaf:
            if (leaves_[o.a].kind == BlobLeaf::Kind::Ground) break;
            if (const BlobJet j = blobLeafJet(leaves_[o.a], p); j.f > 0) {
                out.push_back({leaves_[o.a].number, j.f, j.g});
                sum += j.f;
                slope = slope + j.g;
            }
            break;
        case Kind::Maximum:
            shown[v[o.a] >= v[o.b] ? o.a : o.b] = true;
            break;
        case Kind::Minimum:
            shown[v[o.a] <= v[o.b] ? o.a : o.b] = true;
            break;
        case Kind::Subtract:
        case Kind::Divide:
        case Kind::Negate:
            shown[o.a] = true;
            break;
        default:
            shown[o.a] = shown[o.b] = true;
        }
    }
    for (Share& s : out) {
        s.g = (s.g - slope * (s.w / sum)) / sum;
        s.w /= sum;
    }
    std::sort(out.begin(), out.end(), [](const Share& a, const Share& b) { return a.number < b.number; });
}

Interval combinedBounds(const BlobOp& o, const Interval& a, const Interval& b) {
    switch (o.kind) {
    case Kind::Add:
        return {a.lo + b.lo, a.hi + b.hi};
    case Kind::Multiply:
        return multiply(a, b);
    case Kind::Maximum:
        return {std::max(a.lo, b.lo), std::max(a.hi, b.hi)};
    case Kind::Minimum:
        return {std::min(a.lo, b.lo), std::min(a.hi, b.hi)};
    case Kind::Subtract:
        return {a.lo - b.hi, a.hi - b.lo};
    case Kind::Divide:
        return divide(a, b);
    case Kind::Negate:
        return {-a.hi, -a.lo};
    default:
        return {o.c, o.c};
    }
}

Interval BlobField::bounds(const BlobTape& tape, const Vec3d& lo, const Vec3d& hi, std::vector<Interval>& v) const {
    v.resize(tape.size());
    for (size_t i = 0; i < tape.size(); ++i) {
        const BlobOp& o = tape[i];
        if (o.kind == Kind::Leaf) v[i] = blobLeafBounds(leaves_[o.a], lo, hi);
        else if (o.kind == Kind::Constant) v[i] = {o.c, o.c};
        else v[i] = combinedBounds(o, v[o.a], v[o.b]);
    }
    return v.back();
}

BlobTape BlobField::simplified(const BlobTape& tape, const std::vector<Interval>& v) {
    const size_t n = tape.size();
    std::vector<uint32_t> same(n); // the operation that has its value here
    std::vector<bool> needed(n);
    const auto fixed = [&](size_t i) { return v[i].lo == v[i].hi; };
    for (size_t i = 0; i < n; ++i) {
        const BlobOp& o = tape[i];
        same[i] = uint32_t(i);
        if (fixed(i)) continue;
        if (o.kind == Kind::Maximum) {
            if (v[o.a].lo >= v[o.b].hi) same[i] = same[o.a];
            else if (v[o.b].lo >= v[o.a].hi) same[i] = same[o.b];
        } else if (o.kind == Kind::Minimum) {
            if (v[o.a].hi <= v[o.b].lo) same[i] = same[o.a];
            else if (v[o.b].hi <= v[o.a].lo) same[i] = same[o.b];
        } else if (o.kind == Kind::Add) {
            if (fixed(o.a) && v[o.a].lo == 0) same[i] = same[o.b];
            else if (fixed(o.b) && v[o.b].lo == 0) same[i] = same[o.a];
        } else if (o.kind == Kind::Subtract && fixed(o.b) && v[o.b].lo == 0) same[i] = same[o.a];
    }
    needed[same[n - 1]] = true;
    for (size_t i = n; i-- > 0;) {
        const BlobOp& o = tape[i];
        if (!needed[i] || fixed(i) || o.kind == Kind::Leaf || o.kind == Kind::Constant) continue;
        needed[same[o.a]] = true;
        if (o.kind != Kind::Negate) needed[same[o.b]] = true;
    }
    BlobTape out;
    std::vector<uint32_t> at(n);
    for (size_t i = 0; i < n; ++i) {
        if (!needed[i]) continue;
        BlobOp o = tape[i];
        if (fixed(i)) o = {Kind::Constant, 0, 0, v[i].lo};
        else if (o.kind != Kind::Leaf && o.kind != Kind::Constant)
            o.a = at[same[o.a]], o.b = o.kind == Kind::Negate ? 0 : at[same[o.b]];
        at[i] = uint32_t(out.size());
        out.push_back(o);
    }
    return out;
}

} // namespace alpenglow::geometry
