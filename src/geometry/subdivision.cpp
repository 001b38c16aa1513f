#include "geometry/subdivision.h"
#include "geometry/welding.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

using scene::Class;

Subdivision::Subdivision(ShapeSource s, CageInput&& in, std::vector<FaceDomain> domains, Diagnostics& diag)
    : Shape(std::move(s)), input_(std::move(in)), domains_(std::move(domains)) {
    const scene::Param* P = lastParam(source_.primitive->params, "P");
    objectP_ = P->numbers.data();
    const auto& c = input_.cage.corners;
    evenCorners_ = c.empty() ? 0 : c[0];
    if (std::any_of(c.begin(), c.end(), [&](int n) { return n != evenCorners_; })) {
        size_t at = 0;
        for (int n : c) firstCorner_.push_back(at), at += size_t(n);
    }
    takePrimvars(diag);
    std::vector<LimitSurface::Channel> channels;
    makeChannels(channels);
    std::string why;
    limit_ = std::make_unique<LimitSurface>(input_.cage, channels, why);
    if (!limit_->valid()) {
        diag.report(Severity::Error, Rie::Consistency, place(), kind() + ": " + why + "; it is not drawn");
        return;
    }
    for (uint32_t f = 0; f < limit_->faces(); ++f)
        if (limit_->drawn(f)) drawn_ += limit_->piecesOf(f);
    if (limit_->flattened())
        diag.report(Severity::Warning, Rie::Limit, place(),
                    kind() + ": " + std::to_string(limit_->flattened()) +
                        " faces have more neighbours than their limit can be evaluated for; they are drawn flat");
    if (limit_->blunted())
        diag.report(Severity::Warning, Rie::Incapable, place(),
                    kind() + ": faces share edges or vertices in more than one sheet; its creases and corners are ignored");
    if (limit_->coarser())
        diag.report(Severity::Info, Rie::Limit, place(),
                    kind() + " has very many different face neighbourhoods; some are evaluated less accurately");
    if (empty())
        diag.report(Severity::Warning, Rie::Range, place(), kind() + " has no face with a limit surface; it is not drawn",
                    input_.cage.boundary == SubdivisionCage::Boundary::None
                        ? "faces at a border need the tag \"interpolateboundary\""
                        : "");
    for (int v = 0; v < input_.cage.vertices; ++v) {
        const Vec3d q =
            transformPoint(toCamera(), Vec3d(objectP_[3 * size_t(v)], objectP_[3 * size_t(v) + 1], objectP_[3 * size_t(v) + 2]));
        pointScale_ = std::max(pointScale_, std::fabs(q.x) + std::fabs(q.y) + std::fabs(q.z));
    }
}

void Subdivision::makeChannels(std::vector<LimitSurface::Channel>& out) {
    const auto take = [&](const PrimVar& var) {
        const bool smooth = var.cls == Class::FaceVertex || (var.cls == Class::FaceVarying && !input_.faceVaryingLinear);
        if (!smooth || !var.param || var.type == scene::Type::String || input_.cage.scheme == SubdivisionScheme::Bilinear) return;
        const size_t width = size_t(var.width());
        const float* data = var.param->numbers.data();
        LimitSurface::Channel channel =
            weld(input_.cage.vertex, input_.cage.vertices, [&](size_t k) { return data + requestCorner(k) * width; }, width);
        smooth_.push_back(var.param);
        out.push_back(std::move(channel));
    };
    for (const PrimVar& var : primvars_) take(var);
    if (normal_.param) take(normal_);
}

int Subdivision::channelOf(const PrimVar& var) const {
    for (size_t k = 0; k < smooth_.size(); ++k)
        if (smooth_[k] == var.param) return int(k);
    return -1;
}

