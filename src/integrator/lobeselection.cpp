// Stage LobeSelection: albedo of each lobe, the energy rule, and the probability of its ray (docs/design/light-transport.md).
#include "integrator/lobeselection.h"
#include "integrator/accumulator.h"
#include "integrator/medium.h"
#include "integrator/photonscatter.h"
#include "integrator/photonstage.h"
#include "integrator/requests.h"
#include "integrator/transparency.h"
#include "integrator/vertexlight.h"

namespace alpenglow::integrator {

LobeSelection::LobeSelection(const StageSet& s, const VertexLobes& v, PhotonScatter& photonScatter)
    : VertexStage(s, v), photonScatter_(photonScatter), accumulator_(s.accumulator), media_(s.media),
      mediumEvents_(s.mediumEvents), photons_(s.photons), transparency_(s.transparency), vertexLight_(s.vertexLight) {}

namespace {
/// Indirect light of a lobe may be scaled to 0, but its ray still carries emission: the lobe keeps at least this fraction of its
/// probability.
constexpr float kLeastScale = 1 / 32.f;
} // namespace

void LobeSelection::choose() {
    indirectScale.assign(c_->points.size(), 1.f);
    passes.assign(c_->points.size(), 1.f);
    for (const int point : requests_.apartAt) // indirectdiffuse() adds the light of surfaces
        for (const int i : lobesOf(size_t(point)))
            if (LobeVertex& l = requests_.lobes[size_t(i)]; l.lobeOfShader && l.rays == &kDiffuseKind && !l.ownsTarget)
                l.indirect = 0;
    for (size_t point = 0; point < c_->points.size(); ++point)
        if (begin_[point] != begin_[point + 1]) choosePoint(point);
}

/// Lobes beyond the depth limit are not followed; light samples then count in full.
bool LobeSelection::tooDeep(const LobeVertex& l, const PathRay& from, const SurfaceBinding& b) const {
    const bool diffuse = l.rays->type == RayType::Diffuse;
    if (from.scattered >= limits::kPathDepth) return true;
    const int scattered = from.scattered + c_->between; // scattering in media does not count as depth
    if (from.bounces + 1 - scattered > world_.maxDepth_) return true;
    if (const PhotonTrace* t = photons_.photonTrace(); t && t->job->caustics) return !photonScatter_.depthsBehind(l, b);
    return (b.maxDiffuse >= 0 && from.diffuseBounces + diffuse - scattered > b.maxDiffuse) ||
           (b.maxSpecular >= 0 && from.specularBounces + !diffuse > b.maxSpecular);
}

void LobeSelection::choosePoint(size_t point) {
    const PathRay& from = c_->rays[point];
    const SurfaceBinding& b = world_.bindings_[size_t(c_->bindings[point])];
    const Color clear = c_->clear.empty() ? Color(0) : c_->clear[point];
    // Under path one ray continues from a vertex: along a lobe, or behind a transparent surface. These may have very different
    // colours, so the choice weights them by the throughput of the path; otherwise a channel could grow without bound. A camera
    // ray also continues in addition.
    const Color on = c_->clear.empty() ? Color(0) : transparency_.goesOn(*c_, int(point));
    const bool competes = rules_.pickOne && from.bounces > 0 && maxComponent(on) > 0;
    const Color left = absolute(from.weight);
    const auto worth = [&](const Color& share) { return competes ? dot(share, left) / 3 : luminance(share); };
    const auto list = lobesOf(point);
    const float narrowest = photons_.narrowBelow(from);
    Color sum(0), seen(0);
    bool cut = false; // by the render's depth limit, not an attribute's
    for (int i : list) {
        LobeVertex& l = requests_.lobes[size_t(i)];
        const Color weight = absolute(l.weight);
        l.albedo = requests_.rows.albedo(l.place);
        l.delta = requests_.rows.delta(l.place);
        l.narrow = photonScatter_.isNarrow(l, narrowest, normalize(c_->points[point].I));
        if (l.lobeOfShader) sum += weight * l.albedo;
        if (!l.ownsTarget && !albedoIsMeasured(l)) seen += l.weight * l.albedo;
        l.chosen = std::max(worth(weight) * l.albedo, 0.f);
        if (!std::isfinite(l.chosen)) {
            accumulator_.notFinite(*c_, from, l.site);
            l.chosen = 0;
        }
        cut |= from.bounces + 1 - from.scattered - c_->between > world_.maxDepth_ && l.chosen > 0;
        const bool noIndirect =
            l.rays->type == RayType::Diffuse && !world_.settings_.indirect && !photonScatter_.sampledByPaths(l);
        const bool deep = l.below < 0 && tooDeep(l, from, b);               // walks end in light
        const bool ended = from.guided() && !PhotonScatter::mirrorsPath(l); // guide rays continue by mirrors only
        const bool stays = l.directOnly || deep || (l.below < 0 && noIndirect) || ended;
        l.last = deep && !l.directOnly && !noIndirect && !ended && l.chosen > 0;
        if (ended) l.lights = false;
        if (stays) l.chosen = 0;
        l.followed = l.chosen > 0 || (l.ownsTarget && !stays);
    }
    counters_.depthCap += cut;
    if (from.counts && world_.settings_.firstSeen && !c_->aside)
        accumulator_.results[size_t(from.sample->path)]->albedo += from.weight * seen;
    const bool most = sum.x + clear.x > 1 || sum.y + clear.y > 1 || sum.z + clear.z > 1;
    const float scale = indirectScale[point] = most ? energyScale(point, sum, clear) : 1;
    const float behind = competes ? worth(on) : 0;
    if (list.size() == 1 && behind == 0) { // the most frequent case
        LobeVertex& l = requests_.lobes[size_t(list[0])];
        l.chosen = l.ownsTarget || !rules_.pickOne ? l.followed : l.chosen > 0;
        return;
    }
    double total = behind;
    for (int i : list)
        if (LobeVertex& l = requests_.lobes[size_t(i)]; !l.ownsTarget) {
            if (behind > 0 && l.lobeOfShader) l.chosen *= std::max(scale, kLeastScale);
            total += l.chosen;
        }
    for (int i : list) {
        LobeVertex& l = requests_.lobes[size_t(i)];
        if (l.ownsTarget || !rules_.pickOne) l.chosen = l.followed ? 1 : 0;
        else l.chosen = total > 0 ? (total == l.chosen ? 1 : float(l.chosen / total)) : 0;
    }
    passes[point] = behind > 0 && total > behind ? float(behind / total) : 1;
}

/// Reflected plus transmitted light must not exceed incident light.
float LobeSelection::energyScale(size_t point, const Color& reflected, const Color& clear) {
    float scale = 1;
    for (int k = 0; k < 3 && !world_.settings_.unbiased && !c_->aside; ++k) // sums of outputs need not conserve energy
        if (reflected[k] + clear[k] > 1 && reflected[k] > 0) scale = std::min(scale, (1 - clear[k]) / reflected[k]);
    // Reflectance alone; a highlight on a clear surface is common and not reported as such
    const bool more = maxComponent(reflected) > 1;
    const SurfaceBinding& b = world_.bindings_[size_t(c_->bindings[point])];
    if (scale < 0.999f) vertexLight_.tellScaled(b, more);
    return scale;
}

} // namespace alpenglow::integrator
