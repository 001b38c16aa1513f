#include "world/gathersite.h"
#include "base/limits.h"
#include "rsl/front/protocol.h"
#include "rsl/front/visit.h"
#include <algorithm>
#include <cstdlib>

namespace alpenglow::world {

namespace {

using Of = GatherSite::Of;

/// Meaning of a prefixed name; nothing: unknown.
std::optional<std::pair<Of, std::string>> meaning(const std::string& name) {
    static const std::map<std::pair<std::string, std::string>, Of> whole = {{{"surface", "Ci"}, Of::Light},
                                                                            {{"surface", "Oi"}, Of::Opacity},
                                                                            // With the Atmosphere, like surface:Ci here.
                                                                            {{"volume", "Ci"}, Of::Light},
                                                                            {{"volume", "Oi"}, Of::Opacity},
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

/// Whether a variable has a type that fits the query; types of shader, primitive and attribute values are unknown here.
bool fits(const GatherSite::Output& o) {
    const bool number = o.of == Of::Length || o.of == Of::SkySolidAngle;
    if (o.of == Of::Surface || o.of == Of::Displacement || o.of == Of::Volume || o.of == Of::Primitive || o.of == Of::Attribute)
        return true;
    return o.elements == 0 && !o.open && o.kind == (number ? rsl::ir::Kind::Float : rsl::ir::Kind::Triple);
}

/// Reads the outputs of an iteration: results that begin with '?' are flags, followed by their values.
void readOutputs(const rsl::ir::Site& turn, GatherSite& g, const std::function<void(const std::string&)>& unknown,
                 const std::function<void(const std::string&)>& unfit) {
    int row = 0;
    GatherSite::Output* open = nullptr;
    std::vector<std::string> names;
    for (size_t r = 0; r < turn.resultKinds.size(); ++r) {
        const std::string& name = turn.resultNames[r];
        const int rows = rsl::ir::components(turn.resultKinds[r]);
        if (!name.empty() && name[0] == '?') {
            open = nullptr;
            if (const auto known = meaning(name.substr(1))) {
                open = &g.outputs.emplace_back();
                names.push_back(name.substr(1));
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
    for (size_t k = 0; k < names.size(); ++k)
        if (!fits(g.outputs[k])) unfit(names[k]);
}

/// Reads the values that the rays of a gather() take along. Elements of an array stand one behind the other, behind its length.
void readSent(const SiteInfo& i, GatherSite& g) {
    g.sent.clear();
    for (const std::string& pair : i.site->names) {
        const rsl::PairName name = rsl::PairName::parse(pair);
        const auto at = i.named.find(pair);
        if (name.kind != rsl::PairName::Kind::Send || at == i.named.end()) continue;
        rsl::ir::Kind kind = rsl::ir::Kind::Float;
        int begin = 0;
        for (const rsl::ir::Kind k : i.site->argKinds) {
            if (begin == at->second) kind = k;
            begin += rsl::ir::components(k);
        }
        if (name.length) g.sent.push_back({name.to, name.name, kind, -1, at->second, 0});
        else if (name.element < 0) g.sent.push_back({name.to, name.name, kind, at->second, -1, 1});
        else if (GatherSite::Sent& array = g.sent.back(); ++array.elements == 1) array.kind = kind, array.row = at->second;
    }
    std::erase_if(g.sent, [](const GatherSite::Sent& s) { return s.row < 0; }); // arrays without room
}

} // namespace

void linkGathers(BoundKernel& b, const rsl::CompiledKernel& k, const WorldImpl& world) {
    std::map<std::string, std::shared_ptr<GatherSite>> known;
    const auto numberOf = [](const SiteInfo& i) {
        const auto n = i.text.find(rsl::kPairGather);
        return n == i.text.end() ? std::string() : n->second;
    };
    const auto warn = [&](const SiteInfo& i, const std::string& what, const std::string& hint) {
        const rsl::Place& at = i.site->place;
        const SourcePlace place{at.file >= 0 && at.file < int(k.files().size()) ? k.files()[size_t(at.file)] : "", at.line,
                                at.column};
        world.diagnostics().reportOnce("gather:" + what + place.file + std::to_string(place.line),
                                       {Severity::Warning, Rie::BadToken, place, "gather: " + what, hint, {}});
    };
    for (SiteInfo& i : b.sites) {
        if (i.kind != SiteKind::Gather && i.kind != SiteKind::GatherIteration) continue;
        auto& g = known[numberOf(i)];
        if (!g) g = std::make_shared<GatherSite>();
        i.gather = g;
        g->number = std::atoi(numberOf(i).c_str());
        if (i.kind == SiteKind::GatherIteration) {
            g->outputs.clear();
            const auto unknown = [&](const std::string& name) {
                warn(i, "\"" + name + "\" is not known; the variable is not changed",
                     "names begin with surface: displacement: volume: primitive: attribute: ray: environment:");
            };
            readOutputs(*i.site, *g, unknown, [&](const std::string& name) {
                warn(i, "the variable of \"" + name + "\" has another type; it is not changed",
                     "ray:length and environment:solidangle are floats; the others a colour, a point or a vector");
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
            const auto map = world.textures().open(category.substr(kSky.size()), world.settings().texturePaths, place);
            g->sky = &world.skyMaps().of(map, world.textures().latLong());
        } else if (!category.empty() && category != "illuminance") {
            warn(i, "the category \"" + category + "\" is not known; \"illuminance\" is used",
                 "illuminance, samplepattern, environment:MAP");
        }
        if (const auto d = i.text.find("distribution"); d != i.text.end()) {
            g->cosine = d->second == "cosine";
            if (!g->cosine && d->second != "uniform")
                warn(i, "the distribution \"" + d->second + "\" is not known; uniform is used", "uniform, cosine");
        }
        readSent(i, *g);
        if (const auto t = i.named.find("othreshold"); t != i.named.end()) g->threshold = t->second;
    }
}

/// Whether what is sent to a parameter comes as an input of its own: it may have another value at each point, which texts have
/// not in kernels otherwise, nor arrays another length.
static bool apart(const rsl::ParameterInfo& p) { return p.type.base == shadeops::Base::String || p.open || p.type.array < 0; }

std::vector<std::string> GatheredNames::withSent(std::vector<std::string> varying, const ShaderInstance& shader,
                                                 rsl::PairName::To to) const {
    for (const auto& p : shader.program->parameters()) {
        const bool number = !apart(p);
        if (number && sent.contains({to, p.name}) && std::find(varying.begin(), varying.end(), p.name) == varying.end())
            varying.push_back(p.name);
    }
    std::sort(varying.begin(), varying.end());
    return varying;
}

std::vector<rsl::SentParameter> GatheredNames::sentTexts(const ShaderInstance& shader, rsl::PairName::To to) const {
    std::vector<rsl::SentParameter> all;
    for (const auto& p : shader.program->parameters())
        if (const auto s = sent.find({to, p.name}); s != sent.end() && apart(p) && !p.handle) all.push_back({p.name, s->second});
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return all;
}

void GatheredNames::add(const std::string& name, int length) {
    if (const rsl::PairName pair = rsl::PairName::parse(name); pair.kind == rsl::PairName::Kind::Send) {
        int& room = sent[{pair.to, pair.name}];
        room = std::max({room, 1, length < 0 ? limits::kResizableArray : length});
    }
    if (const auto known = meaning(name))
        if (known->first == Of::Surface || known->first == Of::Displacement)
            (known->first == Of::Surface ? surface : displacement).insert(known->second);
}

bool gatheredNames(const rsl::Program& p, GatheredNames& all) {
    bool made = false;
    std::set<std::string> texts;
    const auto in = [&](const rsl::StmtPtr& body) {
        if (!body) return;
        rsl::front::everyStmt(
            *body,
            [&](const rsl::Stmt& s) {
                if (s.kind != rsl::StmtKind::Gather) return;
                for (const rsl::NamedArg& a : s.pairs) {
                    made |= a.named == rsl::NamedArg::Name::Made;
                    if (a.value) all.add(a.name, a.value->type.array);
                }
            },
            [&](const rsl::Expr& e) {
                if (e.kind == rsl::ExprKind::String) texts.insert(e.text);
            });
    };
    rsl::front::everyFunction(p, [&](const rsl::Function& f) { in(f.body); });
    for (const auto& s : p.shaders) {
        in(s->body);
        for (const rsl::ShaderParameter& q : s->parameters)
            if (q.defaultValue && q.defaultValue->kind == rsl::ExprKind::String) texts.insert(q.defaultValue->text);
    }
    for (const std::string& t : texts)
        if (made) all.add(t, -1);
    return made;
}

} // namespace alpenglow::world
