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
constexpr size_t kLargestObject = 256u << 20; // nothing that we generate comes near

struct Reader {
    const std::string& elf;
    std::vector<Elf64_Shdr> sections;
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

} // namespace

LoadedObject::~LoadedObject() {
    if (memory_) munmap(memory_, size_);
}

void* LoadedObject::find(const std::string& name) const {
    auto it = symbols_.find(name);
    return it == symbols_.end() ? nullptr : it->second;
}

std::unique_ptr<LoadedObject> LoadedObject::load(const std::string& elf, std::string& error, const Outside& outside) {
    auto fail = [&](const std::string& why) -> std::unique_ptr<LoadedObject> {
        error = "object file: " + why;
        return nullptr;
    };
    Reader r{elf, {}};
    if (elf.size() < sizeof(Elf64_Ehdr) || std::memcmp(elf.data(), ELFMAG, SELFMAG) != 0) return fail("not an ELF file");
    const auto header = r.get<Elf64_Ehdr>(0);
    if (header.e_type != ET_REL || header.e_machine != EM_X86_64 || header.e_ident[EI_CLASS] != ELFCLASS64)
        return fail("not relocatable x86-64 code");
    if (header.e_shentsize != sizeof(Elf64_Shdr) || !r.range(header.e_shoff, uint64_t(header.e_shnum) * sizeof(Elf64_Shdr)))
        return fail("damaged section table");
    for (size_t i = 0; i < header.e_shnum; i++) {
        r.sections.push_back(r.get<Elf64_Shdr>(header.e_shoff + i * sizeof(Elf64_Shdr)));
        const auto& s = r.sections.back();
        if (s.sh_type != SHT_NOBITS && !r.range(s.sh_offset, s.sh_size)) return fail("damaged section");
    }
    // Layout: executable sections and stubs, then read-only ones, then writable ones with the offset table; each group on its own
    // pages.
    const size_t page = size_t(sysconf(_SC_PAGESIZE));
    auto groupOf = [](const Elf64_Shdr& s) { return s.sh_flags & SHF_EXECINSTR ? 0 : s.sh_flags & SHF_WRITE ? 2 : 1; };
    std::vector<size_t> place(r.sections.size(), SIZE_MAX);
    std::vector<std::string> names(r.sections.size());
    if (header.e_shstrndx < r.sections.size())
        for (size_t i = 0; i < r.sections.size(); i++) names[i] = r.text(r.sections[header.e_shstrndx], r.sections[i].sh_name);
    size_t relocations = 0;
    for (const auto& s : r.sections)
        if (s.sh_type == SHT_RELA) relocations += s.sh_size / sizeof(Elf64_Rela);
    size_t end = 0, groupStart[4] = {};
    size_t stubs = 0, table = 0;
    for (int group = 0; group < 3; group++) {
        groupStart[group] = end = roundUp(end, page);
        for (size_t i = 0; i < r.sections.size(); i++) {
            const auto& s = r.sections[i];
            // Unwind tables are not needed: kernels neither throw nor are thrown through.
            if (!(s.sh_flags & SHF_ALLOC) || s.sh_size == 0 || groupOf(s) != group || names[i] == ".eh_frame") continue;
            if (s.sh_size > kLargestObject || s.sh_addralign > page) return fail("a section is too large");
            end = roundUp(end, std::max<size_t>(1, s.sh_addralign));
            place[i] = end;
            end += s.sh_size;
            if (end > kLargestObject) return fail("too large");
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
    groupStart[3] = end = roundUp(std::max<size_t>(end, 1), page);
    std::unique_ptr<LoadedObject> o(new LoadedObject);
    void* memory = mmap(nullptr, end, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    o->memory_ = memory;
    o->size_ = end;
    auto* base = static_cast<unsigned char*>(memory);
    for (size_t i = 0; i < r.sections.size(); i++)
        if (place[i] != SIZE_MAX && r.sections[i].sh_type != SHT_NOBITS)
            std::memcpy(base + place[i], elf.data() + r.sections[i].sh_offset, r.sections[i].sh_size);

    // Symbols.
    std::vector<uint64_t> address;
    std::vector<bool> isExternal;
    std::vector<std::string> symbolName;
    for (const auto& s : r.sections) {
        if (s.sh_type != SHT_SYMTAB) continue;
        if (s.sh_link >= r.sections.size()) return fail("damaged symbols");
        for (uint64_t at = 0; at + sizeof(Elf64_Sym) <= s.sh_size; at += sizeof(Elf64_Sym)) {
            const auto y = r.get<Elf64_Sym>(s.sh_offset + at);
            const std::string name = r.text(r.sections[s.sh_link], y.st_name);
            uint64_t value = 0;
            bool foreign = false;
            if (y.st_shndx == SHN_UNDEF) {
                value = reinterpret_cast<uint64_t>(external(name));
                if (!value && outside) value = reinterpret_cast<uint64_t>(outside(name));
                foreign = true;
            } else if (y.st_shndx < r.sections.size() && place[y.st_shndx] != SIZE_MAX) {
                if (y.st_value > r.sections[y.st_shndx].sh_size) return fail("symbol " + name + " outside its section");
                value = reinterpret_cast<uint64_t>(base) + place[y.st_shndx] + y.st_value;
                if (!name.empty() && ELF64_ST_BIND(y.st_info) == STB_GLOBAL) o->symbols_[name] = reinterpret_cast<void*>(value);
            }
            address.push_back(value);
            isExternal.push_back(foreign);
            symbolName.push_back(name);
        }
        break;
    }

    std::map<uint64_t, size_t> stubOf, slotOf;
    auto stub = [&](uint64_t target) -> uint64_t {
        auto [it, fresh] = stubOf.try_emplace(target, stubs + stubOf.size() * kStubBytes);
        if (it->second + kStubBytes > groupStart[1]) return 0;
        if (fresh) {
            const unsigned char jump[8] = {0xff, 0x25, 2, 0, 0, 0, 0x0f, 0x0b};
            std::memcpy(base + it->second, jump, 8);
            std::memcpy(base + it->second + 8, &target, 8);
        }
        return reinterpret_cast<uint64_t>(base) + it->second;
    };
    auto slot = [&](uint64_t target) -> uint64_t {
        auto [it, fresh] = slotOf.try_emplace(target, table + slotOf.size() * 8);
        if (it->second + 8 > end) return 0;
        if (fresh) std::memcpy(base + it->second, &target, 8);
        return reinterpret_cast<uint64_t>(base) + it->second;
    };
    for (const auto& s : r.sections) {
        if (s.sh_type == SHT_REL) return fail("relocations without addends");
        if (s.sh_type != SHT_RELA || s.sh_info >= r.sections.size() || place[s.sh_info] == SIZE_MAX) continue;
        const auto& target = r.sections[s.sh_info];
        for (uint64_t at = 0; at + sizeof(Elf64_Rela) <= s.sh_size; at += sizeof(Elf64_Rela)) {
            const auto e = r.get<Elf64_Rela>(s.sh_offset + at);
            const uint32_t type = ELF64_R_TYPE(e.r_info);
            const size_t index = ELF64_R_SYM(e.r_info);
            const size_t width = type == R_X86_64_64 || type == R_X86_64_PC64 ? 8 : 4;
            if (type == R_X86_64_NONE) continue;
            if (index >= address.size() || e.r_offset > target.sh_size || target.sh_size - e.r_offset < width)
                return fail("damaged relocation");
            uint64_t to = address[index];
            if (!to)
                return fail("it needs " + (symbolName[index].empty() ? std::string("a dropped section") : symbolName[index]));
            unsigned char* where = base + place[s.sh_info] + e.r_offset;
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
                if (isExternal[index]) to = stub(to);
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
                return fail("relocation of type " + std::to_string(type));
            }
            if (!fits) return fail("a relocation does not reach");
            std::memcpy(where, &value, width);
        }
    }
    auto protect = [&](int group, int flags) {
        const size_t size = groupStart[group + 1] - groupStart[group];
        return size == 0 || mprotect(base + groupStart[group], size, flags) == 0;
    };
    if (!protect(0, PROT_READ | PROT_EXEC) || !protect(1, PROT_READ)) {
        if (errno == ENOMEM) throw std::bad_alloc();
        return fail("memory cannot be made executable");
    }
    return o;
}

} // namespace alpenglow::rsl::jit
