// Messages come out by their keys, whatever order they came in.
#include "rsl/printlog.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

namespace alpenglow::rsl::printlog_test {
namespace {

std::string textOf(std::FILE* f) {
    std::string s;
    std::rewind(f);
    for (int c; (c = std::fgetc(f)) != EOF;) s += char(c);
    return s;
}

TEST(PrintLog, SamplesThenRowsThenBounces) {
    std::FILE* f = std::tmpfile();
    ASSERT_NE(f, nullptr);
    {
        PrintLog log(f);
        const auto key = [](int64_t s, int y, int x, int b) {
            PrintKey k;
            k.sample = s;
            k.y = y;
            k.x = x;
            k.bounces = b;
            return k;
        };
        log.add(key(1, 0, 0, 0), "5");
        log.add(key(0, 1, 0, 0), "3");
        log.add(key(0, 0, 1, 1), "2");
        log.add(key(0, 0, 1, 0), "1a");
        log.add(key(0, 0, 1, 0), "1b");
        log.add(key(0, 1, 0, 0), "4");
        log.add(key(-1, 9, 9, 9), "0");
        log.flush();
        log.add(key(0, 0, 0, 0), "void");
        log.discard();
        log.add(key(0, 0, 0, 0), "last");
    }
    EXPECT_EQ(textOf(f), "01a1b2345last");
    std::fclose(f);
}

TEST(PrintLog, OrderHoldsBeyondItsMemory) {
    // Two thousand messages in a scrambled order, with room for some dozens: 7919 is coprime to 2000.
    std::FILE* f = std::tmpfile();
    ASSERT_NE(f, nullptr);
    std::string expected;
    for (int i = 0; i < 2000; ++i) expected += std::to_string(i) + "a " + std::to_string(i) + "b ";
    {
        PrintLog log(f, 16 << 10);
        for (int i = 0; i < 2000; ++i) {
            const int n = i * 7919 % 2000;
            PrintKey k;
            k.sample = n / 100;
            k.y = n / 10 % 10;
            k.place[0] = float(n % 10);
            log.add(k, std::to_string(n) + "a ");
            log.add(k, std::to_string(n) + "b ");
        }
    }
    EXPECT_EQ(textOf(f), expected);
    std::fclose(f);
}

TEST(PrintLog, LoopsThatPrintAreCut) {
    const size_t most = PrintLog::kOfOneCall;
    for (const size_t memory : {size_t(1) << 20, size_t(256) << 20}) { // goes to files in between, or not
        std::FILE* f = std::tmpfile();
        ASSERT_NE(f, nullptr);
        {
            PrintLog log(f, memory);
            PrintKey k;
            k.program = "loop.sl";
            k.call = {0, 7, 3};
            PrintKey other = k;
            other.call = {0, 8, 3};
            PrintKey next = k;
            next.sample = 1;
            for (size_t i = 0; i < 3 * most + 5; ++i) {
                log.add(k, "a");
                if (i < most) log.add(other, "b"); // as many as may be
                if (i < 2) log.add(next, "c");
            }
        }
        const std::string text = textOf(f),
                          rest = "(" + std::to_string(2 * most + 5) + " more messages of loop.sl:7 at this point are left out)\n";
        EXPECT_EQ(size_t(std::count(text.begin(), text.end(), 'b')), most);
        EXPECT_EQ(text.size(), 2 * most + rest.size() + 2);
        EXPECT_EQ(text.substr(2 * most), rest + "cc");
        std::fclose(f);
    }
}

TEST(PrintLog, WhatConstructPrintsComesOnceAndFirst) {
    std::FILE* f = std::tmpfile();
    ASSERT_NE(f, nullptr);
    {
        PrintLog log(f);
        PrintKey k;
        k.sample = 0;
        log.add(k, "3");
        log.once("a.sl:1", "a.sl", "1");
        log.once("a.sl:2", "a.sl", "2");
        log.once("a.sl:1", "a.sl", "1");
        log.flush();
        log.once("a.sl:1", "a.sl", "1");
        log.once("a.sl:1", "a.sl", "4");
        log.add(k, "void");
        log.discard();
    }
    EXPECT_EQ(textOf(f), "1234");
    std::fclose(f);
}

TEST(PrintLog, ThreadsDoNotShow) {
    std::string texts[2];
    for (int threads : {1, 4}) {
        std::FILE* f = std::tmpfile();
        ASSERT_NE(f, nullptr);
        {
            PrintLog log(f);
            std::vector<std::thread> team;
            for (int t = 0; t < threads; ++t)
                team.emplace_back([&, t] {
                    for (int s = 999 - t; s >= 0; s -= threads) {
                        PrintKey k;
                        k.sample = s;
                        log.add(k, std::to_string(s) + "\n");
                        log.add(k, "again\n");
                    }
                });
            for (auto& t : team) t.join();
        }
        texts[threads > 1] = textOf(f);
        std::fclose(f);
    }
    EXPECT_EQ(texts[0], texts[1]);
    EXPECT_EQ(texts[0].substr(0, 16), "0\nagain\n1\nagain\n");
}

} // namespace
} // namespace alpenglow::rsl::printlog_test
