// The runtime as LLVM bitcode, embedded in the program: the same templates as sections.cpp, compiled at other widths.
#pragma once
#include <cstddef>
#include <string_view>

namespace alpenglow::rsl {

struct Bitcode {
    const unsigned char* data;
    size_t size;
};

/// Bitcode of all Runtime symbols at 4, 8, 16, 32 or 64 lanes (typedef float vf __attribute__((ext_vector_type(lanes))));
/// {nullptr, 0} for other widths. Functions: void symbol_k(const vf* in, vf* out), k = 0, 1, 2, always inlined; pointers aligned
/// to a whole vf. Lane-wise operations only: the results are the same to the bit at every width. The target attributes are those
/// of the machine class that the width suits (4: x86-64-v2, 8: v3, others: v4) and may be replaced.
Bitcode runtimeBitcode(int lanes);

/// A hash of everything that the bitcode depends on; part of the kernel cache's key.
std::string_view runtimeHash();

} // namespace alpenglow::rsl
