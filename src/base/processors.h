// How many threads a run may keep busy, and what the processors can do.
#pragma once
#include <string>
#include <vector>

namespace alpenglow {

/// Threads when the user gives no number: processors that this process may run on (taskset, sched_getaffinity), or fewer where a
/// control group has a quota (cpu.max, rounded up) or Slurm gave the task fewer (SLURM_CPUS_PER_TASK). At least 1.
int defaultThreads();

/// The same from its parts: `allowed` processors, folders of control groups from the inner to the outer, the text of
/// SLURM_CPUS_PER_TASK (may be null).
int threadsWithin(int allowed, const std::vector<std::string>& groups, const char* slurm);

/// The level of this machine's instruction set that the program makes use of: "x86-64-v2", "x86-64-v3" or "x86-64-v4".
const char* processorLevel();

} // namespace alpenglow
