#include "rsl/jit/cache.h"
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sys/stat.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace alpenglow::rsl::jit {

std::string defaultCacheDirectory() {
    auto env = [](const char* name) {
        const char* v = std::getenv(name);
        return std::string(v ? v : "");
    };
    if (std::string d = env("ALPENGLOW_CACHE"); !d.empty()) return d == "off" ? std::string() : d;
    if (std::string d = env("XDG_CACHE_HOME"); !d.empty()) return d + "/alpenglow";
    if (std::string d = env("HOME"); !d.empty()) return d + "/.cache/alpenglow";
    return {};
}

KernelCache::KernelCache(std::string directory, size_t maxBytes) : directory_(std::move(directory)), maxBytes_(maxBytes) {}

std::string KernelCache::path(const std::string& key) const { return directory_ + "/" + key + ".kernel"; }

std::optional<KernelFile> KernelCache::load(const std::string& key) const {
    if (directory_.empty()) return {};
    // Code is run from here: only from a file and a directory of this user that no one else can write.
    struct stat dir{}, file{};
    if (stat(directory_.c_str(), &dir) != 0 || dir.st_uid != geteuid() || (dir.st_mode & 022)) return {};
    const std::string name = path(key);
    if (stat(name.c_str(), &file) != 0 || !S_ISREG(file.st_mode) || file.st_uid != geteuid() || size_t(file.st_size) > maxBytes_)
        return {};
    std::ifstream in(name, std::ios::binary);
    std::string bytes(size_t(file.st_size), 0);
    if (!in.read(bytes.data(), std::streamsize(bytes.size()))) return {};
    auto k = unpack(bytes);
    std::error_code ignored;
    if (!k) fs::remove(name, ignored);
    else fs::last_write_time(name, fs::file_time_type::clock::now(), ignored); // when it was last used
    return k;
}

void KernelCache::store(const std::string& key, const KernelFile& k) const {
    if (directory_.empty()) return;
    std::error_code e;
    if (!fs::exists(directory_, e)) {
        fs::create_directories(directory_, e);
        if (!e) fs::permissions(directory_, fs::perms::owner_all, e);
    }
    static std::atomic<unsigned> counter{0};
    const std::string temporary = path(key) + "." + std::to_string(getpid()) + "." + std::to_string(counter++) + ".tmp";
    {
        std::ofstream out(temporary, std::ios::binary);
        const std::string bytes = pack(k);
        out.write(bytes.data(), std::streamsize(bytes.size()));
        out.close();
        if (!out) {
            fs::remove(temporary, e);
            return;
        }
    }
    fs::permissions(temporary, fs::perms::owner_read | fs::perms::owner_write, e);
    fs::rename(temporary, path(key), e);
    if (e) fs::remove(temporary, e);
    trim();
}

void KernelCache::trim() const {
    struct Entry {
        fs::path path;
        fs::file_time_type time;
        uintmax_t size;
    };
    std::vector<Entry> entries;
    uintmax_t total = 0;
    std::error_code e;
    for (fs::directory_iterator it(directory_, e), end; !e && it != end; it.increment(e)) {
        if (it->path().extension() != ".kernel") continue;
        std::error_code f;
        Entry x{it->path(), it->last_write_time(f), it->file_size(f)};
        if (f) continue;
        total += x.size;
        entries.push_back(std::move(x));
    }
    if (total <= maxBytes_) return;
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.time < b.time; });
    for (const auto& x : entries) {
        if (total <= maxBytes_) break;
        fs::remove(x.path, e);
        total -= std::min(total, x.size);
    }
}

} // namespace alpenglow::rsl::jit
