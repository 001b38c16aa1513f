#include "render/samplebuffer.h"
#include "base/parallel.h"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace alpenglow::render {
namespace {

constexpr uint32_t kPositionSite = 0;
constexpr int kColor = 2, kOpacity = 5, kDepth = 8, kDepth2 = 9, kAovs = 10;
constexpr float kInf = std::numeric_limits<float>::infinity();

// Whole pixels beyond the window that a filter of full width w, centred on a pixel, can reach.
int border(double w) { return std::max(0, int(std::ceil(w / 2 - 0.5))); }

} // namespace

Vec2 stratifiedOffset(uint64_t seed, int x, int y, int k, int nx, int ny, Jitter jitter) {
    Vec2 u{0.5f, 0.5f};
    if (jitter == Jitter::Middle) return u;
    if (jitter != Jitter::Grid) u = Sampler(seed, x, y).get2(0, kPositionSite, 0, uint32_t(k));
    if (jitter == Jitter::Scrambled) return u;
    // float rounding could reach 1, which is the next pixel's
    constexpr float below = 1 - 0x1p-24f;
    return {std::min(below, (float(k % nx) + u.x) / float(nx)), std::min(below, (float(k / nx) + u.y) / float(ny))};
}

std::optional<DepthFilter> depthFilterByName(std::string_view n) {
    if (n == "min" || n == "zmin") return DepthFilter::Min;
    if (n == "max" || n == "zmax") return DepthFilter::Max;
    if (n == "average") return DepthFilter::Average;
    if (n == "midpoint") return DepthFilter::Midpoint;
    return {};
}

SampleBuffer::SampleBuffer(Window w, double maxXw, double maxYw, int nx, int ny, std::vector<Channel> aovs, uint64_t seed,
                           Jitter j)
    : window_(w), nx_(nx), ny_(ny), aovs_(std::move(aovs)), seed_(seed), jitter_(j), stride_(kAovs + aovs_.size()) {
    int bx = border(maxXw), by = border(maxYw);
    sampled_ = {w.x0 - bx, w.y0 - by, w.x1 + bx, w.y1 + by};
    data_.assign(sampled_.pixels() * size_t(nx * ny) * stride_, 0);
    for (size_t i = 0; i < data_.size(); i += stride_) data_[i] = -1;
}

Vec2 SampleBuffer::position(int x, int y, int k) const {
    Vec2 o = stratifiedOffset(seed_, x, y, k, nx_, ny_, jitter_);
    return {float(x) + o.x, float(y) + o.y};
}

bool SampleBuffer::set(int x, int y, int k, const ImageSample& s) {
    float* d = &data_[base(x, y, k)];
    const bool again = d[0] >= 0 || d[1] > 0; // a task that is done again counts once
    const auto drop = [&] {
        if (!again) std::atomic_ref<uint64_t>(nonFinite_).fetch_add(1, std::memory_order_relaxed);
    };
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(s.color[i]) || !std::isfinite(s.opacity[i])) {
            drop();
            d[1] = 1;
            return false;
        }
    auto depth = [&](float z) {
        if (!std::isnan(z)) return z;
        drop();
        return kInf;
    };
    for (int i = 0; i < 3; ++i) {
        d[kColor + i] = s.color[i];
        d[kOpacity + i] = s.opacity[i];
    }
    d[kDepth] = depth(s.z);
    d[kDepth2] = depth(s.zSecond);
    for (size_t i = 0; i < aovs_.size(); ++i) {
        float v = i < s.aovs.size() ? s.aovs[i] : 0;
        if (std::isnan(v) || (aovs_[i].rule == ChannelRule::Average && std::isinf(v))) {
            drop();
            v = 0;
        }
        d[kAovs + i] = v;
    }
    Vec2 o = stratifiedOffset(seed_, x, y, k, nx_, ny_, jitter_);
    d[0] = o.x;
    d[1] = o.y;
    return true;
}

Color SampleBuffer::color(int x, int y, int k) const {
    const float* d = &data_[base(x, y, k)];
    return d[0] < 0 ? Color(0) : Color(d[kColor], d[kColor + 1], d[kColor + 2]);
}

