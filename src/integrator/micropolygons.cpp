#include "integrator/micropolygons.h"
#include "base/hash.h"
#include "geometry/placed.h"
#include "integrator/limits.h"
#include "scene/scene.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace alpenglow::integrator {

namespace {

using geometry::Shape;

constexpr int kMostSteps = 32767;       ///< of a lattice along a parameter
constexpr size_t kPieces = 1 << 18;     ///< primitives whose lengths are cached, at most
constexpr float kNarrowest = 0.25f;     ///< smallest foreshortening of an edge: fraction of its length that counts
constexpr float kSmallestSmooth = 1.5f; ///< pixels: facets with shorter edges have one colour

/// Number of steps for a squared number of edges: a power of 2^(1/4), rounded.
uint16_t stepsFor(float square) {
    if (!(square > 1)) return 1;
    const double x = std::min(double(square), double(kMostSteps) * kMostSteps), fourth = x * x * 1.4142135623730951;
    const int quarters = int(std::bit_cast<uint64_t>(fourth) >> 52) - 1023; // floor(4 log2 + 1/2)
    constexpr double kParts[] = {1, 1.189207115002721, 1.4142135623730951, 1.681792830507429};
    return uint16_t(std::min(kParts[quarters & 3] * double(1 << (quarters >> 2)) + 0.5, double(kMostSteps)));
}

/// The shape whose triangles or parameters define lattices, at shutter open.
const Shape* baseOf(const Shape& s) {
    const geometry::Placed* placed = s.placed();
    if (!placed) return &s;
    return placed->deforming() ? placed->deforming()->keys()[0].get() : placed->geometry().get();
}

bool inside(double b) { return b >= 0 && b <= 1; }

/// The cell of a parameter among n.
uint16_t cellOf(double b, int n) { return uint16_t(std::clamp(int(b * n), 0, n - 1)); }

} // namespace

uint64_t MicropolygonKey::hash() const {
    const uint64_t a = uint64_t(shape) << 32 | prim,
                   b = uint64_t(steps[0]) << 48 | uint64_t(steps[1]) << 32 | uint64_t(at[0]) << 16 | at[1];
    return mix64(a ^ mix64(b + (corner ? 0x9e3779b97f4a7c15ull : 0)));
}

MicropolygonCamera::MicropolygonCamera(const scene::Options& o) {
    const geometry::DiceCamera c = geometry::DiceCamera::from(o);
    perspective = c.perspective;
    pixel = float(1 / c.pixelsPerUnit);
}

Micropolygons::Micropolygons(const WorldImpl& w) : world_(w), camera_(w.frame().options) { lattices_.resize(w.shapes().size()); }

const Micropolygons::Lattice& Micropolygons::lattice(uint32_t shape) {
    std::unique_ptr<Lattice>& l = lattices_[shape];
    if (!l) l = std::make_unique<Lattice>(latticeOf(shape));
    return *l;
}

Micropolygons::Lattice Micropolygons::latticeOf(uint32_t shape) const {
    const Shape& s = *world_.shapes()[shape];
    const Shape& base = *baseOf(s);
    Lattice l;
    l.edge = float(geometry::diceEdge(s.attributes()));
    l.smooth = s.attributes().smoothShading;
    if (!base.exact()) {
        l.kind = Kind::Triangles;
        l.mesh = &base.mesh();
        l.paired = base.diced();
        if (s.placed()) l.place = s.placed()->fromGeometry(0);
    } else if (base.kind() == "Blobby") {
        l.kind = Kind::Single; // its hits are points on faces of boxes
    } else {
        l.kind = base.exactPrims() == 1 ? Kind::Surface : Kind::Pieces;
        const geometry::Bounds b = s.bounds();
        constexpr float kLarge = 64; // pixels; a larger shape has more hits than the table has entries
        l.large = length(b.hi - b.lo) > kLarge * camera_.pixelAt((b.lo + b.hi) * 0.5f);
    }
    return l;
}

Micropolygons::Seen::Seen(const MicropolygonCamera& c, const Vec3& at, float edge)
    : P(c.perspective ? at : Vec3(0, 0, 1)), inverse(1 / std::max(dot(P, P), 1e-37f)),
      scale(1 / std::max(c.pixel * c.pixel * edge * edge * (c.perspective ? dot(P, P) : 1), 1e-37f)) {}

