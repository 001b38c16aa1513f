// Threads that work through a list of tasks. Plain threads, not TBB: a tracer handles one call at a time, and a TBB thread that
// waits inside a trace could start another task with the same tracer.
#pragma once
#include "base/stopflag.h"
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace alpenglow::render {

/// Threads of one render.
class Team {
public:
    /// Below 1: 1.
    explicit Team(int threads) : threads_(threads < 1 ? 1 : threads) {}
    /// Number of threads.
    int threads() const { return threads_; }

    /// Calls work(worker, task) for tasks 0 to count - 1, each once, on `threads` threads; worker < threads. Meanwhile tick(done)
    /// runs on the calling thread about every 20 ms. Once *halt is set no further task starts. Rethrows exceptions of tasks or
    /// tick() after all have ended. Returns true if every task was done. If a thread cannot be started (no memory, or too many
    /// processes of this user), the others do its work; if none can, the calling thread works, with tick() between its tasks.
    template <class Work, class Tick> bool run(size_t count, StopFlag* halt, Work work, Tick tick) {
        std::atomic<size_t> next{0}, done{0};
        int running = 0;
        std::exception_ptr thrown;
        std::mutex mutex;
        std::condition_variable ended;
        const auto each = [&](int w, auto after) {
            try {
                while (!*halt) {
                    size_t i = next++;
                    if (i >= count) break;
                    work(w, i);
                    after(++done);
                }
            } catch (...) {
                std::lock_guard lock(mutex);
                if (!thrown) thrown = std::current_exception();
                *halt = 1;
            }
        };
        std::vector<std::thread> threads;
        threads.reserve(size_t(threads_));
        for (int w = 0; w < threads_; ++w) {
            {
                std::lock_guard lock(mutex);
                ++running;
            }
            if (!start(threads, [&, w] {
                    each(w, [](size_t) {});
                    std::lock_guard lock(mutex);
                    --running;
                    ended.notify_one();
                })) {
                std::lock_guard lock(mutex);
                --running;
                break;
            }
        }
        if (threads.empty()) each(0, tick);
        {
            std::unique_lock lock(mutex);
            bool broken = false;
            while (running > 0) {
                ended.wait_for(lock, std::chrono::milliseconds(20));
                lock.unlock();
                std::exception_ptr fault;
                try {
                    if (!broken) tick(done.load());
                } catch (...) { fault = std::current_exception(); }
                lock.lock();
                if (!fault) continue;
                broken = true;
                if (!thrown) thrown = fault;
                *halt = 1;
            }
        }
        for (std::thread& t : threads) t.join();
        if (thrown) std::rethrow_exception(thrown);
        return done == count && !*halt;
    }

    /// How many of `wanted` threads can run at once in addition to the calling one; at least 1, which may be the calling one.
    static int startable(int wanted) {
        std::vector<std::thread> threads;
        threads.reserve(size_t(wanted));
        std::mutex mutex;
        std::condition_variable all;
        bool go = false;
        for (int w = 0; w < wanted; ++w)
            if (!start(threads, [&] {
                    std::unique_lock lock(mutex);
                    all.wait(lock, [&] { return go; });
                }))
                break;
        {
            std::lock_guard lock(mutex);
            go = true;
        }
        all.notify_all();
        for (std::thread& t : threads) t.join();
        return threads.empty() ? 1 : int(threads.size());
    }

private:
    template <class Body> static bool start(std::vector<std::thread>& threads, Body body) {
        try {
            threads.emplace_back(std::move(body));
            return true;
        } catch (const std::system_error&) { return false; } catch (const std::bad_alloc&) {
            return false;
        }
    }
    int threads_;
};

} // namespace alpenglow::render
