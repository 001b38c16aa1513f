#include "render/film.h"
#include "base/digest.h"
#include "base/limits.h"
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

namespace alpenglow::render {
namespace {

// Min and Max channels keep a float as an integer with the same order, so that merging them is a comparison of integers.
int32_t orderKey(float f) {
    int32_t b = std::bit_cast<int32_t>(f == 0 ? 0.0f : f); // -0 and 0 are one value
    return b < 0 ? int32_t(b ^ 0x7fffffff) : b;
}
float fromKey(int32_t k) { return std::bit_cast<float>(k < 0 ? int32_t(k ^ 0x7fffffff) : k); }

Int128 emptyValue(ChannelRule r) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    return isSum(r) ? 0 : orderKey(r == ChannelRule::Min ? inf : -inf);
}

void tally(uint64_t& counter) { std::atomic_ref<uint64_t>(counter).fetch_add(1, std::memory_order_relaxed); }

bool insertRange(std::vector<SampleRange>& ranges, SampleRange r) {
    if (r.begin >= r.end) return false;
    auto at = std::lower_bound(ranges.begin(), ranges.end(), r, [](auto a, auto b) { return a.begin < b.begin; });
    if ((at != ranges.end() && at->begin < r.end) || (at != ranges.begin() && std::prev(at)->end > r.begin)) return false;
    at = ranges.insert(at, r);
    if (std::next(at) != ranges.end() && std::next(at)->begin == at->end) {
        at->end = std::next(at)->end;
        ranges.erase(std::next(at));
    }
    if (at != ranges.begin() && std::prev(at)->end == at->begin) {
        std::prev(at)->end = at->end;
        ranges.erase(at);
    }
    return true;
}

uint64_t total(const std::vector<SampleRange>& ranges) {
    uint64_t n = 0;
    for (auto r : ranges) n += r.end - r.begin;
    return n;
}

} // namespace

std::array<double, 2> signScales(double negative, const std::array<uint32_t, kReplicas>& samples, double plusWeights,
                                 double minusWeights) {
    if (!(minusWeights > 0)) return {plusWeights > 0 ? 1 / plusWeights : 0, 0};
    if (!(plusWeights > 0)) return {0, 1 / minusWeights};
    // The first numbers of a replica are stratified, so it has about `share` times its samples with negative sign.
    const double share = negative / (1 + 2 * negative);
    double none = 1;
    for (uint32_t n : samples) none *= std::max(0.0, 1 - n * share);
    const double part = none < 1 ? negative / (1 - none) : negative;
    return {(1 + part) / plusWeights, -part / minusWeights};
}

bool Film::check(const FilmDescription& d, Diagnostics& diag, const SourcePlace& place) {
    auto bad = [&](const std::string& what) {
        diag.report(Severity::Error, Rie::Limit, place, what);
        return false;
    };
    const Window& w = d.window;
    if (d.width < 1 || d.height < 1 || d.width > limits::kImageSide || d.height > limits::kImageSide)
        return bad("picture size " + std::to_string(d.width) + " x " + std::to_string(d.height) + " is outside 1 .. " +
                   std::to_string(limits::kImageSide));
    if (w.x0 < 0 || w.y0 < 0 || w.x1 > d.width || w.y1 > d.height || w.x0 >= w.x1 || w.y0 >= w.y1)
        return bad("crop window " + std::to_string(w.x0) + "," + std::to_string(w.y0) + " to " + std::to_string(w.x1) + "," +
                   std::to_string(w.y1) + " is empty or outside the picture");
    if (d.channels.size() > size_t(limits::kFilmChannels))
        return bad(std::to_string(d.channels.size()) + " channels; at most " + std::to_string(limits::kFilmChannels));
    return true;
}

Film::Film(FilmDescription d) : description_(std::move(d)) {
    pixels_.resize(window().pixels() * layers());
    if (description_.negative) weights_.resize(pixels_.size());
    size_t n = description_.channels.size();
    aovs_.resize(pixels_.size() * n);
    for (size_t i = 0; i < aovs_.size(); ++i) aovs_[i] = emptyValue(description_.channels[i % n].rule);
    for (size_t i = 0; i < n; ++i)
        if (const int c = int(description_.channels[i].rule) - int(ChannelRule::PartOfRed); c >= 0 && c < 3)
            parts_[c].push_back(int(i));
}

