// Point clouds and brick maps that a frame's shaders read, and what they bake.
#pragma once
#include "base/file.h"
#include "clouds/bakelog.h"
#include "clouds/map.h"

namespace alpenglow::transport {

class CloudStore {
public:
    /// Where files are looked for, as textures are.
    struct Files {
        std::vector<std::string> folders;
        ReadPolicy read;
    };
    CloudStore(Files files, Diagnostics& d) : files_(std::move(files)), diagnostics_(d) {}
    /// The map of a name, read when it is first asked for. Null: there is none, which was reported once. Thread safe; the map
    /// lives as long as the store.
    const clouds::CloudMap* find(const std::string& name, const SourcePlace&);

    clouds::BakeLog baked;
    /// Some kernel of a surface bakes; some of these calls may want middles of micropolygons. While the world is made.
    bool bakes = false, centres = false;

private:
    Files files_;
    Diagnostics& diagnostics_;
    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<const clouds::CloudMap>> maps_; ///< null: none
};

} // namespace alpenglow::transport
