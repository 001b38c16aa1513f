// The Muttenzer box through RSL against the oracle, a plain path tracer of the same box without a shading language.
// box_bench [--spp N] [--repeats N] [--threads N] [--size WxH] [--lanes N] [--ours 1]
// --ours 1: nothing but our own time, the least and the median; to compare two builds in turns and to profile.
#include "bench/box_embree.h"
#include "bench/box_oracle_runs.h"
#include "bench/profile.h"
#include "bsdf/sampling.h"
#include "integrator/integrator.h"
#include "render/rendering.h"
#include "ri/reader.h"
#include "scene/scene.h"
#include "world/impl.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>

using namespace alpenglow;

namespace {

double cpuSeconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

double median(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

struct Frames final : scene::FrameConsumer {
    std::shared_ptr<const scene::Frame> frame;
    void render(std::shared_ptr<const scene::Frame> f) override { frame = std::move(f); }
    void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&, const SourcePlace&) override {}
};

/// The box, ready to be rendered any number of times.
struct Box {
    Diagnostics diagnostics;
    render::RenderSettings settings;
    std::shared_ptr<const scene::Frame> frame;
    std::unique_ptr<render::Camera> camera;
    render::OutputPlan plan;
    std::shared_ptr<const world::World> world;
    render::Engine engine = render::transportEngine();

    bool load(int width, int height, int threads, int lanes) {
        Frames frames;
        ri::RibReader reader({}, frames, diagnostics);
        reader.readFile(ALPENGLOW_SOURCE_DIR "/examples/muttenzer_box.rib");
        if (!frames.frame) return false;
        auto mine = std::make_shared<scene::Frame>(*frames.frame);
        mine->options.xres = width;
        mine->options.yres = height;
        frame = mine;
        settings.threads = threads;
        settings.progress = render::ProgressMode::None;
        camera = std::make_unique<render::Camera>(frame->options, diagnostics);
        plan = render::planOutputs(frame->options, settings, true, "box.exr", diagnostics);
        world::Settings t;
        t.hider = world::Hider::Path;
        t.lanes = lanes;
        t.outputs = plan.engineOutputs;
        t.shaderPaths = {ALPENGLOW_SOURCE_DIR "/shaders"};
        world = integrator::buildWorld(frame, t, diagnostics);
        if (world) plan.resolve(world->outputWidths(), diagnostics);
        return world != nullptr;
    }