float Micropolygons::Seen::edges(const Vec3& step) const {
    const float whole = dot(step, step), along = dot(step, P);
    return std::max(whole - along * along * inverse, whole * (kNarrowest * kNarrowest)) * scale;
}

float Micropolygons::Seen::edges(const Four (&s)[3]) const {
    const Four whole = s[0] * s[0] + s[1] * s[1] + s[2] * s[2], along = s[0] * P.x + s[1] * P.y + s[2] * P.z;
    const Four across = whole - along * along * inverse, least = whole * (kNarrowest * kNarrowest);
    const Four e = (across > least ? across : least) * scale;
    return std::max(std::max(e[0], e[1]), std::max(e[2], e[3]));
}

/// For two triangles of a diced surface that are halves of a quad: their common micropolygon, shaded at its centre.
bool Micropolygons::pair(const geometry::TriMesh& mesh, MicropolygonShare& s) const {
    const uint32_t even = s.key.prim & ~1u;
    if (even + 1 >= mesh.triangles()) return false;
    const uint32_t *a = &mesh.index[3 * size_t(even)], *b = a + 3;
    bool common[3];
    int n = 0;
    for (int k = 0; k < 3; ++k) n += common[k] = std::find(b, b + 3, a[k]) != b + 3;
    if (n != 2) return false;
    s.key.prim = even;
    s.b1 = common[1] ? 0.5 : 0;
    s.b2 = common[2] ? 0.5 : 0;
    return true;
}

namespace {

/// A triangle as its lattice sees it: from the corner opposite to the longest edge, so that the cells of the two halves of a
/// rectangle are rectangles. b1 and b2 are the weights of the next corner and of the one after it.
struct Turned {
    int first = 0; ///< that corner
    Vec3 e1, e2;   ///< edges from there
    double b1, b2;
    Turned(const Vec3 p[3], double weight1, double weight2) {
        const float l[3] = {dot(p[2] - p[1], p[2] - p[1]), dot(p[0] - p[2], p[0] - p[2]), dot(p[1] - p[0], p[1] - p[0])};
        first = l[1] > l[0] ? (l[2] > l[1] ? 2 : 1) : (l[2] > l[0] ? 2 : 0);
        const int second = (first + 1) % 3, third = (first + 2) % 3;
        e1 = p[second] - p[first];
        e2 = p[third] - p[first];
        const double weights[3] = {1 - weight1 - weight2, weight1, weight2};
        b1 = std::clamp(weights[second], 0., 1.);
        b2 = std::clamp(weights[third], 0., 1.);
    }
    /// Converts a lattice position to the triangle's own weights.
    void put(double x, double y, MicropolygonShare& s) const {
        const double turned[3] = {1 - x - y, x, y};
        s.b1 = turned[(4 - first) % 3];
        s.b2 = turned[(5 - first) % 3];
    }
};

} // namespace

/// The corners, up to a translation.
Micropolygons::Triangle Micropolygons::triangleOf(const Lattice& l, uint32_t prim) const {
    const uint32_t* index = &l.mesh->index[3 * size_t(prim)];
    Triangle c;
    for (int k = 0; k < 3; ++k) {
        c.p[k] = l.mesh->P[index[k]];
        if (l.place) c.p[k] = Vec3(l.place->vector(Vec3d(c.p[k])));
    }
    return c;
}

