// Archives that are read more than once: where they were found, and their requests, which need not be parsed again.
#pragma once
#include "ri/readahead.h"
#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace alpenglow::ri {

/// Keeps parsed archives within a memory limit. Not thread safe.
class ArchiveShelf {
public:
    static constexpr uint64_t kArchive = 1u << 20; ///< bytes of an archive that is kept, at most
    static constexpr uint64_t kAll = 16u << 20;    ///< of all that are kept
    /// Where a look-up led.
    struct Found {
        std::string file, key; ///< name for messages; path without links, which identifies the file
    };
    /// The answer that was noted for a look-up (name and search path as text); null: none, or the file has gone.
    const Found* found(const std::string& question) const;
    /// Keeps an answer until forgetPlaces().
    void note(const std::string& question, Found answer) { found_.insert_or_assign(question, std::move(answer)); }

    /// The requests of a file as it is now, parsed at most once. Null: read the file in the ordinary way, because it is too large
    /// to keep, compressed, or causes messages while it is parsed.
    std::shared_ptr<const ParsedArchive> take(const std::string& file);

    /// Forgets look-ups, after requests that may have made files.
    void forgetPlaces() { found_.clear(); }

private:
    struct Held {
        uint64_t bytes = 0, inode = 0;
        int64_t seconds = 0, nanoseconds = 0; ///< when it was last written
        std::shared_ptr<const ParsedArchive> archive;
        bool operator==(const Held& o) const {
            return bytes == o.bytes && inode == o.inode && seconds == o.seconds && nanoseconds == o.nanoseconds;
        }
    };
    std::map<std::string, Found> found_;
    std::map<std::string, Held> held_;
    uint64_t heldBytes_ = 0;
};

} // namespace alpenglow::ri
