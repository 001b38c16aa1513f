// Point clouds and brick maps that a frame's shaders read, and what they bake.
#pragma once
#include "clouds/bakelog.h"
#include "clouds/map.h"
#include "clouds/octree.h"
#include "clouds/shear.h"
#include "world/mapfiles.h"
#include <set>
#include <span>

namespace alpenglow::transport {

struct BoundLight;

class CloudStore {
public:
    CloudStore(MapFiles files, Diagnostics& d) : files_(std::move(files)), diagnostics_(d) {}
    /// The map of a name, read when it is first asked for. Null: there is none, which was reported once. Thread safe; the map
    /// lives as long as the store.
    const clouds::CloudMap* find(const std::string& name, const SourcePlace&);

    /// The cloud of a name as point-based shadeops see it; `light`: they want what its points send or get. Null: there is none,
    /// which was reported once. Thread safe. `shear`: where points stand for their space's (clouds/shear.h).
    std::shared_ptr<const clouds::PointOctree> octree(const std::string& name, bool light,
                                                      const std::optional<clouds::Shear>& shear, const SourcePlace&);

    /// Notes that texture3d() has asked a map, and whether it has found anything there. Thread safe.
    void noteLookup(const clouds::CloudMap*, bool found, const SourcePlace&);
    /// The maps in which texture3d() has found nothing wherever it asked, by name, each with the first of its calls in the order
    /// of files and lines.
    std::vector<std::pair<std::string, SourcePlace>> foundNothing();

    clouds::BakeLog baked;
    /// Some kernel of a surface bakes; some of these calls may want middles of micropolygons. While the world is made.
    bool bakes = false, centres = false;
    /// Where it is asked for, which lights were run: a few points say whether a primitive is baked, but only of what ran there.
    bool notesLights = false;
    void noteLights(const BoundLight& first, std::span<const BoundLight* const> all);
    std::set<const BoundLight*> lightsRan;

private:
    std::optional<std::string> pathOf(const std::string& name, const SourcePlace&);
    std::shared_ptr<const clouds::PointOctree> makeOctree(const std::string& name, bool light,
                                                          const std::optional<clouds::Shear>&, const SourcePlace&);
    MapFiles files_;
    Diagnostics& diagnostics_;
    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<const clouds::CloudMap>> maps_; ///< null: none
    struct Asked {
        bool found = false;
        SourcePlace place;
    };
    std::map<const clouds::CloudMap*, Asked> asked_; ///< by texture3d()
    using OctreeKey = std::tuple<std::string, bool, std::optional<clouds::Shear>>;
    std::map<OctreeKey, std::shared_ptr<const clouds::PointOctree>> octrees_; ///< null: none
    size_t sheared_ = 0;                                                      ///< of these
};

} // namespace alpenglow::transport
