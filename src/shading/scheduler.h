// The scheduler: coroutine shaders and rays without recursion (docs/design/rsl.md).
//
// A unit of work is a Task (a ray to trace) or a Strip (a suspended kernel). A task adds its light to its Target. A strip that
// suspends makes one target for each lane, spawns tasks for them, and waits; when the last of them is complete the strip is
// ready. Work is done deepest first, tasks in slices of at most limits::kSliceRays, so memory grows with depth and not with image
// size. While no strip waits, a slice is filled with less deep tasks, so that the long tails of paths share batches with new
// paths. Sums are exact (base/exactsum.h), so the order of work, slices and batches changes no bit.
//
// One scheduler serves one thread. Geometry and shading are in the RayService; tests use a fake one.
#pragma once
#include "base/exactsum.h"
#include "base/limits.h"
#include "base/stopflag.h"
#include "base/vec.h"
#include "shading/tasklist.h"
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace alpenglow::shading {

/// Index of a target of light.
using AccumulatorId = int32_t;
inline constexpr AccumulatorId kNoAccumulator = -1;

/// Result of a request for light. `radiance` is a sum over all tasks of the target; the rest is written at most once, by the
/// first task spawned.
struct TargetValue {
    Color radiance{0};
    Color transmission{1};  ///< of the medium and the surfaces on the way, by channel
    float distance = 1e38f; ///< to the nearest hit; > 1e30 on a miss (3Delight manual, 6.4.5.2)
    Vec3 normal;            ///< shading normal of that hit
};

/// Traces tasks to their end, the deepest first, and resumes kernels that wait for them. For one thread. Sums are exact, so their
/// bits depend neither on the order of tasks nor on slices. Payload: what a task carries, copied byte by byte.
template <class Payload> class Scheduler {
public:
    /// One ray to trace, and the target of its light.
    struct Task {
        int32_t depth = 0; ///< 0 = camera
        AccumulatorId target = kNoAccumulator;
        Payload payload{}; ///< what the integrator keeps of the ray
    };
    using Tasks = TaskList<Task>;

    /// A suspended kernel strip.
    class Strip {
    public:
        virtual ~Strip() = default;
        /// Depth of the tasks that it waits for.
        virtual int depth() const = 0;
        /// Memory of its frame while it waits, in bytes.
        virtual size_t frameBytes() const = 0;
        /// All its targets are complete: `results[i]` belongs to the i-th target of the last wait. Runs to the next suspension
        /// (calls Scheduler::wait again and returns false) or to its end (returns true and is destroyed).
        virtual bool resume(Scheduler&, std::span<const TargetValue> results) = 0;
    };

    /// What traces: the pipeline of the integrator.
    class RayService {
    public:
        virtual ~RayService() = default;
        /// Traces every task of the slice: adds to targets, spawns tasks, starts strips. The deepest tasks come first.
        virtual void follow(std::span<const Task> slice, Scheduler&) = 0;
        /// Called after all strips that were ready at a depth have resumed: their new requests may be processed together.
        virtual void followStrips(Scheduler&) {}
        /// Called when no task and no strip is left: continues with hits that follow() has held back with their targets. Returns
        /// false if there are none.
        virtual bool shadeQueued(Scheduler&) { return false; }
    };

    /// `stop`: polled between slices; once set, run() abandons the remaining work. May be null.
    explicit Scheduler(RayService& service, const StopFlag* stop = nullptr, size_t frameLimit = limits::kFrameBytesPerThread,
                       int sliceRays = limits::kSliceRays)
        : service_(service), stop_(stop), frameLimit_(frameLimit), sliceRays_(sliceRays) {}

    /// A root target, read with value() after run().
    AccumulatorId newRoot() { return newTarget(-1); }
    /// Adds a task. Its target stays open until the task has been followed.
    void spawn(Task t) { spawn(t.depth, t.target, t.payload); }
    /// For a payload made from another and modified in place; the reference is valid until the next spawn.
    Task& spawn(int depth, AccumulatorId target, const Payload& from = {}) {
        hold(target);
        Tasks& chunk = chunkAt(depth, 1);
        chunk.push({depth, target, from});
        ++queued_;
        return chunk.back();
    }
    /// Whether no strip has waited so far: then the order of tasks is irrelevant, and targets are not counted.
    bool plain() const { return strips_.empty(); }
    /// Requires plain(): memory for some tasks written at once, plus `behind` more that may be overwritten; then call spawned()
    /// with their number.
    Task* room(size_t tasks, size_t behind) { return chunkAt(0, tasks).room(tasks + behind); }
    /// Takes so many of the tasks written to room().
    void spawned(size_t count) {
        queues_[0].back().taken(count);
        queued_ += count;
    }
    /// Whether no strip waits for this target: its value is a sum of light, of which no shader makes anything else.
    bool isRoot(AccumulatorId id) const { return open_[size_t(id)].strip < 0; }
    /// Adds light to a target. The sum is exact, so order does not matter. Non-finite values are counted and dropped.
    void add(AccumulatorId id, const Color& c) {
        if (c.x == 0 && c.y == 0 && c.z == 0) return;
        Target& t = targets_[id];
        if (!std::isfinite(c.x) || !std::isfinite(c.y) || !std::isfinite(c.z)) {
            ++nonFinite_;
            return;
        }
        if (c.x != 0) t.sum[0].add(c.x);
        if (c.y != 0) t.sum[1].add(c.y);
        if (c.z != 0) t.sum[2].add(c.z);
    }
    /// Sets the transmission of a target; only its first task may.
    void setTransmission(AccumulatorId id, const Color& c) { targets_[id].value.transmission = c; }
    /// Sets the distance to the nearest hit, and its normal.
    void setDistance(AccumulatorId id, float d, const Vec3& normal = {}) {
        targets_[id].value.distance = d;
        targets_[id].value.normal = normal;
    }

    /// Sets the distance if this hit is nearer. Order does not matter.
    void setNearer(AccumulatorId id, float d, const Vec3& normal) {
        TargetValue& v = targets_[id].value;
        const auto key = [](const Vec3& n) { return std::array<float, 3>{n.x, n.y, n.z}; };
        if (d < v.distance || (d == v.distance && key(normal) < key(v.normal))) setDistance(id, d, normal);
    }

    /// Called when a strip suspends: makes `count` targets, calls make(i, target) so that the caller spawns the tasks of each,
    /// and keeps the strip until all are complete. A target without tasks is complete at once.
    template <class Make> void wait(std::unique_ptr<Strip> strip, int count, Make make) {
        int slot = newStrip();
        Waiting& w = strips_[slot];
        w.strip = std::move(strip);
        frameBytes_ += w.bytes = w.strip->frameBytes();
        peakFrameBytes_ = std::max(peakFrameBytes_, frameBytes_);
        ++suspensions_;
        std::vector<AccumulatorId> ids(count);
        for (int i = 0; i < count; ++i) ids[i] = newTarget(slot);
        strips_[slot].targets = ids;
        strips_[slot].open = count + 1; // one for this loop, so that nothing becomes ready while it runs
        for (int i = 0; i < count; ++i) {
            make(i, ids[i]);
            if (open_[size_t(ids[i])].pending == 0) closeChild(slot);
        }
        closeChild(slot);
    }

    /// Works until everything is done or stop is set. Returns false if stopped.
    bool run() {
        Tasks slice;
        while (queued_ > 0 || !ready_.empty() || service_.shadeQueued(*this)) {
            if (queued_ == 0 && ready_.empty()) continue;
            if (stop_ && *stop_) {
                abandon();
                return false;
            }
            int rayDepth = queued_ > 0 ? deepestBelow(queues_.size()) : -1;
            if (!ready_.empty() && ready_.rbegin()->first >= rayDepth) {
                // All strips that are ready at this depth resume together, so that their next requests form one stream.
                for (size_t n = ready_.rbegin()->second.size(); n > 0; --n) resumeOne();
                service_.followStrips(*this);
                continue;
            }
            // Near the frame limit takes only as many rays as one strip has, so that depth rather than breadth uses the remaining
            // memory.
            size_t most = frameBytes_ > frameLimit_ / 2 ? std::min(kStripRays, size_t(sliceRays_)) : size_t(sliceRays_);
            takeSlice(slice, most);
            size_t n = slice.size();
            queued_ -= n;
            if (frameBytes_ > frameLimit_) {
                overLimit_ += n; // these rays are dropped: a bias, counted and reported by the caller
            } else {
                ++slices_;
                largestSlice_ = std::max(largestSlice_, n);
                service_.follow({slice.data(), n}, *this);
            }
            for (size_t i = 0; i < n && !plain(); ++i) complete(slice.data()[i].target);
        }
        if (stop_ && *stop_) {
            abandon();
            return false;
        } // early exits of kernels are void
        return true;
    }

    /// The value so far; of a root, complete after run().
    TargetValue value(AccumulatorId id) const {
        const Target& t = targets_[id];
        TargetValue v = t.value;
        v.radiance = {t.sum[0].toFloat(), t.sum[1].toFloat(), t.sum[2].toFloat()};
        return v;
    }
    /// Resets the scheduler and keeps its memory.
    void restart(const StopFlag* stop) {
        stop_ = stop;
        targets_.clear();
        open_.clear();
        freeTargets_.clear();
        strips_.clear();
        freeStrips_.clear();
        ready_.clear();
        resuming_.reset();
        dropTasks();
        queued_ = frameBytes_ = peakFrameBytes_ = largestSlice_ = 0;
        suspensions_ = overLimit_ = nonFinite_ = slices_ = 0;
    }

    size_t frameBytes() const { return frameBytes_; } ///< of waiting strips
    /// Beyond it kernels are no longer suspended side by side.
    size_t frameLimit() const { return frameLimit_; }
    /// Largest value of frameBytes() so far.
    size_t peakFrameBytes() const { return peakFrameBytes_; }
    /// Memory that tasks and targets hold, and the most that frames of waiting strips have held since restart().
    size_t bytes() const {
        size_t sum = targets_.capacity() * sizeof(Target) + open_.capacity() * sizeof(Open) + peakFrameBytes_;
        for (const std::vector<Tasks>& chunks : queues_)
            for (const Tasks& t : chunks) sum += t.bytes();
        for (const Tasks& t : freeChunks_) sum += t.bytes();
        return sum;
    }
    size_t largestSlice() const { return largestSlice_; }
    uint64_t suspensions() const { return suspensions_; }
    uint64_t overLimit() const { return overLimit_; }
    uint64_t nonFinite() const { return nonFinite_; }

    static constexpr size_t kStripRays = 64; ///< lanes of the widest strip

private:
    struct Target {
        ExactSum sum[3];
        TargetValue value;
    };
    /// Pending work of a target: separate from the rest, as it changes with every ray.
    struct Open {
        int pending = 0;
        int strip = -1; ///< -1: a root
    };
    struct Waiting {
        std::unique_ptr<Strip> strip;
        std::vector<AccumulatorId> targets;
        int open = 0;
        size_t bytes = 0;
    };

    AccumulatorId newTarget(int strip) {
        AccumulatorId id;
        if (freeTargets_.empty()) {
            id = AccumulatorId(targets_.size());
            targets_.emplace_back();
            open_.emplace_back();
        } else {
            id = freeTargets_.back();
            freeTargets_.pop_back();
            targets_[id] = Target{};
        }
        open_[size_t(id)] = {0, strip};
        return id;
    }
    int newStrip() {
        if (!freeStrips_.empty()) {
            int s = freeStrips_.back();
            freeStrips_.pop_back();
            return s;
        }
        strips_.emplace_back();
        return int(strips_.size()) - 1;
    }
    void complete(AccumulatorId id) {
        Open& t = open_[size_t(id)];
        if (--t.pending == 0 && t.strip >= 0) closeChild(t.strip);
    }
    void closeChild(int slot) {
        Waiting& w = strips_[slot];
        if (--w.open == 0) ready_[w.strip->depth()].push_back(slot);
    }
    /// The last chunk of tasks of a depth, with space for some more.
    Tasks& chunkAt(int depth, size_t more) {
        if (size_t(depth) >= queues_.size()) {
            queues_.resize(size_t(depth) + 1);
            filled_.resize(size_t(depth) / 64 + 1);
        }
        filled_[size_t(depth) / 64] |= uint64_t(1) << depth % 64;
        auto& chunks = queues_[size_t(depth)];
        if (chunks.empty() || chunks.back().size() + more > size_t(sliceRays_)) chunks.push_back(newChunk());
        return chunks.back();
    }
    Tasks newChunk() {
        Tasks chunk;
        if (!freeChunks_.empty()) {
            chunk.swap(freeChunks_.back());
            freeChunks_.pop_back();
        }
        return chunk;
    }
    void freeChunk(Tasks&& chunk) {
        chunk.clear();
        freeChunks_.push_back(std::move(chunk));
    }
    /// Takes the deepest tasks. If no strip waits, a slice that would be less than half full also gets less deep ones.
    void takeSlice(Tasks& slice, size_t most) {
        slice.clear();
        for (int depth = deepestBelow(queues_.size()); depth >= 0 && slice.size() * 2 < most;
             depth = deepestBelow(size_t(depth))) {
            auto& chunks = queues_[size_t(depth)];
            if (!slice.empty() && frameBytes_ > 0) break;
            if (slice.empty() && chunks.size() > 1 && chunks[chunks.size() - 2].size() <= most) // nearly full, unlike the last
                std::swap(chunks[chunks.size() - 2], chunks.back());
            while (!chunks.empty() && slice.size() < most) {
                Tasks& q = chunks.back();
                if (slice.empty() && q.size() <= most) slice.swap(q); // without moving tasks
                else slice.takeLast(q, std::min(q.size(), most - slice.size()));
                if (!q.empty()) break;
                freeChunk(std::move(q));
                chunks.pop_back();
                if (slice.size() * 2 >= most) break;
            }
            if (chunks.empty()) filled_[size_t(depth) / 64] &= ~(uint64_t(1) << depth % 64);
        }
    }
    /// The deepest non-empty queue below `depth`; -1: none. A path of ten thousand bounces leaves as many empty ones.
    int deepestBelow(size_t depth) const {
        size_t word = std::min(depth / 64, filled_.size());
        uint64_t bits = word < filled_.size() ? filled_[word] & ((uint64_t(1) << depth % 64) - 1) : 0;
        while (bits == 0 && word > 0) bits = filled_[--word];
        return bits != 0 ? int(word * 64 + 63) - std::countl_zero(bits) : -1;
    }
    void resumeOne() {
        auto last = std::prev(ready_.end()); // strips that become ready meanwhile are appended, at most at this depth
        int slot = last->second.front();
        last->second.pop_front();
        if (last->second.empty()) ready_.erase(last);
        Waiting w = std::move(strips_[slot]);
        strips_[slot] = Waiting{};
        freeStrips_.push_back(slot);
        frameBytes_ -= w.bytes;
        std::vector<TargetValue> results;
        results.reserve(w.targets.size());
        for (AccumulatorId id : w.targets) {
            results.push_back(value(id));
            freeTargets_.push_back(id);
        }
        Strip* s = w.strip.get();
        resuming_ = std::move(w.strip);
        if (s->resume(*this, results)) resuming_.reset();
    }
    void dropTasks() {
        for (auto& chunks : queues_) {
            for (auto& chunk : chunks) freeChunk(std::move(chunk));
            chunks.clear();
        }
        std::fill(filled_.begin(), filled_.end(), 0);
        queued_ = 0;
    }
    void abandon() {
        dropTasks();
        ready_.clear();
        strips_.clear();
        frameBytes_ = 0;
    }

public:
    /// For Strip::resume: takes ownership of the strip being resumed, to pass it to wait() again.
    std::unique_ptr<Strip> takeResuming() { return std::move(resuming_); }
    /// For a strip that keeps a task's target open until it ends: run() closes the task's own count, so the strip adds one.
    void hold(AccumulatorId id) {
        if (!plain()) ++open_[size_t(id)].pending;
    }
    /// Ends what hold() began.
    void release(AccumulatorId id) {
        if (!plain()) complete(id);
    }

private:
    RayService& service_;
    const StopFlag* stop_;
    size_t frameLimit_;
    int sliceRays_;
    std::vector<Target> targets_;
    std::vector<Open> open_; ///< by target
    std::vector<AccumulatorId> freeTargets_;
    std::deque<Waiting> strips_;
    std::vector<int> freeStrips_;
    std::vector<std::vector<Tasks>> queues_; ///< by depth, in chunks of at most a slice
    std::vector<uint64_t> filled_;           ///< a bit for each depth: whether its queue holds tasks
    std::vector<Tasks> freeChunks_;
    size_t queued_ = 0;
    std::map<int, std::deque<int>> ready_;
    std::unique_ptr<Strip> resuming_;
    size_t frameBytes_ = 0, peakFrameBytes_ = 0, largestSlice_ = 0;
    uint64_t suspensions_ = 0, overLimit_ = 0, nonFinite_ = 0, slices_ = 0;
};

} // namespace alpenglow::shading
