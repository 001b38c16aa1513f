// Construction: ranges of references are split by the surface area heuristic (bvh_cut.h), large ones over groups
// (bvh_groups.h).
#include "accel/bvh_cut.h"
#include "accel/bvh_groups.h"
#include "accel/bvh_leaf.h"
#include "base/parallel.h"
#include "geometry/keyed.h"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace alpenglow::accel {

namespace {

constexpr size_t kParallel = 8192; // with fewer references a separate task costs more than it saves
constexpr size_t kExactRun = 256;  // exact primitives that are measured at once
constexpr size_t kPieces = 65536;  // with at most so many references all pieces are held at once: some megabytes of a thread
constexpr size_t kGrouped = 512;   // larger ranges are put into groups first

} // namespace

struct Bvh::Builder {
    Bvh& tree;
    std::span<const geometry::ShapeRef> shapes, keys;
    std::span<const Part> parts;
    bool quick = false;     ///< over the leaves of grids
    uint32_t triangles = 0; // larger numbers are primitives of exact shapes: exact[number - triangles]
    size_t exacts = 0;      ///< primitives of exact shapes: first the parts, then those of shapes in order
    std::vector<Mesh> exactShapes;
    std::vector<uint32_t> placeOf; ///< by exact primitive: its position in the tree
    std::unique_ptr<Ref[]> refs;
    size_t groups = 0; ///< references to triangles, which come first
    // Nodes in the order of creation by any thread, in pieces that do not move. A leaf's child is the index of its first
    // reference, and its size is in `spare` by child.
    static constexpr size_t kPiece = 1024;
    std::vector<std::unique_ptr<Node[]>> pieces;
    std::atomic<size_t> made{0};
    std::mutex growing;

    Node& node(size_t i) { return pieces[i / kPiece][i % kPiece]; }
    size_t newNode() {
        const size_t i = made.fetch_add(1);
        if (i / kPiece >= pieces.size()) throw std::length_error("nodes"); // impossible: see room()
        std::lock_guard lock(growing);
        if (!pieces[i / kPiece]) pieces[i / kPiece] = std::make_unique<Node[]>(kPiece);
        return i;
    }

    /// Whether references form one leaf.
    bool isLeaf(const Range& r) const {
        if (r.size() == 1) return true; // references that belong together fit
        if (r.size() > kLeafTriangles) return false;
        const std::span of(&refs[r.begin], r.size());
        return std::all_of(of.begin(), of.end(), [&](const Ref& ref) { return ref.id() < triangles; }) &&
               LeafMaker{tree, shapes}.fits(of);
    }
    bool allExact(const Range& r) const {
        return std::all_of(&refs[r.begin], &refs[0] + r.end, [&](const Ref& ref) { return ref.id() >= triangles; });
    }

    Range measured(size_t begin, size_t end) const {
        Range r = measuredRange(refs.get(), begin, end);
        r.leaf = isLeaf(r);
        return r;
    }
    void split(const Range& r, bool halves, Range& a, Range& b) {
        if (!halves && r.size() > 2 && cutInTwo(refs.get(), r, a, b)) {
            a.leaf = isLeaf(a);
            b.leaf = isLeaf(b);
            return;
        }
        a = measured(r.begin, r.begin + r.size() / 2);
        b = measured(r.begin + r.size() / 2, r.end);
    }
    std::vector<Half> grouped(const Range& r, int depth) {
        std::vector<Half> halves = inGroups(refs.get(), r, depth);
        for (Half& h : halves) h.range.leaf = isLeaf(h.range);
        return halves;
    }

    /// A range divided recursively down to its leaves; a cost, the sum of areas of all nodes, selects which of these pieces
    /// become children of nodes (Ylitie et al., section 3.1).
    struct Pieces {
        struct Piece {
            Box box;
            uint32_t size;
            bool leaf;
            size_t begin;
            int left = -1, right = -1; // -1: a leaf. Only right is -1: `size` leaves from `left` on
            // By number of children: smallest cost if they are this piece or below it; and how many of them are then on its left
            // side, 0: it is a single child.
            float cost[kWidth + 1] = {};
            uint8_t lefts[kWidth + 1] = {};
        };
        std::vector<Piece> list;

