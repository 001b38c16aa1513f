// What pictures and part files may cost.
#include "base/limits.h"
#include "display/support.h"
#include "render/partfile.h"

namespace file_limits_test {

using namespace alpenglow;
using namespace alpenglow::display;
using namespace alpenglow::display::test;

namespace {

/// A file of this many bytes that takes no room on disk.
std::string hole(const Scratch& s, const std::string& name, uintmax_t bytes) {
    putBytes(s / name, {});
    std::error_code e;
    std::filesystem::resize_file(s / name, bytes, e);
    return e ? "" : s / name;
}

void putNumber(std::vector<uint8_t>& b, uint32_t v) {
    for (int k = 24; k >= 0; k -= 8) b.push_back(uint8_t(v >> k));
}

/// A PNG chunk: length, kind and data, CRC-32 (PNG, appendix D).
void putChunk(std::vector<uint8_t>& b, const std::vector<uint8_t>& kindAndData) {
    putNumber(b, uint32_t(kindAndData.size() - 4));
    uint32_t crc = 0xffffffff;
    for (uint8_t x : kindAndData) {
        crc ^= x;
        for (int k = 0; k < 8; ++k) crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
    b.insert(b.end(), kindAndData.begin(), kindAndData.end());
    putNumber(b, ~crc);
}

/// A PNG of 8 bits, RGBA (colour type 6) or grey (0), whose pixels are missing.
std::vector<uint8_t> pngHeader(uint32_t width, uint32_t height, uint8_t colourType) {
    std::vector<uint8_t> b = {0x89, 'P', 'N', 'G', 13, 10, 26, 10}, c = {'I', 'H', 'D', 'R'};
    putNumber(c, width);
    putNumber(c, height);
    c.insert(c.end(), {8, colourType, 0, 0, 0});
    putChunk(b, c);
    putChunk(b, {'I', 'D', 'A', 'T'});
    return b;
}

/// The one message about a file that is refused.
Diagnostic refusal(const std::vector<uint8_t>& bytes) {
    Diagnostics d;
    EXPECT_FALSE(decodeImage(bytes, "a.png", d));
    EXPECT_EQ(d.errors(), 1) << messages(d);
    return d.all().empty() ? Diagnostic{} : d.all()[0];
}

} // namespace

TEST(FileLimits, DecodedPictures) {
    const uint32_t side = uint32_t(limits::kImageSide);
    static_assert(size_t(limits::kImageSide) * limits::kImageSide * 4 * sizeof(float) > limits::kImageBytes);
    EXPECT_EQ(refusal(pngHeader(side, side, 6)).code, Rie::Limit);
    // Grey, 256 MiB decoded, from less than a hundred bytes: refused before anything is allocated.
    static_assert(size_t(8192) * 8192 * sizeof(float) > limits::kImageSmallBytes);
    static_assert(size_t(8192) * 8192 * sizeof(float) / limits::kImageExpansion > 100);
    const Diagnostic m = refusal(pngHeader(8192, 8192, 0));
    EXPECT_EQ(m.code, Rie::BadFile);
    EXPECT_NE(m.message.find("too short for its stated size"), std::string::npos) << m.message;
}

TEST(FileLimits, WrittenPictures) {
    Scratch s;
    Image m;
    m.width = m.height = limits::kImageSide;
    m.channels = defaultChannels(4);
    WriteOptions o;
    o.policy = s.policy();
    Diagnostics d;
    EXPECT_FALSE(writeImage("a.exr", m, o, d));
    ASSERT_EQ(d.errors(), 1);
    EXPECT_EQ(d.all()[0].code, Rie::Limit);
    EXPECT_FALSE(std::filesystem::exists(s / "a.exr"));
}

TEST(FileLimits, LengthOfPicturesAndPartFiles) {
    Scratch s;
    Diagnostics d;
    const std::string picture = hole(s, "a.exr", limits::kImageBytes + 1), part = hole(s, "a.part", limits::kPartFileBytes + 1);
    if (picture.empty() || part.empty()) GTEST_SKIP() << "this file system has no files with holes";
    EXPECT_FALSE(readImage(picture, d));
    EXPECT_EQ(d.errors(), 1) << messages(d);
    EXPECT_FALSE(render::loadPart(part, d));
    EXPECT_EQ(d.errors(), 2) << messages(d);
    for (const Diagnostic& m : d.all()) EXPECT_EQ(m.code, Rie::Limit) << toString(m);
}

TEST(FileLimits, HeadersOfPartFiles) {
    Scratch s;
    render::FilmDescription f;
    f.width = f.height = 1;
    f.window = {0, 0, 1, 1};
    render::Film film(f);
    film.addRange({0, 1});
    Diagnostics d;
    film.metadata["note"] = std::string(limits::kPartHeaderBytes / 2, 'a');
    EXPECT_TRUE(render::savePart(film, "fits.part", s.policy(), d)) << messages(d);
    EXPECT_TRUE(render::loadPart(s / "fits.part", d)) << messages(d);
    film.metadata["note"] = std::string(limits::kPartHeaderBytes + 1, 'a');
    EXPECT_FALSE(render::savePart(film, "large.part", s.policy(), d));
    ASSERT_EQ(d.errors(), 1);
    EXPECT_EQ(d.all()[0].code, Rie::Limit);
    EXPECT_FALSE(std::filesystem::exists(s / "large.part"));
    // A file that states a larger header, in the four bytes after magic and version.
    std::vector<uint8_t> b = bytesOf(s / "fits.part");
    const uint32_t stated = uint32_t(limits::kPartHeaderBytes) + 1;
    for (int k = 0; k < 4; ++k) b[size_t(12 + k)] = uint8_t(stated >> (8 * k));
    b.resize(b.size() + stated);
    EXPECT_FALSE(render::parsePart(b, "stated.part", d));
    EXPECT_EQ(d.errors(), 2);
}

} // namespace file_limits_test
