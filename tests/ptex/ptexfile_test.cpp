// Ptex files: written and read, by the bytes that the specification says, cut short and damaged.
#include "../nightly.h"
#include "ptex/ball.h"
#include "ptex/numbers.h"
#include <random>

namespace ptexfile_test {

namespace {

using namespace alpenglow;
using namespace alpenglow::ptex;
using alpenglow::ptex::test::Ptex;

std::vector<Image> noise(Head& head, int faces, uint32_t seed, const std::function<std::pair<int, int>(int)>& logs) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> byte(0, 255);
    std::vector<Image> all;
    head.faces.resize(size_t(faces));
    for (int f = 0; f < faces; ++f) {
        const auto [u, v] = logs(f);
        head.faces[size_t(f)].ulog = uint8_t(u);
        head.faces[size_t(f)].vlog = uint8_t(v);
        Image m{1 << u, 1 << v, {}};
        for (int i = 0; i < m.u * m.v * head.channels; ++i) m.values.push_back(float(byte(random)) / 255);
        all.push_back(std::move(m));
    }
    return all;
}

TEST_F(Ptex, WhatIsWrittenIsRead) {
    for (const Number number : {Number::Byte, Number::Word, Number::Half, Number::Float})
        for (const int channels : {1, 3, 5}) {
            Head head;
            head.number = number;
            head.channels = channels;
            head.metas = {{"small", 0, {'h', 'i', 0}}, {"large", 3, std::vector<uint8_t>(5000, 7)}};
            auto images = noise(head, 12, 3, [](int f) { return std::pair(f % 8, f % 3 + 2); });
            std::fill(images[5].values.begin(), images[5].values.end(), .4f); // constant
            ASSERT_TRUE(writeTexture(path("a.ptx"), head, images, policy(), d));
            const auto t = open("a.ptx");
            ASSERT_TRUE(t);
            EXPECT_EQ(t->head().channels, channels);
            EXPECT_TRUE(t->head().faces[5].constant);
            ASSERT_EQ(t->head().metas.size(), 2u);
            EXPECT_EQ(t->head().metas[0].key, "small");
            EXPECT_EQ(t->head().metas[1].bytes.size(), 5000u);
            const double near = number == Number::Byte   ? 1.0 / 500
                                : number == Number::Word ? 1e-5
                                : number == Number::Half ? 3e-4
                                                         : 1e-7;
            for (uint32_t f = 0; f < 12; ++f) {
                const auto m = t->image(f, 0);
                if (f == 5) {
                    EXPECT_EQ(m->values.size(), size_t(channels));
                    EXPECT_NEAR(m->values[0], .4, near);
                    continue;
                }
                ASSERT_EQ(m->values.size(), images[f].values.size());
                for (size_t i = 0; i < m->values.size(); ++i) ASSERT_NEAR(m->values[i], images[f].values[i], near);
                // Coarser levels are means: of the file's where it has some, else made when they are read.
                Image half = images[f];
                for (int k = 1; k < 8; ++k) {
                    half = halved(half, channels, Mesh::Quad);
                    const auto got = t->image(f, k);
                    ASSERT_EQ(got->values.size(), half.values.size()) << f << " " << k;
                    for (size_t i = 0; i < half.values.size(); ++i)
                        ASSERT_NEAR(got->values[i], half.values[i], 4 * near + 1e-6) << f << " " << k;
                }
            }
        }
    EXPECT_EQ(d.errors(), 0u);
}

TEST_F(Ptex, LargeFacesAreTiledAndAlphaIsMultiplied) {
    Head head;
    head.number = Number::Byte;
    head.channels = 4;
    head.alpha = 3;
    const auto images = noise(head, 2, 5, [](int f) { return f ? std::pair(8, 8) : std::pair(9, 7); }); // 256 KiB each
    ASSERT_TRUE(writeTexture(path("a.ptx"), head, images, policy(), d));
    const auto t = open("a.ptx");
    ASSERT_TRUE(t);
    for (uint32_t f = 0; f < 2; ++f) {
        const auto m = t->image(f, 0);
        ASSERT_EQ(m->u, images[f].u);
        for (size_t i = 0; i < m->values.size(); i += 4) {
            ASSERT_NEAR(m->values[i + 1], images[f].values[i + 1] * images[f].values[i + 3], 1e-5);
            ASSERT_NEAR(m->values[i + 3], images[f].values[i + 3], 1e-6);
        }
        const auto coarse = t->image(f, 1);
        EXPECT_NEAR(coarse->values[0],
                    (m->values[0] + m->values[4] + m->values[size_t(m->u) * 4] + m->values[size_t(m->u) * 4 + 4]) / 4, 1 / 250.0);
    }
}

/// Drops what a file has of coarser levels.
void keepFirstLevel(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::vector<uint8_t> b{std::istreambuf_iterator<char>(in), {}};
    const auto change = [&](size_t at, std::vector<uint8_t> to) { std::copy(to.begin(), to.end(), b.begin() + long(at)); };
    std::vector<uint8_t> size;
    const uint32_t infos = 64 + take<uint32_t>(&b[28]) + take<uint32_t>(&b[32]) + take<uint32_t>(&b[36]);
    const uint32_t infoSize = take<uint32_t>(&b[40]);
    const uint64_t first = take<uint64_t>(&b[infos]), all = take<uint64_t>(&b[48]);
    put(size, first);
    b.erase(b.begin() + long(infos + infoSize + first), b.begin() + long(infos + infoSize + all));
    b.erase(b.begin() + long(infos + 16), b.begin() + long(infos + infoSize));
    change(22, {1, 0});
    change(40, {16, 0, 0, 0});
    change(48, size);
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(b.data()), long(b.size()));
}

