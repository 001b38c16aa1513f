// Baked data of shaders, collected while they run in an order that does not depend on threads or batches, and written after the
// frame.
#pragma once
#include "base/diagnostics.h"
#include "pointcloud/pointcloud.h"
#include <map>
#include <mutex>

namespace alpenglow {
struct OutputPolicy;
}

namespace alpenglow::pointcloud {

/// Layout of the records of one bake() or bake3d() call.
struct BakeLayout {
    bool flat = false;             ///< bake(): s, t and the one channel; else bake3d(): P, N, radius and channels
    std::vector<Channel> channels; ///< of bake3d(); of bake() the value
    int width = 0;                 ///< numbers of the channels
    std::string where;             ///< file, line and column of the call: it orders the calls of one point
    SourcePlace place;             ///< of the call, for messages
};

/// Identifies the point of a record: grid points by shape and index, hits of camera rays by pixel.
struct BakeKey {
    bool camera = false;
    int32_t y = 0, x = 0; ///< grids: shape, point
    int32_t layers = 0;   ///< camera: surfaces before it
    uint32_t vertex = 0;  ///< of the path, as in Sampler::get2(); 0: the camera ray's hit
    uint32_t sample = 0;  ///< sample of the pixel
};

/// Who writes a file, by fileIdentity().
using FileOwners = std::map<std::string, std::string>;

/// Records of bake calls of one frame, ordered at the end, so that files do not depend on threads.
class BakeLog {
public:
    /// Adds the numbers of one call: s, t and the value; or P (3), N (3), radius and the channels, in the space of the file.
    /// Layouts must outlive the log. Returns false if the log is full, which is reported when it is written. Thread safe.
    bool add(const std::string& file, const BakeLayout&, const BakeKey&, std::span<const float> numbers);
    /// Appends records added since the last call to the earlier ones, in order of keys. Averages the samples of grid points.
    /// Removes bitwise duplicates, because points may be shaded again. Call while no thread adds.
    void commit();
    /// Whether anything was added since the last commit(). Nobody adds meanwhile.
    bool pending() const;
    /// Discards records added since the last commit(), because the samples were void.
    void discard();
    /// Calls commit(), writes all files except those of other owners, and empties the log. Returns false if a file could not be
    /// written; each is reported.
    bool write(const OutputPolicy&, Diagnostics&, FileOwners = {});
    /// Nothing was committed.
    bool empty() const { return files_.empty(); }
    /// Size of the records in memory.
    size_t bytes() const { return bytes_; }

private:
    struct Entry {
        BakeKey key;
        const BakeLayout* layout;
        size_t at; ///< in File::pending
    };
    struct Row {
        const BakeLayout* layout;
        size_t at; ///< in File::committed
    };
    struct File {
        std::vector<Entry> entries;
        std::vector<float> pending, committed;
        std::vector<Row> rows;
        uint64_t notFinite = 0;
    };
    void commit(File&);
    void count();
    bool writeFlat(const std::string& name, const File&, const OutputPolicy&, Diagnostics&) const;
    bool writeCloud(const std::string& name, const File&, const OutputPolicy&, Diagnostics&) const;
    std::mutex mutex_;
    std::map<std::string, File> files_;
    size_t bytes_ = 0;
    bool full_ = false;
};

} // namespace alpenglow::pointcloud
