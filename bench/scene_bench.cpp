// The scenes of bench/scenes: where their processor time goes, and how two programs compare on them.
//   scene_bench [OPTIONS] [SCENE ...]     --help lists both
#include "base/file.h"
#include "bench/profile.h"
#include "bench/scene_parts.h"
#include "bench/scene_set.h"
#include "render/progress.h"
#include "render/renderer.h"
#include "ri/reader.h"
#include "scene/scene.h"
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace alpenglow;

namespace {

constexpr const char* kUsage = R"(scene_bench [OPTIONS] [SCENE ...]     all scenes when none is named
  --folder DIR     where scenes are written to (default: build/release/bench_scenes)
  --write          only write them: `alpenglow render DIR/NAME.rib` renders one
  --spp N          samples a pixel instead of the scene's own
  --threads N      default 1
  --seed N         default 0
  --symbols N      also the N symbols that take most time
  --stages         also nanoseconds a sample by stage of the integrator (docs/architecture.md)
  --program A      whole programs instead of this one: run A on each scene, processor seconds from its --stats
  --against B      run A and B in turns; the median of the ratios of processor time, B / A (above 1: A is faster)
  --turns N        how often (default 5)
)";

struct Arguments {
    std::string folder = ALPENGLOW_BINARY_DIR "/bench_scenes", program, against;
    std::vector<std::string> scenes;
    int spp = 0, threads = 1, symbols = 0, turns = 5;
    uint64_t seed = 0;
    bool writeOnly = false, stages = false;
};

bool parse(int argc, char** argv, Arguments& a) {
    for (int i = 1; i < argc; ++i) {
        const std::string what = argv[i];
        if (what.rfind("--", 0) != 0) {
            a.scenes.push_back(what);
            continue;
        }
        if (what == "--write") {
            a.writeOnly = true;
            continue;
        }
        if (what == "--stages") {
            a.stages = true;
            continue;
        }
        if (++i >= argc) return false;
        if (what == "--folder") a.folder = argv[i];
        else if (what == "--program") a.program = argv[i];
        else if (what == "--against") a.against = argv[i];
        else if (what == "--spp") a.spp = std::atoi(argv[i]);
        else if (what == "--threads") a.threads = std::atoi(argv[i]);
        else if (what == "--symbols") a.symbols = std::atoi(argv[i]);
        else if (what == "--turns") a.turns = std::atoi(argv[i]);
        else if (what == "--seed") a.seed = uint64_t(std::atoll(argv[i]));
        else return false;
    }
    for (const std::string& s : a.scenes)
        if (std::none_of(bench::benchScenes().begin(), bench::benchScenes().end(), [&](const auto& b) { return s == b.name; })) {
            std::fprintf(stderr, "scene_bench: there is no scene %s; the scenes are", s.c_str());
            for (const auto& b : bench::benchScenes()) std::fprintf(stderr, " %s", b.name);
            std::fprintf(stderr, "\n");
            return false;
        }
    return a.spp >= 0 && a.threads > 0 && a.turns > 0 && (a.against.empty() || !a.program.empty());
}

struct Figures {
    double samples = 0, cpu = 0, rays = 0, points = 0, megabytes = 0, batch = 0, lanes = 0;
    bool compiled = false;
    std::array<double, bench::kParts> share{};
};

