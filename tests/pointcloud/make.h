// Clouds with known values, and a folder for files.
#pragma once
#include "base/file.h"
#include "pointcloud/brickmap.h"
#include "pointcloud/cloudfile.h"
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <unistd.h>

namespace alpenglow::pointcloud::test {

/// A square of n x n points in the plane z = 0, from 0 to 1; "x": linear, "c": color, "m": matrix of the number of the point.
inline PointCloud square(int n, float z = 0, float side = 1) {
    PointCloud c;
    c.channels = {{"x", ChannelType::Float}, {"c", ChannelType::Color}, {"m", ChannelType::Matrix}};
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const float x = (float(i) + .5f) / float(n), y = (float(j) + .5f) / float(n);
            std::vector<float> v = {2 * x - y, x, y, 1};
            for (int k = 0; k < 16; ++k) v.push_back(float(k + i));
            c.add({x, y, z}, {0, 0, side}, .5f / float(n), v);
        }
    return c;
}

class Clouds : public ::testing::Test {
protected:
    std::filesystem::path dir;
    void SetUp() override {
        dir = std::filesystem::temp_directory_path() / ("alpenglow_clouds_" + std::to_string(getpid()) + "_" +
                                                        ::testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(dir);
    }
    void TearDown() override { std::filesystem::remove_all(dir); }
    std::string path(const std::string& name) const { return (dir / name).string(); }
    OutputPolicy policy() const { return {dir.string(), true, -1}; }
    std::string bytes(const std::string& name) const {
        std::ifstream f(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(f), {}};
    }
    void write(const std::string& name, const std::string& all) const { std::ofstream(path(name), std::ios::binary) << all; }
};

inline std::string said(const Diagnostics& d) {
    std::string s;
    for (const Diagnostic& x : d.all()) s += toString(x);
    return s;
}

/// Equal bit by bit.
inline void expectSame(const PointCloud& a, const PointCloud& b) {
    EXPECT_EQ(a.channels, b.channels);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(a.values, b.values);
    EXPECT_EQ(a.radius, b.radius);
    for (size_t i = 0; i < a.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(a.P[i][k], b.P[i][k]);
            EXPECT_EQ(a.N[i][k], b.N[i][k]);
        }
}

} // namespace alpenglow::pointcloud::test
