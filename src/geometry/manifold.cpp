#include "geometry/manifold.h"
#include <algorithm>
#include <numeric>
#include <tuple>

namespace alpenglow::geometry {

namespace {

/// Corner c represents the side of its face that starts there.
class Splitter {
public:
    explicit Splitter(const SubdivisionCage& c) : in_(c), n_(c.vertex.size()), next_(n_), previous_(n_), pair_(n_, -1), set_(n_) {
        size_t first = 0;
        for (int count : c.corners) {
            for (int k = 0; k < count; ++k) {
                next_[first + size_t(k)] = int(first) + (k + 1) % count;
                previous_[first + size_t(k)] = int(first) + (k + count - 1) % count;
            }
            first += size_t(count);
        }
        std::iota(set_.begin(), set_.end(), 0);
    }
    ManifoldCage split() {
        pairSides();
        for (size_t c = 0; c < n_; ++c)
            if (pair_[c] >= 0) join(int(c), next_[size_t(pair_[c])]);
        ManifoldCage out;
        out.cage = in_;
        nameVertices(out);
        keepBorders(out);
        out.blunted = !in_.creaseSharpness.empty() || !in_.cornerSharpness.empty();
        out.cage.creaseEnds.clear();
        out.cage.creaseSharpness.clear();
        out.cage.cornerVertex.clear();
        out.cage.cornerSharpness.clear();
        out.cage.vertices = int(out.original.size());
        out.cage.vertex = out.vertex;
        return out;
    }

private:
    struct Side {
        int low, high, corner;
        bool forward;
    };

    int end(int c) const { return in_.vertex[size_t(next_[size_t(c)])]; }
    int root(int c) {
        while (set_[size_t(c)] != c) c = set_[size_t(c)] = set_[size_t(set_[size_t(c)])];
        return c;
    }
    void join(int a, int b) {
        a = root(a);
        b = root(b);
        set_[size_t(std::max(a, b))] = std::min(a, b);
    }
    void pairSides() {
        for (size_t c = 0; c < n_; ++c) {
            const int a = in_.vertex[c], b = end(int(c));
            sides_.push_back({std::min(a, b), std::max(a, b), int(c), a < b});
        }
        std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
            return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
        });
        for (size_t i = 0, j; i < n_; i = j) {
            for (j = i + 1; j < n_ && sides_[j].low == sides_[i].low && sides_[j].high == sides_[i].high;) ++j;
            if (j - i == 2 && sides_[i].forward != sides_[i + 1].forward) {
                pair_[size_t(sides_[i].corner)] = sides_[i + 1].corner;
                pair_[size_t(sides_[i + 1].corner)] = sides_[i].corner;
            } else if (j - i > 1) {
                for (size_t k = i; k < j; ++k) torn_.push_back(sides_[k].corner);
            }
        }
    }
    /// The first sheet at a vertex keeps its index.
    void nameVertices(ManifoldCage& out) {
        out.original.resize(size_t(in_.vertices));
        std::iota(out.original.begin(), out.original.end(), 0);
        std::vector<int> name(n_, -1);
        std::vector<uint8_t> taken(size_t(in_.vertices), 0);
        for (size_t c = 0; c < n_; ++c) {
            int& of = name[size_t(root(int(c)))];
            const int v = in_.vertex[c];
            if (of < 0 && !taken[size_t(v)]) of = v, taken[size_t(v)] = 1;
            else if (of < 0) of = int(out.original.size()), out.original.push_back(v);
            out.vertex.push_back(of);
        }
    }
    /// Where borders are not interpolated, faces at them have no limit. Those of the sheets do.
    void keepBorders(ManifoldCage& out) {
        if (in_.boundary != SubdivisionCage::Boundary::None) return;
        out.cage.boundary = SubdivisionCage::Boundary::EdgeOnly;
        std::vector<uint8_t> torn(n_, 0), border(size_t(in_.vertices), 0);
        for (int c : torn_) torn[size_t(c)] = 1;
        for (size_t c = 0; c < n_; ++c)
            if (pair_[c] < 0 && !torn[c]) border[size_t(in_.vertex[c])] = border[size_t(end(int(c)))] = 1;
        size_t first = 0;
        for (size_t f = 0; f < in_.corners.size(); ++f) {
            bool at = false;
            for (int k = 0; k < in_.corners[f]; ++k) at |= border[size_t(in_.vertex[first + size_t(k)])] != 0;
            if (at) out.cage.holes.push_back(int(f));
            first += size_t(in_.corners[f]);
        }
    }

    const SubdivisionCage& in_;
    size_t n_;
    std::vector<int> next_, previous_, pair_, set_; ///< per corner; pair: the same side in the neighbour, or -1
    std::vector<Side> sides_;
    std::vector<int> torn_; ///< sides of edges that cannot be paired
};

} // namespace

ManifoldCage makeManifold(const SubdivisionCage& c) { return Splitter(c).split(); }

} // namespace alpenglow::geometry
