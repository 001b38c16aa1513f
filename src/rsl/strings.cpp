// Interned strings: kernels handle ids.
#include "rsl/kernel.h"
#include <deque>
#include <mutex>
#include <shared_mutex>
#include <unordered_map>

namespace alpenglow::rsl {
namespace {

// The one table of the process. Append-only: an id, once given, means the same text for good, so that references may be handed
// out.
struct StringTable {
    std::shared_mutex mutex;
    std::deque<std::string> texts{std::string()};
    std::unordered_map<std::string_view, int32_t> ids{{texts[0], 0}};
};

StringTable& table() {
    static StringTable t;
    return t;
}

} // namespace

int32_t internString(const std::string& s) {
    StringTable& t = table();
    {
        std::shared_lock lock(t.mutex);
        if (auto it = t.ids.find(s); it != t.ids.end()) return it->second;
    }
    std::unique_lock lock(t.mutex);
    if (auto it = t.ids.find(s); it != t.ids.end()) return it->second;
    t.texts.push_back(s);
    const auto id = int32_t(t.texts.size() - 1);
    t.ids.emplace(t.texts.back(), id);
    return id;
}

const std::string& internedString(int32_t id) {
    StringTable& t = table();
    std::shared_lock lock(t.mutex);
    return id >= 0 && size_t(id) < t.texts.size() ? t.texts[size_t(id)] : t.texts[0];
}

} // namespace alpenglow::rsl
