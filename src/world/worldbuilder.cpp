// Builds a world from the description of a frame.
#include "base/file.h"
#include "base/installation.h"
#include "geometry/build.h"
#include "rsl/front/headers.h"
#include "scene/deferred.h"
#include "scene/numbers.h"
#include "scene/scene.h"
#include "world/surfaces.h"
#include <chrono>
#include <cstdlib>

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

/// Sets the range of samples that see each shape that fades between levels of detail.
void findLevels(MutableWorld& w) {
    std::vector<accel::Accel::Levels> levels(w.shapes_.size());
    for (size_t i = 0; i < levels.size(); ++i)
        if (const auto& level = w.shapes_[i]->attributes().level) {
            levels[i] = {(*level)[0], (*level)[1]};
            w.fades_ = true;
        }
    if (w.fades_) w.accel_->setLevels(std::move(levels));
}

/// Texture settings of the frame.
texture::TextureSettings mapSettings(const scene::Options& o, const Settings& settings, Diagnostics& d) {
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

/// Gives area lights the meshes that rays hit.
void takeDiced(MutableWorld& w, const std::vector<uint32_t>& visibility) {
    const auto seenThrough = [&](const geometry::Shape& s) { // light behind the surface is visible, too
        const size_t i = w.numberOfShape_.at(&s);
        const bool blocks = (visibility[i] & accel::kTransmission) && w.bindings_[size_t(w.bindingOf_[i])].opacity.opaque();
        return !blocks && !s.oneSided();
    };
    for (BoundLight& l : w.lights_)
        if (l.emitter) l.emitter->takeDiced(seenThrough);
}

/// Builds one world. Each step needs what the steps before it have set; after run() the world never changes.
class WorldBuilder {
public:
    /// All arguments must outlive the builder.
    WorldBuilder(const std::shared_ptr<const scene::Frame>& frame, const Settings& settings, Diagnostics& d)
        : frame_(*frame), settings_(settings), d_(d), path_(settings.hider == Hider::Path), begin_(buildClock()),
          world_(std::make_shared<MutableWorld>()), w_(*world_) {}

    /// Null after an error that prevents rendering (reported), or when Settings::stop is set.
    std::shared_ptr<const World> run(const std::shared_ptr<const scene::Frame>& frame, std::span<const Service> services,
                                     MakeEvaluator evaluators) {
        w_.begin(frame, settings_, services, d_);
        readOptions();
        startCompiler();
        makeShapes();
        bindLights();
        w_.evaluators_ = std::move(evaluators);
        evaluator_ = w_.evaluators_(w_, d_, settings_.stop, true);
        if (path_) w_.tabulateSkies(*evaluator_);
        if (!SurfaceBinder(w_, *evaluator_, d_).bindAll()) return nullptr;
        w_.measureOutputs();
        if (stopped()) return nullptr;
        w_.setPointNeeds();
        w_.diceShapes(d_); // displacement uses the same kernels as shading
        if (stopped()) return nullptr;
        if (!makeTree()) return nullptr;
        measure();
        w_.bindImager(d_);
        w_.facts_.buildSec = buildClock() - begin_ - w_.facts_.compileSec;
        return world_;
    }

private:
    bool stopped() const { return settings_.stop && *settings_.stop; }

    /// Limits, clipping, outputs and map settings from the options of the frame.
    void readOptions() {
        const scene::Options& o = frame_.options;
        for (const std::string& name : settings_.outputs) w_.wanted_.push_back(rsl::OutputName::parse(name));
        w_.maxDepth_ = path_ ? 32 : 4;
        if (auto i = o.values.find("trace:maxdepth"); i != o.values.end() && !i->second.numbers.empty())
            w_.maxDepth_ = int(std::clamp(double(i->second.numbers[0]), -1.0, double(limits::kPathDepth)));
        if (settings_.maxDepth >= 0) w_.maxDepth_ = settings_.maxDepth;
        w_.maxDepth_ = std::min(w_.maxDepth_, limits::kPathDepth);
        w_.textures_ = std::make_unique<texture::TextureSystem>(d_, mapSettings(o, settings_, d_));
        w_.clippingPlanes_ = o.clippingPlanes;
        w_.clipNear_ = o.clipNear;
        w_.clipFar_ = o.clipFar;
    }

    /// The compiler, and the folders in which it finds shaders: the scene's, the environment's, those of the installation.
    void startCompiler() {
        rsl::ShaderCompiler::Settings cs;
        cs.cacheDirectory = settings_.cacheDirectory;
        cs.dialect = settings_.dialect;
        cs.rispecSpecular = w_.rispecSpecular_ = rispecSpecular(frame_.options, settings_.dialect, d_);
        cs.allowExec = settings_.allowExec;
        cs.pluginPaths = settings_.pluginPaths;
        cs.reads = settings_.reads;
        w_.compiler_ = std::make_shared<rsl::ShaderCompiler>(cs);
        if (const char* e = std::getenv("ALPENGLOW_SHADERS"))
            for (auto& folder : splitSearchPath(e)) w_.settings_.shaderPaths.push_back(folder);
        if (std::string s = shippedShaders(); !s.empty()) {
            w_.settings_.shaderPaths.push_back(s);
            w_.settings_.shaderPaths.push_back(s + "/ris"); // materials, patterns and lights of RIS
        }
    }

    /// Shapes as the scene describes them, and bounds of procedurals.
    void makeShapes() {
        w_.shapes_ = geometry::buildShapes(frame_, d_);
        w_.numberShapes();
        w_.shadesAtOpen_ = shadesAtOpen(frame_, settings_, w_.shapes_);
        for (const auto& shape : w_.shapes_) w_.traceSubsets_ |= shape->attributes().value("grouping:tracesubset") != nullptr;
        unset_ = unsetVisibility(w_.shapes_, frame_, path_);
        w_.findProcedurals();
    }

    void bindLights() {
        w_.bindLights(d_, [&](const geometry::Shape& s) { return visibilityOf(s.attributes(), unset_); });
        w_.findShining();
    }

    /// The acceleration structure over diced shapes. False (reported): it cannot be built.
    bool makeTree() {
        std::vector<uint32_t> visibility;
        for (const auto& shape : w_.shapes_) visibility.push_back(visibilityOf(shape->attributes(), unset_));
        takeDiced(w_, visibility);
        w_.bindPhotons(visibility);
        w_.accel_ = std::make_unique<accel::Accel>(w_.shapes_, visibility, d_, !path_);
        if (!w_.accel_->sound()) return false;
        w_.accel_->makeSolids(d_);
        findLevels(w_);
        w_.sortByOpacity(visibility);
        w_.findShadowVisibility(visibility);
        w_.findEye();
        return true;
    }

    /// Brightness and places of lights, which kernels compute, and the tables from which lights are chosen.
    void measure() {
        w_.bindSentStrings(d_);
        w_.countLightTraces();
        w_.measureLights(*evaluator_, d_);
        w_.placeLights(*evaluator_);
        for (const auto& [shape, binding] : w_.emittersInAtmosphere_) {
            BoundLight& light = w_.lights_[size_t(shape->attributes().areaLight)];
            light.inAtmosphere = true;
            for (int part : light.parts) w_.lights_[size_t(part)].inAtmosphere = true;
        }
        w_.makeChoosers(d_);
        w_.facts_.shapes = w_.shapes_.size();
        for (const auto& shape : w_.shapes_) w_.facts_.before += !(shape->bounds().hi.z <= 0);
    }

    const scene::Frame& frame_;
    const Settings& settings_;
    Diagnostics& d_;
    const bool path_;    ///< the hider is path
    const double begin_; ///< of buildClock(), in seconds
    std::shared_ptr<MutableWorld> world_;
    MutableWorld& w_;
    std::unique_ptr<Evaluator> evaluator_; ///< runs kernels of the world that is being built
    UnsetVisibility unset_;
};

} // namespace

std::shared_ptr<const World> World::build(const std::shared_ptr<const scene::Frame>& frame, const Settings& settings,
                                          std::span<const Service> services, MakeEvaluator evaluators, Diagnostics& d) {
    return WorldBuilder(frame, settings, d).run(frame, services, std::move(evaluators));
}

} // namespace alpenglow::world
