// The kernel cache on disk: files named by the key, whole or absent, the least recently used dropped.
#pragma once
#include "rsl/jit/kernelfile.h"
#include <atomic>

namespace alpenglow::rsl::jit {

/// $ALPENGLOW_CACHE, else $XDG_CACHE_HOME/alpenglow, else ~/.cache/alpenglow; "" (no cache) when none is set or ALPENGLOW_CACHE
/// is "off".
std::string defaultCacheDirectory();

/// One folder of kernels. Thread safe; processes may share the folder.
class KernelCache {
public:
    /// An empty directory name: no cache. The directory is made on the first store, for its owner only.
    explicit KernelCache(std::string directory, size_t maxBytes);
    /// The kernel of that key; nothing if there is none or its file is damaged.
    std::optional<KernelFile> load(const std::string& key) const;
    /// Why the directory is neither read nor written, in a sentence that says what to do: it is another user's, or others can
    /// write to it.
    /// "" when it can be used or does not exist yet.
    std::string refusal() const;
    /// A full or read-only disk is no error: the next run compiles again. Trims once in 256 kernels or after a 64th of the
    /// largest size, so the folder may be larger by that.
    void store(const std::string& key, const KernelFile&) const;
    /// As given to the constructor.
    const std::string& directory() const { return directory_; }

    /// Drops the least recently used kernels beyond the largest size, and files that killed programs left.
    void trim() const;

private:
    std::string path(const std::string& key) const;
    std::string directory_;
    size_t maxBytes_;
    mutable std::atomic<size_t> written_ = 0; ///< bytes since the last look at the folder
};

} // namespace alpenglow::rsl::jit
