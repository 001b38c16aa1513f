// Targa pictures against bytes written by the letter of the format, and pictures through the module for other formats.
#include "base/limits.h"
#include "display/foreign.h"
#include "support.h"
#include <chrono>

namespace targa_test {

using namespace alpenglow;
using namespace alpenglow::display;
using namespace alpenglow::display::test;

namespace {

using Byte = std::vector<uint8_t>;

/// A header: type, map (length, bits), size, bits, descriptor.
Byte header(int type, int mapLength, int mapBits, int w, int h, int bits, int descriptor) {
    return {2,
            uint8_t(mapLength > 0),
            uint8_t(type),
            0,
            0,
            uint8_t(mapLength),
            uint8_t(mapLength >> 8),
            uint8_t(mapBits),
            0,
            0,
            0,
            0,
            uint8_t(w),
            uint8_t(w >> 8),
            uint8_t(h),
            uint8_t(h >> 8),
            uint8_t(bits),
            uint8_t(descriptor),
            'i',
            'd'};
}
Byte operator+(Byte a, const Byte& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}
std::vector<int> codesOf(const Image& m) {
    std::vector<int> c;
    for (float v : m.data) c.push_back(int(std::lround(v * 255)));
    return c;
}
Image read(const Byte& b) {
    Diagnostics d;
    auto m = decodeImage(b, "a.tga", d);
    EXPECT_TRUE(m) << messages(d);
    return m ? *m : Image{};
}

} // namespace

TEST(Targa, RowsFromEitherEndAndColumns) {
    const Byte pixels = {3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10}; // b g r
    EXPECT_EQ(codesOf(read(header(2, 0, 0, 2, 2, 24, 32) + pixels)), (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
    EXPECT_EQ(codesOf(read(header(2, 0, 0, 2, 2, 24, 0) + pixels)), (std::vector<int>{7, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(codesOf(read(header(2, 0, 0, 2, 2, 24, 48) + pixels)), (std::vector<int>{4, 5, 6, 1, 2, 3, 10, 11, 12, 7, 8, 9}));
}

TEST(Targa, OpacityGreyFifteenBitsAndColourMaps) {
    const Image a = read(header(2, 0, 0, 1, 1, 32, 40) + Byte{3, 2, 1, 200});
    EXPECT_EQ(a.channels, (std::vector<std::string>{"r", "g", "b", "a"}));
    EXPECT_EQ(codesOf(a), (std::vector<int>{1, 2, 3, 200}));
    EXPECT_EQ(read(header(2, 0, 0, 1, 1, 32, 32) + Byte{3, 2, 1, 0}).channels.size(), 3u); // no bit of opacity
    const Image g = read(header(3, 0, 0, 2, 1, 8, 32) + Byte{0, 255});
    EXPECT_EQ(g.channels, (std::vector<std::string>{"y"}));
    EXPECT_EQ(codesOf(g), (std::vector<int>{0, 255}));
    EXPECT_EQ(read(header(3, 0, 0, 1, 1, 16, 40) + Byte{9, 8}).channels.size(), 2u);
    const Image f = read(header(2, 0, 0, 1, 1, 16, 32) + Byte{0x1f, 0x7c}); // 0 11111 00000 11111
    EXPECT_EQ(f.data, (std::vector<float>{1, 0, 1}));
    const Image m = read(header(1, 2, 24, 3, 1, 8, 32) + Byte{3, 2, 1, 6, 5, 4} + Byte{1, 0, 1});
    EXPECT_EQ(codesOf(m), (std::vector<int>{4, 5, 6, 1, 2, 3, 4, 5, 6}));
    Diagnostics d;
    EXPECT_FALSE(decodeImage(header(1, 2, 24, 1, 1, 8, 32) + Byte{3, 2, 1, 6, 5, 4} + Byte{2}, "a.tga", d));
    EXPECT_NE(messages(d).find("colour map"), std::string::npos);
}

TEST(Targa, RunLengths) {
    // Three of one, two as they are.
    const Image m = read(header(10, 0, 0, 5, 1, 24, 32) + Byte{0x82, 3, 2, 1, 0x01, 6, 5, 4, 9, 8, 7});
    EXPECT_EQ(codesOf(m), (std::vector<int>{1, 2, 3, 1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(Targa, CutAndDamagedFilesAreErrorsOrPictures) {
    Byte whole = header(10, 0, 0, 40, 3, 24, 32);
    for (int i = 0; i < 120; ++i) whole = whole + Byte{0, uint8_t(i), uint8_t(2 * i), uint8_t(3 * i)};
    for (size_t n = 0; n < whole.size(); ++n) {
        Diagnostics d;
        EXPECT_FALSE(decodeImage(Byte(whole.begin(), whole.begin() + std::ptrdiff_t(n)), "a.tga", d)) << n;
        EXPECT_EQ(d.errors(), 1) << n;
    }
    uint32_t random = 1;
    for (int trial = 0; trial < 2000; ++trial) {
        Byte b = whole;
        for (int k = 0; k < 1 + trial % 4; ++k) {
            random = random * 1664525 + 1013904223;
            b[(random >> 8) % (trial % 2 ? 20 : b.size())] = uint8_t(random >> 24);
        }
        Diagnostics d;
        const auto m = decodeImage(b, "a.tga", d);
        if (m) EXPECT_EQ(m->data.size(), m->sampleCount());
        else EXPECT_EQ(d.errors(), 1);
    }
}

#ifdef ALPENGLOW_HAS_PICTURES
namespace {
/// A picture in the binary form of PNM, which is not read here: 3 x 2, codes 0, 10, 20, ...
Byte pnm() {
    Byte b;
    for (char c : std::string("P6\n3 2\n255\n")) b.push_back(uint8_t(c));
    for (int i = 0; i < 18; ++i) b.push_back(uint8_t(10 * i));
    return b;
}
} // namespace

TEST(Foreign, TheModuleReadsWhatIsNotReadHere) {
    Scratch s;
    putBytes(s / "a.ppm", pnm());
    Diagnostics d;
    const auto m = readImage(s / "a.ppm", d);
    ASSERT_TRUE(m) << messages(d);
    EXPECT_EQ(d.all().size(), 0u);
    EXPECT_EQ(m->width, 3);
    EXPECT_EQ(m->height, 2);
    EXPECT_EQ(m->channels, (std::vector<std::string>{"r", "g", "b"}));
    EXPECT_EQ(m->bits, 8);
    EXPECT_FALSE(m->floating);
    for (int i = 0; i < 18; ++i) EXPECT_EQ(std::lround(m->data[size_t(i)] * 255), 10 * i);
}

TEST(Foreign, CutAndDamagedFilesAreErrorsOrPictures) {
    Scratch s;
    Byte whole = pnm();
    uint32_t random = 5;
    for (int trial = 0; trial < 8; ++trial) { // each is a child process
        Byte b = whole;
        if (trial % 2) b.resize(b.size() * size_t(trial) / 8);
        for (int k = 0; k < trial % 3; ++k) {
            random = random * 1664525 + 1013904223;
            if (!b.empty()) b[(random >> 8) % b.size()] = uint8_t(random >> 24);
        }
        putBytes(s / "a.ppm", b);
        Diagnostics d;
        const auto m = readImage(s / "a.ppm", d);
        if (m) EXPECT_EQ(m->data.size(), m->sampleCount());
        else EXPECT_EQ(d.errors(), 1) << messages(d);
    }
}
#endif

#if !__has_feature(address_sanitizer) // its own tables are larger than any limit
// In addition to the picture, twice, a module has kForeignBytes.
TEST(Foreign, TheModuleHasNoMoreMemoryThanItNeeds) {
    static_assert(kForeignBytes + 2 * limits::kImageSmallBytes < size_t(16) << 30);
    Scratch s;
    putBytes(s / "a.ppm", {'P', '6', '\n', '1', ' ', '1', '\n', '2', '5', '5', '\n', 1, 2, 3});
    setenv("ALPENGLOW_PICTURES", HUNGRY_MODULE, 1);
    Diagnostics d;
    EXPECT_FALSE(readImage(s / "a.ppm", d));
    EXPECT_EQ(d.errors(), 1);
    EXPECT_NE(messages(d).find("out of memory"), std::string::npos) << messages(d);
    unsetenv("ALPENGLOW_PICTURES");
}
#endif

TEST(Foreign, WithoutTheModuleTheErrorSaysSo) {
    Scratch s;
    putBytes(s / "a.ppm", {'P', '6', '\n', '1', ' ', '1', '\n', '2', '5', '5', '\n', 1, 2, 3});
    putBytes(s / "libwrong.so", {'n', 'o', ' ', 'm', 'o', 'd', 'u', 'l', 'e'});
    for (const char* module : {"nowhere.so", "libwrong.so"}) {
        setenv("ALPENGLOW_PICTURES", (s / module).c_str(), 1);
        Diagnostics d;
        EXPECT_FALSE(readImage(s / "a.ppm", d));
        EXPECT_EQ(d.errors(), 1);
        EXPECT_NE(messages(d).find("module for others"), std::string::npos) << messages(d);
    }
    unsetenv("ALPENGLOW_PICTURES");
}

} // namespace targa_test
