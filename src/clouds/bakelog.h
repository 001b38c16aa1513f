// What shaders bake, collected while they run, in an order that no thread and no batch decides, and written when the frame is
// done.
#pragma once
#include "base/diagnostics.h"
#include "clouds/pointcloud.h"
#include <map>
#include <mutex>

namespace alpenglow {
struct OutputPolicy;
}

namespace alpenglow::clouds {

/// What one call of bake() or bake3d() writes.
struct BakeLayout {
    bool flat = false; ///< bake(): s, t and the one channel; else bake3d(): P, N, radius and channels
    std::vector<Channel> channels;
    int width = 0;     ///< numbers of the channels
    std::string where; ///< file, line and column of the call: it orders the calls of one point
    SourcePlace place;
};

/// To which point a record belongs: points of grids by shape and number, points that camera rays meet by pixel.
struct BakeKey {
    bool camera = false;
    int32_t y = 0, x = 0; ///< grids: shape, point
    int32_t layers = 0;   ///< camera: surfaces before it
    uint32_t vertex = 0;
    uint32_t sample = 0;
};

/// Who writes a file, by fileIdentity().
using FileOwners = std::map<std::string, std::string>;

class BakeLog {
public:
    /// The numbers of one call: s, t and the value; or P (3), N (3), radius and the channels, in the space of the file. Layouts
    /// outlive the log. False: nothing is kept any more, which is reported when it is written. Thread safe.
    bool add(const std::string& file, const BakeLayout&, const BakeKey&, std::span<const float> numbers);
    /// Puts what was added since the last call behind what was there, in the order of the keys. Of points of grids the samples
    /// are averaged. What was added twice, bit by bit, is kept once: points may be shaded again. Nobody adds meanwhile.
    void settle();
    /// Whether anything was added since the last settle(). Nobody adds meanwhile.
    bool pending() const;
    /// Forgets what was added since the last settle(): the samples were void.
    void discard();
    /// Settles, and writes all files but those that somebody else writes; then the log is empty. False: an error was reported for
    /// each that was not written.
    bool write(const OutputPolicy&, Diagnostics&, FileOwners = {});
    bool empty() const { return files_.empty(); }
    /// Of what is kept, in memory.
    size_t bytes() const { return bytes_; }

private:
    struct Entry {
        BakeKey key;
        const BakeLayout* layout;
        size_t at; ///< in File::pending
    };
    struct Row {
        const BakeLayout* layout;
        size_t at; ///< in File::settled
    };
    struct File {
        std::vector<Entry> entries;
        std::vector<float> pending, settled;
        std::vector<Row> rows;
        uint64_t notFinite = 0;
    };
    void settle(File&);
    void count();
    bool writeFlat(const std::string& name, const File&, const OutputPolicy&, Diagnostics&) const;
    bool writeCloud(const std::string& name, const File&, const OutputPolicy&, Diagnostics&) const;
    std::mutex mutex_;
    std::map<std::string, File> files_;
    size_t bytes_ = 0;
    bool full_ = false;
};

} // namespace alpenglow::clouds
