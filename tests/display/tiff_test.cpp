// TIFF as others write it: planes, tiles, palettes, bits, orientations. Written here by libtiff, read by our codec.
#include "support.h"
#include <half.h>
#include <tiffio.h>

namespace tiff_test {

using namespace alpenglow;
using namespace alpenglow::display;
using namespace alpenglow::display::test;

namespace {

struct Writer {
    Scratch s;
    TIFF* t;
    Writer(int w, int h, int bits, int samples, int photometric) : t(TIFFOpen((s / "a.tif").c_str(), "w")) {
        TIFFSetField(t, TIFFTAG_IMAGEWIDTH, uint32_t(w));
        TIFFSetField(t, TIFFTAG_IMAGELENGTH, uint32_t(h));
        TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, bits);
        TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, samples);
        TIFFSetField(t, TIFFTAG_PHOTOMETRIC, photometric);
        TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
        TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, 2u);
    }
    Image finish() {
        TIFFClose(t);
        Diagnostics d;
        auto m = readImage(s / "a.tif", d);
        EXPECT_TRUE(m) << messages(d);
        return m ? *m : Image{};
    }
};

} // namespace

TEST(ForeignTiff, SeparatePlanesOf16Bits) {
    Writer w(3, 2, 16, 3, PHOTOMETRIC_RGB);
    TIFFSetField(w.t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_SEPARATE);
    for (uint16_t c = 0; c < 3; ++c)
        for (uint32_t y = 0; y < 2; ++y) {
            uint16_t row[3];
            for (uint16_t x = 0; x < 3; ++x) row[x] = uint16_t(1000 * c + 100 * y + x);
            TIFFWriteScanline(w.t, row, y, c);
        }
    Image m = w.finish();
    ASSERT_EQ(m.data.size(), 18u);
    EXPECT_EQ(m.bits, 16);
    EXPECT_EQ(m.pixel(2, 1)[1], 1102 / 65535.0f);
    EXPECT_EQ(m.pixel(0, 1)[2], 2100 / 65535.0f);
}

