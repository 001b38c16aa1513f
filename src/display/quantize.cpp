#include "display/quantize.h"
#include <cmath>

namespace alpenglow::display {

float quantise(const Quantization& q, float value, float noise) {
    if (q.floating()) return value;
    double v =
        std::floor(double(q.zero) + double(value) * (double(q.one) - double(q.zero)) + double(q.dither) * double(noise) + 0.5);
    if (!(v >= q.min)) return q.min; // also NaN
    return v > q.max ? q.max : float(v);
}

float ditherNoise(int x, int y, int channel) {
    // A 64-bit finaliser (xor-shift, multiply) over the packed coordinates; 14 bits of it select the centre of one of 16384 equal
    // steps, so that noise stays further from +-1 than the rounding error of a value for an 8-bit code.
    uint64_t h = uint64_t(uint32_t(x)) << 32 | uint32_t(y);
    h += uint64_t(uint32_t(channel)) * 0x9e3779b97f4a7c15ull + 0x632be59bd9b4e019ull;
    for (int i = 0; i < 2; ++i) {
        h ^= h >> 32;
        h *= 0xd6e8feb86659fd93ull;
    }
    h ^= h >> 32;
    return (float(h & 0x3fff) + 0.5f) / 8192.0f - 1.0f;
}

Quantization quantizationOf(const scene::Quantize& ri, const scene::ParamList& params, Diagnostics& diags, bool* explicitly) {
    Quantization q{0, ri.one, ri.min, ri.max, ri.dither};
    bool asked = ri.set;
    if (const scene::Param* p = scene::find(params, "quantize")) {
        if (p->numbers.size() == 4) {
            q = {p->numbers[0], p->numbers[1], p->numbers[2], p->numbers[3], q.dither};
            asked = true;
        } else {
            diags.report(Severity::Error, Rie::Consistency, p->place,
                         "\"quantize\" of a display takes 4 numbers (zero one min max), not " +
                             std::to_string(p->numbers.size()));
        }
    }
    if (const scene::Param* p = scene::find(params, "dither")) {
        if (p->numbers.size() == 1) q.dither = p->numbers[0];
        else diags.report(Severity::Error, Rie::Consistency, p->place, "\"dither\" of a display takes 1 number");
    }
    bool finite =
        std::isfinite(q.zero) && std::isfinite(q.one) && std::isfinite(q.min) && std::isfinite(q.max) && std::isfinite(q.dither);
    if (!finite || q.min > q.max) {
        diags.report(Severity::Error, Rie::Range, {},
                     "quantisation with min above max, or not finite; floating point is written");
        q = {};
    }
    if (explicitly) *explicitly = asked;
    return q;
}

} // namespace alpenglow::display