void Film::addParts(size_t at, const FilmSample& s, const Int128 (&rgb)[3], bool* saturated) {
    const size_t n = description_.channels.size();
    for (int c = 0; c < 3; ++c) {
        if (parts_[c].empty()) continue;
        Int128 left = rgb[c], most = -1;
        size_t largest = 0;
        for (int i : parts_[c]) {
            const float v = size_t(i) < s.aovs.size() ? s.aovs[size_t(i)] : 0.0f;
            const bool good = std::isfinite(v);
            if (!good) tally(nonFiniteAovs_);
            const Int128 part = good ? toFixed(double(v) * std::fabs(s.weight), saturated) : Int128(0),
                         size = part < 0 ? -part : part;
            aovs_[at * n + size_t(i)] += part;
            left -= part;
            if (size > most) most = size, largest = size_t(i);
        }
        aovs_[at * n + largest] += left;
    }
}

bool Film::add(int x, int y, uint32_t sampleIndex, const FilmSample& s) {
    const Color& c = s.radiance;
    if (!std::isfinite(c.x) || !std::isfinite(c.y) || !std::isfinite(c.z) || !std::isfinite(s.alpha)) {
        tally(nonFinite_);
        std::atomic_ref<uint8_t> lock(dropLock_[0]);
        while (lock.exchange(1, std::memory_order_acquire)) {}
        uint64_t key = uint64_t(sampleIndex) << 32 | uint32_t(y);
        if (key < firstDropped_[0] || (key == firstDropped_[0] && uint64_t(x) < firstDropped_[1])) {
            firstDropped_[0] = key;
            firstDropped_[1] = uint64_t(x);
        }
        lock.store(0, std::memory_order_release);
        return false;
    }
    const double weight = std::fabs(s.weight);
    size_t at = index(x, y);
    if (description_.negative && s.weight < 0) at = below(at);
    Pixel& p = pixels_[at];
    bool saturated = false;
    const Int128 rgb[3] = {toFixed(c.x * weight, &saturated), toFixed(c.y * weight, &saturated),
                           toFixed(c.z * weight, &saturated)};
    for (int k = 0; k < 3; ++k) p.rgb[k] += rgb[k];
    p.alpha += toFixed(s.alpha * weight, &saturated);
    if (description_.negative) weights_[at] += toFixed(weight, &saturated);
    // Squares the rounded luminance, so that the variance of equal samples is exactly 0.
    Int128 lum = toFixed(luminance(Vec3d(c)), &saturated);
    p.replicaY[sampleIndex % kReplicas] += lum;
    p.replicaCount[sampleIndex % kReplicas]++;
    p.y2 += square(lum);
    if (s.surface) {
        p.surfaceY += lum;
        p.surfaceCount[sampleIndex % kReplicas]++;
    }
    size_t n = description_.channels.size();
    for (size_t i = 0; i < n; ++i) {
        float v = i < s.aovs.size() ? s.aovs[i] : 0.0f;
        Int128& sum = aovs_[at * n + i];
        ChannelRule rule = description_.channels[i].rule;
        if (rule >= ChannelRule::PartOfRed) continue;
        if (std::isnan(v) || (rule == ChannelRule::Average && std::isinf(v))) tally(nonFiniteAovs_);
        else if (rule == ChannelRule::Average) sum += toFixed(v * weight, &saturated);
        else if (rule == ChannelRule::Min) sum = std::min<Int128>(sum, orderKey(v));
        else sum = std::max<Int128>(sum, orderKey(v));
    }
    addParts(at, s, rgb, &saturated);
    if (saturated) tally(saturated_);
    return true;
}

bool Film::addRange(SampleRange r) {
    auto next = ranges_;
    if (spread_ || !insertRange(next, r) || total(next) > limits::kSamplesPerPixel) return false;
    ranges_ = std::move(next);
    return true;
}