        int divide(Builder& builder, const Range& r, int depth) {
            const int at = int(list.size());
            list.push_back({.box = r.box, .size = uint32_t(r.size()), .leaf = r.leaf, .begin = r.begin});
            if (r.leaf) return at;
            if (r.size() <= 4 && builder.allExact(r)) return fan(builder, r, at);
            if (r.size() > kGrouped && depth < kDeepest / 2)
                if (const std::vector<Half> halves = builder.grouped(r, kDeepest - 32 - depth); !halves.empty()) {
                    list.pop_back();
                    return take(builder, halves, 0, depth);
                }
            Range first, second;
            builder.split(r, depth >= kDeepest - 20, first, second);
            const int left = divide(builder, first, depth + 1);
            return join(at, left, divide(builder, second, depth + 1));
        }
        /// A range divided into groups.
        int take(Builder& builder, const std::vector<Half>& halves, int half, int depth) {
            const Half& h = halves[size_t(half)];
            if (h.left < 0 || h.range.leaf) return divide(builder, h.range, depth);
            const int at = int(list.size());
            list.push_back({.box = h.range.box, .size = uint32_t(h.range.size()), .leaf = false, .begin = h.range.begin});
            const int left = take(builder, halves, h.left, depth + 1);
            return join(at, left, take(builder, halves, h.right, depth + 1));
        }
        /// Primitives of one node: their further division hardly matters.
        int fan(Builder& builder, const Range& r, int at) {
            Piece& p = list[size_t(at)];
            p.left = int(list.size());
            for (uint32_t n = 1; n <= kWidth; ++n) {
                const bool open = n >= p.size;
                p.cost[n] = open ? 0 : float(p.box.halfArea());
                p.lefts[n] = open;
            }
            p.cost[1] = float(p.box.halfArea());
            for (size_t i = r.begin; i < r.end; ++i) {
                const Ref& ref = builder.refs[i];
                list.push_back({.box = Box{ref.lo, ref.hi}, .size = 1, .leaf = true, .begin = i});
            }
            return at;
        }
        int join(int at, int left, int right) {
            list[size_t(at)].left = left;
            list[size_t(at)].right = right;
            weigh(list[size_t(at)]);
            return at;
        }
        void weigh(Piece& p) const {
            const float *l = list[size_t(p.left)].cost, *r = list[size_t(p.right)].cost;
            for (int n = 2; n <= kWidth; ++n) {
                p.cost[n] = INFINITY;
                p.lefts[n] = 1; // also if areas overflow
                for (int k = 1; k < n; ++k)
                    if (const float c = l[k] + r[n - k]; c < p.cost[n]) p.cost[n] = c, p.lefts[n] = uint8_t(k);
            }
            p.cost[1] = float(p.box.halfArea()) + p.cost[kWidth];
            for (int n = 2; n < kWidth; ++n)
                if (p.cost[1] <= p.cost[n]) p.cost[n] = p.cost[1], p.lefts[n] = 0;
        }
        void children(int piece, int n, int out[kWidth], int& count) const {
            const Piece& p = list[size_t(piece)];
            if (p.left < 0 || n == 1 || (n < kWidth && !p.lefts[n])) {
                out[count++] = piece;
                return;
            }
            if (p.right < 0) {
                for (uint32_t k = 0; k < p.size; ++k) out[count++] = p.left + int(k);
                return;
            }
            children(p.left, p.lefts[n], out, count);
            children(p.right, n - p.lefts[n], out, count);
        }
    };
    size_t makeNode(const Pieces& of, int piece) {
        int child[kWidth], n = 0;
        of.children(piece, kWidth, child, n);
        Box boxes[kWidth];
        for (int k = 0; k < n; ++k) boxes[k] = of.list[size_t(child[k])].box;
        const size_t at = newNode();
        Node& out = this->node(at);
        setBoxes(out, of.list[size_t(piece)].box, {boxes, size_t(n)});
        for (int k = 0; k < n; ++k) {
            const Pieces::Piece& p = of.list[size_t(child[k])];
            out.child[k] = uint32_t(p.leaf ? p.begin : makeNode(of, child[k]));
            out.spare[k] = uint8_t(p.leaf ? p.size : 0);
        }
        return at;
    }

