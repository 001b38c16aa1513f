// alpenglow render: scenes to pictures.
#include "base/installation.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/processors.h"
#include "cli/command.h"
#include "cli/modelscene.h"
#include "cli/ranges.h"
#include "cli/version.h"
#include "display/imageio.h"
#include "render/filmpicture.h"
#include "render/renderer.h"
#include "ri/lookahead.h"
#include "ri/models/model.h"
#include "ri/reader.h"
#include "view/preview.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <memory>
#include <set>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace alpenglow::cli {
namespace {

struct RenderArguments {
    render::RenderSettings settings;
    std::vector<std::string> scenes, searchPaths, displays, rib;
    std::string format, crop, samples, part, frames, pixel, preset, memory, folder, seed, progress = "auto";
    std::string gamma, preview;
    std::vector<std::pair<std::string, int>> tev; ///< hosts and ports
    bool noDirect = false, noIndirect = false, watch = false, quiet = false, verbose = false;
    std::vector<int> frameList;
};

void checkLate(RenderArguments& a, const CLI::App& app) {
    render::RenderSettings& s = a.settings;
    auto wrong = [](const std::string& option, const std::string& what) { throw CLI::ValidationError(option, what); };
    if (!a.folder.empty() && chdir(a.folder.c_str()) != 0) wrong("--cwd", "there is no folder \"" + a.folder + "\"");
    if (!a.format.empty()) readFormat(a.format, &s.width, &s.height);
    if (!a.crop.empty()) {
        auto v = parseNumbers(a.crop, 4);
        if (!v || !((*v)[0] <= (*v)[1] && (*v)[2] <= (*v)[3]))
            wrong("--crop", "takes X0,X1,Y0,Y1, each in 0..1, lower before upper");
        s.crop = {float((*v)[0]), float((*v)[1]), float((*v)[2]), float((*v)[3])};
    }
    if (!a.samples.empty()) {
        s.samples = render::rangeFromText(a.samples);
        if (!s.samples) wrong("--samples", "takes A:B with A < B: samples A to B-1 of every pixel");
    }
    if (!a.part.empty()) {
        unsigned k = 0, n = 0;
        int end = 0;
        if (std::sscanf(a.part.c_str(), "%9u/%9u%n", &k, &n, &end) != 2 || size_t(end) != a.part.size() || k < 1 || k > n)
            wrong("--part", "takes K/N, with K from 1 to N: the third of sixteen parts is 3/16");
        if (s.noise > 0 || s.seconds > 0) wrong("--part", "needs a number of samples: --spp, not --noise or --time");
        s.part = {k, n};
    }
    if (!a.frames.empty()) {
        auto v = parseFrames(a.frames);
        if (!v) wrong("--frames", "takes a list like 1,4-6");
        a.frameList = *v;
    }
    if (!a.pixel.empty()) {
        auto v = parseNumbers(a.pixel);
        if (!v || v->size() < 2 || v->size() > 3) wrong("--pixel", "takes X,Y or X,Y,SAMPLE");
        for (double d : *v)
            if (d != std::floor(d) || std::fabs(d) > 1e9 || (v->size() == 3 && v->back() < 0))
                wrong("--pixel", "takes whole numbers");
        s.pixel = {int((*v)[0]), int((*v)[1])};
        if (v->size() == 3) s.pixelSample = uint32_t((*v)[2]);
    }
    s.seedByFrame = a.seed == "frame";
    if (!a.seed.empty() && !s.seedByFrame) {
        const auto [end, fault] = std::from_chars(a.seed.data(), a.seed.data() + a.seed.size(), s.seed);
        if (fault != std::errc() || end != a.seed.data() + a.seed.size())
            wrong("--seed", "takes a whole number or frame, not " + a.seed);
    }
    s.memoryLimit = defaultMemoryLimit();
    if (!a.memory.empty()) {
        auto bytes = parseMemorySize(a.memory);
        if (!bytes) wrong("--memory-limit", "takes a size like 800M or 4G");
        s.memoryLimit = *bytes;
    }
    for (const std::string& d : a.displays) {
        const size_t colon = d.find(':'), second = colon == d.npos ? d.npos : d.find(':', colon + 1);
        scene::Display added;
        added.type = d.substr(0, colon);
        added.name = colon == d.npos ? "" : d.substr(colon + 1, second == d.npos ? d.npos : second - colon - 1);
        if (second != d.npos) added.mode = d.substr(second + 1);
        if (added.type.empty() || added.name.empty() || added.mode.empty())
            wrong("--display", "takes TYPE:NAME or TYPE:NAME:MODE, for example png:view.png or openexr:all.exr:rgba,N,z");
        if (added.type == "tev") { // a viewer, no file
            char* end = nullptr;
            const long port = std::strtol(added.mode.c_str(), &end, 10);
            if (second == d.npos || *end || port < 1 || port > 65535)
                wrong("--display", "takes tev:HOST:PORT, for example tev:localhost:14158");
            a.tev.emplace_back(added.name, int(port));
            continue;
        }
        s.displays.push_back(std::move(added));
    }
    s.srgb = a.gamma == "srgb" || a.gamma == "sRGB";
    if (!a.gamma.empty() && !s.srgb) {
        auto v = parseNumbers(a.gamma, 1);
        if (!v || !(v->front() >= 0.01 && v->front() <= 100))
            wrong("--gamma", std::string("takes a number from 0.01 to 100") + (v ? "" : ", or srgb") + ", not " + a.gamma);
        s.gamma = float(v->front());
    }
    s.direct = !a.noDirect;
    s.indirect = !a.noIndirect;
    if (const std::string fault = s.output.empty() ? "" : faultOfPictureName(s.output, true); !fault.empty()) wrong("-o", fault);
    if (s.output == "-" && (s.samples || s.part))
        wrong("-o", "with --samples or --part a part file lies beside the picture: name a file");
    if (s.resume && s.checkpoint.empty()) wrong("--resume", "needs --checkpoint FILE");
    if (s.restart && s.checkpoint.empty()) wrong("--restart", "needs --checkpoint FILE");
    if (a.preset == "slproject") {
        if (s.hider.empty()) s.hider = "path";
        if (!s.gamma && !s.srgb) s.gamma = 2.2f;
        if (!app.count("--sample-clamp")) s.sampleClamp = 3;
        s.localRoulette = true;
        if (s.output.empty() && s.displays.empty()) s.savePattern = "Pathtraced_<spp>_<no>.png";
    }
    s.progress = *render::progressModeByName(a.progress);
    if (a.quiet && !app.count("--progress")) s.progress = render::ProgressMode::None;
    s.quiet = a.quiet;
    s.texturePaths = s.shaderPaths = folders(a.searchPaths);
    for (std::string& e : environmentShaders()) s.shaderPaths.push_back(std::move(e));
    s.shippedShaders = shippedShaders();
}

/// Without a name RIB comes from standard input, as other renderers have it.
void takeScenes(RenderArguments& a) {
    if (a.scenes.empty() && standardInputHasData()) a.scenes = {"-"};
    if (a.scenes.empty()) throw CLI::RequiredError("scenes: a FILE, or RIB on standard input,");
}

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

int renderOnce(const RenderArguments& a, const StopFlag* stop) {
    const Diagnostics::Handler print = printer(a.quiet ? Severity::Error : a.verbose ? Severity::Info : Severity::Warning);
    Diagnostics diags(print);
    render::RenderSettings settings = a.settings;
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
    render::Renderer renderer(settings, render::transportEngine(), diags, progress,
                              [](const std::string& line) { std::printf("%s\n", line.c_str()); });
    ri::ReaderOptions options;
    options.searchPaths = folders(a.searchPaths);
    options.allowExec = settings.allowExec;
    options.allowRead = settings.allowRead;
    options.reads = settings.reads;
    options.stop = stop;
    options.frames = a.frameList;
    options.defers = true;
    std::vector<int> seen;
    options.frameSeen = [&](int frame) { seen.push_back(frame); };
    options.overrides = [&](scene::Options& o) { renderer.override(o); };
    bool memory = false;
    if (!renderer.canBegin()) return kOutputFailed;
    try {
        ri::RibReader reader(options, renderer, diags);
        renderer.setProcedurals([&reader](const scene::Frame& f, std::span<const int> which) { return reader.make(f, which); });
        for (const std::string& r : a.rib) reader.readMemory(r, "--rib");
        for (const std::string& s : a.scenes) {
            if (*stop) break;
            reader.nextScene();
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
    } catch (const std::bad_alloc&) {
        memory = true;
        diags.report(Severity::Severe, Rie::NoMem, {}, "out of memory while the scene was read",
                     "the limit is " + memorySizeText(settings.memoryLimit) + "; --memory-limit sets another");
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
    render::RenderSettings& s = a->settings;
    s.software = softwareName();
    s.command = command;
    CLI::App* c = app.add_subcommand("render", "Render scenes (RIB files; - reads standard input) or models (.ply, .obj)");
    c->add_option("scenes", a->scenes,
                  "RIB files, ASCII, binary or gzipped; - is standard input, which is also read where no file is named. A model "
                  "(.ply, .obj) is shown whole under a sky. Each file starts from the default state; a file of options without "
                  "a world holds for all that follow")
        ->type_name("FILE");

    c->add_option(
         "-o", s.output,
         std::string("Write the picture to FILE instead of the scene's displays; the extension chooses the format (") +
             display::kPictureExtensions +
             "). Depth and shadow maps stay, and further displays of other outputs. # or %04d in the name becomes the number of "
             "the frame; in a scene of several frames a name without it gets the number before the extension. - is standard "
             "output: PNG, or the format of the scene's first display (openexr, tiff, jpeg), frames one after the other")
        ->type_name("FILE")
        ->group("Pictures");
    c->add_option("--display", a->displays,
                  "Add a display, for example png:view.png or openexr:all.exr:rgba,N,z; tev:HOST:PORT shows the growing pictures "
                  "in that viewer")
        ->type_name("TYPE:NAME[:MODE]")
        ->allow_extra_args(false)
        ->group("Pictures");
    c->add_flag(
         "--preview{auto}", a->preview,
         "Show the picture in the terminal as it grows, by the graphics of kitty or sixels where it has them, else in half "
         "blocks; --preview=kitty, sixel or blocks chooses")
        ->check(CLI::IsMember({"auto", "kitty", "sixel", "blocks"}))
        ->group("Pictures");
    c->add_option("--format", a->format, "Size of the picture in pixels")->type_name("WxH")->group("Pictures");
    c->add_option("--resolution-factor", s.resolutionFactor, "Scale both sides of the picture")
        ->check(between(1e-4, 1e4))
        ->type_name("F")
        ->group("Pictures");
    c->add_option("--crop", a->crop, "Render only this part, in fractions of the picture from its upper left")
        ->type_name("X0,X1,Y0,Y1")
        ->group("Pictures");
    c->add_option("--gamma", a->gamma,
                  "Curve of the pictures instead of Exposure's, or that of path: a display gamma, 1 for none, or srgb (PNG, JPEG "
                  "and TIFF of 8 bits; docs/colour.md)")
        ->type_name("G|srgb")
        ->group("Pictures");
    c->add_option("--frames", a->frames, "Only these frames, for example 1,4-6")->type_name("LIST")->group("Pictures");

    c->add_option("--hider", s.hider, "hidden, raytrace, path or photon, instead of the scene's Hider")
        ->check(CLI::IsMember({"hidden", "raytrace", "path", "photon"}))
        ->type_name("NAME")
        ->group("Quality");
    c->add_option("--spp", s.spp, "Samples per pixel instead of PixelSamples (path without either: 64)")
        ->check(wholeBetween(1, limits::kSamplesPerPixel))
        ->type_name("N")
        ->group("Quality");
    c->add_option(
         "--noise", s.noise,
         "path: go on until the noise that is printed at the end is at most E, for example 0.01: the mean relative error of "
         "the light on surfaces")
        ->check(positive("0.02 for 2 %"))
        ->type_name("E")
        ->group("Quality");
    c->add_option("--time", s.seconds, "path: go on for about so long")
        ->check(positive())
        ->type_name("SECONDS")
        ->group("Quality");
    c->add_option("--samples", a->samples,
                  "path: only samples A to B-1 of every pixel; a part file is written beside the picture, for merge")
        ->type_name("A:B")
        ->group("Quality");
    c->add_option("--part", a->part, "path: only part K of N of the samples, which are shared evenly; else as --samples")
        ->type_name("K/N")
        ->excludes("--samples")
        ->group("Quality");
    c->add_option("--seed", a->seed,
                  "Seed of all random numbers; same seed, same bits. frame: the number of each frame, so that the noise of an "
                  "animation changes")
        ->type_name("N|frame")
        ->group("Quality");
    c->add_option("--max-depth", s.maxDepth, "Greatest number of bounces")
        ->check(wholeBetween(0, limits::kPathDepth))
        ->type_name("N")
        ->group("Quality");
    c->add_option("--sample-clamp", s.sampleClamp, "Scale samples brighter than X down to it: less noise, but a bias")
        ->check(notNegative())
        ->type_name("X")
        ->group("Quality");
    c->add_flag("--no-direct", a->noDirect, "Leave direct light out")->group("Quality");
    c->add_flag("--no-indirect", a->noIndirect, "Leave diffuse interreflection out")->group("Quality");
    c->add_flag("--unbiased", s.unbiased, "Do not tame shaders that reflect more than they receive")->group("Quality");
    c->add_option("--preset", a->preset,
                  "slproject: path, gamma 2.2, sample clamp 3, local roulette, box filter, Pathtraced_<spp>_<no>.png")
        ->check(CLI::IsMember({"slproject"}))
        ->type_name("NAME")
        ->group("Quality");

    c->add_option("--threads", s.threads,
                  "Threads; when not given as many processors as the process may use (affinity, control groups, Slurm). The "
                  "picture does not depend on it")
        ->check(wholeBetween(1, 1024))
        ->type_name("N")
        ->group("Machine");
    c->add_option("--lanes", s.lanes, "Points a shader works on at once; the picture does not depend on it")
        ->check(CLI::IsMember({4, 8, 16}))
        ->type_name("N")
        ->group("Machine");
    c->add_option(
         "--memory-limit", a->memory,
         "End with status 4 rather than take more memory than SIZE, for example 800M or 4G; nine tenths of the machine's when "
         "not given")
        ->type_name("SIZE")
        ->group("Machine");
    c->add_option("--checkpoint", s.checkpoint, "path: keep the samples so far in FILE, every half minute and at the end")
        ->type_name("FILE")
        ->group("Machine");
    CLI::Option* resume =
        c->add_flag("--resume", s.resume, "Begin with the samples in the checkpoint; without one, begin anew")->group("Machine");
    c->add_flag("--restart", s.restart, "Begin anew and replace the checkpoint that is there")
        ->excludes(resume)
        ->group("Machine");
    c->add_option("--stats", s.statsFile, "Write figures of the render and of each frame as JSON (docs/statistics.md)")
        ->type_name("FILE.json")
        ->group("Machine");
    c->add_flag("--stamp", s.stamp,
                "Write command, host, date and seconds into the pictures; without it equal pictures are equal files")
        ->group("Machine");
    c->add_option("--pixel", a->pixel,
                  "Print red, green, blue and coverage of one pixel, or of one of its samples, and write no picture")
        ->type_name("X,Y[,SAMPLE]")
        ->group("Machine");
    c->add_flag("--watch", a->watch,
                "Render again whenever a file changes that the scene uses: shaders, includes, maps, archives")
        ->group("Machine");

    addDialect(*c, a->settings.dialect);
    c->add_option("--cwd", a->folder, "Work in this folder: names on the command line and in the scene begin there")
        ->type_name("DIR")
        ->group("Input");
    c->add_option("--searchpath", a->searchPaths, "Folders for shaders, textures and archives, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false)
        ->group("Input");
    c->add_option("--rib", a->rib, "Requests that are read before the scene")
        ->type_name("'REQUESTS'")
        ->allow_extra_args(false)
        ->group("Input");
    c->add_flag("--allow-exec", s.allowExec, "Let the scene run programs and load plug-ins")->group("Input");
    c->add_flag("--allow-read", s.allowRead,
                "Let the scene read maps and archives anywhere, not only below its folders and --searchpath")
        ->group("Input");
    c->add_flag("--allow-write", s.allowWrite,
                "Let the scene write outside the current folder, hidden files, and over what is no picture")
        ->group("Input");

    c->add_option("--progress", a->progress, "auto, bar, plain or none")
        ->check(CLI::IsMember({"auto", "bar", "plain", "none"}))
        ->type_name("MODE")
        ->group("Messages");
    c->add_flag("-q,--quiet", a->quiet, "Errors only: no progress, no warnings, no table at the end")->group("Messages");
    c->add_flag("-v,--verbose", a->verbose, "Notes too")->group("Messages");
    c->footer("Examples:\n  alpenglow scene.rib                          as the scene says\n"
              "  alpenglow render --hider path --noise 0.02 -o out.exr scene.rib\n"
              "  alpenglow render --samples 0:32 -o a.exr scene.rib    and 32:64 to b.exr elsewhere; then merge a.exr b.exr -o "
              "whole.exr\n"
              "Ctrl-C keeps the passes that are whole and writes the picture; a second Ctrl-C ends at once.");
    for (CLI::Option* o : c->get_options())
        if (o->get_items_expected_max() == 1) o->take_last(); // a script's option gives way to the user's behind it
    c->callback([a, c, status] {
        takeScenes(*a);
        checkLate(*a, *c);
        *status = renderAll(*a);
    });
}

} // namespace alpenglow::cli
