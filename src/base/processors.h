// Number of threads for a run, and capabilities of the processor.
#pragma once
#include <string>
#include <vector>

namespace alpenglow {

/// Default number of threads: processors that this process may use (taskset, sched_getaffinity), or fewer if a control group has
/// a quota (cpu.max, rounded up) or Slurm assigned fewer to the task (SLURM_CPUS_PER_TASK). At least 1.
int defaultThreads();

/// The same from its parts: `allowed` processors, folders of control groups from the inner to the outer, the text of
/// SLURM_CPUS_PER_TASK (may be null).
int threadsWithin(int allowed, const std::vector<std::string>& groups, const char* slurm);

/// The instruction set level that the program uses on this machine: "x86-64-v2", "x86-64-v3" or "x86-64-v4".
const char* processorLevel();

} // namespace alpenglow
