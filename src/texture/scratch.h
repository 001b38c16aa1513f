// Scratch files for levels of maps that do not fit into memory. An unnamed file, mapped for reading: the system loads pages at
// access and reclaims them on request at any time. So lookups take no lock and get the same numbers whether a page is resident or
// not.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::texture {

/// The folder of scratch files: TMPDIR, else /var/tmp, which is on a disk.
std::string scratchFolder();

/// One file and its mapping. Removed by the system when the last reference goes.
class ScratchFile {
public:
    /// Creates an empty file in scratchFolder(). Returns null after an error, with `why`.
    static std::shared_ptr<ScratchFile> create(std::string& why);
    ScratchFile() = default;
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;
    ~ScratchFile();
    /// Appends data; `at`: its offset in the file, a multiple of 64. Returns false if the disk is full or broken, with `why`.
    bool append(const void* bytes, size_t n, size_t& at, std::string& why);
    /// Maps the appended data. Call once, after the last append. One page beyond the end can be read.
    bool map(std::string& why);
    const char* data() const { return data_; }
    size_t size() const { return size_; }
    /// Bytes of the file that are in this process now.
    size_t resident() const { return residentIn(0, mapped_); }
    /// Gives `bytes` from `from` on back to the system; they are fetched again when they are looked at. Harmless at any time. How
    /// many of them were here.
    size_t release(size_t from, size_t bytes) const;

private:
    size_t residentIn(size_t from, size_t bytes) const; ///< complete pages
    int file_ = -1;
    char* data_ = nullptr;
    size_t size_ = 0, mapped_ = 0;
};

/// Bytes of files, of all kinds, that are in this process now. Quick.
size_t bytesOfFiles();

} // namespace alpenglow::texture
