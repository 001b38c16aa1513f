// Ptex files that the shaders of a frame read.
#pragma once
#include "ptex/ptexfile.h"
#include "world/mapfiles.h"
#include <map>
#include <mutex>

namespace alpenglow::world {

/// The Ptex files of a frame. Thread safe.
class PtexStore {
public:
    /// files: where names are looked up.
    PtexStore(MapFiles files, Diagnostics& d);
    /// The file of a name, opened at first use. Returns null if it does not exist, which is reported once. Thread safe; it lives
    /// as long as the store.
    const ptex::Texture* find(const std::string& name, const SourcePlace&);

private:
    MapFiles files_;
    Diagnostics& diagnostics_;
    std::shared_ptr<ptex::Cache> cache_;
    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<const ptex::Texture>> textures_; ///< null: does not exist
};

} // namespace alpenglow::world
