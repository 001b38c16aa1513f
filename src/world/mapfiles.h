// Looks up map files by name: point clouds, photon maps and Ptex files.
#pragma once
#include "base/file.h"
#include "world/names.h"

namespace alpenglow::world {

/// Where maps are looked up.
struct MapFiles {
    std::vector<std::string> folders; ///< searched after the current folder; from Option "searchpath" "texture"
    ReadPolicy read;                  ///< where names may lead
};

/// Texts for messages about a kind of map.
struct MapKind {
    const char* name;         ///< "point cloud"
    const char* missing;      ///< follows `there is no <NAME>; `: what happens without it
    const char* hint;         ///< how to make such maps
    bool byBaseName = true;   ///< accepts a file of the same name in another folder of the path
    const char* names = name; ///< all kinds of files with such names: "point cloud or brick map"
};

/// Whether a file of this name exists. `outside`: set to a path that may not be read. Reports nothing.
std::optional<FoundFile> lookUpMap(const std::string& name, const MapFiles&, const MapKind&, std::string* outside);
/// The path of a map. Returns nothing if it does not exist or may not be read, which is reported; so is a map found in another
/// place than its name says.
std::optional<std::string> findMap(const std::string& name, const MapFiles&, const MapKind&, Diagnostics&, const SourcePlace&);

} // namespace alpenglow::world
