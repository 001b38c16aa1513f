// Which shapes rays hit: "subset", "excludesubset", "hitsides" and "hitmode" of tracing shadeops, and groups by Attribute
// "grouping" "membership" (3Delight manual, table 6.10; docs/options.md).
#include "world/raysets.h"
#include <bit>
#include <set>
#include <sstream>

namespace alpenglow::world {

using shading::HitMode;

namespace {

/// Names separated by blanks and commas.
std::vector<std::string> namesIn(const std::string& text) {
    std::vector<std::string> names(1);
    for (const char c : text)
        if (c == ',' || c == ' ' || c == '\t' || c == '\n') names.emplace_back();
        else names.back() += c;
    std::erase(names, "");
    return names;
}

} // namespace

std::string attributeText(const scene::Attributes& a, const char* key) {
    const scene::Param* p = a.value(key);
    return p && !p->strings.empty() ? p->strings[0] : "";
}

std::optional<accel::Sides> sidesOf(const std::string& word) {
    if (word == "front") return accel::Sides::Front;
    if (word == "back" || word == "reversed") return accel::Sides::Back;
    if (word == "both") return accel::Sides::Both;
    return {};
}
std::optional<HitMode> modeOf(const std::string& word) {
    if (word == "primitive") return HitMode::Primitive;
    if (word == "shader") return HitMode::Shader;
    if (word == "default") return HitMode::Default;
    return {};
}

RayType rayTypeOf(const std::string& word) {
    return word == "diffuse" ? RayType::Diffuse : word == "transmission" ? RayType::Transmission : RayType::Specular;
}

const uint8_t* ShapeSubsets::find(const WorldImpl& world, const std::string& wanted, const std::string& unwanted) const {
    std::set<std::string> with, without;
    for (std::string g : namesIn(wanted)) {
        const char sign = g[0];
        if (sign == '-' || sign == '+') g.erase(0, 1);
        if (!g.empty()) (sign == '-' ? without : with).insert(g);
    }
    for (std::string g : namesIn(unwanted)) {
        if (g[0] == '-' || g[0] == '+') g.erase(0, 1);
        if (!g.empty()) without.insert(g);
    }
    if (with.empty() && without.empty()) return nullptr;
    std::string key;
    for (const std::string& g : with) key += "+" + g;
    for (const std::string& g : without) key += "-" + g;
    std::lock_guard lock(mutex_);
    auto [at, fresh] = kept_.try_emplace(std::move(key));
    if (!fresh) return at->second.data();
    std::vector<uint8_t>& take = at->second;
    take.reserve(world.shapes().size() + 1);
    const scene::Attributes* last = nullptr; // of consecutive shapes with the same attributes
    uint8_t taken = 0;
    for (const geometry::ShapeRef& s : world.shapes()) {
        if (&s->attributes() != last) {
            last = &s->attributes();
            bool in = with.empty(), out = false;
            for (const std::string& g : namesIn(attributeText(*last, "grouping:membership"))) {
                const std::string name = g[0] == '+' ? g.substr(1) : g;
                in |= with.count(name) > 0;
                out |= without.count(name) > 0;
            }
            taken = in && !out;
        }
        take.push_back(taken);
    }
    take.push_back(0); // not empty
    return take.data();
}

std::shared_ptr<const RaySite> raySite(const SiteInfo& i, const WorldImpl& world, const SourcePlace& place) {
    auto r = std::make_shared<RaySite>();
    const std::string op = i.site->op;
    auto row = [&](const char* name) {
        auto f = i.named.find(name);
        return f == i.named.end() ? -1 : f->second;
    };
    auto text = [&](const char* name) {
        auto f = i.text.find(name);
        return f == i.text.end() ? std::string() : f->second;
    };
    auto unknown = [&](const char* name, const std::string& word, const char* known) {
        world.diagnostics().reportOnce("rays:" + std::string(name) + word + place.file + std::to_string(place.line),
                                       {Severity::Warning,
                                        Rie::BadToken,
                                        place,
                                        op + "(): \"" + name + "\" \"" + word + "\" is not known; it is ignored",
                                        known,
                                        {}});
    };
    r->bias = row("bias");
    r->maxDistance = row("maxdist");
    r->maxHit = row("maxhitdist");
    r->cone = row("samplecone");
    r->samples = row("samples");
    r->base = row("samplebase");
    r->subset = row("subset");
    r->exclude = row("excludesubset");
    r->sides = row("hitsides");
    r->mode = row("hitmode");
    r->label = row("label") >= 0 ? row("label") : row("raylabel");
    r->type = row("type") >= 0 ? row("type") : row("raytype");
    r->subsetText = text("subset");
    r->excludeText = text("excludesubset");
    r->subsetId = rsl::internString(r->subsetText);
    r->excludeId = rsl::internString(r->excludeText);
    const bool distance = i.kind == SiteKind::Trace && i.site->resultType.base == shadeops::Base::Float; // float trace()
    const std::string type = !text("type").empty() ? text("type") : text("raytype");
    if (!type.empty() && type != "specular" && type != "diffuse" && type != "transmission")
        unknown("type", type, "specular, diffuse, transmission");
    r->rays = !type.empty()                                                                   ? rayTypeOf(type)
              : i.kind == SiteKind::Transmission || i.kind == SiteKind::Occlusion || distance ? RayType::Transmission
                                                                                              : RayType::Specular;
    if (const std::string word = text("hitsides"); !word.empty()) {
        if (const auto s = sidesOf(word)) r->set.sides = *s;
        else unknown("hitsides", word, "front, back, both, reversed");
    }
    if (const std::string word = text("hitmode"); !word.empty()) {
        if (const auto m = modeOf(word)) r->set.mode = *m;
        else unknown("hitmode", word, "primitive, shader, default");
    }
    r->set.only = world.subsets().find(world, r->subsetText, r->excludeText);
    r->saysSides = r->sides >= 0 || !text("hitsides").empty();
    r->fixed = r->subset < 0 && r->exclude < 0 && r->sides < 0 && r->mode < 0 && r->label < 0 && r->type < 0;
    return r;
}

} // namespace alpenglow::world
