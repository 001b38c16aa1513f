// Scratch files: where the levels of maps lie that do not fit into memory. A file without a name, mapped for reading: the system
// fetches pages when they are looked at, and takes them back when it is asked to, whoever reads them meanwhile. So lookups take
// no lock and find the same numbers whether a page is there or not.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::texture {

/// The folder of scratch files: TMPDIR, else /var/tmp, which lies on a disk.
std::string scratchFolder();

class ScratchFile {
public:
    /// An empty file in scratchFolder(). Null: `why` says what went wrong.
    static std::shared_ptr<ScratchFile> create(std::string& why);
    ScratchFile() = default;
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;
    ~ScratchFile();
    /// Appends; where it begins in the file, a multiple of 64. False: the disk is full or broken, `why` says so.
    bool append(const void* bytes, size_t n, size_t& at, std::string& why);
    /// Maps what was appended. Once; nothing is appended after it. A page more than the file has can be read.
    bool map(std::string& why);
    const char* data() const { return data_; }
    size_t size() const { return size_; }
    /// Bytes of the file that are in this process now.
    size_t resident() const { return residentIn(0, mapped_); }
    /// Gives `bytes` from `from` on back to the system; they are fetched again when they are looked at. Harmless at any time. How
    /// many of them were here.
    size_t release(size_t from, size_t bytes) const;

private:
    size_t residentIn(size_t from, size_t bytes) const; ///< whole pages
    int file_ = -1;
    char* data_ = nullptr;
    size_t size_ = 0, mapped_ = 0;
};

/// Bytes of files, of all kinds, that are in this process now. Quick.
size_t bytesOfFiles();

} // namespace alpenglow::texture
