// Building: surface area heuristic over sixteen bins of centroids, the largest child first until there are eight.
#include "accel/tree_refs.h"
#include "base/parallel.h"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace alpenglow::accel {

namespace {

constexpr int kBins = 16;
constexpr size_t kParallel = 8192; // references below which a task of its own costs more than it brings

} // namespace

struct Tree::Builder {
    Tree& tree;
    std::span<const geometry::ShapeRef> shapes, keys;
    std::span<const Part> parts;
    bool quick = false;     ///< over the leaves of grids
    uint32_t triangles = 0; // numbers from here on are primitives of exact shapes: exact[number - triangles]
    std::vector<Exact> exact;
    std::unique_ptr<Ref[]> refs;
    size_t groups = 0; ///< references to triangles, the first ones
    // Nodes as they come, by any thread: pieces that stay where they are. A leaf's child is the number of its first reference,
    // and its size lies in `spare` by child.
    static constexpr size_t kPiece = 1024;
    std::vector<std::unique_ptr<Node[]>> pieces;
    std::atomic<size_t> made{0};
    std::mutex growing;

    Node& node(size_t i) { return pieces[i / kPiece][i % kPiece]; }
    size_t newNode() {
        const size_t i = made.fetch_add(1);
        if (i / kPiece >= pieces.size()) throw std::length_error("nodes"); // never: see room()
        std::lock_guard lock(growing);
        if (!pieces[i / kPiece]) pieces[i / kPiece] = std::make_unique<Node[]>(kPiece);
        return i;
    }

    void triangle(uint32_t id, Vec3 corner[3]) const {
        uint32_t shape, prim;
        tree.find(id, shape, prim);
        const geometry::TriMesh& m = shapes[shape]->mesh();
        for (int k = 0; k < 3; ++k) corner[k] = m.P[m.index[3 * size_t(prim) + size_t(k)]];
    }
    /// The vertices of a leaf of these references, and its list of corners. False: they do not make one leaf.
    bool leafOf(const Range& r, Leaf* out) const {
        if (r.size() == 1 && (refs[r.begin].id() >= triangles || !out)) return true; // what comes together has room
        if (r.size() > kLeafTriangles) return false;
        Vec3 vertex[kLeafVertices];
        size_t n = 0, t = 0;
        uint64_t corners = 0;
        for (size_t i = r.begin; i < r.end; ++i) {
            const uint32_t first = refs[i].id(), many = refs[i].many();
            if (first >= triangles || t + many > kLeafTriangles) return false;
            for (uint32_t id = first; id < first + many; ++id, ++t) {
                Vec3 corner[3];
                triangle(id, corner);
                for (size_t k = 0; k < 3; ++k) {
                    const auto same = [&](const Vec3& v) { return std::memcmp(&v, &corner[k], sizeof v) == 0; };
                    const size_t v = size_t(std::find_if(vertex, vertex + n, same) - vertex);
                    if (v == n) {
                        if (n == kLeafVertices) return false;
                        vertex[n++] = corner[k];
                    }
                    corners |= uint64_t(v) << Leaf::cornerAt(t, int(k));
                }
                if (out) out->id[t] = id;
            }
        }
        if (!out) return true;
        out->corners = corners | uint64_t(t) << 59;
        for (size_t v = 0; v < kLeafVertices; ++v)
            for (int a = 0; a < 3; ++a) out->p[a][v] = vertex[std::min(v, n - 1)][a];
        return true;
    }

    Range measured(size_t begin, size_t end) const {
        Range r;
        r.begin = begin;
        r.end = end;
        for (size_t i = begin; i < end; ++i) {
            r.box.add(refs[i].lo, refs[i].hi);
            const Four c = refs[i].twiceCentre();
            r.centres.add(c, c);
        }
        r.leaf = leafOf(r, nullptr);
        return r;
    }

