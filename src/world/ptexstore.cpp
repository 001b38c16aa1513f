#include "world/ptexstore.h"
#include "ptex/limits.h"

namespace alpenglow::world {

PtexStore::PtexStore(MapFiles files, Diagnostics& d)
    : files_(std::move(files)), diagnostics_(d), cache_(ptex::makeCache(limits::kPtexCacheBytes)) {}

const ptex::Texture* PtexStore::find(const std::string& name, const SourcePlace& place) {
    if (name.empty()) return nullptr;
    std::lock_guard lock(mutex_);
    const auto [at, fresh] = textures_.try_emplace(name);
    if (!fresh) return at->second.get();
    static constexpr MapKind kPtexFile{"Ptex file", "ptexture() returns 0", "alpenglow maketx -ptex makes such files"};
    if (const auto path = findMap(name, files_, kPtexFile, diagnostics_, place))
        at->second = ptex::openTexture(*path, cache_, diagnostics_, place);
    return at->second.get();
}

} // namespace alpenglow::world
