// Loops and groups of tasks on oneTBB's threads. libtbb is not instrumented, so ThreadSanitizer does not see how it hands work
// from thread to thread; its build is told here.
#pragma once
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>
#include <utility>
#if __has_feature(thread_sanitizer)
#include <sanitizer/tsan_interface.h>
#endif

namespace alpenglow {

/// The order that starting tasks and waiting for them establishes: what is before started() happens before every task, and every
/// task before what is after waited(). Nothing orders two tasks.
class TaskOrder {
public:
    /// Lives as long as a task runs.
    class Running {
    public:
        explicit Running(TaskOrder& order) : order_(order) { order_.begins(); }
        Running(const Running&) = delete;
        Running& operator=(const Running&) = delete;
        ~Running() { order_.ends(); }

    private:
        TaskOrder& order_;
    };
#if __has_feature(thread_sanitizer)
    void started() { __tsan_release(&start_); }
    void waited() { __tsan_acquire(&end_); }

private:
    void begins() { __tsan_acquire(&start_); }
    void ends() { __tsan_release(&end_); }
    char start_ = 0, end_ = 0; // only their addresses matter
#else
    void started() {}
    void waited() {}

private:
    void begins() {}
    void ends() {}
#endif
};

/// Tasks that may run on other threads until wait() returns, which throws what one of them threw.
class TaskGroup {
public:
    template <class Task> void run(Task task) {
        order_.started();
        group_.run([this, task = std::move(task)] {
            const TaskOrder::Running running(order_);
            task();
        });
    }
    void wait() {
        const Waited waited{order_};
        group_.wait();
    }

private:
    struct Waited {
        TaskOrder& order;
        ~Waited() { order.waited(); }
    };
    template <class Index, class Body> friend void parallelFor(Index first, Index last, const Body& body);
    tbb::task_group group_;
    TaskOrder order_;
};

/// body(i) for first <= i < last, in any order and on any thread; returns when all have ended. Throws what one of them threw.
template <class Index, class Body> void parallelFor(Index first, Index last, const Body& body) {
    TaskOrder order;
    order.started();
    const TaskGroup::Waited waited{order};
    tbb::parallel_for(first, last, [&](Index i) {
        const TaskOrder::Running running(order);
        body(i);
    });
}

} // namespace alpenglow
