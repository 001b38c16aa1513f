#include "world/gathersite.h"
#include "base/exact.h"
#include "rsl/front/protocol.h"
#include "rsl/front/visit.h"
#include <cstdlib>

namespace alpenglow::transport {

namespace {

using Of = GatherSite::Of;

constexpr int kAround = 128, kDown = 64; ///< cells, all of the same size: even in height and around

Vec3 directionAt(double x, double y) {
    const double z = 1 - 2 * y / kDown, r = std::sqrt(std::max(0.0, 1 - z * z)), turn = 2 * kPi * x / kAround;
    return {float(r * exact::cos(turn)), float(r * exact::sin(turn)), float(z)};
}

Color lightAt(texture::Handle map, const texture::LatLong& axes, const Vec3& w, float side) {
    texture::LookupOptions colours;
    colours.asLight = true;
    const Vec3 beside = std::fabs(w.z) < .9f ? cross(w, Vec3(0, 0, 1)) : cross(w, Vec3(1, 0, 0)), t = beside / length(beside);
    float v[3] = {};
    texture::environment(map, axes, 0, 3, w, t * side, cross(w, t) * side, colours, v);
    return {v[0], v[1], v[2]};
}

/// What a name with its prefix means; nothing: it is not known.
std::optional<std::pair<Of, std::string>> meaning(const std::string& name) {
    static const std::map<std::pair<std::string, std::string>, Of> whole = {{{"surface", "Ci"}, Of::Light},
                                                                            {{"surface", "Oi"}, Of::Opacity},
                                                                            {{"ray", "origin"}, Of::Origin},
                                                                            {{"ray", "direction"}, Of::Direction},
                                                                            {{"ray", "length"}, Of::Length},
                                                                            {{"environment", "color"}, Of::SkyColor},
                                                                            {{"environment", "direction"}, Of::SkyDirection},
                                                                            {{"environment", "solidangle"}, Of::SkySolidAngle}};
    static const std::map<std::string, Of> prefixes = {{"surface", Of::Surface},
                                                       {"displacement", Of::Displacement},
                                                       {"volume", Of::Volume},
                                                       {"primitive", Of::Primitive},
                                                       {"attribute", Of::Attribute}};
    const size_t colon = name.find(':');
    if (colon == std::string::npos) return {};
    const std::string prefix = name.substr(0, colon), rest = name.substr(colon + 1);
    if (const auto i = whole.find({prefix, rest}); i != whole.end()) return std::pair(i->second, std::string());
    const auto i = prefixes.find(prefix);
    if (i == prefixes.end()) return {};
    return std::pair(i->second, rest);
}

/// The outputs of a turn: flags are results that begin with '?', values follow them.
void readOutputs(const rsl::ir::Site& turn, GatherSite& g, const std::function<void(const std::string&)>& unknown) {
    int row = 0;
    GatherSite::Output* open = nullptr;
    for (size_t r = 0; r < turn.resultKinds.size(); ++r) {
        const std::string& name = turn.resultNames[r];
        const int rows = rsl::ir::components(turn.resultKinds[r]);
        if (!name.empty() && name[0] == '?') {
            open = nullptr;
            if (const auto known = meaning(name.substr(1))) {
                open = &g.outputs.emplace_back();
                open->of = known->first;
                open->id = rsl::internString(known->second);
                open->at = row;
                open->rows = 0;
            } else {
                unknown(name.substr(1));
            }
        } else if (open) {
            if (rsl::isLengthResult(name)) open->open = true;
            else {
                open->kind = turn.resultKinds[r];
                open->elements += name.back() == ']';
            }
            open->rows += rows;
        }
        row += rows;
    }
    g.width = row;
}

} // namespace

SkyDirections::SkyDirections(texture::Handle map, const texture::LatLong& axes) : map_(map), axes_(axes) {
    std::vector<float> light;
    double all = 0;
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAround; ++x) {
            const float v = std::max(
                0.f, luminance(lightAt(map, axes, directionAt(x + .5, y + .5), float(std::sqrt(4 * kPi / (kAround * kDown))))));
            light.push_back(std::isfinite(v) ? v : 0);
            all += light.back();
        }
    // A tenth of all goes everywhere alike: what a cell's middle says of it may be wrong.
    double sum = 0;
    for (const float v : light)
        sums_.push_back(float(sum += .9 * (all > 0 ? v / all : 1.0 / double(light.size())) + .1 / double(light.size())));
}