// What is larger than 2^20 numbers is looked at tile by tile: the same pixels, the same means where the file has none, the same
// lookups.
TEST_F(Ptex, VeryLargeFacesAreReadByTiles) {
    for (const Mesh mesh : {Mesh::Quad, Mesh::Triangle}) {
        Head head;
        head.mesh = mesh;
        head.channels = 2;
        head.alpha = 1;
        const bool quad = mesh == Mesh::Quad;
        const auto images = noise(head, 1, 8, [&](int) { return quad ? std::pair(10, 9) : std::pair(9, 9); });
        ASSERT_TRUE(writeTexture(path("a.ptx"), head, images, policy(), d));
        keepFirstLevel(path("a.ptx"));
        const Image& m = images[0];
        const auto want = [&](int i, int j) {
            const size_t at = 2 * (size_t(j) * size_t(m.u) + size_t(i));
            return m.values[at] * m.values[at + 1];
        };
        ASSERT_FALSE(open("a.ptx")->tiles(0, 0)); // 2^20 or fewer: whole
        Head wide = head;
        wide.channels = 8; // the same four times
        Image often{m.u, m.v, {}};
        for (size_t i = 0; i < m.values.size(); i += 2)
            for (size_t k = 0; k < 8; ++k) often.values.push_back(m.values[i + k % 2]);
        ASSERT_TRUE(writeTexture(path("b.ptx"), wide, {often}, policy(), d));
        keepFirstLevel(path("b.ptx"));
        const auto whole = open("a.ptx"), cut = open("b.ptx");
        ASSERT_TRUE(whole && cut);
        const auto t = cut->tiles(0, 0);
        ASSERT_TRUE(t);
        ASSERT_GT(t->at.size(), 1u);
        for (const auto& [i, j] : {std::pair(0, 0), {m.u - 1, m.v - 1}, {300, 150}, {m.u / 2, m.v / 2 - 1}}) {
            const auto piece = cut->tile(0, 0, *t, t->numberOf(i, j));
            EXPECT_LT(piece->values.size(), 1u << 18);
            EXPECT_NEAR(piece->values[8 * t->within(i, j)], want(i, j), 1e-6) << i << " " << j;
        }
        const auto coarse = whole->image(0, 1), made = cut->image(0, 1);
        ASSERT_EQ(made->values.size(), 4 * coarse->values.size());
        for (size_t i = 0; i < coarse->values.size(); i += 2) ASSERT_EQ(made->values[4 * i], coarse->values[i]) << i;
        for (const float width : {0.f, .002f, .02f})
            for (const auto& [u, v] : {std::pair(.1f, .2f), {.125f, .25f}, {.4999f, .5001f}, {0.f, .9f}}) {
                float a = 1, b = 2;
                EXPECT_TRUE(lookup(*whole, {0, u, v, width, width, 0, 1}, &a) && lookup(*cut, {0, u, v, width, width, 0, 1}, &b));
                EXPECT_EQ(a, b) << u << " " << v << " " << width;
            }
    }
    EXPECT_EQ(d.errors(), 0u);
}