LocalPoint Subdivision::cameraPoint(uint32_t piece, double u, double v, int derivatives) const {
    LimitWeights w;
    limit_->weights(piece, u, v, derivatives, w);
    const int sets = derivatives == 0 ? 1 : derivatives == 1 ? 3 : 6;
    Vec3d sum[6];
    for (int k = 0; k < sets; ++k) {
        const double* q = w.weights(k);
        double x = 0, y = 0, z = 0;
        for (int i = 0; i < w.count; ++i) {
            const float* p = objectP_ + 3 * size_t(w.index[i]);
            x += q[i] * p[0];
            y += q[i] * p[1];
            z += q[i] * p[2];
        }
        sum[k] = Vec3d(x, y, z);
    }
    LocalPoint r;
    const auto vector = [&](int k) { return k < sets ? transformVector(toCamera(), sum[k]) : Vec3d(0.0); };
    r.P = transformPoint(toCamera(), sum[0]);
    r.Pu = vector(1);
    r.Pv = vector(2);
    r.Puu = vector(3);
    r.Puv = vector(4);
    r.Pvv = vector(5);
    return r;
}

void Subdivision::setNormal(uint32_t piece, double u, double v, LocalPoint& p) const {
    const auto normalOf = [](const LocalPoint& q, Vec3d& n) {
        const Vec3d c = cross(q.Pu, q.Pv);
        const double l = length(c);
        if (!(l > 1e-10 * (dot(q.Pu, q.Pu) + dot(q.Pv, q.Pv)))) return false;
        n = c / l;
        return true;
    };
    if (normalOf(p, p.n)) {
        normalDerivatives(p);
        return;
    }
    // A sharp corner's partials vanish, or a face has collapsed there: the normal a little inside.
    for (double step : {1e-4, 1e-3, 1e-2, 0.1, 0.3}) {
        const double third = 1 / 3.0;
        const LocalPoint q = cameraPoint(piece, u + (third - u) * step, v + (third - v) * step, 1);
        if (normalOf(q, p.n)) return;
    }
    p.n = Vec3d(0, 0, -1);
}

void Subdivision::evaluateLocal(uint32_t piece, double u, double v, SurfacePoint& p, uint32_t needs) const {
    u = std::clamp(u, 0.0, 1.0);
    v = std::clamp(v, 0.0, 1.0);
    if (limit_->triangles() && u + v > 1) {
        const double s = u + v;
        u /= s;
        v /= s;
    }
    LocalPoint c = cameraPoint(piece, u, v, (needs & (kNeedPartials | kNeedNormalSlopes)) ? 2 : 1);
    setNormal(piece, u, v, c);
    p = SurfacePoint();
    const double o = orientation_;
    const LimitSurface::PieceOf at = limit_->pieceOf(piece);
    p.P = Vec3(c.P);
    p.n = Vec3(c.n * o);
    p.u = float(u);
    p.v = float(v);
    if (!domains_.empty()) {
        // The face is a part of one of the request's: by u and v of that one.
        const FaceDomain& d = domains_[at.face];
        const Vec3d Pu = c.Pu, Pv = c.Pv, uu = c.Puu, uv = c.Puv, vv = c.Pvv, nu = c.nu, nv = c.nv;
        p.u = float(d.origin.x + u * d.along.x + v * d.across.x);
        p.v = float(d.origin.y + u * d.along.y + v * d.across.y);
        const double det = double(d.along.x) * d.across.y - double(d.along.y) * d.across.x;
        const double a = d.across.y / det, b = -d.along.y / det, e = -d.across.x / det,
                     f = d.along.x / det; // du'/du, dv'/du, du'/dv, dv'/dv
        c.Pu = Pu * a + Pv * b;
        c.Pv = Pu * e + Pv * f;
        c.nu = nu * a + nv * b;
        c.nv = nu * e + nv * f;
        c.Puu = uu * (a * a) + uv * (2 * a * b) + vv * (b * b);
        c.Puv = uu * (a * e) + uv * (a * f + b * e) + vv * (b * f);
        c.Pvv = uu * (e * e) + uv * (2 * e * f) + vv * (f * f);
    }
    p.dPdu = Vec3(c.Pu);
    p.dPdv = Vec3(c.Pv);
    p.Puu = Vec3(c.Puu);
    p.Puv = Vec3(c.Puv);
    p.Pvv = Vec3(c.Pvv);
    p.dNdu = Vec3(c.nu * o);
    p.dNdv = Vec3(c.nv * o);
    const Vec3d g = cross(c.Pu, c.Pv) * o;
    p.Ng = dot(g, g) > 0 ? Vec3(g) : p.n;
    p.orientation = orientation_;
    p.prim = piece;
    p.b1 = u;
    p.b2 = v;
    p.face = int(input_.faceOf.empty() ? at.face : input_.faceOf[at.face]);
    p.pError = roundingError(p.P) + float(4e-15 * pointScale_);
    finishPoint(p, true);
}

