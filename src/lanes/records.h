// Stages load and store: convert structures of 32-bit words to rows and back, by transposing squares of kW words.
#pragma once
#include "lanes/rows.h"

namespace alpenglow::lanes::AL_NAMESPACE {

/// Helpers of loadRecords() and storeRecords(): numbers as types.
template <class, int...> struct Numbers {};
template <class T, T... I> struct NumbersOf {
    using Type = Numbers<T, I...>; ///< T(I)...
};
using LaneNumbers = __make_integer_seq<NumbersOf, int, kW>::Type; ///< 0 to kW - 1

/// Interleaves the first, or the second, halves of two registers.
template <int Half, int... I> AL_INLINE vu inTurns(vu a, vu b, Numbers<int, I...>) {
    return __builtin_shufflevector(a, b, ((I % 2 ? kW : 0) + Half * kW / 2 + I / 2)...);
}

/// Row i, lane k becomes row k, lane i: each step moves the highest bit of the lane index to the lowest bit of the row index, and
/// vice versa.
AL_INLINE void transpose(vu (&rows)[kW]) {
    for (int step = 1; step < kW; step *= 2) {
        vu next[kW];
        for (int i = 0; i < kW / 2; ++i) {
            next[2 * i] = inTurns<0>(rows[i], rows[i + kW / 2], LaneNumbers());
            next[2 * i + 1] = inTurns<1>(rows[i], rows[i + kW / 2], LaneNumbers());
        }
        for (int i = 0; i < kW; ++i) rows[i] = next[i];
    }
}

/// Stages::load.
static void loadRecords(const void* from, int stride, int count, int words, void* rows) {
    uint32_t* to = static_cast<uint32_t*>(rows);
    for (int at = 0; at < kBlock; at += kW) {
        const char* record[kW];
        for (int k = 0; k < kW; ++k) {
            const int64_t i = at + k < count ? at + k : count - 1;
            record[k] = static_cast<const char*>(from) + i * stride;
        }
        for (int next = 0; next < words; next += kW) {
            const int word = next + kW <= words ? next : words - kW; // repeats the last words instead of reading beyond them
            vu square[kW];
            for (int k = 0; k < kW; ++k) __builtin_memcpy(&square[k], record[k] + 4 * word, sizeof square[k]);
            transpose(square);
            for (int k = 0; k < kW; ++k) store(to + (word + k) * kBlock + at, square[k]);
        }
    }
}

/// Stages::store.
static int storeRecords(const void* rows, int words, Lanes points, void* to) {
    const uint32_t* from = static_cast<const uint32_t*>(rows);
    int stored = 0;
    for (int at = 0; at < kBlock; at += kW) {
        int end = stored;
        for (int word = 0; word < words; word += kW) {
            vu square[kW];
            for (int k = 0; k < kW; ++k) square[k] = loadBits(from + (word + k) * kBlock + at);
            transpose(square);
            end = stored;
            for (int k = 0; k < kW; ++k) { // an excluded point is overwritten by the next one
                store(static_cast<uint32_t*>(to) + int64_t(end) * words + word, square[k]);
                end += int(points >> (at + k) & 1);
            }
        }
        stored = end;
    }
    return stored;
}

} // namespace alpenglow::lanes::AL_NAMESPACE
