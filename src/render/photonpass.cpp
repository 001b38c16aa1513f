#include "render/photonpass.h"
#include "photons/limits.h"
#include "photons/photonmap.h"
#include <algorithm>

namespace alpenglow::render {

namespace {

constexpr uint32_t kBlock = 8192;        ///< photons of a task
constexpr uint64_t kBlocksAtOnce = 16;   ///< of an emission, before what came to rest is counted
constexpr uint64_t kDefaultEmit = 200000;
constexpr uint32_t kPilot = 0xffffffffu; ///< pass by which caustics are found
constexpr int kTypical = 12;             ///< photons within the first radius, about, where they are dense

const scene::Param* hiderParam(const scene::Options& o, const char* name) {
    const scene::Param* p = scene::find(o.hiderParams, name);
    return p && !p->numbers.empty() ? p : nullptr;
}

} // namespace

uint64_t photonsToEmit(const scene::Options& o, Diagnostics& d) {
    const scene::Param* p = hiderParam(o, "emit");
    if (!p)
        if (const auto i = o.values.find("photon:emit"); i != o.values.end() && !i->second.numbers.empty()) p = &i->second;
    if (!p || !(p->numbers[0] != 0)) return kDefaultEmit;
    const double n = p->numbers[0];
    if (!(n >= 1)) {
        d.report(Severity::Error, Rie::Range, p->place, "\"emit\" is a number of photons, 1 or more; " + std::to_string(kDefaultEmit) + " are emitted");
        return kDefaultEmit;
    }
    if (n > double(limits::kPhotonsEmitted)) {
        d.report(Severity::Error, Rie::Limit, p->place,
                 "no more than " + std::to_string(limits::kPhotonsEmitted) + " photons are emitted; that many are");
        return limits::kPhotonsEmitted;
    }
    return uint64_t(n);
}

PhotonPasses::PhotonPasses(Job& job, std::shared_ptr<const transport::World> world, const transport::PhotonUse& use)
    : job_(job), emission_(std::move(world), use, job.diagnostics), threads_(size_t(job.team.threads())) {}

transport::PhotonEmission::Thread& PhotonPasses::thread(int worker) {
    auto& t = threads_[size_t(worker)];
    if (!t) t = std::make_unique<transport::PhotonEmission::Thread>(emission_, job_.diagnostics);
    return *t;
}

bool PhotonPasses::emit(uint32_t pass, uint64_t count, std::vector<transport::StoredPhoton>& stored, const std::string& what,
                        uint64_t* emitted) {
    const uint64_t blocks = (count + kBlock - 1) / kBlock;
    uint64_t done = 0;
    const auto tell = [&](double now) {
        if (what.empty()) return;
        ProgressState s;
        s.fraction = s.samplesDone = double(now) / double(blocks);
        s.samplesTotal = 1;
        job_.progress.update(s, what);
    };
    bool whole = true;
    for (; done < blocks && whole && !job_.pollStop(); done += kBlocksAtOnce) {
        const uint64_t now = std::min(kBlocksAtOnce, blocks - done);
        std::vector<std::vector<transport::StoredPhoton>> of(now);
        whole = job_.team.run(
            now, &job_.halt,
            [&](int worker, size_t i) {
                const uint64_t first = (done + i) * kBlock;
                thread(worker).emit(pass, uint32_t(first), uint32_t(std::min<uint64_t>(kBlock, count - first)), 1, of[i], &job_.halt);
            },
            [&](size_t finished) {
                job_.pollStop();
                tell(double(done) + double(finished));
            });
        if (!whole) break;
        size_t more = stored.size();
        for (const auto& o : of) more += o.size();
        if (more > limits::kPhotons) {
            job_.diagnostics.report(Severity::Error, Rie::Limit, {},
                                    "photon maps hold no more than " + std::to_string(limits::kPhotons) + " photons: emission ends after " +
                                        std::to_string(done * kBlock) + " of " + std::to_string(count),
                                    "they share the light of all lights, so maps are right, and coarser");
            break;
        }
        for (const auto& o : of) stored.insert(stored.end(), o.begin(), o.end());
    }
    job_.progress.clear();
    if (!whole || job_.interrupted) return false;
    *emitted = std::min(done * kBlock, count);
    for (transport::StoredPhoton& s : stored) s.photon.power /= float(*emitted);
    return true;
}

bool PhotonPasses::emit(uint32_t first, uint32_t passes, uint32_t count, std::vector<std::vector<transport::StoredPhoton>>& stored) {
    const size_t blocks = (count + kBlock - 1) / kBlock;
    std::vector<std::vector<transport::StoredPhoton>> of(blocks * passes);
    const bool whole = job_.team.run(
        of.size(), &job_.halt,
        [&](int worker, size_t i) {
            const uint32_t begin = uint32_t(i % blocks) * kBlock;
            thread(worker).emit(first + uint32_t(i / blocks), begin, std::min(kBlock, count - begin), count, of[i], &job_.halt);
        },
        [&](size_t) { job_.pollStop(); });
    stored.assign(passes, {});
    for (size_t i = 0; i < of.size() && whole; ++i) {
        auto& to = stored[i / blocks];
        to.insert(to.end(), of[i].begin(), of[i].end());
    }
    return whole;
}

bool CausticPasses::asked(const scene::Options& o) {
    const scene::Param* p = hiderParam(o, "caustics");
    return p && p->numbers[0] != 0;
}

CausticPasses::CausticPasses(Job& job) : job_(job) {}

/// Where caustics come from, and how large they are: by photons that nobody gathers. False: stopped.
bool CausticPasses::begin() {
    const scene::Options& o = job_.world->frame().options;
    begun_ = true;
    if (!asked(o) || !job_.world->photons()) return true;
    // One photon for four pixels, of the whole picture: a crop shows what the picture shows.
    const double pixels = double(std::max(o.xres, 1)) * double(std::max(o.yres, 1));
    count_ = uint32_t(std::clamp(pixels / 4, double(1u << 12), double(1u << 18)));
    if (const scene::Param* p = hiderParam(o, "emit")) {
        if (!(p->numbers[0] >= 1) || p->numbers[0] > float(limits::kPhotonsOfPass))
            job_.diagnostics.report(Severity::Error, Rie::Range, p->place,
                                    "a pass emits 1 to " + std::to_string(limits::kPhotonsOfPass) + " photons");
        count_ = uint32_t(std::clamp(double(p->numbers[0]), 1.0, double(limits::kPhotonsOfPass)));
    }
    auto passes = std::make_unique<PhotonPasses>(job_, job_.world, transport::PhotonUse{true, false, true});
    if (!passes->emission().lights()) return true;
    std::vector<std::vector<transport::StoredPhoton>> found;
    const uint32_t pilot = std::clamp(count_ * 4, 1u << 14, 1u << 17);
    if (!passes->emit(kPilot, 1, pilot, found)) return false;
    if (found[0].empty()) return true; // then paths find what there is
    passes->emission().learn(found[0], kPilot, pilot);
    if (!passes->emit(0, 1, count_, found)) return false;
    std::vector<photons::Photon> some;
    for (const transport::StoredPhoton& s : found[0]) some.push_back(s.photon);
    radius_ = photons::typicalDistance(photons::PhotonMap(std::move(some)), kTypical, 128);
    if (!(radius_ > 0)) return true;
    passes->emission().tellLights();
    passes_ = std::move(passes);
    return true;
}

bool CausticPasses::ready(uint32_t first, uint32_t count) {
    if (!begun_ && !begin()) return false;
    if (!passes_) return true;
    std::vector<std::vector<transport::StoredPhoton>> stored;
    if (!passes_->emit(first, count, count_, stored)) return false;
    std::vector<std::unique_ptr<photons::PhotonGrid>> grids(count);
    StopFlag go{0};
    job_.team.run(
        count, &go,
        [&](int, size_t i) {
            std::vector<photons::Photon> all;
            all.reserve(stored[i].size());
            for (const transport::StoredPhoton& s : stored[i]) all.push_back(s.photon);
            stored[i] = {};
            grids[i] = std::make_unique<photons::PhotonGrid>(std::move(all), photons::radiusOfPass(radius_, first + uint32_t(i)));
        },
        [](size_t) {});
    transport::setPhotonPasses(*job_.world, first, std::move(grids));
    return true;
}

} // namespace alpenglow::render
