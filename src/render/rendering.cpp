#include "render/rendering.h"
#include "world/procedurals.h"
#include <algorithm>
#include <chrono>
#include <numeric>
#include <stdexcept>

namespace alpenglow::render {

Job::Job(const RenderSettings& s, const Camera& c, const OutputPlan& p, Engine& e, std::shared_ptr<const world::World> w,
         int threads, Progress& progress_, Diagnostics& d)
    : settings(s), camera(c), plan(p), engine(e), world(std::move(w)), team(threads), progress(progress_), diagnostics(d),
      startSeconds(clockSeconds()), unfinished_(size_t(team.threads()), 0) {
    begin();
}

void Job::begin() {
    tracers.clear();
    rays.assign(size_t(team.threads()), 0);
    for (int i = 0; i < team.threads(); ++i) tracers.push_back(engine.tracer(world, diagnostics));
}

bool Job::run(size_t count, const std::function<void(int, size_t)>& work, const std::function<void(size_t)>& tick) {
    std::vector<size_t> left(count);
    std::iota(left.begin(), left.end(), size_t(0));
    while (true) {
        std::vector<uint8_t> again(left.size());
        const size_t before = count - left.size();
        const auto task = [&](int worker, size_t i) {
            unfinished_[size_t(worker)] = 0;
            work(worker, left[i]);
            again[i] = unfinished_[size_t(worker)];
        };
        if (!team.run(left.size(), &halt, task, [&](size_t done) { tick(before + done); })) return false;
        if (std::find(again.begin(), again.end(), 1) == again.end()) return true;
        if (!world::hasPrints(*world)) { // otherwise prints could not be assigned to a world
            size_t kept = 0;
            for (size_t i = 0; i < left.size(); ++i)
                if (again[i]) left[kept++] = left[i];
            left.resize(kept);
        } else {
            world->flushPrints(false);
            left.resize(count);
            std::iota(left.begin(), left.end(), size_t(0));
        }
        if (!makeMet()) return false;
    }
}

bool Job::runShown(size_t count, const char* part, const std::function<void(int, size_t)>& work) {
    const bool whole = run(count, work, [&](size_t done) {
        pollStop();
        ProgressState s;
        s.fraction = s.samplesDone = double(done) / double(std::max<size_t>(count, 1));
        s.samplesTotal = 1;
        progress.update(s, what + ": " + part);
    });
    progress.clear();
    return whole && !interrupted;
}

bool Job::makeMet() {
    const std::vector<int> numbers = world::procedurals(*world);
    // Nearest first; then twice as many each round, so that a long row of procedurals needs few rounds.
    const int most = 1 << std::min(++rounds_, 20);
    std::shared_ptr<const world::World> next = make && !numbers.empty() ? make(numbers, most) : nullptr;
    if (!next) {
        if (!pollStop()) throw std::runtime_error("procedurals that rays reached cannot be expanded");
        return false;
    }
    world::takeOver(*next, *world);
    earlier_ = counters();
    world = std::move(next);
    begin();
    std::fill(unfinished_.begin(), unfinished_.end(), uint8_t(0));
    return true;
}

bool Job::trace(int worker, std::span<const integrator::CameraRay> in, std::span<integrator::SampleResult> out) {
    Tracer& t = *tracers[size_t(worker)];
    bool whole = t.trace(in, out, &halt) && !halt;
    if (t.unfinished()) unfinished_[size_t(worker)] = 1;
    uint64_t now = totalRays(t.counters());
    rayTotal += now - rays[size_t(worker)];
    rays[size_t(worker)] = now;
    if (whole && !t.unfinished() && !(met && shone))
        for (const integrator::SampleResult& r : out) {
            if (!r.transmittance.empty() || (in[0].depthOnly && r.z < 1e38f)) met = shone = true; // depth renders need no light
            if (r.z < 1e38f || luminance(r.opacity) > 0) met = true;
            if (r.color.x != 0 || r.color.y != 0 || r.color.z != 0) shone = true;
        }
    return whole;
}

bool Job::pollStop() {
    aborted = aborted || (errorsAllowed && diagnostics.errors() > *errorsAllowed);
    if (aborted || (settings.stop && *settings.stop)) {
        interrupted = true;
        halt = 1;
    }
    return interrupted;
}

integrator::Counters Job::counters() const {
    integrator::Counters all = earlier_;
    for (const auto& t : tracers) all += t->counters();
    return all;
}

double Job::elapsed() const { return clockSeconds() - startSeconds; }

double clockSeconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

uint64_t totalRays(const integrator::Counters& c) { return c.camera + c.diffuse + c.specular + c.transmission + c.shadow; }

std::vector<Window> tilesOf(const Window& w, int side) {
    std::vector<Window> tiles;
    for (int y = w.y0; y < w.y1; y += side)
        for (int x = w.x0; x < w.x1; x += side) tiles.push_back({x, y, std::min(x + side, w.x1), std::min(y + side, w.y1)});
    return tiles;
}

} // namespace alpenglow::render