    size_t makeNode(const Range& all, int depth) {
        if (all.size() <= kPieces) {
            Pieces small;
            small.list.reserve(all.size());
            return makeNode(small, small.divide(*this, all, depth));
        }
        std::vector<Half> halves;
        if (depth < 12) halves = grouped(all, 24);
        return makeNode({all, halves.empty() ? -1 : 0}, halves, depth);
    }
    /// A range, and the index of its half, or -1: not yet divided.
    struct Open {
        Range range;
        int half = -1;
    };
    size_t makeNode(const Open& all, const std::vector<Half>& halves, int depth) {
        Open child[kWidth] = {all};
        int n = 1;
        while (n < kWidth) {
            int largest = -1;
            for (int k = 0; k < n; ++k) {
                const Range& r = child[k].range;
                if (!r.leaf && (largest < 0 || r.box.halfArea() > child[largest].range.box.halfArea())) largest = k;
            }
            if (largest < 0) break;
            Open &first = child[largest], &second = child[n++];
            if (const Half* h = first.half < 0 ? nullptr : &halves[size_t(first.half)]; h && h->left >= 0) {
                first = {halves[size_t(h->left)].range, h->left};
                second = {halves[size_t(h->right)].range, h->right};
            } else {
                const Range r = first.range;
                first.half = -1;
                split(r, depth >= kDeepest / 2, first.range, second.range);
            }
        }
        const size_t at = newNode();
        Node& node = this->node(at);
        Box boxes[kWidth];
        for (int k = 0; k < n; ++k) boxes[k] = child[k].range.box;
        setBoxes(node, all.range.box, {boxes, size_t(n)});
        TaskGroup below;
        for (int k = 0; k < n; ++k) {
            const Open& c = child[k];
            const auto make = [&, k] {
                const bool goesOn = c.half >= 0 && halves[size_t(c.half)].left >= 0 && c.range.size() > kPieces;
                node.child[k] = uint32_t(goesOn ? makeNode(c, halves, depth + 1) : makeNode(c.range, depth + 1));
            };
            if (c.range.leaf) {
                node.child[k] = uint32_t(c.range.begin);
                node.spare[k] = uint8_t(c.range.size());
            } else if (c.range.size() > kParallel) {
                below.run(make);
            } else {
                make();
            }
        }
        below.wait();
        return at;
    }

    /// Depth first, with adjacent children: rays visit near memory next.
    void arrange(size_t root) {
        std::vector<Node> nodes;
        nodes.reserve(made);
        struct Leaves {
            uint32_t begin, size;
        };
        std::vector<Leaves> leaves;
        nodes.push_back(node(root));
        const auto place = [&](const auto& self, size_t at) -> void {
            uint32_t inner[kWidth];
            int n = 0;
            for (int k = 0; k < kWidth; ++k) {
                const uint32_t c = nodes[at].child[k];
                if (c == kNothing) continue;
                if (const uint8_t size = nodes[at].spare[k]) {
                    const uint32_t id = refs[c].id();
                    if (id >= triangles) {
                        nodes[at].child[k] = kLeaf | kExact | uint32_t(tree.exact_.size());
                        placeOf[id - triangles] = uint32_t(tree.exact_.size());
                        tree.exact_.push_back(exactAt(id - triangles));
                        continue;
                    }
                    if (leaves.size() >= kIndex) throw std::length_error("leaves");
                    nodes[at].child[k] = kLeaf | uint32_t(leaves.size());
                    leaves.push_back({c, size});
                } else {
                    inner[n++] = uint32_t(nodes.size());
                    nodes[at].child[k] = uint32_t(nodes.size());
                    nodes.push_back(node(c));
                }
            }
            std::memset(nodes[at].spare, 0, sizeof nodes[at].spare);
            for (int k = 0; k < n; ++k) self(self, inner[k]);
        };
        placeOf.resize(exacts);
        place(place, 0);
        pieces.clear();
        tree.leaves_.resize(leaves.size());
        parallelFor(size_t(0), leaves.size(),
                    [&](size_t i) { LeafMaker{tree, shapes}.make({&refs[leaves[i].begin], leaves[i].size}, &tree.leaves_[i]); });
        refs.reset();
        makeCapsules();
        tree.nodes_ = std::move(nodes);
        if (!quick && keys.empty() && parts.empty() && !tree.capsules()) tree.orderChildren();
    }