/// Renders a scene in this process and notes where it is from the first ray to the written picture.
bool renderHere(const Arguments& a, const std::string& name, int spp, Figures& f, std::map<std::string, uint64_t>& symbols) {
    Diagnostics diagnostics([](const Diagnostic& d) {
        if (d.severity >= Severity::Error) std::fprintf(stderr, "%s\n", toString(d).c_str());
    });
    render::RenderSettings s;
    s.output = a.folder + "/" + name + ".exr";
    s.threads = a.threads;
    s.spp = uint32_t(spp);
    s.seed = a.seed;
    s.allowWrite = true;
    s.shippedShaders = ALPENGLOW_SOURCE_DIR "/shaders";
    s.progress = render::ProgressMode::None;
    bench::Profile profile;
    render::Engine engine = render::transportEngine();
    engine.build = [&profile, build = engine.build](auto frame, const auto& settings, auto& d) {
        auto world = build(std::move(frame), settings, d);
        profile.start();
        return world;
    };
    render::Progress progress(render::ProgressMode::None);
    render::Renderer renderer(s, engine, diagnostics, progress);
    ri::ReaderOptions options;
    options.overrides = [&](scene::Options& o) { renderer.override(o); };
    const std::string file = a.folder + "/" + name + ".rib";
    renderer.setScene(file);
    ri::RibReader reader(options, renderer, diagnostics);
    reader.readFile(file);
    profile.stop();
    renderer.finish();
    const render::RenderStats r = renderer.stats();
    f.samples = double(r.width) * r.height * double(r.spp);
    f.cpu = r.cpuSec;
    f.rays = double(r.totalRays);
    f.points = double(r.shading.points);
    f.batch = r.shading.batches ? f.points / double(r.shading.batches) : 0;
    f.lanes = r.shading.laneOccupancy;
    f.megabytes = double(r.peakMemoryBytes) / 1e6;
    f.compiled = r.shading.cacheHits < r.shading.kernels;
    symbols = profile.bySymbol();
    double all = 0;
    for (const auto& [symbol, n] : symbols) {
        f.share[size_t(bench::partOfSymbol(symbol))] += double(n);
        all += double(n);
    }
    for (double& share : f.share) share /= std::max(all, 1.0);
    return renderer.outcome().rendered == 1 && !diagnostics.errors();
}

void printSymbols(const std::map<std::string, uint64_t>& symbols, int most) {
    std::vector<std::pair<uint64_t, std::string>> order;
    uint64_t all = 0;
    for (const auto& [symbol, n] : symbols) {
        order.emplace_back(n, symbol);
        all += n;
    }
    std::sort(order.rbegin(), order.rend());
    for (int i = 0; i < most && size_t(i) < order.size(); ++i)
        std::printf("    %5.1f %% %-9s %s\n", 100.0 * double(order[size_t(i)].first) / double(all),
                    bench::kPartNames[size_t(bench::partOfSymbol(order[size_t(i)].second))], order[size_t(i)].second.c_str());
}

void printStages(const std::map<std::string, uint64_t>& symbols, double nanoseconds) {
    std::array<uint64_t, bench::kStages> of{};
    uint64_t all = 0;
    for (const auto& [symbol, n] : symbols) {
        of[size_t(bench::stageOfSymbol(symbol))] += n;
        all += n;
    }
    for (size_t k = 0; k < of.size(); ++k)
        std::printf("    %-16s %7.1f ns a sample %5.1f %%\n", bench::kStageNames[k], nanoseconds * double(of[k]) / double(all),
                    100 * double(of[k]) / double(all));
}

void printHead() {
    std::printf("%-16s %8s %7s %7s %6s %5s %6s |", "scene", "ns/spl", "Mray/s", "Mpt/s", "pts/b", "lane", "MB");
    for (const char* part : bench::kPartNames) std::printf(" %9s", part);
    std::printf("  %% of the processor time\n");
}

/// One row; in a process of its own, so that the memory is the scene's.
bool printRow(const Arguments& a, const bench::BenchScene& scene) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        Figures f;
        std::map<std::string, uint64_t> symbols;
        const int spp = a.spp > 0 ? a.spp : scene.samples;
        bool fine = renderHere(a, scene.name, spp, f, symbols);
        if (fine && f.compiled)
            fine = renderHere(a, scene.name, spp, f, symbols); // shaders were compiled, partly while rendering
        if (fine) {
            std::printf("%-16s %8.1f %7.2f %7.2f %6.0f %5.2f %6.0f |", scene.name, 1e9 * f.cpu / f.samples, f.rays / f.cpu / 1e6,
                        f.points / f.cpu / 1e6, f.batch, f.lanes, f.megabytes);
            for (double share : f.share) std::printf(" %9.1f", 100 * share);
            std::printf("\n");
            if (a.stages) printStages(symbols, 1e9 * f.cpu / f.samples);
            printSymbols(symbols, a.symbols);
        }
        std::fflush(stdout);
        _exit(fine ? 0 : 1);
    }
    int status = 0;
    return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

