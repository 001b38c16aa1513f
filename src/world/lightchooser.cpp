#include "world/lightchooser.h"
#include "base/exact.h"
#include "geometry/bounds.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace alpenglow::world {

namespace {
constexpr int kBins = 12; // candidate split positions, by axis

float area(const geometry::Bounds& b) {
    const Vec3 d = b.hi - b.lo;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

Vec3 centreOf(const LightNode& n) { return {n.centre[0], n.centre[1], n.centre[2]}; }
void setCentre(LightNode& n, const Vec3& c) {
    for (int q = 0; q < 3; ++q) n.centre[q] = c[q];
}
Cone coneOf(const LightFront& f) { return {{f.axis[0], f.axis[1], f.axis[2]}, float(f.cosine)}; }
LightFront frontOf(const Cone& c) {
    LightFront f{{c.axis.x, c.axis.y, c.axis.z}, {}, 0, double(c.cosine), 0};
    f.sine = std::sqrt(std::max(0.0, 1 - f.cosine * f.cosine));
    return f;
}

/// Squared distance of a node, at least its squared radius.
double distance2(const LightNode& n, const Vec3& at) {
    const Vec3 to = centreOf(n) - at;
    return std::max(double(dot(to, to)), n.radius2);
}

geometry::Bounds boundsOf(const LightBound& l) {
    geometry::Bounds b;
    b.add(l.centre - Vec3(l.radius));
    b.add(l.centre + Vec3(l.radius));
    return b;
}
/// Solid-angle measure of emission with front directions in a cone, up to a constant (Conty Estevez and Kulla).
double spreadOf(const Cone& c) {
    const double angle = c.all() ? kPi : exact::acos(double(c.cosine)), end = std::min(angle + kPi / 2, kPi);
    const auto [s, k] = exact::sinCos(angle);
    return 2 * kPi * (1 - k) + kPi / 2 * (2 * end * s - exact::cos(angle - 2 * end) - 2 * angle * s + k);
}
} // namespace

Cone around(const Cone& a, const Cone& b) {
    if (a.all()) return a;
    if (b.all()) return b;
    const auto angle = [](double cosine) { return exact::acos(std::clamp(cosine, -1.0, 1.0)); };
    const double wideA = angle(double(a.cosine)), wideB = angle(double(b.cosine)), apart = angle(double(dot(a.axis, b.axis)));
    if (std::min(apart + wideB, kPi) <= wideA) return a;
    if (std::min(apart + wideA, kPi) <= wideB) return b;
    const double wide = .5 * (wideA + wideB + apart);
    const Vec3d side = Vec3d(b.axis) - Vec3d(a.axis) * double(dot(a.axis, b.axis));
    if (!(wide < kPi) || !(dot(side, side) > 0)) return {};
    const auto [s, c] = exact::sinCos(wide - wideA);
    // Rounded outwards: contains everything within either cone.
    return {Vec3(normalize(Vec3d(a.axis) * c + normalize(side) * s)), float(std::max(exact::cos(wide) - 1e-6, -1.0))};
}

LightChooser::LightChooser(std::span<const LightBound> lights, int wanted) : wanted_(std::clamp(wanted, 1, kMost)) {
    leafOf_.assign(lights.size(), -1);
    nodes_.reserve(lights.size() * 2);
    fronts_.reserve(lights.size() * 2);
    std::vector<int> order(lights.size());
    std::iota(order.begin(), order.end(), 0);
    const auto placed = std::stable_partition(order.begin(), order.end(), [&](int i) { return !lights[size_t(i)].everywhere; });
    for (auto [first, last] : {std::pair(order.begin(), placed), std::pair(placed, order.end())}) {
        if (first == last) continue;
        roots_.push_back(int(nodes_.size()));
        nodes_.emplace_back();
        fronts_.emplace_back();
        build(roots_.back(), {first, last}, lights);
    }
    for (Node& n : nodes_) {
        n.wide2 = n.leaf() || n.everywhere() ? 0 : 4 * n.radius2;
        n.radius2 = std::max(n.radius2, 1e-12);
        LightFront& f = fronts_[size_t(&n - nodes_.data())];
        f.radius2 = n.radius2;
        std::copy_n(n.centre, 3, f.centre);
        n.blind = kBlind * n.count / double(leafOf_.size());
    }
}

// Where to split the lights of a node: minimises powers times surface areas of the boxes, else halves.
size_t LightChooser::split(std::span<int> order, std::span<const LightBound> lights) const {
    geometry::Bounds centres;
    for (int i : order) centres.add(lights[size_t(i)].centre);
    const Vec3 extent = centres.hi - centres.lo;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto middle = [&] {
        std::stable_sort(order.begin(), order.end(),
                         [&](int a, int b) { return lights[size_t(a)].centre[axis] < lights[size_t(b)].centre[axis]; });
        return order.size() / 2;
    };
    if (!(extent[axis] > 0) || !std::isfinite(extent[axis]) || order.size() <= 4) return middle();
    struct Bin {
        geometry::Bounds box;
        double power = 0;
        size_t count = 0;
        Cone front;
        void add(const geometry::Bounds& b, double p, size_t n, const Cone& c) {
            box.add(b);
            power += p;
            front = count ? around(front, c) : c;
            count += n;
        }
    };
    const bool face = std::any_of(order.begin(), order.end(), [&](int i) { return !lights[size_t(i)].front.all(); });
    std::array<Bin, kBins> bins;
    const auto binOf = [&](int i) {
        return std::clamp(int((lights[size_t(i)].centre[axis] - centres.lo[axis]) / extent[axis] * kBins), 0, kBins - 1);
    };
    for (int i : order) {
        const LightBound& l = lights[size_t(i)];
        bins[size_t(binOf(i))].add(boundsOf(l), l.power, 1, face ? l.front : Cone());
    }
    double least = std::numeric_limits<double>::infinity();
    int at = -1;
    for (int cut = 1; cut < kBins; ++cut) {
        Bin side[2];
        for (int k = 0; k < kBins; ++k) {
            const Bin& b = bins[size_t(k)];
            if (b.count) side[k >= cut].add(b.box, b.power, b.count, b.front);
        }
        if (!side[0].count || !side[1].count) continue;
        const auto costOf = [&](const Bin& b) { return b.power * area(b.box) * (face ? spreadOf(b.front) : 1); };
        const double cost = costOf(side[0]) + costOf(side[1]);
        if (cost < least) least = cost, at = cut;
    }
    if (at < 0 || !(least > 0)) return middle();
    const auto part = std::stable_partition(order.begin(), order.end(), [&](int i) { return binOf(i) < at; });
    return size_t(part - order.begin());
}

LightTree LightChooser::tree() const {
    LightTree t{nodes_.data(), fronts_.data(), {}, int(roots_.size()), double(wanted_), 1 - kBlind, double(leafOf_.size())};
    std::copy(roots_.begin(), roots_.end(), t.roots);
    return t;
}

void LightChooser::build(int node, std::span<int> order, std::span<const LightBound> lights) {
    geometry::Bounds box;
    double power = 0;
    for (int i : order) {
        box.add(boundsOf(lights[size_t(i)]));
        power += std::isfinite(lights[size_t(i)].power) ? std::max(lights[size_t(i)].power, 0.f) : 0;
    }
    Node& n = nodes_[size_t(node)];
    n.flags = lights[size_t(order[0])].everywhere ? Node::kEverywhere : 0;
    n.power = power;
    n.count = int(order.size());
    const auto setBall = [&](const Vec3& centre, float radius) {
        setCentre(n, centre);
        n.radius2 = double(radius) * radius;
    };
    const auto setFront = [&](const Cone& front) {
        fronts_[size_t(node)] = frontOf(front);
        if (!front.all()) nodes_[size_t(node)].flags |= Node::kFaces;
    };
    setBall((box.lo + box.hi) * .5f, length(box.hi - box.lo) * .5f);
    if (order.size() == 1) {
        const LightBound& light = lights[size_t(order[0])];
        setBall(light.centre, light.radius);
        n.next = ~order[0];
        setFront(light.front);
        leafOf_[size_t(order[0])] = node;
        return;
    }
    const size_t half = split(order, lights);
    const int left = int(nodes_.size());
    n.next = left; // the reference ends here: adding children may move the nodes
    nodes_.resize(nodes_.size() + 2);
    fronts_.resize(nodes_.size());
    nodes_[size_t(left)].parent = nodes_[size_t(left) + 1].parent = node;
    build(left, order.first(half), lights);
    build(left + 1, order.subspan(half), lights);
    setFront(around(coneOf(fronts_[size_t(left)]), coneOf(fronts_[size_t(left) + 1])));
}

double LightChooser::towards(const Node& n, const Vec3& at) const {
    const LightFront& front = fronts_[size_t(&n - nodes_.data())];
    const Vec3d to = Vec3d(at) - Vec3d(centreOf(n));
    const double d2 = dot(to, to);
    if (!(d2 > n.radius2)) return 1;
    // The angle to the axis, minus that of the cone and the angular size of the node; neither may become negative.
    double cosine = dot(to, Vec3d(front.axis[0], front.axis[1], front.axis[2])) / std::sqrt(d2),
           sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const auto less = [&](double c, double s) {
        const double before = cosine;
        cosine = before > c ? 1 : before * c + sine * s;
        sine = before > c ? 0 : sine * c - before * s;
    };
    less(front.cosine, front.sine);
    const double seen = std::sqrt(1 - n.radius2 / d2);
    less(seen, std::sqrt(std::max(0.0, 1 - seen * seen)));
    return std::max(cosine, 0.0);
}

double LightChooser::importance(const Node& n, const Vec3& at) const {
    if (n.everywhere()) return n.power;
    const double share = n.power / distance2(n, at);
    return !std::isfinite(share) ? 0 : n.faces() ? share * towards(n, at) : share;
}

LightChooser::Cut LightChooser::cutAt(const Vec3& at) const {
    Cut c;
    for (int r : roots_) c.part[c.size++] = {r, 0};
    // Opens nodes that are wide as seen from here, in tree order, while there is room.
    for (int k = 0; k < c.size && c.size < kCut;) {
        const Node& n = nodes_[size_t(c.part[k].node)];
        const Vec3 to = centreOf(n) - at;
        if (!(n.wide2 > dot(to, to))) {
            ++k;
            continue;
        }
        c.part[k].node = n.next;
        c.part[c.size++].node = n.next + 1;
    }
    for (int k = 0; k < c.size; ++k) c.total += c.part[k].importance = importance(nodes_[size_t(c.part[k].node)], at);
    return c;
}

double LightChooser::probability(double share, const Node& n) const { return wanted_ * ((1 - kBlind) * share + n.blind); }

inline std::pair<double, double> LightChooser::divide(const Node& n, const Vec3& at) const {
    // Only the ratio of the children's importances matters: both are multiplied by both squared distances, for a single division.
    const Node &a = nodes_[size_t(n.next)], &b = nodes_[size_t(n.next) + 1];
    double l = n.everywhere() ? a.power : a.power * distance2(b, at);
    double r = n.everywhere() ? b.power : b.power * distance2(a, at);
    if (a.faces()) l *= towards(a, at);
    if (b.faces()) r *= towards(b, at);
    const double left = l + r > 0 && std::isfinite(l + r) ? l / (l + r) : a.count / double(n.count);
    return {left, 1 - left};
}

void LightChooser::choose(const Vec3& at, float u, Chosen& chosen) const {
    chosen.clear();
    const Cut c = cutAt(at);
    // Nodes that contain a tooth of the comb, or that are certain: their start in the cumulative sum, and the teeth before it. A
    // node without a tooth has no leaf with one; a certain node is certain in its leaves. All descend together, one level an
    // iteration, so the work on one does not wait for another's.
    struct Entered {
        int node;
        double share, begin, teeth;
    };
    Entered entered[kMost + kCut + 4];
    int size = 0;
    const double random = double(u);
    const auto teethBelow = [&](double sum) { return std::ceil(sum - random); };
    double sum = 0, teeth = teethBelow(0);
    for (int k = 0; k < c.size; ++k) {
        const Node& n = nodes_[size_t(c.part[k].node)];
        const double share = c.total > 0 ? c.part[k].importance / c.total : n.count / double(leafOf_.size());
        const double p = probability(share, n), end = teethBelow(sum + p);
        if (p >= 1 || end > teeth) entered[size++] = {c.part[k].node, share, sum, teeth};
        sum += p;
        teeth = end;
    }
    while (size > 0)
        for (int k = 0; k < size;) {
            Entered& e = entered[k];
            const Node& n = nodes_[size_t(e.node)];
            if (n.leaf()) {
                chosen.emplace_back(~n.next, float(std::min(probability(e.share, n), 1.0)));
                e = entered[--size];
                continue;
            }
            const auto [left, right] = divide(n, at);
            const Node &a = nodes_[size_t(n.next)], &b = nodes_[size_t(n.next) + 1];
            const double shareA = e.share * left, shareB = e.share * right;
            const double pa = probability(shareA, a), pb = probability(shareB, b), middle = e.begin + pa;
            const double below = teethBelow(middle), end = teethBelow(middle + pb);
            // Both outcomes are random: branch only on the rare case.
            const bool inA = (pa >= 1) | (below > e.teeth), inB = (pb >= 1) | (end > below);
            if (!(inA | inB)) { // its tooth was lost to rounding
                e = entered[--size];
                continue;
            }
            if (inA & inB) entered[size++] = {n.next + 1, shareB, middle, below};
            e.node = n.next + !inA;
            e.share = inA ? shareA : shareB;
            e.begin = inA ? e.begin : middle;
            e.teeth = inA ? e.teeth : below;
            ++k;
        }
}

int LightChooser::pick(const Vec3& at, float u, float& p) const {
    const Cut c = cutAt(at);
    // Finds the part of the cut whose range contains u, then the side of each node on the way down.
    double left = u, share = 0;
    int node = -1;
    for (int k = 0; k < c.size; ++k) {
        const Node& n = nodes_[size_t(c.part[k].node)];
        const double s = c.total > 0 ? c.part[k].importance / c.total : n.count / double(leafOf_.size());
        const double range = probability(s, n);
        node = c.part[k].node; // the last one absorbs rounding
        share = s;
        if (left < range) break;
        if (k + 1 < c.size) left -= range;
    }
    for (const Node* n = &nodes_[size_t(node)]; !n->leaf(); n = &nodes_[size_t(node)]) {
        const double first = divide(*n, at).first, range = probability(share * first, nodes_[size_t(n->next)]);
        const bool second = !(left < range);
        if (second) left -= range;
        node = n->next + second;
        share *= second ? 1 - first : first;
    }
    const int light = ~nodes_[size_t(node)].next;
    p = pmf(light, at);
    return light;
}

float LightChooser::pmf(int light, const Vec3& at) const {
    if (light < 0 || size_t(light) >= leafOf_.size()) return 0;
    const Cut c = cutAt(at);
    // Up to the node of the cut, then down again: the path is as long as the tree is deep.
    int node = leafOf_[size_t(light)];
    double share = 1;
    for (;;) {
        for (int k = 0; k < c.size; ++k)
            if (c.part[k].node == node) {
                share *= c.total > 0 ? c.part[k].importance / c.total : nodes_[size_t(node)].count / double(leafOf_.size());
                return float(std::min(1.0, probability(share, nodes_[size_t(leafOf_[size_t(light)])])));
            }
        const Node& parent = nodes_[size_t(nodes_[size_t(node)].parent)];
        const auto [left, right] = divide(parent, at);
        share *= node == parent.next ? left : right;
        node = nodes_[size_t(node)].parent;
    }
}

} // namespace alpenglow::world
