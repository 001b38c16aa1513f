// Deep shadow maps: staircases, files of them, and files that are damaged.
#include "base/limits.h"
#include "support.h"
#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepTiledOutputFile.h>
#include <ImfHeader.h>
#include <ImfPartType.h>
#include <cmath>
#include <random>

namespace deep_test {

using namespace alpenglow;
using namespace alpenglow::display;
using namespace alpenglow::display::test;

namespace {

DeepChange change(float z, float before, float after) { return {z, {before, before, before}, {after, after, after}}; }

/// 7 x 5 pixels with 0 to 5 steps, coloured.
Image deepPicture() {
    Image m = makeImage(7, 5, {"z"});
    auto deep = std::make_shared<DeepSamples>();
    std::mt19937 random(3);
    for (int i = 0; i < 35; ++i) {
        deep->first.push_back(deep->steps.size());
        DeepStep s;
        for (int k = 0; k < i % 6; ++k) {
            s.z += 1 + float(random() % 8) / 8;
            for (float& l : s.transmittance) l *= float(random() % 65) / 64;
            deep->steps.push_back(s);
        }
        if (i % 6) m.data[size_t(i)] = deep->steps[size_t(deep->first.back())].z;
    }
    deep->first.push_back(deep->steps.size());
    m.deep = deep;
    m.worldToCamera = Matrix();
    m.worldToNDC = screenToNDC();
    m.metadata["textureformat"] = "Shadow";
    return m;
}

std::vector<uint8_t> fileOf(const Image& m) {
    Scratch s;
    Diagnostics d;
    WriteOptions o;
    o.policy = s.policy();
    EXPECT_TRUE(writeImage("map.dsm", m, o, d)) << messages(d);
    return bytesOf(s / "map.dsm");
}

TEST(Deep, LightIsTakenBehindASurface) {
    DeepSamples d;
    d.first = {0, 2, 2};
    d.steps = {{2, {.5f, 1, 0}}, {3, {.25f, .5f, 0}}};
    const auto left = [&](size_t pixel, double z) {
        double out[3];
        d.transmittanceAt(pixel, z, out);
        return std::array{out[0], out[1], out[2]};
    };
    const std::array none{1., 1., 1.}, first{.5, 1., 0.}, both{.25, .5, 0.};
    EXPECT_EQ(left(0, -1), none);
    EXPECT_EQ(left(0, 2), none) << "on the surface itself";
    EXPECT_EQ(left(0, 2.001), first);
    EXPECT_EQ(left(0, 3), first);
    EXPECT_EQ(left(0, 1e30), both);
    EXPECT_EQ(left(1, 1e30), none);
}

TEST(Deep, TheMeanOfStaircases) {
    // Four rays: one meets nothing, one a pane at 1, one the pane and a wall at 2, one the wall.
    std::vector<DeepChange> all{change(2, .5f, 0), change(1, 1, .5f), change(2, 1, 0), change(1, 1, .5f)};
    std::vector<DeepStep> out{{9, {.1f, .1f, .1f}}}; // of another pixel
    meanStairs(all, 4, 0, out);
    ASSERT_EQ(out.size(), 3u);
    EXPECT_EQ(out[1].z, 1);
    EXPECT_EQ(out[1].transmittance[0], .75f); // 1 .5 .5 1
    EXPECT_EQ(out[2].z, 2);
    EXPECT_EQ(out[2].transmittance[1], .375f); // 1 .5 0 0
}

TEST(Deep, NoStepIsFartherOffThanAsked) {
    // A thousand hairs, each of which takes a thousandth.
    std::vector<DeepChange> all;
    for (int i = 0; i < 1000; ++i) all.push_back(change(float((i * 7) % 1000), 1, 0));
    for (const float error : {0.f, .01f, .1f}) {
        DeepSamples d;
        std::vector<DeepChange> copy = all;
        meanStairs(copy, 1000, error, d.steps);
        d.first = {0, d.steps.size()};
        EXPECT_EQ(d.steps.back().transmittance[0], 0);
        EXPECT_LE(double(d.steps.size()), error > 0 ? 1 / error + 1 : 1000);
        for (int z = 0; z <= 1000; ++z) {
            double left[3];
            d.transmittanceAt(0, z, left);
            EXPECT_NEAR(left[0], 1 - z / 1000., error + 1e-6) << z;
        }
    }
}

TEST(Deep, FilesGiveBackWhatWasWritten) {
    const Image m = deepPicture();
    Diagnostics d;
    const auto r = decodeImage(fileOf(m), "map.dsm", d);
    ASSERT_TRUE(r && r->deep) << messages(d);
    EXPECT_EQ(d.all().size(), 0u);
    EXPECT_EQ(r->metadata.at("textureformat"), "Shadow");
    EXPECT_TRUE(r->worldToCamera && r->worldToNDC);
    ASSERT_EQ(r->deep->first, m.deep->first);
    for (size_t i = 0; i < m.deep->steps.size(); ++i) {
        EXPECT_EQ(r->deep->steps[i].z, m.deep->steps[i].z);
        for (int k = 0; k < 3; ++k) // quotients and products of singles
            EXPECT_NEAR(r->deep->steps[i].transmittance[k], m.deep->steps[i].transmittance[k], 4e-7);
    }
    EXPECT_EQ(r->channels, std::vector<std::string>{"z"});
    EXPECT_EQ(r->pixel(2, 0)[0], m.pixel(2, 0)[0]);
    EXPECT_GT(r->pixel(0, 0)[0], 1e37f) << "nothing there";
}

TEST(Deep, WhatIsTooLargeOrDoesNotFitIsNotWritten) {
    for (const uint64_t steps : {uint64_t(limits::kDeepSteps) + 1, uint64_t(1)})
        for (const size_t pixels : {size_t(1), size_t(2)}) {
            Image m = makeImage(1, 1, {"z"});
            auto deep = std::make_shared<DeepSamples>();
            deep->first.assign(pixels, 0);
            deep->first.push_back(steps); // of which none is there
            m.deep = deep;
            Scratch s;
            Diagnostics d;
            WriteOptions o;
            o.policy = s.policy();
            EXPECT_FALSE(writeImage("map.dsm", m, o, d));
            EXPECT_NE(messages(d).find(pixels == 1 && steps > 1 ? std::to_string(limits::kDeepSteps) : "match"),
                      std::string::npos);
            EXPECT_EQ(s.files(), 0u);
        }
}

/// The same picture in tiles of 4 x 2 pixels, as other programs write it.
std::vector<uint8_t> tiledFileOf(const Image& m) {
    Scratch s;
    const std::string name = s / "tiles.exr";
    {
        Imf::Header h(m.width, m.height);
        h.setType(Imf::DEEPTILE);
        h.setTileDescription(Imf::TileDescription(4, 2, Imf::ONE_LEVEL));
        h.compression() = Imf::ZIPS_COMPRESSION;
        const char* names[] = {"Z", "RA", "GA", "BA"};
        for (const char* n : names) h.channels().insert(n, Imf::Channel(Imf::FLOAT));
        Imf::DeepTiledOutputFile file(name.c_str(), h);
        const size_t pixels = size_t(m.width * m.height);
        std::vector<unsigned> count(pixels);
        std::vector<std::vector<float>> values[4];
        std::vector<float*> at[4];
        for (size_t c = 0; c < 4; ++c) values[c].resize(pixels), at[c].resize(pixels);
        for (size_t p = 0; p < pixels; ++p) {
            count[p] = unsigned(m.deep->first[p + 1] - m.deep->first[p]);
            float left[3] = {1, 1, 1};
            for (size_t i = m.deep->first[p]; i < m.deep->first[p + 1]; ++i) {
                values[0][p].push_back(m.deep->steps[i].z);
                for (size_t c = 0; c < 3; ++c) {
                    values[c + 1][p].push_back(left[c] > 0 ? 1 - m.deep->steps[i].transmittance[c] / left[c] : 0);
                    left[c] = m.deep->steps[i].transmittance[c];
                }
            }
            for (size_t c = 0; c < 4; ++c) at[c][p] = values[c][p].data();
        }
        Imf::DeepFrameBuffer fb;
        fb.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(count.data()), 4, 4 * size_t(m.width)));
        for (size_t c = 0; c < 4; ++c)
            fb.insert(names[c], Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(at[c].data()), sizeof(float*),
                                               sizeof(float*) * size_t(m.width), sizeof(float)));
        file.setFrameBuffer(fb);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    }
    return bytesOf(s / "tiles.exr");
}

