#include "render/samplebuffer.h"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace alpenglow::render {
namespace {

constexpr uint32_t kPositionSite = 0;
constexpr float kInf = std::numeric_limits<float>::infinity();

bool drawn(Jitter j) { return j == Jitter::Jittered || j == Jitter::Scrambled; }

// u: the two random numbers of the sample, if needed.
Vec2 placeOf(int k, int nx, int ny, Jitter jitter, Vec2 u) {
    if (jitter == Jitter::Scrambled || jitter == Jitter::Middle) return u;
    // Float rounding could reach 1, which belongs to the next pixel.
    constexpr float below = 1 - 0x1p-24f;
    return {std::min(below, (float(k % nx) + u.x) / float(nx)), std::min(below, (float(k / nx) + u.y) / float(ny))};
}

} // namespace

int border(double w) { return std::max(0, int(std::ceil(w / 2 - 0.5))); }

Vec2 stratifiedOffset(uint64_t seed, int x, int y, int k, int nx, int ny, Jitter jitter) {
    Vec2 u{0.5f, 0.5f};
    if (drawn(jitter)) u = Sampler(seed, x, y).get2(0, kPositionSite, 0, uint32_t(k));
    return placeOf(k, nx, ny, jitter, u);
}

void PlaceRows::clear() {
    asked_.clear();
    numbers_.clear();
}

void PlaceRows::ask(int x, int y, int k) {
    asked_.push_back(k);
    if (!drawn(jitter_)) return;
    if (!pixel_ || x != x_ || y != y_) pixel_.emplace(seed_, x_ = x, y_ = y);
    numbers_.askPair({*pixel_, uint32_t(k)}, 0, kPositionSite, 0);
}

void PlaceRows::draw() {
    numbers_.draw();
    places_.resize(asked_.size());
    for (size_t i = 0; i < asked_.size(); ++i)
        places_[i] = placeOf(asked_[i], nx_, ny_, jitter_, drawn(jitter_) ? numbers_.pair(i) : Vec2{0.5f, 0.5f});
}

std::optional<DepthFilter> depthFilterByName(std::string_view n) {
    if (n == "min" || n == "zmin") return DepthFilter::Min;
    if (n == "max" || n == "zmax") return DepthFilter::Max;
    if (n == "average") return DepthFilter::Average;
    if (n == "midpoint") return DepthFilter::Midpoint;
    return {};
}

SampleBuffer::SampleBuffer(Window w, double maxXw, double maxYw, int nx, int ny, std::vector<Channel> aovs, uint64_t seed,
                           Jitter j, std::vector<float> memory)
    : window_(w), nx_(nx), ny_(ny), aovs_(std::move(aovs)), seed_(seed), jitter_(j), stride_(kAovs + aovs_.size()) {
    averagesAll_ = std::all_of(aovs_.begin(), aovs_.end(), [](const Channel& c) { return c.rule == ChannelRule::Average; });
    int bx = border(maxXw), by = border(maxYw);
    sampled_ = {w.x0 - bx, w.y0 - by, w.x1 + bx, w.y1 + by};
    const size_t floats = sampled_.pixels() * size_t(nx * ny) * stride_;
    if (memory.capacity() >= floats) data_ = std::move(memory);
    else memory = {}; // frees one before the other
    data_.assign(floats, 0);
    for (size_t i = 0; i < data_.size(); i += stride_) data_[i] = -1;
}

int SampleBuffer::moveDown(const Window& w) {
    const int above = window_.y0 - sampled_.y0, below = sampled_.y1 - window_.y1;
    const Window from = sampled_;
    window_ = w;
    sampled_ = {from.x0, w.y0 - above, from.x1, w.y1 + below};
    const size_t row = size_t(from.width()) * size_t(nx_ * ny_) * stride_;
    const size_t kept = size_t(std::clamp(from.y1 - sampled_.y0, 0, sampled_.height())) * row;
    std::copy_n(data_.end() - long(kept), kept, data_.begin());
    data_.resize(size_t(sampled_.height()) * row);
    std::fill(data_.begin() + long(kept), data_.end(), 0.f);
    for (size_t i = kept; i < data_.size(); i += stride_) data_[i] = -1;
    return sampled_.y0 + int(kept / row);
}

Vec2 SampleBuffer::position(int x, int y, int k) const {
    Vec2 o = stratifiedOffset(seed_, x, y, k, nx_, ny_, jitter_);
    return {float(x) + o.x, float(y) + o.y};
}

bool SampleBuffer::set(int x, int y, int k, const ImageSample& s) {
    return set(x, y, k, stratifiedOffset(seed_, x, y, k, nx_, ny_, jitter_), s);
}

bool SampleBuffer::set(int x, int y, int k, Vec2 place, const ImageSample& s) {
    float* d = &data_[base(x, y, k)];
    const bool again = d[0] >= 0 || d[1] > 0; // a repeated task counts once
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
    d[0] = place.x;
    d[1] = place.y;
    return true;
}

Color SampleBuffer::color(int x, int y, int k) const {
    const float* d = &data_[base(x, y, k)];
    return d[0] < 0 ? Color(0) : Color(d[kColor], d[kColor + 1], d[kColor + 2]);
}

} // namespace alpenglow::render
