// The thread of a view, and requests of viewers.
#include "view/session.h"
#include "render/outputnames.h"
#include "render/outputs.h"
#include "scene/scene.h"
#include "view/ribcopy.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::view {
namespace {

using Json = nlohmann::json;
constexpr size_t kMostMessages = 500;
constexpr size_t kMostShaders = 500;
constexpr auto kFilePatience = std::chrono::milliseconds(200);
/// A coarse picture that is begun is finished, so that one sees something while the mouse moves; but not for longer than this.
constexpr auto kCoarsePatience = std::chrono::milliseconds(180);

/// Keeps the frame that is to be looked at; frames of maps are rendered.
class Keeper final : public scene::FrameConsumer {
public:
    Keeper(render::Renderer& maps, std::optional<int> wanted) : maps_(maps), wanted_(wanted) {}
    std::shared_ptr<const scene::Frame> frame;
    std::vector<int> numbers;
    void render(std::shared_ptr<const scene::Frame> f) override {
        if (render::isMapPass(f->options)) return maps_.render(std::move(f));
        numbers.push_back(f->options.frameNumber);
        if (!frame && (!wanted_ || *wanted_ == f->options.frameNumber)) frame = std::move(f);
    }
    void makeTexture(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                     const SourcePlace& place) override {
        if (!frame) maps_.makeTexture(kind, files, args, place); // those behind it are of later frames
    }
    void passOver(const scene::Options& o) override { maps_.passOver(o); }
    void passOverTexture(const std::vector<std::string>& files) override { maps_.passOverTexture(files); }

private:
    render::Renderer& maps_;
    std::optional<int> wanted_;
};

Json placeJson(const SourcePlace& p) { return {{"file", p.file}, {"line", p.line}, {"column", p.column}}; }

const char* severityName(Severity s) {
    return s == Severity::Info ? "note" : s == Severity::Warning ? "warning" : s == Severity::Error ? "error" : "severe error";
}

double one(const Json& j, size_t i) { return j.is_array() && i < j.size() && j[i].is_number() ? j[i].get<double>() : NAN; }

Json failed(const std::string& why) { return {{"error", why}}; }

/// Default value of a float parameter in the result of `describe`.
std::optional<double> defaultOf(const Json& about, const std::string& name) {
    if (!about.is_object() || !about.contains("parameters")) return {};
    for (const Json& p : about["parameters"]) {
        if (!p.is_object() || p.value("name", "") != name || !p.contains("default")) continue;
        const Json& d = p["default"].is_array() && p["default"].size() == 1 ? p["default"][0] : p["default"];
        if (d.is_number()) return d.get<double>();
    }
    return {};
}

} // namespace

Session::Session(ViewOptions o, std::function<void()> changed) : options_(std::move(o)), changed_(std::move(changed)) {}

Session::~Session() {
    {
        std::lock_guard lock(mutex_);
        end_ = 1;
        stop_ = 1;
    }
    work_.notify_all();
    watchEnds_.notify_all();
    if (thread_.joinable()) thread_.join();
    if (watching_.joinable()) watching_.join();
}

bool Session::load() { return readScene(); }

void Session::start() {
    begun_ = true;
    thread_ = std::thread([this] { run(); });
    if (options_.watch) watching_ = std::thread([this] { watchFiles(); });
}

void Session::notifyViewers() {
    {
        std::lock_guard lock(mutex_);
        ++serial_;
    }
    changed_();
}

void Session::setPhase(Phase p) {
    {
        std::lock_guard lock(mutex_);
        if (phase_ == p) return;
        phase_ = p;
        phaseSince_ = Clock::now();
    }
    notifyViewers();
}

void Session::say(const Diagnostic& d) {
    if (options_.print) options_.print(d);
    {
        std::lock_guard lock(mutex_);
        const std::string key = toString(d);
        const auto [at, fresh] = messageAt_.try_emplace(key, messages_.size());
        if (!fresh) return;
        if (messages_.size() >= kMostMessages) {
            messageAt_.erase(at);
            ++messagesLost_;
            return;
        }
        messages_.push_back({d, 1});
    }
    notifyViewers();
}

/// Requires mutex_. Interrupts the current pass.
void Session::interrupt() {
    ++generation_;
    ++serial_;
    const bool coarse = phase_ == Phase::Coarse || phase_ == Phase::Building;
    if (!coarse || Clock::now() - phaseSince_ > kCoarsePatience) stop_ = 1;
    work_.notify_all();
}

