// Maps that are cut, damaged, changed while they are read, or made by two at once: an error with the name, or a picture.
#include "../nightly.h"
#include "base/limits.h"
#include "pictures.h"
#include "texture/maketexture.h"
#include <random>
#include <sys/wait.h>
#include <thread>

namespace damage_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::display::test;
using namespace alpenglow::texture::test;
using display::Image;

namespace {

std::vector<std::pair<std::string, std::vector<uint8_t>>> seeds(const Scratch& s) {
    std::vector<std::pair<std::string, std::vector<uint8_t>>> all;
    const Image m = pattern(40, 24, {"r", "g", "b"});
    for (auto f : {display::Format::Tiff, display::Format::Png, display::Format::Jpeg}) {
        save(s, "seed", m, f);
        all.push_back({display::toString(f), bytesOf(s / "seed")});
    }
    Diagnostics d;
    MakeOptions o;
    o.searchPath = {s.dir.string()};
    o.policy = s.policy();
    save(s, "seed.tif", m);
    EXPECT_TRUE(makeTexture("seed.tif", "seed.tex", o, d)) << messages(d);
    all.push_back({"tiled OpenEXR", bytesOf(s / "seed.tex")});
    std::vector<uint8_t> hdr;
    for (char c : std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 24 +X 40\n")) hdr.push_back(uint8_t(c));
    for (int i = 0; i < 24 * 40; ++i)
        for (uint8_t v : {uint8_t(i), uint8_t(3 * i), uint8_t(7 * i), uint8_t(128)}) hdr.push_back(v);
    all.push_back({"Radiance", hdr});
    std::vector<uint8_t> tga = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 40, 0, 24, 0, 24, 32};
    for (int i = 0; i < 24 * 40 * 3; ++i) tga.push_back(uint8_t(5 * i));
    all.push_back({"Targa", tga});
    for (const char* native : {"rmemboss.tx", "shad17.shd"}) { // where the samples are
        const std::string path = std::string(ALPENGLOW_SOURCE_DIR) + "/../shared/pixar_textures/" + native;
        if (auto b = bytesOf(path); !b.empty()) all.push_back({native, b});
    }
    return all;
}

/// Reads and makes levels; a picture or an error with a name.
bool readable(const std::vector<uint8_t>& bytes) {
    Diagnostics d;
    display::ReadOptions o;
    o.levels = true;
    auto m = display::decodeImage(bytes, "the map", d, o);
    if (!m) {
        EXPECT_GE(d.errors(), 1);
        EXPECT_NE(messages(d).find("the map"), std::string::npos);
        return false;
    }
    size_t numbers = m->data.size();
    for (const Image& l : m->levels) numbers += l.data.size();
    EXPECT_LE(numbers * sizeof(float), std::max(2 * limits::kImageSmallBytes, 2 * bytes.size() * limits::kImageExpansion));
    if (m->data.size() > 4'000'000) return true; // its levels take the time of a render
    const auto t = makeTextureFrom(std::move(*m));
    float v[3] = {};
    lookup2D(t.get(), 0, 3, .3f, .4f, .1f, 0, 0, .1f, {}, v);
    return true;
}

} // namespace

TEST(Damage, EveryFormatCutAtEvery64thByte) {
    Scratch s;
    for (const auto& [name, bytes] : seeds(s)) {
        EXPECT_TRUE(readable(bytes)) << name;
        // A large sample is cut at some 200 places.
        const size_t step = std::max<size_t>(64, bytes.size() / 200 / 64 * 64);
        for (size_t n = 0; n < bytes.size(); n += step) readable({bytes.begin(), bytes.begin() + std::ptrdiff_t(n)});
    }
}

TEST(Damage, EveryFormat) { // in 2,000 ways nightly
    Scratch s;
    std::mt19937 random(3);
    for (const auto& [name, bytes] : seeds(s)) {
        int good = 0;
        for (int trial = 0; trial < (nightly() ? 2000 : 500); ++trial) {
            std::vector<uint8_t> b = bytes;
            for (unsigned k = 0; k < 1 + random() % 6; ++k) {
                constexpr uint8_t nasty[] = {0, 1, 0x7f, 0x80, 0xfe, 0xff};
                const size_t at = random() % 3 ? random() % std::min<size_t>(b.size(), 300) : random() % b.size();
                b[at] = random() % 2 ? nasty[random() % 6] : uint8_t(random());
            }
            good += readable(b);
            if (HasFailure()) FAIL() << name << " " << trial;
        }
        RecordProperty(name, good);
    }
}

TEST(Damage, AFileThatChangesWhileItIsRead) {
    Scratch s;
    save(s, "a.tif", constant(200, 100, .25f));
    save(s, "b.tif", constant(90, 130, .75f));
    const auto a = bytesOf(s / "a.tif"), b = bytesOf(s / "b.tif");
    std::atomic<bool> stop{false};
    std::thread writer([&] {
        for (unsigned k = 0; !stop; ++k) { // in place, as a careless tool does it
            const auto& whole = k & 1 ? a : b;
            putBytes(s / "map.tif", {whole.begin(), whole.begin() + std::ptrdiff_t(k % 3 ? whole.size() : whole.size() / 2)});
        }
    });
    int read = 0;
    for (int trial = 0; trial < 150; ++trial) {
        Diagnostics d;
        TextureSystem maps(d);
        const Handle h = maps.open(s / "map.tif");
        if (!h) EXPECT_GE(d.errors(), 1);
        read += h != nullptr;
    }
    stop = true;
    writer.join();
    RecordProperty("read", read);
}

TEST(Damage, TwoProcessesThatMakeOneMap) {
    Scratch s;
    save(s, "a.tif", constant(64, 64, 64 / 255.f));
    save(s, "b.tif", constant(64, 64, 192 / 255.f));
    const auto make = [&](const char* picture) {
        Diagnostics d;
        MakeOptions o;
        o.searchPath = {s.dir.string()};
        o.policy = s.policy();
        bool good = true;
        for (int k = 0; k < 12; ++k) good = makeTexture(picture, "map.tex", o, d) && good;
        return good;
    };
    ASSERT_TRUE(make("a.tif"));
    pid_t children[2];
    for (int k = 0; k < 2; ++k)
        if ((children[k] = fork()) == 0) _exit(make(k ? "b.tif" : "a.tif") ? 0 : 1);
    for (int trial = 0; trial < 60; ++trial) {
        Diagnostics d;
        TextureSystem maps(d);
        const Handle h = maps.open(s / "map.tex");
        ASSERT_TRUE(h) << messages(d);
        float v[3] = {};
        lookup2D(h, 0, 3, .5f, .5f, 0, 0, 0, 0, {}, v);
        EXPECT_TRUE(v[0] == 64 / 255.f || v[0] == 192 / 255.f) << v[0];
        EXPECT_TRUE(v[0] == v[1] && v[1] == v[2]);
    }
    for (const pid_t child : children) {
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(WEXITSTATUS(status), 0);
    }
    EXPECT_EQ(s.files(), 3u); // and no other file is left
}

} // namespace damage_test
