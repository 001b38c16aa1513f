// Memory in large pages is memory as any other.
#include "../sanitized.h"
#include "base/largepages.h"
#include <algorithm>
#include <cstdint>
#include <gtest/gtest.h>
#include <new>
#include <vector>

namespace largepages_test {

using namespace alpenglow;

TEST(LargePages, AnyRangeMayBeAdvised) { // it is a wish: odd ranges and none at all change nothing
    std::vector<char> v(5'000'000, 'a');
    adviseLargePages(v.data() + 1, v.size() - 7);
    adviseLargePages(nullptr, 0);
    adviseLargePages(v.data() + 4097, 1);
    EXPECT_EQ(std::count(v.begin(), v.end(), 'a'), 5'000'000);
}

TEST(LargePages, NewStillThrowsAndAsksItsHandler) {
    if (kSanitized) GTEST_SKIP() << "the sanitizer's operator new takes the place of ours";
    static int asked;
    asked = 0;
    const std::new_handler before = std::set_new_handler([] {
        if (++asked == 2) std::set_new_handler(nullptr);
    });
    void* volatile room = nullptr;
    EXPECT_THROW(room = ::operator new(size_t(1) << 60), std::bad_alloc);
    std::set_new_handler(before);
    EXPECT_EQ(asked, 2);
    EXPECT_EQ(room, nullptr);
    EXPECT_THROW(room = ::operator new(size_t(1) << 60, std::align_val_t(128)), std::bad_alloc);
    for (const size_t bytes : {size_t(0), size_t(1), (size_t(2) << 20) + 5}) {
        char* p = static_cast<char*>(::operator new(bytes));
        char* aligned = static_cast<char*>(::operator new(bytes, std::align_val_t(128)));
        EXPECT_EQ(reinterpret_cast<uintptr_t>(aligned) % 128, 0u);
        for (char* at : {p, aligned}) {
            ASSERT_NE(at, nullptr);
            std::fill_n(at, bytes, 'b');
            EXPECT_EQ(size_t(std::count(at, at + bytes, 'b')), bytes);
        }
        ::operator delete(p);
        ::operator delete(aligned, std::align_val_t(128));
    }
}

} // namespace largepages_test
