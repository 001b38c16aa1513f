// Surfaces with a photon shading model (Attribute "photon" "shadingmodel"), and photon map lookups at surfaces.
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/context.h"
#include "integrator/emission.h"
#include "integrator/lightpathstates.h"
#include "integrator/mediastacks.h"
#include "integrator/photonjob.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"
#include "integrator/surfaceshading.h"
#include "integrator/transparency.h"
#include "integrator/vertexlight.h"
#include "shadeops/specular.h"
#include "world/mediaabout.h"
#include <algorithm>

namespace alpenglow::integrator {

PhotonTrace& PhotonStage::begin() {
    if (!photonTrace_) photonTrace_ = std::make_unique<PhotonTrace>();
    return *photonTrace_;
}

PhotonStage::PhotonStage(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), vertexLight_(s.vertexLight), paths_(s.paths), media_(s.media),
      store_(s.store), shading_(s.shading), transparency_(s.transparency) {}

namespace {

/// Fresnel reflectance for unpolarised light; `index`: index of refraction on the incident side over that on the other side.
float reflectance(float cosine, float index, Vec3 in, Vec3 n, Vec3& refracted) {
    const float k = 1 - index * index * (1 - cosine * cosine);
    if (!(k > 0)) return 1;
    const float ct = std::sqrt(k);
    const float s = (index * cosine - ct) / (index * cosine + ct), p = (cosine - index * ct) / (cosine + index * ct);
    refracted = normalize(in * index + n * (index * cosine - ct));
    return (s * s + p * p) / 2;
}

/// For caustics under path, where Attribute "photon" "shadingmodel" is ignored.
void sayNoCaustics(const SurfaceBinding& b, Diagnostics& d) {
    d.reportOnce(
        "causticwaits:" + b.surface->name,
        {Severity::Warning,
         Rie::Incapable,
         b.surface->place,
         "surface \"" + b.surface->name + "\" makes no caustics: its shader branches on the results of its rays",
         "a shader whose Ci is a sum of products with trace() makes them, as slmaterial does; `alpenglow info` names the "
         "call that prevents it",
         {}});
}

} // namespace

PhotonModel PhotonStage::modelAt(const BatchContext& c, size_t point, bool all) const {
    const bool models = photonTrace_->job->models;
    const PhotonModel m = models ? world_.bindings()[size_t(c.bindings[point])].photons.model : PhotonModel::Shader;
    return m == PhotonModel::Shader && all ? PhotonModel::Matte : m;
}

int PhotonStage::lobesOfModel(PhotonModel model, const ShadePoint& p, const Color& Cs, ModelLobe (&to)[kModelLobes]) {
    static const LobeKind *const diffuse = findLobe("diffuse"), *const mirror = findLobe("uniform"),
                                 *const specular = findLobe("specular");
    const Vec3 in = normalize(p.I), side = normalize(p.N), N = dot(side, in) > 0 ? -side : side;
    const Vec3 mirrored = normalize(in - N * (2 * dot(in, N)));
    int count = 0;
    if (model == PhotonModel::Matte) to[count++] = {diffuse, N, Cs, &kDiffuseKind};
    if (model == PhotonModel::Chrome) to[count++] = {mirror, mirrored, Cs, &kSpecularKind};
    if (model == PhotonModel::Plastic) { // as in the shader of that name
        to[count++] = {diffuse, N, Cs * .5f, &kDiffuseKind};
        to[count++] = {specular, N, Color(.5f), &kSpecularKind, shadeops::kSpecularExponent / .1f};
    }
    if (model == PhotonModel::Glass || model == PhotonModel::Water) {
        const float eta = model == PhotonModel::Glass ? 1.5f : 1.33f;
        Vec3 refracted = in;
        const float kr = reflectance(-dot(in, N), dot(side, in) < 0 ? 1 / eta : eta, in, N, refracted);
        to[count++] = {mirror, mirrored, Cs * kr, &kSpecularKind};
        if (kr < 1) to[count++] = {mirror, refracted, Cs * (1 - kr), &kSpecularKind};
    }
    return count;
}

void PhotonStage::photonsByModel(BatchContext& c, Sched& sched) {
    const size_t n = c.points.size();
    for (size_t i = 0; i < n; ++i) {
        const SurfaceBinding& b = world_.bindings()[size_t(c.bindings[i])];
        if (photonTrace_->job->learns) continue;
        if (photonTrace_->job->caustics) sayNoCaustics(b, diagnostics_);
        else if (b.photons.model == PhotonModel::Shader)
            diagnostics_.reportOnce(
                "photonwaits:" + b.surface->name,
                {Severity::Info,
                 Rie::NoError,
                 b.surface->place,
                 "surface \"" + b.surface->name + "\" branches on the results of its rays: photons scatter as on a matte surface",
                 "Attribute \"photon\" \"string shadingmodel\" selects another model",
                 {}});
    }
    c.clear.assign(n, Color(0));
    c.passes.assign(n, 1.f);
    for (size_t i = 0; i < n; ++i) {
        const SurfaceBinding& b = world_.bindings()[size_t(c.bindings[i])];
        const Color o = b.attributes->opacity;
        c.clear[i] = b.photons.model == PhotonModel::Transparent
                         ? Color(1)
                         : Color(std::clamp(1 - o.x, 0.f, 1.f), std::clamp(1 - o.y, 0.f, 1.f), std::clamp(1 - o.z, 0.f, 1.f));
        c.clear[i] = c.clear[i] * transparency_.leftBehind(c, int(i));
    }
    vertexLight_.runModels(c, sched);
    for (size_t i = 0; i < n; ++i)
        if (const Color clear = transparency_.goesOn(c, int(i)); maxComponent(clear) > 0 && c.passes[i] > 0)
            transparency_.continueBehind(world_.bindings()[size_t(c.bindings[i])], c.rays[i], c.targets[i], c.points[i], clear,
                                         c.passes[i], 0, sched);
}

const photonmap::PhotonMap* PhotonStage::globalMapOf(int binding) {
    const auto [at, fresh] = globalMaps_.try_emplace(binding, nullptr);
    const PhotonBinding& b = world_.bindings()[size_t(binding)].photons;
    if (fresh && !b.globalMap.empty()) at->second = world_.photons()->find(b.globalMap, {});
    return at->second;
}

void PhotonStage::takeGlobalMaps(BatchContext& c, Sched& sched) {
    size_t kept = 0;
    for (size_t i = 0; i < c.rays.size(); ++i) {
        const photonmap::PhotonMap* map = c.rays[i].kind->gathersPhotons ? globalMapOf(c.bindings[i]) : nullptr;
        if (map) {
            const PathRay& r = c.rays[i];
            const ShadePoint& p = c.points[i];
            const Vec3& n = p.surface.displaced ? p.surface.displacedN : p.surface.n;
            const Color light =
                map->radiance({p.surface.displaced ? p.surface.displacedP : p.surface.P, dot(n, r.dir) > 0 ? -n : n,
                               world_.bindings()[size_t(c.bindings[i])].photons.estimator, 0});
            shading_.answerCall(c, int(i), Color(1), sched);
            accumulator_.contribute(sched, {c.targets[i], r.weight * light, LightEvent::Photons, &r, store_.extraOf(r).share,
                                            nullptr, paths_.atPhotons(r.path)});
            store_.freeExtra(r);
            sched.release(c.targets[i]);
            continue;
        }
        c.move(i, kept++);
    }
    c.keepFirst(kept);
}

/// The volumes at the origin of a photon; null: none.
const shading::Media* PhotonStage::aboutLight(const EmissionPlan::Light& l, const EmissionStart& s) {
    const bool placed = l.light->photons || l.light->kind == LightKind::Point || l.light->kind == LightKind::Area;
    if (world_.media().empty() || !placed) return nullptr;
    return media_.kept(mediaAbout(world_, s.origin, world_.shadesAtOpen() ? 0 : s.drawn.time));
}

void PhotonStage::tilt(BatchContext& c) {
    for (size_t i = 0; i < c.points.size(); ++i) {
        ShadePoint& p = c.points[i];
        const Vec3 N = normalize(p.N);
        if (!(sine(c.rays[i].dir, N) < kLeastTilt / 10)) continue;
        const Basis b(N);
        p.I = normalize(c.rays[i].dir + b.t * kLeastTilt) * length(p.I);
    }
}

} // namespace alpenglow::integrator
