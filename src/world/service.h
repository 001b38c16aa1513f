// A service: a shadeop that the renderer answers at once. services/table.cpp lists the descriptors; a world gets the list when it
// is built, because the answers are above it.
#pragma once
#include "world/sites.h"
#include <span>
#include <string_view>

namespace alpenglow::services {
class Services;
class ServiceCall;
} // namespace alpenglow::services

namespace alpenglow::world {

/// What a service needs, as bits.
enum ServiceTrait : unsigned {
    kWithoutScene = 1,   ///< also answers where there is no scene (alpenglow eval and shade); otherwise the result there is 0
    kSendsNothing = 2,   ///< needs neither rays nor points of complete surfaces
    kAsksNoLight = 4,    ///< neither requests light nor queries lights
    kReadsFacePlaces = 8 ///< reads positions of points on faces
};

/// What a service has resolved for a call site. Each service derives its own.
struct ServiceSite {
    virtual ~ServiceSite() = default;
};

/// The descriptor of a service.
struct Service {
    std::string_view shadeop; ///< name of the shadeop that it answers
    SiteKind kind;            ///< SiteKind::Service unless other stages ask for it
    unsigned traits;          ///< ServiceTrait
    /// Answers a call for the points of its mask. Runs on several threads, takes no lock, compares no strings.
    void (*answer)(services::Services&, const services::ServiceCall&);
    /// Resolves a call site when its kernel is bound; null: there is nothing to resolve.
    void (*bind)(SiteInfo&, const rsl::CompiledKernel&, const WorldImpl&) = nullptr;
};
using ServiceTable = std::span<const Service>;

/// The service that answers a shadeop; null: none.
inline const Service* findService(ServiceTable table, std::string_view shadeop) {
    for (const Service& s : table)
        if (s.shadeop == shadeop) return &s;
    return nullptr;
}

// Binders of map lookups, photon maps, and point clouds and volumes.
void bindMap(SiteInfo&, const rsl::CompiledKernel&, const WorldImpl&);
void bindPhotonMap(SiteInfo&, const rsl::CompiledKernel&, const WorldImpl&);
void bindCloud(SiteInfo&, const rsl::CompiledKernel&, const WorldImpl&);

} // namespace alpenglow::world
