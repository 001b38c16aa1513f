// Seeds made by our own writers: pictures, maps, part files.
#include "../display/pixar_writer.h"
#include "display/imageio.h"
#include "program.h"
#include "targets.h"
#include <fstream>

namespace alpenglow::fuzz {

void putFile(const std::string& name, const Bytes& bytes) { std::ofstream(name, std::ios::binary) << bytes; }

namespace {

Bytes shadowMap() {
    display::test::PixarFile f;
    f.type = 2;
    f.floats = true;
    f.levels = {display::makeImage(16, 16, {"z"})};
    for (size_t i = 0; i < 256; ++i) f.levels[0].data[i] = i % 3 ? 1e30f : 4;
    f.matrices = {.5f, 0, 0, 0, 0, .5f, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1};
    f.coding = [](int) { return display::test::Coding::Zlib; };
    const auto b = f.bytes();
    return Bytes(b.begin(), b.end());
}

/// A KTX2 picture of 8 x 4 pixels, of one level.
Bytes ktx2(unsigned vulkanFormat) {
    Bytes b("\xabKTX 20\xbb\r\n\x1a\n", 12);
    const auto put = [&](unsigned v, int bytes) {
        for (int i = 0; i < bytes; ++i) b.push_back(char(v >> (8 * i) & 255));
    };
    const unsigned size = vulkanFormat == 23 ? 96 : vulkanFormat == 109 ? 512 : vulkanFormat == 131 ? 16 : 32;
    for (const unsigned v : {vulkanFormat, 1u, 8u, 4u, 0u, 0u, 1u, 1u, 0u}) put(v, 4);
    b += Bytes(32, '\0');
    put(104, 8), put(size, 8), put(size, 8);
    for (unsigned i = 0; i < size; ++i) b.push_back(char(i * 37 + 5));
    return b;
}

display::Image smallPicture(int channels) {
    display::Image m = display::makeImage(20, 12, display::defaultChannels(channels));
    for (size_t i = 0; i < m.data.size(); ++i) m.data[i] = float(i * 7 % 256) / 255;
    return m;
}

void writeAs(const std::string& name, const display::Image& m, display::Format format, display::Sample sample,
             const std::string& compression, int tile) {
    Diagnostics d;
    display::WriteOptions o;
    o.format = format;
    o.sample = sample;
    o.compression = compression;
    o.tile = tile;
    display::writeImage(name, m, o, d);
}

} // namespace

void makePictures() {
    using display::Format, display::Sample;
    int n = 0;
    const auto name = [&](const char* extension) { return std::to_string(100 + n++) + extension; };
    for (int channels : {1, 3, 4}) {
        const display::Image m = smallPicture(channels);
        for (const char* c : {"none", "zip", "lzw", "packbits"})
            for (Sample s : {Sample::UInt8, Sample::UInt16, Sample::Float}) writeAs(name(".tif"), m, Format::Tiff, s, c, 0);
        for (const char* c : {"none", "rle", "zips", "zip", "piz"})
            for (int tile : {0, 8}) writeAs(name(".exr"), m, Format::Exr, tile ? Sample::Half : Sample::Float, c, tile);
        for (Sample s : {Sample::UInt8, Sample::UInt16}) writeAs(name(".png"), m, Format::Png, s, "", 0);
    }
    using display::test::Coding;
    for (Coding how : {Coding::Raw, Coding::Constant, Coding::Runs, Coding::Lzw, Coding::Huffman, Coding::Zlib})
        for (int version : {2, 3}) {
            display::test::PixarFile f;
            f.version = version;
            f.big = how != Coding::Lzw;
            f.type = how == Coding::Raw ? 3 : 1;
            f.coding = [how](int) { return how; };
            display::Image m = display::makeImage(16, 8, {"y"});
            for (size_t i = 0; i < m.data.size(); ++i) m.data[i] = float(i * i % 251);
            f.levels = display::test::withCodeLevels(m, 4);
            const auto b = f.bytes();
            putFile(name(".tx"), Bytes(b.begin(), b.end()));
        }
    putFile(name(".shd"), shadowMap());
    for (const int format : {23, 109, 131, 137, 141, 143, 145}) putFile(name(".ktx"), ktx2(unsigned(format)));
}

const char* const partScene =
    "Format 6 4 1\nDisplay \"p.exr\" \"openexr\" \"rgba\"\nProjection \"perspective\" \"fov\" 40\nTranslate 0 0 4\nWorldBegin\n"
    "LightSource \"ambientlight\" 1\nLightSource \"distantlight\" 2\nSurface \"matte\"\nSphere 1 -1 1 360\nWorldEnd\n";

void makeParts() {
    putFile("p.rib", partScene);
    program({"render", "-q", "--hider", "path", "--samples", "0:2", "-o", "a.exr", "p.rib"});
    program({"render", "-q", "--hider", "path", "--samples", "2:4", "-o", "b.exr", "p.rib"});
    program({"render", "-q", "--hider", "path", "--spp", "2", "--checkpoint", "c.part", "p.rib"});
}

/// Map files that scenes and shaders of the generators name.
void putMaps() {
    static const Bytes shadow = shadowMap();
    static const Bytes texture = [] {
        writeAs("a.tif", smallPicture(3), display::Format::Tiff, display::Sample::UInt8, "zip", 0);
        return contentsOf("a.tif");
    }();
    putFile("a.tx", texture);
    putFile("a.shd", shadow);
}

} // namespace alpenglow::fuzz
