// The runtime as LLVM bitcode: the same templates as sections.cpp, compiled at other widths. For 16 lanes and more it is part of
// the program; for 4 and 8 it is in the files alpenglow_runtime4.bc and alpenglow_runtime8.bc next to the program's modules.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace alpenglow::shadeops {

/// LLVM bitcode of the runtime, compiled into the program.
struct Bitcode {
    const unsigned char* data; ///< not null
    size_t size;               ///< bytes
};

/// Bitcode of all Runtime symbols at 4, 8, 16, 32 or 64 lanes (typedef float vf __attribute__((ext_vector_type(lanes))));
/// {nullptr, 0} for other widths, and where runtimeLack says why. Functions: void symbol_k(const vf* in, vf* out), k = 0, 1, 2,
/// always inlined; pointers aligned to a whole vf. Lane-wise operations only: the results are the same to the bit at every width.
/// The target attributes are those of the machine class that the width suits (4: x86-64-v2, 8: v3, others: v4) and may be
/// replaced.
Bitcode runtimeBitcode(int lanes);

/// Why shaders cannot be compiled at `lanes` lanes, and what to do; "" when they can.
std::string runtimeLack(int lanes);

/// A hash of everything that the bitcode depends on, that for `lanes` lanes included; part of the kernel cache's key.
std::string_view runtimeHash(int lanes = 16);

} // namespace alpenglow::shadeops
