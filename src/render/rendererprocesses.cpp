// The renderer's part in frames rendered by processes (frameprocesses.h): what they receive and return.
#include "base/realpath.h"
#include "display/driver.h"
#include "render/frameprocesses.h"
#include "render/framework.h"
#include "render/heap.h"
#include "shadeops/bitcode.h"
#include "world/bakes.h"
#include "world/procedurals.h"
#include <algorithm>
#include <tbb/cache_aligned_allocator.h>
#include <utility>

namespace alpenglow::render {

void Renderer::setProcesses(FrameProcesses& p) {
    processes_ = &p;
    // Each process would repeat these: tables of the language, and TBB's search for its allocator.
    shadeops::runtimeHash();
    tbb::cache_aligned_allocator<char> allocator;
    allocator.deallocate(allocator.allocate(1), 1);
    p.setTake([this](FrameResult r) { takeResult(std::move(r)); });
}

bool Renderer::inProcess() const { return processes_ && processes_->inProcess(); }

std::string Renderer::ofEachFrame() const {
    return inProcess() ? " for each of " + std::to_string(processes_->most()) + " frames at once" : "";
}

bool Renderer::drawsHere(const FrameWork& f) {
    if (!processes_) return true;
    FrameProcesses::Writes writes;
    for (const OutputSpec& s : f.plan.pictures) {
        const display::DriverDescriptor* driver = display::findDriver(s.type);
        if (settings_.pixel || s.name == "-" || (driver && !driver->writes)) continue;
        writes.files.push_back(s.name);
        written_.push_back(followedPath(s.name));
    }
    writes.others = writes.declared = f.o.hider == "photon"; // the names are in the scene and its shaders
    const int number = f.o.frameNumber;
    handedOver_ = !processes_->start(number > 0 ? "frame " + std::to_string(number) : "a frame", std::move(writes), false);
    if (!handedOver_) beginProcess(false);
    return !handedOver_;
}

void Renderer::beginProcess(bool alone) {
    outcome_ = {};
    all_ = {};
    frames_.clear();
    if (alone) return;
    settings_.threads = std::max(1, settings_.threads / processes_->most());
    settings_.memoryLimit /= size_t(processes_->most());
    begun_ = ownBytes();
    fillHeap(grown_, settings_.threads == 1); // frames are similar
}

void Renderer::endFrame() {
    if (inProcess()) {
        FrameResult r;
        r.outcome = outcome_;
        r.parseSec = stats_.parseSec;
        if (grown_ == 0) r.grown = ownBytes() - std::min(ownBytes(), begun_);
        if (!frames_.empty()) r.stats = std::move(frames_.back());
        processes_->finish(std::move(r));
    }
    processes_->closeFrame();
    if (std::exchange(handedOver_, false)) stats_ = {};
}

void Renderer::takeResult(FrameResult r) {
    outcome_.add(r.outcome);
    grown_ = std::max(grown_, r.grown);
    if (!r.stats) {
        stats_.parseSec += r.parseSec;
        return;
    }
    accumulate(all_, r.stats->figures);
    frames_.push_back(std::move(*r.stats));
}

void Renderer::waitForFrames() {
    if (processes_) processes_->waitForFrames();
}

void Renderer::beforeRead(const std::string& name) {
    if (processes_) processes_->awaitRead(name);
}

void Renderer::declareBakes(const FrameWork& f) {
    // A procedural expanded later may contain shaders that bake.
    if (inProcess()) processes_->declare(world::bakes(*f.world) || world::hasDeferred(*f.world));
}

void Renderer::awaitTurn() {
    if (inProcess()) processes_->awaitTurn();
}

void Renderer::awaitTurn(const FrameWork& f) {
    const auto map = [](const OutputSpec& s) { return s.map; };
    if (std::any_of(f.plan.pictures.begin(), f.plan.pictures.end(), map)) awaitTurn();
}

} // namespace alpenglow::render