struct ProgramRun {
    double cpu = 0, megabytes = 0, samples = 0; ///< seconds from the first ray on
};

/// Runs a program on a scene; cpu < 0 when it failed.
ProgramRun runProgram(const Arguments& a, const std::string& program, const bench::BenchScene& scene) {
    const std::string stats = a.folder + "/stats.json", picture = a.folder + "/program.exr",
                      rib = a.folder + "/" + scene.name + ".rib";
    const std::vector<std::string> words{program,
                                         "render",
                                         "-q",
                                         "--threads",
                                         std::to_string(a.threads),
                                         "--spp",
                                         std::to_string(a.spp > 0 ? a.spp : scene.samples),
                                         "--seed",
                                         std::to_string(a.seed),
                                         "--stats",
                                         stats,
                                         "-o",
                                         picture,
                                         rib};
    std::vector<char*> argv;
    for (const std::string& w : words) argv.push_back(const_cast<char*>(w.c_str()));
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        execv(argv[0], argv.data());
        std::perror(argv[0]);
        _exit(127);
    }
    int status = 0;
    ProgramRun r;
    r.cpu = -1;
    if (child < 0 || waitpid(child, &status, 0) != child || status != 0) return r;
    std::ifstream in(stats);
    const nlohmann::json j = nlohmann::json::parse(in, nullptr, false);
    if (j.is_discarded()) return r;
    r.cpu = j.value("cpuSec", -1.0);
    r.megabytes = j.value("peakMemoryBytes", 0.0) / 1e6;
    r.samples = j.value("width", 0.0) * j.value("height", 0.0) * j.value("spp", 0.0);
    return r;
}

double median(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v.empty() ? 0 : v[v.size() / 2];
}

bool compareRow(const Arguments& a, const bench::BenchScene& scene) {
    const bool two = !a.against.empty();
    for (const std::string& p : {a.program, a.against}) // both have their shaders in the cache before the first turn
        if (!p.empty() && runProgram(a, p, scene).cpu < 0) return false;
    std::vector<double> ratios, ours, theirs;
    ProgramRun x, y;
    for (int i = 0; i < a.turns; ++i) {
        x = runProgram(a, a.program, scene);
        if (two) y = runProgram(a, a.against, scene);
        if (x.cpu < 0 || y.cpu < 0) return false;
        ours.push_back(x.cpu);
        theirs.push_back(y.cpu);
        ratios.push_back(y.cpu / x.cpu);
    }
    std::printf("%-16s %9.1f ns a sample, %5.0f MB", scene.name, 1e9 * median(ours) / x.samples, x.megabytes);
    if (two) {
        std::sort(ratios.begin(), ratios.end());
        std::printf(" | %9.1f ns, %5.0f MB | %.3f times as fast (%.3f to %.3f)", 1e9 * median(theirs) / y.samples, y.megabytes,
                    median(ratios), ratios.front(), ratios.back());
    }
    std::printf("\n");
    std::fflush(stdout);
    return true;
}

} // namespace

int main(int argc, char** argv) {
    Arguments a;
    if (!parse(argc, argv, a)) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    Diagnostics diagnostics([](const Diagnostic& d) {
        if (d.severity >= Severity::Error) std::fprintf(stderr, "%s\n", toString(d).c_str());
    });
    bool fine = true, headed = !a.program.empty();
    for (const bench::BenchScene& scene : bench::benchScenes()) {
        if (!a.scenes.empty() && std::find(a.scenes.begin(), a.scenes.end(), scene.name) == a.scenes.end()) continue;
        if (!bench::writeBenchScene(scene.name, a.folder, 1, diagnostics)) {
            fine = false;
            continue;
        }
        if (a.writeOnly) continue;
        if (!headed) printHead();
        headed = true;
        const bool done = a.program.empty() ? printRow(a, scene) : compareRow(a, scene);
        if (!done) std::fprintf(stderr, "scene_bench: %s failed\n", scene.name);
        fine &= done;
    }
    return fine ? 0 : 1;
}
