// A file with random access.
#pragma once
#include <cstdint>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace alpenglow {

/// Open for reading during its lifetime. Pipes, devices and folders are not read: regular() is false for them.
class RandomFile {
public:
    /// Opens the file; on failure regular() is false.
    explicit RandomFile(const std::string& path) : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
        struct stat s;
        if (fd_ >= 0 && fstat(fd_, &s) == 0 && S_ISREG(s.st_mode)) size_ = uint64_t(s.st_size), regular_ = true;
    }
    ~RandomFile() {
        if (fd_ >= 0) ::close(fd_);
    }
    RandomFile(const RandomFile&) = delete;
    RandomFile& operator=(const RandomFile&) = delete;
    /// Open, and a regular file.
    bool regular() const { return regular_; }
    uint64_t size() const { return size_; } ///< bytes, when it was opened
    /// Reads the `n` bytes from offset `at`. Returns false if they do not exist, also if the file has become shorter; allocates
    /// no memory beyond the file's size. Thread safe.
    bool read(uint64_t at, uint64_t n, std::vector<uint8_t>& to) const {
        if (at > size_ || n > size_ - at) return false;
        to.resize(size_t(n));
        for (size_t done = 0; done < n;) {
            const ssize_t k = ::pread(fd_, to.data() + done, size_t(n) - done, off_t(at + done));
            if (k <= 0) return false;
            done += size_t(k);
        }
        return true;
    }

private:
    int fd_;
    uint64_t size_ = 0;
    bool regular_ = false;
};

} // namespace alpenglow
