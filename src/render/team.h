// Threads that work through a list of tasks. Plain threads, not TBB: a tracer is busy with one call at a time, and a TBB thread
// that waits inside a trace may begin another task of the same list with the same tracer.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace alpenglow::render {

class Team {
public:
    explicit Team(int threads) : threads_(threads < 1 ? 1 : threads) {}
    int threads() const { return threads_; }

    /// Calls work(worker, task) for tasks 0 .. count-1, each once, on `threads` threads; worker < threads. Meanwhile tick(done)
    /// runs on the calling thread about every 20 ms. Once *halt is set no further task begins. Throws what a task threw, after
    /// all have ended. True when every task was done.
    template <class Work, class Tick> bool run(size_t count, volatile int32_t* halt, Work work, Tick tick) {
        std::atomic<size_t> next{0}, done{0};
        int running = threads_;
        std::exception_ptr thrown;
        std::mutex mutex;
        std::condition_variable ended;
        std::vector<std::thread> threads;
        for (int w = 0; w < threads_; ++w)
            threads.emplace_back([&, w] {
                try {
                    while (!*halt) {
                        size_t i = next++;
                        if (i >= count) break;
                        work(w, i);
                        ++done;
                    }
                } catch (...) {
                    std::lock_guard lock(mutex);
                    if (!thrown) thrown = std::current_exception();
                    *halt = 1;
                }
                std::lock_guard lock(mutex);
                --running;
                ended.notify_one();
            });
        {
            std::unique_lock lock(mutex);
            while (running > 0) {
                ended.wait_for(lock, std::chrono::milliseconds(20));
                lock.unlock();
                tick(done.load());
                lock.lock();
            }
        }
        for (std::thread& t : threads) t.join();
        if (thrown) std::rethrow_exception(thrown);
        return done == count && !*halt;
    }

private:
    int threads_;
};

} // namespace alpenglow::render