template <class Take> void Micropolygons::ofTriangle(const Lattice& l, const accel::Hit& h, const Vec3& P, Take take) const {
    const Turned t(triangleOf(l, h.prim).p, h.b1, h.b2);
    const Seen seen(camera_, P, l.edge);
    MicropolygonShare s;
    s.key.shape = h.shape;
    s.key.prim = h.prim;
    s.key.steps[0] = stepsFor(seen.edges(t.e1)), s.key.steps[1] = stepsFor(seen.edges(t.e2));
    const int n1 = s.key.steps[0], n2 = s.key.steps[1];
    const uint16_t i = cellOf(t.b1, n1), j = cellOf(t.b2, n2);
    s.key.at[0] = i, s.key.at[1] = j;
    if (l.smooth && (n1 > 1 || n2 > 1 || !l.paired || l.edge > kSmallestSmooth)) {
        const double fx = t.b1 * n1 - i, fy = t.b2 * n2 - j;
        const bool far = fx + fy > 1;
        const struct {
            int i, j;
            double weight;
        } ends[3] = {{far, far, far ? fx + fy - 1 : 1 - fx - fy}, {1, 0, far ? 1 - fy : fx}, {0, 1, far ? 1 - fx : fy}};
        for (const auto& end : ends) {
            MicropolygonShare at = s;
            at.key.corner = true;
            at.key.at[0] = uint16_t(i + end.i), at.key.at[1] = uint16_t(j + end.j);
            at.weight = float(end.weight);
            take(at);
        }
        return;
    }
    if (n1 == 1 && n2 == 1 && l.paired) pair(*l.mesh, s);
    take(s);
}

void Micropolygons::place(MicropolygonShare& s) const {
    if (!s.key.shared()) return;
    const Lattice& l = *lattices_[s.key.shape];
    const int n1 = s.key.steps[0], n2 = s.key.steps[1];
    if (l.kind != Kind::Triangles) {
        const double half = s.key.corner ? 0 : 0.5;
        s.b1 = (s.key.at[0] + half) / n1, s.b2 = (s.key.at[1] + half) / n2;
        return;
    }
    if (n1 == 1 && n2 == 1 && !s.key.corner) {
        if (!l.paired || !pair(*l.mesh, s)) s.b1 = s.b2 = 1 / 3.;
        return;
    }
    const Turned t(triangleOf(l, s.key.prim).p, 0, 0);
    const double x = double(s.key.at[0]) / n1, y = double(s.key.at[1]) / n2;
    if (s.key.corner) { // of a cell that the edge cuts: moved onto the edge
        const double sum = std::max(x + y, 1.);
        return t.put(x / sum, y / sum, s);
    }
    // The centre of the cell; for a cell that the edge cuts, the centre of the part inside.
    const double left = 1 - x - y, part = std::min(0.5, std::max(left, 0.) / (1. / n1 + 1. / n2) * (2 / 3.));
    t.put(x + part / n1, y + part / n2, s);
}

Vec2 Micropolygons::spanOfTriangle(const Lattice& l, const MicropolygonShare& s) {
    const Turned t(triangleOf(l, s.key.prim).p, s.b1, s.b2);
    const bool whole = s.key.steps[0] == 1 && s.key.steps[1] == 1 && !s.key.corner;
    const bool quad = whole && (s.b1 == 0.5 || s.b2 == 0.5); // from pair(): the other half lies opposite its own corner
    const int first = !quad ? t.first : s.b1 == 0 ? 1 : s.b2 == 0 ? 2 : 0;
    if (corners_.shape != s.key.shape || corners_.prim != s.key.prim) {
        corners_.shape = s.key.shape, corners_.prim = s.key.prim;
        const geometry::HitRef refs[3] = {{s.key.prim, 0, 0, &corners_.at[0], 0},
                                          {s.key.prim, 1, 0, &corners_.at[1], 0},
                                          {s.key.prim, 0, 1, &corners_.at[2], 0}};
        world_.shapes()[s.key.shape]->points(refs, geometry::kNeedUV);
    }
    const geometry::SurfacePoint& from = corners_.at[first];
    float u[2], v[2]; // along one edge of the cell each
    for (int k = 0; k < 2; ++k) {
        const geometry::SurfacePoint& to = corners_.at[(first + 1 + k) % 3];
        u[k] = (to.u - from.u) / float(s.key.steps[k]);
        v[k] = (to.v - from.v) / float(s.key.steps[k]);
    }
    const float du = std::max(std::fabs(u[0]), std::fabs(u[1])), dv = std::max(std::fabs(v[0]), std::fabs(v[1]));
    const float box = du * dv, area = std::fabs(u[0] * v[1] - u[1] * v[0]);
    if (!(box > 0) || !std::isfinite(area)) return {0, 0};
    const float wider = std::sqrt(std::max(area / box, 1.f));
    return {du * wider, dv * wider};
}

