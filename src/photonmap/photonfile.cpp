#include "photonmap/photonfile.h"
#include "base/exact.h"
#include "base/file.h"
#include "photonmap/limits.h"
#include <bit>
#include <cstring>
#include <zlib.h>

namespace alpenglow::photonmap {

namespace {

constexpr char kMagic[8] = {'A', 'L', 'P', 'G', 'P', 'H', 'O', 'T'};
constexpr uint32_t kVersion = 1;
constexpr size_t kHeader = 36, kRecord = 36, kEnd = 4;

template <class T> void put(uint8_t* to, T v) {
    for (size_t i = 0; i < sizeof(T); ++i) to[i] = uint8_t(v >> (8 * i));
}
template <class T> T take(const uint8_t* from) {
    T v = 0;
    for (size_t i = 0; i < sizeof(T); ++i) v |= T(from[i]) << (8 * i);
    return v;
}
void putFloats(uint8_t* to, const Vec3& v) {
    for (int k = 0; k < 3; ++k) put(to + 4 * k, std::bit_cast<uint32_t>(v[k]));
}
Vec3 takeFloats(const uint8_t* from) {
    Vec3 v;
    for (int k = 0; k < 3; ++k) v[k] = std::bit_cast<float>(take<uint32_t>(from + 4 * k));
    return v;
}
Vec3 turned(const Matrix& m, uint32_t unit) { return normalize(Vec3(transformVector(m, Vec3d(unpackUnit(unit))))); }

/// Scale factor of power by a matrix: power has units of radiance times area.
float powerBehind(const Matrix& m) { return float(exact::pow(std::fabs(determinant3(m)), 2.0 / 3)); }

void pack(const Photon& p, const Matrix& m, float scale, uint8_t* to) {
    putFloats(to, Vec3(transformPoint(m, Vec3d(p.P))));
    putFloats(to + 12, p.power * scale);
    put(to + 24, packUnit(turned(m, p.from)));
    put(to + 28, packUnit(turned(m, p.normal)));
    std::memcpy(to + 32, p.reflected, 3);
    to[35] = p.bounces;
}

bool sound(const Photon& p) {
    const float sum = dot(p.P, Vec3(1)) + dot(p.power, Vec3(1));
    return std::isfinite(sum) && p.power.x >= 0 && p.power.y >= 0 && p.power.z >= 0;
}

/// Returns "" if the header is valid and matches the size of the file.
std::string faultOf(const std::vector<uint8_t>& b) {
    if (b.size() < 8 || std::memcmp(b.data(), kMagic, 8) != 0) return "it is no photon map";
    if (b.size() < kHeader + kEnd) return "it is cut short";
    if (uint32_t(crc32(0, b.data(), 32)) != take<uint32_t>(b.data() + 32)) return "its header is damaged";
    if (const uint32_t v = take<uint32_t>(b.data() + 8); v != kVersion)
        return "it has version " + std::to_string(v) + ", this program reads version " + std::to_string(kVersion);
    if (take<uint32_t>(b.data() + 12) != kRecord) return "its photons do not have the size of its version";
    const uint64_t count = take<uint64_t>(b.data() + 16);
    if (count > limits::kPhotons) return "it has more than " + std::to_string(limits::kPhotons) + " photons";
    if (const uint64_t want = kHeader + count * kRecord + kEnd; b.size() != want)
        return b.size() < want ? "it is cut short" : "something follows its photons";
    const uint8_t* first = b.data() + kHeader;
    uLong crc = crc32(0, nullptr, 0);
    for (uint64_t at = 0; at < count; at += 1u << 20)
        crc = crc32(crc, first + at * kRecord, uInt(std::min<uint64_t>(count - at, 1u << 20) * kRecord));
    return uint32_t(crc) != take<uint32_t>(first + count * kRecord) ? "its photons are damaged" : "";
}

} // namespace

bool savePhotons(const std::string& name, std::span<const Photon> photons, uint64_t emitted, const Matrix& cameraToWorld,
                 const OutputPolicy& policy, Diagnostics& d, const SourcePlace& place) {
    auto file = OutputFile::open(name, policy, d, place);
    if (!file) return false;
    uint8_t header[kHeader];
    std::memcpy(header, kMagic, 8);
    put(header + 8, kVersion);
    put(header + 12, uint32_t(kRecord));
    put(header + 16, uint64_t(photons.size()));
    put(header + 24, emitted);
    put(header + 32, uint32_t(crc32(0, header, 32)));
    file->write(header, kHeader);
    std::vector<uint8_t> some;
    const float scale = powerBehind(cameraToWorld);
    uLong crc = crc32(0, nullptr, 0);
    for (size_t at = 0; at < photons.size() && file->ok(); at += 4096) {
        const size_t n = std::min<size_t>(photons.size() - at, 4096);
        some.resize(n * kRecord);
        for (size_t i = 0; i < n; ++i) pack(photons[at + i], cameraToWorld, scale, some.data() + i * kRecord);
        crc = crc32(crc, some.data(), uInt(some.size()));
        file->write(some.data(), some.size());
    }
    uint8_t end[kEnd];
    put(end, uint32_t(crc));
    file->write(end, kEnd);
    return file->commit(d);
}

std::shared_ptr<const PhotonMap> loadPhotons(const std::string& path, const Matrix& worldToCamera, Diagnostics& d,
                                             const SourcePlace& place) {
    const auto bytes = readWholeFile(path, kHeader + limits::kPhotons * kRecord + kEnd, d, place);
    if (!bytes) return nullptr;
    std::string fault = faultOf(*bytes);
    std::vector<Photon> photons;
    if (fault.empty()) {
        const float scale = powerBehind(worldToCamera);
        photons.resize((bytes->size() - kHeader - kEnd) / kRecord);
        for (size_t i = 0; i < photons.size() && fault.empty(); ++i) {
            const uint8_t* at = bytes->data() + kHeader + i * kRecord;
            Photon& p = photons[i];
            p.P = Vec3(transformPoint(worldToCamera, Vec3d(takeFloats(at))));
            p.power = takeFloats(at + 12) * scale;
            p.from = packUnit(turned(worldToCamera, take<uint32_t>(at + 24)));
            p.normal = packUnit(turned(worldToCamera, take<uint32_t>(at + 28)));
            std::memcpy(p.reflected, at + 32, 3);
            p.bounces = at[35];
            if (!sound(p)) fault = "a photon in it is not a number, or has negative power";
        }
    }
    if (!fault.empty()) {
        d.report(Severity::Error, Rie::BadFile, place, "photon map \"" + path + "\" cannot be read: " + fault,
                 "Hider \"photon\" makes it again");
        return nullptr;
    }
    return std::make_shared<const PhotonMap>(std::move(photons));
}

} // namespace alpenglow::photonmap
