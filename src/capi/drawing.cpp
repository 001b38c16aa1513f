// RiBegin(RI_NULL): the program draws its pictures itself.
#include "base/installation.h"
#include "base/memory.h"
#include "base/processors.h"
#include "capi/output.h"
#include "cli/command.h"
#include "cli/renderarguments.h"
#include "cli/version.h"
#include "render/renderer.h"
#include "ri/interpreter.h"
#include <cstdio>
#include <optional>

namespace alpenglow::capi {

namespace {

class Drawing final : public Output {
public:
    Drawing(const cli::RenderArguments& a, Diagnostics& diags)
        : progress_(a.settings.progress), renderer_(a.settings, render::transportEngine(), diags, progress_,
                                                    [](const std::string& line) { std::printf("%s\n", line.c_str()); }),
          interpreter_(readerOptions(a), renderer_, diags), target_(interpreter_) {
        if (!a.memory.empty())
            limit_.emplace(a.settings.memoryLimit, a.settings.threads > 0 ? a.settings.threads : defaultThreads());
        renderer_.setProcedurals(
            [this](const scene::Frame& f, std::span<const int> which) { return interpreter_.make(f, which); });
        for (const std::string& r : a.rib) interpreter_.readStream(ri::memorySource(r), "--rib");
    }
    ri::Target& target() override { return target_; }
    bool canBegin() { return renderer_.canBegin(); }
    void end(const SourcePlace& where) override {
        interpreter_.finish(where);
        interpreter_.endPrograms();
        renderer_.waitForFrames();
        renderer_.finish();
        renderer_.writeStats();
    }

private:
    ri::ReaderOptions readerOptions(const cli::RenderArguments& a) {
        ri::ReaderOptions o;
        o.searchPaths = cli::folders(a.searchPaths);
        o.allowExec = a.settings.allowExec;
        o.allowRead = a.settings.allowRead;
        o.frames = a.frameList;
        o.defers = true;
        o.overrides = [this](scene::Options& options) { renderer_.override(options); };
        return o;
    }
    std::optional<MemoryLimit> limit_;
    render::Progress progress_;
    render::Renderer renderer_;
    ri::Interpreter interpreter_;
    ri::InterpreterTarget target_;
};

} // namespace

std::unique_ptr<Output> drawing(const std::string& options, Diagnostics& diags) {
    cli::RenderArguments a;
    a.settings.software = cli::softwareName();
    a.progress = "none"; // the program's terminal is the program's
    if (const std::string wrong = cli::readRenderOptions(options, a); !wrong.empty()) {
        diags.report(Severity::Error, Rie::BadToken, {}, "ALPENGLOW_OPTIONS: " + wrong,
                     "it takes the options of alpenglow render, for example --threads 4 --spp 64");
        a = {};
        a.settings.software = cli::softwareName();
        a.progress = "none";
        (void)cli::readRenderOptions("", a);
    }
    if (a.memory.empty()) a.settings.memoryLimit = 0; // the process is not ours
    auto d = std::make_unique<Drawing>(a, diags);
    return d->canBegin() ? std::move(d) : nullptr;
}

} // namespace alpenglow::capi