    struct Result {
        double cpu = 0, wall = 0, mean = 0;
        integrator::Counters counters;
    };
    Result render(uint32_t spp) {
        Result r;
        render::Progress progress(render::ProgressMode::None);
        render::FilmDescription d;
        d.width = camera->width();
        d.height = camera->height();
        d.window = camera->window();
        d.channels = render::filmChannels(plan);
        double cpu = cpuSeconds(), wall = render::clockSeconds();
        render::Film film(d);
        render::Job job(settings, *camera, plan, engine, world, settings.threads, progress, diagnostics);
        render::renderPath(job, film, {0, spp}, 0, {});
        r.cpu = cpuSeconds() - cpu;
        r.wall = render::clockSeconds() - wall;
        r.counters = job.counters();
        for (int y = 0; y < d.height; ++y)
            for (int x = 0; x < d.width; ++x) {
                Color c = film.mean(x, y);
                r.mean += (c.x + c.y + c.z) / 3 / (double(d.width) * d.height);
            }
        return r;
    }
};

/// Camera rays of the picture, or rays that leave what those met along a cosine lobe.
std::vector<accel::Ray> recordRays(const Box& box, const accel::Accel& accel, int bounces) {
    render::FilterSampler filter(box.plan.basis.filter);
    std::vector<accel::Ray> rays;
    for (int y = 0; y < box.camera->height(); ++y)
        for (int x = 0; x < box.camera->width(); ++x) {
            float w;
            integrator::CameraRay c = render::pathRay(*box.camera, filter, 0, x, y, 0, &w);
            accel::Ray r;
            r.org = c.origin;
            r.dir = c.direction;
            Sampler numbers(0, x, y);
            bool inside = true;
            for (int b = 0; b < bounces && inside; ++b) {
                accel::Hit h;
                inside = accel.intersect(r, h);
                if (!inside) break;
                geometry::SurfacePoint p = accel.point(h);
                Vec3 n = dot(p.n, r.dir) > 0 ? -p.n : p.n;
                r.dir = bsdf::Basis(n).toWorld(bsdf::sampleCosine(numbers.get2(uint32_t(b) + 1, 0, 0, 0)));
                r.org = geometry::offsetOrigin(p, r.dir);
            }
            if (inside) rays.push_back(r);
        }
    return rays;
}

double raysPerSecond(size_t n, int repeats, const std::function<void()>& once) {
    std::vector<double> t;
    for (int i = 0; i < repeats; ++i) {
        double begin = cpuSeconds();
        once();
        t.push_back(cpuSeconds() - begin);
    }
    return double(n) / median(t);
}

/// Which part of the work a symbol belongs to.
const char* partOf(const std::string& s) {
    auto has = [&](const char* what) { return s.find(what) != std::string::npos; };
    if (s == "[kernel code]") return "kernels";
    if (has("libembree") || has("5accel") || has("exactHits") || has("Quadric5roots") || has("Quadric6accept") ||
        has("solveQuadratic") || has("hitNormal") || has("vOf"))
        return "traversal";
    if (has("libc.so") || has("libm.so") || has("libgcc") || has("libstdc++")) return "C library (memory, sines)";
    if (has("8geometry")) return "points of hits and lights";
    if (has("7Sampler") || has("13SampleNumbers") || has("nestedS") || has("6render6nested") || has("6sobol") ||
        has("13FilterSampler") || has("6Camera") || has("7pathRay"))
        return "sampling, camera";
    if (has("4bsdf") || has("lobe") || has("Lobe") || has("4draw") || has("5value")) return "lobes";
    if (has("7shading5Batch") || has("12setFootprint")) return "filling batches";
    if (has("4Film") || has("6render")) return "film";
    if (has("9Scheduler") || has("10integrator") || has("8services") || has("5world"))
        return "scheduling, light samples, requests";
    return "other";
}

struct BenchArguments {
    int spp = 8, repeats = 5, threads = 1, width = 320, height = 240, lanes = 16, oursOnly = 0;
    double samples() const { return double(width) * height * spp; }
    bool valid() const { return spp >= 1 && repeats >= 1 && threads >= 1 && width >= 1 && height >= 1; }
};

BenchArguments argumentsOf(int argc, char** argv) {
    BenchArguments a;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (!std::strcmp(argv[i], "--spp")) a.spp = std::atoi(argv[i + 1]);
        else if (!std::strcmp(argv[i], "--repeats")) a.repeats = std::atoi(argv[i + 1]);
        else if (!std::strcmp(argv[i], "--threads")) a.threads = std::atoi(argv[i + 1]);
        else if (!std::strcmp(argv[i], "--lanes")) a.lanes = std::atoi(argv[i + 1]);
        else if (!std::strcmp(argv[i], "--ours")) a.oursOnly = std::atoi(argv[i + 1]);
        else if (!std::strcmp(argv[i], "--size")) std::sscanf(argv[i + 1], "%dx%d", &a.width, &a.height);
    }
    return a;
}

/// Nothing but our own time.
void printOurs(Box& box, const BenchArguments& a) {
    std::vector<double> t;
    for (int i = 0; i < a.repeats; ++i) t.push_back(box.render(uint32_t(a.spp)).cpu);
    std::printf("%.4f us a sample at the least, %.4f median\n", 1e6 * *std::min_element(t.begin(), t.end()) / a.samples(),
                1e6 * median(t) / a.samples());
}

