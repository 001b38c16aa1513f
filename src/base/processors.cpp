#include "base/processors.h"
#include "base/controlgroup.h"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sched.h>
#include <thread>

namespace alpenglow {
namespace {

/// Processor quota of a group, in processors; 0: none.
double quotaOf(const std::string& folder) {
    double quota = 0, period = 0;
    if (std::ifstream in(folder + "/cpu.max"); in >> quota >> period)
        return period > 0 ? quota / period : 0; // "max 100000": none
    std::ifstream of(folder + "/cpu.cfs_quota_us"), in(folder + "/cpu.cfs_period_us");
    return of >> quota && in >> period && period > 0 ? quota / period : 0; // -1: none
}

int affinity() {
    // Machines of more than 1024 processors need a larger set than cpu_set_t.
    for (int size = CPU_SETSIZE; size <= CPU_SETSIZE << 8; size *= 2) {
        cpu_set_t* set = CPU_ALLOC(size_t(size));
        if (!set) break;
        const size_t bytes = CPU_ALLOC_SIZE(size_t(size));
        const int count = sched_getaffinity(0, bytes, set) == 0 ? CPU_COUNT_S(bytes, set) : 0;
        CPU_FREE(set);
        if (count > 0) return count;
    }
    return int(std::thread::hardware_concurrency());
}

} // namespace

int threadsWithin(int allowed, const std::vector<std::string>& groups, const char* slurm) {
    int threads = std::max(1, allowed);
    for (const std::string& g : groups)
        if (const double quota = quotaOf(g); quota > 0 && quota < threads) threads = std::max(1, int(std::ceil(quota)));
    if (slurm)
        if (const int given = std::atoi(slurm); given > 0) threads = std::min(threads, given);
    return threads;
}

int defaultThreads() { return threadsWithin(affinity(), controlGroupFolders("cpu"), std::getenv("SLURM_CPUS_PER_TASK")); }

const char* processorLevel() {
    __builtin_cpu_init();
    return __builtin_cpu_supports("x86-64-v4") ? "x86-64-v4" : __builtin_cpu_supports("x86-64-v3") ? "x86-64-v3" : "x86-64-v2";
}

} // namespace alpenglow
