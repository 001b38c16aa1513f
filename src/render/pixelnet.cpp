#include "render/pixelnet.h"
#include "render/rendering.h"
#include <algorithm>

namespace alpenglow::render {
namespace {

/// Irreducible polynomials of degree 1 to 12 over GF(2), for the fields with 2 to 4096 elements.
constexpr int kPolynomials[12] = {0x3, 0x7, 0xb, 0x13, 0x25, 0x43, 0x83, 0x11d, 0x211, 0x409, 0x805, 0x1053};

bool prime(int n) {
    for (int d = 2; d * d <= n; ++d)
        if (n % d == 0) return false;
    return n >= 2;
}

/// Product of two elements of the field with 2^degree elements.
int productOfTwos(int a, int b, int degree) {
    int r = 0;
    for (int i = 0; i < degree; ++i)
        if (b >> i & 1) r ^= a << i;
    for (int i = 2 * degree - 2; i >= degree; --i)
        if (r >> i & 1) r ^= kPolynomials[degree - 1] << (i - degree);
    return r;
}

/// Position of number i of n in a permutation by seed: hash of Kensler, "Correlated multi-jittered sampling" (2013).
uint32_t permuted(uint32_t i, uint32_t n, uint32_t seed) {
    uint32_t w = n - 1;
    for (int shift : {1, 2, 4, 8, 16}) w |= w >> shift;
    do {
        i ^= seed;
        i *= 0xe170893du;
        i ^= seed >> 16;
        i ^= (i & w) >> 4;
        i ^= seed >> 8;
        i *= 0x0929eb3fu;
        i ^= seed >> 23;
        i ^= (i & w) >> 1;
        i *= 1 | seed >> 27;
        i *= 0x6935fa69u;
        i ^= (i & w) >> 11;
        i *= 0x74dcb303u;
        i ^= (i & w) >> 2;
        i *= 0x9e501cc3u;
        i ^= (i & w) >> 2;
        i *= 0xc860a3dfu;
        i &= w;
        i ^= i >> 5;
    } while (i >= n);
    return (i + seed) % n;
}

/// (whole + part) / n, less than 1.
float strataNumber(uint32_t whole, double part, double n) { return std::min(float((double(whole) + part) / n), 1 - 0x1p-24f); }

} // namespace

PixelNet::PixelNet(int nx, int ny, bool moves, bool lens) : nx_(nx), count_(nx * ny), moves_(moves), lens_(lens) {
    two_ = (nx & (nx - 1)) == 0;
    if (nx != ny || nx < 2) return;
    side_ = nx;
    factors_ = two_ || prime(nx) ? nx - 1 : 1; // x + y is a Latin square of any side
    int g = 1;
    if (moves_) time_ = column(g++);
    if (!lens_ || g + 1 > factors_) return;
    lensX_ = column(g);
    lensY_ = column(g + 1);
}

PixelNet::Column PixelNet::column(int g) const {
    int degree = 0;
    while (1 << degree < side_) ++degree;
    const int cut = g < factors_ ? g + 1 : 0; // 0: rows divide its levels
    Column c;
    for (int y = 0; y < side_; ++y) {
        c.level.push_back(two_ ? productOfTwos(g, y, degree) : g * y % side_);
        if (cut) c.part.push_back(two_ ? productOfTwos(cut, y, degree) : cut * y % side_);
    }
    return c;
}

PixelNet::Pixel PixelNet::pixel(const Sampler& s) const {
    const SampleNumbers own(s, 0);
    const auto words = [&](uint32_t n) { return streamWords<uint32_t>(own.low(), own.high(), 0, kUseNet << 1, n); };
    return {s, words(0), words(1), words(2), words(3)};
}

int PixelNet::sum(int a, int b) const { return two_ ? a ^ b : (a + b) % side_; }

float PixelNet::number(const Column& c, const Words4<uint32_t>& words, int x, int y, uint32_t within) const {
    const uint32_t s = uint32_t(side_);
    const uint32_t level = uint32_t(sum(x, c.level[size_t(y)]));
    const uint32_t part = uint32_t(c.part.empty() ? y : sum(x, c.part[size_t(y)]));
    const uint32_t digits = permuted(level, s, words.x) * s + permuted(part, s, words.y + level * 0x9e3779b9u);
    return strataNumber(digits, double(unitFloat(within)), double(s) * double(s));
}

PixelNet::Numbers PixelNet::sample(const Pixel& p, int k) const {
    Numbers r;
    const Words4<uint32_t> within = mixWords<uint32_t>({p.all.x, p.all.y, uint32_t(k), p.all.z});
    int x = 0, y = 0;
    if (side_) {
        x = int(permuted(uint32_t(k % nx_), uint32_t(side_), p.all.z));
        y = int(permuted(uint32_t(k / nx_), uint32_t(side_), p.all.w));
    }
    if (moves_ && !time_.level.empty()) r.time = number(time_, p.time, x, y, within.x);
    else if (moves_)
        r.time = strataNumber(permuted(uint32_t(k), uint32_t(count_), p.time.x), double(unitFloat(within.x)), double(count_));
    if (!lens_) return r;
    if (!lensX_.level.empty()) r.lens = {number(lensX_, p.lensX, x, y, within.y), number(lensY_, p.lensY, x, y, within.z)};
    else r.lens = p.sampler.get2(0, kUseLens, 0, uint32_t(k) * kReplicas); // all in the first replica
    return r;
}

} // namespace alpenglow::render
