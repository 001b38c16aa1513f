#include "pointcloud/brickmap.h"
#include "base/file.h"
#include "base/randomfile.h"
#include "pointcloud/brickparts.h"
#include "pointcloud/bytes.h"
#include "pointcloud/cloudfile.h"
#include "pointcloud/limits.h"
#include "pointcloud/pointtree.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <list>
#include <map>
#include <mutex>
#include <sys/stat.h>
#include <unistd.h>

namespace alpenglow::pointcloud {

namespace {

class BrickMap final : public CloudMap {
public:
    BrickMap(const std::string& path, Diagnostics& d, SourcePlace place, size_t cacheBytes)
        : path_(path), diagnostics_(d), place_(std::move(place)), file_(path), most_(cacheBytes) {}
    /// Returns "", or an error message.
    std::string readDirectory();
    BrickFacts facts() const;
    const std::vector<Channel>& channels() const override { return channels_; }
    bool lookup(const Query& q, std::span<float> out) const override {
        const int levels = int(largest_.size());
        int depth = std::min(depthFor(side_, q.radius), levels - 1);
        if (q.maxDepth >= 0) depth = std::min(depth, q.maxDepth);
        const double reach = double(q.radius) + 2 * double(largest_[size_t(depth)]);
        uint32_t lo[3], hi[3];
        for (int k = 0; k < 3; ++k) {
            lo[k] = brickOf(double(q.P[k]) - reach, corner_[k], side_, depth);
            hi[k] = brickOf(double(q.P[k]) + reach, corner_[k], side_, depth);
        }
        double weight = 0;
        std::vector<double> sums(out.size());
        const double boxes = (1.0 + hi[0] - lo[0]) * (1.0 + hi[1] - lo[1]) * (1.0 + hi[2] - lo[2]);
        if (boxes > double(bricks_.size())) { // the same in the same order
            for (const Brick& b : bricks_) {
                bool near = b.at[0] == uint32_t(depth);
                for (size_t k = 0; k < 3; ++k) near &= b.at[k + 1] >= lo[k] && b.at[k + 1] <= hi[k];
                if (near) brick(b.at)->gather(q, &weight, sums);
            }
            return meanOf(weight, sums, out);
        }
        for (uint32_t x = lo[0]; x <= hi[0]; ++x)
            for (uint32_t y = lo[1]; y <= hi[1]; ++y)
                for (uint32_t z = lo[2]; z <= hi[2]; ++z)
                    if (const auto tree = brick({uint32_t(depth), x, y, z})) tree->gather(q, &weight, sums);
        return meanOf(weight, sums, out);
    }

private:
    std::shared_ptr<const PointTree> brick(const BrickPlace&) const;
    std::shared_ptr<const PointTree> load(const Brick&) const;
    std::string path_;
    Diagnostics& diagnostics_;
    SourcePlace place_;
    RandomFile file_;
    size_t most_;
    std::vector<Channel> channels_;
    int width_ = 0;
    Vec3 corner_;
    float side_ = 0;
    std::vector<float> largest_; ///< by level
    std::vector<Brick> bricks_;
    struct Kept {
        std::shared_ptr<const PointTree> tree;
        std::list<uint32_t>::iterator use;
    };
    mutable std::mutex mutex_; ///< guards the cache of bricks: a brick is the same whenever it is read
    mutable std::map<uint32_t, Kept> kept_;
    mutable std::list<uint32_t> used_; ///< most recently used first
    mutable size_t bytes_ = 0;
};

BrickFacts BrickMap::facts() const {
    BrickFacts f{channels_, largest_.size(), bricks_.size(), 0, corner_, side_};
    for (const Brick& b : bricks_)
        if (b.at[0] + 1 == largest_.size()) f.points += b.points;
    return f;
}

std::string BrickMap::readDirectory() {
    std::vector<uint8_t> b;
    if (!file_.regular() || file_.size() < kBrickFixed + kBrickEnd || !file_.read(0, kBrickFixed, b)) return "it is cut short";
    if (takeNumber<uint32_t>(&b[8]) != kBrickVersion) return "it has another version than this program reads";
    const uint32_t channels = takeNumber<uint32_t>(&b[12]), levels = takeNumber<uint32_t>(&b[16]);
    const uint32_t bricks = takeNumber<uint32_t>(&b[36]), header = takeNumber<uint32_t>(&b[40]);
    corner_ = takeVec(&b[20]);
    side_ = takeFloat(&b[32]);
    if (header < kBrickFixed + kBrickEnd || header > file_.size()) return "it is cut short";
    if (!file_.read(0, header, b)) return "it cannot be read";
    const std::span<const uint8_t> head(b.data(), header - kBrickEnd);
    if (checksum(head) != takeNumber<uint32_t>(&b[header - kBrickEnd])) return "its header is damaged";
    if (levels < 1 || levels > uint32_t(kDeepest) || !std::isfinite(dot(corner_, Vec3(1))) || !(side_ >= 0) ||
        !std::isfinite(side_))
        return "its header is damaged";
    size_t at = kBrickFixed;
    if (std::string fault = unpackChannels(head, channels, &at, channels_); !fault.empty()) return fault;
    width_ = width();
    if (head.size() != at + levels * 4 + uint64_t(bricks) * kOfBrick) return "its header does not match its bricks";
    for (uint32_t i = 0; i < levels; ++i, at += 4) largest_.push_back(takeFloat(&b[at]));
    for (const float r : largest_)
        if (!(r >= 0) || !std::isfinite(r)) return "its header is damaged";
    const uint64_t record = 28 + 4 * uint64_t(width_);
    for (uint32_t i = 0; i < bricks; ++i, at += kOfBrick) {
        Brick k;
        for (size_t n = 0; n < 4; ++n) k.at[n] = takeNumber<uint32_t>(&b[at + 4 * n]);
        k.points = takeNumber<uint32_t>(&b[at + 16]);
        k.offset = takeNumber<uint64_t>(&b[at + 20]);
        k.crc = takeNumber<uint32_t>(&b[at + 28]);
        if (k.at[0] >= levels || k.offset > file_.size() || k.points * record > file_.size() - k.offset) return "it is cut short";
        if (!bricks_.empty() && bricks_.back().at >= k.at) return "its bricks are not in order";
        bricks_.push_back(k);
    }
    return "";
}

std::shared_ptr<const PointTree> BrickMap::load(const Brick& k) const {
    const size_t record = 28 + 4 * size_t(width_);
    std::vector<uint8_t> b;
    bool fine = file_.read(k.offset, k.points * record, b) && checksum(b) == k.crc;
    PointCloud cloud;
    cloud.channels = channels_;
    std::vector<float> room(static_cast<size_t>(width_));
    for (size_t i = 0; fine && i < k.points; ++i) fine = unpackPoint(b.data() + i * record, width_, room, cloud);
    if (fine) return std::make_shared<const PointTree>(std::move(cloud));
    diagnostics_.reportOnce(
        "brick:" + path_,
        {Severity::Error,
         Rie::BadFile,
         place_,
         "brick map \"" + path_ + "\": some of its bricks are damaged, or the file has changed; these bricks are empty",
         "alpenglow ptc brick makes it again",
         {}});
    return std::make_shared<const PointTree>();
}

/// Returns null if there is none at this position.
std::shared_ptr<const PointTree> BrickMap::brick(const BrickPlace& at) const {
    const auto found =
        std::lower_bound(bricks_.begin(), bricks_.end(), at, [](const Brick& b, const BrickPlace& p) { return b.at < p; });
    if (found == bricks_.end() || found->at != at) return nullptr;
    const uint32_t number = uint32_t(found - bricks_.begin());
    const std::lock_guard lock(mutex_);
    if (const auto kept = kept_.find(number); kept != kept_.end()) {
        used_.splice(used_.begin(), used_, kept->second.use);
        return kept->second.tree;
    }
    auto tree = load(*found);
    used_.push_front(number);
    kept_[number] = {tree, used_.begin()};
    bytes_ += tree->bytes();
    while (bytes_ > most_ && used_.size() > 1) {
        const auto last = kept_.find(used_.back());
        bytes_ -= last->second.tree->bytes();
        kept_.erase(last);
        used_.pop_back();
    }
    return tree;
}

} // namespace

bool isBrickMap(const std::string& path) {
    char head[8];
    std::FILE* f = std::fopen(path.c_str(), "rb");
    if (!f) return false;
    const bool is = std::fread(head, 1, 8, f) == 8 && std::memcmp(head, kBrickMagic, 8) == 0;
    std::fclose(f);
    return is;
}

std::shared_ptr<const CloudMap> openBrickMap(const std::string& path, Diagnostics& d, const SourcePlace& place,
                                             size_t cacheBytes) {
    auto map = std::make_shared<BrickMap>(path, d, place, cacheBytes);
    const std::string fault = map->readDirectory();
    if (fault.empty()) return map;
    d.report(Severity::Error, Rie::BadFile, place, "brick map \"" + path + "\" cannot be read: " + fault,
             "alpenglow ptc brick makes it again");
    return nullptr;
}

std::optional<BrickFacts> brickFacts(const std::string& path, Diagnostics& d) {
    BrickMap map(path, d, {}, 0);
    const std::string fault = map.readDirectory();
    if (fault.empty()) return map.facts();
    d.report(Severity::Error, Rie::BadFile, {}, "brick map \"" + path + "\" cannot be read: " + fault,
             "alpenglow ptc brick makes it again");
    return {};
}

std::vector<uint8_t> brickHead(std::span<const Channel> of, std::span<const float> largest, const Vec3& corner, float side,
                               std::span<const Brick> bricks, uint64_t record) {
    const std::vector<uint8_t> channels = packChannels(of);
    const size_t header = kBrickFixed + channels.size() + 4 * largest.size() + kOfBrick * bricks.size() + kBrickEnd;
    uint64_t offset = header;
    std::vector<uint8_t> head(kBrickMagic, kBrickMagic + 8);
    for (const uint32_t v : {kBrickVersion, uint32_t(of.size()), uint32_t(largest.size())}) putNumber(head, v);
    putVec(head, corner);
    putFloat(head, side);
    putNumber(head, uint32_t(bricks.size()));
    putNumber(head, uint32_t(header));
    head.insert(head.end(), channels.begin(), channels.end());
    for (const float r : largest) putFloat(head, r);
    for (const Brick& b : bricks) {
        for (const uint32_t v : b.at) putNumber(head, v);
        putNumber(head, b.points);
        putNumber(head, offset);
        putNumber(head, b.crc);
        offset += b.points * record;
    }
    putNumber(head, checksum(head));
    return head;
}

bool saveBrickMap(const std::string& name, const PointCloud& cloud, const OutputPolicy& policy, Diagnostics& d,
                  const SourcePlace& place) {
    Vec3 corner;
    float side = 0;
    cubeAbout(cloud, &corner, &side);
    const int deepest = deepestOf(cloud.radius, side);
    std::vector<PointCloud> levels(size_t(deepest) + 1);
    for (int depth = deepest; depth >= 0; --depth) // each from the next finer one: means by area of means by area
        levels[size_t(depth)] = coarser(depth == deepest ? cloud : levels[size_t(depth) + 1], corner, side, depth);
    const uint64_t record = 28 + 4 * uint64_t(cloud.width());
    std::vector<Brick> bricks;
    std::vector<std::vector<uint8_t>> points;
    std::vector<float> largest;
    for (int depth = 0; depth <= deepest; ++depth) {
        const PointCloud& level = levels[size_t(depth)];
        largest.push_back(level.size() ? *std::max_element(level.radius.begin(), level.radius.end()) : 0.f);
        for (const auto& [at, of] : bricksOf(level, corner, side, depth)) {
            std::vector<uint8_t>& packed = points.emplace_back();
            for (const uint32_t i : of) packPoint(level, i, packed);
            bricks.push_back({at, uint32_t(of.size()), 0, checksum(packed)});
        }
    }
    const std::vector<uint8_t> head = brickHead(cloud.channels, largest, corner, side, bricks, record);
    auto file = OutputFile::open(name, policy, d, place);
    if (!file) return false;
    file->write(head.data(), head.size());
    for (const auto& p : points)
        if (!file->write(p.data(), p.size())) break;
    return file->commit(d);
}

} // namespace alpenglow::pointcloud