uint32_t Film::samplesPerPixel() const { return uint32_t(total(ranges_)); }

bool Film::spread(std::vector<uint16_t> rates) {
    if (spread_ || ranges_.size() != 1 || ranges_[0].begin != 0 || rates.size() != window().pixels()) return false;
    if (std::any_of(rates.begin(), rates.end(), [](uint16_t r) { return r > Spread::kMost; })) return false;
    spread_ = Spread{ranges_[0].end, 0, std::move(rates)};
    return true;
}

bool Film::addSteps(uint32_t steps) {
    if (!spread_ || steps > limits::kSamplesPerPixel) return false;
    const uint64_t after = uint64_t(spread_->steps) + steps;
    const size_t most = size_t(std::max_element(spread_->rates.begin(), spread_->rates.end()) - spread_->rates.begin());
    if (after > limits::kSamplesPerPixel || spread_->held(most, after) > limits::kSamplesPerPixel) return false;
    spread_->steps = uint32_t(after);
    return true;
}

SampleRange Film::samplesOfSteps(int x, int y, uint32_t steps) const {
    const size_t i = index(x, y);
    return {uint32_t(spread_->held(i)), uint32_t(spread_->held(i, uint64_t(spread_->steps) + steps))};
}

Film::Samples Film::samplesAfter(uint32_t steps) const {
    const uint64_t n = samplesPerPixel();
    if (!spread_) return {double(n), n, n};
    Samples s{0, ~0ull, 0};
    uint64_t sum = 0;
    for (size_t i = 0; i < window().pixels(); ++i) {
        const uint64_t held = spread_->held(i, uint64_t(spread_->steps) + steps);
        sum += held;
        s.least = std::min(s.least, held);
        s.most = std::max(s.most, held);
    }
    s.mean = double(sum) / double(window().pixels());
    return s;
}

bool Film::merge(const Film& o, Diagnostics& diag, const SourcePlace& place) {
    auto bad = [&](Rie code, const std::string& what) {
        diag.report(Severity::Error, code, place, what);
        return false;
    };
    const auto &a = description_, &b = o.description_;
    if (a.width != b.width || a.height != b.height || a.window != b.window)
        return bad(Rie::Consistency, "the parts have different sizes or crop windows");
    if (a.channels != b.channels) return bad(Rie::Consistency, "the parts have different channels");
    if (a.negative != b.negative) return bad(Rie::Consistency, "the parts have different pixel filters");
    if (a.seed != b.seed)
        return bad(Rie::Consistency,
                   "the parts have different seeds (" + std::to_string(a.seed) + " and " + std::to_string(b.seed) + ")");
    if (a.scene != b.scene) return bad(Rie::Consistency, "the parts come from different scenes or options");
    if (spread_ || o.spread_)
        return bad(Rie::Consistency, "pixels have different numbers of samples (--noise); such renders cannot be merged");
    auto next = ranges_;
    for (auto r : o.ranges_)
        if (!insertRange(next, r))
            return bad(Rie::Consistency, "the parts share samples: " + std::to_string(r.begin) + ":" + std::to_string(r.end) +
                                             " overlaps the samples already present");
    if (total(next) > limits::kSamplesPerPixel)
        return bad(Rie::Limit, "more than " + std::to_string(limits::kSamplesPerPixel) + " samples per pixel");
    ranges_ = std::move(next);
    for (size_t i = 0; i < pixels_.size(); ++i) {
        Pixel& p = pixels_[i];
        const Pixel& q = o.pixels_[i];
        for (int k = 0; k < 3; ++k) p.rgb[k] += q.rgb[k];
        p.alpha += q.alpha;
        p.y2 += q.y2;
        p.surfaceY += q.surfaceY;
        for (uint32_t k = 0; k < kReplicas; ++k) {
            p.replicaY[k] += q.replicaY[k];
            p.replicaCount[k] += q.replicaCount[k];
            p.surfaceCount[k] += q.surfaceCount[k];
        }
    }
    for (size_t i = 0; i < weights_.size(); ++i) weights_[i] += o.weights_[i];
    size_t n = a.channels.size();
    for (size_t i = 0; i < aovs_.size(); ++i) {
        ChannelRule rule = a.channels[i % n].rule;
        if (isSum(rule)) aovs_[i] += o.aovs_[i];
        else aovs_[i] = rule == ChannelRule::Min ? std::min(aovs_[i], o.aovs_[i]) : std::max(aovs_[i], o.aovs_[i]);
    }
    nonFinite_ += o.nonFinite_;
    nonFiniteAovs_ += o.nonFiniteAovs_;
    saturated_ += o.saturated_;
    if (std::lexicographical_compare(o.firstDropped_, o.firstDropped_ + 2, firstDropped_, firstDropped_ + 2))
        std::copy(o.firstDropped_, o.firstDropped_ + 2, firstDropped_);
    metadata.insert(o.metadata.begin(), o.metadata.end());
    return true;
}

