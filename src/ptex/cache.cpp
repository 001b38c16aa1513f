#include "ptex/cache.h"

namespace alpenglow::ptex {

std::shared_ptr<Cache> makeCache(size_t bytes) { return std::make_shared<Cache>(bytes); }

Cache::Ref Cache::find(const Key& k) {
    Part& p = partOf(k);
    std::lock_guard lock(p.mutex);
    const auto found = p.at.find(k);
    if (found == p.at.end()) return nullptr;
    p.entries.splice(p.entries.begin(), p.entries, found->second);
    return found->second->image;
}

/// Drops the least recently used faces of a part, except the newest, until the total size is small enough.
void Cache::forget(Part& p, size_t butFor) {
    std::lock_guard lock(p.mutex);
    while (bytes_ > most_ && p.entries.size() > butFor) {
        bytes_ -= p.entries.back().bytes;
        p.at.erase(p.entries.back().key);
        p.entries.pop_back();
    }
}

void Cache::keep(const Key& k, const Ref& image, size_t tableBytes) {
    const size_t own = size_t(&partOf(k) - parts_.data()), bytes = image->values.size() * sizeof(float) + tableBytes + 128;
    {
        Part& p = parts_[own];
        std::lock_guard lock(p.mutex);
        if (p.at.count(k)) return; // another thread was quicker
        p.entries.push_front({k, image, bytes});
        p.at[k] = p.entries.begin();
        bytes_ += bytes;
    }
    // Other parts only if a single face exceeds the limit of a part.
    for (size_t n = 0; n < kParts && bytes_ > most_; ++n) forget(parts_[(own + n) % kParts], n == 0 ? 1 : 0);
}

} // namespace alpenglow::ptex
