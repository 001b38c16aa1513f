#include "world/ptexstore.h"
#include "ptex/limits.h"

namespace alpenglow::transport {

PtexStore::PtexStore(Files files, Diagnostics& d)
    : files_(std::move(files)), diagnostics_(d), cache_(ptex::makeCache(limits::kPtexCacheBytes)) {}

const ptex::Texture* PtexStore::find(const std::string& name, const SourcePlace& place) {
    if (name.empty()) return nullptr;
    std::lock_guard lock(mutex_);
    const auto [at, fresh] = textures_.try_emplace(name);
    if (!fresh) return at->second.get();
    std::vector<std::string> folders = {""};
    folders.insert(folders.end(), files_.folders.begin(), files_.folders.end());
    std::string outside;
    const auto found = findFile(name, folders, files_.read, &outside);
    if (found) {
        if (found->otherCase || found->baseNameOnly)
            diagnostics_.report(Severity::Warning, Rie::NoError, place,
                                "Ptex file \"" + name + "\" was not found as named; \"" + found->path + "\" is used");
        at->second = ptex::openTexture(found->path, cache_, diagnostics_, place);
    } else if (!outside.empty()) {
        diagnostics_.report(outsideMessage("Ptex file", name, outside, place));
    } else {
        diagnostics_.report(Severity::Error, Rie::NoFile, place, "there is no Ptex file \"" + name + "\"; ptexture() gives 0",
                            "alpenglow maketx -ptex makes such files");
    }
    return at->second.get();
}

} // namespace alpenglow::transport
