// Converts image samples to pixels: weighted sums, in blocks of pixels, and values from a pixel's own samples only.
#include "base/parallel.h"
#include "render/samplebuffer.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace alpenglow::render {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr int kRows = 16;           // in a block
constexpr int kSamplesOfRow = 2048; // in a row of a block, about: their weights stay in the L1 cache
constexpr size_t kFixedSums = 8;    // for a pixel: weights, their absolute values, colour, opacity; then the AOVs

} // namespace

/// Scratch memory for a block of pixels. Weights are by column relative to the pixel, then by sample of a row.
struct SampleBuffer::Scratch {
    int bx = 0, by = 0;
    size_t samples = 0; ///< in a row: those of the block and of bx pixels on both sides
    std::vector<float> across, down, weights;
    std::vector<double> sums; ///< by pixel of the block
};

FilterWeights SampleBuffer::weights(const PixelFilter& filter) const {
    PixelFilter f = filter;
    f.xw = std::min(f.xw, 2.0 * (window_.x0 - sampled_.x0) + 1);
    f.yw = std::min(f.yw, 2.0 * (window_.y0 - sampled_.y0) + 1);
    return FilterWeights(f);
}

/// For a row of samples: x factors of a separable filter for each column around a pixel. 0: no sample.
void SampleBuffer::weigh(const FilterWeights& f, const Window& block, int row, Scratch& to) const {
    const float* s = &data_[base(block.x0 - to.bx, row, 0)];
    for (size_t i = 0; i < to.samples; ++i, s += stride_)
        for (int di = -to.bx; di <= to.bx; ++di)
            to.across[size_t(di + to.bx) * to.samples + i] = s[0] < 0 ? 0 : f.across(double(di) + s[0] - 0.5);
}

/// Weights of a row of samples for row y of a block, for separable filters.
void SampleBuffer::multiply(const FilterWeights& f, const Window& block, int row, int y, Scratch& to) const {
    const float* s = &data_[base(block.x0 - to.bx, row, 0)];
    for (size_t i = 0; i < to.samples; ++i, s += stride_) to.down[i] = f.down(double(row - y) + s[1] - 0.5);
    const float* down = to.down.data();
    for (int di = 0; di <= 2 * to.bx; ++di) {
        const float* across = &to.across[size_t(di) * to.samples];
        float* w = &to.weights[size_t(di) * to.samples];
        for (size_t i = 0; i < to.samples; ++i) w[i] = across[i] * down[i];
    }
}

/// The same for any filter.
void SampleBuffer::weighEach(const FilterWeights& f, const Window& block, int row, int y, Scratch& to) const {
    const float* s = &data_[base(block.x0 - to.bx, row, 0)];
    for (size_t i = 0; i < to.samples; ++i, s += stride_)
        for (int di = -to.bx; di <= to.bx; ++di)
            to.weights[size_t(di + to.bx) * to.samples + i] =
                s[0] < 0 ? 0 : f(double(di) + s[0] - 0.5, double(row - y) + s[1] - 0.5);
}

/// Adds a row of samples to the sums of row y of a block.
void SampleBuffer::addRow(const Window& block, int row, int y, Scratch& to) const {
    const size_t spp = size_t(nx_ * ny_), naov = aovs_.size(), nsum = kFixedSums + naov;
    double* sum = &to.sums[size_t(y - block.y0) * size_t(block.width()) * nsum];
    for (int x = block.x0; x < block.x1; ++x, sum += nsum) {
        double a[kFixedSums];
        std::copy_n(sum, kFixedSums, a);
        for (int di = 0; di <= 2 * to.bx; ++di) {
            const float* w = &to.weights[size_t(di) * to.samples + size_t(x - block.x0 + di) * spp];
            const float* s = &data_[base(x + di - to.bx, row, 0)];
            for (size_t k = 0; k < spp; ++k, s += stride_) {
                const double v = w[k];
                a[0] += v;
                a[1] += std::fabs(v);
                for (size_t c = 0; c < 6; ++c) a[2 + c] += v * double(s[kColor + c]);
                for (size_t c = 0; c < naov; ++c) sum[kFixedSums + c] += v * double(s[kAovs + c]);
            }
        }
        std::copy_n(a, kFixedSums, sum);
    }
}

bool SampleBuffer::hasSamples(const Window& w) const {
    if (!averagesAll_) return true;
    for (int y = w.y0; y < w.y1; ++y) {
        const float* s = &data_[base(w.x0, y, 0)];
        for (size_t i = 0; i < size_t(w.width()) * size_t(nx_ * ny_); ++i, s += stride_)
            if (s[0] >= 0) return true;
    }
    return false;
}

void SampleBuffer::block(const FilterWeights& f, const Window& block, Scratch& scratch, float* to, size_t rowFloats) const {
    if (!hasSamples({block.x0 - scratch.bx, block.y0 - scratch.by, block.x1 + scratch.bx, block.y1 + scratch.by})) {
        for (int y = block.y0; y < block.y1; ++y, to += rowFloats) std::fill_n(to, size_t(block.width()) * channels(), 0.f);
        return;
    }
    const size_t nsum = kFixedSums + aovs_.size(), side = size_t(2 * scratch.bx + 1);
    scratch.samples = size_t(block.width() + 2 * scratch.bx) * size_t(nx_ * ny_);
    scratch.across.resize(f.separable() ? side * scratch.samples : 0);
    scratch.down.resize(scratch.samples);
    scratch.weights.resize(side * scratch.samples);
    scratch.sums.assign(block.pixels() * nsum, 0);
    for (int row = block.y0 - scratch.by; row < block.y1 + scratch.by; ++row) {
        if (f.separable()) weigh(f, block, row, scratch);
        for (int y = std::max(block.y0, row - scratch.by); y < std::min(block.y1, row + scratch.by + 1); ++y) {
            if (f.separable()) multiply(f, block, row, y, scratch);
            else weighEach(f, block, row, y, scratch);
            addRow(block, row, y, scratch);
        }
    }
    double* sums = scratch.sums.data();
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x, sums += nsum)
            finish(sums, x, y, to + size_t(y - block.y0) * rowFloats + size_t(x - block.x0) * channels());
}