// Bytes at the places that the specification names.
TEST_F(Ptex, TheHeaderIsThatOfTheSpecification) {
    Head head;
    head.number = Number::Half;
    head.channels = 2;
    head.uBorder = Border::Periodic;
    const auto images = noise(head, 3, 1, [](int) { return std::pair(4, 3); });
    head.faces[1].adjacent = {2, -1, 0, -1};
    head.faces[1].edge = {1, 2, 3, 0};
    ASSERT_TRUE(writeTexture(path("a.ptx"), head, images, policy(), d));
    const std::string b = bytes("a.ptx");
    const auto* u = reinterpret_cast<const uint8_t*>(b.data());
    EXPECT_EQ(b.substr(0, 4), "Ptex");
    EXPECT_EQ(take<uint32_t>(u + 4), 1u);           // version
    EXPECT_EQ(take<uint32_t>(u + 8), 1u);           // quads
    EXPECT_EQ(take<uint32_t>(u + 12), 2u);          // float16
    EXPECT_EQ(take<uint32_t>(u + 16), 0xffffffffu); // no alpha
    EXPECT_EQ(take<uint16_t>(u + 20), 2);           // channels
    EXPECT_EQ(take<uint16_t>(u + 22), 2);           // levels: 16 x 8, 8 x 4
    EXPECT_EQ(take<uint32_t>(u + 24), 3u);          // faces
    const uint32_t ext = take<uint32_t>(u + 28), info = take<uint32_t>(u + 32);
    EXPECT_EQ(ext, 40u);
    EXPECT_EQ(take<uint32_t>(u + 64), 2u); // periodic along u
    EXPECT_EQ(take<uint32_t>(u + 68), 0u);
    std::vector<uint8_t> faces;
    ASSERT_TRUE(inflated({u + 64 + ext, info}, 60, faces));
    EXPECT_EQ(faces[20], 4);
    EXPECT_EQ(faces[21], 3);
    EXPECT_EQ(faces[22], 1 | 2 << 2 | 3 << 4);
    EXPECT_EQ(take<uint32_t>(&faces[24]), 2u);
    EXPECT_EQ(take<uint32_t>(&faces[28]), 0xffffffffu);
    const uint64_t levels = take<uint64_t>(u + 48);
    EXPECT_EQ(64 + ext + info + take<uint32_t>(u + 36) + take<uint32_t>(u + 40) + levels + take<uint32_t>(u + 56) + 8, b.size())
        << "the barrier ends it";
}

// An edit at the end of the file replaces a face, and the levels that were made of it.
TEST_F(Ptex, EditsReplaceFaces) {
    Head head;
    head.number = Number::Float;
    head.channels = 1;
    const auto images = noise(head, 4, 9, [](int) { return std::pair(3, 3); });
    ASSERT_TRUE(writeTexture(path("a.ptx"), head, images, policy(), d));
    std::string b = bytes("a.ptx");
    std::vector<uint8_t> raw, edit;
    for (int i = 0; i < 64; ++i) fromFloat(Number::Float, i < 32 ? 2.f : 4.f, raw);
    const auto zip = deflated(raw);
    ptex::put(edit, uint32_t(2));
    edit.insert(edit.end(), {3, 3, 0, 0});
    for (int k = 0; k < 4; ++k) ptex::put(edit, uint32_t(-1));
    ptex::put(edit, uint32_t(zip.size()) | 1u << 30);
    fromFloat(Number::Float, 3, edit);
    edit.insert(edit.end(), zip.begin(), zip.end());
    const uint64_t at = b.size();
    std::vector<uint8_t> block = {1};
    ptex::put(block, uint32_t(edit.size()));
    block.insert(block.end(), edit.begin(), edit.end());
    b.append(reinterpret_cast<const char*>(block.data()), block.size());
    for (int k = 0; k < 8; ++k) {
        b[size_t(64 + 24 + k)] = char(uint64_t(block.size()) >> (8 * k));
        b[size_t(64 + 32 + k)] = char(at >> (8 * k));
    }
    put("b.ptx", b);
    const auto t = open("b.ptx");
    ASSERT_TRUE(t);
    EXPECT_EQ(t->image(2, 0)->values[0], 2);
    EXPECT_EQ(t->image(2, 0)->values[63], 4);
    EXPECT_EQ(t->image(2, 1)->values[0], 2);
    EXPECT_EQ(t->image(2, 3)->values[0], 3);
    EXPECT_EQ(t->image(1, 0)->values, images[1].values);
}

