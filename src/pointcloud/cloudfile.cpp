#include "pointcloud/cloudfile.h"
#include "base/file.h"
#include "pointcloud/bytes.h"
#include "pointcloud/limits.h"
#include <algorithm>
#include <cmath>
#include <cstring>

namespace alpenglow::pointcloud {

namespace {

constexpr char kMagic[] = "ALPGCLOU";
constexpr uint32_t kCloudVersion = 1;
constexpr size_t kFixed = 32, kOfPoint = 28, kEnd = 4;

bool endsWith(const std::string& s, const char* end) {
    const size_t n = std::strlen(end);
    if (s.size() < n) return false;
    for (size_t i = 0; i < n; ++i)
        if (std::tolower(static_cast<unsigned char>(s[s.size() - n + i])) != end[i]) return false;
    return true;
}

/// "" where the bytes are a cloud, which is then in `to`.
std::string readCloud(std::span<const uint8_t> b, PointCloud& to) {
    if (b.size() < kFixed + 2 * kEnd) return "it is cut short";
    if (const uint32_t v = takeNumber<uint32_t>(&b[8]); v != kCloudVersion)
        return "it has version " + std::to_string(v) + ", this program reads version " + std::to_string(kCloudVersion);
    const uint64_t count = takeNumber<uint64_t>(&b[16]), header = takeNumber<uint32_t>(&b[24]);
    const uint64_t record = takeNumber<uint32_t>(&b[28]);
    if (header < kFixed + kEnd || header > b.size() - kEnd) return "it is cut short";
    if (checksum(b.first(size_t(header) - kEnd)) != takeNumber<uint32_t>(&b[size_t(header) - kEnd]))
        return "its header is damaged";
    size_t at = kFixed;
    if (std::string fault = unpackChannels(b.first(size_t(header) - kEnd), takeNumber<uint32_t>(&b[12]), &at, to.channels);
        !fault.empty())
        return fault;
    const int width = to.width();
    if (at != header - kEnd || record != kOfPoint + 4 * uint64_t(width)) return "its header does not match its points";
    if (count > limits::kCloudPoints) return "it has more than " + std::to_string(limits::kCloudPoints) + " points";
    if (const uint64_t want = header + count * record + kEnd; b.size() != want)
        return b.size() < want ? "it is cut short" : "there is extra data after its points";
    const auto points = b.subspan(size_t(header), size_t(count * record));
    if (checksum(points) != takeNumber<uint32_t>(b.data() + b.size() - kEnd)) return "its points are damaged";
    to.reserve(size_t(count));
    std::vector<float> room(static_cast<size_t>(width));
    for (size_t i = 0; i < count; ++i)
        if (!unpackPoint(points.data() + i * record, width, room, to)) return "a point in it is not a number";
    return "";
}

} // namespace

std::vector<uint8_t> packChannels(std::span<const Channel> channels) {
    std::vector<uint8_t> to;
    for (const Channel& c : channels) {
        to.push_back(uint8_t(c.type));
        const std::string name = c.name.substr(0, 255);
        to.push_back(uint8_t(name.size()));
        to.insert(to.end(), name.begin(), name.end());
    }
    return to;
}

std::string unpackChannels(std::span<const uint8_t> b, uint32_t count, size_t* at, std::vector<Channel>& to) {
    int width = 0;
    if (count > uint32_t(limits::kCloudChannels))
        return "it has more than " + std::to_string(limits::kCloudChannels) + " channels";
    for (uint32_t i = 0; i < count; ++i) {
        if (*at + 2 > b.size() || *at + 2 + b[*at + 1] > b.size() || b[*at] > uint8_t(ChannelType::Matrix) || b[*at + 1] == 0)
            return "its channels are damaged";
        Channel c{std::string(b.begin() + long(*at) + 2, b.begin() + long(*at) + 2 + b[*at + 1]), ChannelType(b[*at])};
        *at += 2 + c.name.size();
        for (const Channel& other : to)
            if (other.name == c.name) return "it has two channels \"" + c.name + "\"";
        if ((width += sizeOf(c.type)) > limits::kCloudChannels)
            return "it has more than " + std::to_string(limits::kCloudChannels) + " numbers a point";
        to.push_back(std::move(c));
    }
    return "";
}

void packPoint(const PointCloud& cloud, size_t i, std::vector<uint8_t>& to) {
    putVec(to, cloud.P[i]);
    putVec(to, cloud.N[i]);
    putFloat(to, cloud.radius[i]);
    for (const float v : cloud.valuesOf(i)) putFloat(to, v);
}

bool unpackPoint(const uint8_t* from, int width, std::vector<float>& room, PointCloud& to) {
    const Vec3 p = takeVec(from), n = takeVec(from + 12);
    const float r = takeFloat(from + 24);
    bool fine = std::isfinite(dot(p, Vec3(1))) && std::isfinite(dot(n, n)) && std::isfinite(r) && r >= 0;
    for (int k = 0; k < width; ++k) {
        room[size_t(k)] = takeFloat(from + kOfPoint + 4 * size_t(k));
        fine &= std::isfinite(room[size_t(k)]);
    }
    if (fine) to.add(p, n, r, {room.data(), size_t(width)});
    return fine;
}

bool saveCloud(const std::string& name, const PointCloud& cloud, const OutputPolicy& policy, Diagnostics& d,
               const SourcePlace& place) {
    if (endsWith(name, ".ply")) return savePly(name, cloud, policy, d, place);
    auto file = OutputFile::open(name, policy, d, place);
    if (!file) return false;
    const std::vector<uint8_t> channels = packChannels(cloud.channels);
    std::vector<uint8_t> some(kMagic, kMagic + 8);
    putNumber(some, kCloudVersion);
    putNumber(some, uint32_t(cloud.channels.size()));
    putNumber(some, uint64_t(cloud.size()));
    putNumber(some, uint32_t(kFixed + channels.size() + kEnd));
    putNumber(some, uint32_t(kOfPoint + 4 * size_t(cloud.width())));
    some.insert(some.end(), channels.begin(), channels.end());
    putNumber(some, checksum(some));
    file->write(some.data(), some.size());
    uint32_t crc = 0;
    for (size_t at = 0; at < cloud.size() && file->ok(); at += 4096) {
        some.clear();
        for (size_t i = at; i < std::min(cloud.size(), at + 4096); ++i) packPoint(cloud, i, some);
        crc = checksum(some, crc);
        file->write(some.data(), some.size());
    }
    some.clear();
    putNumber(some, crc);
    file->write(some.data(), some.size());
    return file->commit(d);
}

std::optional<PointCloud> loadCloud(const std::string& path, Diagnostics& d, const SourcePlace& place) {
    const auto bytes = readWholeFile(path, limits::kCloudBytes, d, place);
    if (!bytes) return {};
    const auto begins = [&](const char* with) {
        return bytes->size() >= std::strlen(with) && std::memcmp(bytes->data(), with, std::strlen(with)) == 0;
    };
    PointCloud cloud;
    const std::string fault = begins(kMagic)                       ? readCloud(*bytes, cloud)
                              : begins("ply\n") || begins("ply\r") ? readPly(*bytes, cloud)
                                                                   : "it is no point cloud";
    if (fault.empty()) return cloud;
    d.report(Severity::Error, Rie::BadFile, place, "point cloud \"" + path + "\" cannot be read: " + fault,
             "bake3d() writes point clouds, and so does alpenglow ptc");
    return {};
}

} // namespace alpenglow::pointcloud