std::array<uint32_t, kReplicas> Film::countsAt(size_t pixel) const {
    std::array<uint32_t, kReplicas> n{};
    for (size_t at = pixel; at < pixels_.size(); at = below(at))
        for (uint32_t r = 0; r < kReplicas; ++r) n[r] += pixels_[at].replicaCount[r];
    return n;
}

uint32_t Film::count(int x, int y) const {
    const auto counts = countsAt(index(x, y));
    return std::accumulate(counts.begin(), counts.end(), 0u);
}

/// sumOf: sum of a pixel, by its index for one sign.
template <class SumOf> double Film::average(int x, int y, SumOf sumOf) const {
    const size_t at = index(x, y);
    if (!description_.negative) {
        const uint32_t n = count(x, y);
        return n ? fromFixed(sumOf(at)) / n : 0;
    }
    const auto [plus, minus] =
        signScales(*description_.negative, countsAt(at), fromFixed(weights_[at]), fromFixed(weights_[below(at)]));
    return plus * fromFixed(sumOf(at)) + minus * fromFixed(sumOf(below(at)));
}

Color Film::mean(int x, int y) const {
    Color c;
    for (int k = 0; k < 3; ++k) c[k] = float(average(x, y, [&](size_t at) { return pixels_[at].rgb[k]; }));
    return c;
}

float Film::alpha(int x, int y) const {
    return float(average(x, y, [&](size_t at) { return pixels_[at].alpha; }));
}

float Film::aov(int x, int y, int channel) const {
    const size_t n = description_.channels.size();
    const auto sumOf = [&](size_t at) { return aovs_[at * n + size_t(channel)]; };
    const ChannelRule rule = description_.channels[size_t(channel)].rule;
    if (isSum(rule)) return float(average(x, y, sumOf));
    Int128 v = sumOf(index(x, y));
    if (description_.negative) {
        const Int128 other = sumOf(below(index(x, y)));
        v = rule == ChannelRule::Min ? std::min(v, other) : std::max(v, other);
    }
    return fromKey(int32_t(v));
}

float Film::aov(int x, int y, std::span<const int> channels) const {
    const size_t n = description_.channels.size();
    return float(average(x, y, [&](size_t at) {
        Int128 v = 0;
        for (int channel : channels) v += aovs_[at * n + size_t(channel)];
        return v;
    }));
}

Moments Film::momentsOf(const Pixel& p) {
    Moments m;
    for (uint32_t c : p.replicaCount) m.n += c;
    Int128 sum = 0;
    for (Int128 v : p.replicaY) sum += v;
    m.s1 = fromFixed(sum);
    m.s2 = p.y2.toDouble() * 0x1p-80;
    if (m.n < 2) return m;
    // n * S2 - S1^2 is not negative (Cauchy-Schwarz for integers) and fits: 27 + 227 bits.
    UInt256 d = p.y2;
    d *= m.n;
    d -= square(sum);
    m.variance = d.toDouble() * 0x1p-80 / (double(m.n) * (double(m.n) - 1));
    return m;
}

