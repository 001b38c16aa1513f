#include "world/pointsite.h"
#include "world/impl.h"

namespace alpenglow::world {

pointcloud::DiskSides diskSides(const std::string& word) {
    if (word == "front") return pointcloud::DiskSides::Front;
    return word == "back" || word == "reversed" ? pointcloud::DiskSides::Back : pointcloud::DiskSides::Both;
}

bool readsPoints(const SiteInfo& i) {
    if (i.site->op == "subsurface") return i.text.count(rsl::kPairPoints) > 0;
    return (i.site->op == "occlusion" || i.site->op == "indirectdiffuse") && i.text.count(rsl::kPairPoints) > 0;
}

std::shared_ptr<const PointSite> pointSite(const SiteInfo& i, const rsl::CompiledKernel& k, const WorldImpl& world) {
    auto p = std::make_shared<PointSite>();
    const rsl::ir::Site& s = *i.site;
    const auto row = [&](const char* name) {
        const auto f = i.named.find(name);
        return f == i.named.end() ? -1 : f->second;
    };
    const auto text = [&](const char* name) {
        const auto f = i.text.find(name);
        return f == i.text.end() ? std::string() : f->second;
    };
    const auto result = [&](const char* name) {
        const auto f = i.resultRows.find(name);
        return f == i.resultRows.end() ? -1 : f->second;
    };
    const auto name = [&](const std::string& pair) {
        if (const auto f = i.text.find(pair); f != i.text.end()) p->names.push_back(rsl::internString(f->second));
        else if (const auto r = i.named.find(pair); r != i.named.end()) p->nameRows.push_back(r->second);
        else return false;
        return true;
    };
    name("filename");
    name("filenames");
    for (int n = 0; name("filenames[" + std::to_string(n) + "]");) ++n;
    if (const std::string space = text("coordsystem"); !space.empty()) p->space = space;
    p->spaceRow = row("coordsystem");
    std::vector<int> given; // positional arguments that are not strings
    for (size_t a = 0; a < i.rows.size(); ++a)
        if (s.argKinds[a] != rsl::ir::Kind::String) given.push_back(i.rows[a]);
    p->point = given.empty() ? -1 : given[0];
    p->normal = given.size() < 2 ? -1 : given[1];
    p->blocks = s.op == "occlusion";
    p->cone = row("coneangle") >= 0 ? row("coneangle") : row("samplecone");
    if (result("bent") >= 0 && given.size() > 2) p->cone = given[2]; // the form of AIR
    p->axis = row("axis");
    p->maxDistance = row("maxdist");
    p->maxHit = row("maxhitdist");
    p->bias = row("bias");
    p->solidAngle = row("maxsolidangle");
    p->clamp = row("clamp");
    p->sort = row("sortbleeding");
    p->fade = {row("falloff"), row("falloffmode")};
    p->sidesRow = row("hitsides");
    p->sides = diskSides(text("hitsides"));
    p->uniform = text("distribution") == "uniform";
    if (const std::string map = text("environmentmap"); !map.empty()) {
        const SourcePlace place{s.place.file < int(k.files().size()) ? k.files()[size_t(s.place.file)] : "", s.place.line,
                                s.place.column};
        p->map = world.textures().open(map, world.settings().texturePaths, place);
        if (const std::string space = text("environmentspace"); !space.empty()) world.matrix("current", space, p->toMap);
    }
    p->value = result("");
    p->environment = result("environmentcolor");
    p->openTowards = result("environmentdir") >= 0 ? result("environmentdir") : result("bent");
    p->blocked = result("occlusion");
    return p;
}

} // namespace alpenglow::world
