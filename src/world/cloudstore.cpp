#include "world/cloudstore.h"

namespace alpenglow::transport {

const clouds::CloudMap* CloudStore::find(const std::string& name, const SourcePlace& place) {
    if (name.empty()) return nullptr;
    std::lock_guard lock(mutex_);
    const auto [at, fresh] = maps_.try_emplace(name);
    if (!fresh) return at->second.get();
    std::vector<std::string> folders = {""};
    folders.insert(folders.end(), files_.folders.begin(), files_.folders.end());
    std::string outside;
    const auto found = findFile(name, folders, files_.read, &outside);
    if (found) {
        if (found->otherCase || found->baseNameOnly)
            diagnostics_.report(Severity::Warning, Rie::NoError, place,
                                "point cloud \"" + name + "\" was not found as named; \"" + found->path + "\" is used");
        at->second = clouds::openMap(found->path, diagnostics_, place);
    } else if (!outside.empty()) {
        diagnostics_.report(outsideMessage("point cloud", name, outside, place));
    } else {
        diagnostics_.report(Severity::Error, Rie::NoFile, place,
                            "there is no point cloud or brick map \"" + name + "\"; texture3d() gives 0",
                            "bake3d() in a frame before this one makes it");
    }
    return at->second.get();
}

} // namespace alpenglow::transport
