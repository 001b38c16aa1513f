// Rays of a scene by kind, traced by us and by Embree in turns: nanoseconds of CPU a ray, one thread, the least of all turns.
// ray_bench [--repeats N] [--rays N] [--kind NAME] [--ours] [--builds N] FILE.rib ...
// --ours: without Embree. --builds: no rays, but what it takes to build shapes and the tree, the least of N.
// The scenes: those of ../shared/bench/cycles, where they are, and examples/muttenzer_box.rib.
#include "bench/box_embree.h"
#include "bench/ray_set.h"
#include "geometry/build.h"
#include "geometry/dice.h"
#include "ri/reader.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <sys/resource.h>

using namespace alpenglow;

namespace {

struct Arguments {
    int repeats = 5;
    size_t rays = 60'000;
    std::string kind;
    bool ours = false;
    int builds = 0;
    std::vector<std::string> files;
};

double cpuSeconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

struct Frames final : scene::FrameConsumer {
    std::shared_ptr<const scene::Frame> frame;
    void render(std::shared_ptr<const scene::Frame> f) override { frame = std::move(f); }
    void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&, const SourcePlace&) override {}
};

double clockSeconds() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

template <class F> void timed(double& least, F f) {
    const double begin = cpuSeconds();
    f();
    least = std::min(least, cpuSeconds() - begin);
}

struct Services {
    std::vector<accel::Hit> hits;
    std::vector<uint8_t> met;
};

void trace(const accel::Accel& accel, const bench::RaysOfKind& k, bool together, Services& out) {
    constexpr size_t kSlice = 512;
    const std::span<const accel::Ray> rays(k.rays);
    for (size_t i = 0; i < rays.size(); i += kSlice) {
        const size_t n = std::min(kSlice, rays.size() - i);
        if (k.any) accel.occluded(rays.subspan(i, n), std::span(out.met).subspan(i, n));
        else if (together) accel.intersectTogether(rays.subspan(i, n), std::span(out.hits).subspan(i, n));
        else accel.intersect(rays.subspan(i, n), std::span(out.hits).subspan(i, n));
    }
}

/// Of all that is answered, to the bit.
uint64_t digestOf(const Services& a) {
    uint64_t d = 0;
    const auto take = [&](uint64_t bits) { d = (d ^ bits) * 0x9e3779b97f4a7c15u, d ^= d >> 29; };
    for (const accel::Hit& h : a.hits) {
        if (!h.valid()) {
            take(1);
            continue;
        }
        take(std::bit_cast<uint64_t>(h.distance));
        take(uint64_t(h.shape) << 32 | h.prim);
        take(std::bit_cast<uint64_t>(h.b1));
        take(std::bit_cast<uint64_t>(h.b2));
    }
    for (const uint8_t m : a.met) take(m);
    return d;
}

/// Rays of which ours and Embree's answers differ by more than floats do.
size_t differing(const bench::RaysOfKind& k, const Services& a, const std::vector<float>& t, const std::vector<uint8_t>& met) {
    size_t n = 0;
    for (size_t i = 0; i < k.rays.size(); ++i)
        if (k.any) n += (a.met[i] != 0) != (met[i] != 0);
        else if (a.hits[i].valid() != std::isfinite(t[i])) ++n;
        else n += a.hits[i].valid() && std::fabs(a.hits[i].t - t[i]) > 1e-4f * (1 + t[i]);
    return n;
}

void measure(const accel::Accel& accel, const bench::BareEmbree* embree, const std::string& name, const bench::RaysOfKind& k,
             int repeats) {
    const size_t n = k.rays.size();
    Services a;
    std::vector<float> t(k.any ? 0 : n);
    std::vector<uint8_t> met(k.any ? n : 0);
    (k.any ? a.met.resize(n) : a.hits.resize(n));
    double ours = INFINITY, theirs = INFINITY;
    for (int i = 0; i < repeats; ++i) {
        timed(ours, [&] { trace(accel, k, name == "camera", a); });
        if (embree) timed(theirs, [&] { k.any ? embree->occluded(k.rays, met.data()) : embree->intersect(k.rays, t.data()); });
    }
    size_t hit = 0;
    for (const accel::Hit& h : a.hits) hit += h.valid();
    for (const uint8_t m : a.met) hit += m != 0;
    std::printf("| %-9s | %7zu | %4.0f %% | %6.0f |", name.c_str(), n, 100 * double(hit) / double(n), 1e9 * ours / double(n));
    if (embree) std::printf(" %6.0f | %5.2f | %5zu |", 1e9 * theirs / double(n), theirs / ours, differing(k, a, t, met));
    std::printf(" %016llx\n", static_cast<unsigned long long>(digestOf(a)));
    std::fflush(stdout);
}

