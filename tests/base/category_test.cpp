// Category expressions: each answer is the definition's in base/category.h, counted by hand.
#include "base/category.h"
#include "base/limits.h"
#include <gtest/gtest.h>

namespace category_test {

using namespace alpenglow;

TEST(Category, Expressions) {
    const struct {
        const char* expression;
        const char* categories;
        bool in;
    } cases[] = {{"", "", true},
                 {"", "a", true},
                 {"  ", "a", true},
                 {"a", "a", true},
                 {"a", "b", false},
                 {"a", "", false},
                 {"a", "b,a", true},
                 {"a", "b, a ,c", true},
                 {"a", "ab", false},
                 {"-a", "a", false},
                 {"-a", "b", true},
                 {"-a", "", true},
                 {"!a", "a", false},
                 {"--a", "a", true},
                 {"a|b", "a", true},
                 {"a|b", "b", true},
                 {"a|b", "c", false},
                 {"a | b", "b", true},
                 {"a&b", "a", false},
                 {"a&b", "a,b", true},
                 {"a&-b", "a", true},
                 {"a&-b", "a,b", false},
                 {"a|b&c", "a", true},
                 {"a|b&c", "b", false},
                 {"(a|b)&c", "a", false},
                 {"(a|b)&c", "b,c", true},
                 {"-(a|b)", "c", true},
                 {"-(a|b)", "b", false},
                 {"a,b", "b", true},
                 {"a,b", "c", false},
                 {"a,-b", "a", true},
                 {"a,-b", "a,b", false},
                 {"-a,-b", "c", true},
                 {"-a,-b", "b", false},
                 {"a,-b", "c", false},
                 {"my-light", "my-light", true},
                 {"key light", "key light", true}};
    for (const auto& c : cases) {
        EXPECT_EQ(inCategory(c.expression, c.categories), c.in) << c.expression << " of " << c.categories;
        EXPECT_EQ(categoryError(c.expression), "") << c.expression;
    }
}

TEST(Category, WhatCannotBeReadMeansAll) {
    for (const std::string bad : {"a|", "&", "(a", "a)", "-", "a||b", ",", "()"}) {
        EXPECT_NE(categoryError(bad), "") << bad;
        EXPECT_TRUE(inCategory(bad, "x")) << bad;
    }
    EXPECT_NE(categoryError(std::string(100000, '(')), "");
    EXPECT_NE(categoryError(std::string(100000, '-') + "a"), "");
}

TEST(Category, NestingHasALimit) {
    auto nested = [](int deep) { return std::string(size_t(deep), '(') + "a" + std::string(size_t(deep), ')'); };
    EXPECT_EQ(categoryError(nested(limits::kCategoryDepth / 2)), "");
    EXPECT_TRUE(inCategory(nested(limits::kCategoryDepth / 2), "a"));
    EXPECT_FALSE(inCategory(nested(limits::kCategoryDepth / 2), "b"));
    EXPECT_NE(categoryError(nested(limits::kCategoryDepth + 1)).find("nested too deeply"), std::string::npos);
}

} // namespace category_test
