#include "cli/framesatonce.h"
#include "base/processors.h"
#include "cli/command.h"
#include <algorithm>
#include <csignal>

namespace alpenglow::cli {

FramesAtOnce::FramesAtOnce(int most, const render::RenderSettings& s, Diagnostics& messages)
    : messages_(messages), memory_(s.memoryLimit), threads_(s.threads > 0 ? s.threads : defaultThreads()) {
    if (most <= 1) return;
    render::FrameProcesses::Use use;
    use.most = most;
    use.stop = s.stop;
    use.stopSignal = SIGUSR1;
    use.begins = [this](bool alone) { begin(alone); };
    use.ends = [this] {
        if (reader_) reader_->endPrograms();
    };
    watchStopSignal(use.stopSignal); // before the first process: it would end one that has just begun
    processes_.emplace(std::move(use), messages);
    reported_.setHandler([this](const Diagnostic& d) { processes_->say(d); });
}

void FramesAtOnce::begin(bool alone) {
    leaveInterrupts();
    if (reader_) reader_->leavePrograms();
    const int most = processes_->most();
    if (!alone && memory_) share_.emplace(memory_ / size_t(most), std::max(1, threads_ / most));
}

} // namespace alpenglow::cli
