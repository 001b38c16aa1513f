// Which lights are on for a primitive. Scenes with many lights name nearly all of them nearly everywhere, and every area light
// has attributes of its own: as runs of indices such sets take the room of their gaps, not that of their lights.
#pragma once
#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <utility>
#include <vector>

namespace alpenglow::scene {

/// A set of indices into Frame::lights, in order of declaration.
class LightSet {
public:
    using Run = std::pair<int, int>; ///< [first, second)

    LightSet() = default;
    /// Indices in any order, none negative; repeated ones count once.
    LightSet(std::initializer_list<int> lights) : LightSet(std::vector<int>(lights)) {}
    explicit LightSet(const std::vector<int>& lights) {
        for (int l : lights) insert(l);
    }

    /// No light.
    bool empty() const { return runs_.empty(); }
    /// Number of lights.
    size_t size() const {
        size_t n = 0;
        for (const Run& r : runs_) n += size_t(r.second - r.first);
        return n;
    }
    /// Logarithmic in the number of runs.
    bool contains(int light) const {
        const auto behind = after(runs_.begin(), runs_.end(), light);
        return behind != runs_.begin() && light < std::prev(behind)->second;
    }
    /// Linear in the number of runs.
    void insert(int light) {
        const auto behind = after(runs_.begin(), runs_.end(), light);
        const bool before = behind != runs_.begin();
        if (before && light < std::prev(behind)->second) return;
        const bool joinsLeft = before && std::prev(behind)->second == light;
        const bool joinsRight = behind != runs_.end() && behind->first == light + 1;
        if (joinsLeft && joinsRight) {
            std::prev(behind)->second = behind->second;
            runs_.erase(behind);
        } else if (joinsLeft) {
            ++std::prev(behind)->second;
        } else if (joinsRight) {
            --behind->first;
        } else {
            runs_.insert(behind, {light, light + 1});
        }
    }
    /// Linear in the number of runs; a light that is not in the set changes nothing.
    void erase(int light) {
        const auto behind = after(runs_.begin(), runs_.end(), light);
        if (behind == runs_.begin() || light >= std::prev(behind)->second) return;
        const auto run = std::prev(behind);
        const Run was = *run;
        if (was.second - was.first == 1) {
            runs_.erase(run);
        } else if (was.first == light) {
            ++run->first;
        } else if (was.second == light + 1) {
            --run->second;
        } else {
            run->second = light;
            runs_.insert(std::next(run), {light + 1, was.second});
        }
    }
    /// Removes indices from `end` on.
    void keepBelow(int end) {
        while (!runs_.empty() && runs_.back().first >= end) runs_.pop_back();
        if (!runs_.empty()) runs_.back().second = std::min(runs_.back().second, end);
    }
    /// The last one; only where there is one.
    int last() const { return runs_.back().second - 1; }
    /// Removes all lights.
    void clear() { runs_.clear(); }
    /// Ascending, with gaps between them.
    const std::vector<Run>& runs() const { return runs_; }

    /// Visits the lights one by one, ascending.
    class const_iterator {
    public:
        /// What the standard library asks of an iterator.
        using iterator_category = std::forward_iterator_tag;
        using value_type = int;
        using difference_type = std::ptrdiff_t;
        using pointer = const int*;
        using reference = int;
        const_iterator() = default;
        /// A forward iterator over the lights of the runs.
        const_iterator(const Run* run, const Run* end) : run_(run), end_(end), light_(run == end ? 0 : run->first) {}
        int operator*() const { return light_; }
        const_iterator& operator++() {
            if (++light_ == run_->second) *this = const_iterator(run_ + 1, end_);
            return *this;
        }
        const_iterator operator++(int) {
            const const_iterator was = *this;
            ++*this;
            return was;
        }
        bool operator==(const const_iterator& o) const { return run_ == o.run_ && light_ == o.light_; }

    private:
        const Run *run_ = nullptr, *end_ = nullptr;
        int light_ = 0;
    };
    using iterator = const_iterator;
    using value_type = int;
    const_iterator begin() const { return {runs_.data(), runs_.data() + runs_.size()}; }
    const_iterator end() const { return {runs_.data() + runs_.size(), runs_.data() + runs_.size()}; }

    bool operator==(const LightSet&) const = default;
    auto operator<=>(const LightSet&) const = default;
    /// list: ascending.
    bool operator==(const std::vector<int>& o) const { return std::equal(begin(), end(), o.begin(), o.end()); }

private:
    /// The first run that begins after a light.
    template <class Iterator> static Iterator after(Iterator first, Iterator last, int light) {
        return std::upper_bound(first, last, light, [](int l, const Run& r) { return l < r.first; });
    }
    std::vector<Run> runs_;
};

} // namespace alpenglow::scene