TEST(Deep, TilesAreReadAsLinesAre) {
    const Image m = deepPicture();
    const std::vector<uint8_t> file = tiledFileOf(m);
    Diagnostics d;
    const auto r = decodeImage(file, "tiles", d);
    ASSERT_TRUE(r && r->deep) << messages(d);
    ASSERT_EQ(r->deep->first, m.deep->first);
    for (size_t i = 0; i < m.deep->steps.size(); ++i) {
        EXPECT_EQ(r->deep->steps[i].z, m.deep->steps[i].z);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(r->deep->steps[i].transmittance[k], m.deep->steps[i].transmittance[k], 1e-5);
    }
    for (size_t n = 0; n < file.size(); n += 16) {
        Diagnostics said;
        EXPECT_TRUE(decodeImage({file.data(), n}, "cut", said) || said.errors()) << n;
    }
    std::mt19937 random(5);
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<uint8_t> b = file;
        for (int i = 0; i < 1 + trial % 5; ++i)
            b[random() % b.size()] = trial % 3 ? uint8_t(random()) : uint8_t(random() % 2 ? 255 : 0);
        Diagnostics said;
        EXPECT_TRUE(decodeImage(b, "damaged", said) || said.errors());
    }
}

TEST(Deep, CutAndDamagedFilesAreRefusedOrRead) {
    const std::vector<uint8_t> file = fileOf(deepPicture());
    size_t refused = 0;
    for (size_t n = 0; n < file.size(); ++n) {
        Diagnostics d;
        const auto r = decodeImage({file.data(), n}, "cut", d);
        EXPECT_TRUE(r || d.errors()) << n;
        refused += !r;
    }
    EXPECT_GT(refused, file.size() * 9 / 10);
    std::mt19937 random(11);
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<uint8_t> b = file;
        for (int i = 0; i < 1 + trial % 5; ++i)
            b[random() % b.size()] = trial % 3 ? uint8_t(random()) : uint8_t(random() % 2 ? 255 : 0);
        Diagnostics d;
        const auto r = decodeImage(b, "damaged", d);
        EXPECT_TRUE(r || d.errors());
        if (!r || !r->deep) continue;
        ASSERT_EQ(r->deep->first.size(), r->data.size() + 1);
        for (size_t i = 1; i < r->deep->steps.size(); ++i)
            for (const float l : r->deep->steps[i].transmittance) EXPECT_TRUE(l >= 0 && l <= 1);
    }
}

} // namespace

} // namespace deep_test
