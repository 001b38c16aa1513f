// Order of rendering in a view: coarse first, then the crop, then the complete picture.
#include "base/limits.h"
#include "render/camera.h"
#include "render/levels.h"
#include "scene/anycamera.h"
#include "scene/scene.h"
#include "view/session.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::view {
namespace {

constexpr double kCoarseSeconds = 0.06; ///< time for a coarse picture
constexpr double kCoarsePixels = 6000;  ///< its size in pixels while timing is unknown
constexpr uint32_t kCropSamples = 256;  ///< limit of the crop's samples before the complete picture, if that has none

std::string keyOf(const Pose& p) {
    char text[64];
    std::string key;
    for (const auto& row : p.view().m)
        for (double d : row) {
            std::snprintf(text, sizeof text, "%.17g ", d);
            key += text;
        }
    std::snprintf(text, sizeof text, "%.17g", p.zoom());
    return key + text;
}

bool samePlace(const Pose& a, const Pose& b) { return a.view() == b.view() && a.zoom() == b.zoom(); }

} // namespace

bool Session::isPath() const { return round_.frame && round_.frame->options.hider == "path"; }

uint32_t Session::wanted() const { return round_.wishes.continuous ? limits::kSamplesPerPixel : round_.wishes.spp; }

/// Something else is wanted by now.
bool Session::overtaken() const {
    std::lock_guard lock(mutex_);
    return generation_ != round_.generation;
}

/// Adds the picture, and requested outputs, as displays that are not written.
void Session::addOutputs(scene::Options& o) const {
    o.displays.clear();
    const auto add = [&](const std::string& name, const std::string& mode) {
        scene::Display d;
        d.name = name;
        d.type = "openexr";
        d.mode = mode;
        o.displays.push_back(std::move(d));
    };
    add("picture", "rgbaz");
    // Light by its path, under a name of ours.
    const auto addPath = [&](const std::string& name, const std::string& expression) {
        const std::string channel = "alpenglow_path" + std::to_string(o.displays.size());
        scene::Param declaration, source;
        declaration.name = channel;
        declaration.cls = scene::Class::Varying;
        declaration.type = scene::Type::Color;
        source.name = "source";
        source.type = scene::Type::String;
        source.strings = {"color " + expression};
        o.displayChannels[channel] = declaration;
        o.displayChannelParams[channel] = {source};
        add(name, channel);
    };
    for (const std::string& c : round_.wishes.channels) {
        if (c.starts_with("lpe:")) addPath(c, c);
        else add(c, c);
    }
    if (!round_.wishes.lights || o.hider != "path") return;
    for (const std::string& handle : round_.scene->lights) addPath("light:" + handle, "lpe:C.*<L.'" + handle + "'>");
}

/// The frame as this round has it, at its full resolution.
std::shared_ptr<const scene::Frame> Session::frameFor() const {
    auto frame = std::make_shared<scene::Frame>(*changed(round_.scene->frame, round_.scene->shaders, round_.wishes.parameters));
    render::RenderSettings s = options_.settings;
    if (!round_.wishes.hider.empty()) s.hider = round_.wishes.hider;
    s.resolutionFactor *= round_.wishes.factor;
    Diagnostics quiet;
    render::Progress progress(render::ProgressMode::None);
    render::Renderer(s, {}, quiet, progress).override(frame->options);
    scene::Options& o = frame->options;
    if (o.hider == "photon" || (o.hider != "path" && o.hider != "raytrace")) o.hider = o.hider == "photon" ? "path" : "hidden";
    round_.pose->apply(o);
    addOutputs(o);
    return frame;
}

render::Engine Session::engine() {
    const render::Engine own = render::transportEngine();
    render::Engine e;
    e.build = [this, own](const std::shared_ptr<const scene::Frame>&, const world::Settings& settings, Diagnostics& diags) {
        const bool there = world_ && worldKey_ == round_.worldKey;
        if (there && (round_.dragging || samePlace(*worldPose_, *round_.pose))) return world_;
        setPhase(Phase::Building);
        world_.reset();
        // For the complete picture, whatever the resolution of this pass, because it is kept.
        auto frame =
            std::make_shared<scene::Frame>(*render::drawnLevels(round_.frame, render::Camera(round_.frame->options, diags)));
        frame->options.values[scene::kAnyCamera] = {}; // while it is turned, rays go through this world from elsewhere
        world_ = own.build(std::move(frame), settings, diags);
        worldKey_ = round_.worldKey;
        worldPose_ = round_.pose;
        if (world_) {
            std::lock_guard lock(mutex_);
            outputs_ = world_->knownOutputs();
            shaderFolders_ = settings.shaderPaths;
            ++sceneSerial_;
        }
        setPhase(pass_.phase);
        return world_;
    };
    e.tracer = [this, own](const std::shared_ptr<const world::World>& world, Diagnostics& diags) {
        auto tracer = own.tracer(world, diags);
        if (samePlace(*worldPose_, *round_.pose)) return tracer;
        return turned(std::move(tracer), round_.pose->to(*worldPose_));
    };
    return e;
}