Moments Film::moments(int x, int y) const {
    const size_t at = index(x, y);
    if (!description_.negative) return momentsOf(pixels_[at]);
    // The variance of n independent samples whose mean has the same error as the combination of both signs.
    const Moments part[2] = {momentsOf(pixels_[at]), momentsOf(pixels_[below(at)])};
    const auto scale = signScales(*description_.negative, countsAt(at), part[0].n, part[1].n);
    Moments m;
    m.n = part[0].n + part[1].n;
    for (size_t k = 0; k < 2; ++k) {
        m.s1 += scale[k] * part[k].s1 * m.n;
        m.variance += scale[k] * scale[k] * part[k].n * part[k].variance * m.n;
    }
    if (m.n > 0) m.s2 = m.variance * (m.n - 1.0) + m.s1 * m.s1 / m.n;
    return m;
}

std::vector<LuminanceSums> Film::luminanceSums(int x, int y) const {
    std::vector<LuminanceSums> all;
    for (size_t at = index(x, y); at < pixels_.size(); at = below(at)) {
        const Pixel& p = pixels_[at];
        LuminanceSums& s = all.emplace_back();
        for (uint32_t r = 0; r < kReplicas; ++r) s.y[r] = fromFixed(p.replicaY[r]);
        std::copy(std::begin(p.replicaCount), std::end(p.replicaCount), s.count.begin());
        s.surfaceY = fromFixed(p.surfaceY);
        std::copy(std::begin(p.surfaceCount), std::end(p.surfaceCount), s.surfaceCount.begin());
    }
    if (all.size() < 2) return all;
    const uint32_t plus = all[0].samples(), minus = all[1].samples();
    const auto scales = signScales(*description_.negative, countsAt(index(x, y)), plus, minus);
    for (size_t k = 0; k < 2; ++k) all[k].scale = scales[k] * (double(plus) + minus);
    return all;
}

void Film::replica(int x, int y, uint32_t r, double* sum, uint32_t* n) const {
    if (!description_.negative) {
        const Pixel& p = pixel(x, y);
        *sum = fromFixed(p.replicaY[r]);
        *n = p.replicaCount[r];
        return;
    }
    *sum = 0;
    *n = 0;
    const std::vector<LuminanceSums> signs = luminanceSums(x, y);
    double whole = 0, samples = 0;
    for (const LuminanceSums& s : signs) {
        const uint32_t count = s.samples();
        *n += s.count[r];
        samples += count;
        whole += s.scale * s.sum();
        if (count > 0) *sum += s.scale * (s.y[r] - s.sum() / count * s.count[r]);
    }
    if (samples > 0) *sum += whole / samples * *n;
}

std::optional<DroppedSample> Film::firstDropped() const {
    if (firstDropped_[0] == ~0ull) return {};
    return DroppedSample{uint32_t(firstDropped_[0] >> 32), int(firstDropped_[1]), int(uint32_t(firstDropped_[0]))};
}

uint64_t Film::digest() const {
    Digest all;
    auto mix = [&](uint64_t v) { all.add(&v, sizeof v); };
    auto mix128 = [&](Int128 v) {
        mix(uint64_t(v));
        mix(uint64_t(v >> 64));
    };
    for (const Pixel& p : pixels_) {
        for (Int128 v : p.rgb) mix128(v);
        mix128(p.alpha);
        for (Int128 v : p.replicaY) mix128(v);
        for (uint64_t v : p.y2.limb) mix(v);
        for (uint32_t v : p.replicaCount) mix(v);
        mix128(p.surfaceY);
        for (uint32_t v : p.surfaceCount) mix(v);
    }
    for (Int128 v : aovs_) mix128(v);
    for (Int128 v : weights_) mix128(v);
    for (auto r : ranges_) mix(uint64_t(r.begin) << 32 | r.end);
    for (uint64_t v : {nonFinite_, nonFiniteAovs_, saturated_}) mix(v);
    if (spread_) {
        mix(uint64_t(spread_->base) << 32 | spread_->steps);
        for (uint16_t v : spread_->rates) mix(v);
    }
    return all.value();
}

} // namespace alpenglow::render
