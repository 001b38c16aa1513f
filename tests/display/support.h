// Shared by the tests of this room: a scratch directory, pictures with known values, counting diagnostics.
#pragma once
#include "display/imageio.h"
#include <atomic>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace alpenglow::display::test {

/// A directory of its own for each test, removed at the end.
struct Scratch {
    std::filesystem::path dir;
    Scratch() {
        auto* info = testing::UnitTest::GetInstance()->current_test_info();
        std::string name =
            std::string("alpenglow-") + info->test_suite_name() + "-" + info->name() + "-" + std::to_string(getpid());
        for (char& c : name)
            if (c == '/') c = '_';
        dir = std::filesystem::temp_directory_path() / name;
        std::filesystem::remove_all(dir);
        std::filesystem::create_directories(dir);
    }
    ~Scratch() {
        std::error_code e;
        std::filesystem::remove_all(dir, e);
    }
    std::string operator/(const std::string& n) const { return (dir / n).string(); }
    OutputPolicy policy() const { return {dir.string(), false, -1}; }
    size_t files() const {
        size_t n = 0;
        for (auto& e : std::filesystem::recursive_directory_iterator(dir)) n += e.is_regular_file();
        return n;
    }
};

/// Every sample different and exact in 8-bit codes, halves and floats alike: v = k / 255 with k = (7x + 13y + 31c) mod 256.
inline Image pattern(int w, int h, std::vector<std::string> channels) {
    Image m = makeImage(w, h, std::move(channels));
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (int c = 0; c < m.channelCount(); ++c) m.pixel(x, y)[c] = float((7 * x + 13 * y + 31 * c) % 256) / 255.0f;
    return m;
}

inline std::vector<uint8_t> bytesOf(const std::string& path) {
    std::ifstream f(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(f), {}};
}
inline void putBytes(const std::string& path, const std::vector<uint8_t>& b) {
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(b.data()), std::streamsize(b.size()));
}

inline std::string messages(const Diagnostics& d) {
    std::string s;
    for (auto& m : d.all()) s += toString(m);
    return s;
}

} // namespace alpenglow::display::test
