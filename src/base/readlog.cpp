#include "base/readlog.h"
#include <filesystem>
#include <sys/stat.h>

namespace alpenglow {

ReadLog::State ReadLog::stateOf(const std::string& path) {
    struct stat s;
    if (stat(path.c_str(), &s) != 0) return {0, -1};
    return {int64_t(s.st_mtim.tv_sec) * 1'000'000'000 + s.st_mtim.tv_nsec, int64_t(s.st_size)};
}

void ReadLog::add(const std::string& path) {
    if (path.empty() || path == "-") return;
    const State now = stateOf(path);
    std::lock_guard lock(mutex_);
    files_.try_emplace(path, now);
}

void ReadLog::addMissing(const std::string& name, const std::vector<std::string>& folders) {
    if (std::filesystem::path(name).is_absolute()) return add(name);
    for (const std::string& folder : folders) add((std::filesystem::path(folder) / name).string());
}

bool ReadLog::changed() const {
    std::lock_guard lock(mutex_);
    for (const auto& [path, state] : files_)
        if (stateOf(path) != state) return true;
    return false;
}

} // namespace alpenglow
