// The patterns of bench/shaders (and of their published relatives) written by hand, for comparison with what the compiler makes.
#pragma once

namespace alpenglow::bench {

/// Points over the unit square. out: Ci and Oi, six rows.
struct Points {
    const float *u, *v, *du, *dv; ///< a point is a hit: each has a footprint of its own
    float* out[6];
    int n; ///< a multiple of 64
};

using Pattern = void (*)(const Points&);

/// Null: no such pattern.
struct NamedPattern {
    const char* name;
    Pattern run;
};

// One list a way of writing, of the same patterns in the same order, ended by a null name.
extern const NamedPattern kScalar[];     ///< one point at a time, vectorisers off
extern const NamedPattern kAvx512x16[];  ///< vector types of 16 lanes
extern const NamedPattern kAvx512x32[];  ///< two registers in flight
extern const NamedPattern kAvx512x64[];  ///< four
extern const NamedPattern kAvx2Scalar[]; ///< for processors without AVX-512: the same with 256-bit registers
extern const NamedPattern kAvx2x8[];
extern const NamedPattern kAvx2x16[];

} // namespace alpenglow::bench