/// Opens, reads every face, looks up everywhere: whatever the bytes are.
void use(const std::string& path) {
    Diagnostics d;
    const auto t = openTexture(path, makeCache(1 << 20), d);
    if (!t) {
        EXPECT_GT(d.errors(), 0u);
        return;
    }
    const uint32_t faces = uint32_t(std::min<size_t>(t->head().faces.size(), 64));
    for (uint32_t f = 0; f < faces; ++f) {
        for (int k = 0; k < 3; ++k) t->image(f, k);
        float out[3];
        for (const float w : {0.f, .3f})
            for (const float u : {0.f, .5f, 1.f}) {
                lookup(*t, {f, u, 1 - u, w, w}, out);
                for (const float v : out) EXPECT_TRUE(std::isfinite(v));
            }
    }
}

/// `tiled`: one face is so large that it is cut.
void sample(bool tiled, const std::function<void(Head&, std::vector<Image>&)>& write) {
    Head head;
    head.number = Number::Byte;
    auto images = noise(head, 24, 2, [tiled](int f) { return f == 3 && tiled ? std::pair(8, 8) : std::pair(f % 5, f % 4); });
    for (size_t f = 0; f < 24; ++f) {
        head.faces[f].adjacent = {int32_t((f + 1) % 24), int32_t((f + 5) % 24), -1, int32_t((f + 23) % 24)};
        head.faces[f].edge = {uint8_t(f % 4), 1, 0, 3};
        head.faces[f].subface = f % 7 == 0;
    }
    head.metas = {{"note", 0, std::vector<uint8_t>(2000, 'x')}, {"small", 0, {0}}};
    write(head, images);
}

TEST_F(Ptex, CutShortAtEvery64thByte) {
    sample(false, [&](Head& h, std::vector<Image>& m) { ASSERT_TRUE(writeTexture(path("a.ptx"), h, m, policy(), d)); });
    const std::string b = bytes("a.ptx");
    for (size_t n = 0; n < b.size(); n += 64) {
        put("cut.ptx", b.substr(0, n));
        use(path("cut.ptx"));
    }
}

TEST_F(Ptex, Damaged) { // 2,000 times nightly
    sample(true, [&](Head& h, std::vector<Image>& m) { ASSERT_TRUE(writeTexture(path("a.ptx"), h, m, policy(), d)); });
    const std::string b = bytes("a.ptx");
    std::mt19937 random(11);
    for (int n = 0; n < (nightly() ? 2000 : 500); ++n) {
        std::string c = b;
        // Half of them in the header and what follows it, where sizes lie.
        const size_t range = n % 2 ? c.size() : std::min<size_t>(c.size(), 400);
        for (int k = 0; k < 1 + n % 3; ++k) c[random() % range] = n % 5 ? char(random()) : char(n % 10 < 5 ? 0xff : 0);
        put("bad.ptx", c);
        use(path("bad.ptx"));
    }
}

