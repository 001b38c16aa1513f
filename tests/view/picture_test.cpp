// What is sent of a picture, and what is made of its planes on the way.
#include "base/half.h"
#include "view/picture.h"
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

namespace picture_test {

using namespace alpenglow;
using namespace alpenglow::view;

namespace {

std::shared_ptr<display::Image> filled(int w, int h, std::vector<std::string> channels, float first) {
    auto i = std::make_shared<display::Image>(display::makeImage(w, h, std::move(channels)));
    for (size_t k = 0; k < i->data.size(); ++k) i->data[k] = first + float(k);
    return i;
}

float halfAt(const std::string& bytes, size_t n) {
    uint16_t h;
    std::memcpy(&h, bytes.data() + 2 * n, 2);
    return ofHalf(h);
}

TEST(Pixels, HaveFourHalvesEach) {
    Picture p;
    p.planes = {{"picture", filled(2, 1, {"r", "g", "b", "a", "z"}, 0)},
                {"z", filled(2, 1, {"z"}, 10)},
                {"N", filled(2, 1, {"N.x", "N.y", "N.z"}, 20)}};
    const std::string a = halves(p, p.planes[0], {}), z = halves(p, p.planes[1], {}), n = halves(p, p.planes[2], {});
    ASSERT_EQ(a.size(), 16u);
    const float wanted[] = {0, 1, 2, 3, 5, 6, 7, 8};
    for (size_t i = 0; i < 8; ++i) EXPECT_EQ(halfAt(a, i), wanted[i]);
    const float grey[] = {10, 10, 10, 1, 11, 11, 11, 1};
    for (size_t i = 0; i < 8; ++i) EXPECT_EQ(halfAt(z, i), grey[i]);
    const float three[] = {20, 21, 22, 1, 23, 24, 25, 1};
    for (size_t i = 0; i < 8; ++i) EXPECT_EQ(halfAt(n, i), three[i]);
}

TEST(Pixels, LightsAreDimmedByWhatTheyGive) {
    Picture p;
    p.planes = {{"picture", filled(1, 1, {"r", "g", "b", "a", "z"}, 10)},
                {"light:key", filled(1, 1, {"r", "g", "b"}, 1)},
                {"light:fill", filled(1, 1, {"r", "g", "b"}, 3)}};
    const std::string same = halves(p, p.planes[0], {{"key", 1}, {"nobody", 0}});
    EXPECT_EQ(halfAt(same, 0), 10);
    const std::string dim = halves(p, p.planes[0], {{"key", 0}, {"fill", 2}}); // 10 - 1 + 3, 11 - 2 + 4, 12 - 3 + 5
    EXPECT_EQ(halfAt(dim, 0), 12);
    EXPECT_EQ(halfAt(dim, 1), 13);
    EXPECT_EQ(halfAt(dim, 2), 14);
    EXPECT_EQ(halfAt(dim, 3), 13); // alpha stays
}

TEST(Pixels, WhatWasRenderedFirstLiesOverTheWhole) {
    Picture whole, crop;
    whole.width = crop.width = 4;
    whole.height = crop.height = 3;
    whole.window = {0, 0, 4, 3};
    crop.window = {1, 1, 3, 3};
    whole.planes = {{"picture", filled(4, 3, {"r"}, 0)}, {"noise", filled(4, 3, {"noise"}, 50)}};
    crop.planes = {{"picture", filled(2, 2, {"r"}, 100)}};
    const auto before = whole.planes[0].image;
    overlay(whole, crop);
    const float wanted[] = {0, 1, 2, 3, 4, 100, 101, 7, 8, 102, 103, 11};
    for (int i = 0; i < 12; ++i) EXPECT_EQ(whole.planes[0].image->data[size_t(i)], wanted[i]);
    EXPECT_EQ(whole.planes[1].image->data[5], 55); // the crop has none
    EXPECT_EQ(before->data[5], 5);                 // who looks at it meanwhile sees what it was
}

} // namespace

} // namespace picture_test
