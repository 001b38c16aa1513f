// texture3d() on volumes.
#include "texture/volume.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::texture {

namespace {

/// A volume for texture3d(): its channels interleaved, in all levels.
class VolumeMap : public pointcloud::CloudMap {
public:
    explicit VolumeMap(Volume v) {
        const auto has = [&](const char* name) {
            const auto at = std::find(v.names.begin(), v.names.end(), name);
            return at == v.names.end() ? -1 : int(at - v.names.begin());
        };
        const int r = has("r"), g = has("g"), b = has("b"), a = has("a"), y = has("y");
        const int colours[3] = {r >= 0   ? r
                                : y >= 0 ? y
                                         : 0,
                                g >= 0   ? g
                                : r >= 0 ? r
                                : y >= 0 ? y
                                         : 0,
                                b >= 0   ? b
                                : r >= 0 ? r
                                : y >= 0 ? y
                                         : 0};
        channels_ = {{"color", pointcloud::ChannelType::Color},
                     {"alpha", pointcloud::ChannelType::Float},
                     {"gradient", pointcloud::ChannelType::Vector}};
        for (const std::string& n : v.names)
            if (n != "color" && n != "alpha" && n != "gradient") channels_.push_back({n, pointcloud::ChannelType::Float});
        Volume all{v.width, v.height, v.depth, std::vector<std::string>(size_t(width())), {}};
        const size_t voxels = size_t(v.width) * size_t(v.height) * size_t(v.depth), n = v.names.size();
        all.values.reserve(voxels * size_t(width()));
        for (size_t i = 0; i < voxels; ++i) {
            const float* p = &v.values[i * n];
            for (const int c : colours) all.values.push_back(p[c]);
            all.values.push_back(a >= 0 ? p[a] : n < 3 ? p[colours[0]] : (p[colours[0]] + p[colours[1]] + p[colours[2]]) / 3);
            for (const int c : colours) all.values.push_back(2 * p[c] - 1);
            for (size_t c = 0; c < n; ++c)
                if (v.names[c] != "color" && v.names[c] != "alpha" && v.names[c] != "gradient") all.values.push_back(p[c]);
        }
        levels_.push_back(std::move(all));
        while (levels_.back().width > 1 || levels_.back().height > 1 || levels_.back().depth > 1)
            levels_.push_back(half(levels_.back()));
    }
    const std::vector<pointcloud::Channel>& channels() const override { return channels_; }

    bool lookup(const pointcloud::Query& q, std::span<float> out) const override {
        for (int k = 0; k < 3; ++k)
            if (!(q.P[k] >= 0 && q.P[k] <= 1)) return false;
        const Volume& fine = levels_.front();
        const int side = std::max({fine.width, fine.height, fine.depth}), last = int(levels_.size()) - 1;
        // Interpolated voxels of side u have the variance u^2 / 4 (lookup.cpp), a box of the filter's diameter (2 R)^2 / 12.
        const float u = std::max(1.f, std::min(2 * q.radius / 1.7320508f, 4.f) * float(side));
        int exponent = 0;
        const float mantissa = 2 * std::frexp(u, &exponent);
        const int most = q.maxDepth >= 0 ? std::max(0, last - q.maxDepth) : 0; // the finest that is allowed
        const int level = std::clamp(exponent - 1, most, last);
        const float f = exponent - 1 >= last || exponent - 1 < most ? 0 : (mantissa * mantissa - 1) / 3;
        std::fill(out.begin(), out.end(), 0.f);
        add(levels_[size_t(level)], q.P, 1 - f, out);
        if (f > 0) add(levels_[size_t(level) + 1], q.P, f, out);
        return true;
    }

private:
    /// Halves the number of voxels along each side, at least one; each is the mean of what it covers.
    static Volume half(const Volume& v) {
        Volume to{std::max(1, v.width / 2), std::max(1, v.height / 2), std::max(1, v.depth / 2), v.names, {}};
        const size_t n = v.names.size();
        to.values.resize(size_t(to.width) * size_t(to.height) * size_t(to.depth) * n);
        std::vector<double> sum(n);
        const auto from = [](int i, int small, int large) { return int(int64_t(i) * large / small); };
        for (int z = 0; z < to.depth; ++z)
            for (int y = 0; y < to.height; ++y)
                for (int x = 0; x < to.width; ++x) {
                    std::fill(sum.begin(), sum.end(), 0.0);
                    int count = 0;
                    for (int c = from(z, to.depth, v.depth); c < from(z + 1, to.depth, v.depth); ++c)
                        for (int b = from(y, to.height, v.height); b < from(y + 1, to.height, v.height); ++b)
                            for (int a = from(x, to.width, v.width); a < from(x + 1, to.width, v.width); ++a, ++count)
                                for (size_t k = 0; k < n; ++k) sum[k] += double(v.at(a, b, c)[k]);
                    for (size_t k = 0; k < n; ++k) to.at(x, y, z)[k] = float(sum[k] / count);
                }
        return to;
    }
    static void add(const Volume& v, const Vec3& p, float weight, std::span<float> out) {
        const int sizes[3] = {v.width, v.height, v.depth};
        int i0[3], i1[3];
        float f[3];
        for (int k = 0; k < 3; ++k) {
            const float x = p[k] * float(sizes[k]) - .5f, floor = std::floor(x);
            f[k] = x - floor;
            i0[k] = std::clamp(int(floor), 0, sizes[k] - 1);
            i1[k] = std::clamp(int(floor) + 1, 0, sizes[k] - 1);
        }
        for (int corner = 0; corner < 8; ++corner) {
            const bool x = corner & 1, y = corner & 2, z = corner & 4;
            const float w = weight * (x ? f[0] : 1 - f[0]) * (y ? f[1] : 1 - f[1]) * (z ? f[2] : 1 - f[2]);
            if (w == 0) continue;
            const float* from = v.at(x ? i1[0] : i0[0], y ? i1[1] : i0[1], z ? i1[2] : i0[2]);
            for (size_t k = 0; k < out.size(); ++k) out[k] += w * from[k];
        }
    }
    std::vector<pointcloud::Channel> channels_;
    std::vector<Volume> levels_;
};

} // namespace

std::shared_ptr<const pointcloud::CloudMap> mapOf(Volume v) { return std::make_shared<VolumeMap>(std::move(v)); }

} // namespace alpenglow::texture
