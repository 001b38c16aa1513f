// Parallel loops and task groups: on oneTBB, or on plain threads under ThreadSanitizer, because libtbb is not instrumented.
#pragma once
#if __has_feature(thread_sanitizer)
#include "base/plainthreads.h"
#else
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>
#include <utility>

namespace alpenglow {

/// Tasks that may run on other threads until wait() returns, which rethrows an exception of a task.
class TaskGroup {
public:
    /// Starts task(), on this thread or another.
    template <class Task> void run(Task task) { group_.run(std::move(task)); }
    /// Returns when all tasks have ended.
    void wait() { group_.wait(); }

private:
    tbb::task_group group_;
};

/// Calls body(i) for first <= i < last, in any order and on any thread; returns when all have ended. Rethrows an exception of a
/// body.
template <class Index, class Body> void parallelFor(Index first, Index last, const Body& body) {
    tbb::parallel_for(first, last, body);
}

} // namespace alpenglow
#endif