SurfacePoint Subdivision::evaluateLocal(uint32_t piece, double u, double v) const {
    SurfacePoint p;
    evaluateLocal(piece, u, v, p, kNeedAll);
    return p;
}

SurfacePoint Subdivision::evaluate(int face, double u, double v) const {
    uint32_t f = uint32_t(std::clamp(face, 0, int(input_.requestFaces) - 1));
    if (!input_.faceOf.empty()) {
        const auto at = std::lower_bound(input_.faceOf.begin(), input_.faceOf.end(), f);
        f = at == input_.faceOf.end() ? uint32_t(input_.faceOf.size() - 1) : uint32_t(at - input_.faceOf.begin());
    }
    const uint32_t n = limit_->piecesOf(f), k = n == 1 ? 0 : uint32_t(std::clamp(u, 0.0, double(n) - 1));
    return evaluateLocal(limit_->firstPiece(f) + k, n == 1 ? u : u - k, v);
}

// ---- variables ----------------------------------------------------------------------------------------------------------------

size_t Subdivision::classCount(Class c) const {
    switch (c) {
    case Class::Constant:
        return 1;
    case Class::Uniform:
        return input_.requestFaces;
    case Class::FaceVarying:
    case Class::FaceVertex:
        return input_.requestCorners;
    default: {
        // One for each vertex that a face uses (RISpec 3.2, 5.3).
        int most = -1;
        for (int v : source_.primitive->ints2) most = std::max(most, v);
        return size_t(std::min(most + 1, input_.cage.vertices));
    }
    }
}

int Subdivision::cornerWeights(uint32_t piece, double u, double v, std::vector<Weight>& w) const {
    const LimitSurface::PieceOf at = limit_->pieceOf(piece);
    const int n = corners(at.face);
    const size_t first = firstCorner(at.face);
    w.assign(size_t(n), {});
    for (int k = 0; k < n; ++k) w[size_t(k)].index = first + size_t(k);
    const auto add = [&](int k, double share, double f, double fu, double fv) {
        Weight& x = w[size_t((k + n) % n)];
        x.w += share * f;
        x.du += share * fu;
        x.dv += share * fv;
    };
    if (limit_->triangles()) {
        add(0, 1, 1 - u - v, -1, -1);
        add(1, 1, u, 1, 0);
        add(2, 1, v, 0, 1);
        return n;
    }
    const double f[4] = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v}, fu[4] = {v - 1, 1 - v, v, -v},
                 fv[4] = {u - 1, -u, u, 1 - u};
    if (limit_->piecesOf(at.face) == 1) {
        for (int k = 0; k < 4; ++k) add(k, 1, f[k], fu[k], fv[k]);
        return n;
    }
    // Corner, midpoint of the next edge, centre of the face, midpoint of the previous edge.
    const int k = at.corner;
    add(k, 1, f[0], fu[0], fv[0]);
    for (int j : {k, k + 1}) add(j, 0.5, f[1], fu[1], fv[1]);
    for (int j = 0; j < n; ++j) add(j, 1.0 / n, f[2], fu[2], fv[2]);
    for (int j : {k, k - 1}) add(j, 0.5, f[3], fu[3], fv[3]);
    return n;
}

int Subdivision::weights(Class c, const SurfacePoint& p, Weight w[16]) const {
    w[0] = {0, 1, 0, 0};
    if (c == Class::Constant) return 1;
    if (c == Class::Uniform) {
        w[0].index = size_t(p.face);
        return 1;
    }
    std::vector<Weight> all;
    cornerWeights(p.prim, p.b1, p.b2, all);
    const auto most = std::max_element(all.begin(), all.end(), [](const Weight& a, const Weight& b) { return a.w < b.w; });
    w[0].index = c == Class::FaceVarying || c == Class::FaceVertex ? requestCorner(most->index) : size_t(vertexAt(most->index));
    return 1;
}

