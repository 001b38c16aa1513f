#include "rsl/jit/loader.h"
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <elf.h>
#include <new>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>

namespace alpenglow::rsl::jit {
namespace {

// What generated code may call outside itself. The fma of a machine without it is a call; the C library rounds it correctly.
void* external(const std::string& name) {
    static const std::map<std::string, void*> table = {
        {"memcpy", reinterpret_cast<void*>(static_cast<void* (*)(void*, const void*, size_t)>(&std::memcpy))},
        {"memset", reinterpret_cast<void*>(static_cast<void* (*)(void*, int, size_t)>(&std::memset))},
        {"memmove", reinterpret_cast<void*>(static_cast<void* (*)(void*, const void*, size_t)>(&std::memmove))},
        {"fmaf", reinterpret_cast<void*>(static_cast<float (*)(float, float, float)>(&::fmaf))},
        {"fma", reinterpret_cast<void*>(static_cast<double (*)(double, double, double)>(&::fma))},
    };
    auto it = table.find(name);
    return it == table.end() ? nullptr : it->second;
}

size_t roundUp(size_t n, size_t to) { return (n + to - 1) / to * to; }

constexpr size_t kStubBytes = 16;             // jmp *[rip+2]; ud2; the address
constexpr size_t kLargestObject = 256u << 20; // far above any object of this compiler

/// Why a file cannot be loaded.
using Fault = std::string;

/// The sections of a file, checked to lie within it.
struct Sections {
    const std::string& elf;
    std::vector<Elf64_Shdr> all{};
    std::vector<std::string> names{};
    Fault read();
    bool range(uint64_t offset, uint64_t size) const { return offset <= elf.size() && size <= elf.size() - offset; }
    template <class T> T get(uint64_t offset) const {
        T t;
        std::memcpy(&t, elf.data() + offset, sizeof t);
        return t;
    }
    std::string text(const Elf64_Shdr& table, uint64_t at) const {
        if (at >= table.sh_size) return {};
        const char* p = elf.data() + table.sh_offset + at;
        return std::string(p, strnlen(p, table.sh_size - at));
    }
};

Fault Sections::read() {
    if (elf.size() < sizeof(Elf64_Ehdr) || std::memcmp(elf.data(), ELFMAG, SELFMAG) != 0) return "not an ELF file";
    const auto header = get<Elf64_Ehdr>(0);
    if (header.e_type != ET_REL || header.e_machine != EM_X86_64 || header.e_ident[EI_CLASS] != ELFCLASS64)
        return "not relocatable x86-64 code";
    if (header.e_shentsize != sizeof(Elf64_Shdr) || !range(header.e_shoff, uint64_t(header.e_shnum) * sizeof(Elf64_Shdr)))
        return "damaged section table";
    for (size_t i = 0; i < header.e_shnum; i++) {
        all.push_back(get<Elf64_Shdr>(header.e_shoff + i * sizeof(Elf64_Shdr)));
        const auto& s = all.back();
        if (s.sh_type != SHT_NOBITS && !range(s.sh_offset, s.sh_size)) return "damaged section";
    }
    names.resize(all.size());
    if (header.e_shstrndx < all.size())
        for (size_t i = 0; i < all.size(); i++) names[i] = text(all[header.e_shstrndx], all[i].sh_name);
    return {};
}

/// Where what is loaded stands: executable sections and stubs, then read-only ones, then writable ones with the offset table;
/// each group on its own pages. Offsets into the memory.
struct Layout {
    std::vector<size_t> place{}; ///< of sections; SIZE_MAX: not loaded
    size_t groupStart[4] = {};   ///< the last is the end of all
    size_t stubs = 0, table = 0;
    Fault lay(const Sections&);
};

Fault Layout::lay(const Sections& sections) {
    const size_t page = size_t(sysconf(_SC_PAGESIZE));
    const auto groupOf = [](const Elf64_Shdr& s) { return s.sh_flags & SHF_EXECINSTR ? 0 : s.sh_flags & SHF_WRITE ? 2 : 1; };
    place.assign(sections.all.size(), SIZE_MAX);
    size_t relocations = 0, end = 0;
    for (const auto& s : sections.all)
        if (s.sh_type == SHT_RELA) relocations += s.sh_size / sizeof(Elf64_Rela);
    for (int group = 0; group < 3; group++) {
        groupStart[group] = end = roundUp(end, page);
        for (size_t i = 0; i < sections.all.size(); i++) {
            const auto& s = sections.all[i];
            // Unwind tables are not needed: kernels neither throw nor are thrown through.
            if (!(s.sh_flags & SHF_ALLOC) || s.sh_size == 0 || groupOf(s) != group || sections.names[i] == ".eh_frame") continue;
            if (s.sh_size > kLargestObject || s.sh_addralign > page) return "a section is too large";
            end = roundUp(end, std::max<size_t>(1, s.sh_addralign));
            place[i] = end;
            end += s.sh_size;
            if (end > kLargestObject) return "too large";
        }
        end = roundUp(end, 16);
        if (group == 0) {
            stubs = end;
            end += std::min<size_t>(relocations, 1024) * kStubBytes;
        }
        if (group == 2) {
            table = end;
            end += std::min<size_t>(relocations, 4096) * 8;
        }
    }
    groupStart[3] = roundUp(std::max<size_t>(end, 1), page);
    return {};
}

/// Puts addresses into code that has been copied to its place.
class Linker {
public:
    /// base: of the memory that is laid out so.
    Linker(const Sections& s, const Layout& l, unsigned char* base) : sections_(s), layout_(l), base_(base) {}
    /// Finds the addresses of all symbols; those that the object defines for others go to `defined`.
    Fault resolve(const LoadedObject::Outside& outside, std::map<std::string, void*>& defined);
    /// After that.
    Fault relocate();

private:
    struct Symbol {
        uint64_t address = 0; ///< 0: not known
        bool foreign = false;
        std::string name;
    };
    Fault resolve(const Elf64_Sym&, Symbol&, const LoadedObject::Outside&, std::map<std::string, void*>& defined) const;
    Fault relocate(const Elf64_Rela&, size_t section);
    uint64_t stub(uint64_t target);
    uint64_t slot(uint64_t target);

