// JPEG seeds, and random damage to every format: many bytes at once, where imageio_test.cpp changes one.
#include "base/limits.h"
#include "display/formats/codecs.h"
#include "support.h"
#include <csetjmp>
#include <cstdio>
#include <jpeglib.h>
#include <random>

namespace hostile_test {

using namespace alpenglow;
using namespace alpenglow::display;
using namespace alpenglow::display::test;

namespace {

std::vector<uint8_t> encodeJpeg(const Image& m, bool progressive) {
    jpeg_compress_struct c{};
    jpeg_error_mgr e{};
    c.err = jpeg_std_error(&e);
    jpeg_create_compress(&c);
    unsigned char* out = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&c, &out, &size);
    c.image_width = JDIMENSION(m.width);
    c.image_height = JDIMENSION(m.height);
    c.input_components = m.channelCount();
    c.in_color_space = m.channelCount() == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&c);
    jpeg_set_quality(&c, 100, TRUE);
    if (progressive) jpeg_simple_progression(&c);
    jpeg_start_compress(&c, TRUE);
    std::vector<uint8_t> row(size_t(m.width) * m.channels.size());
    for (int y = 0; y < m.height; ++y) {
        for (size_t i = 0; i < row.size(); ++i) row[i] = uint8_t(m.pixel(0, y)[i] * 255 + 0.5f);
        JSAMPROW p = row.data();
        jpeg_write_scanlines(&c, &p, 1);
    }
    jpeg_finish_compress(&c);
    std::vector<uint8_t> bytes(out, out + size);
    jpeg_destroy_compress(&c);
    std::free(out);
    return bytes;
}

Image smooth(int w, int h, int channels) {
    Image m = makeImage(w, h, defaultChannels(channels));
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (int c = 0; c < channels; ++c) m.pixel(x, y)[c] = float(x * 4 + y * 3 + 20 * c) / 255.0f;
    return m;
}

std::vector<std::vector<uint8_t>> allSeeds(const Scratch& s) {
    std::vector<std::vector<uint8_t>> seeds;
    Image m = smooth(24, 20, 3);
    for (Format f : {Format::Exr, Format::Tiff, Format::Png})
        for (const char* c : {"none", "zip", "lzw", "packbits", "rle", "piz"})
            for (Sample sample : {Sample::UInt8, Sample::Float}) {
                Diagnostics d;
                WriteOptions o;
                o.format = f;
                o.sample = sample;
                o.compression = c;
                o.policy = s.policy();
                EXPECT_TRUE(writeImage("seed", m, o, d));
                seeds.push_back(bytesOf(s / "seed"));
            }
    seeds.push_back(encodeJpeg(m, false));
    seeds.push_back(encodeJpeg(m, true));
    return seeds;
}

} // namespace

TEST(Jpeg, GreyAndColourComeBackNearly) {
    for (int n : {1, 3})
        for (bool progressive : {false, true}) {
            Image m = smooth(24, 20, n);
            Diagnostics d;
            auto r = decodeImage(encodeJpeg(m, progressive), "a.jpg", d);
            ASSERT_TRUE(r) << messages(d);
            EXPECT_TRUE(d.all().empty());
            EXPECT_EQ(r->channels, defaultChannels(n));
            EXPECT_EQ(r->width, 24);
            EXPECT_EQ(r->bits, 8);
            for (size_t i = 0; i < m.data.size(); ++i)
                EXPECT_NEAR(r->data[i], m.data[i], 4.0f / 255); // quality 100; chroma is subsampled
        }
}

TEST(Jpeg, PrefixesAreRefusedOrSaid) {
    auto bytes = encodeJpeg(smooth(24, 20, 3), true);
    for (size_t n = 0; n + 2 < bytes.size(); ++n) { // without its last marker the file is still whole in pixels, but not in form
        Diagnostics d;
        std::vector<uint8_t> cut(bytes.begin(), bytes.begin() + std::ptrdiff_t(n));
        decodeImage(cut, "a.jpg", d);
        EXPECT_GE(d.errors() + d.warnings(), 1) << n;
    }
}

