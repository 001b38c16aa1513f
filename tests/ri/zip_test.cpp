// RIB inside zip archives: archives built here byte by byte (PKWARE's APPNOTE 6.3), whole and damaged.
#include "base/limits.h"
#include "base/zipname.h"
#include "collect.h"
#include "ri/limits.h"
#include "ri/zip.h"
#include "scene/scene.h"
#include <filesystem>
#include <fstream>
#include <random>
#include <zlib.h>

namespace zip_test {

using namespace alpenglow;
using namespace alpenglow::ri;
namespace fs = std::filesystem;

namespace {

std::string little(uint64_t v, int bytes) {
    std::string s;
    for (int i = 0; i < bytes; ++i) s += char(v >> (8 * i) & 0xff);
    return s;
}

struct Entry {
    std::string name, text;
    bool deflated = true;
    int flags = 0, method = -1; ///< -1: what `deflated` says
};

std::string deflatedBytes(const std::string& text) {
    z_stream z{};
    deflateInit2(&z, 9, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&z, uLong(text.size())) + 64, '\0');
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    z.avail_in = uInt(text.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = uInt(out.size());
    deflate(&z, Z_FINISH);
    out.resize(z.total_out);
    deflateEnd(&z);
    return out;
}

/// large: sizes and places stand in the extension for large files.
std::string zipOf(const std::vector<Entry>& entries, bool large = false, const std::string& comment = "") {
    std::string body, directory;
    for (const Entry& e : entries) {
        const std::string data = e.deflated ? deflatedBytes(e.text) : e.text;
        const auto crc = uint32_t(crc32(0, reinterpret_cast<const Bytef*>(e.text.data()), uInt(e.text.size())));
        const std::string how = little(uint64_t(e.flags), 2) + little(uint64_t(e.method >= 0 ? e.method : e.deflated ? 8 : 0), 2);
        const std::string shortSizes = little(data.size(), 4) + little(e.text.size(), 4);
        const std::string extra =
            large ? little(1, 2) + little(24, 2) + little(e.text.size(), 8) + little(data.size(), 8) + little(body.size(), 8)
                  : "";
        const std::string sizes = large ? std::string(8, '\xff') : shortSizes,
                          at = large ? std::string(4, '\xff') : little(body.size(), 4);
        directory += little(0x02014b50, 4) + little(20, 2) + little(20, 2) + how + little(0, 4) + little(crc, 4) + sizes +
                     little(e.name.size(), 2) + little(extra.size(), 2) + little(0, 2) + little(0, 8) + at + e.name + extra;
        body += little(0x04034b50, 4) + little(20, 2) + how + little(0, 4) + little(crc, 4) + shortSizes +
                little(e.name.size(), 2) + little(0, 2) + e.name + data;
    }
    std::string end;
    const uint64_t start = body.size();
    if (large)
        end = little(0x06064b50, 4) + little(44, 8) + little(45, 2) + little(45, 2) + little(0, 8) + little(entries.size(), 8) +
              little(entries.size(), 8) + little(directory.size(), 8) + little(start, 8) + little(0x07064b50, 4) + little(0, 4) +
              little(start + directory.size(), 8) + little(1, 4);
    end += little(0x06054b50, 4) + little(0, 4) + little(large ? 0xffff : entries.size(), 2) +
           little(large ? 0xffff : entries.size(), 2) + little(large ? 0xffffffff : directory.size(), 4) +
           little(large ? 0xffffffff : start, 4) + little(comment.size(), 2) + comment;
    return body + directory + end;
}

class Zips : public ::testing::Test {
protected:
    void SetUp() override {
        dir = fs::temp_directory_path() / ("alpenglow_zip_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(dir);
    }
    void TearDown() override { fs::remove_all(dir); }
    void write(const std::string& name, const std::string& bytes) const { std::ofstream(dir / name, std::ios::binary) << bytes; }
    /// All of a member, or "!" and why not.
    std::string get(const std::string& bytes, const std::string& member) const {
        write("t.zip", bytes);
        std::string why, out;
        auto s = zipSource((dir / "t.zip").string(), member, &why);
        if (!s) return "!" + why;
        char buffer[1000];
        while (size_t n = s->read(buffer, sizeof buffer)) out.append(buffer, n);
        return s->failure().empty() ? out : "!" + s->failure();
    }
    std::unique_ptr<Collected> readFile(const std::string& name) const {
        auto c = std::make_unique<Collected>();
        RibReader reader({}, *c, c->diagnostics);
        c->ok = reader.readFile((dir / name).string());
        return c;
    }
    fs::path dir;
};

std::string longText() {
    std::string s;
    for (int i = 0; i < 20'000; ++i) s += "Sphere " + std::to_string(i * 7919 % 1000) + " -1 1 360\n";
    return s;
}

} // namespace

TEST_F(Zips, NamesAreTakenApart) {
    EXPECT_EQ(zipName("a/b.zip!c/d.rib")->zip, "a/b.zip");
    EXPECT_EQ(zipName("a/b.ZIP!/c/d.rib")->member, "c/d.rib");
    EXPECT_EQ(zipName("a!b.zip!c")->zip, "a!b.zip");
    EXPECT_FALSE(zipName("b.zip"));
    EXPECT_FALSE(zipName("b.rib!c"));
    EXPECT_FALSE(zipName("zip!c"));
}

TEST_F(Zips, StoredAndDeflatedMembersAreRead) {
    for (const bool large : {false, true})
        for (const char* comment : {"", "a comment that ends the file"}) {
            const std::string z =
                zipOf({{"a.rib", "one", false}, {"in/b.rib", longText(), true}, {"empty", "", true}}, large, comment);
            EXPECT_EQ(get(z, "a.rib"), "one");
            EXPECT_EQ(get(z, "in/b.rib"), longText());
            EXPECT_EQ(get(z, "In\\B.rib"), longText()); // as Windows has it
            EXPECT_EQ(get(z, "empty"), "");
            EXPECT_EQ(get(z, "c.rib"), "!there is no \"c.rib\" in it");
            EXPECT_EQ(zipMembers((dir / "t.zip").string(), 2, nullptr), (std::vector<std::string>{"a.rib", "in/b.rib"}));
        }
}

TEST_F(Zips, ScenesNameWhatIsInThem) {
    write("assets.zip", zipOf({{"ball.rib", "Color 1 0 0 ReadArchive \"parts/deep.rib\""},
                               {"parts/deep.rib", "Sphere 2 -2 2 360 ReadArchive \"deeper.rib\""},
                               {"parts/deeper.rib", "Sphere 3 -3 3 360 ReadArchive \"outside.rib\""}}));
    write("outside.rib", "Sphere 4 -4 4 360");
    write("main.rib", "WorldBegin ReadArchive \"assets.zip!ball.rib\" "
                      "Procedural \"DelayedReadArchive\" [\"assets.zip!/parts/deeper.rib\"] [-1 1 -1 1 -1 1] WorldEnd");
    auto c = readFile("main.rib");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    ASSERT_EQ(c->frame().primitives.size(), 5u);
    EXPECT_EQ(c->primitive().numbers[0], 2);
    EXPECT_EQ(c->primitive(2).numbers[0], 4);
    EXPECT_EQ(c->primitive().place.file, (dir / "assets.zip!parts/deep.rib").string());
    write("main.rib", "WorldBegin ReadArchive \"assets.zip!none.rib\" ReadArchive \"none.zip!a.rib\" WorldEnd");
    EXPECT_EQ(readFile("main.rib")->diagnostics.errors(), 2);
}

TEST_F(Zips, ScenesLieInThem) {
    write("scene.zip",
          zipOf({{"notes.txt", "no RIB"}, {"s/scene.rib", "WorldBegin Sphere 1 -1 1 360 ReadArchive \"beside.rib\" WorldEnd"}}));
    write("beside.rib", "Sphere 2 -2 2 360");
    for (const char* name : {"scene.zip!s/scene.rib", "scene.zip"}) {
        auto c = readFile(name);
        EXPECT_EQ(c->count(), 0u) << name << c->messages();
        EXPECT_EQ(c->frame().primitives.size(), 2u) << name;
    }
    write("two.zip", zipOf({{"a.rib", ""}, {"b.rib", ""}}));
    EXPECT_NE(readFile("two.zip")->first().message.find("two.zip!a.rib"), std::string::npos);
    EXPECT_FALSE(readFile("scene.zip!none.rib")->ok);
}

TEST_F(Zips, WhatIsNotReadIsNamed) {
    EXPECT_EQ(get(zipOf({{"a", "x", true, 1}}), "a"), "!it is encrypted");
    EXPECT_EQ(get(zipOf({{"a", "x", false, 0, 12}}), "a"), "!it is packed by method 12; stored and deflated ones are read");
    EXPECT_EQ(get("no zip", "a")[0], '!');
    EXPECT_EQ(get(std::string(100, 'x'), "a"), "!it is no zip archive, or its end is missing");
    // Blanks deflate at about 1000:1, and the sizes say so; a size that lies is found while it inflates.
    const std::string blanks(8 << 20, ' ');
    std::string bomb = zipOf({{"a", blanks}});
    if (deflatedBytes(blanks).size() * limits::kGzipRatio < blanks.size())
        EXPECT_EQ(get(bomb, "a"), "!it inflates beyond the limit");
    const size_t entry = bomb.rfind("PK\1\2");
    bomb.replace(entry + 24, 4, little(1000, 4));
    EXPECT_EQ(get(bomb, "a"), "!the zip member is longer than it says");
    std::string wrong = zipOf({{"a", longText()}});
    wrong[wrong.rfind("PK\1\2") + 16] ^= 1;
    EXPECT_EQ(get(wrong, "a"), "!the zip member is damaged: its check sum is another one");
    // A directory that claims too much.
    std::string many = zipOf({{"a", "x"}}, true);
    many.replace(many.rfind("PK\6\6") + 32, 8, little(limits::kZipEntries + 1, 8));
    EXPECT_EQ(get(many, "a"), "!it holds too many files");
    many = zipOf({{"a", "x"}}, true);
    many.replace(many.rfind("PK\6\6") + 40, 8, little(limits::kZipDirectoryBytes + 1, 8));
    EXPECT_EQ(get(many, "a"), "!it holds too many files");
}

TEST_F(Zips, DamageIsNeverWorseThanAMessage) {
    const std::string whole = zipOf({{"a.rib", longText().substr(0, 3000)}, {"b.rib", "Sphere 1 -1 1 360", false}});
    std::mt19937 random(11);
    int good = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string z = whole;
        if (i % 3 == 0) z.resize(random() % z.size());
        else
            for (unsigned k = 0; k <= random() % 4; ++k) z[random() % z.size()] = char(random());
        good += get(z, i % 2 ? "a.rib" : "b.rib")[0] != '!';
    }
    EXPECT_GT(good, 100);
    EXPECT_LT(good, 2900);
}

} // namespace zip_test
