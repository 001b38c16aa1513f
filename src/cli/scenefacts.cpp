#include "cli/scenefacts.h"
#include "ri/reader.h"
#include "scene/deferred.h"
#include "scene/scene.h"
#include <algorithm>
#include <cctype>
#include <map>

namespace alpenglow::cli {

using Facts = nlohmann::ordered_json;

namespace {

using Counts = std::map<std::string, size_t>;

constexpr const char* kSceneEnds[] = {".rib", ".ribz", ".rib.gz", ".arc", ".archive", ".rlf"};

Facts countsJson(const Counts& counts) {
    Facts f = Facts::object();
    for (const auto& [name, n] : counts) f[name] = n;
    return f;
}

/// The shaders that primitives have, each set of attributes once.
void countShaders(const scene::AttributesRef& a, Counts& shaders) {
    if (!a) return;
    for (const scene::ShaderRef& s : {a->surface, a->displacement, a->atmosphere, a->interior, a->exterior})
        if (s) ++shaders[s->name];
    for (const auto& [handle, s] : a->coshaders)
        if (s) ++shaders[s->name];
}

Facts frameFacts(const scene::Frame& f) {
    const scene::Options& o = f.options;
    Counts primitives, shaders, lights;
    size_t moving = 0, inObjects = 0;
    const auto count = [&](const scene::PrimitiveRef& p) {
        if (!p) return;
        ++primitives[scene::isProcedural(*p) ? "Procedural" : p->kind];
        moving += p->toWorld.moves() || !p->motionKeys.empty();
        countShaders(p->attributes, shaders);
    };
    for (const scene::PrimitiveRef& p : f.primitives) count(p);
    for (const scene::Object& object : f.objects) {
        inObjects += object.primitives.size();
        for (const scene::PrimitiveRef& p : object.primitives) count(p);
    }
    for (const scene::Light& l : f.lights)
        if (l.shader) ++lights[l.shader->name];
    Facts j;
    if (o.inFrame) j["number"] = o.frameNumber;
    j["size"] = {o.xres, o.yres};
    j["hider"] = o.hider;
    j["projection"] = o.projection;
    Facts displays = Facts::array();
    for (const scene::Display& d : o.displays) displays.push_back(d.name + " " + d.type + " " + d.mode);
    j["displays"] = std::move(displays);
    j["primitives"] = countsJson(primitives);
    if (!f.objects.empty())
        j["objects"] = {{"count", f.objects.size()}, {"primitives", inObjects}, {"instances", f.instances.size()}};
    if (moving) j["moving"] = moving;
    j["lights"] = countsJson(lights);
    j["shaders"] = countsJson(shaders);
    return j;
}

/// Counts what each frame holds, then drops the frame.
struct FrameCounter final : scene::FrameConsumer {
    Facts frames = Facts::array(), made = Facts::array();
    void render(std::shared_ptr<const scene::Frame> f) override { frames.push_back(frameFacts(*f)); }
    void makeTexture(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList&,
                     const SourcePlace&) override {
        Facts names = Facts::array();
        for (const std::string& file : files) names.push_back(file);
        made.push_back({{"kind", kind}, {"names", std::move(names)}});
    }
};

} // namespace

bool namedAsScene(const std::string& file) {
    std::string lower = file;
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return std::any_of(std::begin(kSceneEnds), std::end(kSceneEnds), [&](const char* end) { return lower.ends_with(end); });
}

bool addScene(Facts& facts, const std::string& file, Diagnostics& d) {
    FrameCounter teller;
    ri::ReaderOptions options;
    options.allowRead = false;
    options.defers = true;
    if (!ri::RibReader(options, teller, d).readFile(file) && teller.frames.empty() && teller.made.empty()) return false;
    facts["kind"] = "scene";
    if (!teller.made.empty()) facts["map"] = std::move(teller.made);
    facts["frame"] = std::move(teller.frames);
    return true;
}

} // namespace alpenglow::cli
