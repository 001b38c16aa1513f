#include "ri/c/strings.h"
#include "base/limits.h"
#include <cstdint>
#include <cstring>
#include <sys/uio.h>
#include <unistd.h>

namespace alpenglow::ri {

namespace {

/// Copies up to n bytes of this process; how many could be read.
size_t peek(uintptr_t from, char* to, size_t n) {
    iovec local{to, n}, remote{reinterpret_cast<void*>(from), n};
    const ssize_t got = process_vm_readv(getpid(), &local, 1, &remote, 1, 0);
    return got < 0 ? 0 : size_t(got);
}

/// Whether the system can tell which memory is readable. If it cannot, addresses are assumed to be valid.
bool canPeek() {
    static const bool can = [] {
        const char here = 'x';
        char there = 0;
        return peek(reinterpret_cast<uintptr_t>(&here), &there, 1) == 1 && there == here;
    }();
    return can;
}

constexpr uintptr_t kLowest = 65536;               ///< nothing is mapped below
constexpr uintptr_t kHighest = uintptr_t(1) << 47; ///< of a program on this processor

} // namespace

bool endsWhereItCanBeRead(const void* array, size_t bytes) {
    constexpr size_t kShort = 4096;
    char last;
    return bytes < kShort || !canPeek() || peek(reinterpret_cast<uintptr_t>(array) + bytes - 1, &last, 1) == 1;
}

std::optional<std::string> textInsteadOfAddress(const void* value) {
    if (!canPeek()) return {};
    const auto at = reinterpret_cast<uintptr_t>(value);
    char word[sizeof(uintptr_t)] = {}, byte;
    size_t got = peek(at, word, sizeof word);
    if (got == 0) // at the end of what can be read
        while (got < sizeof word && peek(at + got, word + got, 1) == 1) ++got;
    if (got == 0) return {};
    uintptr_t address = 0;
    std::memcpy(&address, word, sizeof address);
    if (address == 0 && got == sizeof word) return {}; // a null string: reported where it is used
    if (got == sizeof word && address >= kLowest && address < kHighest && peek(address, &byte, 1) == 1) return {};
    std::string text;
    for (char c; text.size() < size_t(limits::kTokenBytes) && peek(at + text.size(), &c, 1) == 1 && c != 0;) text += c;
    return text;
}

} // namespace alpenglow::ri