TEST_F(Ptex, PromisesThatNoFileKeeps) {
    put("none.ptx", "");
    put("text.ptx",
        "Ptex is a fine format, but this is a text file, and it is long enough to have a header of 64 bytes and more.");
    for (const char* name : {"none.ptx", "text.ptx", "missing.ptx"}) {
        Diagnostics said;
        EXPECT_FALSE(openTexture(path(name), makeCache(1000), said));
        EXPECT_EQ(said.errors(), 1u) << name;
    }
}

// A thousand bytes that stand for gigabytes of faces.
TEST_F(Ptex, ManyFacesAreRefusedBeforeMemoryIsTaken) {
    Head head;
    head.number = Number::Float;
    head.channels = 1;
    const auto images = noise(head, 1, 3, [](int) { return std::pair(1, 1); });
    ASSERT_TRUE(writeTexture(path("a.ptx"), head, images, policy(), d));
    std::string b = bytes("a.ptx");
    const auto set = [&](size_t at, uint32_t v, size_t n) {
        for (size_t k = 0; k < n; ++k) b[at + k] = char(v >> (8 * k));
    };
    set(20, 64, 2);         // channels
    set(24, 40'000'000, 4); // faces: with their means 12 GiB
    put("b.ptx", b);
    Diagnostics said;
    EXPECT_FALSE(openTexture(path("b.ptx"), makeCache(1000), said));
    ASSERT_EQ(said.all().size(), 1u);
    EXPECT_NE(said.all()[0].message.find("its face data is too large"), std::string::npos) << said.all()[0].message;
}

TEST_F(Ptex, MetaDataAreReadInTimeThatGrowsWithThem) {
    Head head;
    head.number = Number::Float;
    head.channels = 1;
    const auto images = noise(head, 1, 3, [](int) { return std::pair(1, 1); });
    const auto metas = [&](int n) {
        head.metas.clear();
        for (int i = 0; i < n; ++i) head.metas.push_back({std::to_string(i), 0, {}});
    };
    metas(50'000);
    head.metas.push_back({"7", 0, {1}});
    ASSERT_TRUE(writeTexture(path("a.ptx"), head, images, policy(), d));
    const auto t = open("a.ptx");
    ASSERT_TRUE(t);
    ASSERT_EQ(t->head().metas.size(), 50'000u); // the later of one key holds
    EXPECT_EQ(t->head().metas[7].bytes, std::vector<uint8_t>{1});
    metas(1'000'001);
    ASSERT_TRUE(writeTexture(path("b.ptx"), head, images, policy(), d));
    Diagnostics said;
    EXPECT_FALSE(openTexture(path("b.ptx"), makeCache(1000), said));
    EXPECT_EQ(said.errors(), 1u);
}

// Of all parts of the cache together no more is kept than it may have, or one face.
TEST_F(Ptex, WhatIsKeptIsBounded) {
    Head head;
    head.number = Number::Byte;
    head.channels = 1;
    const auto images = noise(head, 40, 3, [](int) { return std::pair(6, 6); });
    ASSERT_TRUE(writeTexture(path("a.ptx"), head, images, policy(), d));
    const auto t = openTexture(path("a.ptx"), makeCache(30'000), d); // a face has 16,384 bytes and a few
    ASSERT_TRUE(t);
    std::vector<std::weak_ptr<const Image>> seen;
    for (uint32_t f = 0; f < 40; ++f) {
        seen.push_back(t->image(f, 0));
        EXPECT_LE(std::count_if(seen.begin(), seen.end(), [](const auto& w) { return !w.expired(); }), 1) << f;
    }
}

TEST_F(Ptex, NumbersThatAreNoneAreNothing) {
    Head head;
    head.number = Number::Float;
    head.channels = 2;
    head.alpha = 1;
    head.faces.resize(2);
    const std::vector<Image> images = {{1, 1, {INFINITY, 1}}, {1, 1, {3e38f, 3e38f}}}; // the product is beyond all numbers
    ASSERT_TRUE(writeTexture(path("a.ptx"), head, images, policy(), d));
    const auto t = open("a.ptx");
    ASSERT_TRUE(t);
    for (const uint32_t f : {0u, 1u}) EXPECT_EQ(t->image(f, 0)->values[0], 0) << f;
}

} // namespace

} // namespace ptexfile_test
