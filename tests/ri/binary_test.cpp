// Binary RIB (RISpec 3.2, appendix C.2) from hand-assembled bytes, gzip, and damaged streams.
#include "base/limits.h"
#include "collect.h"
#include "scene/scene.h"
#include <fstream>
#include <random>
#include <zlib.h>

namespace binary_test {

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {
std::string bytes(std::initializer_list<int> b) {
    std::string s;
    for (int v : b) s += char(v);
    return s;
}
/// The numbers of a Translate whose three arguments are these bytes.
Vec3d translated(const std::string& arguments) {
    auto c = read("WorldBegin Translate " + arguments + " Sphere 1 -1 1 360 WorldEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    return transformPoint(c->primitive().toWorld.first(), {0, 0, 0});
}
std::string gzip(const std::string& text) {
    z_stream z{};
    deflateInit2(&z, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&z, text.size()) + 64, '\0');
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    z.avail_in = uInt(text.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = uInt(out.size());
    deflate(&z, Z_FINISH);
    out.resize(z.total_out);
    deflateEnd(&z);
    return out;
}
} // namespace

TEST(Binary, Integers) {
    // 0200+w: w+1 bytes, signed, most significant first.
    EXPECT_EQ(translated(bytes({0200, 5, 0201, 1, 2, 0202, 1, 0, 0})), Vec3d(5, 258, 65536));
    EXPECT_EQ(translated(bytes({0200, 0xff, 0201, 0xff, 0xfe, 0203, 0x80, 0, 0, 0})), Vec3d(-1, -2, -2147483648.0));
}

TEST(Binary, FixedPoint) {
    // 0200+4d+w: the integer over 256^d. 0x0180 / 256 = 1.5; 0x40 / 256 = .25; 0x010000 / 65536 = 1.
    EXPECT_EQ(translated(bytes({0205, 0x01, 0x80, 0204, 0x40, 0212, 1, 0, 0})), Vec3d(1.5, .25, 1));
    // d > w + 1: missing leading bytes are zero: 0x40 / 256^3.
    EXPECT_EQ(translated(bytes({0214, 0x40, 0200, 0, 0200, 0})).x, 64.0 / 16777216);
}

TEST(Binary, Floats) {
    // 1.5f = 3FC00000, -2.0 = C000000000000000
    EXPECT_EQ(translated(bytes({0244, 0x3f, 0xc0, 0, 0, 0245, 0xc0, 0, 0, 0, 0, 0, 0, 0, 0200, 3})), Vec3d(1.5, -2, 3));
}

TEST(Binary, MixesWithAscii) { EXPECT_EQ(translated("1.25 " + bytes({0200, 2}) + " 3"), Vec3d(1.25, 2, 3)); }

TEST(Binary, Strings) {
    auto name = [](const std::string& s) {
        auto c = read("Hider " + s + " WorldBegin WorldEnd");
        EXPECT_EQ(c->count(), 0u) << c->messages();
        return c->frame().options.hider;
    };
    EXPECT_EQ(name(bytes({0224}) + "path"), "path");                                 // 0220 + length
    EXPECT_EQ(name(bytes({0240, 4}) + "path"), "path");                              // one length byte
    EXPECT_EQ(name(bytes({0243, 0, 0, 0, 4}) + "path"), "path");                     // four
    EXPECT_EQ(name(bytes({0315, 7, 0224}) + "path" + bytes({0317, 7})), "path");     // define 7, use 7
    EXPECT_EQ(name(bytes({0316, 1, 7}) + "\"path\"" + bytes({0320, 1, 7})), "path"); // two-byte code, ASCII operand
}

TEST(Binary, RequestCodesAndArrays) {
    // Define request 3 as Color, use it with an array of three floats: 1, .5, 0.
    std::string s = bytes({0314, 3, 0225}) + "Color" + "WorldBegin " +
                    bytes({0246, 3, 0310, 3, 0x3f, 0x80, 0, 0, 0x3f, 0, 0, 0, 0, 0, 0, 0}) + "Sphere 1 -1 1 360 WorldEnd";
    auto c = read(s);
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->primitive().attributes->color, Color(1, .5f, 0));
}

TEST(Binary, EndOfDataByteIsNothing) { EXPECT_EQ(inWorld(bytes({0377}))->count(), 0u); }

TEST(Binary, DamageIsReported) {
    EXPECT_EQ(read(bytes({0246, 9}))->only().code, Rie::BadFile); // not defined
    EXPECT_EQ(read("Hider " + bytes({0317, 9}))->first().code, Rie::BadFile);
    EXPECT_EQ(read(bytes({0250}))->only().code, Rie::BadFile); // reserved
    EXPECT_EQ(read(bytes({0321}))->only().code, Rie::BadFile);
    EXPECT_EQ(read("Hider " + bytes({0243, 0xff, 0xff, 0xff, 0xff}) + "x")->first().code, Rie::Limit);
    EXPECT_EQ(read("Color " + bytes({0313, 0xff, 0xff, 0xff, 0xff, 0}))->first().code, Rie::BadFile); // a length that lies
    EXPECT_EQ(read("Color " + bytes({0203, 1}))->first().code, Rie::BadFile);
    // NaN and infinity
    EXPECT_EQ(inWorld("Translate " + bytes({0244, 0x7f, 0xc0, 0, 0}) + " 0 0")->only().code, Rie::Range);
    auto c = inWorld("Polygon \"P\" " + bytes({0310, 9, 0x7f, 0x80, 0, 0}) + std::string(32, '\0'));
    EXPECT_EQ(c->first().code, Rie::Range);
    EXPECT_TRUE(c->frame().primitives.empty());
}

TEST(Gzip, IsDetectedByItsMagic) {
    std::string text = "WorldBegin Sphere 1 -1 1 360 WorldEnd\n";
    auto c = read(gzip(text));
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    EXPECT_EQ(read(gzip(text) + gzip(text))->frames.size(), 2u);       // concatenated members
    EXPECT_EQ(read(gzip(text) + std::string(100, '\0'))->count(), 0u); // padding
}

TEST(Gzip, DamageIsReported) {
    std::string z = gzip("WorldBegin Sphere 1 -1 1 360 WorldEnd\nWorldBegin Sphere 1 -1 1 360 WorldEnd\n");
    EXPECT_EQ(read(z.substr(0, z.size() - 12))->first().code, Rie::BadFile);
    z[z.size() / 2] = char(z[z.size() / 2] ^ 0x55);
    EXPECT_FALSE(read(z)->ok);
}

TEST(Gzip, BombsAreRefused) {
    // 64 MiB of blanks deflate at about 1000:1.
    std::string z = gzip(std::string(64 << 20, ' ') + "WorldBegin WorldEnd");
    if (z.size() * limits::kGzipRatio > size_t(64 << 20)) GTEST_SKIP() << "this zlib compresses less than the limit";
    EXPECT_EQ(read(z)->only().code, Rie::Limit);
}

TEST(Hostile, EveryPrefixOfAScene) {
    const std::string scenes[] = {
        "##RenderMan RIB-Structure 1.0\nversion 3.03\nOption \"searchpath\" \"shader\" [\"a:b\"]\nFrameBegin 1\nDisplay "
        "\"a.tif\" \"tiff\" \"rgba\"\nProjection \"perspective\" \"fov\" 30\n"
        "MotionBegin [0 1] Translate 0 0 5 Translate 0 1 5 MotionEnd\nWorldBegin\nLightSource \"pointlight\" 1 \"from\" [0 1 "
        "0]\nIfBegin \"1 < 2 && defined(x)\"\nElse\nAttributeBegin\n"
        "Surface \"plastic\" \"Kd\" .5\nObjectBegin 1 Sphere 1 -1 1 360 ObjectEnd\nObjectInstance 1\nSolidBegin \"union\" "
        "SolidEnd\nArchiveBegin \"a\" Disk 0 1 360 ArchiveEnd ReadArchive \"a\"\n"
        "AttributeEnd\nIfEnd\nPointsPolygons [3 3] [0 1 2 0 2 1] \"P\" [0 0 0 1 0 0 1 1 0] \"Cs\" [1 0 0 0 1 0 0 0 "
        "1]\nWorldEnd\nFrameEnd\n",
        bytes({0314, 3, 0225}) + "Color" + "WorldBegin " +
            bytes({0246, 3, 0310, 3, 0x3f, 0x80, 0, 0, 0x3f, 0, 0, 0, 0, 0, 0, 0}) + bytes({0315, 1, 0222}) + "Kd" +
            " Surface \"matte\" " + bytes({0317, 1, 0244, 0x3f, 0, 0, 0, 0205, 1, 0x80}) + "Sphere 1 -1 1 360 WorldEnd",
        gzip("WorldBegin NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0] WorldEnd")};
    for (const std::string& s : scenes) {
        EXPECT_TRUE(read(s)->ok) << read(s)->messages();
        for (size_t n = 0; n < s.size(); ++n) {
            auto c = read(std::string_view(s).substr(0, n));
            EXPECT_LE(c->frames.size(), 1u);
        }
        // And damaged in every place.
        std::mt19937 random(7);
        for (size_t n = 0; n < s.size(); ++n)
            for (int k = 0; k < 4; ++k) {
                std::string t = s;
                t[n] = char(random());
                read(t);
            }
    }
}

TEST(Hostile, Noise) {
    std::mt19937 random(1);
    for (int i = 0; i < 300; ++i) {
        std::string s;
        for (int k = 0; k < 500; ++k) s += char(random());
        auto c = read(s);
        EXPECT_TRUE(c->frames.empty());
    }
    EXPECT_FALSE(read(std::string(100000, '['))->ok);
    EXPECT_EQ(read(std::string(100000, ' '))->count(), 0u);
    EXPECT_EQ(read(std::string(100000, '\0'))->only().code, Rie::Syntax);
    EXPECT_EQ(read("")->count(), 0u);
}

TEST(Hostile, ObjectsOfObjectsAreBounded) {
    // Ten copies of ten copies of ...: 10^k primitives.
    auto nested = [](int levels) {
        std::string s = "ObjectBegin 0 Sphere 1 -1 1 360 ObjectEnd\n";
        for (int i = 1; i <= levels; ++i) {
            s += "ObjectBegin " + std::to_string(i);
            for (int k = 0; k < 10; ++k) s += " ObjectInstance " + std::to_string(i - 1);
            s += " ObjectEnd\n";
        }
        return read(s + "WorldBegin ObjectInstance " + std::to_string(levels) + " WorldEnd");
    };
    auto c = nested(3);
    EXPECT_TRUE(c->ok);
    EXPECT_EQ(c->frame().objects.at(0).primitives.size(), 1000u);
    EXPECT_EQ(nested(9)->only().code, Rie::Limit);
}

TEST(Hostile, ArchivesOfArchivesAreBounded) {
    // A thousand times a thousand times a thousand reads of an empty archive.
    std::string s = "ArchiveBegin \"a0\" ArchiveEnd\n";
    for (int i = 1; i <= 3; ++i) {
        s += "ArchiveBegin \"a" + std::to_string(i) + "\"";
        for (int k = 0; k < 1000; ++k) s += " ReadArchive \"a" + std::to_string(i - 1) + "\"";
        s += " ArchiveEnd\n";
    }
    EXPECT_EQ(read(s + "ReadArchive \"a3\"")->only().code, Rie::Limit); // limits::kArchiveReads
    // 10^4 reads of 10^4 requests: limits::kReplayedCalls.
    std::string t = "ArchiveBegin \"b0\"";
    for (int k = 0; k < 10000; ++k) t += " ReverseOrientation";
    t += " ArchiveEnd\n";
    for (int k = 0; k < 10000; ++k) t += "ReadArchive \"b0\" ";
    EXPECT_EQ(read(t)->only().code, Rie::Limit);
}

} // namespace binary_test