Vec2 Micropolygons::spanOf(const Lattice& l, const MicropolygonShare& s) {
    if (!s.key.shared()) return {0, 0};
    if (l.kind == Kind::Triangles) return spanOfTriangle(l, s);
    const Vec2 steps(1.f / s.key.steps[0], 1.f / s.key.steps[1]);
    if (l.kind == Kind::Surface) return steps;
    geometry::SurfacePoint at[2]; // pieces of a curve share its v
    const geometry::HitRef refs[2] = {{s.key.prim, 0, 0, &at[0], 0}, {s.key.prim, 1, 1, &at[1], 0}};
    world_.shapes()[s.key.shape]->points(refs, geometry::kNeedUV);
    return {steps.x * std::fabs(at[1].u - at[0].u), steps.y * std::fabs(at[1].v - at[0].v)};
}

Vec2 Micropolygons::stepsOf(const MicropolygonShare& s, const Vec2& footprint) {
    const Lattice& l = *lattices_[s.key.shape];
    const Vec2 cell = spanOf(l, s);
    if (!(cell.x > 0 && cell.y > 0)) return {0, 0};
    // Cells at grazing angles and triangles smaller than a pixel are not all shaded: those that are represent their neighbours.
    const auto over = [&](float step, float seen) {
        const float most = l.kind == Kind::Triangles ? INFINITY : 1; // all of the surface
        return std::max(step, std::min({seen, 2 * (seen - step), most}));
    };
    return {over(cell.x, footprint.x), over(cell.y, footprint.y)};
}

/// s: with its steps; b1 and b2 are those of the hit, in [0, 1].
template <class Take> void Micropolygons::ofParameters(const Lattice& l, MicropolygonShare s, Take take) const {
    const int nu = s.key.steps[0], nv = s.key.steps[1];
    const uint16_t i = cellOf(s.b1, nu), j = cellOf(s.b2, nv);
    if (!l.smooth) {
        s.key.at[0] = i, s.key.at[1] = j;
        return take(s);
    }
    const double fx = s.b1 * nu - i, fy = s.b2 * nv - j;
    s.key.corner = true;
    for (int k = 0; k < 4; ++k) {
        s.key.at[0] = uint16_t(i + (k & 1)), s.key.at[1] = uint16_t(j + (k >> 1));
        s.weight = float((k & 1 ? fx : 1 - fx) * (k >> 1 ? fy : 1 - fy));
        take(s);
    }
}

const Micropolygons::Partials& Micropolygons::partialsOf(uint32_t shape) {
    std::unique_ptr<Partials>& p = lattices_[shape]->partials;
    if (p) return *p;
    if ((tabled_.size() + 1) * sizeof(Partials) > limits::kPartialsBytes)
        for (const uint32_t of : std::exchange(tabled_, {})) lattices_[of]->partials.reset();
    p = std::make_unique<Partials>();
    tabled_.push_back(shape);
    constexpr int n = Partials::kCells + 1;
    std::vector<geometry::SurfacePoint> at(n * n);
    std::vector<geometry::HitRef> run;
    for (int k = 0; k < n * n; ++k) run.push_back({0, double(k % n) / (n - 1), double(k / n) / (n - 1), &at[size_t(k)], 0});
    world_.shapes()[shape]->points(run, geometry::kNeedPartials);
    for (int y = 0; y < Partials::kCells; ++y)
        for (int x = 0; x < Partials::kCells; ++x)
            for (int k = 0; k < 4; ++k) {
                const geometry::SurfacePoint& corner = at[size_t((y + k / 2) * n + x + k % 2)];
                for (int a = 0; a < 3; ++a) {
                    p->cells[y][x].u[a][k] = corner.dPdu[a];
                    p->cells[y][x].v[a][k] = corner.dPdv[a];
                }
            }
    return *p;
}

