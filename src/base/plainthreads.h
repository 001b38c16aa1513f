// base/parallel.h for ThreadSanitizer: the same on std::thread, whose synchronisation it tracks.
#pragma once
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <tbb/global_control.h>
#include <thread>
#include <utility>
#include <vector>

namespace alpenglow {

/// As TaskGroup of base/parallel.h. A task runs on its own thread, or immediately if as many threads run as oneTBB would use.
class TaskGroup {
public:
    ~TaskGroup() { join(); }

    /// Starts a task, which may run before this returns.
    template <class Task> void run(Task task) {
        if (!mayStart()) return attempt(task);
        const std::lock_guard lock(mutex_);
        threads_.emplace_back([this, task = std::move(task)]() mutable {
            attempt(task);
            --running();
        });
    }
    /// Returns when all tasks have ended. Throws what the first failing task threw.
    void wait() {
        join();
        const std::lock_guard lock(mutex_);
        if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
    }

private:
    /// Threads of all groups that run.
    static std::atomic<size_t>& running() {
        static std::atomic<size_t> count = 0;
        return count;
    }
    static bool mayStart() {
        const size_t most = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
        size_t now = running();
        while (now + 1 < most)
            if (running().compare_exchange_weak(now, now + 1)) return true;
        return false;
    }
    template <class Task> void attempt(Task& task) {
        try {
            task();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!thrown_) thrown_ = std::current_exception();
        }
    }
    /// A task may start others of its group.
    void join() {
        for (;;) {
            std::vector<std::thread> now;
            {
                const std::lock_guard lock(mutex_);
                now.swap(threads_);
            }
            if (now.empty()) return;
            for (std::thread& t : now) t.join();
        }
    }

    std::mutex mutex_;
    std::vector<std::thread> threads_;
    std::exception_ptr thrown_;
};

/// As parallelFor() of base/parallel.h. Starts no further iterations once a body has thrown.
template <class Index, class Body> void parallelFor(Index first, Index last, const Body& body) {
    std::atomic<Index> next = first;
    std::atomic<bool> failed = false;
    const auto some = [&] {
        try {
            for (Index i; !failed && (i = next++) < last;) body(i);
        } catch (...) {
            failed = true;
            throw;
        }
    };
    TaskGroup group;
    for (size_t n = std::min(size_t(8), last > first ? size_t(last - first) : 0); n > 1; --n) group.run(some);
    group.run([&] { some(); });
    group.wait();
}

} // namespace alpenglow
