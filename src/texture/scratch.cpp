#include "texture/scratch.h"
#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace alpenglow::texture {

namespace {
size_t pageSize() {
    static const size_t size = size_t(sysconf(_SC_PAGESIZE));
    return size;
}
} // namespace

std::string scratchFolder() {
    const char* named = std::getenv("TMPDIR");
    return named && *named ? named : "/var/tmp";
}

std::shared_ptr<ScratchFile> ScratchFile::create(std::string& why) {
    const std::string folder = scratchFolder();
    auto f = std::make_shared<ScratchFile>();
    f->file_ = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (f->file_ < 0) { // not supported by every file system
        std::string name = folder + "/alpenglow-XXXXXX";
        f->file_ = mkostemp(name.data(), O_CLOEXEC);
        if (f->file_ >= 0) unlink(name.c_str());
    }
    if (f->file_ >= 0) return f;
    why = "no scratch file in \"" + folder + "\": " + std::strerror(errno);
    return nullptr;
}

ScratchFile::~ScratchFile() {
    if (data_) munmap(data_, mapped_);
    if (file_ >= 0) close(file_);
}

bool ScratchFile::append(const void* bytes, size_t n, size_t& at, std::string& why) {
    at = (size_ + 63) / 64 * 64;
    const char* from = static_cast<const char*>(bytes);
    for (size_t done = 0; done < n;) {
        const ssize_t k = pwrite(file_, from + done, std::min<size_t>(n - done, size_t(1) << 30), off_t(at + done));
        if (k < 0 && errno == EINTR) continue;
        if (k <= 0) {
            why = std::string("the scratch file cannot be written: ") + std::strerror(k ? errno : ENOSPC);
            return false;
        }
        done += size_t(k);
    }
    size_ = at + n;
    return true;
}

bool ScratchFile::map(std::string& why) {
    mapped_ = (size_ / pageSize() + 2) * pageSize();
    // The last page and one beyond it exist, so that reads beyond the end give zeros rather than faults.
    void* p = ftruncate(file_, off_t(mapped_)) == 0 ? mmap(nullptr, mapped_, PROT_READ, MAP_SHARED, file_, 0) : MAP_FAILED;
    if (p == MAP_FAILED) {
        why = std::string("the scratch file cannot be mapped: ") + std::strerror(errno);
        return false;
    }
    data_ = static_cast<char*>(p);
    return true;
}

size_t ScratchFile::residentIn(size_t from, size_t bytes) const {
    if (!data_) return 0;
    const int pages = open("/proc/self/pagemap", O_RDONLY | O_CLOEXEC);
    if (pages < 0) return bytes; // unknown: as if all were resident
    size_t count = 0;
    std::vector<uint64_t> entries(std::min<size_t>(8192, bytes / pageSize() + 1));
    const size_t first = reinterpret_cast<uintptr_t>(data_ + from) / pageSize(), all = bytes / pageSize();
    for (size_t done = 0; done < all;) {
        const size_t n = std::min(entries.size(), all - done);
        const ssize_t k = pread(pages, entries.data(), n * 8, off_t((first + done) * 8));
        if (k <= 0) break;
        for (size_t i = 0; i < size_t(k) / 8; ++i) count += entries[i] >> 63;
        done += size_t(k) / 8;
    }
    close(pages);
    return count * pageSize();
}

size_t ScratchFile::release(size_t from, size_t bytes) const {
    if (!data_ || from >= mapped_) return 0;
    from = from / pageSize() * pageSize();
    bytes = std::min((bytes + pageSize() - 1) / pageSize() * pageSize(), mapped_ - from);
    const size_t there = residentIn(from, bytes);
    if (there) madvise(data_ + from, bytes, MADV_DONTNEED);
    return there;
}

size_t bytesOfFiles() {
    static const int statm = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    char text[128] = "";
    if (statm < 0 || pread(statm, text, sizeof text - 1, 0) <= 0) return 0;
    unsigned long size = 0, resident = 0, shared = 0; // in pages
    return std::sscanf(text, "%lu %lu %lu", &size, &resident, &shared) == 3 ? shared * pageSize() : 0;
}

} // namespace alpenglow::texture
