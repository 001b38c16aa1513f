#include "world/cloudsite.h"
#include "rsl/front/protocol.h"
#include "world/cloudstore.h"
#include "world/impl.h"

namespace alpenglow::world {

namespace {

pointcloud::ChannelType channelOf(shadeops::Type t) {
    switch (t.base) {
    case shadeops::Base::Color:
        return pointcloud::ChannelType::Color;
    case shadeops::Base::Point:
        return pointcloud::ChannelType::Point;
    case shadeops::Base::Vector:
        return pointcloud::ChannelType::Vector;
    case shadeops::Base::Normal:
        return pointcloud::ChannelType::Normal;
    case shadeops::Base::Matrix:
        return pointcloud::ChannelType::Matrix;
    default:
        return pointcloud::ChannelType::Float;
    }
}

/// The channel type by number of components, if the type is unknown.
pointcloud::ChannelType channelOf(rsl::ir::Kind k) {
    const int n = rsl::ir::components(k);
    return n == 3 ? pointcloud::ChannelType::Color : n == 16 ? pointcloud::ChannelType::Matrix : pointcloud::ChannelType::Float;
}

bool isOption(const std::string& name) {
    static const std::set<std::string> kOptions = {"coordsystem",  "radius",      "radiusscale", "interpolate",
                                                   "filterradius", "filterscale", "maxdepth"};
    return kOptions.count(name) > 0;
}

void noteString(const std::string& name, const SourcePlace& at, const WorldImpl& world) {
    world.diagnostics().reportOnce("bakedstring:" + name + at.file + std::to_string(at.line),
                                   {Severity::Warning,
                                    Rie::BadToken,
                                    at,
                                    "bake3d(): \"" + name + "\" is a string; it is not written",
                                    "channels are floats, colours, points, vectors, normals and matrices",
                                    {}});
}

} // namespace

std::shared_ptr<const CloudSite> cloudSite(const SiteInfo& i, const rsl::CompiledKernel& k, const WorldImpl& world) {
    auto c = std::make_shared<CloudSite>();
    const rsl::ir::Site& s = *i.site;
    pointcloud::BakeLayout& l = c->layout;
    l.place = {s.place.file < int(k.files().size()) ? k.files()[size_t(s.place.file)] : "", s.place.line, s.place.column};
    const auto row = [&](const char* name) {
        const auto f = i.named.find(name);
        return f == i.named.end() ? -1 : f->second;
    };
    if (!s.strings.empty()) c->name = s.strings[0];
    c->computed = c->name.empty() && !s.argKinds.empty() && s.argKinds[0] == rsl::ir::Kind::String;
    std::vector<size_t> given; // positional arguments that are not strings
    for (size_t a = 0; a < i.rows.size(); ++a)
        if (s.argKinds[a] != rsl::ir::Kind::String) given.push_back(a);
    const auto at = [&](size_t n) { return n < given.size() ? i.rows[given[n]] : -1; };
    c->layout.flat = i.kind == SiteKind::Bake;
    if (c->layout.flat) {
        c->s = at(0);
        c->t = at(1);
        if (given.size() > 2) {
            const auto type = given[2] < s.argTypes.size() ? channelOf(s.argTypes[given[2]]) : channelOf(s.argKinds[given[2]]);
            c->parts.push_back({"value", type, at(2)});
        }
    } else {
        c->point = at(0);
        c->normal = at(1);
        c->du = at(2);
        c->dv = at(3);
    }
    if (const auto f = i.text.find("coordsystem"); f != i.text.end()) c->space = f->second;
    c->spaceRow = row("coordsystem");
    c->radius = row(i.kind == SiteKind::Texture3d ? "filterradius" : "radius");
    c->scale = row(i.kind == SiteKind::Texture3d ? "filterscale" : "radiusscale");
    c->centres = row("interpolate");
    c->maxDepth = row("maxdepth");
    if (i.kind == SiteKind::Texture3d) {
        for (size_t r = 0; r < s.resultKinds.size(); ++r)
            if (const std::string& name = s.resultNames[r]; !name.empty() && s.resultKinds[r] != rsl::ir::Kind::String)
                c->parts.push_back({name, channelOf(s.resultKinds[r]), i.resultRows.at(name)});
    } else if (!c->layout.flat) {
        int begin = 0;
        std::map<int, size_t> argument; // by row
        for (size_t a = 0; a < s.argKinds.size(); begin += rsl::ir::components(s.argKinds[a++])) argument[begin] = a;
        for (const std::string& name : s.names) { // in order of the call
            const int r = row(name.c_str());
            if (isOption(name) || name == rsl::kPairSteady) continue;
            const size_t a = r < 0 ? s.argKinds.size() : argument.at(r);
            if (i.text.count(name) || (r >= 0 && s.argKinds[a] == rsl::ir::Kind::String)) noteString(name, l.place, world);
            if (r < 0 || s.argKinds[a] == rsl::ir::Kind::String) continue;
            c->parts.push_back({name,
                                a < s.argTypes.size() && s.argTypes[a].base != shadeops::Base::Void ? channelOf(s.argTypes[a])
                                                                                                    : channelOf(s.argKinds[a]),
                                r});
        }
    }
    char where[64];
    std::snprintf(where, sizeof where, ":%08d:%06d", l.place.line, l.place.column);
    l.where = l.place.file + where;
    for (const CloudSite::Part& p : c->parts) {
        l.channels.push_back({p.name, p.type});
        l.width += pointcloud::sizeOf(p.type);
    }
    const auto area = [](const pointcloud::Channel& a) { return a.name == "_area"; };
    if (i.kind == SiteKind::Bake3d && std::none_of(l.channels.begin(), l.channels.end(), area)) {
        c->addsArea = true;
        l.channels.push_back({"_area", pointcloud::ChannelType::Float});
        ++l.width;
    }
    c->writes = i.kind != SiteKind::Texture3d && (c->computed || !c->name.empty());
    c->steady = i.text.count(rsl::kPairSteady) > 0;
    return c;
}

} // namespace alpenglow::world
