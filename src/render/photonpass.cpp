#include "render/photonpass.h"
#include "base/hash.h"
#include "photonmap/limits.h"
#include "photonmap/photonmap.h"
#include "render/guidepass.h"
#include "scene/scene.h"
#include "world/photonmaps.h"
#include <algorithm>
#include <utility>

namespace alpenglow::render {

namespace {

constexpr uint32_t kBlock = 8192;      ///< photons in a task
constexpr uint64_t kBlocksAtOnce = 16; ///< of an emission, between counts of stored photons
constexpr size_t kBlocksOfPasses = 32; ///< of passes for samples, between counts of stored photons
constexpr float kWidth = .1f;          ///< radians: lobes with a smaller spread are followed
constexpr float kMostWidth = .5f;
constexpr uint64_t kDefaultEmit = 200000;
constexpr uint32_t kPilot = 0xffffffffu; ///< pass for finding caustics
constexpr int kTypical = 12;             ///< typical number of photons within the first radius, where they are dense

const scene::Param* hiderParam(const scene::Options& o, const char* name) {
    const scene::Param* p = scene::find(o.hiderParams, name);
    return p && !p->numbers.empty() ? p : nullptr;
}

/// Reduces photons to about `most` at random; the remaining ones carry the light of all.
void thin(std::vector<world::StoredPhoton>& stored, size_t most, uint32_t pass) {
    if (stored.size() <= most) return;
    const double part = double(most) / double(stored.size());
    std::erase_if(stored, [&](const world::StoredPhoton& s) {
        const uint64_t key = mix64(uint64_t(pass) << 32 | s.number) + s.photon.bounces;
        return double(mix64(key) >> 11) * 0x1p-53 >= part;
    });
    for (world::StoredPhoton& s : stored) s.photon.power /= float(part);
}

} // namespace

uint64_t photonsToEmit(const scene::Options& o, Diagnostics& d) {
    const scene::Param* p = hiderParam(o, "emit");
    if (!p)
        if (const auto i = o.values.find("photon:emit"); i != o.values.end() && !i->second.numbers.empty()) p = &i->second;
    if (!p || !(p->numbers[0] != 0)) return kDefaultEmit;
    const double n = p->numbers[0];
    if (!(n >= 1)) {
        d.report(Severity::Error, Rie::Range, p->place,
                 "\"emit\" is a number of photons, 1 or more; " + std::to_string(kDefaultEmit) + " are emitted");
        return kDefaultEmit;
    }
    if (n > double(limits::kPhotonsEmitted)) {
        d.report(Severity::Error, Rie::Limit, p->place,
                 "no more than " + std::to_string(limits::kPhotonsEmitted) + " photons are emitted; that many are");
        return limits::kPhotonsEmitted;
    }
    return uint64_t(n);
}

PhotonPasses::PhotonPasses(Job& job, std::shared_ptr<const world::World> world, const integrator::PhotonUse& use)
    : PhotonPasses(job, std::move(world), use, job.diagnostics) {}

PhotonPasses::PhotonPasses(Job& job, std::shared_ptr<const world::World> world, const integrator::PhotonUse& use, Diagnostics& d)
    : job_(job), diagnostics_(d), emission_(std::move(world), use, d), threads_(size_t(job.team.threads())) {}

integrator::PhotonEmission::Thread& PhotonPasses::thread(int worker) {
    auto& t = threads_[size_t(worker)];
    if (!t) t = std::make_unique<integrator::PhotonEmission::Thread>(emission_, diagnostics_);
    return *t;
}

bool PhotonPasses::emit(uint32_t pass, uint64_t count, std::vector<world::StoredPhoton>& stored, const std::string& what,
                        uint64_t* emitted) {
    const uint64_t blocks = (count + kBlock - 1) / kBlock;
    uint64_t done = 0;
    const auto showProgress = [&](double now) {
        if (what.empty()) return;
        ProgressState s;
        s.fraction = s.samplesDone = double(now) / double(blocks);
        s.samplesTotal = 1;
        job_.progress.update(s, what);
    };
    bool whole = true;
    for (; done < blocks && whole && !job_.pollStop(); done += kBlocksAtOnce) {
        const uint64_t now = std::min(kBlocksAtOnce, blocks - done);
        std::vector<std::vector<world::StoredPhoton>> of(now);
        whole = job_.team.run(
            now, &job_.halt,
            [&](int worker, size_t i) {
                const uint64_t first = (done + i) * kBlock;
                thread(worker).emit(pass, uint32_t(first), uint32_t(std::min<uint64_t>(kBlock, count - first)), 1, of[i],
                                    &job_.halt);
            },
            [&](size_t finished) {
                job_.pollStop();
                showProgress(double(done) + double(finished));
            });
        if (!whole) break;
        size_t more = stored.size();
        for (const auto& o : of) more += o.size();
        if (more > limits::kPhotons) {
            diagnostics_.report(Severity::Error, Rie::Limit, {},
                                "photon maps hold no more than " + std::to_string(limits::kPhotons) +
                                    " photons: emission ends after " + std::to_string(done * kBlock) + " of " +
                                    std::to_string(count),
                                "they carry the light of all lights, so maps are correct but coarser");
            break;
        }
        for (const auto& o : of) stored.insert(stored.end(), o.begin(), o.end());
    }
    job_.progress.clear();
    if (!whole || job_.interrupted) return false;
    *emitted = std::min(done * kBlock, count);
    for (world::StoredPhoton& s : stored) s.photon.power /= float(*emitted);
    return true;
}

/// Emits blocks begin to end - 1, counted over all passes from `first` on; returns the stored photons by block.
bool PhotonPasses::emitBlocks(uint32_t first, uint32_t count, size_t begin, size_t end,
                              std::vector<std::vector<world::StoredPhoton>>& of) {
    const size_t blocks = (count + kBlock - 1) / kBlock;
    of.assign(end - begin, {});
    return job_.team.run(
        of.size(), &job_.halt,
        [&](int worker, size_t i) {
            const size_t block = begin + i;
            const uint32_t at = uint32_t(block % blocks) * kBlock;
            thread(worker).emit(first + uint32_t(block / blocks), at, std::min(kBlock, count - at), count, of[i], &job_.halt);
        },
        [&](size_t) { job_.pollStop(); });
}

bool PhotonPasses::emit(uint32_t first, uint32_t passes, uint32_t count, size_t most,
                        const std::function<void(uint32_t, std::vector<world::StoredPhoton>)>& take) {
    const size_t blocks = (count + kBlock - 1) / kBlock;
    // Combines small passes, so that all threads have work, and divides large ones. The division depends on nothing else, so a
    // pass is independent of what is emitted with it.
    const size_t together = std::max<size_t>(1, kBlocksOfPasses / blocks);
    std::vector<std::vector<world::StoredPhoton>> of;
    for (uint32_t pass = 0; pass < passes; pass += uint32_t(together)) {
        const size_t now = std::min<size_t>(together, passes - pass);
        std::vector<world::StoredPhoton> stored;
        for (size_t done = 0; done < blocks * now;) {
            const size_t end = now > 1 || blocks <= kBlocksOfPasses ? blocks * now : std::min(done + kBlocksOfPasses, blocks);
            if (!emitBlocks(first + pass, count, done, end, of)) return false;
            for (size_t i = done; i < end; ++i) {
                stored.insert(stored.end(), of[i - done].begin(), of[i - done].end());
                of[i - done] = {};
                if ((i + 1) % blocks != 0) continue;
                const uint32_t whole = pass + uint32_t(i / blocks);
                thin(stored, most, first + whole);
                take(whole, std::exchange(stored, {}));
            }
            done = end;
            if (stored.size() <= most || done >= blocks) continue;
            const uint32_t emitted = uint32_t(done) * kBlock;
            for (world::StoredPhoton& s : stored) s.photon.power *= float(count) / float(emitted);
            diagnostics_.reportOnce("photonsatrest",
                                    {Severity::Warning,
                                     Rie::Limit,
                                     {},
                                     "more than " + std::to_string(most) + " photons of a pass were stored: it ends after " +
                                         std::to_string(emitted) + " of " + std::to_string(count),
                                     "they carry the light of all lights, so caustics are correct but coarser",
                                     {}});
            thin(stored, most, first + pass);
            take(pass, std::exchange(stored, {}));
            break;
        }
    }
    return true;
}

float PhotonPasses::travel() const {
    float most = 0;
    for (const auto& t : threads_)
        if (t) most = std::max(most, t->travel());
    return most;
}

bool CausticPasses::asked(const scene::Options& o) {
    const scene::Param* p = hiderParam(o, "caustics");
    return p && p->numbers[0] != 0;
}

CausticPasses::CausticPasses(Job& job) : job_(job) {}

/// Finds origin and size of caustics by photons that are not gathered. Returns false if stopped.
bool CausticPasses::begin() {
    const scene::Options& o = job_.world->frame().options;
    begun_ = true;
    if (!asked(o)) {
        forgetLearned(job_); // of another part of the same world, in the viewer: pilot paths would follow it
        return learnCaustics(job_) && learnSeeds(job_) && learnLights(job_) && learnBrightness(job_);
    }
    if (!job_.world->photons()) return true;
    // One photon for four pixels of the complete picture, so that a crop equals that part of the picture.
    const double pixels = double(std::max(o.xres, 1)) * double(std::max(o.yres, 1));
    count_ = uint32_t(std::clamp(pixels / 4, double(1u << 12), double(1u << 18)));
    if (const scene::Param* p = hiderParam(o, "emit")) {
        if (!(p->numbers[0] >= 1) || p->numbers[0] > float(limits::kPhotonsOfPass))
            job_.diagnostics.report(Severity::Error, Rie::Range, p->place,
                                    "a pass emits 1 to " + std::to_string(limits::kPhotonsOfPass) + " photons");
        count_ = uint32_t(std::clamp(double(p->numbers[0]), 1.0, double(limits::kPhotonsOfPass)));
    }
    auto passes = std::make_unique<PhotonPasses>(job_, job_.world, integrator::PhotonUse{true, false, true, widthOf(o)});
    if (!passes->emission().lights()) return true;
    std::vector<world::StoredPhoton> found;
    const auto take = [&](uint32_t, std::vector<world::StoredPhoton> stored) { found = std::move(stored); };
    const uint32_t pilot = std::clamp(count_ * 4, 1u << 14, 1u << 17);
    if (!passes->emit(kPilot, 1, pilot, limits::kPhotonsAtRest, take)) return false;
    if (found.empty()) return true; // then paths sample what there is
    passes->emission().learn(found, kPilot, pilot);
    if (!passes->emit(0, 1, count_, limits::kPhotonsAtRest, take)) return false;
    std::vector<photonmap::Photon> some;
    for (const world::StoredPhoton& s : found) some.push_back(s.photon);
    found = {};
    radius_ = photonmap::typicalDistance(photonmap::PhotonMap(std::move(some)), kTypical, 128);
    if (!(radius_ > 0)) return true;
    moves_ = passes->emission().moves();
    if (moves_) {
        const photonmap::MovingStart start = photonmap::movingStart(radius_, passes->travel());
        radius_ = start.radius;
        window_ = start.window;
    }
    passes->emission().markPhotonLights();
    passes_ = std::move(passes);
    return true;
}

/// Hider "path" "causticwidth": radians, 0 to kMostWidth.
float CausticPasses::widthOf(const scene::Options& o) {
    const scene::Param* p = hiderParam(o, "causticwidth");
    if (!p) return kWidth;
    if (!(p->numbers[0] >= 0 && p->numbers[0] <= kMostWidth))
        job_.diagnostics.report(Severity::Error, Rie::Range, p->place, "\"causticwidth\" must be an angle of 0 to 0.5 radians");
    return p->numbers[0] >= 0 ? std::min(float(p->numbers[0]), kMostWidth) : 0;
}

bool CausticPasses::ready(uint32_t first, uint32_t count) {
    if (!prepare()) return false;
    if (!passes_) return true;
    std::vector<std::unique_ptr<photonmap::PhotonGrid>> grids(count);
    const auto take = [&](uint32_t pass, std::vector<world::StoredPhoton> stored) {
        std::vector<photonmap::Photon> all;
        std::vector<float> times;
        all.reserve(stored.size());
        for (const world::StoredPhoton& s : stored) all.push_back(s.photon);
        if (moves_)
            for (const world::StoredPhoton& s : stored) times.push_back(s.time);
        stored = {};
        const float radius = photonmap::radiusOfPass(radius_, first + pass);
        grids[pass] = std::make_unique<photonmap::PhotonGrid>(std::move(all), radius, times, window_ * (radius / radius_));
    };
    world::setPhotonPasses(*job_.world, first, {}); // photons of earlier samples are freed first
    if (!passes_->emit(first, count, count_, limits::kPhotonsAtRest, take)) return false;
    world::setPhotonPasses(*job_.world, first, std::move(grids));
    return true;
}

} // namespace alpenglow::render
