#include "ri/shelf.h"
#include "ri/zip.h"
#include <sys/stat.h>

namespace alpenglow::ri {

const ArchiveShelf::Found* ArchiveShelf::found(const std::string& question) const {
    const auto i = found_.find(question);
    if (i == found_.end()) return nullptr;
    struct stat st{};
    const auto inside = zipName(i->second.file);
    return ::stat((inside ? inside->zip : i->second.file).c_str(), &st) == 0 && S_ISREG(st.st_mode) ? &i->second : nullptr;
}

std::shared_ptr<const ParsedArchive> ArchiveShelf::take(const std::string& file) {
    struct stat st{};
    if (::stat(file.c_str(), &st) != 0 || !S_ISREG(st.st_mode)) return nullptr;
    Held now{uint64_t(st.st_size), uint64_t(st.st_ino), int64_t(st.st_mtim.tv_sec), int64_t(st.st_mtim.tv_nsec), nullptr};
    Held& held = held_[file];
    if (held == now) return held.archive;
    if (held.archive) heldBytes_ -= held.bytes;
    if (now.bytes <= kArchive && heldBytes_ + now.bytes <= kAll) now.archive = parseArchive(file);
    if (now.archive) heldBytes_ += now.bytes;
    held = std::move(now);
    return held.archive;
}

} // namespace alpenglow::ri
