// The elements of RSL arrays that have outgrown the memory of a kernel. A kernel has storage for the first elements of an array
// that can change its length (ir/build_arrays.cpp); for those behind it calls services, which whoever runs it passes on to an
// object of this class. Each point has arrays of its own.
#pragma once
#include "base/diagnostics.h"
#include "rsl/ir/ir.h"
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace alpenglow::rsl {

/// Bytes of all such elements of one run of a kernel, that is of all points that are shaded together.
inline constexpr size_t kSpilledArrayBytes = size_t(256) << 20;

/// The elements of resizable arrays beyond the memory of the kernel, for one run. For one thread.
class SpilledArrays {
public:
    /// most: bytes of one run; more is an error.
    explicit SpilledArrays(size_t most = kSpilledArrayBytes) : most_(most) {}
    /// Answers a service on arrays: "arraystore" gives the length that the array has with this element at least, "arrayload" the
    /// element, 0 where there is none; "arrayresize" the length that it gets. A length that there is no memory for is reported
    /// once, and the old one or the storage's is kept. False: the site is another service. `first`: the point of lane 0.
    bool answer(const ir::Site&, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out, Diagnostics&,
                const std::vector<std::string>* files);
    /// Gives the memory back; for the next run.
    void clear();
    /// Memory in use.
    size_t bytes() const { return bytes_; }

private:
    bool reserve(std::vector<float>&, size_t numbers);
    size_t most_, bytes_ = 0;
    std::unordered_map<uint64_t, std::vector<float>> elements_; ///< by array and point: those beyond its storage
};

} // namespace alpenglow::rsl
