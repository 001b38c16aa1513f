// The bitcode files of the build folder as arrays, by the assembler's .incbin; those of few lanes as files next to the modules.
#include "shadeops/bitcode.h"
#include "base/digest.h"
#include "shadeops/descriptor.h"
#include "shadeops/narrowruntime.h"
#include <cstdint>
#include <string>
#include <vector>

#define AL_EMBED(name, file)                                                                                                     \
    asm(".section .rodata\n"                                                                                                     \
        ".balign 16\n"                                                                                                           \
        ".hidden " #name "\n.global " #name "\n" #name ":\n"                                                                     \
        ".incbin \"" ALPENGLOW_BITCODE_DIR "/" file "\"\n"                                                                       \
        ".hidden " #name "_end\n.global " #name "_end\n" #name "_end:\n"                                                         \
        ".byte 0\n"                                                                                                              \
        ".previous\n");                                                                                                          \
    extern "C" const unsigned char name[];                                                                                       \
    extern "C" const unsigned char name##_end[];

AL_EMBED(alpenglow_bitcode_16, "runtime16.bc")
AL_EMBED(alpenglow_bitcode_32, "runtime32.bc")
AL_EMBED(alpenglow_bitcode_64, "runtime64.bc")
AL_EMBED(alpenglow_bitcode_hash, "hash.txt")

namespace alpenglow::shadeops {
namespace {

Bitcode between(const unsigned char* begin, const unsigned char* end) { return {begin, static_cast<size_t>(end - begin)}; }

const NarrowRuntime& narrow(int lanes) {
    const Bitcode hash = between(alpenglow_bitcode_hash, alpenglow_bitcode_hash_end);
    return narrowRuntime(lanes, {reinterpret_cast<const char*>(hash.data), hash.size});
}

/// Over everything in the descriptors that becomes code.
uint64_t hashDescriptors() {
    Digest all;
    const auto add = [&all](std::string_view text) {
        all.add(text);
        all.add("\xff");
    };
    for (const Shadeop& op : allShadeops()) {
        add(op.name);
        add(op.rsl);
        add(std::to_string(static_cast<int>(op.lowering)) + std::to_string(static_cast<int>(op.derivative)) +
            (op.pure ? "p" : "e"));
        for (const Signature& s : op.signatures) {
            add(s.text);
            add(s.symbol);
        }
    }
    return all.value();
}

} // namespace

Bitcode runtimeBitcode(int lanes) {
    switch (lanes) {
    case 4:
    case 8: {
        const std::vector<uint8_t>& bytes = narrow(lanes).bytes;
        return {bytes.empty() ? nullptr : bytes.data(), bytes.size()};
    }
    case 16:
        return between(alpenglow_bitcode_16, alpenglow_bitcode_16_end);
    case 32:
        return between(alpenglow_bitcode_32, alpenglow_bitcode_32_end);
    case 64:
        return between(alpenglow_bitcode_64, alpenglow_bitcode_64_end);
    default:
        return {nullptr, 0};
    }
}

std::string runtimeLack(int lanes) {
    for (const int n : {4, 8})
        if (lanes <= n && !narrow(n).lack.empty()) return narrow(n).lack;
    return {};
}

std::string_view runtimeHash(int lanes) {
    static const std::string hash =
        std::string(reinterpret_cast<const char*>(alpenglow_bitcode_hash), 64) + "-" + std::to_string(hashDescriptors());
    if (lanes > 8) return hash;
    static const std::string narrowHash = [] {
        Digest all;
        for (const int n : {4, 8}) all.add(narrow(n).bytes.data(), narrow(n).bytes.size());
        return hash + "-" + digestText(all.value());
    }();
    return narrowHash;
}

} // namespace alpenglow::shadeops
