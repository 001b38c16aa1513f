// The bitcode files of the build folder as arrays, by the assembler's .incbin.
#include "shadeops/bitcode.h"
#include "base/digest.h"
#include "shadeops/descriptor.h"
#include <cstdint>
#include <string>

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

AL_EMBED(alpenglow_bitcode_4, "runtime4.bc")
AL_EMBED(alpenglow_bitcode_8, "runtime8.bc")
AL_EMBED(alpenglow_bitcode_16, "runtime16.bc")
AL_EMBED(alpenglow_bitcode_32, "runtime32.bc")
AL_EMBED(alpenglow_bitcode_64, "runtime64.bc")
AL_EMBED(alpenglow_bitcode_hash, "hash.txt")

namespace alpenglow::rsl {
namespace {

Bitcode between(const unsigned char* begin, const unsigned char* end) { return {begin, static_cast<size_t>(end - begin)}; }

/// Over everything in the descriptors that becomes code.
uint64_t hashDescriptors() {
    Digest all;
    const auto add = [&all](std::string_view text) {
        all.add(text);
        all.add("\xff");
    };
    for (const Shadeop& op : shadeops()) {
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
        return between(alpenglow_bitcode_4, alpenglow_bitcode_4_end);
    case 8:
        return between(alpenglow_bitcode_8, alpenglow_bitcode_8_end);
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

std::string_view runtimeHash() {
    static const std::string hash =
        std::string(reinterpret_cast<const char*>(alpenglow_bitcode_hash), 64) + "-" + std::to_string(hashDescriptors());
    return hash;
}

} // namespace alpenglow::rsl