    void makeCapsules() {
        std::vector<const geometry::InCapsules*>& of = tree.inCapsules_;
        of.resize(shapes.size());
        bool any = false;
        for (size_t s = 0; s < shapes.size(); ++s)
            if (shapes[s]->exact() && !shapes[s]->placed())
                any |= (of[s] = dynamic_cast<const geometry::InCapsules*>(shapes[s].get())) != nullptr;
        if (!any) {
            of.clear();
            return;
        }
        tree.capsules_.resize(tree.exact_.size());
        eachExactRun([&](const Exact& first, size_t from, size_t to) {
            geometry::Capsule run[kExactRun];
            if (!(first.shape & kPart) && of[first.shape]) of[first.shape]->capsules(first.prim, {run, to - from});
            else
                for (size_t i = from; i < to; ++i) run[i - from].radius = INFINITY;
            for (size_t i = from; i < to; ++i) tree.capsules_[placeOf[i]] = run[i - from];
        });
    }
    Exact exactAt(size_t i) const {
        if (i < parts.size()) return parts[i].as;
        const auto next =
            std::upper_bound(exactShapes.begin(), exactShapes.end(), i, [](size_t at, const Mesh& m) { return at < m.first; });
        return {next[-1].shape, uint32_t(i) - next[-1].first};
    }
    /// Runs f(first, from, to) for consecutive primitives of one exact shape, or for some parts, on any thread.
    template <class F> void eachExactRun(F f) const {
        parallelFor(size_t(0), (exacts + kExactRun - 1) / kExactRun, [&](size_t run) {
            const size_t end = std::min(exacts, (run + 1) * kExactRun);
            for (size_t from = run * kExactRun, to; from < end; from = to) {
                const Exact first = exactAt(from);
                to = from < parts.size() ? parts.size() : from + shapes[first.shape]->exactPrims() - first.prim;
                to = std::min(to, end);
                f(first, from, to);
            }
        });
    }

    /// Lists all primitives of exact shapes; the parts come first.
    void listExact() {
        std::vector<uint8_t> inParts(parts.empty() ? 0 : shapes.size());
        for (const Part& p : parts) inParts[p.shape] = 1;
        const auto primsOf = [&](uint32_t s) {
            return shapes[s]->exact() && (parts.empty() || !inParts[s]) ? shapes[s]->exactPrims() : 0;
        };
        exacts = parts.size();
        for (uint32_t s = 0; s < shapes.size(); ++s)
            if (const uint32_t many = primsOf(s)) {
                if (triangles + exacts + many >= kIndex) throw std::length_error("exact primitives");
                exactShapes.push_back({uint32_t(exacts), s});
                exacts += many;
            }
    }
    /// Removes triangles that reach too far, before the others get boxes.
    void leaveOut() {
        Ref* const end = &refs[0] + groups + exacts;
        [[maybe_unused]] const Ref* const kept =
            std::remove_if(&refs[0], end, [&](const Ref& r) { return r.id() < triangles && tooFar(r); });
    }

    /// Triangles of one mesh that one thread handles.
    struct Run {
        uint32_t mesh, from, to;
        size_t at = 0; ///< index of its references
    };
    template <class F> void eachTogether(const Run& run, F f) const {
        const geometry::Shape& shape = *shapes[tree.meshes_[run.mesh].shape];
        const bool grid = quick && keys.empty() && shape.diced();
        for (uint32_t t = run.from; t < run.to;) {
            const uint32_t many = grid ? together(shape.mesh(), t, run.to) : keys.empty() ? pair(shape.mesh(), t, run.to) : 1;
            f(shape.mesh(), t, many);
            t += many;
        }
    }
    void makeTriangleRefs() {
        constexpr uint32_t kRun = 3 * 8192;
        std::vector<Run> runs;
        for (uint32_t k = 0; k < tree.meshes_.size(); ++k) {
            const uint32_t n = shapes[tree.meshes_[k].shape]->mesh().triangles();
            for (uint32_t from = 0; from < n; from += kRun) runs.push_back({k, from, std::min(n, from + kRun)});
        }
        parallelFor(size_t(0), runs.size(), [&](size_t i) {
            eachTogether(runs[i], [&](const geometry::TriMesh&, uint32_t, uint32_t) { ++runs[i].at; });
        });
        for (Run& r : runs) groups += std::exchange(r.at, groups);
        refs.reset(new Ref[groups + exacts]);
        std::atomic<size_t> beyond{0};
        std::atomic<uint32_t> beyondOf{uint32_t(shapes.size())};
        parallelFor(size_t(0), runs.size(), [&](size_t i) {
            size_t at = runs[i].at;
            const Mesh& mesh = tree.meshes_[runs[i].mesh];
            eachTogether(runs[i], [&](const geometry::TriMesh& m, uint32_t first, uint32_t many) {
                Box b;
                for (size_t c = 3 * size_t(first); c < 3 * size_t(first + many); ++c) {
                    const uint32_t v = m.index[c];
                    const auto add = [&](const Vec3& p) { b.add(Four{p.x, p.y, p.z, 0}, Four{p.x, p.y, p.z, 0}); };
                    add(m.P[v]);
                    for (const geometry::ShapeRef& key : keys) add(key->mesh().P[v]);
                }
                Ref& r = refs[at++];
                r.lo = b.lo;
                r.hi = b.hi;
                r.setId(mesh.first + first);
                r.hi[3] = float(many);
                if (!tooFar(r)) return;
                ++beyond;
                for (uint32_t s = mesh.shape, known = beyondOf; s < known && !beyondOf.compare_exchange_weak(known, s);) {}
            });
        });
        tree.beyond_ = beyond;
        if (beyond > 0) tree.beyondOf_ = beyondOf;
    }