/// The remaining passes of this round, in order.
std::vector<Session::Pass> Session::passes() const {
    std::vector<Pass> all;
    int width, height;
    render::imageSize(round_.frame->options, &width, &height);
    const double pixels = double(width) * height;
    const double few = sampleSeconds_ > 0 ? std::clamp(kCoarseSeconds / sampleSeconds_, 1000.0, 60000.0) : kCoarsePixels;
    const bool fresh = !kept_.film && !kept_.image;
    if (fresh && pixels > 1.5 * few) all.push_back({Phase::Coarse, std::sqrt(few / pixels), 1, {}});
    if (round_.wishes.paused) return all;
    const bool path = isPath();
    const uint32_t have = kept_.film ? kept_.film->samplesPerPixel() : 0;
    const uint32_t first = path ? std::min(wanted(), kCropSamples) : round_.wishes.continuous ? 0 : round_.wishes.spp;
    const bool cropped = crop_ && cropOf_ == round_.wishes.crop && crop_->figures.spp >= first;
    if (round_.wishes.crop && !cropped && (path ? have < first : !kept_.image))
        all.push_back({Phase::Crop, 1, first, round_.wishes.crop});
    if (path && have < wanted()) all.push_back({Phase::Whole, 1, wanted(), {}});
    if (!path && !kept_.image) {
        if (fresh) all.push_back({Phase::Coarse, 1, 1, {}});
        all.push_back({Phase::Whole, 1, round_.wishes.continuous ? 0 : round_.wishes.spp, {}});
    }
    return all;
}

void Session::render() {
    {
        std::lock_guard lock(mutex_);
        round_ = {};
        round_.wishes = wishes_;
        round_.pose = pose_;
        round_.dragging = dragging_;
        round_.generation = generation_;
        round_.scene = scene_;
    }
    round_.frame = frameFor();
    round_.worldKey = round_.wishes.worldKey();
    const bool turns = round_.dragging && world_ && worldKey_ == round_.worldKey && !samePlace(*worldPose_, *round_.pose);
    std::string filmKey = round_.worldKey + keyOf(*round_.pose) + (turns ? " turned" : "") +
                          (isPath() || round_.wishes.continuous ? "" : std::to_string(round_.wishes.spp));
    if (filmKey != filmKey_ || (kept_.film && kept_.film->samplesPerPixel() > wanted())) {
        kept_ = {};
        crop_.reset();
        shownOf_.reset();
        std::lock_guard lock(mutex_);
        curve_.clear();
        ++curveOf_;
        render::imageSize(round_.frame->options, &width_, &height_);
    }
    filmKey_ = std::move(filmKey);
    for (const Pass& p : passes()) {
        if (overtaken()) return;
        if (!renderPass(p)) {
            if (stop_) return;
            break;
        }
    }
    std::lock_guard lock(mutex_);
    done_ = round_.generation;
}

/// Returns false if interrupted, or if there is nothing to see.
bool Session::renderPass(const Pass& p) {
    pass_ = p;
    passSeconds_ = passRays_ = 0;
    setPhase(p.phase);
    auto frame = round_.frame;
    if (p.factor != 1 || p.crop) {
        auto other = std::make_shared<scene::Frame>(*frame);
        scene::Options& o = other->options;
        if (p.factor != 1) {
            int width, height;
            render::imageSize(o, &width, &height);
            o.xres = std::max(1, int(std::lround(width * p.factor)));
            o.yres = std::max(1, int(std::lround(height * p.factor)));
            o.frameAspect.reset();
            o.pixelAspect *= float(double(width) * o.yres / (double(height) * o.xres)); // the same part of the scene
        }
        if (p.crop)
            for (size_t i = 0; i < 4; ++i) o.crop[i] = float((*p.crop)[i]);
        frame = std::move(other);
    }
    render::RenderSettings s = options_.settings;
    s.watcher = this;
    s.stop = &stop_;
    s.reads = reads_;
    s.spp = p.spp;
    s.maxDepth = round_.wishes.depth;
    s.direct = round_.wishes.direct;
    s.indirect = round_.wishes.indirect;
    s.sampleClamp = float(round_.wishes.clamp);
    s.progress = render::ProgressMode::None;
    render::Progress progress(render::ProgressMode::None);
    render::Renderer renderer(s, engine(), *diags_, progress);
    renderer.setScene(options_.scene);
    renderer.render(std::move(frame));
    plan_ = nullptr;
    return renderer.outcome().rendered > 0 && !stop_;
}

} // namespace alpenglow::view
