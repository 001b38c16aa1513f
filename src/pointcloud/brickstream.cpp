#include "pointcloud/brickstream.h"
#include "base/file.h"
#include "pointcloud/brickparts.h"
#include "pointcloud/bytes.h"
#include "pointcloud/cloudfile.h"
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <span>

namespace alpenglow::pointcloud {

namespace {

constexpr size_t kSlice = size_t(1) << 20; ///< bytes read or written at once
constexpr int kDeepestCubes = 7;           ///< of the cubes that the cloud is sorted into

struct Close {
    void operator()(std::FILE* f) const { std::fclose(f); }
};
using Handle = std::unique_ptr<std::FILE, Close>;

/// A point cloud that is read a slice at a time.
class Part {
public:
    explicit Part(const std::string& path) : file_(std::fopen(path.c_str(), "rb")) {}
    std::string open();
    const std::vector<Channel>& channels() const { return channels_; }
    uint64_t points() const { return count_; }
    size_t record() const { return record_; }
    /// f(the bytes of a point), for all. "": fine.
    std::string each(const std::function<void(const uint8_t*)>& f);

private:
    Handle file_;
    std::vector<Channel> channels_;
    uint64_t count_ = 0;
    size_t record_ = 0, header_ = 0;
};

/// Point clouds one behind the other, with the channels of all, as merge() joins them.
class Stream {
public:
    explicit Stream(std::span<const std::string> paths) : paths_(paths.begin(), paths.end()) {}
    /// Returns "", or an error message that names the cloud.
    std::string open();
    const std::vector<Channel>& channels() const { return all_.channels; }
    size_t record() const { return 28 + 4 * size_t(all_.width()); } ///< bytes of a point
    /// f(the bytes of a point), for all. "": fine.
    std::string each(const std::function<void(const uint8_t*)>& f);

private:
    std::vector<std::string> paths_;
    std::vector<Part> parts_;
    std::vector<std::vector<size_t>> places_; ///< by part and index of a point: its destination
    PointCloud all_;                          ///< channels only
};

/// The header as loadCloud() checks it.
std::string Part::open() {
    std::vector<uint8_t> b(32);
    if (!file_ || std::fread(b.data(), 1, 32, file_.get()) != 32) return "it is cut short";
    header_ = takeNumber<uint32_t>(&b[24]);
    record_ = takeNumber<uint32_t>(&b[28]);
    count_ = takeNumber<uint64_t>(&b[16]);
    if (takeNumber<uint32_t>(&b[8]) != 1) return "it has another version than this program reads";
    if (header_ < 36 || header_ > (1u << 20)) return "its header is damaged";
    b.resize(header_);
    if (std::fread(&b[32], 1, header_ - 32, file_.get()) != header_ - 32) return "it is cut short";
    if (checksum(std::span(b).first(header_ - 4)) != takeNumber<uint32_t>(&b[header_ - 4])) return "its header is damaged";
    size_t at = 32;
    if (std::string f = unpackChannels(std::span(b).first(header_ - 4), takeNumber<uint32_t>(&b[12]), &at, channels_); !f.empty())
        return f;
    int width = 0;
    for (const Channel& c : channels_) width += sizeOf(c.type);
    if (at != header_ - 4 || record_ != 28 + 4 * size_t(width)) return "its header does not match its points";
    if (count_ > limits::kCloudPoints) return "it has more than " + std::to_string(limits::kCloudPoints) + " points";
    return "";
}

std::string Part::each(const std::function<void(const uint8_t*)>& f) {
    if (std::fseek(file_.get(), long(header_), SEEK_SET) != 0) return "it cannot be read";
    const size_t some = std::max<size_t>(1, kSlice / record_);
    std::vector<uint8_t> b(some * record_);
    uint32_t crc = 0;
    for (uint64_t done = 0; done < count_;) {
        const size_t n = size_t(std::min<uint64_t>(some, count_ - done));
        if (std::fread(b.data(), record_, n, file_.get()) != n) return "it is cut short";
        crc = checksum(std::span(b).first(n * record_), crc);
        for (size_t i = 0; i < n; ++i) f(&b[i * record_]);
        done += n;
    }
    uint8_t end[4];
    if (std::fread(end, 1, 4, file_.get()) != 4) return "it is cut short";
    return takeNumber<uint32_t>(end) == crc ? "" : "its points are damaged";
}

std::string named(const std::string& path, const std::string& fault) {
    return "point cloud \"" + path + "\" cannot be read: " + fault;
}

std::string Stream::open() {
    std::vector<PointCloud> heads;
    uint64_t points = 0;
    for (const std::string& path : paths_) {
        if (std::string f = parts_.emplace_back(path).open(); !f.empty()) return named(path, f);
        points += parts_.back().points();
        heads.emplace_back().channels = parts_.back().channels();
    }
    if (std::string f = merge(heads, all_); !f.empty()) return f;
    if (points > limits::kCloudPoints) return "there are more than " + std::to_string(limits::kCloudPoints) + " points";
    for (const PointCloud& head : heads) {
        std::vector<size_t>& to = places_.emplace_back();
        for (const Channel& c : head.channels)
            for (int k = 0, at = all_.offsetOf(c.name); k < sizeOf(c.type); ++k) to.push_back(size_t(at + k));
    }
    return "";
}

std::string Stream::each(const std::function<void(const uint8_t*)>& f) {
    std::vector<uint8_t> b(record());
    for (size_t i = 0; i < parts_.size(); ++i) {
        const std::vector<size_t>& to = places_[i];
        const auto put = [&](const uint8_t* from) {
            std::memcpy(b.data(), from, 28);
            std::memset(&b[28], 0, b.size() - 28);
            for (size_t k = 0; k < to.size(); ++k) std::memcpy(&b[28 + 4 * to[k]], from + 28 + 4 * k, 4);
            f(b.data());
        };
        const bool same = parts_[i].channels() == all_.channels;
        if (std::string fault = same ? parts_[i].each(f) : parts_[i].each(put); !fault.empty()) return named(paths_[i], fault);
    }
    return "";
}

class Maker {
public:
    Maker(Stream& s, size_t memory) : stream_(s), most_(std::max<size_t>(1000, memory / (3 * s.record() + 64))) {}
    /// "": fine.
    std::string measure();
    std::string sort();
    void cubes();
    bool write(const std::string& name, const OutputPolicy&, Diagnostics&, const SourcePlace&);

private:
    struct Cube {
        uint64_t points = 0, at = 0; ///< at: of the first, in scratch_
    };
    uint32_t cubeOf(const uint8_t* point) const;
    void cube(const Cube&);
    void level(const PointCloud&, int depth);
    Stream& stream_;
    const size_t most_; ///< points at a time
    Vec3 corner_;
    float side_ = 0;
    int deepest_ = 0, depth_ = 0; ///< depth_: of the cubes
    std::vector<Cube> cubes_;
    Handle scratch_{std::tmpfile()}, bricksOut_{std::tmpfile()};
    uint64_t written_ = 0;
    std::vector<Brick> bricks_; ///< offset: in bricksOut_
    std::vector<float> largest_;
    PointCloud top_; ///< of the coarsest level for which cubes have complete bricks
};

std::string Maker::measure() {
    if (!scratch_ || !bricksOut_) return "there is no disk space for temporary files";
    Vec3 lo(INFINITY), hi(-INFINITY);
    std::vector<float> radii;
    bool finite = true;
    std::string fault = stream_.each([&](const uint8_t* b) {
        for (size_t at = 0; at < stream_.record(); at += 4) finite &= std::isfinite(takeFloat(b + at));
        const Vec3 p = takeVec(b);
        for (int k = 0; k < 3; ++k) {
            lo[k] = std::min(lo[k], p[k]);
            hi[k] = std::max(hi[k], p[k]);
        }
        radii.push_back(takeFloat(b + 24));
        finite &= radii.back() >= 0;
    });
    if (!fault.empty()) return fault;
    if (!finite) return "a point in it is not a number";
    corner_ = lo;
    side_ = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
    deepest_ = deepestOf(std::move(radii), side_);
    largest_.assign(size_t(deepest_) + 1, 0.f);
    return "";
}

uint32_t Maker::cubeOf(const uint8_t* point) const {
    const Vec3 p = takeVec(point);
    uint32_t at = 0;
    for (int k = 0; k < 3; ++k) at = at << depth_ | cellOf(double(p[k]), corner_[k], side_, depth_);
    return at;
}

/// Points by cube, in the order in which they were.
std::string Maker::sort() {
    const int most = std::clamp(deepest_ - kBrickLog, 0, kDeepestCubes);
    for (depth_ = 0;; ++depth_) { // counts at each depth until the fullest cube is small enough
        cubes_.assign(size_t(1) << (3 * depth_), {});
        if (std::string f = stream_.each([&](const uint8_t* b) { ++cubes_[cubeOf(b)].points; }); !f.empty()) return f;
        uint64_t fullest = 0;
        for (const Cube& c : cubes_) fullest = std::max(fullest, c.points);
        if (fullest <= most_ || depth_ >= most) break;
    }
    uint64_t at = 0;
    for (Cube& c : cubes_) {
        c.at = at;
        at += c.points;
    }
    const size_t record = stream_.record();
    std::vector<std::vector<uint8_t>> waiting(cubes_.size());
    std::vector<uint64_t> next;
    for (const Cube& c : cubes_) next.push_back(c.at);
    size_t held = 0;
    bool fine = true;
    const auto put = [&](size_t c) {
        fine &= std::fseek(scratch_.get(), long(next[c] * record), SEEK_SET) == 0 &&
                std::fwrite(waiting[c].data(), 1, waiting[c].size(), scratch_.get()) == waiting[c].size();
        next[c] += waiting[c].size() / record;
        held -= waiting[c].size();
        waiting[c] = {};
    };
    std::string fault = stream_.each([&](const uint8_t* b) {
        const uint32_t c = cubeOf(b);
        waiting[c].insert(waiting[c].end(), b, b + record);
        held += record;
        if (held > most_ * record)
            for (size_t k = 0; k < waiting.size(); ++k)
                if (!waiting[k].empty()) put(k);
    });
    for (size_t k = 0; k < waiting.size(); ++k)
        if (!waiting[k].empty()) put(k);
    return !fault.empty() ? fault : fine ? "" : "there is no disk space for temporary files";
}

void Maker::level(const PointCloud& points, int depth) {
    for (const float r : points.radius) largest_[size_t(depth)] = std::max(largest_[size_t(depth)], r);
    std::vector<uint8_t> packed;
    for (const auto& [at, of] : bricksOf(points, corner_, side_, depth)) {
        packed.clear();
        for (const uint32_t i : of) packPoint(points, i, packed);
        bricks_.push_back({at, uint32_t(of.size()), written_, checksum(packed)});
        written_ += std::fwrite(packed.data(), 1, packed.size(), bricksOut_.get());
    }
}

/// Writes the levels of a cube down to the one whose bricks have its size.
void Maker::cube(const Cube& c) {
    std::vector<uint8_t> b(stream_.record());
    std::vector<float> room((stream_.record() - 28) / 4);
    PointCloud points;
    points.channels = stream_.channels();
    points.reserve(size_t(c.points));
    if (std::fseek(scratch_.get(), long(c.at * stream_.record()), SEEK_SET) != 0) return;
    for (uint64_t i = 0; i < c.points && std::fread(b.data(), b.size(), 1, scratch_.get()) == 1; ++i)
        unpackPoint(b.data(), int(room.size()), room, points);
    const int last = depth_ > 0 ? depth_ + kBrickLog : 0;
    for (int depth = deepest_; depth >= last; --depth) {
        points = coarser(points, corner_, side_, depth);
        if (depth_ > 0 && depth == last)
            for (size_t i = 0; i < points.size(); ++i) top_.add(points.P[i], points.N[i], points.radius[i], points.valuesOf(i));
        level(points, depth);
    }
}

void Maker::cubes() {
    top_.channels = stream_.channels();
    for (const Cube& c : cubes_)
        if (c.points > 0) cube(c);
    for (int depth = depth_ + kBrickLog - 1; depth_ > 0 && depth >= 0; --depth) {
        top_ = coarser(top_, corner_, side_, depth);
        level(top_, depth);
    }
}

bool Maker::write(const std::string& name, const OutputPolicy& policy, Diagnostics& d, const SourcePlace& place) {
    std::sort(bricks_.begin(), bricks_.end(), [](const Brick& a, const Brick& b) { return a.at < b.at; });
    const std::vector<uint8_t> head = brickHead(stream_.channels(), largest_, corner_, side_, bricks_, stream_.record());
    auto file = OutputFile::open(name, policy, d, place);
    if (!file) return false;
    file->write(head.data(), head.size());
    std::vector<uint8_t> b;
    for (const Brick& k : bricks_) {
        b.resize(k.points * stream_.record());
        if (std::fseek(bricksOut_.get(), long(k.offset), SEEK_SET) != 0 ||
            std::fread(b.data(), 1, b.size(), bricksOut_.get()) != b.size()) {
            d.report(Severity::Error, Rie::System, place,
                     "brick map \"" + name + "\": there is no disk space for temporary files", "TMPDIR has too little");
            return false;
        }
        if (!file->write(b.data(), b.size())) break;
    }
    return file->commit(d);
}

bool isOurs(const std::string& path, uint64_t* bytes) {
    const Handle f(std::fopen(path.c_str(), "rb"));
    char magic[8];
    if (!f || std::fread(magic, 1, 8, f.get()) != 8 || std::fseek(f.get(), 0, SEEK_END) != 0) return false;
    *bytes = uint64_t(std::max(0L, std::ftell(f.get())));
    return std::memcmp(magic, "ALPGCLOU", 8) == 0;
}

} // namespace

bool brickMapOfFiles(std::span<const std::string> paths, const std::string& name, const OutputPolicy& policy, Diagnostics& d,
                     const SourcePlace& place, size_t memory) {
    uint64_t bytes = 0;
    bool ours = true;
    for (const std::string& path : paths) {
        uint64_t some = 0;
        ours &= isOurs(path, &some);
        bytes += some;
    }
    const auto refuse = [&](Rie code, const std::string& fault) {
        d.report(Severity::Error, code, place, "brick map \"" + name + "\": " + fault);
        return false;
    };
    if (!ours || bytes * 4 <= memory) {
        std::vector<PointCloud> from;
        for (const std::string& path : paths) {
            auto cloud = loadCloud(path, d, place);
            if (!cloud) return false;
            from.push_back(std::move(*cloud));
        }
        PointCloud all;
        if (from.size() == 1) all = std::move(from[0]);
        else if (const std::string fault = merge(from, all); !fault.empty()) return refuse(Rie::Consistency, fault);
        return saveBrickMap(name, all, policy, d, place);
    }
    Stream stream(paths);
    if (const std::string fault = stream.open(); !fault.empty()) return refuse(Rie::BadFile, fault);
    Maker maker(stream, memory);
    std::string fault = maker.measure();
    if (fault.empty()) fault = maker.sort();
    if (!fault.empty()) return refuse(Rie::BadFile, fault);
    maker.cubes();
    return maker.write(name, policy, d, place);
}

} // namespace alpenglow::pointcloud