SkyDirections::Direction SkyDirections::at(Vec2 e) const {
    const size_t cell = size_t(
        std::min<ptrdiff_t>(std::upper_bound(sums_.begin(), sums_.end(), e.x) - sums_.begin(), ptrdiff_t(sums_.size()) - 1));
    const float before = cell ? sums_[cell - 1] : 0, chance = sums_[cell] - before;
    const float inside = std::clamp((e.x - before) / chance, 0.f, 1.f); // what is left of the first number
    Direction d;
    d.w = directionAt(double(cell % kAround) + inside, double(cell / kAround) + e.y);
    d.density = chance * float(kAround * kDown / (4 * kPi));
    d.light = map_ ? lightAt(map_, axes_, d.w, 1e-3f) : Color(0);
    return d;
}

void linkGathers(BoundKernel& b, const rsl::CompiledKernel& k, WorldImpl& world) {
    std::map<std::string, std::shared_ptr<GatherSite>> known;
    const auto numberOf = [](const SiteInfo& i) {
        const auto n = i.text.find(rsl::kPairGather);
        return n == i.text.end() ? std::string() : n->second;
    };
    const auto told = [&](const SiteInfo& i, const std::string& what, const std::string& hint) {
        const rsl::Place& at = i.site->place;
        const SourcePlace place{at.file >= 0 && at.file < int(k.files().size()) ? k.files()[size_t(at.file)] : "", at.line,
                                at.column};
        world.diagnostics_->reportOnce("gather:" + what + place.file + std::to_string(place.line),
                                       {Severity::Warning, Rie::BadToken, place, "gather: " + what, hint, {}});
    };
    for (SiteInfo& i : b.sites) {
        if (i.kind != SiteKind::Gather && i.kind != SiteKind::GatherTurn) continue;
        auto& g = known[numberOf(i)];
        if (!g) g = std::make_shared<GatherSite>();
        i.gather = g;
        g->number = std::atoi(numberOf(i).c_str());
        if (i.kind == SiteKind::GatherTurn) {
            g->outputs.clear();
            readOutputs(*i.site, *g, [&](const std::string& name) {
                told(i, "\"" + name + "\" is not known; the variable stays as it is",
                     "names begin with surface: displacement: volume: primitive: attribute: ray: environment:");
            });
            for (const GatherSite::Output& o : g->outputs) {
                g->light |= o.of == Of::Light;
                g->opacity |= o.of == Of::Opacity;
                g->asks |= o.of == Of::Surface || o.of == Of::Displacement || o.of == Of::Volume;
                g->shades |= g->light || g->opacity || g->asks;
            }
            continue;
        }
        const std::string category = i.site->strings.empty() ? "" : i.site->strings[0];
        static const std::string kSky = "environment:";
        if (category == "samplepattern") g->category = GatherSite::Category::Directions;
        else if (category.rfind(kSky, 0) == 0) {
            g->category = GatherSite::Category::Sky;
            const rsl::Place& at = i.site->place;
            const SourcePlace place{at.file >= 0 && at.file < int(k.files().size()) ? k.files()[size_t(at.file)] : "", at.line,
                                    at.column};
            g->sky = std::make_shared<SkyDirections>(
                world.textures_->open(category.substr(kSky.size()), world.settings_.texturePaths, place),
                world.textures_->latLong());
        } else if (!category.empty() && category != "illuminance") {
            told(i, "the category \"" + category + "\" is not known; \"illuminance\" is taken",
                 "illuminance, samplepattern, environment:MAP");
        }
        if (const auto d = i.text.find("distribution"); d != i.text.end()) {
            g->cosine = d->second == "cosine";
            if (!g->cosine && d->second != "uniform")
                told(i, "the distribution \"" + d->second + "\" is not known; uniform is taken", "uniform, cosine");
        }
        if (const auto t = i.named.find("othreshold"); t != i.named.end()) g->threshold = t->second;
    }
}

void gatheredNames(const rsl::Program& p, std::set<std::string>& names) {
    const auto in = [&](const rsl::StmtPtr& body) {
        if (!body) return;
        rsl::front::everyStmt(
            *body,
            [&](const rsl::Stmt& s) {
                if (s.kind != rsl::StmtKind::Gather) return;
                for (const rsl::NamedArg& a : s.pairs)
                    if (const auto pair = rsl::PairName::parse(a.name); pair.kind == rsl::PairName::Kind::Surface)
                        names.insert(pair.name);
            },
            [](const rsl::Expr&) {});
    };
    rsl::front::everyFunction(p, [&](const rsl::Function& f) { in(f.body); });
    for (const auto& s : p.shaders) in(s->body);
}

} // namespace alpenglow::transport
