// Parameters of trace() that only some calls have, point by point: "bias", "maxdist", "weight", "falloff", an origin of its own.
#include "integrator/blockvertices.h"
#include "integrator/occlusioncalls.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/surfacepoints.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

static const geometry::SurfacePoint& surfaceAt(const BatchContext& c, size_t point) {
    return c.points.empty() ? c.surfaces[point] : c.points[point].surface;
}

/// Reads the parameters of a call. A ray with "weight" 0 is not sent. Returns false if a point must be processed on its own.
bool BlockVertices::readOptions(Site& s, BatchContext& c) {
    const auto elsewhere = [](const LobeBlock& l) { return l.elsewhere != 0; };
    if (!s.info->block->options && rules_.pickOne && std::none_of(s.lobes.begin(), s.lobes.begin() + long(blocks_), elsewhere))
        return true;
    const SiteInfo& info = *s.info;
    s.options.assign(points_, {});
    for (size_t b = 0; b < blocks_; ++b)
        for (Lanes left = s.lobes[b].asked; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
            const auto row = [&](int r) { return s.rows[b][size_t(r) * size_t(s.stride) + i]; };
            RayOptions& o = s.options[point] = rayOptionsOf(info, row);
            if ((o.elsewhere = s.lobes[b].elsewhere >> i & 1)) {
                if (surfaceAt(c, point).displaced) return false; // then the ray starts at the point after all
                const int from = info.rows[0];
                o.from = {row(from), row(from + 1), row(from + 2)};
            }
            if (photons_.photonTrace() || (o.importance > 0 && rules_.pickOne)) continue; // photons ignore "weight"
            surfaces_.pointsOfRows(c);
            o.samples = occlusion_.samplesOf(samplesAskedOf(info, row), c.points[point].shape, info, c);
            if (o.importance > 0) continue;
            ignored_ += uint64_t(o.samples);
            s.lobes[b].asked &= ~(1u << i);
        }
    return true;
}

/// Sets the shadow rays of a call with a bias or a limit of distance, and removes samples out of its reach.
/// points, lights: by lane.
void BlockVertices::limitShadows(const Site& s, const size_t* points, const BoundLight* const* lights, LightBlock& l) {
    for (Lanes left = l.asked; left; left &= left - 1) {
        const size_t i = size_t(std::countr_zero(left)), point = points[i];
        const BoundLight& of = *lights[i];
        const RayOptions& o = s.options[point];
        const auto row3 = [&](const Row* r) { return Vec3(r[0][i], r[1][i], r[2][i]); };
        const Vec3 w = row3(l.w), origin = originOf(s, point, w), way = row3(l.end) - origin;
        const Vec3 direction = l.emitter ? normalizeOr(way, w) : w;
        for (int q = 0; q < 3; ++q) shadow_.origin[q][i] = origin[q], shadow_.direction[q][i] = direction[q];
        shadow_.length[i] = l.emitter ? length(way) * (1 - 1e-6f) : of.isSky() ? o.maxDistance : l.far[i];
        const bool limited = l.emitter || (!of.isSky() && of.kind != LightKind::Distant);
        // Shadow rays end before a light without area by kShort, so the limit is shortened as well.
        constexpr float kShort = 1 - 1e-5f;
        const float away = l.emitter ? length(way) : l.far[i], most = l.emitter ? o.maxDistance : o.maxDistance * kShort;
        if (limited && away > most) l.asked &= ~(1u << i);
    }
}

/// Applies the parameters to the next rays of a block.
void BlockVertices::applyOptions(size_t b, const BatchContext& c) {
    RayBlock& r = rays_[b];
    for (Lanes left = next_.goes; left; left &= left - 1) {
        const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
        const Site& s = sites_[size_t(next_.site[i])];
        if (s.options.empty()) continue;
        const Vec3 origin = originOf(s, point, {next_.direction[0][i], next_.direction[1][i], next_.direction[2][i]});
        for (int q = 0; q < 3; ++q) r.origin[q][i] = origin[q];
        r.maxDistance[i] = s.options[point].maxDistance;
        r.importance[i] *= s.options[point].importance;
        if (!(s.options[point].base > 0)) continue;
        const ShadePoint& p = c.points[point]; // the ray starts anywhere in the footprint
        const Vec2 at = store_.random(c.rays[point]).pair(next_.vertex[i], kSampleBase, 0);
        const Vec3 off =
            (p.surface.dPdu * (p.du * (at.x - .5f)) + p.surface.dPdv * (p.dv * (at.y - .5f))) * s.options[point].base;
        for (int q = 0; q < 3; ++q) r.origin[q][i] += off[q];
    }
}

/// Origin of a ray of a lobe in direction w.
Vec3 BlockVertices::originOf(const Site& s, size_t point, const Vec3& w) const {
    const VertexBlock& v = vertices_[point / kBlock];
    const size_t i = point % kBlock;
    const Vec3 P(v.P[0][i], v.P[1][i], v.P[2][i]), n(v.n[0][i], v.n[1][i], v.n[2][i]);
    if (!s.options.empty()) {
        const RayOptions& o = s.options[point];
        const Vec3 at = o.elsewhere ? o.from : P;
        if (o.bias >= 0) return at + w * o.bias;
        if (o.elsewhere) return at + w * geometry::roundingError(at);
    }
    if (moved_) return surfaces_.leave(*moved_, point, w);
    return v.bias[i] > 0 ? P + w * v.bias[i] : geometry::offsetOrigin(P, n, v.error[i], w);
}

} // namespace alpenglow::integrator
