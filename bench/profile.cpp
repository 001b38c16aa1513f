#include "bench/profile.h"
#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <dlfcn.h>
#include <elf.h>
#include <fstream>
#include <iterator>
#include <link.h>
#include <sys/time.h>
#include <ucontext.h>
#include <vector>

namespace alpenglow::bench {
namespace {

// A signal handler can reach nothing but globals.
constexpr size_t kMost = 1 << 18;
std::array<uintptr_t, kMost> places;
std::atomic<size_t> count{0};

void note(int, siginfo_t*, void* context) {
    size_t i = count.fetch_add(1, std::memory_order_relaxed);
    if (i < kMost) places[i] = uintptr_t(static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP]);
}

struct Symbol {
    uintptr_t begin, end;
    std::string name;
};

// The program's own symbol table, static functions included.
std::vector<Symbol> ownSymbols() {
    uintptr_t base = 0;
    dl_iterate_phdr(
        [](dl_phdr_info* i, size_t, void* to) {
            *static_cast<uintptr_t*>(to) = i->dlpi_addr;
            return 1;
        },
        &base);
    std::ifstream f("/proc/self/exe", std::ios::binary);
    std::vector<char> bytes((std::istreambuf_iterator<char>(f)), {});
    std::vector<Symbol> out;
    if (bytes.size() < sizeof(Elf64_Ehdr)) return out;
    const auto* head = reinterpret_cast<const Elf64_Ehdr*>(bytes.data());
    const auto* sections = reinterpret_cast<const Elf64_Shdr*>(bytes.data() + head->e_shoff);
    for (int s = 0; s < head->e_shnum; ++s) {
        if (sections[s].sh_type != SHT_SYMTAB) continue;
        const char* names = bytes.data() + sections[sections[s].sh_link].sh_offset;
        const auto* symbols = reinterpret_cast<const Elf64_Sym*>(bytes.data() + sections[s].sh_offset);
        for (size_t i = 0; i < sections[s].sh_size / sizeof(Elf64_Sym); ++i)
            if (ELF64_ST_TYPE(symbols[i].st_info) == STT_FUNC && symbols[i].st_size)
                out.push_back(
                    {base + symbols[i].st_value, base + symbols[i].st_value + symbols[i].st_size, names + symbols[i].st_name});
    }
    std::sort(out.begin(), out.end(), [](const Symbol& a, const Symbol& b) { return a.begin < b.begin; });
    return out;
}

void timer(int microseconds) {
    itimerval t{};
    t.it_interval.tv_usec = t.it_value.tv_usec = microseconds;
    setitimer(ITIMER_PROF, &t, nullptr);
}

} // namespace

void Profile::start() {
    count = 0;
    struct sigaction a{};
    a.sa_sigaction = note;
    a.sa_flags = SA_SIGINFO | SA_RESTART;
    sigaction(SIGPROF, &a, nullptr);
    timer(1000);
}

void Profile::stop() {
    timer(0);
    std::signal(SIGPROF, SIG_IGN);
}

std::map<std::string, uint64_t> Profile::bySymbol() const {
    std::vector<Symbol> own = ownSymbols();
    std::map<std::string, uint64_t> out;
    for (size_t k = 0; k < std::min(count.load(), kMost); ++k) {
        uintptr_t at = places[k];
        auto i = std::upper_bound(own.begin(), own.end(), at, [](uintptr_t a, const Symbol& s) { return a < s.begin; });
        if (i != own.begin() && at < std::prev(i)->end) {
            ++out[std::prev(i)->name];
            continue;
        }
        Dl_info info{};
        if (!dladdr(reinterpret_cast<void*>(at), &info) || !info.dli_fname) {
            ++out["[kernel code]"];
            continue;
        }
        const char* slash = std::strrchr(info.dli_fname, '/');
        ++out["[" + std::string(slash ? slash + 1 : info.dli_fname) + "]"];
    }
    return out;
}

} // namespace alpenglow::bench