bool Session::readScene() {
    setPhase(Phase::Reading);
    const std::shared_ptr<const Loaded> before = [&] {
        std::lock_guard lock(mutex_);
        reload_ = false;
        reads_ = std::make_shared<ReadLog>();
        messages_.clear();
        messageAt_.clear();
        messagesLost_ = 0;
        ++sceneSerial_;
        return scene_;
    }();
    // It refers to the diagnostics, so it is dropped first.
    world_.reset();
    means_.reset();
    kept_ = {};
    crop_.reset();
    worldKey_.clear();
    filmKey_.clear();
    diags_ = std::make_unique<Diagnostics>([this](const Diagnostic& d) { say(d); });
    // Before the thread exists, the caller's stop flag applies.
    const StopFlag* const stop = begun_ || !options_.settings.stop ? &end_ : options_.settings.stop;
    render::RenderSettings s = options_.settings;
    s.stop = stop;
    s.reads = reads_;
    render::Progress progress(render::ProgressMode::None);
    render::Renderer maps(s, render::transportEngine(), *diags_, progress);
    maps.setScene(options_.scene);
    Keeper keeper(maps, options_.frame);
    ri::ReaderOptions o = options_.reader;
    o.reads = reads_;
    o.stop = stop;
    if (options_.frame) o.frames = {*options_.frame};
    o.overrides = [&](scene::Options& of) {
        if (render::isMapPass(of)) maps.override(of);
    };
    ri::RibReader reader(o, keeper, *diags_);
    options_.read(reader);
    if (*stop) return false;
    if (!keeper.frame) {
        diags_->report(Severity::Error, Rie::MissingData, {options_.scene},
                       options_.frame ? "the scene has no frame " + std::to_string(*options_.frame)
                                      : "there is no picture in the scene");
        return false;
    }
    auto loaded = std::make_shared<Loaded>();
    loaded->frame = keeper.frame;
    loaded->shaders = shadersOf(*keeper.frame, kMostShaders);
    for (const scene::Light& l : keeper.frame->lights)
        if (loaded->lights.size() < kMostLights && l.handle.find('\'') == l.handle.npos && !l.handle.empty() &&
            std::find(loaded->lights.begin(), loaded->lights.end(), l.handle) == loaded->lights.end())
            loaded->lights.push_back(l.handle);
    std::sort(keeper.numbers.begin(), keeper.numbers.end());
    loaded->frames = keeper.numbers;
    std::lock_guard lock(mutex_);
    Pose pose(keeper.frame->options);
    if (pose_) pose.keepFrom(*pose_);
    pose_ = pose;
    if (before) // unchanged shaders keep their settings
        std::erase_if(wishes_.parameters, [&](const auto& p) {
            return p.first >= loaded->shaders.size() || p.first >= before->shaders.size() ||
                   loaded->shaders[p.first].call->name != before->shaders[p.first].call->name;
        });
    scene_ = std::move(loaded);
    descriptions_.clear();
    ++generation_;
    return true;
}

void Session::run() {
    while (true) try {
            if (!waitForWork()) return;
            bool reload;
            {
                std::lock_guard lock(mutex_);
                reload = reload_;
                stop_ = end_ ? 1 : 0;
            }
            bool there = true;
            if (reload) there = readScene();
            if (there && !end_) {
                render();
                if (!end_) lookAtRest(); // overdue shots
            } else {
                std::lock_guard lock(mutex_);
                done_ = generation_;
            }
            setPhase(Phase::Idle);
            notifyViewers(); // that all is done
        } catch (const std::bad_alloc&) { giveUp("out of memory"); } catch (const std::exception& e) {
            giveUp(e.what());
        }
}

/// Ends the current work after a failure; the next request may succeed.
void Session::giveUp(const std::string& why) {
    plan_ = nullptr;
    kept_ = {};
    crop_.reset();
    world_.reset();
    worldKey_.clear();
    filmKey_.clear();
    stale_ = false;
    shotPlanes_ = wantedPlanes();
    {
        std::lock_guard lock(mutex_);
        done_ = generation_;
        reload_ = false;
    }
    say({Severity::Severe, Rie::NoMem, {options_.scene}, "the picture is given up: " + why, {}, {}});
    setPhase(Phase::Idle);
    notifyViewers();
}

