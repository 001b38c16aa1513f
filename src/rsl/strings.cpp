// Interned strings: kernels handle ids.
#include "base/limits.h"
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
    size_t runtimeBytes = 0; ///< of texts that shaders made
    std::deque<std::string> texts{std::string()};
    std::unordered_map<std::string_view, int32_t> ids{{texts[0], 0}};
};

StringTable& table() {
    static StringTable t;
    return t;
}

constexpr size_t kEntryBytes = 96; // of a text's places in the table

int32_t intern(const std::string& s, bool runtime, bool& full) {
    StringTable& t = table();
    {
        std::shared_lock lock(t.mutex);
        if (auto it = t.ids.find(s); it != t.ids.end()) return it->second;
    }
    std::unique_lock lock(t.mutex);
    if (auto it = t.ids.find(s); it != t.ids.end()) return it->second;
    const size_t bytes = s.size() + kEntryBytes;
    if (runtime && t.runtimeBytes + bytes > limits::kRuntimeStrings) {
        full = true;
        return 0;
    }
    t.runtimeBytes += runtime ? bytes : 0;
    t.texts.push_back(s);
    const auto id = int32_t(t.texts.size() - 1);
    t.ids.emplace(t.texts.back(), id);
    return id;
}

} // namespace

int32_t internString(const std::string& s) {
    bool full = false;
    return intern(s, false, full);
}

int32_t internRuntimeString(const std::string& s, bool& full) { return intern(s, true, full); }

const std::string& internedString(int32_t id) {
    StringTable& t = table();
    std::shared_lock lock(t.mutex);
    return id >= 0 && size_t(id) < t.texts.size() ? t.texts[size_t(id)] : t.texts[0];
}

} // namespace alpenglow::rsl