    void makeExactRefs() {
        eachExactRun([&](const Exact& first, size_t from, size_t to) {
            geometry::Bounds bounds[kExactRun];
            if (from < parts.size()) {
                for (size_t i = from; i < to; ++i) bounds[i - from] = parts[i].bounds;
            } else {
                const geometry::Shape& shape = *shapes[first.shape];
                const auto* keyed = to > from + 1 ? dynamic_cast<const geometry::KeyedShape*>(&shape) : nullptr;
                if (keyed) keyed->treeBoundsOf(first.prim, {bounds, to - from});
                else
                    for (size_t i = 0; i < to - from; ++i) bounds[i] = shape.exactBounds(first.prim + uint32_t(i));
            }
            for (size_t i = from; i < to; ++i) refs[groups + i] = refOf(triangles + uint32_t(i), bounds[i - from]);
        });
    }

    void listMeshes() {
        size_t count = 0;
        for (uint32_t s = 0; s < shapes.size(); ++s) {
            if (shapes[s]->exact()) continue;
            if (!shapes[s]->mesh().triangles()) continue;
            tree.meshes_.push_back({uint32_t(count), s});
            count += shapes[s]->mesh().triangles();
            if (count >= kIndex) throw std::length_error("triangles");
        }
        triangles = uint32_t(count);
        tree.first_.resize(count / (1u << kCoarse) + 1);
        for (size_t i = 0, k = 0; i < tree.first_.size(); ++i) {
            while (k + 1 < tree.meshes_.size() && tree.meshes_[k + 1].first <= i << kCoarse) ++k;
            tree.first_[i] = uint32_t(k);
        }
    }

    void run() {
        listMeshes();
        listExact();
        if (!triangles && !exacts) return;
        makeTriangleRefs();
        tree.exact_.reserve(exacts);
        makeExactRefs();
        const size_t all = groups + exacts;
        pieces.resize(all / kPiece + 2); // a node has at least two children
        if (tree.beyond_ > 0) leaveOut();
        const size_t kept = all - tree.beyond_;
        if (!kept) return;
        const Range root = measured(0, kept);
        for (int a = 0; a < 3; ++a) tree.bounds_.lo[a] = root.box.lo[a], tree.bounds_.hi[a] = root.box.hi[a];
        arrange(root.leaf ? lone(root) : makeNode(root, 0));
    }
    size_t lone(const Range& r) {
        const size_t at = newNode();
        setBoxes(node(at), r.box, {&r.box, 1});
        node(at).child[0] = uint32_t(r.begin);
        node(at).spare[0] = uint8_t(r.size());
        return at;
    }
};

void Bvh::build(std::span<const geometry::ShapeRef> shapes, std::span<const geometry::ShapeRef> keys,
                std::span<const float> times, std::span<const Part> parts, Building building) {
    Builder b{.tree = *this, .shapes = shapes, .keys = keys, .parts = parts, .quick = building == Building::Quick};
    b.run();
    if (keys.size() > 1 && !nodes_.empty()) followKeys(keys, times);
}

} // namespace alpenglow::accel