    /// Where to cut: the axis and the bins before it; axis -1: nothing divides the centres.
    struct Cut {
        int axis = -1, bin = 0, bins = kBins;
        Four from{}, scale{};
        Box below, above; ///< of what lies there
    };
    typedef int32_t Whole4 __attribute__((vector_size(16)));
    /// By axis.
    static Whole4 binsOf(const Cut& c, Four twiceCentre) {
        // No float's bits: what has no whole number goes to a bin at an end.
        const Four at = least(most((twiceCentre - c.from) * c.scale, Four{}), all(float(c.bins - 1)));
        return __builtin_convertvector(at, Whole4);
    }
    static Four all(float f) { return Four{f, f, f, f}; }
    Cut bestCut(const Range& r) const {
        Cut cut;
        cut.bins = r.size() <= 4 ? 4 : r.size() <= 16 ? 8 : kBins; // most ranges are small
        cut.from = r.centres.lo;
        const Four wide = r.centres.hi - r.centres.lo;
        bool any = false;
        for (int a = 0; a < 3; ++a) {
            cut.scale[a] = wide[a] > 0 ? float(cut.bins) * 0.99999f / wide[a] : 0;
            if (!std::isfinite(cut.scale[a])) cut.scale[a] = 0;
            any |= cut.scale[a] > 0;
        }
        if (!any) return cut;
        struct Bin {
            Box box;
            size_t n;
        };
        alignas(Bin) std::byte room[3 * kBins * sizeof(Bin)];
        Bin* const bins[3] = {reinterpret_cast<Bin*>(room), reinterpret_cast<Bin*>(room) + kBins,
                              reinterpret_cast<Bin*>(room) + 2 * kBins};
        for (Bin* of : bins)
            for (int k = 0; k < cut.bins; ++k) new (&of[k]) Bin{Box(), 0};
        for (size_t i = r.begin; i < r.end; ++i) {
            const Whole4 at = binsOf(cut, refs[i].twiceCentre());
            for (int a = 0; a < 3; ++a) {
                Bin& b = bins[a][at[a]];
                b.box.add(refs[i].lo, refs[i].hi);
                b.n += refs[i].many();
            }
        }
        // A leaf costs as much for one triangle as for four.
        const auto leaves = [](size_t n) { return double((n + 3) / 4); };
        double lowest = INFINITY;
        for (int a = 0; a < 3; ++a) {
            if (!(cut.scale[a] > 0)) continue;
            double above[kBins] = {};
            Box box;
            size_t n = 0;
            for (int k = cut.bins - 1; k > 0; --k) {
                box.add(bins[a][k].box);
                n += bins[a][k].n;
                above[k] = n ? box.halfArea() * leaves(n) : INFINITY;
            }
            box = Box();
            n = 0;
            for (int k = 1; k < cut.bins; ++k) {
                box.add(bins[a][k - 1].box);
                n += bins[a][k - 1].n;
                const double cost = n ? box.halfArea() * leaves(n) + above[k] : INFINITY;
                if (cost < lowest) lowest = cost, cut.axis = a, cut.bin = k;
            }
        }
        for (int k = 0; cut.axis >= 0 && k < cut.bins; ++k) (k < cut.bin ? cut.below : cut.above).add(bins[cut.axis][k].box);
        return cut;
    }
    void split(const Range& r, bool halves, Range& a, Range& b) {
        const Cut cut = halves || r.size() == 2 ? Cut() : bestCut(r);
        const size_t middle = cut.axis >= 0 ? partition(r, cut, a, b) : r.begin;
        if (middle > r.begin && middle < r.end) {
            a.box = cut.below, b.box = cut.above;
            a.begin = r.begin, a.end = b.begin = middle, b.end = r.end;
            a.leaf = leafOf(a, nullptr);
            b.leaf = leafOf(b, nullptr);
            return;
        }
        a = measured(r.begin, r.begin + r.size() / 2);
        b = measured(r.begin + r.size() / 2, r.end);
    }
    /// Those below a cut to the front; returns where the others begin. a, b: boxes of their centres.
    size_t partition(const Range& r, const Cut& cut, Range& a, Range& b) {
        Ref *front = &refs[r.begin], *back = &refs[0] + r.end;
        Box below, above;
        Four c{};
        const auto isBelow = [&](const Ref& ref) {
            c = ref.twiceCentre();
            return binsOf(cut, c)[cut.axis] < cut.bin;
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
        return size_t(front - &refs[0]);
    }

    /// A range that is divided in two again and again down to its leaves; which of these pieces become the children of nodes is
    /// chosen by cost: the sum of areas of all nodes (Ylitie et al., section 3.1).
    struct Pieces {
        struct Piece {
            Box box;
            uint32_t size;
            bool leaf;
            size_t begin;
            int left = -1, right = -1; // -1: a leaf
            // By a number of children, what it costs at the least when they are this piece or lie below it; and how many of them
            // lie on its left side then, 0: it is one.
            float cost[kWide + 1] = {};
            uint8_t lefts[kWide + 1] = {};
        };
        std::vector<Piece> list;

        int divide(Builder& builder, const Range& r, int depth) {
            const int at = int(list.size());
            list.push_back({.box = r.box, .size = uint32_t(r.size()), .leaf = r.leaf, .begin = r.begin});
            if (r.leaf) return at;
            Range first, second;
            builder.split(r, depth >= kDeepest - 20, first, second);
            const int left = divide(builder, first, depth + 1), right = divide(builder, second, depth + 1);
            list[size_t(at)].left = left;
            list[size_t(at)].right = right;
            weigh(list[size_t(at)]);
            return at;
        }
        void weigh(Piece& p) const {
            const float *l = list[size_t(p.left)].cost, *r = list[size_t(p.right)].cost;
            for (int n = 2; n <= kWide; ++n) {
                p.cost[n] = INFINITY;
                p.lefts[n] = 1; // also where areas have no floats
                for (int k = 1; k < n; ++k)
                    if (const float c = l[k] + r[n - k]; c < p.cost[n]) p.cost[n] = c, p.lefts[n] = uint8_t(k);
            }
            p.cost[1] = float(p.box.halfArea()) + p.cost[kWide];
            for (int n = 2; n < kWide; ++n)
                if (p.cost[1] <= p.cost[n]) p.cost[n] = p.cost[1], p.lefts[n] = 0;
        }
        void children(int piece, int n, int out[kWide], int& count) const {
            const Piece& p = list[size_t(piece)];
            if (p.left < 0 || n == 1 || (n < kWide && !p.lefts[n])) {
                out[count++] = piece;
                return;
            }
            children(p.left, p.lefts[n], out, count);
            children(p.right, n - p.lefts[n], out, count);
        }
    };
    size_t makeNode(const Pieces& of, int piece) {
        int child[kWide], n = 0;
        of.children(piece, kWide, child, n);
        Box boxes[kWide];
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
        constexpr size_t kPieces = 65536; // some megabytes of a thread
        if (all.size() <= kPieces) {
            Pieces small;
            small.list.reserve(all.size());
            return makeNode(small, small.divide(*this, all, depth));
        }
        Range child[kWide] = {all};
        int n = 1;
        while (n < kWide) {
            int largest = -1;
            for (int k = 0; k < n; ++k)
                if (!child[k].leaf && (largest < 0 || child[k].box.halfArea() > child[largest].box.halfArea())) largest = k;
            if (largest < 0) break;
            Range a, b;
            split(child[largest], depth >= kDeepest / 2, a, b);
            child[largest] = a;
            child[n++] = b;
        }
        const size_t at = newNode();
        Node& node = this->node(at);
        Box boxes[kWide];
        for (int k = 0; k < n; ++k) boxes[k] = child[k].box;
        setBoxes(node, all.box, {boxes, size_t(n)});
        TaskGroup below;
        for (int k = 0; k < n; ++k) {
            if (child[k].leaf) {
                node.child[k] = uint32_t(child[k].begin);
                node.spare[k] = uint8_t(child[k].size());
            } else if (child[k].size() > kParallel) {
                below.run([&, k] { node.child[k] = uint32_t(makeNode(child[k], depth + 1)); });
            } else {
                node.child[k] = uint32_t(makeNode(child[k], depth + 1));
            }
        }
        below.wait();
        return at;
    }

    /// Depth first, the children of a node side by side: where rays go next is near.
    void arrange(size_t root) {
        std::vector<Node> nodes;
        nodes.reserve(made);
        struct Leaves {
            size_t begin, size, at;
        };
        std::vector<Leaves> leaves;
        nodes.push_back(node(root));
        const auto place = [&](const auto& self, size_t at) -> void {
            uint32_t inner[kWide];
            int n = 0;
            for (int k = 0; k < kWide; ++k) {
                const uint32_t c = nodes[at].child[k];
                if (c == kNothing) continue;
                if (const uint8_t size = nodes[at].spare[k]) {
                    const uint32_t id = refs[c].id();
                    if (id >= triangles) {
                        nodes[at].child[k] = kLeaf | kExact | uint32_t(tree.exact_.size());
                        tree.exact_.push_back(exact[id - triangles]);
                        continue;
                    }
                    if (leaves.size() >= kIndex) throw std::length_error("leaves");
                    nodes[at].child[k] = kLeaf | uint32_t(leaves.size());
                    leaves.push_back({c, size, 0});
                } else {
                    inner[n++] = uint32_t(nodes.size());
                    nodes[at].child[k] = uint32_t(nodes.size());
                    nodes.push_back(node(c));
                }
            }
            std::memset(nodes[at].spare, 0, sizeof nodes[at].spare);
            for (int k = 0; k < n; ++k) self(self, inner[k]);
        };
        place(place, 0);
        pieces.clear();
        tree.leaves_.resize(leaves.size());
        parallelFor(size_t(0), leaves.size(), [&](size_t i) {
            Range r;
            r.begin = leaves[i].begin;
            r.end = r.begin + leaves[i].size;
            leafOf(r, &tree.leaves_[i]);
        });
        refs.reset();
        exact = {};
        makeCapsules();
        nodes.shrink_to_fit();
        tree.nodes_ = std::move(nodes);
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
        parallelFor(size_t(0), tree.exact_.size(), [&](size_t i) {
            const Exact& e = tree.exact_[i];
            geometry::Capsule& c = tree.capsules_[i];
            if ((e.shape & kPart) || !of[e.shape] || !of[e.shape]->capsule(e.prim, c)) c.radius = INFINITY;
        });
    }

    /// All primitives of exact shapes; the first are the parts.
    void listExact() {
        std::vector<uint8_t> inParts(parts.empty() ? 0 : shapes.size());
        for (const Part& p : parts) inParts[p.shape] = 1;
        const auto primsOf = [&](uint32_t s) {
            return shapes[s]->exact() && (parts.empty() || !inParts[s]) ? shapes[s]->exactPrims() : 0;
        };
        size_t n = parts.size();
        for (uint32_t s = 0; s < shapes.size(); ++s) n += primsOf(s);
        if (triangles + n >= kIndex) throw std::length_error("exact primitives");
        exact.reserve(n);
        for (const Part& p : parts) exact.push_back(p.as);
        for (uint32_t s = 0; s < shapes.size(); ++s)
            for (uint32_t p = 0, many = primsOf(s); p < many; ++p) exact.push_back({s, p});
    }
    /// Triangles that reach too far, before all others are put into boxes.
    void leaveOut() {
        Ref* const end = &refs[0] + groups + exact.size();
        [[maybe_unused]] const Ref* const kept =
            std::remove_if(&refs[0], end, [&](const Ref& r) { return r.id() < triangles && tooFar(r); });
    }

    /// Triangles of one mesh that are looked at by one thread.
    struct Run {
        uint32_t mesh, from, to;
        size_t at = 0; ///< of its references
    };
    template <class F> void eachTogether(const Run& run, F f) const {
        const geometry::Shape& shape = *shapes[tree.meshes_[run.mesh].shape];
        const bool grid = quick && keys.empty() && shape.diced();
        for (uint32_t t = run.from; t < run.to;) {
            const uint32_t many = grid ? together(shape.mesh(), t, run.to) : 1;
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
        refs.reset(new Ref[groups + exact.size()]);
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
        if (!triangles && exact.empty()) return;
        makeTriangleRefs();
        tree.exact_.reserve(exact.size());
        parallelFor(size_t(0), exact.size(), [&](size_t i) {
            refs[groups + i] = refOf(triangles + uint32_t(i),
                                     i < parts.size() ? parts[i].bounds : shapes[exact[i].shape]->exactBounds(exact[i].prim));
        });
        const size_t all = groups + exact.size();
        pieces.resize(all / kPiece + 2); // a node has two children at least
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

void Tree::build(std::span<const geometry::ShapeRef> shapes, std::span<const geometry::ShapeRef> keys,
                 std::span<const float> times, std::span<const Part> parts, Building building) {
    Builder b{.tree = *this, .shapes = shapes, .keys = keys, .parts = parts, .quick = building == Building::Quick};
    b.run();
    if (keys.size() > 1 && !nodes_.empty()) followKeys(keys, times);
}

} // namespace alpenglow::accel
