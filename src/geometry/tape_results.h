// Room for what is computed step by step along the tape of a Blobby's field.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace alpenglow::geometry {

/// A result for every operation of a tape, without memory of its own for the short tapes that nearly all are.
template <class T> class TapeResults {
public:
    /// n: number of operations.
    explicit TapeResults(size_t n) {
        if (n > few_.size()) many_.resize(n);
    }
    /// I < n.
    T& operator[](size_t i) { return many_.empty() ? few_[i] : many_[i]; }

private:
    std::array<T, 24> few_;
    std::vector<T> many_;
};

} // namespace alpenglow::geometry