/// hits: of one shape.
template <class Take>
void Micropolygons::ofSurfaces(const Lattice& l, std::span<const accel::Hit> hits, std::span<const Vec3> P, Take take) {
    const auto tabled = [&](const accel::Hit& h) { return l.large && inside(h.b1) && inside(h.b2); };
    surfaces_.resize(std::max(surfaces_.size(), hits.size()));
    run_.clear();
    for (size_t i = 0; i < hits.size(); ++i)
        if (!tabled(hits[i])) run_.push_back({hits[i].prim, hits[i].b1, hits[i].b2, &surfaces_[i], 0});
    if (!run_.empty()) world_.shapes()[hits[0].shape]->points(run_, geometry::kNeedPartials | geometry::kNeedUV);
    for (size_t i = 0; i < hits.size(); ++i) {
        MicropolygonShare s{{hits[i].shape, hits[i].prim, {}, {}, false}, hits[i].b1, hits[i].b2, 1};
        const Seen seen(camera_, P[i], l.edge);
        float u = 0, v = 0;
        if (tabled(hits[i])) { // the largest of the surrounding corners: at a pole the length along u is 0
            constexpr int n = Partials::kCells;
            const Partials::Cell& cell = partialsOf(hits[i].shape).cells[cellOf(s.b2, n)][cellOf(s.b1, n)];
            u = seen.edges(cell.u), v = seen.edges(cell.v);
        } else {
            const geometry::SurfacePoint& p = surfaces_[i];
            if (!inside(p.b1) || !inside(p.b2)) {
                take(i, s);
                continue;
            }
            s.b1 = p.b1, s.b2 = p.b2;
            u = seen.edges(p.dPdu), v = seen.edges(p.dPdv);
        }
        s.key.steps[0] = stepsFor(u), s.key.steps[1] = stepsFor(v);
        ofParameters(l, s, [&](const MicropolygonShare& share) { take(i, share); });
    }
}

/// Approximate length of one of many small primitives along its parameters, camera space.
Micropolygons::Lengths Micropolygons::lengthsOf(uint32_t shape, uint32_t prim) {
    if (pieces_.size() > kPieces) pieces_.clear();
    const auto [at, fresh] = pieces_.try_emplace(uint64_t(shape) << 32 | prim);
    if (!fresh) return at->second;
    Vec3 p[3][3];
    Lengths l{0, 0, prim};
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
            const geometry::SurfacePoint point = world_.shapes()[shape]->evaluateHit(prim, i * 0.5, j * 0.5);
            p[j][i] = point.P;
            l.prim = point.prim;
        }
    for (int k = 0; k < 3; ++k) {
        l.u = std::max(l.u, length(p[k][1] - p[k][0]) + length(p[k][2] - p[k][1]));
        l.v = std::max(l.v, length(p[1][k] - p[0][k]) + length(p[2][k] - p[1][k]));
    }
    return at->second = l;
}

void Micropolygons::find(std::span<const accel::Hit> hits, std::span<const Vec3> points, std::vector<Found>& found) {
    found.clear();
    for (size_t i = 0; i < hits.size();) {
        const accel::Hit& h = hits[i];
        if (!h.valid()) {
            ++i;
            continue;
        }
        const Lattice& l = lattice(h.shape);
        const auto one = [&](const MicropolygonShare& s) { found.push_back({uint32_t(i), s}); };
        MicropolygonShare s{{h.shape, h.prim, {}, {}, false}, h.b1, h.b2, 1};
        size_t end = i + 1;
        if (l.kind == Kind::Triangles) {
            ofTriangle(l, h, points[i], one);
        } else if (l.kind == Kind::Surface) {
            while (end < hits.size() && hits[end].shape == h.shape) ++end;
            ofSurfaces(l, hits.subspan(i, end - i), points.subspan(i, end - i),
                       [&](size_t k, const MicropolygonShare& share) { found.push_back({uint32_t(i + k), share}); });
        } else if (l.kind == Kind::Pieces && inside(h.b1) && inside(h.b2)) {
            const float edge = camera_.pixelAt(points[i]) * l.edge;
            const Lengths lengths = lengthsOf(h.shape, h.prim);
            s.key.prim = lengths.prim;
            s.key.steps[0] = stepsFor(lengths.u * lengths.u / (edge * edge));
            s.key.steps[1] = stepsFor(lengths.v * lengths.v / (edge * edge));
            ofParameters(l, s, one);
        } else {
            one(s);
        }
        i = end;
    }
}

} // namespace alpenglow::integrator
