// A set of the Requests of a kernel, by their ordinals. Exact for any number of them.
#pragma once
#include "rsl/passes/names.h"
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alpenglow::rsl::passes {

/// Sets of ordinals of Requests.
class SiteSet {
public:
    /// The set of one.
    static SiteSet of(size_t n) {
        SiteSet s;
        s.add(n);
        return s;
    }
    /// Whether it is not empty; adds an ordinal; whether one is in it.
    explicit operator bool() const {
        for (uint64_t w : rest_)
            if (w) return true;
        return first_ != 0;
    }
    void add(size_t n) { word(n / 64) |= uint64_t(1) << (n % 64); }
    bool has(size_t n) const {
        const uint64_t w = n < 64 ? first_ : n / 64 - 1 < rest_.size() ? rest_[n / 64 - 1] : 0;
        return (w >> (n % 64)) & 1;
    }
    /// Adds the members of another; true when that made a difference.
    bool join(const SiteSet& o) {
        bool more = (o.first_ & ~first_) != 0;
        first_ |= o.first_;
        for (size_t i = 0; i < o.rest_.size(); ++i) {
            uint64_t& w = word(i + 1);
            more = more || (o.rest_[i] & ~w);
            w |= o.rest_[i];
        }
        return more;
    }
    friend SiteSet operator|(SiteSet a, const SiteSet& b) {
        a.join(b);
        return a;
    }
    /// What is in both.
    friend SiteSet operator&(const SiteSet& a, const SiteSet& b) {
        SiteSet both;
        both.first_ = a.first_ & b.first_;
        for (size_t i = 0; i < a.rest_.size() && i < b.rest_.size(); ++i) both.word(i + 1) = a.rest_[i] & b.rest_[i];
        return both;
    }

private:
    uint64_t& word(size_t n) {
        if (n == 0) return first_;
        if (rest_.size() < n) rest_.resize(n);
        return rest_[n - 1];
    }
    uint64_t first_ = 0; ///< most kernels have no more
    std::vector<uint64_t> rest_;
};

} // namespace alpenglow::rsl::passes
