// Builds a world from the description of a frame.
#include "base/file.h"
#include "base/hash.h"
#include "base/installation.h"
#include "geometry/build.h"
#include "geometry/placed.h"
#include "rsl/front/headers.h"
#include "scene/deferred.h"
#include "scene/numbers.h"
#include "scene/scene.h"
#include "world/cloudstore.h"
#include "world/ptexstore.h"
#include "world/surfaces.h"
#include <chrono>
#include <cstdlib>
#include <filesystem>

namespace alpenglow::world {

namespace {

double buildClock() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// REYES shades its grids once, at shutter open, and moves the result. So does the hidden hider, unless a surface or the hider
// requests the time of the sample (Attribute "trace" "samplemotion", Hider "hidden" "samplemotion").
bool shadesAtOpen(const scene::Frame& f, const Settings& settings, const std::vector<geometry::ShapeRef>& shapes) {
    if (settings.hider != Hider::Hidden) return false;
    const auto on = [](const scene::Param* p) { return p && !p->numbers.empty() && p->numbers[0] != 0; };
    if (on(scene::find(f.options.hiderParams, "samplemotion"))) return false;
    const auto asks = [&](const geometry::ShapeRef& s) {
        // Excludes later procedurals, which would change the meaning of earlier pixels
        return on(s->attributes().value("trace:samplemotion")) && scene::partOf(s->attributes()).empty();
    };
    return std::none_of(shapes.begin(), shapes.end(), asks);
}

bool isVisible(const scene::Attributes& a, const char* rays, bool otherwise) {
    const scene::Param* p = a.value(std::string("visibility:") + rays);
    if (!p) return otherwise;
    if (!p->strings.empty()) return p->strings[0] != "transparent";
    return !p->numbers.empty() && p->numbers[0] != 0;
}

/// Default visibility of primitives to traced rays, and to shadow rays.
struct UnsetVisibility {
    bool traced = true, shadows = true;
};

// Under path all are visible. Under the other hiders primitives are invisible by default to kinds of rays for which the scene
// sets visibility anywhere: BMRT's scenes never do, and their shaders trace. Deferred procedurals count by their own attributes,
// not by those of their contents.
UnsetVisibility unsetVisibility(const std::vector<geometry::ShapeRef>& shapes, const scene::Frame& frame, bool path) {
    UnsetVisibility unset;
    if (path) return unset;
    const auto ask = [&](const scene::Attributes& a) {
        if (!scene::partOf(a).empty()) return;
        for (const char* name : {"visibility:trace", "visibility:diffuse", "visibility:specular"})
            unset.traced &= a.value(name) == nullptr;
        unset.shadows &= !isVisible(a, "transmission", false);
    };
    const scene::Attributes* last = nullptr; // of consecutive shapes with the same attributes
    for (const geometry::ShapeRef& s : shapes) {
        if (&s->attributes() == last) continue;
        last = &s->attributes();
        ask(*last);
    }
    for (const scene::PrimitiveRef& p : frame.primitives)
        if (p && scene::isProcedural(*p)) ask(*p->attributes);
    return unset;
}

// Visibility bits of a shape.
uint32_t visibilityOf(const scene::Attributes& a, const UnsetVisibility& unset) {
    const auto on = [&](const char* name, bool otherwise) { return isVisible(a, name, otherwise); };
    // BMRT: 1 for camera rays, 2 for reflections, 4 for shadows. Separate visibility attributes take precedence.
    const scene::Param* old = a.value("render:visibility");
    const int of = old && !old->numbers.empty() ? int(std::clamp(double(old->numbers[0]), 0., 7.)) : -1;
    bool traced = on("trace", of < 0 ? unset.traced : (of & 2) != 0);
    uint32_t bits = 0;
    if (on("camera", of < 0 || (of & 1) != 0)) bits |= accel::kCamera;
    if (on("diffuse", traced)) bits |= accel::kDiffuse;
    if (on("specular", traced)) bits |= accel::kSpecular;
    const scene::Param* casts = a.value("render:casts_shadows"); // BMRT
    if (on("transmission", of < 0 ? unset.shadows : (of & 4) != 0) &&
        !(casts && !casts->strings.empty() && casts->strings[0] == "none"))
        bits |= accel::kTransmission;
    return bits;
}

/// Whether specular() uses RISpec's exponent: Option "shade" "specular" "rispec" (or "prman", the default), else by dialect.
bool rispecSpecular(const scene::Options& o, const std::string& dialect, Diagnostics& d) {
    const auto i = o.values.find("shade:specular");
    if (i == o.values.end()) return rsl::front::dialectRispecSpecular(dialect);
    const std::string value = i->second.strings.empty() ? "" : i->second.strings[0];
    if (value != "rispec" && value != "prman")
        d.report(Severity::Error, Rie::BadToken, i->second.place,
                 "Option \"shade\" \"specular\" cannot be \"" + value + "\"; it is \"prman\"",
                 "\"rispec\": exponent 1/roughness; \"prman\": 8/roughness");
    return value == "rispec" || rsl::front::dialectRispecSpecular(dialect);
}

} // namespace

void WorldImpl::numberShapes() {
    for (uint32_t i = 0; i < shapes_.size(); ++i) {
        numberOfShape_.emplace(shapes_[i].get(), i);
        const geometry::Placed* p = shapes_[i]->placed();
        if (!p) continue;
        moves_ |= p->moves();
        numberOfShape_.emplace(p->geometry().get(), i); // dicing looks up a binding by geometry
        if (p->deforming())
            for (const auto& key : p->deforming()->keys()) numberOfShape_.emplace(key.get(), i);
    }
    const auto waits = [](const scene::PrimitiveRef& p) { return p && scene::isProcedural(*p); };
    if (std::none_of(frame_->primitives.begin(), frame_->primitives.end(), waits)) return;
    std::map<std::string, uint32_t> within; // shapes of each part so far
    for (const geometry::ShapeRef& s : shapes_) {
        const std::string part = scene::partOf(s->attributes());
        uint64_t key = 0;
        for (const char c : part) key = render::mix64(key ^ uint64_t(uint8_t(c)));
        keysOfShapes_.push_back(part.empty() ? within[part]++ : uint32_t(render::mix64(key + within[part]++)));
    }
}

void WorldImpl::findProcedurals() {
    std::vector<DeferredBounds::Bound> bounds;
    const Matrix toCamera = scene::at(frame_->options.worldToCamera, scene::Shutter(frame_->options).open);
    for (const scene::PrimitiveRef& p : frame_->primitives) {
        if (!p || !scene::isProcedural(*p)) continue;
        DeferredBounds::Bound b;
        for (const Matrix& m : scene::overShutter(p->toWorld, scene::Shutter(frame_->options)).keys)
            for (int k = 0; k < 8; ++k) {
                const Vec3d corner(p->numbers[k & 1 ? 1 : 0], p->numbers[k & 2 ? 3 : 2], p->numbers[k & 4 ? 5 : 4]);
                b.box.add(Vec3(transformPoint(m * toCamera, corner)));
            }
        b.number = scene::deferredNumber(*p);
        procedurals_.add(b.box);
        if (scene::isDeferred(*p)) bounds.push_back(b);
    }
    if (!bounds.empty()) deferred_ = std::make_unique<DeferredBounds>(std::move(bounds));
}

/// Finds the samples that see a shape that fades between levels of detail.
static void findLevels(WorldImpl& w) {
    std::vector<accel::Accel::Levels> levels(w.shapes_.size());
    for (size_t i = 0; i < levels.size(); ++i)
        if (const auto& level = w.shapes_[i]->attributes().level) {
            levels[i] = {(*level)[0], (*level)[1]};
            w.fades_ = true;
        }
    if (w.fades_) w.accel_->setLevels(std::move(levels));
}

/// Texture settings of the frame.
static texture::TextureSettings mapSettings(const scene::Options& o, const Settings& settings, Diagnostics& d) {
    const scene::MapColours colours = scene::mapColours(o, settings.hider == Hider::Path, d);
    texture::TextureSettings t{.linearise = colours == scene::MapColours::Light,
                               .light = colours == scene::MapColours::Srgb,
                               .read = settings.read,
                               .reads = settings.reads};
    if (const auto i = o.values.find("texture:missing"); i != o.values.end() && i->second.numbers.size() >= 3)
        t.missing = Color(i->second.numbers[0], i->second.numbers[1], i->second.numbers[2]);
    if (const auto i = o.values.find("texture:maxanisotropy"); i != o.values.end() && !i->second.numbers.empty()) {
        if (const float most = i->second.numbers[0]; most >= 1) t.squeeze = 1 / (most * most);
        else
            d.report(Severity::Error, Rie::Range, i->second.place,
                     "Option \"texture\" \"maxanisotropy\" must be a number >= 1; it is ignored");
    }
    if (const auto i = o.values.find("limits:texturememory"); i != o.values.end() && !i->second.numbers.empty()) {
        const double kilobytes = double(i->second.numbers[0]);
        if (kilobytes >= 1 && kilobytes < 1e15) t.memory = size_t(kilobytes) * 1024;
        else
            d.report(Severity::Error, Rie::Range, i->second.place,
                     "Option \"limits\" \"texturememory\" must be a number of kB >= 1; the default is used");
    }
    return t;
}

std::vector<World::MapRead> WorldImpl::mapsRead() const {
    std::vector<MapRead> all;
    for (const auto& f : textures_->files()) all.push_back({f.path, f.bytes, f.memory, f.scratch});
    return all;
}

/// Tells emitters where rays hit their shapes.
static void takeDiced(WorldImpl& w, const std::vector<uint32_t>& visibility) {
    const auto seenThrough = [&](const geometry::Shape& s) { // light behind it is visible as well
        const size_t i = w.numberOfShape_.at(&s);
        const bool blocks = (visibility[i] & accel::kTransmission) && w.bindings_[size_t(w.bindingOf_[i])].opacity.opaque();
        return !blocks && !s.oneSided();
    };
    for (BoundLight& l : w.lights_)
        if (l.emitter) l.emitter->takeDiced(seenThrough);
}

void WorldImpl::begin(std::shared_ptr<const scene::Frame> frame, const Settings& settings, ServiceTable services,
                      Diagnostics& d) {
    frame_ = std::move(frame);
    sceneLights_ = frame_->lights.size();
    settings_ = settings;
    services_ = services;
    diagnostics_ = &d;
    setCamera(frame_->options);
    const MapFiles files{settings.texturePaths, settings.read};
    photons_ = std::make_shared<PhotonStore>(files, worldToCamera_, d);
    clouds_ = std::make_shared<CloudStore>(files, d);
    ptex_ = std::make_shared<PtexStore>(files, d);
}

std::shared_ptr<const WorldImpl> emptyWorld(const Settings& settings, ServiceTable services, Diagnostics& d) {
    auto w = std::make_shared<WorldImpl>();
    w->begin(std::make_shared<scene::Frame>(), settings, services, d);
    w->textures_ = std::make_unique<texture::TextureSystem>(d);
    w->accel_ = std::make_unique<accel::Accel>(w->shapes_, std::vector<uint32_t>(), d, true);
    w->built_ = true;
    return w;
}

std::shared_ptr<const World> World::build(const std::shared_ptr<const scene::Frame>& frame, const Settings& settings,
                                          std::span<const Service> services, MakeEvaluator evaluators, Diagnostics& d) {
    double begin = buildClock();
    auto w = std::make_shared<WorldImpl>();
    w->begin(frame, settings, services, d);
    for (const std::string& name : settings.outputs) w->wanted_.push_back(rsl::OutputName::parse(name));
    const scene::Options& o = frame->options;
    bool path = settings.hider == Hider::Path;
    w->maxDepth_ = path ? 32 : 4;
    if (auto i = o.values.find("trace:maxdepth"); i != o.values.end() && !i->second.numbers.empty())
        w->maxDepth_ = int(std::clamp(double(i->second.numbers[0]), -1.0, double(limits::kPathDepth)));
    if (settings.maxDepth >= 0) w->maxDepth_ = settings.maxDepth;
    w->maxDepth_ = std::min(w->maxDepth_, limits::kPathDepth);
    w->textures_ = std::make_unique<texture::TextureSystem>(d, mapSettings(o, settings, d));
    rsl::ShaderCompiler::Settings cs;
    cs.cacheDirectory = settings.cacheDirectory;
    cs.dialect = settings.dialect;
    cs.rispecSpecular = w->rispecSpecular_ = rispecSpecular(o, settings.dialect, d);
    cs.allowExec = settings.allowExec;
    cs.pluginPaths = settings.pluginPaths;
    cs.reads = settings.reads;
    w->compiler_ = std::make_shared<rsl::ShaderCompiler>(cs);
    if (const char* e = std::getenv("ALPENGLOW_SHADERS"))
        for (auto& folder : splitSearchPath(e)) w->settings_.shaderPaths.push_back(folder);
    if (std::string s = shippedShaders(); !s.empty()) {
        w->settings_.shaderPaths.push_back(s);
        w->settings_.shaderPaths.push_back(s + "/ris"); // materials, patterns and lights of RIS
    }
    w->shapes_ = geometry::buildShapes(*frame, d);
    w->numberShapes();
    w->shadesAtOpen_ = shadesAtOpen(*frame, settings, w->shapes_);
    for (const auto& shape : w->shapes_) w->traceSubsets_ |= shape->attributes().value("grouping:tracesubset") != nullptr;
    w->clippingPlanes_ = o.clippingPlanes;
    w->clipNear_ = o.clipNear;
    w->clipFar_ = o.clipFar;
    const UnsetVisibility unset = unsetVisibility(w->shapes_, *frame, path);
    w->findProcedurals();
    w->bindLights(d, [&](const geometry::Shape& s) { return visibilityOf(s.attributes(), unset); });
    w->findShining();
    w->evaluators_ = std::move(evaluators);
    const std::unique_ptr<Evaluator> evaluator = w->evaluators_(*w, d, settings.stop);
    if (path) w->tabulateSkies(*evaluator);
    const auto stopped = [&settings] { return settings.stop && *settings.stop; };
    if (!SurfaceBinder(*w, *evaluator, d).bindAll()) return nullptr;
    w->measureOutputs();
    if (stopped()) return nullptr;
    w->setPointNeeds();
    w->diceShapes(d); // displacement uses the same kernels as shading
    if (stopped()) return nullptr;
    std::vector<uint32_t> visibility;
    for (const auto& shape : w->shapes_) visibility.push_back(visibilityOf(shape->attributes(), unset));
    takeDiced(*w, visibility);
    w->bindPhotons(visibility);
    w->accel_ = std::make_unique<accel::Accel>(w->shapes_, visibility, d, !path);
    if (!w->accel_->sound()) return nullptr;
    w->accel_->makeSolids(d);
    findLevels(*w);
    w->sortByOpacity(visibility);
    w->findEye();
    w->bindSentStrings(d);
    w->countLightTraces();
    w->measureLights(*evaluator, d);
    w->placeLights(*evaluator);
    for (const auto& [shape, binding] : w->emittersInAtmosphere_) {
        w->lights_[size_t(shape->attributes().areaLight)].hazy = true;
        for (int part : w->lights_[size_t(shape->attributes().areaLight)].parts) w->lights_[size_t(part)].hazy = true;
    }
    w->makeChoosers(d);
    w->facts_.shapes = w->shapes_.size();
    for (const auto& shape : w->shapes_) w->facts_.before += !(shape->bounds().hi.z <= 0);
    w->bindImager(d);
    w->built_ = true;
    w->facts_.buildSec = buildClock() - begin - w->facts_.compileSec;
    return w;
}

} // namespace alpenglow::world
