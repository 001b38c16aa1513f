#include "rsl/spilledarrays.h"
#include "rsl/messages/messages.h"
#include <algorithm>

namespace alpenglow::rsl {

void SpilledArrays::clear() {
    elements_.clear();
    bytes_ = 0;
}

/// Room for so many numbers, by doubling. False: that would be too many bytes.
bool SpilledArrays::reserve(std::vector<float>& v, size_t numbers) {
    if (numbers <= v.capacity()) return true;
    const size_t had = v.capacity() * sizeof(float), left = most_ > bytes_ ? most_ - bytes_ : 0;
    size_t wanted = std::max({numbers, 2 * v.capacity(), size_t(64)});
    if (wanted * sizeof(float) > left + had) wanted = numbers;
    if (wanted * sizeof(float) > left + had) return false;
    v.reserve(wanted);
    bytes_ += v.capacity() * sizeof(float) - had;
    return true;
}

bool SpilledArrays::answer(const ir::Site& s, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out,
                           Diagnostics& diagnostics, const std::vector<std::string>* files) {
    const bool store = s.op == "arraystore", load = s.op == "arrayload", resize = s.op == "arrayresize";
    if (!store && !load && !resize) return false;
    const auto argument = [&](int row, int lane) { return in[size_t(row) * size_t(lanes) + size_t(lane)]; };
    const auto put = [&](int row, int lane, float v) { out[size_t(row) * size_t(lanes) + size_t(lane)] = v; };
    bool full = false;
    for (int lane = 0; lane < lanes; ++lane) {
        if (!(mask >> lane & 1)) continue;
        const float storage = argument(1, lane), at = argument(2, lane);
        const uint64_t key = uint64_t(uint32_t(argument(0, lane))) << 32 | uint32_t(first + lane);
        const int width = resize ? int(argument(3, lane)) : ir::components(store ? s.argKinds[3] : s.resultKinds[0]);
        // Floats count whole numbers up to 2^24 one by one.
        const float beyond = at - storage; // may be not a number: the shader's own
        const size_t begin = size_t(beyond > 0 ? std::min(beyond, float(1 << 24)) : 0) * size_t(width);
        if (load) {
            const auto v = elements_.find(key);
            const bool there = v != elements_.end() && begin + size_t(width) <= v->second.size();
            for (int k = 0; k < width; ++k) put(k, lane, there ? v->second[begin + size_t(k)] : 0);
            continue;
        }
        std::vector<float>& v = elements_[key];
        const size_t size = resize ? begin : begin + size_t(width);
        const bool fits = at < float(1 << 24) && reserve(v, size);
        full |= !fits;
        if (fits && v.size() < size) v.resize(size);
        if (resize) put(0, lane, fits ? at : storage);
        if (store) put(0, lane, fits ? at + 1 : at);
        for (int k = 0; store && fits && k < width; ++k) v[begin + size_t(k)] = argument(3 + k, lane);
    }
    if (!full) return true;
    const std::string file =
        files && s.place.file >= 0 && size_t(s.place.file) < files->size() ? (*files)[size_t(s.place.file)] : "";
    diagnostics.reportOnce("spilled arrays:" + file + std::to_string(s.place.line),
                           diagnostic(msg::kArraysLimit(most_ >> 20, 1 << 24), Rie::Limit, {file, s.place.line, s.place.column}));
    return true;
}

} // namespace alpenglow::rsl
