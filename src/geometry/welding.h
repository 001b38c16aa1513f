// Corners of a mesh with equal values at one vertex are one value of its surface; others are borders in it.
#pragma once
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace alpenglow::geometry {

/// Per corner the first one of its vertex with the same bits. valueOf(corner): its `width` floats.
template <class ValueOf> std::vector<int> weld(std::span<const int> vertex, int vertices, ValueOf valueOf, size_t width) {
    constexpr int kMost = 64; // distinct values at a vertex; further ones are not merged
    std::vector<int> last(size_t(vertices), -1), before(vertex.size(), -1), out(vertex.size());
    for (size_t k = 0; k < vertex.size(); ++k) {
        int same = last[size_t(vertex[k])], tries = 0;
        for (; same >= 0 && tries < kMost; same = before[size_t(same)], ++tries)
            if (!std::memcmp(valueOf(size_t(same)), valueOf(k), width * sizeof(float))) break;
        if (tries >= kMost) same = -1;
        out[k] = same >= 0 ? same : int(k);
        if (same < 0) before[k] = last[size_t(vertex[k])], last[size_t(vertex[k])] = int(k);
    }
    return out;
}

} // namespace alpenglow::geometry
