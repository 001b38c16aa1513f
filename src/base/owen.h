// Nested uniform scrambling by hashes, in constant time: what the sampler is made of. Every function is a chain of 32-bit integer
// operations without a branch or a table, written over any type U that has them: uint32_t, or a row of lanes.
//
// "Reversed" values have their first (most significant) binary digit in bit 0. There, a function whose output bit k depends on
// input bits 0..k only, one to one, is a nested permutation of the digits: the flip of a digit depends on the digits before it.
// Additions, products with odd numbers and v ^ v * even are such functions (Laine and Karras, "Stratified Sampling for Stochastic
// Transparency", 2011; Burley, "Practical Hash-based Owen Scrambling", 2020). Elementary intervals are kept exactly, whatever the
// quality of the hash. Its weakness is the first digits, on which few bits of its seed work: there the flips are coins, one for
// each node of the tree. That all flips are as good as independent coins is tested (docs/proof.md).
#pragma once
#include <cstdint>

namespace alpenglow {

/// The 32 bits in the opposite order.
template <class U> constexpr U reverseBits(U v) {
    v = (v >> 16) | (v << 16);
    v = ((v & U(0xff00ff00u)) >> 8) | ((v & U(0x00ff00ffu)) << 8);
    v = ((v & U(0xf0f0f0f0u)) >> 4) | ((v & U(0x0f0f0f0fu)) << 4);
    v = ((v & U(0xccccccccu)) >> 2) | ((v & U(0x33333333u)) << 2);
    return ((v & U(0xaaaaaaaau)) >> 1) | ((v & U(0x55555555u)) << 1);
}

/// A nested scramble of a reversed value: seed and factor are random words. Constants by N. Vegdahl, "Building a Better LK Hash"
/// (2021), where the factor is the upper half of the seed; here it is a separate word.
template <class U> constexpr U owenReversed(U v, U seed, U factor) {
    v = v ^ v * U(0x3d20adeau);
    v = v + seed;
    v = v * (factor | U(1));
    v = v ^ v * U(0x05526c56u);
    return v ^ v * U(0x53a22864u);
}

/// Flips the first five digits of a reversed value by independent bits: the 1, 2, 4, 8 and 16 nodes of these digits have one bit
/// of `coins` each (bit 31 is unused). So the first 32 points of a sequence are scrambled exactly.
template <class U> constexpr U coinsReversed(U v, U coins) {
    const U one(1u);
    return v ^ (coins & one) ^ (((coins >> 1) >> (v & U(1u)) & one) << 1) ^ (((coins >> 3) >> (v & U(3u)) & one) << 2) ^
           (((coins >> 7) >> (v & U(7u)) & one) << 3) ^ (((coins >> 15) >> (v & U(15u)) & one) << 4);
}

/// The scramble of a coordinate, reversed: coins for the first five digits, the hash for the others.
template <class U> constexpr U scrambleReversed(U v, U coins, U seed, U factor) {
    return (coinsReversed(v, coins) & U(31u)) | (owenReversed(v, seed, factor) & U(~31u));
}

/// Point i of the second Sobol dimension, reversed; the first dimension is i itself. Digit j is the sum over the digits k of i of
/// the binomial coefficient (k over j) mod 2, which is 1 if the bits of j are a subset of those of k (Lucas): a sum over
/// supersets, in one step for each of the five bits of a digit's index.
template <class U> constexpr U sobol1Reversed(U i) {
    i = i ^ ((i >> 16) & U(0x0000ffffu));
    i = i ^ ((i >> 8) & U(0x00ff00ffu));
    i = i ^ ((i >> 4) & U(0x0f0f0f0fu));
    i = i ^ ((i >> 2) & U(0x33333333u));
    return i ^ ((i >> 1) & U(0x55555555u));
}

/// 128 bits as four words; U: uint32_t or a vector of them.
template <class U> struct Words4 {
    U x, y, z, w; ///< from the first to the last word
};

/// One round of pcg4d, without its shifts.
template <class U> constexpr Words4<U> roundOfWords(Words4<U> v) {
    v.x = v.x + v.y * v.w;
    v.y = v.y + v.z * v.x;
    v.z = v.z + v.x * v.y;
    v.w = v.w + v.y * v.z;
    return v;
}

/// Four words more, of words that are mixed: another round.
template <class U> constexpr Words4<U> moreWords(const Words4<U>& v) {
    return roundOfWords<U>({v.x ^ (v.x >> 16), v.y ^ (v.y >> 16), v.z ^ (v.z >> 16), v.w ^ (v.w >> 16)});
}

/// A bijection of 128 bits in which each output bit depends on all inputs: pcg4d of Jarzynski and Olano, "Hash Functions for GPU
/// Rendering" (2020), with one more round. A round carries bits upward only and shifts down by 16: after two rounds the lowest
/// bits do not yet depend on the highest input bits.
template <class U> constexpr Words4<U> mixWords(Words4<U> v) {
    const U a(1664525u), c(1013904223u);
    v = roundOfWords<U>({v.x * a + c, v.y * a + c, v.z * a + c, v.w * a + c});
    return moreWords<U>(moreWords<U>(v));
}

/// The words that scramble one stream, from the key of pixel and replica (two random words), vertex, site and occurrence. For one
/// key distinct (vertex, site, occurrence) are distinct inputs of mixWords(), so the words are distinct.
template <class U> constexpr Words4<U> streamWords(U low, U high, U vertex, U site, U occurrence) {
    return mixWords<U>({low + occurrence * U(0x9e3779b9u), high ^ (occurrence * U(0x85ebca6bu)), vertex, site});
}

/// Scrambles of one stream: the words of its key, and four more derived from them.
template <class U> struct Scrambles {
    Words4<U> s, more; ///< as mixWords() and moreWords() give them
    /// From streamWords().
    constexpr explicit Scrambles(const Words4<U>& words) : s(words), more(moreWords<U>(words)) {}
    /// The sample's index, reversed, in the order of the stream: a nested scramble, which keeps aligned blocks of 2^m samples
    /// together. (Its first digits are 0 for all samples of a pixel: no coins.)
    constexpr U shuffledIndex(U reversedIndex) const { return reverseBits<U>(owenReversed<U>(reversedIndex, s.x, s.w)); }
    /// The coordinates of the point of that index, 32-bit binary fractions.
    constexpr U first(U index) const { return reverseBits<U>(scrambleReversed<U>(index, s.y, more.y, more.w)); }
    /// The second coordinate.
    constexpr U second(U index) const {
        return reverseBits<U>(scrambleReversed<U>(sobol1Reversed<U>(index), s.z, more.z, (more.w << 16) | (more.w >> 16)));
    }
};

} // namespace alpenglow