void SampleBuffer::addSample(const float* s, double w, double* sum) const {
    sum[0] += w;
    for (size_t c = 0; c < 6; ++c) sum[2 + c] += w * double(s[kColor + c]);
    for (size_t c = 0; c < aovs_.size(); ++c) sum[kFixedSums + c] += w * double(s[kAovs + c]);
}

/// All channels of a pixel except z.
void SampleBuffer::finish(double* sum, int x, int y, float* out) const {
    if (!(sum[0] > 1e-6 * sum[1])) {
        std::fill_n(sum, kFixedSums + aovs_.size(), 0);
        for (int k = 0; k < nx_ * ny_; ++k)
            if (const float* s = &data_[base(x, y, k)]; s[0] >= 0) addSample(s, 1, sum);
    }
    const double scale = sum[0] > 0 ? 1 / sum[0] : 0;
    for (size_t i = 0; i < 3; ++i) {
        out[i] = float(sum[2 + i] * scale);
        out[4 + i] = float(sum[5 + i] * scale);
    }
    out[3] = float((sum[5] + sum[6] + sum[7]) / 3 * scale);
    for (size_t i = 0; i < aovs_.size(); ++i) out[kImageFixedChannels + i] = float(sum[kFixedSums + i] * scale);
    if (!averagesAll_) ownValues(x, y, out);
}

/// AOVs with rules Min and Max.
void SampleBuffer::ownValues(int x, int y, float* out) const {
    for (size_t i = 0; i < aovs_.size(); ++i) {
        if (aovs_[i].rule == ChannelRule::Average) continue;
        const bool least = aovs_[i].rule == ChannelRule::Min;
        float v = least ? kFar : -kFar;
        for (int k = 0; k < nx_ * ny_; ++k) {
            const float* s = &data_[base(x, y, k)];
            if (s[0] >= 0) v = least ? std::min(v, s[kAovs + i]) : std::max(v, s[kAovs + i]);
        }
        out[kImageFixedChannels + i] = v;
    }
}

float SampleBuffer::depthOf(DepthFilter depth, int x, int y) const {
    float least = kFar, most = -kFar, middle = kFar;
    double sum = 0;
    int hits = 0, samples = 0;
    const float* s = &data_[base(x, y, 0)];
    for (int k = 0; k < nx_ * ny_; ++k, s += stride_) {
        if (s[0] < 0) continue;
        ++samples;
        least = std::min(least, s[kDepth]);
        most = std::max(most, s[kDepth]);
        middle = std::min(middle, s[kDepth] / 2 + s[kDepth2] / 2);
        if (std::isfinite(s[kDepth])) {
            sum += s[kDepth];
            ++hits;
        }
    }
    switch (depth) {
    case DepthFilter::Min:
        return least;
    case DepthFilter::Max:
        return samples ? most : kFar;
    case DepthFilter::Average:
        return hits ? float(sum / hits) : kFar;
    case DepthFilter::Midpoint:
        break;
    }
    return middle;
}

void SampleBuffer::reconstructDepth(DepthFilter depth, Window out, float* to, size_t rowFloats) const {
    for (int y = out.y0; y < out.y1; ++y, to += rowFloats)
        for (int x = out.x0; x < out.x1; ++x) to[size_t(x - out.x0) * channels() + 7] = depthOf(depth, x, y);
}

void SampleBuffer::reconstruct(const FilterWeights& f, DepthFilter depth, Window out, float* to, size_t rowFloats) const {
    Scratch scratch;
    scratch.bx = border(f.filter().xw);
    scratch.by = border(f.filter().yw);
    const int columns = std::clamp(kSamplesOfRow / (nx_ * ny_), 8, 64);
    for (int y = out.y0; y < out.y1; y += kRows)
        for (int x = out.x0; x < out.x1; x += columns) {
            const Window part{x, y, std::min(x + columns, out.x1), std::min(y + kRows, out.y1)};
            block(f, part, scratch, to + size_t(y - out.y0) * rowFloats + size_t(x - out.x0) * channels(), rowFloats);
        }
    reconstructDepth(depth, out, to, rowFloats);
}

Image SampleBuffer::reconstruct(const PixelFilter& filter, DepthFilter depth, Window out) const {
    Image image;
    image.window = out;
    image.channels = {"r", "g", "b", "a", "Or", "Og", "Ob", "z"};
    for (const Channel& c : aovs_) image.channels.push_back(c.name);
    image.data.resize(out.pixels() * channels());
    const FilterWeights f = weights(filter);
    const size_t row = size_t(out.width()) * channels();
    parallelFor(0, (out.height() + kRows - 1) / kRows, [&](int i) {
        const int y = out.y0 + i * kRows;
        reconstruct(f, depth, {out.x0, y, out.x1, std::min(y + kRows, out.y1)}, &image.data[size_t(y - out.y0) * row], row);
    });
    return image;
}

} // namespace alpenglow::render