    const Sections& sections_;
    const Layout& layout_;
    unsigned char* base_;
    std::vector<Symbol> symbols_;
    std::map<uint64_t, size_t> stubOf_, slotOf_; ///< by target
};

Fault Linker::resolve(const Elf64_Sym& y, Symbol& symbol, const LoadedObject::Outside& outside,
                      std::map<std::string, void*>& defined) const {
    const std::string& name = symbol.name;
    const auto& all = sections_.all;
    if (y.st_shndx == SHN_UNDEF) {
        symbol.address = reinterpret_cast<uint64_t>(external(name));
        if (!symbol.address && outside) symbol.address = reinterpret_cast<uint64_t>(outside(name));
        symbol.foreign = true;
    } else if (y.st_shndx < all.size() && layout_.place[y.st_shndx] != SIZE_MAX) {
        if (y.st_value > all[y.st_shndx].sh_size) return "symbol " + name + " outside its section";
        symbol.address = reinterpret_cast<uint64_t>(base_) + layout_.place[y.st_shndx] + y.st_value;
        if (!name.empty() && ELF64_ST_BIND(y.st_info) == STB_GLOBAL) defined[name] = reinterpret_cast<void*>(symbol.address);
    }
    return {};
}

Fault Linker::resolve(const LoadedObject::Outside& outside, std::map<std::string, void*>& defined) {
    for (const auto& s : sections_.all) {
        if (s.sh_type != SHT_SYMTAB) continue;
        if (s.sh_link >= sections_.all.size()) return "damaged symbols";
        for (uint64_t at = 0; at + sizeof(Elf64_Sym) <= s.sh_size; at += sizeof(Elf64_Sym)) {
            const auto y = sections_.get<Elf64_Sym>(s.sh_offset + at);
            Symbol& symbol = symbols_.emplace_back();
            symbol.name = sections_.text(sections_.all[s.sh_link], y.st_name);
            if (Fault f = resolve(y, symbol, outside, defined); !f.empty()) return f;
        }
        break;
    }
    return {};
}

/// A jump to an address that may be too far for 32 bits; 0: there is no room.
uint64_t Linker::stub(uint64_t target) {
    auto [it, fresh] = stubOf_.try_emplace(target, layout_.stubs + stubOf_.size() * kStubBytes);
    if (it->second + kStubBytes > layout_.groupStart[1]) return 0;
    if (fresh) {
        const unsigned char jump[8] = {0xff, 0x25, 2, 0, 0, 0, 0x0f, 0x0b};
        std::memcpy(base_ + it->second, jump, 8);
        std::memcpy(base_ + it->second + 8, &target, 8);
    }
    return reinterpret_cast<uint64_t>(base_) + it->second;
}

/// The place of an address in the offset table; 0 if the table is full.
uint64_t Linker::slot(uint64_t target) {
    auto [it, fresh] = slotOf_.try_emplace(target, layout_.table + slotOf_.size() * 8);
    if (it->second + 8 > layout_.groupStart[3]) return 0;
    if (fresh) std::memcpy(base_ + it->second, &target, 8);
    return reinterpret_cast<uint64_t>(base_) + it->second;
}

Fault Linker::relocate(const Elf64_Rela& e, size_t section) {
    const auto& target = sections_.all[section];
    const uint32_t type = ELF64_R_TYPE(e.r_info);
    const size_t index = ELF64_R_SYM(e.r_info);
    const size_t width = type == R_X86_64_64 || type == R_X86_64_PC64 ? 8 : 4;
    if (type == R_X86_64_NONE) return {};
    if (index >= symbols_.size() || e.r_offset > target.sh_size || target.sh_size - e.r_offset < width)
        return "damaged relocation";
    const Symbol& symbol = symbols_[index];
    uint64_t to = symbol.address;
    if (!to) return "it needs " + (symbol.name.empty() ? std::string("a dropped section") : symbol.name);
    unsigned char* where = base_ + layout_.place[section] + e.r_offset;
    const auto here = reinterpret_cast<uint64_t>(where);
    int64_t value = 0;
    bool fits = true;
    switch (type) {
    case R_X86_64_64:
        value = int64_t(to) + e.r_addend;
        break;
    case R_X86_64_PC64:
        value = int64_t(to) + e.r_addend - int64_t(here);
        break;
    case R_X86_64_PLT32:
    case R_X86_64_PC32:
        if (symbol.foreign) to = stub(to);
        value = int64_t(to) + e.r_addend - int64_t(here);
        fits = to != 0 && value == int32_t(value);
        break;
    case R_X86_64_GOTPCREL:
    case R_X86_64_GOTPCRELX:
    case R_X86_64_REX_GOTPCRELX:
        to = slot(to);
        value = int64_t(to) + e.r_addend - int64_t(here);
        fits = to != 0 && value == int32_t(value);
        break;
    case R_X86_64_32:
    case R_X86_64_32S:
        value = int64_t(to) + e.r_addend;
        fits = type == R_X86_64_32S ? value == int32_t(value) : value == int64_t(uint32_t(value));
        break;
    default:
        return "relocation of type " + std::to_string(type);
    }
    if (!fits) return "a relocation does not reach";
    std::memcpy(where, &value, width);
    return {};
}

Fault Linker::relocate() {
    for (const auto& s : sections_.all) {
        if (s.sh_type == SHT_REL) return "relocations without addends";
        if (s.sh_type != SHT_RELA || s.sh_info >= sections_.all.size() || layout_.place[s.sh_info] == SIZE_MAX) continue;
        for (uint64_t at = 0; at + sizeof(Elf64_Rela) <= s.sh_size; at += sizeof(Elf64_Rela))
            if (Fault f = relocate(sections_.get<Elf64_Rela>(s.sh_offset + at), s.sh_info); !f.empty()) return f;
    }
    return {};
}

/// Makes code executable and the rest but writable sections read-only.
bool protect(const Layout& l, unsigned char* base) {
    const auto set = [&](int group, int flags) {
        const size_t size = l.groupStart[group + 1] - l.groupStart[group];
        return size == 0 || mprotect(base + l.groupStart[group], size, flags) == 0;
    };
    return set(0, PROT_READ | PROT_EXEC) && set(1, PROT_READ);
}

} // namespace

LoadedObject::~LoadedObject() {
    if (memory_) munmap(memory_, size_);
}

void* LoadedObject::find(const std::string& name) const {
    auto it = symbols_.find(name);
    return it == symbols_.end() ? nullptr : it->second;
}

std::unique_ptr<LoadedObject> LoadedObject::load(const std::string& elf, std::string& error, const Outside& outside) {
    const auto fail = [&](const Fault& why) -> std::unique_ptr<LoadedObject> {
        error = "object file: " + why;
        return nullptr;
    };
    Sections sections{elf};
    if (const Fault f = sections.read(); !f.empty()) return fail(f);
    Layout layout;
    if (const Fault f = layout.lay(sections); !f.empty()) return fail(f);
    std::unique_ptr<LoadedObject> o(new LoadedObject);
    const size_t size = layout.groupStart[3];
    void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    o->memory_ = memory;
    o->size_ = size;
    auto* base = static_cast<unsigned char*>(memory);
    for (size_t i = 0; i < sections.all.size(); i++)
        if (const Elf64_Shdr& s = sections.all[i]; layout.place[i] != SIZE_MAX && s.sh_type != SHT_NOBITS)
            std::memcpy(base + layout.place[i], elf.data() + s.sh_offset, s.sh_size);
    Linker linker(sections, layout, base);
    if (const Fault f = linker.resolve(outside, o->symbols_); !f.empty()) return fail(f);
    if (const Fault f = linker.relocate(); !f.empty()) return fail(f);
    if (!protect(layout, base)) {
        if (errno == ENOMEM) throw std::bad_alloc();
        return fail("memory cannot be made executable");
    }
    return o;
}

} // namespace alpenglow::rsl::jit