/// On a separate thread, because a pass may take minutes.
void Session::watchFiles() {
    std::unique_lock lock(mutex_);
    while (!end_) {
        watchEnds_.wait_for(lock, kFilePatience);
        const std::shared_ptr<ReadLog> reads = reads_;
        if (end_ || reload_ || !reads) continue;
        lock.unlock();
        const bool changed = reads->changed();
        if (changed) std::this_thread::sleep_for(std::chrono::milliseconds(50)); // let the editor finish
        lock.lock();
        if (!changed || reads != reads_) continue; // it was read again meanwhile
        reload_ = true;
        interrupt();
        stop_ = 1;
    }
}

/// Waits until there is something to render. Returns false at the end.
bool Session::waitForWork() {
    while (true) {
        if (!end_) lookAtRest();
        std::unique_lock lock(mutex_);
        if (end_) return false;
        if (reload_ || (generation_ != done_ && scene_)) return true;
        work_.wait_for(lock, kFilePatience);
    }
}

uint64_t Session::serial() const {
    std::lock_guard lock(mutex_);
    return serial_;
}

Session::Shot Session::look(const std::string& plane) {
    std::lock_guard lock(mutex_);
    auto& last = viewers_[plane];
    const bool fresh = last == Clock::time_point{} || Clock::now() - last > std::chrono::seconds(3);
    last = Clock::now();
    if (viewers_.size() > 100) std::erase_if(viewers_, [&](const auto& v) { return v.second < last; });
    if (fresh) work_.notify_all();
    return {picture_, serial_, wishes_.dim};
}

Json Session::moveCamera(const Json& j) {
    if (!pose_) return failed("there is no camera yet");
    if (j.value("drag", false) && !dragging_) {
        dragging_ = true;
        const Plane* p = picture_ ? picture_->plane("picture") : nullptr;
        if (p && p->image->channels.size() >= 5 && p->image->width > 0) {
            const display::Image& image = *p->image;
            pose_->setDistance(double(image.pixel(image.width / 2, image.height / 2)[4]));
        }
    }
    if (j.value("reset", false) && scene_) pose_ = Pose(scene_->frame->options);
    const Json none = Json::array();
    const auto part = [&](const char* name) -> const Json& {
        const auto i = j.find(name);
        return i == j.end() ? none : *i;
    };
    const auto sane = [](double d) { return std::isfinite(d) && std::fabs(d) < 1e4; };
    if (const double x = one(part("orbit"), 0), y = one(part("orbit"), 1); sane(x) && sane(y)) pose_->orbit(x, y);
    if (const double x = one(part("pan"), 0), y = one(part("pan"), 1); sane(x) && sane(y)) pose_->pan(x, y);
    if (part("dolly").is_number()) pose_->dolly(part("dolly").get<double>());
    if (j.value("settle", false)) dragging_ = false;
    interrupt();
    return {{"ok", true}};
}

Json Session::askSave(const Json& j) {
    Save s;
    s.type = j.value("type", "png");
    if (s.type != "png" && s.type != "exr") return failed("pictures can be saved as png or exr");
    s.gain = j.value("gain", 1.f);
    s.gamma = j.value("gamma", 1.f);
    s.srgb = j.value("srgb", false);
    if (!(s.gain > 0 && s.gain < 1e9f && s.gamma >= 0.01f && s.gamma <= 100))
        return failed("gain and gamma must be positive numbers");
    if (saves_.size() > 20) return failed("pictures are still being saved");
    saves_.push_back(s);
    work_.notify_all();
    return {{"ok", true}};
}

Json Session::act(const Json& j) try {
    if (!j.is_object()) return failed("this is no request");
    const std::string what = j.value("do", "");
    Json answer{{"ok", true}};
    {
        std::lock_guard lock(mutex_);
        if (what == "set") {
            const Json wishes = j.value("wishes", Json::object());
            if (!wishes.is_object()) return failed("\"wishes\" must be an object");
            if (const std::string fault = wishes_.take(wishes); !fault.empty()) return failed(fault);
            if (wishes.size() == 1 && wishes.contains("dim")) ++serial_; // needs no rendering
            else interrupt();
        } else if (what == "camera") answer = moveCamera(j);
        else if (what == "save") answer = askSave(j);
        else if (what == "parameter") {
            if (!scene_) return failed("there is no scene yet");
            if (const std::string fault = takeParameter(j, scene_->shaders, wishes_.parameters); !fault.empty())
                return failed(fault);
            interrupt();
        } else if (what == "reload") {
            reload_ = true;
            interrupt();
        } else return failed("unknown action \"" + what + "\"");
    }
    changed_();
    return answer;
} catch (const Json::exception&) { return failed("a value is not of its type"); }