TEST(HostileImage, RandomDamage) {
    Scratch s;
    std::mt19937 random(1);
    ReadOptions levels;
    levels.levels = true;
    int read = 0, refused = 0;
    for (const auto& seed : allSeeds(s))
        for (int trial = 0; trial < 300; ++trial) {
            std::vector<uint8_t> b = seed;
            int changes = 1 + int(random() % 8);
            for (int i = 0; i < changes; ++i) {
                size_t at = random() % 3 ? random() % std::min<size_t>(b.size(), 400) : random() % b.size(); // headers more often
                static constexpr uint8_t nasty[] = {0, 1, 0x7f, 0x80, 0xfe, 0xff};
                b[at] = random() % 2 ? nasty[random() % 6] : uint8_t(random());
                if (random() % 16 == 0) b.resize(1 + random() % b.size());
            }
            Diagnostics d;
            auto m = decodeImage(b, "damaged", d, levels);
            if (m) EXPECT_EQ(m->data.size(), m->sampleCount());
            else EXPECT_GE(d.errors(), 1);
            ++(m ? read : refused);
        }
    EXPECT_GT(read, 0);
    EXPECT_GT(refused, 100);
}

TEST(ImageLimits, SidesChannelsBytesExpansion) {
    Diagnostics d;
    ReadOptions o;
    std::string name = "x";
    const uint64_t side = uint64_t(limits::kImageSide), channels = uint64_t(limits::kImageChannels);
    DecodeContext large{name, d, o, size_t(1) << 40}, small{name, d, o, 1000};
    EXPECT_TRUE(large.sizeAllowed(side, 1, 1));
    EXPECT_FALSE(large.sizeAllowed(side + 1, 1, 1));
    EXPECT_FALSE(large.sizeAllowed(1, side + 1, 1));
    EXPECT_TRUE(large.sizeAllowed(1, 1, channels));
    EXPECT_FALSE(large.sizeAllowed(1, 1, channels + 1));
    EXPECT_TRUE(large.sizeAllowed(side, side, 2)); // 32 GiB exactly
    EXPECT_FALSE(large.sizeAllowed(side, side, 3));
    EXPECT_TRUE(small.sizeAllowed(4096, 4096, 1)); // 64 MiB: needs no proof
    EXPECT_FALSE(small.sizeAllowed(4096, 4097, 1));
    EXPECT_FALSE(small.sizeAllowed(0, 5, 1));
    EXPECT_EQ(d.errors(), 6);
}

TEST(ImageLimits, ScansOfAJpeg) {
    // Each of 63 coefficients in a scan of its own, four bits deep: 1 + 4 * 63 = 253 scans.
    std::vector<jpeg_scan_info> scans(1);
    scans[0] = {1, {0, 0, 0, 0}, 0, 0, 0, 0};
    for (int depth = 3; depth >= 0; --depth)
        for (int k = 1; k < 64; ++k) scans.push_back({1, {0, 0, 0, 0}, k, k, depth == 3 ? 0 : depth + 1, depth});
    for (size_t count : {scans.size(), size_t(64)}) {
        jpeg_compress_struct c{};
        jpeg_error_mgr e{};
        c.err = jpeg_std_error(&e);
        jpeg_create_compress(&c);
        unsigned char* out = nullptr;
        unsigned long size = 0;
        jpeg_mem_dest(&c, &out, &size);
        c.image_width = c.image_height = 8;
        c.input_components = 1;
        c.in_color_space = JCS_GRAYSCALE;
        jpeg_set_defaults(&c);
        c.scan_info = scans.data();
        c.num_scans = int(count);
        jpeg_start_compress(&c, TRUE);
        uint8_t row[8] = {0, 30, 60, 90, 120, 150, 180, 210};
        JSAMPROW p = row;
        for (int y = 0; y < 8; ++y) jpeg_write_scanlines(&c, &p, 1);
        jpeg_finish_compress(&c);
        Diagnostics d;
        auto m = decodeImage(std::span<const uint8_t>(out, size), "scans.jpg", d);
        EXPECT_EQ(bool(m), int(count) <= limits::kImageScans) << messages(d);
        jpeg_destroy_compress(&c);
        std::free(out);
    }
}

} // namespace hostile_test
