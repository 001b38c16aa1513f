// Maps by their names: point clouds, photon maps and Ptex files are looked up in one way.
#pragma once
#include "base/file.h"

namespace alpenglow::transport {

/// Where maps are looked up.
struct MapFiles {
    std::vector<std::string> folders; ///< behind the current one; what Option "searchpath" "texture" names
    ReadPolicy read;
};

/// What messages say of the maps of a kind.
struct MapKind {
    const char* name;         ///< "point cloud"
    const char* missing;      ///< follows `there is no <NAME>; `: what is done without it
    const char* hint;         ///< what makes such maps
    bool byBaseName = true;   ///< a file of the same name in another folder of the path serves
    const char* names = name; ///< all that may bear the name: "point cloud or brick map"
};

/// Whether there is a file of this name. `outside`: one that may not be read. Reports nothing.
std::optional<FoundFile> lookUpMap(const std::string& name, const MapFiles&, const MapKind&, std::string* outside);
/// The path of a map. Nothing: there is none, or it may not be read, which was reported; so is one that is not where its name
/// says.
std::optional<std::string> findMap(const std::string& name, const MapFiles&, const MapKind&, Diagnostics&, const SourcePlace&);

} // namespace alpenglow::transport
