// A ball of faces, with a function on it: a cube whose sides are cut into n x n faces each, blown up.
#pragma once
#include "base/file.h"
#include "base/vec.h"
#include "ptex/filter.h"
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <iterator>
#include <map>
#include <unistd.h>

namespace alpenglow::ptex::test {

struct Ball {
    int n;
    std::vector<std::array<Vec3d, 4>> corners; ///< on the cube
    Head head;

    explicit Ball(int cut) : n(cut) {
        for (int side = 0; side < 6; ++side)
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i)
                    corners.push_back({at(side, i, j), at(side, i + 1, j), at(side, i + 1, j + 1), at(side, i, j + 1)});
        head.faces.resize(corners.size());
        std::map<std::array<std::array<int, 3>, 2>, std::pair<int, int>> edges;
        const auto key = [&](const Vec3d& p) {
            return std::array<int, 3>{int(std::lround(p.x * 1000)), int(std::lround(p.y * 1000)), int(std::lround(p.z * 1000))};
        };
        for (size_t f = 0; f < corners.size(); ++f)
            for (size_t e = 0; e < 4; ++e) edges[{key(corners[f][e]), key(corners[f][(e + 1) % 4])}] = {int(f), int(e)};
        for (size_t f = 0; f < corners.size(); ++f)
            for (size_t e = 0; e < 4; ++e) {
                const auto to = edges.at({key(corners[f][(e + 1) % 4]), key(corners[f][e])});
                head.faces[f].adjacent[e] = to.first;
                head.faces[f].edge[e] = uint8_t(to.second);
            }
    }
    /// Corner (i, j) of a side, from outside against the clock.
    Vec3d at(int side, int i, int j) const {
        Vec3d p;
        const int axis = side / 2;
        const double sign = side & 1 ? -1 : 1, s = 2.0 * i / n - 1, t = 2.0 * j / n - 1;
        p[axis] = sign;
        p[(axis + 1) % 3] = side & 1 ? t : s;
        p[(axis + 2) % 3] = side & 1 ? s : t;
        return p;
    }
    Vec3d place(size_t f, double u, double v) const {
        const auto& c = corners[f];
        return normalize((c[0] * (1 - u) + c[1] * u) * (1 - v) + (c[3] * (1 - u) + c[2] * u) * v);
    }
    /// The face that a direction goes through, and where.
    size_t find(const Vec3d& d, double& u, double& v) const {
        const Vec3d a(std::fabs(d.x), std::fabs(d.y), std::fabs(d.z));
        const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
        const bool back = d[axis] < 0;
        double s = d[(axis + 1) % 3] / a[axis], t = d[(axis + 2) % 3] / a[axis];
        if (back) std::swap(s, t);
        const double x = std::clamp((s + 1) / 2 * n, 0.0, n - 1e-9), y = std::clamp((t + 1) / 2 * n, 0.0, n - 1e-9);
        u = x - int(x), v = y - int(y);
        return size_t(((2 * axis + back) * n + int(y)) * n + int(x));
    }
    /// Pictures of a function, with sides of 2^log(face) pixels.
    std::vector<Image> paint(const std::function<float(const Vec3d&)>& value, const std::function<int(size_t)>& log) {
        std::vector<Image> all;
        head.channels = 1;
        for (size_t f = 0; f < corners.size(); ++f) {
            Image m{1 << log(f), 1 << log(f), {}};
            head.faces[f].ulog = head.faces[f].vlog = uint8_t(log(f));
            for (int j = 0; j < m.v; ++j)
                for (int i = 0; i < m.u; ++i) m.values.push_back(value(place(f, (i + .5) / m.u, (j + .5) / m.v)));
            all.push_back(std::move(m));
        }
        return all;
    }
};

class Ptex : public ::testing::Test {
protected:
    std::filesystem::path dir;
    Diagnostics d;
    void SetUp() override {
        dir = std::filesystem::temp_directory_path() / ("alpenglow_ptex_" + std::to_string(getpid()) + "_" +
                                                        ::testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(dir);
    }
    void TearDown() override { std::filesystem::remove_all(dir); }
    std::string path(const std::string& name) const { return (dir / name).string(); }
    OutputPolicy policy() const { return {dir.string(), true, -1}; }
    std::shared_ptr<const Texture> open(const std::string& name) { return openTexture(path(name), makeCache(1 << 22), d); }
    std::string bytes(const std::string& name) const {
        std::ifstream f(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(f), {}};
    }
    void put(const std::string& name, const std::string& bytes) const { std::ofstream(path(name), std::ios::binary) << bytes; }
};

} // namespace alpenglow::ptex::test
