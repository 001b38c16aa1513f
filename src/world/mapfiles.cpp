#include "world/mapfiles.h"

namespace alpenglow::world {

std::optional<FoundFile> lookUpMap(const std::string& name, const MapFiles& files, const MapKind& kind, std::string* outside) {
    std::vector<std::string> folders = {""};
    folders.insert(folders.end(), files.folders.begin(), files.folders.end());
    auto found = findFile(name, folders, files.read, outside);
    if (found && found->baseNameOnly && !kind.byBaseName) found.reset();
    return found;
}

std::optional<std::string> findMap(const std::string& name, const MapFiles& files, const MapKind& kind, Diagnostics& d,
                                   const SourcePlace& place) {
    std::string outside;
    const auto found = lookUpMap(name, files, kind, &outside);
    if (found) {
        if (found->otherCase || found->baseNameOnly)
            d.report(Severity::Warning, Rie::NoError, place,
                     std::string(kind.name) + " \"" + name + "\" was not found as named; \"" + found->path + "\" is used");
        return found->path;
    }
    if (!outside.empty()) d.report(outsideMessage(kind.name, name, outside, place));
    else
        d.report(Severity::Error, Rie::NoFile, place,
                 std::string("there is no ") + kind.names + " \"" + name + "\"; " + kind.missing, kind.hint);
    return {};
}

} // namespace alpenglow::world
