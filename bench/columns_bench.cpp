// The mark that the program's time in the Muttenzer box is compared with: the same rays, random numbers, roulette and exact sums,
// written for this one box, with columns of floats from the camera to the film and no shader, no scene and no tree.
//   columns_bench [SLICE [BATCH [CALL [WIDTH [HEIGHT [SAMPLES [EXACT [TURNS]]]]]]]]
// Prints nanoseconds of processor time a sample, the best of the turns (3), and what each stage takes; by default 320 x 240
// pixels of 16 samples. EXACT 0: sums in double. For comparison: `scene_bench --stages --spp 16 box`.
#include "bench/columns/wave.h"
#include <cstdio>
#include <ctime>

using namespace alpenglow;
using namespace alpenglow::bench::columns;

namespace {

double processorSeconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// The mean of the picture, and a hash of its bits.
void printPicture(const Wave& wave, double samples) {
    double mean = 0;
    uint64_t hash = 0;
    for (size_t i = 0; i < wave.film.size(); ++i) {
        if (i % 4 < 3) mean += fromFixed<40>(wave.film[i]);
        hash = mix64(hash ^ uint64_t(wave.film[i]));
    }
    std::printf("mean %.5f, hash %016llx\n", mean / 3 / samples, static_cast<unsigned long long>(hash));
}

void printStages(double nanoseconds) {
    uint64_t all = 0;
    for (const uint64_t t : tt) all += t;
    for (int i = 0; i < NT; ++i)
        std::printf("  %-14s %6.1f ns a sample %5.1f %%\n", tname[i], nanoseconds * double(tt[i]) / double(all),
                    100 * double(tt[i]) / double(all));
}

} // namespace

int main(int argc, char** argv) {
    const auto argument = [&](int i, int otherwise) { return argc > i ? std::atoi(argv[i]) : otherwise; };
    Wave wave;
    wave.slice = argument(1, 2048);
    wave.chunk = argument(2, 256);
    wave.call = argument(3, 8192);
    wave.w = argument(4, 320);
    wave.h = argument(5, 240);
    wave.spp = argument(6, 16);
    exactSums = argument(7, 1) != 0;
    const int turns = argument(8, 3);
    makeScene();
    wave.make();
    const double samples = double(wave.w) * wave.h * wave.spp;
    double best = 1e30;
    for (int i = 0; i < turns; ++i) {
        std::fill(wave.film.begin(), wave.film.end(), 0);
        std::fill(std::begin(tt), std::end(tt), 0);
        bench::columns::rays = shadowsN = verts = amb = batches = 0;
        const double begin = processorSeconds();
        wave.run();
        best = std::min(best, 1e9 * (processorSeconds() - begin) / samples);
    }
    const double sent = double(bench::columns::rays + shadowsN);
    std::printf("%d lanes: %.1f ns a sample, best of %d; %.3f rays (%.3f of them to the lamp) and %.3f points a sample; float "
                "left %.2e of the "
                "rays undecided; %.0f points a batch\n",
                W, best, turns, sent / samples, double(shadowsN) / samples, double(verts) / samples, double(amb) / sent,
                double(verts) / double(batches));
    printPicture(wave, samples);
    printStages(best);
    return 0;
}
