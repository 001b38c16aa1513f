// Ptex files that a frame's shaders read.
#pragma once
#include "ptex/ptexfile.h"
#include "world/mapfiles.h"
#include <map>
#include <mutex>

namespace alpenglow::transport {

class PtexStore {
public:
    PtexStore(MapFiles files, Diagnostics& d);
    /// The file of a name, opened when it is first asked for. Null: there is none, which was reported once. Thread safe; it lives
    /// as long as the store.
    const ptex::Texture* find(const std::string& name, const SourcePlace&);

private:
    MapFiles files_;
    Diagnostics& diagnostics_;
    std::shared_ptr<ptex::Cache> cache_;
    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<const ptex::Texture>> textures_; ///< null: none
};

} // namespace alpenglow::transport
