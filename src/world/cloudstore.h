// Point clouds and brick maps that the shaders of a frame read, and the data that they bake.
#pragma once
#include "pointcloud/bakelog.h"
#include "pointcloud/map.h"
#include "pointcloud/octree.h"
#include "pointcloud/shear.h"
#include "world/mapfiles.h"

namespace alpenglow::world {

/// The maps of one world. Lookups and baking are thread safe; writing is not. What running kernels leave in it (bakes, notes of
/// lookups) is read between passes only, so no picture depends on it; maps are the same whoever opens them.
class CloudStore {
public:
    /// files: where names are looked up.
    CloudStore(MapFiles files, Diagnostics& d) : files_(std::move(files)), diagnostics_(d) {}
    /// The map of this name, read at first use. Returns null if it does not exist, which is reported once. Thread safe; the map
    /// lives as long as the store.
    const pointcloud::CloudMap* find(const std::string& name, const SourcePlace&);

    /// A point cloud for point-based shadeops; `light`: with emitted or received light. Returns null if it does not exist, which
    /// is reported once. Thread safe. `shear`: converts positions to a sheared space (pointcloud/shear.h).
    std::shared_ptr<const pointcloud::PointOctree> octree(const std::string& name, bool light,
                                                          const std::optional<pointcloud::Shear>& shear, const SourcePlace&);

    /// Records a texture3d() lookup and whether it found anything. Thread safe.
    void noteLookup(const pointcloud::CloudMap*, bool found, const SourcePlace&);
    /// Maps in which no texture3d() lookup found anything, by name, each with its first call in order of file and line.
    std::vector<std::pair<std::string, SourcePlace>> foundNothing();

    pointcloud::BakeLog baked; ///< records of this frame

private:
    std::optional<std::string> pathOf(const std::string& name, const SourcePlace&);
    std::shared_ptr<const pointcloud::PointOctree> makeOctree(const std::string& name, bool light,
                                                              const std::optional<pointcloud::Shear>&, const SourcePlace&);
    MapFiles files_;
    Diagnostics& diagnostics_;
    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<const pointcloud::CloudMap>> maps_; ///< null: none
    struct Asked {
        bool found = false;
        SourcePlace place;
    };
    std::map<const pointcloud::CloudMap*, Asked> asked_; ///< by map of texture3d()
    using OctreeKey = std::tuple<std::string, bool, std::optional<pointcloud::Shear>>;
    std::map<OctreeKey, std::shared_ptr<const pointcloud::PointOctree>> octrees_; ///< null: none
    size_t sheared_ = 0;                                                          ///< number of sheared octrees in octrees_
};

} // namespace alpenglow::world