/// Ours and the oracle in its forms.
void compareWithOracle(Box& box, const BenchArguments& a) {
    const double samples = a.samples();
    // The renderer plays roulette from the fourth hit on, by 1.5 sqrt(throughput); the oracle as it is from the sixth, by the
    // throughput. With 2 and the renderer's rule both send the same rays.
    bench::OracleRun same{a.width, a.height, uint32_t(a.spp), true, 2, true}, plain{a.width, a.height, uint32_t(a.spp), false, 4};
    std::vector<double> ours, wall, sequences, embree, twister, sums;
    double mean = 0, oracleMean = 0, embreeMean = 0;
    const bench::OracleRunner throughEmbree = bench::oracleThroughEmbree();
    Box::Result last = box.render(1);
    for (int i = 0; i < a.repeats; ++i) { // in turns, so that what else the machine does hits both alike
        last = box.render(uint32_t(a.spp));
        ours.push_back(last.cpu);
        wall.push_back(last.wall);
        mean = last.mean;
        double t = cpuSeconds();
        oracleMean = bench::runOracle(same, sums);
        sequences.push_back(cpuSeconds() - t);
        t = cpuSeconds();
        embreeMean = throughEmbree(same, sums);
        embree.push_back(cpuSeconds() - t);
        t = cpuSeconds();
        bench::runOracle(plain, sums);
        twister.push_back(cpuSeconds() - t);
    }
    auto ratios = [&](const std::vector<double>& oracle) {
        std::vector<double> r;
        for (size_t i = 0; i < ours.size(); ++i) r.push_back(oracle[i] / ours[i]);
        return median(r);
    };
    const integrator::Counters& c = last.counters;
    double ourRays = double(render::totalRays(c)) / samples;
    std::printf("Muttenzer box, %d x %d, %d samples a pixel, %d threads, %d lanes; CPU time, medians of %d\n", a.width, a.height,
                a.spp, a.threads, a.lanes, a.repeats);
    auto line = [&](const char* what, const std::vector<double>& t, double rays) {
        std::printf("  %-44s %7.3f us a sample  %8.0f samples/s  %5.2f rays a sample  %5.0f ns a ray\n", what,
                    1e6 * median(t) / samples, samples / median(t), rays, 1e9 * median(t) / samples / rays);
    };
    line("ours", ours, ourRays);
    line("oracle, our sequences, our roulette", sequences, bench::oracleRays(same));
    line("oracle through Embree, on our sequences", embree, bench::oracleRays(same));
    line("oracle, Mersenne twister, its own roulette", twister, bench::oracleRays(plain));
    std::printf("  ours / oracle, samples a second: %.3f on the same sequences with the same roulette; %.3f where the oracle "
                "meets through "
                "Embree; %.3f to the oracle as it is\n",
                ratios(sequences), ratios(embree), ratios(twister));
    std::printf(
        "  means %.5f, %.5f and through Embree %.5f; wall %.3f s, %.0f rays/ms; %.1f points a batch, %.0f %% of lanes busy\n",
        mean, oracleMean, embreeMean, median(wall), double(render::totalRays(c)) / median(wall) / 1e3,
        double(c.points) / double(c.batches), 100.0 * double(c.lanesUsed) / double(c.lanesRun));
}

/// Rays of the box through our structure and through Embree alone.
void compareRays(Box& box) {
    const accel::Accel& accel = static_cast<const world::WorldImpl&>(*box.world).accel();
    bench::BareEmbree bare(accel.shapes());
    for (int bounces : {0, 1, 3}) {
        std::vector<accel::Ray> rays = recordRays(box, accel, bounces);
        std::vector<accel::Hit> hits(rays.size());
        size_t met = 0, bareMet = 0;
        double a = raysPerSecond(rays.size(), 9, [&] { accel.intersect(rays, hits); });
        double b = raysPerSecond(rays.size(), 9, [&] { bareMet = bare.intersect(rays); });
        for (const accel::Hit& h : hits) met += h.valid();
        std::printf("  %s rays: ours %.2f M/s, bare Embree %.2f M/s, ratio %.2f (%zu and %zu of %zu meet something)\n",
                    bounces == 0   ? "camera"
                    : bounces == 1 ? "first bounce"
                                   : "third bounce",
                    a / 1e6, b / 1e6, a / b, met, bareMet, rays.size());
    }
}

/// Which part of the work takes how much of the time.
void printShares(Box& box, const BenchArguments& a) {
    bench::Profile profile;
    profile.start();
    double until = cpuSeconds() + 3;
    while (cpuSeconds() < until) box.render(uint32_t(a.spp));
    profile.stop();
    std::map<std::string, uint64_t> parts;
    uint64_t all = 0;
    for (const auto& [symbol, n] : profile.bySymbol()) {
        parts[partOf(symbol)] += n;
        all += n;
        if (std::getenv("BOX_BENCH_SYMBOLS")) std::printf("%8llu %s\n", static_cast<unsigned long long>(n), symbol.c_str());
    }
    std::printf("  shares of %llu samples of the processor:", static_cast<unsigned long long>(all));
    std::vector<std::pair<uint64_t, std::string>> order;
    for (const auto& [part, n] : parts) order.emplace_back(n, part);
    std::sort(order.rbegin(), order.rend());
    for (const auto& [n, part] : order)
        std::printf(" %s %.1f %%;", part.c_str(), 100.0 * double(n) / double(std::max<uint64_t>(all, 1)));
    std::printf("\n");
}

} // namespace

int main(int argc, char** argv) {
    const BenchArguments a = argumentsOf(argc, argv);
    if (!a.valid()) {
        std::fprintf(stderr, "box_bench [--spp N] [--repeats N] [--threads N] [--size WxH] [--lanes N] [--ours 1]\n");
        return 2;
    }
    Box box;
    if (!box.load(a.width, a.height, a.threads, a.lanes)) {
        for (const Diagnostic& d : box.diagnostics.all()) std::fprintf(stderr, "%s\n", toString(d).c_str());
        return 3;
    }
    if (a.oursOnly) {
        printOurs(box, a);
        return 0;
    }
    compareWithOracle(box, a);
    compareRays(box);
    printShares(box, a);
    return 0;
}