void SampleBuffer::pixel(const PixelFilter& f, DepthFilter depth, int x, int y, float* out) const {
    const int spp = nx_ * ny_, bx = border(f.xw), by = border(f.yw);
    const size_t naov = aovs_.size(), nsum = 6 + naov;
    std::vector<double> sum(nsum, 0);
    double weight = 0, absolute = 0;
    auto accumulate = [&](const float* s, double w) {
        weight += w;
        absolute += std::fabs(w);
        for (size_t i = 0; i < 6; ++i) sum[i] += w * s[kColor + i];
        for (size_t i = 0; i < naov; ++i)
            if (aovs_[i].rule == ChannelRule::Average) sum[6 + i] += w * s[kAovs + i];
    };
    for (int j = y - by; j <= y + by; ++j)
        for (int i = x - bx; i <= x + bx; ++i)
            for (int k = 0; k < spp; ++k) {
                const float* s = &data_[base(i, j, k)];
                if (s[0] < 0) continue;
                double w = f(double(i - x) + s[0] - 0.5, double(j - y) + s[1] - 0.5);
                if (w != 0) accumulate(s, w);
            }
    if (!(weight > 1e-6 * absolute)) {
        std::fill(sum.begin(), sum.end(), 0);
        weight = 0;
        for (int k = 0; k < spp; ++k)
            if (const float* s = &data_[base(x, y, k)]; s[0] >= 0) accumulate(s, 1);
    }
    double scale = weight > 0 ? 1 / weight : 0;
    for (int i = 0; i < 3; ++i) {
        out[i] = float(sum[size_t(i)] * scale);
        out[4 + i] = float(sum[size_t(3 + i)] * scale);
    }
    out[3] = float((sum[3] + sum[4] + sum[5]) / 3 * scale);

    float least = kInf, most = -kInf, middle = kInf;
    double zsum = 0;
    int hits = 0, samples = 0;
    for (size_t i = 0; i < naov; ++i)
        out[kImageFixedChannels + i] = aovs_[i].rule == ChannelRule::Average ? float(sum[6 + i] * scale)
                                       : aovs_[i].rule == ChannelRule::Min   ? kInf
                                                                             : -kInf;
    for (int k = 0; k < spp; ++k) {
        const float* s = &data_[base(x, y, k)];
        if (s[0] < 0) continue;
        ++samples;
        least = std::min(least, s[kDepth]);
        most = std::max(most, s[kDepth]);
        middle = std::min(middle, s[kDepth] / 2 + s[kDepth2] / 2);
        if (std::isfinite(s[kDepth])) {
            zsum += s[kDepth];
            ++hits;
        }
        for (size_t i = 0; i < naov; ++i) {
            float& v = out[kImageFixedChannels + i];
            if (aovs_[i].rule == ChannelRule::Min) v = std::min(v, s[kAovs + i]);
            else if (aovs_[i].rule == ChannelRule::Max) v = std::max(v, s[kAovs + i]);
        }
    }
    switch (depth) {
    case DepthFilter::Min:
        out[7] = least;
        break;
    case DepthFilter::Max:
        out[7] = samples ? most : kInf;
        break;
    case DepthFilter::Average:
        out[7] = hits ? float(zsum / hits) : kInf;
        break;
    case DepthFilter::Midpoint:
        out[7] = middle;
        break;
    }
}

Image SampleBuffer::reconstruct(const PixelFilter& filter, DepthFilter depth, Window out) const {
    Image image;
    image.window = out;
    image.channels = {"r", "g", "b", "a", "Or", "Og", "Ob", "z"};
    for (const Channel& c : aovs_) image.channels.push_back(c.name);
    // A filter wider than the border was made for is cut, not read beyond the buffer.
    PixelFilter f = filter;
    f.xw = std::min(f.xw, 2.0 * (window_.x0 - sampled_.x0) + 1);
    f.yw = std::min(f.yw, 2.0 * (window_.y0 - sampled_.y0) + 1);
    size_t n = image.channels.size();
    image.data.resize(out.pixels() * n);
    parallelFor(out.y0, out.y1, [&](int y) {
        for (int x = out.x0; x < out.x1; ++x)
            pixel(f, depth, x, y, &image.data[(size_t(y - out.y0) * size_t(out.width()) + size_t(x - out.x0)) * n]);
    });
    return image;
}

} // namespace alpenglow::render
