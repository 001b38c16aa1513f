#include "geometry/limit_surface.h"
#include "base/limits.h"
#include "geometry/manifold.h"
#include "geometry/osd_cage.h"
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <unordered_map>

namespace alpenglow::geometry {

namespace Osd = OpenSubdiv;
using Surface = Osd::Bfr::Surface<double>;

double* LimitWeights::make(int n, int sets) {
    count = n;
    const size_t need = size_t(n) * size_t(sets);
    large_.clear();
    if (need > small_.size()) large_.resize(need);
    return large_.empty() ? small_.data() : large_.data();
}

struct LimitSurface::Topology {
    std::unique_ptr<Osd::Far::TopologyRefiner> refiner;
    const Osd::Far::TopologyLevel& base() const { return refiner->GetLevel(0); }
};

namespace {

/// Which of the patterns that faces share a surface got.
class Cache final : public Osd::Bfr::SurfaceFactoryCache {
public:
    mutable const void* last = nullptr;

protected:
    DataType Find(const KeyType& key) const override {
        DataType d = find(key);
        last = d.get();
        return d;
    }
    DataType Add(const KeyType& key, const DataType& data) override {
        DataType d = add(key, data);
        last = d.get();
        return d;
    }
};

// OpenSubdiv's patch parameters hold ten bits of u and v: deeper than ten levels is not sound.
constexpr int kDeepestLevel = 10;
// Faces with more control points are not evaluated, as the size of patterns grows with their square.
constexpr int kMostPoints = 1000;

int levelFor(int points, size_t used) {
    int level = points <= 160 ? kDeepestLevel : points <= 400 ? 4 : 2;
    if (used > limits::kLimitPatternBytes / 2) level = std::min(level, 4);
    if (used > limits::kLimitPatternBytes) level = std::min(level, 2);
    return level;
}

std::span<const int> spanOf(const Osd::Far::ConstIndexArray& a) {
    return a.size() ? std::span<const int>(&a[0], size_t(a.size())) : std::span<const int>();
}

} // namespace

/// Surfaces with weights shared by all faces of the same neighbourhood.
struct LimitSurface::Patterns {
    std::deque<Surface> surface;
    Cache caches[3]; ///< by level
    size_t bytes = 0;
    std::unordered_map<const void*, uint32_t> irregular;
    std::unordered_map<std::string, uint32_t> regular;

