// Faces in memory.
#pragma once
#include "ptex/ptexfile.h"
#include <atomic>
#include <list>
#include <mutex>
#include <unordered_map>

namespace alpenglow::ptex {

/// A cache in parts, each with its own lock. The parts drop what was used longest ago.
class Cache {
public:
    /// bytes: most memory of all images together.
    explicit Cache(size_t bytes) : most_(bytes) {}
    using Ref = std::shared_ptr<const Image>;             ///< an image stays alive while somebody holds it
    static constexpr uint32_t kWhole = ~0u, kTable = ~1u; ///< for Key::tile: the complete face, or the table of its tiles
    /// A face of a file at a resolution.
    struct Key {
        uint64_t texture; ///< of number()
        uint32_t face;
        int halvings;           ///< how often its sides were halved
        uint32_t tile = kWhole; ///< or kTable
        bool operator==(const Key&) const = default;
    };
    uint64_t number() { return next_++; } ///< for Key::texture
    /// Null: it is not here.
    Ref find(const Key&);
    /// Adds a face, which find() then returns until it is dropped. tableBytes: memory beyond its pixels.
    void keep(const Key&, const Ref&, size_t tableBytes = 0);

private:
    static constexpr size_t kParts = 16;
    struct Hash {
        size_t operator()(const Key& k) const {
            return size_t(((k.texture * 0x9e3779b97f4a7c15u + k.face) * 31 + uint64_t(k.halvings) + uint64_t(k.tile + 1) * 64) *
                              0x9e3779b97f4a7c15u >>
                          13);
        }
    };
    struct Entry {
        Key key;
        Ref image;
        size_t bytes;
    };
    struct Part {
        std::mutex mutex;
        std::list<Entry> entries; ///< the latest first
        std::unordered_map<Key, std::list<Entry>::iterator, Hash> at;
    };
    Part& partOf(const Key& k) { return parts_[Hash{}(k) % kParts]; }
    void forget(Part&, size_t butFor);
    std::atomic<uint64_t> next_{0};
    const size_t most_; ///< bytes of all parts
    std::atomic<size_t> bytes_{0};
    std::array<Part, kParts> parts_;
};

} // namespace alpenglow::ptex
