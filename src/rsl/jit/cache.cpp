#include "rsl/jit/cache.h"
#include "base/folder.h"
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sys/stat.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace alpenglow::rsl::jit {

constexpr std::chrono::hours kTemporaryAge(24);

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

std::string KernelCache::refusal() const {
    struct stat s{};
    if (directory_.empty() || stat(directory_.c_str(), &s) != 0) return {};
    const std::string cure = "; set ALPENGLOW_CACHE to a folder of your own, or to \"off\"";
    if (!S_ISDIR(s.st_mode)) return {};
    if (s.st_uid != geteuid()) return "the kernel cache " + directory_ + " belongs to another user and is not used" + cure;
    if ((s.st_mode & 022) == 0) return {};
    return "the kernel cache " + directory_ + " is not used because others can write to it; chmod go-w makes it safe" + cure;
}

std::optional<KernelFile> KernelCache::load(const std::string& key) const {
    // Code is run from here: only from a file and a directory of this user that no one else can write.
    if (directory_.empty() || !refusal().empty()) return {};
    const std::string name = path(key);
    const int fd = open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (fd < 0) return {};
    struct stat s{};
    std::string bytes;
    bool whole =
        fstat(fd, &s) == 0 && S_ISREG(s.st_mode) && s.st_uid == geteuid() && !(s.st_mode & 022) && size_t(s.st_size) <= maxBytes_;
    if (whole) bytes.resize(size_t(s.st_size));
    for (size_t at = 0; whole && at < bytes.size();) {
        const ssize_t n = read(fd, bytes.data() + at, bytes.size() - at);
        if (n < 0 && errno == EINTR) continue;
        whole = n > 0;
        at += whole ? size_t(n) : 0;
    }
    close(fd);
    if (!whole) return {};
    auto k = unpack(bytes);
    std::error_code ignored;
    if (!k || k->key != key) { // damaged, or another kernel's
        fs::remove(name, ignored);
        return {};
    }
    fs::last_write_time(name, fs::file_time_type::clock::now(), ignored); // when it was last used
    return k;
}

void KernelCache::store(const std::string& key, const KernelFile& k) const {
    if (directory_.empty()) return;
    std::error_code e;
    if (!refusal().empty()) return;
    if (!fs::exists(directory_, e)) {
        fs::create_directories(directory_, e);
        if (!e) fs::permissions(directory_, fs::perms::owner_all, e);
    }
    static std::atomic<unsigned> counter{0};
    const std::string temporary = path(key) + "." + std::to_string(getpid()) + "." + std::to_string(counter++) + ".tmp";
    KernelFile named = k;
    named.key = key;
    const std::string bytes = pack(named);
    {
        std::ofstream out(temporary, std::ios::binary);
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
    // To look at thousands of files takes longer than to compile a small kernel. A key is a hash: its first digits are chance.
    written_ += bytes.size();
    if (key.starts_with("00") || written_ > maxBytes_ / 64) {
        written_ = 0;
        trim();
    }
}

void KernelCache::trim() const {
    if (directory_.empty()) return; // it would be the working directory
    struct Entry {
        fs::path path;
        fs::file_time_type time;
        uintmax_t size;
    };
    std::vector<Entry> entries;
    uintmax_t total = 0;
    std::error_code e;
    for (const std::string& name : namesIn(directory_)) {
        std::error_code f;
        const fs::path file = fs::path(directory_) / name;
        if (file.extension() == ".tmp") { // of a program that was killed while it wrote
            const auto written = fs::last_write_time(file, f);
            if (!f && written < fs::file_time_type::clock::now() - kTemporaryAge) fs::remove(file, f);
            continue;
        }
        if (file.extension() != ".kernel") continue;
        Entry x{file, fs::last_write_time(file, f), fs::file_size(file, f)};
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