double peakMebibytes() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return double(used.ru_maxrss) / 1024;
}

/// Least seconds, of the clock and of CPU.
struct Least {
    double clock = INFINITY, cpu = INFINITY;
    template <class F> void of(F f) {
        const double c = clockSeconds(), p = cpuSeconds();
        f();
        clock = std::min(clock, clockSeconds() - c);
        cpu = std::min(cpu, cpuSeconds() - p);
    }
};

std::vector<geometry::ShapeRef> shapesOf(const scene::Frame& frame, Diagnostics& diag) {
    std::vector<geometry::ShapeRef> shapes = geometry::buildShapes(frame, diag);
    geometry::DiceOptions dice;
    dice.camera = geometry::DiceCamera::from(frame.options);
    geometry::diceShapes(shapes, dice, diag);
    return shapes;
}

/// Memory is what the process held at most, before and behind all builds.
void measureBuilds(const std::string& file, const scene::Frame& frame, int times, Diagnostics& diag) {
    Least shape, tree;
    const double before = peakMebibytes();
    for (int i = 0; i < times; ++i) {
        std::vector<geometry::ShapeRef> shapes;
        shape.of([&] { shapes = shapesOf(frame, diag); });
        std::unique_ptr<accel::Accel> accel;
        tree.of([&] { accel = std::make_unique<accel::Accel>(std::move(shapes), std::vector<uint32_t>(), diag); });
    }
    std::printf("%s: shapes %.3f s (CPU %.3f), tree %.3f s (CPU %.3f), memory %.0f to %.0f MiB\n", file.c_str(), shape.clock,
                shape.cpu, tree.clock, tree.cpu, before, peakMebibytes());
}

bool measureScene(const std::string& file, const Arguments& arguments) {
    Diagnostics diag;
    Frames frames;
    ri::RibReader reader({}, frames, diag);
    reader.readFile(file);
    if (!frames.frame) {
        for (const Diagnostic& d : diag.all()) std::fprintf(stderr, "%s\n", toString(d).c_str());
        return false;
    }
    if (arguments.builds > 0) {
        measureBuilds(file, *frames.frame, arguments.builds, diag);
        return true;
    }
    const std::vector<geometry::ShapeRef> shapes = shapesOf(*frames.frame, diag);
    double built = INFINITY, theirs = INFINITY;
    std::unique_ptr<accel::Accel> accel;
    timed(built, [&] { accel = std::make_unique<accel::Accel>(shapes, std::vector<uint32_t>(), diag); });
    const double peak = peakMebibytes();
    std::unique_ptr<bench::BareEmbree> embree;
    if (!arguments.ours) timed(theirs, [&] { embree = std::make_unique<bench::BareEmbree>(shapes); });
    std::printf("\n%s: built in %.2f s of CPU (peak memory %.0f MiB)", file.c_str(), built, peak);
    if (embree) std::printf(", Embree's scene in %.2f s", theirs);
    std::printf("\n| kind | rays | met | ours, ns |%s digest\n", embree ? " Embree, ns | Embree / ours | differ |" : "");
    for (const auto& [name, k] : bench::raysOf(*frames.frame, *accel, arguments.rays, diag))
        if (arguments.kind.empty() || arguments.kind == name) measure(*accel, embree.get(), name, k, arguments.repeats);
    return true;
}

} // namespace

int main(int argc, char** argv) {
    Arguments a;
    for (int i = 1; i < argc; ++i) {
        const auto value = [&] { return i + 1 < argc ? argv[++i] : ""; };
        if (!std::strcmp(argv[i], "--repeats")) a.repeats = std::max(1, std::atoi(value()));
        else if (!std::strcmp(argv[i], "--rays")) a.rays = size_t(std::max(1, std::atoi(value())));
        else if (!std::strcmp(argv[i], "--kind")) a.kind = value();
        else if (!std::strcmp(argv[i], "--builds")) a.builds = std::max(1, std::atoi(value()));
        else if (!std::strcmp(argv[i], "--ours")) a.ours = true;
        else a.files.emplace_back(argv[i]);
    }
    bool all = !a.files.empty();
    if (!all) std::fprintf(stderr, "ray_bench: name RIB files, such as examples/muttenzer_box.rib\n");
    for (const std::string& f : a.files) all = measureScene(f, a) && all;
    return all ? 0 : 3;
}