TEST(ForeignTiff, TilesWithARaggedEdge) {
    Writer w(20, 18, 8, 1, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(w.t, TIFFTAG_TILEWIDTH, 16u);
    TIFFSetField(w.t, TIFFTAG_TILELENGTH, 16u);
    for (uint32_t ty = 0; ty < 18; ty += 16)
        for (uint32_t tx = 0; tx < 20; tx += 16) {
            uint8_t tile[256];
            for (uint32_t i = 0; i < 256; ++i) tile[i] = uint8_t((tx + i % 16) * 7 + (ty + i / 16));
            TIFFWriteTile(w.t, tile, tx, ty, 0, 0);
        }
    Image m = w.finish();
    ASSERT_EQ(m.data.size(), 360u);
    for (int y = 0; y < 18; ++y)
        for (int x = 0; x < 20; ++x) EXPECT_EQ(m.pixel(x, y)[0], float(x * 7 + y) / 255.0f);
}

TEST(ForeignTiff, PaletteOneBitAndWhiteIsZero) {
    {
        Writer w(2, 1, 8, 1, PHOTOMETRIC_PALETTE);
        std::vector<uint16_t> r(256, 0), g(256, 0), b(256, 0);
        r[5] = 0xffff;
        g[9] = 0xffff;
        TIFFSetField(w.t, TIFFTAG_COLORMAP, r.data(), g.data(), b.data());
        uint8_t row[2] = {5, 9};
        TIFFWriteScanline(w.t, row, 0, 0);
        Image m = w.finish();
        EXPECT_EQ(m.data, (std::vector<float>{1, 0, 0, 0, 1, 0}));
    }
    {
        Writer w(8, 1, 1, 1, PHOTOMETRIC_MINISBLACK);
        uint8_t row = 0b10100000;
        TIFFWriteScanline(w.t, &row, 0, 0);
        EXPECT_EQ(w.finish().data, (std::vector<float>{1, 0, 1, 0, 0, 0, 0, 0}));
    }
    {
        Writer w(2, 1, 8, 1, PHOTOMETRIC_MINISWHITE);
        uint8_t row[2] = {0, 255};
        TIFFWriteScanline(w.t, row, 0, 0);
        EXPECT_EQ(w.finish().data, (std::vector<float>{1, 0}));
    }
}

TEST(ForeignTiff, FloatsOf16And64Bits) {
    {
        Writer w(2, 1, 16, 1, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(w.t, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
        uint16_t row[2] = {Imath::half(1.5f).bits(), Imath::half(-0.25f).bits()};
        TIFFWriteScanline(w.t, row, 0, 0);
        EXPECT_EQ(w.finish().data, (std::vector<float>{1.5f, -0.25f}));
    }
    {
        Writer w(1, 1, 64, 1, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(w.t, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
        double v = 0.1;
        TIFFWriteScanline(w.t, &v, 0, 0);
        EXPECT_EQ(w.finish().data, std::vector<float>{0.1f});
    }
}

TEST(ForeignTiff, Orientations) {
    // Stored: 1 2 / 3 4.
    const std::pair<int, std::vector<float>> cases[] = {{ORIENTATION_TOPLEFT, {1, 2, 3, 4}},
                                                        {ORIENTATION_TOPRIGHT, {2, 1, 4, 3}},
                                                        {ORIENTATION_BOTRIGHT, {4, 3, 2, 1}},
                                                        {ORIENTATION_BOTLEFT, {3, 4, 1, 2}}};
    for (auto& [orientation, expected] : cases) {
        Writer w(2, 2, 32, 1, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(w.t, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
        TIFFSetField(w.t, TIFFTAG_ORIENTATION, orientation);
        float rows[2][2] = {{1, 2}, {3, 4}};
        for (uint32_t y = 0; y < 2; ++y) TIFFWriteScanline(w.t, rows[y], y, 0);
        EXPECT_EQ(w.finish().data, expected) << orientation;
    }
}

TEST(ForeignTiff, MipLevelsInDirectories) {
    Scratch s;
    TIFF* t = TIFFOpen((s / "a.tex").c_str(), "w");
    for (int n = 4, level = 0; n >= 1; n /= 2, ++level) {
        TIFFSetField(t, TIFFTAG_IMAGEWIDTH, uint32_t(n));
        TIFFSetField(t, TIFFTAG_IMAGELENGTH, uint32_t(n));
        TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, 8);
        TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(t, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        if (level == 0) TIFFSetField(t, TIFFTAG_PIXAR_WRAPMODES, "periodic,black");
        std::vector<uint8_t> row(size_t(n), uint8_t(51 * level));
        for (int y = 0; y < n; ++y) TIFFWriteScanline(t, row.data(), uint32_t(y), 0);
        TIFFWriteDirectory(t);
    }
    TIFFClose(t);
    Diagnostics d;
    ReadOptions o;
    o.levels = true;
    auto m = readImage(s / "a.tex", d, o);
    ASSERT_TRUE(m) << messages(d);
    ASSERT_EQ(m->levels.size(), 2u);
    EXPECT_EQ(m->levels[1].data, std::vector<float>{0.4f}); // 102 / 255
    EXPECT_EQ(m->metadata["wrapmodes"], "periodic,black");
    EXPECT_TRUE(readImage(s / "a.tex", d)->levels.empty());
}

// What a shader outputs as a colour or a normal is shown as colours, by whatever reads no names; other sets of channels as greys.
TEST(OwnTiff, TriplesAreColours) {
    Scratch s;
    const std::pair<std::vector<std::string>, int> cases[] = {{{"r", "g", "b"}, PHOTOMETRIC_RGB},
                                                              {{"Cs.r", "Cs.g", "Cs.b"}, PHOTOMETRIC_RGB},
                                                              {{"N.x", "N.y", "N.z", "a"}, PHOTOMETRIC_RGB},
                                                              {{"a.r", "b.g", "b.b"}, PHOTOMETRIC_MINISBLACK},
                                                              {{"x", "y", "z"}, PHOTOMETRIC_MINISBLACK},
                                                              {{"colour", "bag", "crab"}, PHOTOMETRIC_MINISBLACK},
                                                              {{"u", "v"}, PHOTOMETRIC_MINISBLACK}};
    for (const auto& [channels, photometric] : cases) {
        Image m = makeImage(2, 1, channels);
        for (size_t i = 0; i < m.data.size(); ++i) m.data[i] = float(i) / 16;
        Diagnostics d;
        WriteOptions o;
        o.format = Format::Tiff;
        o.sample = Sample::Float;
        o.policy = s.policy();
        ASSERT_TRUE(writeImage("own.tif", m, o, d)) << messages(d);
        TIFF* t = TIFFOpen((s / "own.tif").c_str(), "r");
        ASSERT_TRUE(t);
        uint16_t shown = 99;
        TIFFGetField(t, TIFFTAG_PHOTOMETRIC, &shown);
        TIFFClose(t);
        EXPECT_EQ(shown, photometric) << channels[0];
        const auto again = readImage(s / "own.tif", d);
        ASSERT_TRUE(again) << messages(d);
        EXPECT_EQ(again->channels, channels);
        EXPECT_EQ(again->data, m.data);
    }
}

} // namespace tiff_test
