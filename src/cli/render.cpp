// alpenglow render: scenes to pictures.
#include "base/memory.h"
#include "base/processors.h"
#include "cli/command.h"
#include "cli/foreignmodel.h"
#include "cli/framesatonce.h"
#include "cli/modelscene.h"
#include "cli/rcfile.h"
#include "cli/renderarguments.h"
#include "cli/ribfilters.h"
#include "cli/version.h"
#include "models/modelfile.h"
#include "render/renderer.h"
#include "ri/lookahead.h"
#include "ri/models/model.h"
#include "ri/reader.h"
#include "ri/receiver.h"
#include "view/preview.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace alpenglow::cli {
namespace {

/// "1-24", "3,5-6".
std::string listOf(std::vector<int> frames) {
    std::sort(frames.begin(), frames.end());
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    std::string text;
    for (size_t i = 0; i < frames.size();) {
        size_t k = i;
        while (k + 1 < frames.size() && frames[k + 1] == frames[k] + 1) ++k;
        text += (text.empty() ? "" : ",") + std::to_string(frames[i]) + (k > i ? "-" + std::to_string(frames[k]) : "");
        i = k + 1;
    }
    return text;
}

/// Frames that --frames names and the scene does not have. True: there are some.
bool tellMissingFrames(const std::vector<int>& wanted, const std::vector<int>& seen, bool rendered, Diagnostics& diags) {
    std::vector<int> missing;
    for (int f : wanted)
        if (std::find(seen.begin(), seen.end(), f) == seen.end()) missing.push_back(f);
    if (missing.empty() || seen.empty()) return false; // a world without a frame is always rendered
    const std::string has = listOf(seen);
    diags.report(rendered ? Severity::Warning : Severity::Error, Rie::MissingData, {},
                 "the scene has " + std::string(has.find_first_of(",-") == has.npos ? "frame " : "frames ") + has + ", not " +
                     listOf(missing),
                 "--frames names frames by the number of their FrameBegin");
    return true;
}

/// Who looks on: the terminal, viewers. `terminal` is the former, or null.
view::Watchers watchersOf(const RenderArguments& a, Diagnostics& diags, view::TerminalPreview** terminal) {
    view::Watchers all;
    *terminal = nullptr;
    if (!a.preview.empty()) {
        const auto kind = view::terminalKindByName(a.preview);
        if (!kind && !isatty(STDERR_FILENO))
            diags.report(Severity::Warning, Rie::Incapable, {}, "--preview: standard error is no terminal; nothing is shown",
                         "--preview=sixel, kitty or blocks writes it all the same");
        else {
            auto preview = std::make_unique<view::TerminalPreview>(diags, kind ? *kind : view::terminalKind(),
                                                                   view::terminalSize(), [](const std::string& text) {
                                                                       std::fwrite(text.data(), 1, text.size(), stderr);
                                                                       std::fflush(stderr);
                                                                   });
            *terminal = preview.get();
            all.all.push_back(std::move(preview));
        }
    }
    for (const auto& [host, port] : a.tev)
        if (auto tev = view::TevPreview::connect(host, port, diags)) all.all.push_back(std::move(tev));
    return all;
}

ri::ReaderOptions readerOptions(const RenderArguments& a, const render::RenderSettings& settings) {
    ri::ReaderOptions options;
    options.searchPaths = folders(a.searchPaths);
    options.lastArchivePaths = a.lastArchivePaths;
    options.lastProceduralPaths = a.lastProceduralPaths;
    options.allowExec = settings.allowExec;
    options.allowRead = settings.allowRead;
    options.reads = settings.reads;
    options.stop = settings.stop;
    options.frames = a.frameList;
    options.defers = true;
    options.threads = a.framesAtOnce == 1;
    return options;
}

/// Filters of requests, and what they make of one.
class SceneFilters : public ri::RequestReceiver {
public:
    /// False: a filter cannot be used, which was reported. diags and stop must outlive this.
    bool load(const std::vector<std::string>& names, Diagnostics& diags, const StopFlag* stop) {
        diags_ = &diags;
        if (!names.empty()) filters_ = RibFilters::make(names, *this, diags, stop);
        return filters_ || names.empty();
    }
    /// From now on requests pass the filters: what stands before the scenes does not.
    void begin() { begun_ = true; }
    /// For ReaderOptions::filter; empty without filters.
    std::function<void(const ri::Call&, std::vector<ri::Call>&)> function() {
        if (!filters_) return {};
        return [this](const ri::Call& c, std::vector<ri::Call>& by) {
            if (!begun_) return by.push_back(c);
            by_ = &by;
            filters_->first().request(c);
        };
    }
    void request(const ri::Call& c) override { by_->push_back(c); }
    void unknown(const std::string& name, const std::vector<ri::Value>&) override {
        diags_->report(Severity::Error, Rie::BadToken, {}, "a filter puts in the unknown request '" + name + "'; it is left out");
    }
    void comment(const std::string&, const std::string&) override {}

private:
    std::unique_ptr<RibFilters> filters_;
    Diagnostics* diags_ = nullptr;
    std::vector<ri::Call>* by_ = nullptr;
    bool begun_ = false;
};

using ForeignScene = std::function<std::string(const std::string& file)>; ///< the text of its scene, or ""

void readScenes(const std::vector<std::string>& scenes, const render::RenderSettings& settings, const ri::ReaderOptions& options,
                ri::RibReader& reader, render::Renderer& renderer, const ForeignScene& foreign) {
    for (const std::string& s : scenes) {
        if (*settings.stop) break;
        reader.nextScene();
        if (models::namedAsForeignModel(s) && ::access(s.c_str(), R_OK) == 0) {
            renderer.setScene(s, {});
            if (const std::string text = foreign(s); !text.empty()) reader.readMemory(text, s);
            continue;
        }
        if (ri::namedAsModel(s) && ::access(s.c_str(), R_OK) == 0) {
            renderer.setScene(s, {});
            reader.readMemory(modelScene(s), s);
            continue;
        }
        // Only what the command line says about pictures must tell them from what the scene reads itself.
        renderer.setScene(s, render::pictureOptions(settings).empty() ? std::set<std::string>{}
                                                                      : ri::picturesOfMakeRequests(s, options));
        reader.readFile(s);
    }
}

/// What the user, or the folder, has in front of every scene; and, as notes, the environment's folders.
void readDefaults(const RenderArguments& a, ri::RibReader& reader, Diagnostics& diags) {
    for (const auto& [name, value] : a.settings.environment)
        diags.report(Severity::Info, Rie::NoError, {}, "$" + name + " names folders that are searched last: " + value);
    if (a.noRc) return;
    for (const RcFile& f : rcFiles(diags)) {
        if (!f.own && f.optionLine > 0)
            diags.report(Severity::Warning, Rie::IllState, {f.path, f.optionLine, 1},
                         "options are read from ~/.alpenglowrc only; those of the current folder are left out",
                         "RIB has its Option, Hider and Display");
        if (f.rib.find_first_not_of(" \t\r\n") == f.rib.npos) continue;
        Diagnostic read{Severity::Info, Rie::NoError, {f.path}, "it is read before the scene; --no-rc leaves it out", {}, {}};
        read.always = true;
        diags.report(std::move(read));
        if (a.settings.reads) a.settings.reads->add(f.path);
        reader.readMemory(f.rib, f.path);
    }
}

int renderOnce(const RenderArguments& a, const StopFlag* stop) {
    const Diagnostics::Handler print = printer(a.quiet ? Severity::Error : a.verbose ? Severity::Info : Severity::Warning);
    Diagnostics diags(print);
    render::RenderSettings settings = a.settings;
    ModelFolder modelFolder; // of the maps of models
    if (const std::string& f = modelFolder.pathFor(a.scenes); !f.empty()) settings.texturePaths.push_back(f);
    settings.stop = stop;
    view::TerminalPreview* terminal = nullptr;
    view::Watchers watchers = watchersOf(a, diags, &terminal);
    if (!watchers.all.empty()) settings.watcher = &watchers;
    if (terminal)
        diags.setHandler([print, terminal](const Diagnostic& d) {
            print(d);
            terminal->scrolled();
        });
    render::Progress progress(settings.pixel ? render::ProgressMode::None : settings.progress);
    FramesAtOnce atOnce(a.framesAtOnce, settings, diags);
    render::Renderer renderer(settings, render::transportEngine(), atOnce.reported(), progress,
                              [](const std::string& line) { std::printf("%s\n", line.c_str()); });
    if (atOnce.processes()) renderer.setProcesses(*atOnce.processes());
    ri::ReaderOptions options = readerOptions(a, settings);
    std::vector<int> seen;
    options.frameSeen = [&](int frame) { seen.push_back(frame); };
    options.overrides = [&](scene::Options& o) { renderer.override(o); };
    bool memory = false;
    SceneFilters filters;
    if (!filters.load(a.filters, atOnce.reported(), stop)) return kWrongUse;
    options.filter = filters.function();
    if (!renderer.canBegin()) return kOutputFailed;
    try {
        ri::RibReader reader(options, renderer, atOnce.reported());
        atOnce.setReader(reader);
        renderer.setProcedurals([&reader](const scene::Frame& f, std::span<const int> which) { return reader.make(f, which); });
        readDefaults(a, reader, atOnce.reported());
        for (const std::string& r : a.rib) reader.readMemory(r, "--rib");
        filters.begin();
        readScenes(a.scenes, settings, options, reader, renderer,
                   [&](const std::string& file) { return modelFolder.scene(file, a.modelTime, atOnce.reported()); });
    } catch (const std::bad_alloc&) {
        memory = true;
        atOnce.reported().report(Severity::Severe, Rie::NoMem, {}, "out of memory while the scene was read",
                                 "the limit is " + memorySizeText(settings.memoryLimit) + "; --memory-limit sets another");
    }
    renderer.waitForFrames();
    atOnce.reported().ignore(false); // what follows is the program's, not the scene's
    if (const int n = diags.ignored(); n > 0) {
        Diagnostic reported{Severity::Info, Rie::NoError, {}, {}, {}, {}};
        reported.message = "ErrorHandler \"ignore\": " + std::to_string(n) +
                           (n == 1 ? " error or warning was" : " errors and warnings were") + " not printed; -v prints all";
        reported.always = true;
        diags.report(std::move(reported));
    }
    const auto& outcome = renderer.outcome();
    bool interrupted = outcome.interrupted || *stop;
    const bool missing = tellMissingFrames(a.frameList, seen, outcome.rendered > 0, diags);
    if (!missing && outcome.rendered == 0 && outcome.refused == 0 && outcome.textures == 0 && !interrupted && !diags.errors())
        diags.report(Severity::Error, Rie::MissingData, {},
                     "no world was rendered: there is none between WorldBegin and WorldEnd in what was read");
    renderer.finish();
    renderer.writeStats();
    if (!a.quiet && outcome.rendered > 0 && !settings.pixel) std::fputs(toTable(renderer.stats()).c_str(), stderr);
    if (interrupted) return kInterrupted;
    if (outcome.outputFailed) return kOutputFailed;
    memory |= outcome.outOfMemory;
    for (const Diagnostic& d : diags.all())
        memory |= d.severity == Severity::Severe && (d.code == Rie::NoMem || d.code == Rie::Limit);
    if (memory) return kLimit;
    if (outcome.rendered == 0 && (outcome.refused > 0 || outcome.textures == 0)) return kNothingRendered;
    return diags.errors() ? kDoneWithErrors : kDone;
}

int renderAll(const RenderArguments& a) {
    if (a.settings.output == "-") stdout = stderr; // what shaders print must not come between the bytes of the picture
    const MemoryLimit limit(a.settings.memoryLimit, a.settings.threads > 0 ? a.settings.threads : defaultThreads());
    const StopFlag* stop = watchInterrupts();
    if (!a.watch) return renderOnce(a, stop);
    RenderArguments again = a;
    while (true) {
        again.settings.reads = std::make_shared<ReadLog>();
        int status = renderOnce(again, stop);
        again.settings.restart = !a.settings.resume; // the checkpoint of the round before is ours
        if (*stop) return status;
        std::fputs("alpenglow: waiting for a file of the scene to change; Ctrl-C ends\n", stderr);
        while (!again.settings.reads->changed()) {
            if (*stop) return status;
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(100)); // let the editor finish
    }
}

} // namespace

void addRender(CLI::App& app, int* status, const std::string& command) {
    auto a = std::make_shared<RenderArguments>();
    a->settings.software = softwareName();
    a->settings.command = command;
    CLI::App* c =
        app.add_subcommand("render", "Render scenes (RIB files; - reads standard input) or models (.ply, .obj, .glb, ...)");
    addRenderOptions(*c, *a);
    c->callback([a, c, status] {
        checkRenderArguments(*a, *c);
        *status = renderAll(*a);
    });
}

} // namespace alpenglow::cli
