// The patterns of the shaders named, through `alpenglow shade --iterations`, against the same mathematics written by hand: scalar
// C++ with the vectorisers off, and vector types. CPU time, one thread; the contestants take turns. A figure is the best of its
// turn; a ratio is the median over the turns, because the clock rate of a busy machine changes from one to the next.
//   pattern_bench [--program PATH] [--lanes 16|8] [--turns N] shader.sl...
// Prints, for every shader, ns a point and two ratios, and compares the pictures. Exit 1 when a ratio misses its limit.
#include "display/imageio.h"
#include "patterns.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <unistd.h>
#include <vector>

using namespace alpenglow;
using namespace alpenglow::bench;

namespace {

constexpr int kSide = 64, kPoints = kSide * kSide; // what `shade --format 64x64 --iterations` runs over
constexpr int kStride = kPoints + 64;              // no power of two: rows would fall on each other in the caches
constexpr double kScalarLimit = 5, kVectorLimit = 0.8;

double cpuSeconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

struct Batch {
    std::unique_ptr<float, decltype(&std::free)> memory{static_cast<float*>(std::aligned_alloc(64, size_t(10) * kStride * 4)),
                                                        &std::free};
    Points points{};
    Batch() {
        float* row[10];
        for (int k = 0; k < 10; k++) row[k] = memory.get() + k * kStride;
        for (int i = 0; i < kPoints; i++) {
            row[0][i] = (float(i % kSide) + 0.5f) / kSide;
            row[1][i] = (float(i / kSide) + 0.5f) / kSide;
            row[2][i] = row[3][i] = 1.0f / kSide;
        }
        points = {row[0], row[1], row[2], row[3], {row[4], row[5], row[6], row[7], row[8], row[9]}, kPoints};
    }
};

Pattern find(const NamedPattern* list, const std::string& name) {
    for (; list->name; list++)
        if (name == list->name) return list->run;
    return nullptr;
}

/// ns a point, the best of what 20 ms hold.
double measure(Pattern f, const Points& p) {
    double best = 1e9;
    const double start = cpuSeconds();
    do {
        const double t = cpuSeconds();
        f(p);
        best = std::min(best, cpuSeconds() - t);
    } while (cpuSeconds() - start < 0.02);
    return best * 1e9 / kPoints;
}

/// ns a point as the program prints it; negative: it did not.
double measureProgram(const std::string& program, const std::string& shader, int lanes, const std::string& picture) {
    const std::string command = "'" + program + "' shade '" + shader + "' -o '" + picture + "' --format 64x64 --lanes " +
                                std::to_string(lanes) + " --iterations 400";
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return -1;
    char line[256];
    double ns = -1;
    while (std::fgets(line, sizeof line, pipe))
        if (std::strstr(line, "ns a point")) ns = std::atof(line);
    return pclose(pipe) == 0 ? ns : -1;
}

double median(std::vector<double> x) {
    std::nth_element(x.begin(), x.begin() + long(x.size() / 2), x.end());
    return x[x.size() / 2];
}

struct Difference {
    double mean = -1, largest = -1;
};
Difference compare(const std::string& picture, const Points& p) {
    Diagnostics diagnostics([](const Diagnostic& d) { std::fputs(toString(d).c_str(), stderr); });
    auto image = display::readImage(picture, diagnostics);
    if (!image || image->width != kSide || image->height != kSide) return {};
    Difference d{0, 0};
    const char* names[] = {"r", "g", "b"};
    for (int c = 0; c < 3; c++) {
        const int channel = image->channel(names[c]);
        if (channel < 0) return {};
        for (int i = 0; i < kPoints; i++) {
            const double x = std::fabs(double(image->pixel(i % kSide, i / kSide)[channel]) - double(p.out[c][i]));
            d.mean += x / (3 * kPoints);
            d.largest = std::max(d.largest, x);
        }
    }
    return d;
}

} // namespace

int main(int argc, char** argv) {
    std::error_code ec;
    std::string program = (std::filesystem::read_symlink("/proc/self/exe", ec).parent_path() / "alpenglow").string();
    const bool hasAvx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
                           __builtin_cpu_supports("avx512cd");
    bool avx512 = hasAvx512;
    int turns = 7, lanes = 0;
    std::vector<std::string> shaders;
    for (int i = 1; i < argc; i++) {
        if (!std::strcmp(argv[i], "--program") && i + 1 < argc) program = argv[++i];
        else if (!std::strcmp(argv[i], "--lanes") && i + 1 < argc) lanes = std::atoi(argv[++i]);
        else if (!std::strcmp(argv[i], "--turns") && i + 1 < argc) turns = std::max(1, std::atoi(argv[++i]));
        else shaders.push_back(argv[i]);
    }
    if (lanes == 8) avx512 = false;
    if (!lanes) lanes = avx512 ? 16 : 8;
    if (!avx512 && !(__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))) {
        std::printf("this machine has neither AVX-512 nor AVX2: nothing to compare with\n");
        return 0;
    }
    const NamedPattern* scalar = avx512 ? kScalar : kAvx2Scalar;
    std::vector<std::pair<int, const NamedPattern*>> vector;
    if (avx512) vector = {{16, kAvx512x16}, {32, kAvx512x32}, {64, kAvx512x64}};
    else vector = {{8, kAvx2x8}, {16, kAvx2x16}};

    Batch batch;
    const std::string picture =
        (std::filesystem::temp_directory_path() / ("alpenglow_pattern_" + std::to_string(getpid()) + ".exr")).string();
    std::printf("%d lanes; ns a point of CPU time, medians of %d turns; by hand: the best of %d, %d%s lanes in flight\n", lanes,
                turns, vector[0].first, vector[1].first, avx512 ? " and 64" : "");
    std::printf("%-15s %8s %8s %8s %4s  %-20s %-20s %s\n", "pattern", "shade", "scalar", "vector", "at", "scalar / shade",
                "vector / shade", "|difference| mean, largest");
    bool good = true;
    for (const auto& file : shaders) {
        const std::string name = std::filesystem::path(file).stem().string();
        const Pattern byHand = find(scalar, name);
        if (!byHand) continue;
        std::vector<double> ours, plain, best, scalarRatio, vectorRatio;
        int width = 0;
        for (int t = 0; t < turns; t++) {
            const double ns = measureProgram(program, file, lanes, picture);
            if (ns < 0) {
                std::fprintf(stderr, "pattern_bench: '%s shade %s' gave no figure\n", program.c_str(), file.c_str());
                return 1;
            }
            ours.push_back(ns);
            plain.push_back(measure(byHand, batch.points));
            best.push_back(1e9);
            for (auto [w, list] : vector)
                if (const double x = measure(find(list, name), batch.points); x < best.back()) best.back() = x, width = w;
            scalarRatio.push_back(plain.back() / ns);
            vectorRatio.push_back(best.back() / ns);
        }
        const Difference d = compare(picture, batch.points);
        const double s = median(scalarRatio), v = median(vectorRatio);
        good = good && s >= kScalarLimit && v >= kVectorLimit;
        std::printf("%-15s %8.2f %8.2f %8.2f %4d  %6.2f >= %-3g %-6s  %6.2f >= %-3g %-6s  %.1e %.1e\n", name.c_str(),
                    median(ours), median(plain), median(best), width, s, kScalarLimit, s >= kScalarLimit ? "PASS" : "MISS", v,
                    kVectorLimit, v >= kVectorLimit ? "PASS" : "MISS", d.mean, d.largest);
        std::fflush(stdout);
    }
    std::filesystem::remove(picture, ec);
    return good ? 0 : 1;
}
