// Resolves the call sites of a kernel, once per kernel.
#include "rsl/front/headers.h"
#include "scene/scene.h"
#include "shadeops/distributions.h"
#include "shadeops/specular.h"
#include "world/blocksite.h"
#include "world/cloudsite.h"
#include "world/gathersite.h"
#include "world/photonattributes.h"
#include "world/pointsite.h"
#include "world/raysets.h"
#include "world/service.h"
#include "world/unknownfilter.h"

namespace alpenglow::world {

SourcePlace placeOf(const rsl::ir::Site& s, const rsl::CompiledKernel& k) {
    const auto& files = k.files();
    return {size_t(s.place.file) < files.size() ? files[size_t(s.place.file)] : "", s.place.line, s.place.column};
}

namespace {

/// Calls that no service answers: requests, and loops.
SiteKind kindOf(const std::string& op) {
    static const std::map<std::string, SiteKind> kinds = {{"ambient", SiteKind::Ambient},
                                                          {"diffuse", SiteKind::Diffuse},
                                                          {"specular", SiteKind::Specular},
                                                          {"specularstd", SiteKind::Specular},
                                                          {"phong", SiteKind::Phong},
                                                          {"trace", SiteKind::Trace},
                                                          {"transmission", SiteKind::Transmission},
                                                          {"occlusion", SiteKind::Occlusion},
                                                          {"subsurface", SiteKind::Subsurface},
                                                          {"indirectdiffuse", SiteKind::Irradiance},
                                                          {"gather", SiteKind::Gather},
                                                          {"gatherturn", SiteKind::GatherIteration},
                                                          {"lightvisibility", SiteKind::LightVisibility},
                                                          {"illuminance", SiteKind::Illuminance}};
    auto i = kinds.find(op);
    return i == kinds.end() ? SiteKind::Other : i->second;
}

/// Records hold irradiance of whole hemispheres around a normal: calls with other outputs or directions cannot use them.
RecordSite recordSite(const SiteInfo& i, const rsl::ir::Site& s) {
    const auto row = [&](const char* name) {
        auto f = i.named.find(name);
        return f == i.named.end() ? -1 : f->second;
    };
    RecordSite r{row("maxvariation"), row("maxpixeldist")};
    if (r.variation < 0 || i.resultRows.size() > 1 || row("horizon") >= 0 || row("axis") >= 0) return r;
    r.call = std::max<uint64_t>(1, std::hash<std::string>{}(s.op + ":" + std::to_string(s.place.file) + ":" +
                                                            std::to_string(s.place.line) + ":" + std::to_string(s.place.column)));
    return r;
}

/// Reads the parameters of a trace() beyond the common ones. Reports each ignored parameter once.
std::shared_ptr<const TraceSite> traceSite(const SiteInfo& i, const rsl::ir::Site& s, const rsl::CompiledKernel& k,
                                           const WorldImpl& world) {
    auto t = std::make_shared<TraceSite>();
    const SourcePlace place = placeOf(s, k);
    auto row = [&](const char* name) {
        auto f = i.named.find(name);
        return f == i.named.end() ? -1 : f->second;
    };
    auto text = [&](const char* name) {
        auto f = i.text.find(name);
        return f == i.text.end() ? std::string() : f->second;
    };
    auto reported = [&](const std::string& what, const std::string& message) {
        world.diagnostics().reportOnce("trace:" + what + place.file + std::to_string(place.line),
                                       {Severity::Warning, Rie::Unimplement, place, s.op + "(): " + message, {}, {}});
    };
    t->udir = row("udir");
    t->roughness = row("roughness");
    t->roughnessv = row("roughnessv");
    t->absorption = row("absorption");
    t->tint = row("environmenttint");
    t->weight = row("weight");
    const std::string part = text(rsl::kPairPart);
    if (!part.empty()) t->part = part[0] - '0';
    std::map<int, int> ends; // by row: end of the value
    int at = 0;
    for (auto kind : s.argKinds) {
        const int begin = at;
        ends[begin] = at += rsl::ir::components(kind);
    }
    for (const char* name : {"eta", "eta[0]", "eta[1]"})
        if (const int r = row(name); r >= 0) t->eta.push_back({r, std::min(3, ends[r] - r)});
    for (int n = 0; row(("lobeparameters[" + std::to_string(n) + "]").c_str()) >= 0; ++n)
        t->lobes.push_back(row(("lobeparameters[" + std::to_string(n) + "]").c_str()));
    t->distribution = row("distribution") >= 0 ? row("distribution") : row("bsdf");
    for (const char* name : {"environmentmap", "environmentspace"})
        if (row(name) >= 0) reported(name, "\"" + std::string(name) + "\" must be a constant in the shader; it is ignored");
    if (const std::string map = text("environmentmap"); !map.empty()) {
        t->map = world.textures().open(map, world.settings().texturePaths, place);
        if (const std::string space = text("environmentspace"); !space.empty()) world.matrix("current", space, t->toMap);
    }
    for (const char* name : {"transmission", "environmentcontribution", "unshadowedenvironment", "arealightcontribution",
                             "unshadowedarealight", "environmentdir"})
        t->sums |= i.resultRows.count(name) > 0;
    t->onlyLights =
        !i.resultRows.empty() &&
        i.resultRows.count("arealightcontribution") + i.resultRows.count("unshadowedarealight") == i.resultRows.size();
    t->openness = i.results.transmission >= 0 || i.results.open >= 0;
    t->hemisphere = i.text.count(rsl::kPairHemisphere) > 0;
    if (t->hemisphere) { // trace() itself has no such parameters: the compiler has reported that
        t->apart = i.text.count(rsl::kPairApart) > 0;
        t->axis = i.rowHorizon >= 0;
        t->fade = {row("falloff"), row("falloffmode")};
        t->records = recordSite(i, s);
    }
    return t;
}

std::shared_ptr<const OcclusionSite> occlusionSite(const SiteInfo& i, const rsl::ir::Site& s) {
    auto o = std::make_shared<OcclusionSite>();
    auto row = [&](const char* name) {
        auto f = i.named.find(name);
        return f == i.named.end() ? -1 : f->second;
    };
    o->cone = row("coneangle");
    o->axis = row("axis");
    o->fade = {row("falloff"), row("falloffmode")};
    o->adaptive = row("adaptive");
    o->least = row("minsamples");
    const auto word = i.text.find("distribution");
    o->uniform = word != i.text.end() && word->second == "uniform";
    if (!o->uniform) o->records = recordSite(i, s);
    return o;
}

/// Parameters of shadow() beyond texture(): from the call, else from Option "shadow"; usual: the bias where both set none.
void shadowSite(TextureSite& t, const SiteInfo& i, const scene::Options& options, float usual) {
    const auto row = [&](const char* name) {
        const auto f = i.named.find(name);
        return f == i.named.end() ? -1 : f->second;
    };
    t.samples = row("samples");
    t.bias = row("bias");
    t.bias0 = row("bias0");
    t.bias1 = row("bias1");
    t.gapbias = row("gapbias");
    int n = 0;
    for (const char* name : {"source", "source2", "source3", "source4"}) t.source[n++] = row(name);
    const auto number = [&](const char* name, float otherwise) {
        const auto f = options.values.find(name);
        return f == options.values.end() || f->second.numbers.empty() ? otherwise : f->second.numbers[0];
    };
    t.shadowSamples = number("shadow:sample", 16);
    const float bias = number("shadow:bias", usual);
    t.shadowBias0 = number("shadow:bias0", bias);
    t.shadowBias1 = std::max(t.shadowBias0, number("shadow:bias1", std::max(bias, t.shadowBias0)));
}

std::shared_ptr<const SubsurfaceSite> subsurfaceSite(const SiteInfo& i, const rsl::ir::Site& s, const rsl::CompiledKernel& k,
                                                     const WorldImpl& world) {
    auto b = std::make_shared<SubsurfaceSite>();
    const SourcePlace place = placeOf(s, k);
    const auto row = [&](std::initializer_list<const char*> names) {
        for (const char* name : names)
            if (const auto f = i.named.find(name); f != i.named.end()) return f->second;
        return -1;
    };
    const auto text = [&](const char* name) {
        const auto f = i.text.find(name);
        return f == i.text.end() ? std::string() : f->second;
    };
    const auto reported = [&](const std::string& what, const std::string& message, const std::string& hint = {}) {
        world.diagnostics().reportOnce("subsurface:" + what + place.file + std::to_string(place.line),
                                       {Severity::Warning, Rie::Unimplement, place, "subsurface(): " + message, hint, {}});
    };
    b->samples = row({"samples"});
    b->scattering = row({"scattering"});
    b->absorption = row({"absorption"});
    b->path = row({"meanfreepath"});
    b->diffusePath = row({"diffusemeanfreepath"});
    b->reflectance = row({"reflectance", "albedo"});
    b->index = row({"ior", "refractionindex"});
    b->scale = row({"scale", "unitlength"});
    b->anisotropy = row({"anisotropy"});
    b->group = text("groupname");
    for (size_t a = 0; a < i.rows.size(); ++a)
        if (s.argKinds[a] == rsl::ir::Kind::Triple) (b->point < 0 ? b->point : b->normal) = i.rows[a];
    for (const char* name : {"model", "groupname"})
        if (row({name}) >= 0) reported(name, "\"" + std::string(name) + "\" must be a constant in the shader; it is ignored");
    const std::string type = !text("type").empty() ? text("type") : s.strings.empty() ? "" : s.strings[0];
    if (type == "pointcloud" && !i.text.count(rsl::kPairPoints))
        reported("type", "name a point cloud by \"filename\"; without one rays compute the light");
    else if (!type.empty() && type != "pointcloud" && type != "raytrace")
        reported("type " + type, "unknown type \"" + type + "\"; rays compute the light", "types are raytrace and pointcloud");
    const std::string model = text("model");
    if (model == "jensen") b->model = SubsurfaceSite::Model::Dipole;
    else if (model == "grosjean") b->model = SubsurfaceSite::Model::BetterDipole;
    else if (!model.empty() && model != "walk")
        reported("model " + model, "unknown model \"" + model + "\"; random walks below the surface are used",
                 "models are walk, jensen and grosjean");
    return b;
}

std::shared_ptr<const TextureSite> textureSite(const SiteInfo& i, const rsl::ir::Site& s, const rsl::CompiledKernel& k,
                                               const WorldImpl& world) {
    const scene::Options& options = world.frame().options;
    auto t = std::make_shared<TextureSite>();
    const auto row = [&](const char* name) {
        const auto f = i.named.find(name);
        return f == i.named.end() ? -1 : f->second;
    };
    t->filter = row("filter");
    t->channel = row("channel");
    t->fill = row("fill");
    t->width = row("width");
    t->swidth = row("swidth");
    t->twidth = row("twidth");
    t->blur = row("blur");
    t->sblur = row("sblur");
    t->tblur = row("tblur");
    if (const auto f = i.text.find("filter"); f != i.text.end()) {
        if (const auto known = texture::filterByName(f->second)) {
            t->options.filter = *known;
        } else {
            const SourcePlace place = placeOf(s, k);
            world.diagnostics().reportOnce("texturefilter:" + f->second, unknownFilter(f->second, s.op, place));
        }
    }
    if (!s.strings.empty()) t->name = s.strings[0];
    t->computed = t->name.empty() && !s.argKinds.empty() && s.argKinds[0] == rsl::ir::Kind::String;
    t->count = s.resultKinds.empty() ? 0 : std::min(rsl::ir::components(s.resultKinds[0]), 3);
    t->options.squeeze = world.textures().settings().squeeze;
    t->options.asLight = t->count == 3; // a float lookup reads data: a height, an opacity, a mask
    t->slopes = std::min(i.resultRowCount - t->count, 27);
    t->firsts = t->count * (i.kind == SiteKind::Texture ? 2 : 3);
    if (i.kind == SiteKind::Shadow) {
        t->slopes = 0;
        shadowSite(*t, i, options, rsl::front::dialectShadowBias(world.settings().dialect));
    }
    t->rows.assign(i.rows.begin() + (t->computed && !i.rows.empty()), i.rows.end());
    return t;
}

} // namespace

Diagnostic unknownFilter(const std::string& name, const std::string& op, const SourcePlace& place) {
    return {Severity::Warning,
            Rie::BadToken,
            place,
            op + "(): there is no filter \"" + name + "\"; \"gaussian\" is used",
            "filters of maps have the names of pixel filters",
            {}};
}

void bindMap(SiteInfo& i, const rsl::CompiledKernel& k, const WorldImpl& world) { i.map = textureSite(i, *i.site, k, world); }
void bindPhotonMap(SiteInfo& i, const rsl::CompiledKernel& k, const WorldImpl& world) { i.photons = photonSite(i, k, world); }
void bindCloud(SiteInfo& i, const rsl::CompiledKernel& k, const WorldImpl& world) { i.cloud = cloudSite(i, k, world); }

size_t rowsOf(const SiteInfo& i, int row) {
    int at = 0;
    for (auto kind : i.site->argKinds) {
        if (at == row) return size_t(rsl::ir::components(kind));
        at += rsl::ir::components(kind);
    }
    return 0;
}

/// Reads the values that a call site sends to lights.
static void bindSent(SiteInfo& i) {
    using rsl::PairName;
    for (const std::string& pair : i.site->names) {
        const PairName name = PairName::parse(pair);
        const auto at = i.named.find(pair);
        if (at == i.named.end()) continue;
        const int size = int(rowsOf(i, at->second));
        if (name.kind == PairName::Kind::Surface)
            i.outputs.push_back({rsl::OutputName::parameterOf(name.name), at->second, size});
        if (name.kind == PairName::Kind::Send && i.kind == SiteKind::LightSetup)
            i.sent.push_back({name.name, name.element, at->second, size});
    }
    for (const auto& [pair, value] : i.text) {
        const PairName name = PairName::parse(pair);
        if (name.kind != PairName::Kind::Send || i.kind != SiteKind::LightSetup) continue;
        i.sentStrings.emplace_back(name.name, value);
        i.sentKey += name.name + '\1' + value + '\2';
    }
    if (!i.sentKey.empty()) i.sentHash = std::hash<std::string>{}(i.sentKey);
    if (i.kind != SiteKind::LightSetup) return;
    int rows = 0;
    for (rsl::ir::Kind k : i.site->argKinds) rows += rsl::ir::components(k);
    for (const auto& [name, row] : i.named) {
        if (name == "N") i.rowN = row;
        if (name == "category") continue; // does not affect lights: cached values stay valid for another category
        int end = rows;
        for (const auto& [other, following] : i.named)
            if (following > row) end = std::min(end, following);
        i.shown.push_back({row, end, std::hash<std::string>{}(name)});
    }
}

/// Reads the distribution of a trace(), and rare parameters.
static void bindTrace(SiteInfo& i, const rsl::ir::Site& s, const rsl::CompiledKernel& k, const WorldImpl& world) {
    auto text = [&](const char* name, const char* fallback) {
        auto f = i.text.find(name);
        return f == i.text.end() ? std::string(fallback) : f->second;
    };
    std::string distribution = text("distribution", text("bsdf", "uniform").c_str());
    i.lobe = findLobe(distribution);
    if (!i.lobe) { // only in a kernel that the compiler has rejected
        i.lobe = findLobe("uniform");
        world.diagnostics().reportOnce("distribution:" + distribution,
                                       {Severity::Error,
                                        Rie::BadToken,
                                        placeOf(s, k),
                                        shadeops::noDistribution(s.op, distribution) + "; one ray along R is traced",
                                        shadeops::knownDistributions(),
                                        {}});
    }
    i.trace = traceSite(i, s, k, world);
}

/// Sets the lobe of a lighting shadeop.
static void bindLobe(SiteInfo& i) {
    if (i.kind == SiteKind::Specular) i.lobe = findLobe("specular");
    if (i.kind == SiteKind::Phong) i.lobe = findLobe("phong");
    if (i.kind != SiteKind::Diffuse) return;
    i.lobe = findLobe("diffuse");
    if (!i.text.count(rsl::kPairApart)) return;
    auto apart = std::make_shared<TraceSite>();
    apart->apart = true;
    i.trace = std::move(apart);
}

/// Finds the rows of a call's arguments and results.
static void bindRows(SiteInfo& i, const rsl::ir::Site& s) {
    int row = 0;
    std::vector<int> starts;
    for (auto kind : s.argKinds) {
        starts.push_back(row);
        row += rsl::ir::components(kind);
    }
    size_t numericPairs = 0;
    for (const auto& text : s.pairStrings) numericPairs += text.empty();
    size_t positional = starts.size() - std::min(starts.size(), numericPairs), next = positional;
    i.rows.assign(starts.begin(), starts.begin() + long(positional));
    for (size_t p = 0; p < s.names.size(); ++p) {
        if (!s.pairStrings[p].empty()) i.text[s.names[p]] = s.pairStrings[p];
        else if (next < starts.size()) i.named[s.names[p]] = starts[next++];
    }
    int out = 0;
    for (size_t r = 0; r < s.resultKinds.size(); ++r) {
        std::string name = r < s.resultNames.size() ? s.resultNames[r] : "";
        i.resultRows[name] = out;
        out += rsl::ir::components(s.resultKinds[r]);
    }
    i.resultRowCount = out;
    const auto result = [&](const char* name) {
        const auto f = i.resultRows.find(name);
        return f == i.resultRows.end() ? -1 : f->second;
    };
    i.results = {result(""),
                 result("dist"),
                 result("transmission"),
                 result("hitnormal"),
                 result("environmentdir"),
                 result("environmentcontribution"),
                 result("unshadowedenvironment"),
                 result("arealightcontribution"),
                 result("unshadowedarealight")};
}

static KernelNeeds needsOf(const BoundKernel& b) {
    KernelNeeds n;
    n.footprints = b.plan->usesFootprint();
    for (const SiteInfo& i : b.sites) {
        n.footprints |= i.rays && i.rays->base >= 0; // "samplebase" is a fraction of the footprint
        n.hitModes |= i.rays && (i.rays->set.mode != shading::HitMode::Default || i.rays->mode >= 0);
        n.records |= (i.trace && i.trace->records.call) || (i.occlusion && i.occlusion->records.call);
        n.globalPhotons |= i.kind == SiteKind::Trace && i.text.count(rsl::kPairHemisphere);
        n.facePlaces |= i.service && (i.service->traits & kReadsFacePlaces);
        if (i.cloud && i.cloud->writes) n.bakes = true, n.bakesCentres |= i.cloud->centres >= 0;
    }
    return n;
}

BoundKernel bindKernel(std::shared_ptr<const rsl::CompiledKernel> k, bool mixed, bool path, const WorldImpl& world) {
    BoundKernel b;
    b.path = path;
    b.mixed = mixed;
    if (!k) return b;
    for (const auto& s : k->sites()) {
        SiteInfo i;
        i.service = findService(world.services(), s.op);
        i.kind = i.service ? i.service->kind : kindOf(s.op);
        i.site = &s;
        bindRows(i, s);
        if (readsPoints(i)) {
            i.kind = s.op == "subsurface" ? SiteKind::PointSubsurface : SiteKind::PointHemisphere;
            auto points = std::make_shared<PointSite>(*pointSite(i, *k, world));
            if (s.op == "subsurface") points->subsurface = *subsurfaceSite(i, s, *k, world);
            i.points = std::move(points);
        }
        if (!s.strings.empty() && !s.strings[0].empty()) i.nameId = rsl::internString(s.strings[0]);
        i.setUp = i.text.count(rsl::kPairSetUp) > 0;
        i.outside = i.text.count(rsl::kPairOutside) > 0;
        i.once = i.text.count(rsl::kPairOnce) > 0;
        i.uniform = i.text.count(rsl::kPairUniform) > 0;
        if (s.resultNames.size() > 1) {
            i.open = rsl::isLengthResult(s.resultNames[1]);
            i.array = i.open || rsl::isElementResult(s.resultNames[1]);
        }
        if (const auto cache = i.text.find("lightcache"); cache != i.text.end()) i.refresh = cache->second == "refresh";
        if (const auto category = i.named.find("category"); category != i.named.end()) i.rowCategory = category->second;
        bindSent(i);
        if (i.service && i.service->bind) i.service->bind(i, *k, world);
        bindLobe(i);
        i.exponent = s.op == "specularstd" || world.rispecSpecular() ? shadeops::kRispecExponent : shadeops::kSpecularExponent;
        auto rowOf = [&](const char* name) {
            auto f = i.named.find(name);
            return f == i.named.end() ? -1 : f->second;
        };
        i.rowWo = rowOf("wo");
        i.rowExponent = rowOf("exponent");
        i.rowCone = rowOf("samplecone");
        i.rowHorizon = rowOf("horizon");
        i.rowLights = rowOf("samplelights");
        i.allLights = i.rowLights >= 0;
        if (!i.allLights) i.rowLights = rowOf("samplearealights");
        if (i.kind == SiteKind::Trace || i.kind == SiteKind::Transmission || i.kind == SiteKind::Occlusion ||
            i.kind == SiteKind::Gather) {
            auto text = [&](const char* name) {
                auto f = i.text.find(name);
                return f == i.text.end() ? std::string() : f->second;
            };
            i.label = rsl::internString(!text("label").empty() ? text("label") : text("raylabel"));
            i.rays = raySite(
                i, world,
                {s.place.file < int(k->files().size()) ? k->files()[size_t(s.place.file)] : "", s.place.line, s.place.column});
        }
        if (i.kind == SiteKind::Trace) bindTrace(i, s, *k, world);
        if (i.kind == SiteKind::Subsurface) {
            i.lobe = findLobe("uniform"); // its rays walk; it has no width
            i.subsurface = subsurfaceSite(i, s, *k, world);
        }
        if (i.kind == SiteKind::Occlusion) {
            i.occlusion = occlusionSite(i, s);
            i.trace = traceSite(i, s, *k, world);
        }
        i.block = blockSite(i, path);
        b.sites.push_back(std::move(i));
    }
    linkGathers(b, *k, world);
    b.plan = std::make_shared<shading::BatchPlan>(*k, mixed);
    b.needs = needsOf(b);
    b.kernel = std::move(k);
    b.blocks = asksBlocks(b);
    return b;
}

} // namespace alpenglow::world
