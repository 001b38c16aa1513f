// Requests read from text, and whether two are equal: what the tests of the writer share.
#pragma once
#include "ri/parser.h"
#include "ri/requests/request.h"
#include <gtest/gtest.h>

namespace alpenglow::ri {

/// The calls of a stream; `said`: what there is to say about it.
inline std::vector<Call> callsOf(std::string_view text, std::string* said = nullptr) {
    Diagnostics d;
    Reporter reporter(d);
    Parser parser(inflating(memorySource(text)), "calls.rib", reporter);
    std::vector<Call> calls;
    for (Call c; parser.next(c);) calls.push_back(c);
    if (said)
        for (const Diagnostic& m : d.all()) *said += toString(m) + "\n";
    return calls;
}

/// asFloats: numbers of parameter lists may differ where their floats are the same.
inline void expectSame(const Call& a, const Call& b, bool asFloats, const std::string& what) {
    ASSERT_EQ(a.request, b.request) << what;
    ASSERT_EQ(a.arguments.size(), b.arguments.size()) << what;
    for (size_t i = 0; i < a.arguments.size(); ++i) {
        EXPECT_EQ(a.arguments[i].given, b.arguments[i].given) << what;
        EXPECT_EQ(a.arguments[i].numbers, b.arguments[i].numbers) << what;
        EXPECT_EQ(a.arguments[i].strings, b.arguments[i].strings) << what;
    }
    ASSERT_EQ(a.params.size(), b.params.size()) << what;
    for (size_t i = 0; i < a.params.size(); ++i) {
        const Value &x = a.params[i].value, &y = b.params[i].value;
        EXPECT_EQ(a.params[i].token, b.params[i].token) << what;
        EXPECT_EQ(x.kind, y.kind) << what;
        EXPECT_EQ(x.array, y.array) << what;
        EXPECT_EQ(x.strings, y.strings) << what;
        ASSERT_EQ(x.numbers.size(), y.numbers.size()) << what;
        for (size_t k = 0; k < x.numbers.size(); ++k) {
            if (asFloats) EXPECT_EQ(toFloat(x.numbers[k]), toFloat(y.numbers[k])) << what;
            else EXPECT_EQ(x.numbers[k], y.numbers[k]) << what;
        }
    }
}

} // namespace alpenglow::ri
