#include "accel/bvh_cut.h"
#include <new>
#include <utility>

namespace alpenglow::accel {

namespace {

struct Bin {
    Box box;
    uint32_t n;
};

/// Indices are denormal as floats, whose multiplication is slow.
Four withoutId(Four lo) { return reinterpret_cast<Four>(reinterpret_cast<Whole4>(lo) & Whole4{-1, -1, -1, 0}); }

/// Half areas of boxes, relative to the longest side of a box around all: these do not overflow.
struct Areas {
    Four unit;
    explicit Areas(const Box& all) {
        const Four d = all.hi * 0.5f - all.lo * 0.5f;
        const float most = std::max(d[0], std::max(d[1], d[2]));
        unit = all4(most > 0 && std::isfinite(1 / most) ? 1 / most : 1);
    }
    float operator()(const Box& b) const {
        const Four d = b.hi * unit - b.lo * unit, p = d * __builtin_shufflevector(d, d, 1, 2, 0, 3);
        return p[0] + p[1] + p[2];
    }
};

/// A leaf costs the same for one triangle as for four.
float leaves(uint32_t n) { return float((n + 3) / 4); }

template <int Bins> void bestOfBins(const Ref* refs, const Range& r, Cut& cut) {
    alignas(Bin) std::byte room[3 * Bins * sizeof(Bin)];
    const auto bins = reinterpret_cast<Bin(*)[Bins]>(room);
    for (int a = 0; a < 3; ++a)
        for (int k = 0; k < Bins; ++k) new (&bins[a][k]) Bin{Box(), 0};
    for (size_t i = r.begin; i < r.end; ++i) {
        const Four lo = withoutId(refs[i].lo), hi = refs[i].hi;
        const Whole4 at = cut.binsOf(lo + hi);
        const uint32_t many = refs[i].many();
        for (int a = 0; a < 3; ++a) {
            Bin& b = bins[a][at[a]];
            b.box.add(lo, hi);
            b.n += many;
        }
    }
    const Areas area(r.box);
    float above[3][Bins], lowest = INFINITY;
    Box box[3];
    uint32_t n[3] = {};
    for (int k = Bins - 1; k > 0; --k)
        for (int a = 0; a < 3; ++a) {
            box[a].add(bins[a][k].box);
            n[a] += bins[a][k].n;
            above[a][k] = n[a] ? area(box[a]) * leaves(n[a]) : INFINITY;
        }
    for (int a = 0; a < 3; ++a) box[a] = Box(), n[a] = 0;
    for (int k = 1; k < Bins; ++k)
        for (int a = 0; a < 3; ++a) {
            box[a].add(bins[a][k - 1].box);
            n[a] += bins[a][k - 1].n;
            const float cost = n[a] ? area(box[a]) * leaves(n[a]) + above[a][k] : INFINITY;
            if (cost < lowest && cut.scale[a] > 0) lowest = cost, cut.axis = a, cut.bin = k;
        }
    for (int k = 0; cut.axis >= 0 && k < Bins; ++k) (k < cut.bin ? cut.below : cut.above).add(bins[cut.axis][k].box);
}

} // namespace

Cut bestCut(const Ref* refs, const Range& r) {
    Cut cut;
    cut.bins = r.size() <= 4 ? 4 : r.size() <= 32 ? 8 : Cut::kBins; // most ranges are small
    cut.from = r.centres.lo;
    const Four wide = r.centres.hi - r.centres.lo;
    bool any = false;
    for (int a = 0; a < 3; ++a) {
        cut.scale[a] = wide[a] > 0 ? float(cut.bins) * 0.99999f / wide[a] : 0;
        if (!std::isfinite(cut.scale[a])) cut.scale[a] = 0;
        any |= cut.scale[a] > 0;
    }
    if (!any) return cut;
    if (cut.bins == 4) bestOfBins<4>(refs, r, cut);
    else if (cut.bins == 8) bestOfBins<8>(refs, r, cut);
    else bestOfBins<Cut::kBins>(refs, r, cut);
    return cut;
}

namespace {

constexpr size_t kFew = 128;

/// partition() of few references, without data-dependent branches, which are unpredictable.
size_t partitionFew(Ref* refs, const Range& r, const Cut& cut, Range& a, Range& b) {
    Ref above[kFew];
    Ref* front = refs + r.begin;
    size_t n = 0;
    for (const Ref *at = front, *end = refs + r.end; at < end; ++at) {
        const Ref ref = *at;
        const bool isBelow = cut.isBelow(ref.twiceCentre());
        *front = ref; // not beyond `at`
        above[n] = ref;
        front += isBelow;
        n += !isBelow;
    }
    std::copy_n(above, n, front);
    const auto middle = size_t(front - refs);
    const auto centresOf = [&](size_t begin, size_t end) {
        Box box;
        for (size_t i = begin; i < end; ++i) {
            const Four c = refs[i].twiceCentre();
            box.add(c, c);
        }
        return box;
    };
    a.centres = centresOf(r.begin, middle), b.centres = centresOf(middle, r.end);
    return middle;
}

} // namespace

size_t partition(Ref* refs, const Range& r, const Cut& cut, Range& a, Range& b) {
    if (r.size() <= kFew) return partitionFew(refs, r, cut, a, b);
    Ref *front = refs + r.begin, *back = refs + r.end;
    Box below, above;
    Four c{};
    const auto isBelow = [&](const Ref& ref) {
        c = ref.twiceCentre();
        return cut.isBelow(c);
    };
    for (;;) {
        for (; front < back && isBelow(*front); ++front) below.add(c, c);
        if (front == back) break;
        above.add(c, c);
        for (--back; front < back && !isBelow(*back); --back) above.add(c, c);
        if (front == back) break;
        below.add(c, c);
        std::swap(*front++, *back);
    }
    a.centres = below, b.centres = above;
    return size_t(front - refs);
}

bool cutInTwo(Ref* refs, const Range& r, Range& a, Range& b) {
    const Cut cut = bestCut(refs, r);
    if (cut.axis < 0) return false;
    const size_t middle = partition(refs, r, cut, a, b);
    if (middle <= r.begin || middle >= r.end) return false;
    a.box = cut.below, b.box = cut.above;
    a.begin = r.begin, a.end = b.begin = middle, b.end = r.end;
    return true;
}

Range measuredRange(const Ref* refs, size_t begin, size_t end) {
    Range r;
    r.begin = begin;
    r.end = end;
    for (size_t i = begin; i < end; ++i) {
        r.box.add(refs[i].lo, refs[i].hi);
        const Four c = refs[i].twiceCentre();
        r.centres.add(c, c);
    }
    return r;
}

} // namespace alpenglow::accel
