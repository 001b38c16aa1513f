// Nanoseconds of CPU time a point for shader files, one thread: rsl_bench [--lanes N] [--vectors N] [--ir] shader.sl...
// The 65,536 points of a grid over the unit square are shaded again and again, in batches of 4,096 (what a scheduler hands to a
// kernel, and what the caches hold); the best of several runs counts. The mean of the first output's first component shows that
// work was done.
#include "rsl/compiler.h"
#include "rsl/evaluate.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>

using namespace alpenglow;
using namespace alpenglow::rsl;

namespace {

double cpuSeconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

constexpr int kSide = 256, kPoints = kSide * kSide, kBatch = 4096;
constexpr int kStride = kPoints + 64; // no power of two: rows would fall on each other in the caches

float* rows(int n) {
    auto* p = static_cast<float*>(std::aligned_alloc(64, size_t(std::max(1, n)) * kStride * 4));
    std::fill(p, p + size_t(std::max(1, n)) * kStride, 0.0f);
    return p;
}

} // namespace

int main(int argc, char** argv) {
    KernelOptions options;
    bool ir = false;
    std::vector<std::string> files;
    for (int i = 1; i < argc; i++) {
        if (!std::strcmp(argv[i], "--lanes") && i + 1 < argc) options.lanes = std::atoi(argv[++i]);
        else if (!std::strcmp(argv[i], "--vectors") && i + 1 < argc) options.vectors = std::atoi(argv[++i]);
        else if (!std::strcmp(argv[i], "--ir")) ir = true;
        else files.push_back(argv[i]);
    }
    Diagnostics diagnostics([](const Diagnostic& d) { std::fputs(toString(d).c_str(), stderr); });
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    for (const auto& f : files) {
        auto shader = compiler.load(f, {"."}, diagnostics);
        if (!shader) return 1;
        if (ir) std::fputs(compiler.dump(shader, options, diagnostics, true).c_str(), stdout);
        const double before = compiler.statistics().seconds;
        auto kernel = compiler.kernel(shader, options, diagnostics);
        if (!kernel) return 1;
        const double compileMs = 1e3 * (compiler.statistics().seconds - before);
        const auto defaults = compiler.parameterValues(shader, diagnostics);
        std::vector<const float*> in;
        std::vector<float*> out;
        for (const auto& i : kernel->inputs()) {
            const int parts = inputParts(i), components = ir::components(i.kind);
            float* p = rows(components * parts * std::max(1, i.array));
            for (const auto& d : defaults)
                if (i.name == "param:" + d.name) std::copy(d.numbers.begin(), d.numbers.end(), p);
            if (i.name.rfind("param:", 0) != 0)
                for (int c = 0; c < components; c++)
                    for (int part = 0; part < parts; part++)
                        for (int n = 0; n < kPoints; n++) {
                            float v = 0;
                            EvaluationPoint::value(i.name, c, part, v);
                            if (part == 0 && (i.name == "u" || i.name == "s")) v = (float(n % kSide) + 0.5f) / kSide;
                            if (part == 0 && (i.name == "v" || i.name == "t")) v = (float(n / kSide) + 0.5f) / kSide;
                            if (part == 0 && (i.name == "du" || i.name == "dv")) v = 1.0f / kSide;
                            p[i.uniform ? c : (c * parts + part) * kStride + n] = v;
                        }
            in.push_back(p);
        }
        for (const auto& o : kernel->outputs()) out.push_back(rows(ir::components(o.kind)));
        KernelCall call{};
        std::vector<const float*> from(in.size());
        call.in = from.data();
        call.out = out.data();
        call.n = kBatch;
        call.stride = kStride;
        call.strings = kernel->strings().data();
        const auto shade = [&](int first) { // every batch writes to the same place, as a renderer's would
            for (size_t k = 0; k < in.size(); k++) from[k] = in[k] + (kernel->inputs()[k].uniform ? 0 : first);
            kernel->run(&call);
        };
        double sum = 0;
        for (int first = 0; first < kPoints; first += kBatch) {
            shade(first);
            for (int n = 0; n < kBatch; n++) sum += double(out[0][n]);
        }
        double best = 1e9;
        for (int trial = 0; trial < 20; trial++) {
            const double t0 = cpuSeconds();
            int repeats = 0;
            do {
                for (int first = 0; first < kPoints; first += kBatch) shade(first);
                repeats++;
            } while (cpuSeconds() - t0 < 0.01);
            best = std::min(best, (cpuSeconds() - t0) / (double(repeats) * kPoints));
        }
        std::printf("%-24s %3d points a strip  %7.2f ns/point  compiled in %6.1f ms  mean red %.6f\n",
                    std::filesystem::path(f).stem().string().c_str(), kernel->lanes(), best * 1e9, compileMs, sum / kPoints);
    }
    return 0;
}
