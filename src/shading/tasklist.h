// Tasks one behind the other, each in cache lines of its own, that may be written out of rows (lanes/stages.h).
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace alpenglow::shading {

/// A vector of what is copied byte by byte, whose memory grows without being written first.
template <class Task> class TaskList {
    static_assert(std::is_trivially_copyable_v<Task> && std::is_trivially_destructible_v<Task>);

public:
    /// Number of tasks.
    size_t size() const { return size_; }
    /// There is no task.
    bool empty() const { return size_ == 0; }
    size_t bytes() const { return capacity_ * sizeof(Task); } ///< memory that it holds
    /// The first task, and the end behind the last; invalid after the list grows.
    Task* data() { return tasks_.get(); }
    const Task* data() const { return tasks_.get(); }
    Task* end() { return tasks_.get() + size_; }
    /// The last task; the list is not empty.
    Task& back() { return tasks_[size_ - 1]; }
    /// Keeps the memory.
    void clear() { size_ = 0; }
    /// Exchanges contents, without copying tasks.
    void swap(TaskList& o) noexcept {
        std::swap(tasks_, o.tasks_);
        std::swap(size_, o.size_);
        std::swap(capacity_, o.capacity_);
    }
    /// Memory for so many more, to be written and then taken(). It is good until the list grows.
    Task* room(size_t more) {
        if (size_ + more > capacity_) grow(size_ + more);
        return end();
    }
    /// Counts tasks that were written to room().
    void taken(size_t count) { size_ += count; }
    /// Appends a copy.
    void push(const Task& t) {
        new (room(1)) Task(t);
        ++size_;
    }
    /// The last ones of another list, which then has them no more.
    void takeLast(TaskList& from, size_t count) {
        std::memcpy(static_cast<void*>(room(count)), from.end() - count, count * sizeof(Task));
        size_ += count;
        from.size_ -= count;
    }

private:
    static constexpr std::align_val_t kLine{64};
    struct Free {
        void operator()(Task* p) const { ::operator delete(static_cast<void*>(p), kLine); }
    };
    void grow(size_t least) {
        const size_t capacity = std::max<size_t>(least, std::max<size_t>(16, capacity_ * 2));
        std::unique_ptr<Task, Free> more(static_cast<Task*>(::operator new(capacity * sizeof(Task), kLine)));
        if (size_ > 0) std::memcpy(static_cast<void*>(more.get()), tasks_.get(), size_ * sizeof(Task));
        tasks_.reset(more.release());
        capacity_ = capacity;
    }
    std::unique_ptr<Task[], Free> tasks_;
    size_t size_ = 0, capacity_ = 0;
};

} // namespace alpenglow::shading
