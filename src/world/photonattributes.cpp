#include "world/photonattributes.h"
#include <algorithm>

namespace alpenglow::world {

namespace {

const scene::Param* textOf(const scene::Attributes& a, const char* name) {
    const scene::Param* p = a.value(name);
    return p && !p->strings.empty() ? p : nullptr;
}

PhotonModel modelOf(const scene::Attributes& a, Diagnostics& d) {
    const scene::Param* p = textOf(a, "photon:shadingmodel");
    if (!p) return PhotonModel::Shader;
    static const std::pair<const char*, PhotonModel> kModels[] = {
        {"matte", PhotonModel::Matte},      {"plastic", PhotonModel::Plastic},
        {"glass", PhotonModel::Glass},      {"dielectric", PhotonModel::Glass},
        {"water", PhotonModel::Water},      {"chrome", PhotonModel::Chrome},
        {"conductor", PhotonModel::Chrome}, {"transparent", PhotonModel::Transparent}};
    for (const auto& [name, model] : kModels)
        if (p->strings[0] == name) return model;
    d.reportOnce("photonmodel:" + p->strings[0],
                 {Severity::Warning,
                  Rie::BadToken,
                  p->place,
                  "unknown shading model of photons \"" + p->strings[0] + "\"; the lobes of the surface shader are used",
                  "matte, plastic, glass, dielectric, water, chrome, conductor and transparent are known",
                  {}});
    return PhotonModel::Shader;
}

/// Attribute "visibility" "photon"; nothing: not set.
std::optional<bool> seenByPhotons(const scene::Attributes& a) {
    const scene::Param* p = a.value("visibility:photon");
    if (!p) return std::nullopt;
    if (!p->strings.empty()) return p->strings[0] != "transparent";
    return !p->numbers.empty() && p->numbers[0] != 0;
}

} // namespace

PhotonBinding photonsOf(const scene::Attributes& a, Diagnostics& d) {
    PhotonBinding b;
    if (const scene::Param* p = textOf(a, "photon:globalmap")) b.globalMap = p->strings[0];
    if (const scene::Param* p = textOf(a, "photon:causticmap")) b.causticMap = p->strings[0];
    if (const scene::Param* p = a.value("photon:estimator"); p && !p->numbers.empty())
        b.estimator = int(std::clamp(p->numbers[0], 1.f, float(photonmap::PhotonMap::kMostAsked)));
    b.model = modelOf(a, d);
    return b;
}

std::string photonKey(const scene::Attributes& a) {
    std::string key;
    for (const char* name :
         {"photon:globalmap", "photon:causticmap", "photon:shadingmodel", "photon:estimator", "visibility:photon",
          "visibility:diffuse", "visibility:specular", "visibility:trace", "render:visibility"})
        if (const scene::Param* p = a.value(name)) {
            key += name;
            if (!p->strings.empty()) key += ' ' + p->strings[0];
            if (!p->numbers.empty()) key += ' ' + std::to_string(p->numbers[0]);
            key += ';';
        }
    return key;
}

void MutableWorld::bindPhotons(std::span<const uint32_t> visibility) {
    for (size_t i = 0; i < shapes_.size(); ++i) {
        PhotonBinding& b = bindings_[size_t(bindingOf_[i])].photons;
        const uint32_t traced = visibility[i] & (accel::kDiffuse | accel::kSpecular);
        b.meets = seenByPhotons(shapes_[i]->attributes()).value_or(traced != 0);
        b.intersectsBoth = traced == (accel::kDiffuse | accel::kSpecular);
        globalMaps_ |= needs_.globalPhotons && !b.globalMap.empty();
    }
}

std::shared_ptr<const PhotonSite> photonSite(const SiteInfo& i, const rsl::CompiledKernel& k, const WorldImpl& world) {
    auto p = std::make_shared<PhotonSite>();
    const rsl::ir::Site& s = *i.site;
    const auto row = [&](const char* name) {
        const auto f = i.named.find(name);
        return f == i.named.end() ? -1 : f->second;
    };
    p->caustic = s.op == "caustic";
    size_t next = 0;
    if (!p->caustic) {
        if (!s.strings.empty()) p->name = s.strings[0];
        p->computed = p->name.empty() && !s.argKinds.empty() && s.argKinds[0] == rsl::ir::Kind::String;
        next = p->computed ? 1 : 0;
    }
    if (i.rows.size() >= next + 2) {
        p->point = i.rows[next];
        p->normal = i.rows[next + 1];
    }
    p->estimator = row("estimator");
    p->minBounces = row("mindepth");
    p->lookup = row("lookuptype");
    const auto word = i.text.find("lookuptype");
    p->radiance = word != i.text.end() && word->second == "radiance";
    const SourcePlace place{s.place.file < int(k.files().size()) ? k.files()[size_t(s.place.file)] : "", s.place.line,
                            s.place.column};
    if (word != i.text.end() && word->second != "radiance" && word->second != "irradiance")
        world.diagnostics().reportOnce("photonlookup:" + word->second,
                                       {Severity::Warning,
                                        Rie::BadToken,
                                        place,
                                        "photonmap(): unknown lookuptype \"" + word->second + "\"; irradiance is looked up",
                                        "\"irradiance\" and \"radiance\" are known",
                                        {}});
    if (p->caustic) world.photons()->asksCaustics = true;
    else world.photons()->asks(p->name, place);
    return p;
}

std::optional<bool> emitsPhotons(const BoundLight& l) {
    const scene::Param* p = l.source && l.source->attributes ? l.source->attributes->value("light:emitphotons") : nullptr;
    if (!p || p->numbers.empty()) return std::nullopt;
    return p->numbers[0] != 0;
}

} // namespace alpenglow::world
