#include "render/growth.h"
#include <algorithm>

namespace alpenglow::render {

Growth::Growth(const SampleBuffer& buffer, const Window& part, int side)
    : buffer_(buffer), part_(part), side_(side), columns_((buffer.sampled().width() + side - 1) / side),
      rows_((buffer.sampled().height() + side - 1) / side), tasks_(size_t(columns_) * size_t(rows_)),
      over_(std::make_unique<std::atomic<uint8_t>[]>(tasks_)), taken_(tasks_) {}

Growth::Growth(const SampleBuffer& buffer, std::vector<std::pair<int, int>> pixels, size_t each)
    : buffer_(buffer), pixels_(std::move(pixels)), each_(each), tasks_((pixels_.size() + each - 1) / each),
      over_(std::make_unique<std::atomic<uint8_t>[]>(tasks_)), taken_(tasks_) {}

Window Growth::tileOf(size_t task) const {
    const Window& s = buffer_.sampled();
    const int x = s.x0 + int(task % size_t(columns_)) * side_, y = s.y0 + int(task / size_t(columns_)) * side_;
    return {x, y, std::min(x + side_, s.x1), std::min(y + side_, s.y1)};
}

/// Whether a tile is complete: together with all tiles from which a filter takes samples for its pixels.
bool Growth::ready(size_t task) const {
    const auto isOver = [&](size_t i) { return over_[i].load(std::memory_order_acquire) != 0; };
    if (!isOver(task) || each_ > 0) return isOver(task);
    const Window& s = buffer_.sampled();
    const int across = (part_.x0 - s.x0 + side_ - 1) / side_, down = (part_.y0 - s.y0 + side_ - 1) / side_; // of its border
    const int x = int(task % size_t(columns_)), y = int(task / size_t(columns_));
    for (int j = std::max(0, y - down); j <= std::min(rows_ - 1, y + down); ++j)
        for (int i = std::max(0, x - across); i <= std::min(columns_ - 1, x + across); ++i)
            if (!isOver(size_t(j) * size_t(columns_) + size_t(i))) return false;
    return true;
}

void Growth::take(const std::function<void(const SampleBuffer&, const Window&)>& f) {
    taking_ = count_.load(std::memory_order_relaxed);
    for (size_t i = 0; i < tasks_; ++i) {
        if (taken_[i] || !ready(i)) continue;
        taken_[i] = 1;
        if (each_ > 0) {
            for (size_t k = i * each_; k < std::min((i + 1) * each_, pixels_.size()); ++k)
                f(buffer_, {pixels_[k].first, pixels_[k].second, pixels_[k].first + 1, pixels_[k].second + 1});
            continue;
        }
        const Window t = tileOf(i);
        const Window w{std::max(t.x0, part_.x0), std::max(t.y0, part_.y0), std::min(t.x1, part_.x1), std::min(t.y1, part_.y1)};
        if (w.x0 < w.x1 && w.y0 < w.y1) f(buffer_, w);
    }
}

} // namespace alpenglow::render