    uint32_t add(const Surface& s) {
        surface.push_back(s);
        return uint32_t(surface.size() - 1);
    }
    /// The pattern of a face's surface. from: the cached one, or null.
    uint32_t of(const Surface& s, const void* from) {
        if (!s.IsRegular() && !s.IsLinear() && from) {
            auto [at, isNew] = irregular.try_emplace(from, 0);
            if (isNew) {
                at->second = add(s);
                bytes += size_t(s.GetNumPatchPoints()) * size_t(s.GetNumControlPoints()) * sizeof(double);
            }
            return at->second;
        }
        // One polynomial piece (or bilinear ones), identified by its weights at a point.
        std::vector<double> w(size_t(s.GetNumControlPoints()) + 1);
        const double uv[2] = {0.3125, 0.21875};
        w.back() = s.GetFaceSize();
        s.EvaluateStencil(uv, w.data());
        std::string key(reinterpret_cast<const char*>(w.data()), w.size() * sizeof(double));
        auto [at, isNew] = regular.try_emplace(std::move(key), 0);
        if (isNew) at->second = add(s);
        return at->second;
    }
};

LimitSurface::~LimitSurface() = default;

static bool isManifold(const Osd::Far::TopologyLevel& l) {
    for (int v = 0; v < l.GetNumVertices(); ++v)
        if (l.IsVertexNonManifold(v)) return false;
    for (int e = 0; e < l.GetNumEdges(); ++e)
        if (l.IsEdgeNonManifold(e)) return false;
    return true;
}

/// Edges between the same vertices of the cage are one, that of the lowest number.
void LimitSurface::joinEdges() {
    const auto& base = topology_->base();
    std::map<std::pair<int, int>, int> first;
    for (int e = 0; e < base.GetNumEdges(); ++e) {
        const auto v = base.GetEdgeVertices(e);
        const int a = original_[size_t(v[0])], b = original_[size_t(v[1])];
        sameEdge_.push_back(first.try_emplace(std::minmax(a, b), e).first->second);
    }
}

LimitSurface::LimitSurface(const SubdivisionCage& c, const std::vector<Channel>& channels, std::string& why) : scheme_(c.scheme) {
    faceCount_ = int(c.corners.size());
    topology_ = std::make_unique<Topology>();
    topology_->refiner = makeRefiner(c, channels);
    ManifoldCage apart;
    if (topology_->refiner && !isManifold(topology_->base())) {
        // OpenSubdiv's results for such neighbourhoods may be invalid.
        apart = makeManifold(c);
        // Values belong to one vertex, so they are taken apart with it.
        std::vector<Channel> own = channels;
        for (Channel& channel : own) {
            std::map<std::pair<int, int>, int> first;
            for (size_t k = 0; k < channel.size(); ++k)
                channel[k] = first.try_emplace({apart.vertex[k], channel[k]}, int(k)).first->second;
        }
        topology_->refiner = makeRefiner(apart.cage, own);
        original_ = std::move(apart.original);
        blunted_ = apart.blunted;
    }
    if (!topology_->refiner || !isManifold(topology_->base())) {
        why = "OpenSubdiv cannot take the topology of its faces";
        return;
    }
    if (!original_.empty()) joinEdges();
    const size_t regular = c.scheme == SubdivisionScheme::Loop ? 3 : 4;
    bool split = false;
    for (int n : c.corners) split |= size_t(n) != regular;
    if (split) {
        firstPiece_.reserve(c.corners.size() + 1);
        for (size_t f = 0; f < c.corners.size(); ++f) {
            firstPiece_.push_back(pieceCount_);
            const uint32_t n = size_t(c.corners[f]) == regular ? 1 : uint32_t(c.corners[f]);
            faceOfPiece_.insert(faceOfPiece_.end(), n, uint32_t(f));
            pieceCount_ += n;
        }
        firstPiece_.push_back(pieceCount_);
    } else {
        pieceCount_ = uint32_t(faceCount_);
    }
    patterns_ = std::make_unique<Patterns>();
    fill(vertexData_, -1, c);
    channels_.resize(channels.size());
    for (size_t k = 0; k < channels.size(); ++k) fill(channels_[k], int(k), c);
    valid_ = true;
}

void LimitSurface::fill(Data& data, int channel, const SubdivisionCage& c) {
    using Factory = Osd::Bfr::RefinerSurfaceFactory<>;
    const auto& base = topology_->base();
    Patterns& all = *patterns_;
    std::unique_ptr<Factory> byLevel[3];
    const int levels[3] = {kDeepestLevel, 4, 2};
    for (size_t k = 0; k < 3; ++k) {
        Factory::Options o;
        o.SetApproxLevelSmooth(levels[k]).SetApproxLevelSharp(levels[k]).SetExternalCache(&all.caches[k]);
        byLevel[k] = std::make_unique<Factory>(*topology_->refiner, o);
    }
    const bool linear = c.scheme == SubdivisionScheme::Bilinear;
    data.pattern.assign(size_t(faceCount_), kNothing);
    data.first.reserve(size_t(faceCount_) + 1);
    data.index.reserve(size_t(faceCount_) * (linear ? 4 : 16));
    for (int f = 0; f < faceCount_; ++f) {
        data.first.push_back(data.index.size());
        const auto corners = base.GetFaceVertices(f);
        int64_t points = 0; // about as many as its surface has
        for (int k = 0; k < corners.size() && points <= kMostPoints; ++k)
            for (int g : spanOf(base.GetVertexFaces(corners[k])))
                if ((points += base.GetFaceVertices(g).size() - 2) > kMostPoints) break;
        Surface s;
        const void* from = nullptr;
        bool ok;
        if (points > kMostPoints && !linear) {
            // Its neighbourhood is too large for a matrix: flat, by its own corners.
            ok = byLevel[2]->FaceHasLimitSurface(f) && byLevel[2]->InitVaryingSurface(f, &s);
            if (ok && channel < 0) ++flattened_;
            if (ok && channel >= 0) ok = false;
        } else {
            const int level = levelFor(int(points), all.bytes);
            const size_t k = level == kDeepestLevel ? 0 : level == 4 ? 1 : 2;
            coarser_ |= k > 0 && points <= 160;
            all.caches[k].last = nullptr;
            ok = channel < 0 ? byLevel[k]->InitVertexSurface(f, &s) : byLevel[k]->InitFaceVaryingSurface(f, &s, channel);
            from = all.caches[k].last;
        }
        if (!ok || !s.IsValid()) continue;
        const size_t at = data.index.size();
        data.index.resize(at + size_t(s.GetNumControlPoints()));
        s.GetControlPointIndices(&data.index[at]);
        if (channel < 0 && !original_.empty())
            for (size_t i = at; i < data.index.size(); ++i) data.index[i] = original_[size_t(data.index[i])];
        data.pattern[size_t(f)] = all.of(s, from);
    }
    data.first.push_back(data.index.size());
    data.index.shrink_to_fit();
}

LimitSurface::PieceOf LimitSurface::pieceOf(uint32_t piece) const {
    if (firstPiece_.empty()) return {piece, 0};
    const uint32_t f = faceOfPiece_[piece];
    return {f, int(piece - firstPiece_[f])};
}

/// OpenSubdiv 3.5 computes second derivatives of irregular triangles with the wrong sign in inverted parts (the middle one of
/// four). Detects this by a difference of first derivatives.
static bool turnedOver(const Surface& s, const double uv[2], const double* du, const double* duu, int n) {
    const double step = uv[0] > 1 / 3.0 ? -1e-6 : 1e-6, there[2] = {uv[0] + step, uv[1]};
    LimitWeights room;
    double* w = room.make(n, 3);
    s.EvaluateStencil(there, w, w + n, w + 2 * size_t(n));
    double same = 0;
    for (int i = 0; i < n; ++i) same += (w[size_t(n) + size_t(i)] - du[i]) * step * duu[i];
    return same < 0;
}

void LimitSurface::evaluate(const Data& d, uint32_t piece, double u, double v, int derivatives, LimitWeights& out) const {
    const PieceOf at = pieceOf(piece);
    const uint32_t pattern = d.pattern[at.face];
    if (pattern == kNothing) {
        out.make(0, 1);
        return;
    }
    const Surface& s = patterns_->surface[pattern];
    const int n = s.GetNumControlPoints(), sets = derivatives == 0 ? 1 : derivatives == 1 ? 3 : 6;
    double* w = out.make(n, sets);
    out.index = &d.index[d.first[at.face]];
    double uv[2] = {u, v}, scale = 1;
    if (piecesOf(at.face) > 1) {
        // Pieces are in tiles of which each fills a quarter.
        const double own[2] = {u, v};
        s.GetParameterization().ConvertNormalizedSubFaceToCoord(at.corner, own, uv);
        scale = 0.5;
    }
    const auto set = [&](int k) { return w + size_t(k) * size_t(n); };
    if (derivatives == 0) s.EvaluateStencil(uv, w);
    else if (derivatives == 1) s.EvaluateStencil(uv, w, set(1), set(2));
    else s.EvaluateStencil(uv, w, set(1), set(2), set(3), set(4), set(5));
    if (derivatives > 1 && scheme_ == SubdivisionScheme::Loop && !s.IsRegular() && turnedOver(s, uv, set(1), set(3), n))
        for (int k = 3; k < 6; ++k)
            for (int i = 0; i < n; ++i) set(k)[i] = -set(k)[i];
    if (scale != 1)
        for (int k = 1; k < sets; ++k)
            for (int i = 0; i < n; ++i) set(k)[i] *= k < 3 ? scale : scale * scale;
}

uint32_t LimitSurface::edges() const { return uint32_t(topology_->base().GetNumEdges()); }
int LimitSurface::corners(uint32_t f) const { return topology_->base().GetFaceVertices(int(f)).size(); }
int LimitSurface::vertexAt(uint32_t f, int corner) const {
    const int v = topology_->base().GetFaceVertices(int(f))[corner];
    return original_.empty() ? v : original_[size_t(v)];
}
int LimitSurface::edgeAt(uint32_t f, int corner) const {
    const int e = topology_->base().GetFaceEdges(int(f))[corner];
    return sameEdge_.empty() ? e : sameEdge_[size_t(e)];
}
int LimitSurface::edgeStart(int e) const {
    const int v = topology_->base().GetEdgeVertices(e)[0];
    return original_.empty() ? v : original_[size_t(v)];
}

void LimitSurface::forgetTopology() {
    topology_.reset();
    // The surfaces keep the cache data that they need.
}

} // namespace alpenglow::geometry
