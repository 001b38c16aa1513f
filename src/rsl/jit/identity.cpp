#include "rsl/jit/identity.h"
#include "base/installation.h"
#include "rsl/jit/module.h"
#include <cstring>
#include <elf.h>
#include <fstream>
#include <sys/stat.h>
#include <vector>

namespace alpenglow::rsl::jit {
namespace {

constexpr uint64_t kLargestNotes = 1u << 20;
constexpr int kMostHeaders = 1000;

/// The build id among the notes of one segment.
std::string idIn(const std::vector<char>& notes) {
    size_t at = 0;
    const auto padded = [](size_t n) { return (n + 3) / 4 * 4; };
    while (notes.size() - at >= sizeof(Elf64_Nhdr)) {
        Elf64_Nhdr h;
        std::memcpy(&h, notes.data() + at, sizeof h);
        at += sizeof h;
        if (padded(h.n_namesz) > notes.size() - at || padded(h.n_descsz) > notes.size() - at - padded(h.n_namesz)) return {};
        const char* name = notes.data() + at;
        at += padded(h.n_namesz);
        if (h.n_type == NT_GNU_BUILD_ID && h.n_namesz == 4 && std::memcmp(name, "GNU", 4) == 0) {
            std::string id;
            for (size_t i = 0; i < h.n_descsz; ++i) {
                const auto b = static_cast<unsigned char>(notes[at + i]);
                id += "0123456789abcdef"[b >> 4];
                id += "0123456789abcdef"[b & 15];
            }
            return id;
        }
        at += padded(h.n_descsz);
    }
    return {};
}

std::string identityOf(const std::string& path) {
    if (std::string id = buildIdOfFile(path); !id.empty()) return id;
    struct stat s{};
    if (stat(path.c_str(), &s) != 0) return "?";
    return std::to_string(s.st_size) + "." + std::to_string(s.st_mtim.tv_sec) + "." + std::to_string(s.st_mtim.tv_nsec);
}

} // namespace

std::string buildIdOfFile(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    Elf64_Ehdr e{};
    if (!in.read(reinterpret_cast<char*>(&e), sizeof e) || std::memcmp(e.e_ident, ELFMAG, SELFMAG) != 0) return {};
    if (e.e_ident[EI_CLASS] != ELFCLASS64 || e.e_phentsize != sizeof(Elf64_Phdr)) return {};
    for (int i = 0; i < e.e_phnum && i < kMostHeaders; ++i) {
        Elf64_Phdr p{};
        in.seekg(std::streamoff(e.e_phoff) + std::streamoff(sizeof p) * i);
        if (!in.read(reinterpret_cast<char*>(&p), sizeof p)) return {};
        if (p.p_type != PT_NOTE || p.p_filesz > kLargestNotes) continue;
        std::vector<char> notes(p.p_filesz);
        in.seekg(std::streamoff(p.p_offset));
        if (!in.read(notes.data(), std::streamsize(notes.size()))) return {};
        if (std::string id = idIn(notes); !id.empty()) return id;
    }
    return {};
}

const std::string& programIdentity() {
    static const std::string identity = identityOf(codeFile().string()) + "+" + identityOf(moduleFile());
    return identity;
}

} // namespace alpenglow::rsl::jit
