#include "geometry/manifold.h"
#include <algorithm>
#include <map>
#include <numeric>

namespace alpenglow::geometry {

namespace {

/// Corner c stands for the side of its face that begins there.
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
        sharpenBorders(out);
        moveTags(out);
        for (std::vector<float>* list : {&out.cage.creaseSharpness, &out.cage.cornerSharpness})
            for (float& s : *list) {
                out.rounded |= s > 0 && s < 10;
                s = s < 2 ? 0 : 10;
            }
        out.cage.vertices = int(out.original.size());
        out.cage.vertex = out.vertex;
        return out;
    }

private:
    struct Side { int low, high, corner; bool forward; };

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
        std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) { return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner); });
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
    /// The first sheet at a vertex keeps its number.
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
    void sharpenBorders(ManifoldCage& out) {
        for (int c : torn_) {
            out.cage.creaseEnds.insert(out.cage.creaseEnds.end(), {out.vertex[size_t(c)], out.vertex[size_t(next_[size_t(c)])]});
            out.cage.creaseSharpness.push_back(10);
        }
        // Sheets that share both ends of their borders share the curve between; all others meet in a point, which must not move.
        std::vector<uint8_t> several(size_t(in_.vertices), 0);
        for (size_t k = size_t(in_.vertices); k < out.original.size(); ++k) several[size_t(out.original[k])] = 1;
        std::map<int, std::vector<int>> ends; // by vertex of the sheets
        for (size_t c = 0; c < n_; ++c) {
            if (!several[size_t(in_.vertex[c])]) continue;
            auto& list = ends[out.vertex[c]];
            if (pair_[c] < 0) list.push_back(end(int(c)));
            if (pair_[size_t(previous_[c])] < 0) list.push_back(in_.vertex[size_t(previous_[c])]);
        }
        std::map<int, std::vector<int>> first; // by original vertex
        std::map<int, bool> alike;
        for (auto& [v, list] : ends) {
            std::sort(list.begin(), list.end());
            const int o = out.original[size_t(v)];
            const auto [at, isNew] = first.try_emplace(o, list);
            alike.try_emplace(o, true).first->second &= list.size() == 2 && at->second == list;
        }
        for (auto& [v, list] : ends)
            if (!alike[out.original[size_t(v)]]) {
                out.cage.cornerVertex.push_back(v);
                out.cage.cornerSharpness.push_back(10);
            }
    }
    /// Creases and corners of the request hold in every sheet.
    void moveTags(ManifoldCage& out) {
        const size_t creases = in_.creaseSharpness.size(), corners = in_.cornerVertex.size();
        auto& ends = out.cage.creaseEnds;
        std::vector<int> added;
        std::vector<float> sharp;
        for (size_t k = 0; k < creases; ++k) {
            const int low = std::min(ends[2 * k], ends[2 * k + 1]), high = std::max(ends[2 * k], ends[2 * k + 1]);
            auto s = std::lower_bound(sides_.begin(), sides_.end(), std::pair(low, high), [](const Side& a, const std::pair<int, int>& b) { return std::pair(a.low, a.high) < b; });
            for (bool isFirst = true; s != sides_.end() && s->low == low && s->high == high; ++s, isFirst = false) {
                const int a = out.vertex[size_t(s->corner)], b = out.vertex[size_t(next_[size_t(s->corner)])];
                if (isFirst) ends[2 * k] = a, ends[2 * k + 1] = b;
                else added.insert(added.end(), {a, b}), sharp.push_back(out.cage.creaseSharpness[k]);
            }
        }
        // First, so that what is torn stays sharp.
        ends.insert(ends.begin(), added.begin(), added.end());
        out.cage.creaseSharpness.insert(out.cage.creaseSharpness.begin(), sharp.begin(), sharp.end());
        std::vector<int> copies;
        std::vector<float> copied;
        for (size_t v = size_t(in_.vertices); v < out.original.size(); ++v)
            for (size_t k = 0; k < corners; ++k)
                if (out.original[v] == in_.cornerVertex[k]) copies.push_back(int(v)), copied.push_back(in_.cornerSharpness[k]);
        out.cage.cornerVertex.insert(out.cage.cornerVertex.begin(), copies.begin(), copies.end());
        out.cage.cornerSharpness.insert(out.cage.cornerSharpness.begin(), copied.begin(), copied.end());
    }

    const SubdivisionCage& in_;
    size_t n_;
    std::vector<int> next_, previous_, pair_, set_; ///< per corner; pair: the same side in the neighbour, or -1
    std::vector<Side> sides_;
    std::vector<int> torn_;                         ///< sides of edges that cannot be paired
};

} // namespace

ManifoldCage makeManifold(const SubdivisionCage& c) { return Splitter(c).split(); }

} // namespace alpenglow::geometry