void Subdivision::interpolateVariable(const PrimVar& var, const SurfacePoint& p, float* out, float* du, float* dv) const {
    if (var.cls == Class::Constant || var.cls == Class::Uniform) return Shape::interpolateVariable(var, p, out, du, dv);
    const bool byCorner = var.cls == Class::FaceVarying || var.cls == Class::FaceVertex;
    const int channel = byCorner ? channelOf(var) : -1;
    std::vector<Weight> all;
    if (var.cls == Class::Vertex || channel >= 0) {
        LimitWeights w;
        const int derivatives = du || dv ? 1 : 0;
        if (channel >= 0) limit_->weights(channel, p.prim, p.b1, p.b2, derivatives, w);
        else limit_->weights(p.prim, p.b1, p.b2, derivatives, w);
        all.resize(size_t(w.count));
        for (size_t i = 0; i < all.size(); ++i) {
            const size_t at = size_t(w.index[i]);
            all[i] = {channel >= 0 ? requestCorner(at) : at, w.weights(0)[i], 0, 0};
            if (derivatives) all[i].du = w.weights(1)[i], all[i].dv = w.weights(2)[i];
        }
    }
    if (all.empty()) { // linear, or a face too large for its channel
        cornerWeights(p.prim, p.b1, p.b2, all);
        for (Weight& w : all) w.index = byCorner ? requestCorner(w.index) : size_t(vertexAt(w.index));
    }
    if (!domains_.empty()) {
        const FaceDomain& d = domains_[limit_->pieceOf(p.prim).face];
        const double det = double(d.along.x) * d.across.y - double(d.along.y) * d.across.x;
        for (Weight& w : all) {
            const double a = w.du, b = w.dv;
            w.du = (a * d.across.y - b * d.along.y) / det;
            w.dv = (b * d.along.x - a * d.across.x) / det;
        }
    }
    interpolatePrimVar(var, all.data(), int(all.size()), out, du, dv);
}

// ---- area ---------------------------------------------------------------------------------------------------------------------

const Subdivision::Areas& Subdivision::areas() const {
    std::call_once(areas_.made, [&] {
        // Gauss-Legendre, 4 points a direction; triangles as squares of which one side has collapsed.
        static constexpr double x[4] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
        static constexpr double w[4] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};
        areas_.cumulative.reserve(limit_->pieces());
        for (uint32_t k = 0; k < limit_->pieces(); ++k) {
            double sum = 0;
            if (limit_->drawn(limit_->pieceOf(k).face))
                for (int j = 0; j < 4; ++j)
                    for (int i = 0; i < 4; ++i) {
                        const double narrow = limit_->triangles() ? 1 - x[j] : 1;
                        const LocalPoint p = cameraPoint(k, x[i] * narrow, x[j], 1);
                        sum += w[i] * w[j] * narrow * length(cross(p.Pu, p.Pv));
                    }
            areas_.cumulative.push_back(areas_.sum += sum);
        }
    });
    return areas_;
}

SurfacePoint Subdivision::sampleArea(double xi1, double xi2) const {
    const Areas& all = areas();
    const double target = xi1 * all.sum;
    size_t k = size_t(std::upper_bound(all.cumulative.begin(), all.cumulative.end(), target) - all.cumulative.begin());
    k = std::min(k, all.cumulative.size() - 1);
    // The remainder of the first number is uniform within the piece.
    const double lo = k ? all.cumulative[k - 1] : 0, size = all.cumulative[k] - lo;
    double u = size > 0 ? std::clamp((target - lo) / size, 0.0, 1.0) : 0.5, v = xi2;
    if (limit_->triangles()) {
        const double root = std::sqrt(u);
        u = root * (1 - xi2);
        v = root * xi2;
    }
    return evaluateLocal(uint32_t(k), u, v);
}

double Subdivision::sampleDensity(const SurfacePoint& p) const {
    const Areas& all = areas();
    const double l = length(cross(Vec3d(p.dPdu), Vec3d(p.dPdv)));
    if (!(l > 0) || !(all.sum > 0) || p.prim >= all.cumulative.size()) return 0;
    double share = (all.cumulative[p.prim] - (p.prim ? all.cumulative[p.prim - 1] : 0)) / all.sum;
    if (limit_->triangles()) share *= 2;
    if (!domains_.empty()) {
        const FaceDomain& d = domains_[limit_->pieceOf(p.prim).face];
        share /= std::fabs(double(d.along.x) * d.across.y - double(d.along.y) * d.across.x);
    }
    return share / l;
}

} // namespace alpenglow::geometry
