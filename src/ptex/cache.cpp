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

void Cache::keep(const Key& k, const Ref& image) {
    Part& p = partOf(k);
    std::lock_guard lock(p.mutex);
    if (p.at.count(k)) return; // another thread was quicker
    const size_t bytes = image->values.size() * sizeof(float) + 128;
    p.entries.push_front({k, image, bytes});
    p.at[k] = p.entries.begin();
    p.bytes += bytes;
    while (p.bytes > most_ && p.entries.size() > 1) {
        p.bytes -= p.entries.back().bytes;
        p.at.erase(p.entries.back().key);
        p.entries.pop_back();
    }
}

} // namespace alpenglow::ptex
