// Stage chooseLights: LightChooser::choose() (world/lightchooser.cpp) for the points of a block, operation by operation.
#pragma once
#include "lanes/lighttree.h"
#include "lanes/records.h"

namespace alpenglow::lanes::AL_NAMESPACE {

typedef int64_t vl __attribute__((ext_vector_type(ALPENGLOW_LANES))); ///< mask of vd

/// Conversions of each lane: to double, to 64-bit and to 32-bit masks.
AL_INLINE vd doubles(vf x) { return __builtin_convertvector(x, vd); }
AL_INLINE vl longMask(vm m) { return __builtin_convertvector(m, vl); }
AL_INLINE vm shortMask(vl m) { return __builtin_convertvector(m, vm); }
/// Rounded correctly.
AL_INLINE vd rootOf(vd x) { return __builtin_elementwise_sqrt(x); }
/// X, but 0 for negative x and NaN.
AL_INLINE vd least0(vd x) { return 0 < x ? x : vd(0); }
/// True where x is neither infinite nor NaN.
AL_INLINE vl isFinite(vd x) { return __builtin_elementwise_abs(x) < vd(__builtin_inf()); }

/// Nodes in registers, one for each lane.
struct NodeLanes {
    /// LightNode's members of these names, by lane.
    V3 centre;
    vi next, count;
    vm everywhere, faces;
    vd power, radius2, blind, wide2;
};
/// Doubles from the rows of their two words.
AL_INLINE vd doubleOf(vu low, vu high) {
    const vu half[2] = {inTurns<0>(low, high, LaneNumbers()), inTurns<1>(low, high, LaneNumbers())};
    vd v;
    __builtin_memcpy(&v, half, sizeof v);
    return v;
}
/// Transposes structures of 16 words, one for each lane, into rows.
AL_INLINE void loadRows(const void* const (&of)[kW], vu (&row)[16]) {
    for (int first = 0; first < 16; first += kW) {
        vu square[kW];
        for (int k = 0; k < kW; ++k) __builtin_memcpy(&square[k], static_cast<const char*>(of[k]) + 4 * first, sizeof square[k]);
        transpose(square);
        for (int k = 0; k < kW; ++k) row[first + k] = square[k];
    }
}
/// The same bits as floats; complete nodes from the addresses of LightNode.
AL_INLINE vf floatsOf(vu v) { return __builtin_bit_cast(vf, v); }
AL_INLINE NodeLanes loadNodes(const void* const (&of)[kW]) {
    vu row[16];
    loadRows(of, row);
    NodeLanes n;
    n.centre = {floatsOf(row[0]), floatsOf(row[1]), floatsOf(row[2])};
    n.next = __builtin_bit_cast(vi, row[3]);
    n.power = doubleOf(row[4], row[5]);
    n.radius2 = doubleOf(row[6], row[7]);
    n.blind = doubleOf(row[8], row[9]);
    n.wide2 = doubleOf(row[10], row[11]);
    n.count = __builtin_bit_cast(vi, row[12]);
    n.everywhere = (row[13] & LightNode::kEverywhere) != 0;
    n.faces = (row[13] & LightNode::kFaces) != 0;
    return n;
}

/// Squared distance from the node's centre.
AL_INLINE vd distance2(const NodeLanes& n, const V3& at) {
    const V3 to = n.centre - at;
    const vd d2 = doubles(dot(to, to));
    return d2 < n.radius2 ? n.radius2 : d2;
}

/// Rotates a direction by an angle toward an axis.
AL_INLINE void turn(vd c, vd s, vd& cosine, vd& sine) {
    const vd before = cosine;
    const vl there = before > c;
    cosine = there ? vd(1) : before * c + sine * s;
    sine = there ? vd(0) : sine * c - before * s;
}

/// LightChooser::towards().
static vd towards(const void* const (&of)[kW], const V3& at) {
    vu row[16];
    loadRows(of, row);
    const auto wide = [&](int r) { return doubles(floatsOf(row[r])); };
    const vd x = doubles(at.x) - wide(3), y = doubles(at.y) - wide(4), z = doubles(at.z) - wide(5), d2 = x * x + y * y + z * z;
    const vd radius2 = doubleOf(row[6], row[7]), c = rootOf(1 - radius2 / d2);
    vd cosine = (x * wide(0) + y * wide(1) + z * wide(2)) / rootOf(d2), sine = rootOf(least0(1 - cosine * cosine));
    turn(doubleOf(row[8], row[9]), doubleOf(row[10], row[11]), cosine, sine);
    turn(c, rootOf(least0(1 - c * c)), cosine, sine);
    return d2 > radius2 ? (cosine < 0 ? vd(0) : cosine) : vd(1);
}
/// Whether any lane is set.
AL_INLINE bool anyOf(vm m) { return __builtin_reduce_or(m) != 0; }

/// Descents in the tree for all points: current node, its share, start in the cumulative probabilities, and teeth of the comb
/// before that.
struct Ways {
    static constexpr int kRoom = kBlock * (LightTree::kMostChosen + 1) + kW; ///< most descents at a time
    /// By descent: node and point of the block; position; random number in [0, 1); share, start and teeth.
    int32_t next[kRoom], lane[kRoom];
    float at[3][kRoom];
    double random[kRoom], share[kRoom], begin[kRoom], teeth[kRoom];
    int size = 0; ///< number of descents
    /// Replaces an entry by the last one.
    void drop(int i) {
        const int last = --size;
        next[i] = next[last], lane[i] = lane[last];
        for (int q = 0; q < 3; ++q) at[q][i] = at[q][last];
        random[i] = random[last], share[i] = share[last], begin[i] = begin[last], teeth[i] = teeth[last];
    }
};
/// The two children, by descent.
struct Children {
    int32_t next[2][Ways::kRoom], count[2][Ways::kRoom]; ///< by child and descent: LightNode::next and count
    /// By child and descent: importance, and share of what has no direction.
    double weight[2][Ways::kRoom], blind[2][Ways::kRoom];
    int32_t faces[2 * Ways::kRoom]; ///< children whose front counts: twice the descent, plus the child
    int facing;                     ///< number of entries of `faces`
    int32_t over[Ways::kRoom];      ///< descents that have ended, in order
    int ended;                      ///< number of entries of `over`
};
struct Choosing {
    const LightTree& tree; ///< to choose from
    const Row* P;          ///< three rows, current space
    const double* random;  ///< by point, in [0, 1)
    ChosenLight* to;       ///< receives the choices
    int count;             ///< number of choices
    Ways& ways;            ///< scratch
    Children& children;    ///< scratch
};
/// Probability that a light with this share is chosen.
AL_INLINE vd probability(const LightTree& t, vd share, vd blind) { return t.wanted * (t.seeing * share + blind); }
/// Appends the light of a leaf to the choices, with probability p.
AL_INLINE void choose(Choosing& c, int32_t leaf, int lane, double p) {
    c.to[c.count++] = {~leaf, lane, float(1.0 < p ? 1.0 : p)};
}

/// Descends to a node, or takes the light of a leaf.
AL_INLINE void goInto(Choosing& c, int32_t next, int lane, double share, double p, double begin, double teeth) {
    if (next < 0) return choose(c, next, lane, p);
    Ways& w = c.ways;
    const int i = w.size++;
    w.next[i] = next, w.lane[i] = lane;
    for (int q = 0; q < 3; ++q) w.at[q][i] = c.P[q][lane];
    w.random[i] = c.random[lane], w.share[i] = share, w.begin[i] = begin, w.teeth[i] = teeth;
}
/// As many doubles as there are lanes.
AL_INLINE vd loadDoubles(const double* from) {
    vd v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

/// Cuts of points in lanes: each iteration handles one node of some points.
struct CutLanes {
    static constexpr int kTurns = 2 * LightTree::kCut; ///< one for each node that is opened and each that stays
    int32_t next[kTurns][kW], count[kTurns][kW];       ///< by turn and lane: LightNode::next and count
    double importance[kTurns][kW], blind[kTurns][kW];  ///< by turn and lane
    Lanes here[kTurns];                                ///< by turn: lanes that are not done
    int turns;                                         ///< number of turns
    vd total;                                          ///< sum of the importances, by lane
};

/// Finds the cut of each point: the nodes among which its first choice is made.
static void cutAt(const LightTree& t, const V3& at, Lanes asked, CutLanes& c) {
    alignas(64) int32_t node[LightTree::kCut + 1][kW], now[kW], next[kW], place[kW], size[kW];
    for (int k = 0; k < kW; ++k) {
        for (int r = 0; r < t.rootCount; ++r) node[r][k] = t.roots[r];
        now[k] = t.roots[0], place[k] = 0, size[k] = t.rootCount;
    }
    c.total = vd(0);
    c.turns = 0;
    for (vm goes = maskFrom(asked, 0); anyOf(goes); ++c.turns) {
        const void* of[kW];
        for (int k = 0; k < kW; ++k) of[k] = &t.nodes[now[k]];
        const NodeLanes n = loadNodes(of);
        const V3 to = n.centre - at;
        const vd d2 = doubles(dot(to, to));
        const vm opens = goes & shortMask(n.wide2 > d2) & (loadInt(size) < LightTree::kCut), stays = goes & ~opens;
        vd importance = n.power / (d2 < n.radius2 ? n.radius2 : d2);
        importance = isFinite(importance) ? importance : vd(0);
        if (const vm faces = stays & n.faces & ~n.everywhere; anyOf(faces)) {
            for (int k = 0; k < kW; ++k) of[k] = &t.fronts[now[k]];
            importance *= longMask(faces) ? towards(of, at) : vd(1);
        }
        importance = longMask(n.everywhere) ? n.power : importance;
        c.total += longMask(stays) ? importance : vd(0);
        store(c.next[c.turns], n.next), store(c.count[c.turns], n.count);
        store(c.importance[c.turns], importance), store(c.blind[c.turns], n.blind);
        c.here[c.turns] = bitsFrom(stays, 0);
        store(next, n.next);
        for (int k = 0; k < kW; ++k) node[size[k]][k] = next[k] + 1; // counts if the node is opened
        const vi position = loadInt(place) - stays, end = loadInt(size) - opens;
        store(place, position), store(size, end);
        goes &= position < end;
        for (int k = 0; k < kW; ++k) now[k] = node[place[k] < LightTree::kCut ? place[k] : 0][k];
        const vi following = opens ? n.next : loadInt(now);
        store(now, goes ? following : vi(t.roots[0]));
    }
}

/// Adds the cut nodes of the points from `from` on.
static void enterCut(Choosing& c, int from, Lanes points) {
    CutLanes cut;
    cutAt(c.tree, load3(c.P, from), points >> from & ((1u << kW) - 1), cut);
    const vd random = loadDoubles(c.random + from);
    vd sum(0), teeth = __builtin_elementwise_ceil(sum - random);
    const bool seen = !anyOf(maskFrom(points, from) & shortMask(~(cut.total > 0))); // some light is visible from each point
    for (int turn = 0; turn < cut.turns; ++turn) {
        if (!cut.here[turn]) continue;
        const vl here = longMask(maskFrom(cut.here[turn], 0));
        vd share = loadDoubles(cut.importance[turn]) / cut.total;
        if (!seen) share = cut.total > 0 ? share : __builtin_convertvector(loadInt(cut.count[turn]), vd) / c.tree.lights;
        const vd p = probability(c.tree, share, loadDoubles(cut.blind[turn]));
        const vd end = __builtin_elementwise_ceil(sum + p - random);
        alignas(64) double of[4][kW];
        store(of[0], share), store(of[1], p), store(of[2], sum), store(of[3], teeth);
        for (Lanes left = cut.here[turn] & bitsFrom(shortMask((p >= 1) | (end > teeth)), 0); left; left &= left - 1) {
            const int i = __builtin_ctz(left);
            goInto(c, cut.next[turn][i], from + i, of[0][i], of[1][i], of[2][i], of[3][i]);
        }
        sum = here ? sum + p : sum;
        teeth = here ? end : teeth;
    }
}

/// Importances of the children of kW descents from `first` on, without fronts.
static void weigh(const Choosing& c, int first) {
    const Ways& w = c.ways;
    Children& to = c.children;
    const void *left[kW], *right[kW];
    const int count = w.size - first < kW ? w.size - first : kW;
    for (int k = 0; k < kW; ++k) {
        left[k] = &c.tree.nodes[w.next[first + (k < count ? k : 0)]];
        right[k] = static_cast<const LightNode*>(left[k]) + 1;
    }
    const V3 at{load(w.at[0] + first), load(w.at[1] + first), load(w.at[2] + first)};
    const NodeLanes a = loadNodes(left), b = loadNodes(right);
    // Only the ratio of the importances matters: both are multiplied by both squared distances, for a single division.
    const vl everywhere = longMask(a.everywhere);
    store(to.weight[0] + first, everywhere ? a.power : a.power * distance2(b, at));
    store(to.weight[1] + first, everywhere ? b.power : b.power * distance2(a, at));
    store(to.blind[0] + first, a.blind), store(to.blind[1] + first, b.blind);
    store(to.next[0] + first, a.next), store(to.next[1] + first, b.next);
    store(to.count[0] + first, a.count), store(to.count[1] + first, b.count);
    const Lanes here = (1u << count) - 1;
    for (Lanes some = here & bitsFrom(a.faces, 0); some; some &= some - 1)
        to.faces[to.facing++] = 2 * (first + __builtin_ctz(some));
    for (Lanes some = here & bitsFrom(b.faces, 0); some; some &= some - 1)
        to.faces[to.facing++] = 2 * (first + __builtin_ctz(some)) + 1;
}

/// Applies the fronts of kW children from `first` of those with one.
static void face(const Choosing& c, int first) {
    const Ways& w = c.ways;
    Children& to = c.children;
    const int count = to.facing - first < kW ? to.facing - first : kW;
    const void* of[kW];
    alignas(64) Row place[3];
    for (int k = 0; k < kW; ++k) {
        const int which = to.faces[first + (k < count ? k : 0)], i = which >> 1;
        of[k] = &c.tree.fronts[w.next[i] + (which & 1)];
        for (int q = 0; q < 3; ++q) place[q][k] = w.at[q][i];
    }
    alignas(64) double part[kW];
    store(part, towards(of, load3(place, 0)));
    for (int k = 0; k < count; ++k) to.weight[to.faces[first + k] & 1][to.faces[first + k] >> 1] *= part[k];
}

/// One step down for kW of `size` descents from `first` on. Most are updated in place; if both children are entered, the second
/// is appended.
static void goDown(Choosing& c, int first, int size) {
    Ways& w = c.ways;
    Children& of = c.children;
    const int count = size - first < kW ? size - first : kW;
    const vd random = loadDoubles(w.random + first), share = loadDoubles(w.share + first), begin = loadDoubles(w.begin + first),
             teeth = loadDoubles(w.teeth + first), l = loadDoubles(of.weight[0] + first),
             both = l + loadDoubles(of.weight[1] + first);
    const vl seen = (both > 0) & isFinite(both);
    vd toA = l / both;
    if (anyOf(shortMask(~seen))) {
        const vi a = loadInt(of.count[0] + first), b = loadInt(of.count[1] + first);
        toA = seen ? toA : __builtin_convertvector(a, vd) / __builtin_convertvector(a + b, vd);
    }
    const vd shareA = share * toA, shareB = share * (1 - toA);
    const vd pA = probability(c.tree, shareA, loadDoubles(of.blind[0] + first)), middle = begin + pA;
    const vd pB = probability(c.tree, shareB, loadDoubles(of.blind[1] + first));
    const vd below = __builtin_elementwise_ceil(middle - random), end = __builtin_elementwise_ceil(middle + pB - random);
    const vl inA = (pA >= 1) | (below > teeth), inB = (pB >= 1) | (end > below);
    const vm here = maskFrom((1u << count) - 1, 0), a = shortMask(inA), b = shortMask(inB);
    const vl ours = longMask(here), second = ours & ~inA;
    const vi nextA = loadInt(of.next[0] + first), nextB = loadInt(of.next[1] + first), next = a ? nextA : nextB;
    const Lanes leaves = bitsFrom(here & (a | b) & (next < 0), 0), over = leaves | bitsFrom(here & ~(a | b), 0);
    store(w.next + first, here ? next : loadInt(w.next + first));
    store(w.share + first, second ? shareB : ours ? shareA : share);
    store(w.begin + first, second ? middle : begin);
    store(w.teeth + first, second ? below : teeth);
    alignas(64) double to[5][kW];
    store(to[0], inA ? pA : pB), store(to[1], shareB), store(to[2], pB), store(to[3], middle), store(to[4], below);
    for (Lanes some = over; some; some &= some - 1) of.over[of.ended++] = first + __builtin_ctz(some);
    for (Lanes some = leaves; some; some &= some - 1) {
        const int k = __builtin_ctz(some);
        choose(c, w.next[first + k], w.lane[first + k], to[0][k]);
    }
    for (Lanes some = bitsFrom(here & a & b, 0); some; some &= some - 1) {
        const int k = __builtin_ctz(some);
        goInto(c, of.next[1][first + k], w.lane[first + k], to[1][k], to[2][k], to[3][k], to[4][k]);
    }
}

/// Stages::chooseLights.
static int chooseLights(const LightTree& tree, const Row* P, const float* random, Lanes points, ChosenLight* to) {
    alignas(64) double u[kBlock];
    for (int i = 0; i < kBlock; ++i) u[i] = double(random[i]);
    Ways ways;
    Children children;
    Choosing c{tree, P, u, to, 0, ways, children};
    for (int from = 0; from < kBlock; from += kW)
        if (points >> from & ((1u << kW) - 1)) enterCut(c, from, points);
    while (ways.size > 0) {
        children.facing = children.ended = 0;
        const int size = ways.size;
        for (int first = 0; first < size; first += kW) weigh(c, first);
        for (int first = 0; first < children.facing; first += kW) face(c, first);
        for (int first = 0; first < size; first += kW) goDown(c, first, size);
        while (children.ended > 0) ways.drop(children.over[--children.ended]);
    }
    return c.count;
}

} // namespace alpenglow::lanes::AL_NAMESPACE
