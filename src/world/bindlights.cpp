// Binds the lights of a frame to kernels. A shader with several illuminate or solar statements makes several lights: the first
// keeps the frame's index, the others are its parts, numbered after all lights of the frame.
#include "scene/filterlink.h"
#include "scene/scene.h"
#include "world/lightobjects.h"
#include "world/mutableworld.h"
#include "world/outputs.h"

namespace alpenglow::world {

using rsl::OutputName;

namespace {

// Number of directions from which a light's kernel is evaluated to estimate its brightness, for the power-over-distance bound.
constexpr int kProbes = 26;

std::vector<std::string> outputsOf(const rsl::ir::KernelFacts& f, const std::vector<std::string>& extra) {
    std::vector<std::string> names;
    for (size_t k = 0; k < f.blocks.size(); ++k) {
        const auto add = [&](const char* name) { names.push_back(OutputName::ofBlock(name, int(k)).text()); };
        if (f.blocks[k] == rsl::kBlockOutside) add("Cl");
        else
            for (const char* n : {"L", "Cl", "Ol", "lit"}) add(n);
    }
    if (f.blocks.empty()) names = {"Cl", "Ol"};
    names.insert(names.end(), extra.begin(), extra.end());
    return names;
}

float numberOf(const scene::AttributesRef& a, const char* key, float fallback) {
    const scene::Param* p = a ? a->value(key) : nullptr;
    return p && !p->numbers.empty() ? p->numbers[0] : fallback;
}

/// Whether an area light returns the mean of Cl over samples of its geometry, as in BMRT and 3Delight, instead of radiance.
bool givesMean(const scene::Light& source, const std::string& shader, bool path, Diagnostics& d) {
    static const std::set<std::string> kRadiance = {"slrect", "slpoint", "slspot", "sldirect"}; // as they ship
    const scene::Param* p = source.attributes ? source.attributes->value("light:units") : nullptr;
    const std::string units = p && !p->strings.empty() ? p->strings[0] : "";
    if (units == "samples") return true;
    if (!units.empty() && units != "radiance")
        d.reportOnce("lightunits:" + units, {Severity::Warning,
                                             Rie::BadToken,
                                             p->place,
                                             "unknown units of light \"" + units + "\"",
                                             "\"radiance\" and \"samples\" are known",
                                             {}});
    return units != "radiance" && !path && !kRadiance.count(shader);
}

/// Whether a light says that nothing casts shadows of it, by the parameter of RIS.
bool castsNone(const ShaderInstance& light) {
    const auto i = light.parameters.numbers.find("enableShadows");
    return i != light.parameters.numbers.end() && !i->second.empty() && i->second[0] == 0;
}

/// Reads Attribute "light" for a light with a kernel.
void readLightAttributes(BoundLight& l, bool path, Diagnostics& d) {
    l.samples = std::clamp(
        int(numberOf(l.source->attributes, "light:samples", numberOf(l.source->attributes, "light:nsamples", 1))), 1, 1024);
    if (const scene::Param* p = l.source->attributes ? l.source->attributes->value("light:shadows") : nullptr; p && !path)
        l.shadows = !p->strings.empty() ? p->strings[0] == "on" : !p->numbers.empty() && p->numbers[0] != 0;
    if (const scene::Param* p = l.source->attributes ? l.source->attributes->value("light:samplingstrategy") : nullptr;
        p && !p->strings.empty()) {
        if (p->strings[0] == "trace") l.strategy = LightStrategy::Trace;
        else if (p->strings[0] == "illuminance") l.strategy = LightStrategy::Illuminance;
        else
            d.reportOnce("samplingstrategy:" + p->strings[0], {Severity::Warning,
                                                               Rie::BadToken,
                                                               p->place,
                                                               "unknown sampling strategy \"" + p->strings[0] + "\"",
                                                               "\"illuminance\" and \"trace\" are known",
                                                               {}});
    }
}

/// Warns: in shaders for Pixie, P is the lit point.
void warnOfOwnPoint(const ShaderInstance& light, Diagnostics& d) {
    d.reportOnce("ownpoint:" + light.name, {Severity::Warning,
                                            Rie::NoError,
                                            light.place,
                                            "light \"" + light.name + "\": P is the position of the light, as it has no area",
                                            "Ps is the point being lit; --dialect pixie reads P so",
                                            {}});
}

/// Whether a light that rays of lobes may meet depends on what it lights, besides Ps. Without area N is the lit point's.
bool readsLitPoint(const BoundKernel& k, bool area) {
    const auto& blocks = k.kernel->facts().blocks;
    if (!area && std::find(blocks.begin(), blocks.end(), rsl::kBlockSky) == blocks.end()) return false;
    const auto& inputs = k.kernel->inputs();
    return std::any_of(inputs.begin(), inputs.end(), [&](const rsl::ir::Input& i) {
        return i.name == "Ns" || i.name == "Ngs" || i.name == "I" || (!area && i.name == "N");
    });
}

/// Sets the kind of a light by its statement.
void setLightKind(BoundLight& part, const std::string& block, bool area, bool path, Diagnostics& d) {
    bool solar = block.starts_with(rsl::kBlockSolar);
    if (block == rsl::kBlockOutside) part.kind = LightKind::Ambient;
    else if (block == rsl::kBlockSky || part.instance->name == "envlight") part.kind = LightKind::Environment;
    else if (solar) part.kind = LightKind::Distant;
    else part.kind = area && part.sentCl < 0 ? LightKind::Area : LightKind::Point; // generated samples need no geometry
    part.cone = block == rsl::kBlockCone;
    if (part.kind != LightKind::Area && !((part.kind == LightKind::Environment || part.cone) && path)) part.samples = 1;
    if (part.sentCl >= 0) { // each of its samples is one iteration
        part.samples = limits::kLightIterations;
        part.shadows |= !path && part.instance->parameters.numbers.count(rsl::kSentShadows) > 0;
    }
    const bool emits = part.instance->parameters.numbers.count(rsl::kEmits) > 0;
    if (part.kind == LightKind::Area && givesMean(*part.source, part.instance->name, path || emits, d)) {
        part.mean = true;
        part.strategy = LightStrategy::Illuminance; // it has no radiance for trace() to find
    }
    if (part.kind != LightKind::Area) part.emitter = nullptr;
    if (part.instance->name == "slbackground" && !path) part.strategy = LightStrategy::Trace; // rays see it; it lights nothing
    if (part.kind != LightKind::Point) part.shadowRadius = -1; // other kinds cast shadows by their geometry or angle
    const auto& numbers = part.instance->parameters.numbers;
    if (const auto i = numbers.find(rsl::kImportanceSample); i != numbers.end())
        part.importance = i->second.empty() || i->second[0] != 0;
}

} // namespace

static constexpr const char* kPhotonNames[] = {rsl::kPhotonFrom, rsl::kPhotonWay, rsl::kPhotonPower, rsl::kPhotonPdf};

static bool givesPhotons(const std::string& name) {
    return std::any_of(std::begin(kPhotonNames), std::end(kPhotonNames), [&](const char* n) { return name == n; });
}

/// The kernel of a light, with its output parameters and the outputs that it writes for surfaces.
BoundKernel MutableWorld::lightKernel(const ShaderInstance& light, bool photons, Diagnostics& d) {
    BoundKernel k;
    std::vector<std::string> extra, outputs;
    bool sends = false;
    for (const char* name : {rsl::kNonDiffuse, rsl::kNonSpecular, kShadowRadius, kShadowSamples})
        for (const auto& p : light.program->parameters())
            if (p.name == name) extra.push_back(OutputName::parameterOf(name).text());
    for (const auto& p : light.program->parameters())
        if (givesPhotons(p.name)) sends = true;
        else if (const std::string name = OutputName::parameterOf(p.name).text();
                 p.output && p.type.base != shadeops::Base::String && std::find(extra.begin(), extra.end(), name) == extra.end())
            extra.push_back(name);
    // Values for outputs of the surface by outputchannel(), if a display requests them.
    for (const OutputName& name : wanted_)
        if (givesChannel(light, name)) addOutput(light, name, extra);
    for (const char* name : kPhotonNames)
        if (photons) extra.push_back(OutputName::parameterOf(name).text());
    if (!extra.empty() || sends) { // the kernel for its photons has the same outputs, followed by more
        outputs = {"L", "Cl", "Ol", "lit"};
        outputs.insert(outputs.end(), extra.begin(), extra.end());
    }
    k = kernel(light, outputs, {}, false, false, d);
    if (k && !outputs.empty() && k.kernel->facts().blocks.size() != 1) // more outputs than estimated
        k = kernel(light, outputsOf(k.kernel->facts(), extra), {}, false, false, d);
    return k;
}

void MutableWorld::bindPhotons(BoundLight& l, Diagnostics& d) {
    const auto& all = l.instance->program->parameters();
    if (std::none_of(all.begin(), all.end(), [](const auto& p) { return givesPhotons(p.name); })) return;
    l.photons = lightKernel(*l.instance, true, d);
    if (!l.photons) return;
    const auto& outputs = l.photons.kernel->outputs();
    for (size_t i = 0; i < outputs.size(); ++i)
        for (int n = 0; n < 4; ++n)
            if (OutputName::parse(outputs[i].name) == OutputName::parameterOf(kPhotonNames[n])) l.photonOutputs[n] = int(i);
}

/// Finds the outputs of one statement of a light, and its values.
void MutableWorld::bindLightOutputs(BoundLight& part, int block) {
    const auto aovsOf = [&](const OutputName& name) { // by index; measureOutputs() converts to the first component
        std::vector<int> all;                         // "list[1]" also belongs to "list"
        for (size_t i = 0; i < wanted_.size(); ++i)
            if (wanted_[i] == name || wanted_[i] == OutputName::of(name.name)) all.push_back(int(i));
        return all;
    };
    const auto& outputs = part.kernel.kernel->outputs();
    std::set<std::string> channels; // "list[1]" can occur twice: in "list", and by itself
    for (size_t i = 0; i < outputs.size(); ++i) {
        const OutputName n = OutputName::parse(outputs[i].name);
        const auto ofBlock = [&](const char* name) { return n == OutputName::ofBlock(name, block); };
        if (ofBlock("L")) part.outL = int(i);
        else if (ofBlock("Cl")) part.outCl = int(i);
        else if (ofBlock("lit")) part.outLit = int(i);
        else if (ofBlock("Ol")) part.outOl = int(i);
        else if (n == OutputName::parameterOf(rsl::kNonDiffuse)) part.nonDiffuse = int(i);
        else if (n == OutputName::parameterOf(rsl::kNonSpecular)) part.nonSpecular = int(i);
        else if (n == OutputName::parameterOf(kShadowRadius)) part.shadowRadius = int(i);
        else if (n == OutputName::parameterOf(kShadowSamples)) part.shadowSamples = int(i);
        if (n.parameter) {
            if (n == OutputName::parameterOf(rsl::kSentL, 0)) part.sentL = part.valueWidth;
            if (n == OutputName::parameterOf(rsl::kSentCl, 0)) part.sentCl = part.valueWidth;
            part.values.push_back({n, int(i), rsl::ir::components(outputs[i].kind)});
            part.valueWidth += part.values.back().components;
        } else if (n.what == OutputName::What::Given) {
            part.values.push_back({n, int(i), 1});
            part.valueWidth += 1;
        } else if (givesChannel(*part.instance, n) && channels.insert(outputs[i].name).second) {
            for (const int aov : aovsOf(n)) {
                part.values.push_back({n, int(i), rsl::ir::components(outputs[i].kind), aov});
                part.valueWidth += part.values.back().components;
                part.channels = lightChannels_ = true;
            }
        }
    }
}

void MutableWorld::bindLights(Diagnostics& d, const std::function<uint32_t(const geometry::Shape&)>& visibility) {
    const bool path = settings_.hider == Hider::Path;
    std::map<int, std::vector<const geometry::Shape*>> emitters;
    for (const auto& s : shapes_)
        if (s->attributes().areaLight >= 0) emitters[s->attributes().areaLight].push_back(s.get());
    size_t own = frame_->lights.size();
    lights_.resize(own);
    for (size_t li = 0; li < own; ++li) {
        const scene::Light& source = frame_->lights[li];
        BoundLight l;
        l.source = &source;
        l.handle = source.handle;
        l.kind = LightKind::Ambient;
        l.samples = 0;
        l.instance = source.shader ? instance(*source.shader, rsl::ShaderKind::Light, d) : nullptr;
        if (source.attributes) l.instance = withCoShaders(l.instance, source.attributes->coshaders, d);
        if (l.instance) l.kernel = lightKernel(*l.instance, false, d);
        if (!l.kernel) {
            lights_[li] = std::move(l);
            continue;
        }
        for (const SiteInfo& s : l.kernel.sites)
            if (s.kind == SiteKind::Message || s.kind == SiteKind::LightHandles || (s.photons && s.photons->caustic)) {
                l.asksSurface = lightsAsk_ = true;
                if (s.site->op == "surface" && !s.site->strings.empty() && !scene::FilterLink::of(s.site->strings[0]))
                    lightMessages_.push_back(s.site->strings[0]);
                if (s.site->op == "displacement") lightDisplacements_.insert(s.site->strings.empty() ? "" : s.site->strings[0]);
            }
        std::vector<std::string> blocks = l.kernel.kernel->facts().blocks;
        if (blocks.empty()) blocks = {rsl::kBlockOutside};
        bool area = source.area && emitters.count(int(li));
        if (path && readsLitPoint(l.kernel, area)) l.asksSurface = lightsAsk_ = true;
        l.shadowless = path && castsNone(*l.instance);
        if (area) {
            std::vector<uint32_t> seen; // by what rays, besides samples of the light
            for (const geometry::Shape* s : emitters[int(li)]) seen.push_back(l.shadowless ? 0 : visibility(*s));
            l.emitter = std::make_shared<Emitter>(emitters[int(li)], std::move(seen));
        }
        if (!area && readsOwnPoint(l.instance->program->shader())) warnOfOwnPoint(*l.instance, d);
        readLightAttributes(l, path, d);
        for (size_t k = 0; k < blocks.size(); ++k) {
            BoundLight part = l;
            bindLightOutputs(part, int(k));
            if (part.outCl < 0) continue;
            setLightKind(part, blocks[k], area, path, d);
            if (k == 0) {
                bindPhotons(part, d);
                lights_[li] = std::move(part);
            } else {
                lights_[li].parts.push_back(int(lights_.size()));
                lights_.push_back(std::move(part));
            }
        }
    }
    for (size_t i = 0; i < lights_.size(); ++i)
        if (const BoundLight& l = lights_[i]; l.kernel && (l.kind == LightKind::Environment || l.kind == LightKind::Ambient))
            skies_.push_back(int(i));
    std::sort(lightMessages_.begin(), lightMessages_.end());
    lightMessages_.erase(std::unique(lightMessages_.begin(), lightMessages_.end()), lightMessages_.end());
}

void MutableWorld::findShining() {
    const auto found = [&](int l) { return lights_[size_t(l)].kind == LightKind::Area && !lights_[size_t(l)].mean; };
    for (const auto& s : shapes_) {
        const int l = s->attributes().areaLight;
        const auto& parts = l >= 0 ? lights_[size_t(l)].parts : std::vector<int>();
        shining_.push_back(l >= 0 && (found(l) || std::any_of(parts.begin(), parts.end(), found)));
    }
    shining_.push_back(0);
}

void MutableWorld::countLightTraces() {
    const auto sitesOf = [](const BoundKernel& k, auto test) {
        return double(std::count_if(k.sites.begin(), k.sites.end(), [&](const SiteInfo& s) { return test(s.kind); }));
    };
    double traces = 0, uses = 1;
    for (const BoundLight& l : lights_) traces += sitesOf(l.kernel, [](SiteKind k) { return k == SiteKind::Trace; });
    traces *= std::min(1.0, double(limits::kLightsSampled) / double(std::max<size_t>(lights_.size(), 1)));
    for (const SurfaceBinding& b : bindings_)
        for (const BoundKernel* k : {&b.surfaceS, &b.surfaceV, &b.entering})
            uses = std::max(uses, sitesOf(*k, [](SiteKind s) {
                                return s == SiteKind::LightSetup || (s >= SiteKind::Ambient && s <= SiteKind::Trace);
                            }));
    lightTraces_ = int(std::ceil(traces * uses));
}

void MutableWorld::bindSentStrings(Diagnostics& d) {
    std::map<std::string, std::map<std::string, std::string>> sent;
    for (const SurfaceBinding& b : bindings_)
        for (const BoundKernel* k : {&b.surfaceS, &b.surfaceV, &b.entering, &b.atmosphere.kernel})
            for (const SiteInfo& s : k->sites)
                if (s.kind == SiteKind::LightSetup)
                    for (const auto& [name, value] : s.sentStrings) sent[s.sentKey][name] = value;
    for (BoundLight& l : lights_)
        for (const auto& [key, values] : sent) {
            if (!l.kernel) continue;
            ShaderInstance other = *l.instance;
            bool differs = false;
            for (const auto& [name, value] : values)
                if (auto have = other.parameters.strings.find(name);
                    have != other.parameters.strings.end() && have->second != value) {
                    have->second = value;
                    differs = true;
                }
            std::vector<std::string> outputs;
            for (const auto& o : l.kernel.kernel->outputs()) outputs.push_back(o.name);
            if (!differs) continue;
            BoundKernel k = kernel(other, outputs, {}, false, false, d);
            if (k && k.kernel->outputs().size() == outputs.size()) l.variants[key] = std::move(k);
        }
}

scene::LightSet MutableWorld::withParts(const scene::LightSet& lights) const {
    scene::LightSet all = lights;
    if (lights_.size() > frame_->lights.size())
        for (int l : lights)
            for (int part : lights_[size_t(l)].parts) all.insert(part);
    return all;
}

/// Estimates the directions in which light leaves an emitter, from its brightness before and behind points of it. shared: lights
/// of other statements of the shader use the same emitter.
static void tellFront(BoundLight& l, std::span<const float> front, std::span<const float> back, bool shared) {
    using Shines = Emitter::Shines;
    const auto shines = [](std::span<const float> side) {
        return std::any_of(side.begin(), side.end(), [](float b) { return b > 0; });
    };
    l.emitter->shinesTo(shines(front) == shines(back) ? Shines::Both : shines(front) ? Shines::Front : Shines::Back);
    l.front = l.emitter->front();
    if (shared) l.emitter->shinesTo(Shines::Both);
}

/// A query for light at `lit` from a point on the light with normal n, facing it.
static ShadePoint askedAt(const Vec3& p, const Vec3& n, const Vec3& lit) {
    ShadePoint q;
    q.P = p;
    q.N = n;
    q.Ps = lit;
    q.Ns = normalize(p - lit);
    return q;
}

void MutableWorld::measureLights(Evaluator& evaluator, Diagnostics& d) {
    const bool many = std::any_of(lightLists_.begin(), lightLists_.end(),
                                  [&](const LightList& l) { return sampledOf(l).size() > size_t(limits::kLightsSampled); });
    for (BoundLight& l : lights_) {
        if (!l.kernel || (l.kind == LightKind::Area && (!l.emitter || l.emitter->empty()))) continue;
        auto brightness = [&](std::vector<ShadePoint> q) {
            std::vector<LightValue> v(q.size());
            evaluator.light(l, q, v);
            std::vector<float> b;
            for (const LightValue& x : v) { // negative light is sampled, too
                const float y = luminance(absolute(x.Cl));
                b.push_back(x.lit && std::isfinite(y) ? y : 0);
            }
            return b;
        };
        if (l.kind == LightKind::Area) {
            geometry::Bounds box = l.emitter->bounds();
            l.centre = (box.lo + box.hi) * 0.5f;
            l.radius = length(box.hi - box.lo) * 0.5f;
            // Radiance is constant along a ray. A kernel whose Cl falls off with squared distance along the normal divides by it
            // itself: its Cl is an intensity.
            float step = std::max(std::sqrt(float(l.emitter->area())), 1e-6f), mean = 0;
            int square = 0, seen = 0;
            std::vector<float> front, back;
            for (int k = 0; k < 4; ++k) {
                const geometry::Shape* shape = nullptr;
                geometry::SurfacePoint p = l.emitter->point({0.3f + 0.2f * float(k & 1), 0.35f + 0.15f * float(k >> 1)}, shape);
                std::vector<ShadePoint> q;
                for (float t : {1.f, 2.f, 4.f, -1.f}) {
                    ShadePoint s = askedAt(p.P, p.n, p.P + p.n * (step * t));
                    s.shape = shape;
                    s.surface = p;
                    q.push_back(s);
                }
                std::vector<float> b = brightness(q);
                mean += b[0] / 4;
                front.insert(front.end(), b.begin(), b.begin() + 3);
                back.push_back(b[3]);
                if (!(b[0] > 0)) continue;
                ++seen;
                square += std::fabs(b[1] * 4 / b[0] - 1) < 1e-3f && std::fabs(b[2] * 16 / b[0] - 1) < 1e-3f;
            }
            if (l.mean) {
                l.power = mean * step * step;
                continue;
            }
            if (seen > 0 && square == seen) {
                l.intensityScale = float(kPi) / float(l.emitter->area());
                mean *= l.intensityScale * step * step;
                d.reportOnce("intensity:" + l.instance->name,
                             {Severity::Info,
                              Rie::NoError,
                              l.instance->place,
                              "area light \"" + l.instance->name +
                                  "\" divides by the distance itself; its Cl is read as intensity, spread over its surface",
                              "Cl of an area light is its radiance: remove the division",
                              {}});
            }
            l.power = mean * float(l.emitter->area()) / float(kPi);
            tellFront(l, front, back, size_t(&l - lights_.data()) >= frame_->lights.size() || !l.parts.empty());
        } else if (many && (l.kind == LightKind::Point || l.kind == LightKind::Distant)) {
            l.centre = Vec3(transformPoint(l.instance->toCurrent, {0, 0, 0}));
            std::vector<ShadePoint> q;
            for (int k = 0; k < kProbes; ++k) {
                int c = k < 13 ? k : k + 1; // the 26 neighbours in a cube of 27
                Vec3 dir = normalize(Vec3(float(c % 3 - 1), float(c / 3 % 3 - 1), float(c / 9 - 1)));
                q.push_back(askedAt(l.centre, dir, l.centre + dir));
            }
            std::vector<float> b = brightness(q);
            l.power = *std::max_element(b.begin(), b.end());
        }
    }
}

} // namespace alpenglow::world