Json Session::state(size_t messages, size_t points) const {
    std::lock_guard lock(mutex_);
    static constexpr const char* kPhases[] = {"reading", "building", "coarse", "crop", "whole", "idle"};
    Json j{{"serial", serial_},        {"generation", generation_}, {"scene", sceneSerial_},   {"phase", kPhases[size_t(phase_)]},
           {"wishes", wishes_.json()}, {"file", options_.scene},    {"watch", options_.watch}, {"saved", saved_},
           {"width", width_},          {"height", height_},         {"lost", messagesLost_}};
    j["done"] = phase_ == Phase::Idle && done_ == generation_ && !reload_ && saves_.empty();
    j["moved"] = pose_ && pose_->moved();
    j["curve"] = {{"gain", curveAtFirst_[0]}, {"gamma", curveAtFirst_[1]}, {"srgb", curveAtFirst_[2] != 0}};
    if (picture_) {
        const Figures& f = picture_->figures;
        j["figures"] = {{"seconds", f.seconds},
                        {"spp", f.spp},
                        {"raysPerMS", f.raysPerMS},
                        {"noiseRSE", f.noiseRSE},
                        {"noiseRSE999", f.noiseRSE999},
                        {"efficiency", f.efficiency},
                        {"noise", f.noise},
                        {"noiseAtMost", f.noiseAtMost}};
    }
    Json& list = j["messages"] = Json::array();
    for (size_t i = messages; i < messages_.size(); ++i) {
        const Diagnostic& d = messages_[i].diagnostic;
        list.push_back({{"severity", severityName(d.severity)},
                        {"text", d.message},
                        {"hint", d.hint},
                        {"line", d.sourceLine},
                        {"place", placeJson(d.place)},
                        {"notes", d.notes}});
    }
    j["messageCount"] = messages_.size();
    j["curveOf"] = curveOf_;
    Json& curve = j["points"] = Json::array();
    for (size_t i = points; i < curve_.size(); ++i) curve.push_back(curve_[i]);
    j["pointCount"] = curve_.size();
    return j;
}

Json Session::scene() {
    std::shared_ptr<const Loaded> s;
    Json j = Json::object();
    std::vector<std::string> folders;
    ParameterChanges changes;
    std::map<std::string, double> dim;
    std::optional<Pose> pose;
    {
        std::lock_guard lock(mutex_);
        s = scene_;
        folders = shaderFolders_;
        changes = wishes_.parameters;
        if (wishes_.lights) dim = wishes_.dim;
        pose = pose_;
        j["outputs"] = outputs_;
        j["scene"] = sceneSerial_;
    }
    j["computed"] = render::computedOutputs();
    if (s) // declared by the scene
        for (const auto& [name, declaration] : s->frame->options.displayChannels) j["outputs"].push_back(name);
    j["lights"] = s ? Json(s->lights) : Json::array();
    j["frames"] = s ? Json(s->frames) : Json::array();
    if (s && pose) {
        scene::Options o = s->frame->options;
        pose->apply(o);
        j["cameraRib"] = ribOfCamera(o);
    }
    std::string lights;
    Json& shaders = j["shaders"] = Json::array();
    for (size_t i = 0; s && i < s->shaders.size(); ++i) {
        const ShaderUse& u = s->shaders[i];
        Json values = Json::object();
        const auto put = [&](const scene::ParamList& list) {
            for (const scene::Param& p : list) values[p.name] = p.strings.empty() ? Json(p.numbers) : Json(p.strings);
        };
        put(u.call->params);
        const auto c = changes.find(i);
        const scene::ParamList tuned = c == changes.end() ? scene::ParamList() : c->second;
        put(tuned);
        Json about;
        if (options_.describe && !folders.empty()) {
            std::unique_lock lock(mutex_);
            const auto known = descriptions_.find(u.call->name);
            if (known != descriptions_.end()) about = known->second;
            else {
                lock.unlock();
                about = options_.describe(u.call->name, folders);
                lock.lock();
                descriptions_[u.call->name] = about;
            }
        }
        shaders.push_back({{"role", u.role},
                           {"name", u.call->name},
                           {"place", placeJson(u.call->place)},
                           {"primitives", u.primitives},
                           {"handle", u.handle},
                           {"rib", ribOfShader(u, tuned)},
                           {"values", values},
                           {"about", about}});
        if (const auto d = dim.find(u.handle); u.role == "light" && d != dim.end() && d->second != 1)
            lights += ribOfDimmedLight(u, tuned, d->second, defaultOf(about, "intensity"));
    }
    j["lightsRib"] = lights;
    return j;
}

} // namespace alpenglow::view
