#include "base/digest.h"
#include <gtest/gtest.h>

namespace alpenglow {
namespace {

// What xxhsum -H3 prints of the same bytes.
TEST(Digest, IsXxh3) {
    EXPECT_EQ(digest(""), 0x2d06800538d394c2u);
    EXPECT_EQ(digest("abc"), 0x78af5f94892f3950u);
    std::string bytes; // of the test buffer of xxHash
    for (uint64_t b = 2654435761u; bytes.size() < 2367; b *= 11400714785074694797u) bytes += char(b >> 56);
    EXPECT_EQ(digest(bytes.substr(0, 222)), 0xb9163b558664d356u);
    EXPECT_EQ(digest(bytes), 0xcb37aeb9e5d361edu);
}

TEST(Digest, PiecesAddUp) {
    std::string bytes;
    for (int i = 0; i < 3000; ++i) bytes += char(i * i >> 3);
    for (size_t piece : {1u, 7u, 64u, 255u, 1024u}) {
        Digest d;
        d.add(nullptr, 0);
        for (size_t at = 0; at < bytes.size(); at += piece) d.add(std::string_view(bytes).substr(at, piece));
        EXPECT_EQ(d.value(), digest(bytes)) << piece;
    }
}

TEST(Digest, CopiesGoOnAlone) {
    Digest a;
    a.add("one");
    Digest b = a;
    b.add("two");
    EXPECT_EQ(a.value(), digest("one"));
    EXPECT_EQ(b.value(), digest("onetwo"));
}

TEST(Digest, HasSixteenDigits) {
    EXPECT_EQ(digestText(0), "0000000000000000");
    EXPECT_EQ(digestText(0xFEDCBA9876543210ull), "fedcba9876543210");
}

} // namespace
} // namespace alpenglow
