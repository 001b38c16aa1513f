// The scheduler: coroutine shaders and rays without recursion (docs/design/rsl.md).
//
// A unit of work is a Task (a ray to follow) or a Strip (a suspended kernel). A task adds what it finds to its Target. A strip
// that suspends makes one target a lane, spawns tasks for them, and waits; when the last of them is complete the strip is ready.
// Work is taken deepest first, tasks in slices of at most limits::kSliceRays, so memory grows with depth and not with the size of
// the image. While no strip waits a slice is filled up with less deep tasks, so that the long tails of paths share batches with
// fresh ones. Sums are exact (base/exactsum.h), so no order of work, slice or batch changes a bit.
//
// One scheduler serves one thread. It knows no geometry and no shader: the RayService does; tests use a fake one.
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

using TargetId = int32_t;
inline constexpr TargetId kNoTarget = -1;

/// What a request for light comes back with. `radiance` is a sum over all tasks that aim at the target; the rest is written at
/// most once, by the task that was spawned first.
struct TargetValue {
    Color radiance{0};
    Color transmission{1};
    float distance = 1e38f; ///< to the nearest hit; > 1e30 on a miss (3Delight manual, 6.4.5.2)
    Vec3 normal;            ///< shading normal of that hit
};

template <class Payload> class Scheduler {
public:
    struct Task {
        int32_t depth = 0; ///< 0 = camera
        TargetId target = kNoTarget;
        Payload payload{};
    };
    using Tasks = TaskList<Task>;

    /// A suspended kernel strip.
    class Strip {
    public:
        virtual ~Strip() = default;
        virtual int depth() const = 0;
        /// Bytes its frame holds while it waits.
        virtual size_t frameBytes() const = 0;
        /// All children are complete: `results[i]` belongs to the i-th target of the last wait. Runs on to the next suspension
        /// (calls Scheduler::wait again and returns false) or to its end (returns true and is destroyed).
        virtual bool resume(Scheduler&, std::span<const TargetValue> results) = 0;
    };

    class RayService {
    public:
        virtual ~RayService() = default;
        /// Follows every task of the slice: adds to targets, spawns children, starts strips. The deepest tasks come first.
        virtual void follow(std::span<const Task> slice, Scheduler&) = 0;
        /// All strips that were ready at a depth have gone on: what they ask for now may be followed together.
        virtual void followStrips(Scheduler&) {}
        /// No task and no strip is left: goes on with what follow() has held back, whose targets it holds. False: there is none.
        virtual bool settle(Scheduler&) { return false; }
    };

    /// `stop`: polled between slices; when it is set run() gives up what is left. May be null.
    explicit Scheduler(RayService& service, const StopFlag* stop = nullptr, size_t frameLimit = limits::kFrameBytesPerThread,
                       int sliceRays = limits::kSliceRays)
        : service_(service), stop_(stop), frameLimit_(frameLimit), sliceRays_(sliceRays) {}

    /// A root target, read with value() after run().
    TargetId newRoot() { return newTarget(-1); }
    void spawn(Task t) { spawn(t.depth, t.target, t.payload); }
    /// The same for a payload that is made from another and changed in place: good until the next task is spawned.
    Task& spawn(int depth, TargetId target, const Payload& from = {}) {
        hold(target);
        Tasks& chunk = chunkAt(depth, 1);
        chunk.push({depth, target, from});
        ++queued_;
        return chunk.back();
    }
    /// Whether no strip has waited so far: then it is all the same in which order tasks are followed, and nobody waits for
    /// targets.
    bool plain() const { return strips_.empty(); }
    /// Where plain(): memory for some tasks that are written in one go, and `behind` more that may be overwritten; then
    /// spawned() says how many there are.
    Task* room(size_t tasks, size_t behind) { return chunkAt(0, tasks).room(tasks + behind); }
    void spawned(size_t count) {
        queues_[0].back().taken(count);
        queued_ += count;
    }
    /// Adds light to a target. Order does not matter: the sum is exact. Non-finite values are counted and dropped.
    void add(TargetId id, const Color& c) {
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
    void setTransmission(TargetId id, const Color& c) { targets_[id].value.transmission = c; }
    void setDistance(TargetId id, float d, const Vec3& normal = {}) {
        targets_[id].value.distance = d;
        targets_[id].value.normal = normal;
    }

    /// The same, when this hit is nearer than what is known. Order does not matter.
    void setNearer(TargetId id, float d, const Vec3& normal) {
        TargetValue& v = targets_[id].value;
        const auto key = [](const Vec3& n) { return std::array<float, 3>{n.x, n.y, n.z}; };
        if (d < v.distance || (d == v.distance && key(normal) < key(v.normal))) setDistance(id, d, normal);
    }

    /// Called by a strip (or whoever starts it) when it suspends: makes `count` targets, calls make(i, target) so that the caller
    /// spawns the tasks of each, and keeps the strip until all are complete. A target for which nothing is spawned is complete at
    /// once.
    template <class Make> void wait(std::unique_ptr<Strip> strip, int count, Make make) {
        int slot = newStrip();
        Waiting& w = strips_[slot];
        w.strip = std::move(strip);
        frameBytes_ += w.bytes = w.strip->frameBytes();
        peakFrameBytes_ = std::max(peakFrameBytes_, frameBytes_);
        ++suspensions_;
        std::vector<TargetId> ids(count);
        for (int i = 0; i < count; ++i) ids[i] = newTarget(slot);
        strips_[slot].targets = ids;
        strips_[slot].open = count + 1; // one for this loop, so that nothing becomes ready while it runs
        for (int i = 0; i < count; ++i) {
            make(i, ids[i]);
            if (open_[size_t(ids[i])].pending == 0) closeChild(slot);
        }
        closeChild(slot);
    }

    /// Works until everything is done or stop is set. Returns false when it was stopped.
    bool run() {
        Tasks slice;
        while (queued_ > 0 || !ready_.empty() || service_.settle(*this)) {
            if (queued_ == 0 && ready_.empty()) continue;
            if (stop_ && *stop_) {
                abandon();
                return false;
            }
            int rayDepth = queued_ > 0 ? deepestBelow(queues_.size()) : -1;
            if (!ready_.empty() && ready_.rbegin()->first >= rayDepth) {
                // All that are ready at this depth go on together, so that what they ask for next is one stream again.
                for (size_t n = ready_.rbegin()->second.size(); n > 0; --n) resumeOne();
                service_.followStrips(*this);
                continue;
            }
            // Near the frame limit only as many rays are taken as one strip can hold, so that depth, not breadth, uses what is
            // left.
            size_t most = frameBytes_ > frameLimit_ / 2 ? std::min(kStripRays, size_t(sliceRays_)) : size_t(sliceRays_);
            takeSlice(slice, most);
            size_t n = slice.size();
            queued_ -= n;
            if (frameBytes_ > frameLimit_) {
                overLimit_ += n; // these rays bring nothing: a bias, counted and reported by the caller
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
        } // what kernels left early is void
        return true;
    }

    TargetValue value(TargetId id) const {
        const Target& t = targets_[id];
        TargetValue v = t.value;
        v.radiance = {t.sum[0].toFloat(), t.sum[1].toFloat(), t.sum[2].toFloat()};
        return v;
    }
    /// As new, in the memory that is there.
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

    size_t frameBytes() const { return frameBytes_; } ///< that wait now
    size_t frameLimit() const { return frameLimit_; }
    size_t peakFrameBytes() const { return peakFrameBytes_; }
    size_t largestSlice() const { return largestSlice_; }
    uint64_t suspensions() const { return suspensions_; }
    uint64_t overLimit() const { return overLimit_; }
    uint64_t nonFinite() const { return nonFinite_; }

    static constexpr size_t kStripRays = 64; ///< the widest strip

private:
    struct Target {
        ExactSum sum[3];
        TargetValue value;
    };
    /// What a target waits for: by itself, since it is asked for at every ray, and the rest only where there is light.
    struct Open {
        int pending = 0;
        int strip = -1; ///< -1: a root
    };
    struct Waiting {
        std::unique_ptr<Strip> strip;
        std::vector<TargetId> targets;
        int open = 0;
        size_t bytes = 0;
    };

    TargetId newTarget(int strip) {
        TargetId id;
        if (freeTargets_.empty()) {
            id = TargetId(targets_.size());
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
    void complete(TargetId id) {
        Open& t = open_[size_t(id)];
        if (--t.pending == 0 && t.strip >= 0) closeChild(t.strip);
    }
    void closeChild(int slot) {
        Waiting& w = strips_[slot];
        if (--w.open == 0) ready_[w.strip->depth()].push_back(slot);
    }
    /// The last chunk of the tasks of a depth, with room for some more.
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
    /// The deepest tasks. Where no strip waits, a slice that would not be half full gets less deep ones, too.
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
                if (slice.empty() && q.size() <= most) slice.swap(q); // no task is moved
                else slice.takeLast(q, std::min(q.size(), most - slice.size()));
                if (!q.empty()) break;
                freeChunk(std::move(q));
                chunks.pop_back();
                if (slice.size() * 2 >= most) break;
            }
            if (chunks.empty()) filled_[size_t(depth) / 64] &= ~(uint64_t(1) << depth % 64);
        }
    }
    /// The deepest queue below `depth` that is not empty; -1: none. A path of ten thousand bounces leaves as many empty ones
    /// behind.
    int deepestBelow(size_t depth) const {
        size_t word = std::min(depth / 64, filled_.size());
        uint64_t bits = word < filled_.size() ? filled_[word] & ((uint64_t(1) << depth % 64) - 1) : 0;
        while (bits == 0 && word > 0) bits = filled_[--word];
        return bits != 0 ? int(word * 64 + 63) - std::countl_zero(bits) : -1;
    }
    void resumeOne() {
        auto last = std::prev(ready_.end()); // strips that become ready meanwhile join behind, at most at this depth
        int slot = last->second.front();
        last->second.pop_front();
        if (last->second.empty()) ready_.erase(last);
        Waiting w = std::move(strips_[slot]);
        strips_[slot] = Waiting{};
        freeStrips_.push_back(slot);
        frameBytes_ -= w.bytes;
        std::vector<TargetValue> results;
        results.reserve(w.targets.size());
        for (TargetId id : w.targets) {
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
    /// For Strip::resume: takes ownership of the strip that is being resumed, to hand it to wait() again.
    std::unique_ptr<Strip> takeResuming() { return std::move(resuming_); }
    /// A strip that holds a task's target open until it ends: the task's own count is closed by run(), so the strip adds one
    /// more.
    void hold(TargetId id) {
        if (!plain()) ++open_[size_t(id)].pending;
    }
    void release(TargetId id) {
        if (!plain()) complete(id);
    }

private:
    RayService& service_;
    const StopFlag* stop_;
    size_t frameLimit_;
    int sliceRays_;
    std::vector<Target> targets_;
    std::vector<Open> open_; ///< of targets_
    std::vector<TargetId> freeTargets_;
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
