// The options of render: their declarations for the parser, and the checks that the parser cannot make.
#include "base/installation.h"
#include "base/limits.h"
#include "base/memory.h"
#include "cli/command.h"
#include "cli/foreignvariables.h"
#include "cli/ranges.h"
#include "cli/renderarguments.h"
#include "display/imageio.h"
#include "render/filmpicture.h"
#include "render/limits.h"
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace alpenglow::cli {
namespace {

[[noreturn]] void wrong(const std::string& option, const std::string& what) { throw CLI::ValidationError(option, what); }

void takePicture(RenderArguments& a) {
    render::RenderSettings& s = a.settings;
    if (!a.format.empty()) readFormat(a.format, &s.width, &s.height);
    if (!a.crop.empty()) {
        auto v = parseNumbers(a.crop, 4);
        if (!v || !((*v)[0] <= (*v)[1] && (*v)[2] <= (*v)[3]))
            wrong("--crop", "takes X0,X1,Y0,Y1, each in 0..1, lower before upper");
        s.crop = {float((*v)[0]), float((*v)[1]), float((*v)[2]), float((*v)[3])};
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
    s.srgb = a.gamma == "srgb" || a.gamma == "sRGB";
    if (!a.gamma.empty() && !s.srgb) {
        auto v = parseNumbers(a.gamma, 1);
        if (!v || !(v->front() >= 0.01 && v->front() <= 100))
            wrong("--gamma", std::string("takes a number from 0.01 to 100") + (v ? "" : ", or srgb") + ", not " + a.gamma);
        s.gamma = float(v->front());
    }
}

void takeDisplays(RenderArguments& a) {
    render::RenderSettings& s = a.settings;
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
}

void checkSettings(RenderArguments& a, const CLI::App& app) {
    render::RenderSettings& s = a.settings;
    if (!a.folder.empty() && chdir(a.folder.c_str()) != 0) wrong("--cwd", "there is no folder \"" + a.folder + "\"");
    takePicture(a);
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
    takeDisplays(a);
    if (a.framesAtOnce > 1 && (a.watch || !a.preview.empty() || !a.tev.empty()))
        wrong("--frames-at-once", "does not go with --watch, --preview and --display tev, which look at one frame");
    if (a.framesAtOnce > 1 && !a.filters.empty())
        wrong("--frames-at-once", "does not go with --filter, which is asked about one request after the other");
    s.direct = !a.noDirect;
    s.indirect = !a.noIndirect;
    if (const std::string fault = s.output.empty() ? "" : faultOfPictureName(s.output, true); !fault.empty()) wrong("-o", fault);
    if (s.output == "-" && (s.samples || s.part))
        wrong("-o", "with --samples or --part a part file lies next to the picture: name a file");
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
    EnvironmentFolders environment = environmentFolders();
    s.lastShaderPaths = environment.of(SearchedFor::Shaders);
    s.lastTexturePaths = environment.of(SearchedFor::Textures);
    a.lastArchivePaths = environment.of(SearchedFor::Archives);
    a.lastProceduralPaths = environment.of(SearchedFor::Procedurals);
    s.environment = std::move(environment.used);
}

/// Without a name RIB comes from standard input, as other renderers have it.
void takeScenes(RenderArguments& a) {
    if (a.scenes.empty() && standardInputHasData()) a.scenes = {"-"};
    if (a.scenes.empty()) throw CLI::RequiredError("scenes: a FILE, or RIB on standard input,");
}

void addScenes(CLI::App& c, RenderArguments& a) {
    c.add_option("scenes", a.scenes,
                 "RIB files (ASCII, binary, gzipped) or models (.ply, .obj, .glb, .fbx and others: shown under a sky by a camera "
                 "that sees all of it). - or no file: standard input. Each file starts from the default state; options of a file "
                 "without a world apply to all later files")
        ->type_name("FILE");
    c.add_option("--model-time", a.modelTime, "Seconds of its animation at which a model (.glb, .fbx, ...) is shown")
        ->type_name("SECONDS");
}

void addPictures(CLI::App& c, RenderArguments& a) {
    render::RenderSettings& s = a.settings;
    c.add_option(
         "-o", s.output,
         std::string("Write the picture to FILE instead of the scene's displays; the extension selects the format (") +
             display::pictureExtensions() +
             "). Depth maps, shadow maps and displays of other outputs are still written. # or %04d stands for the frame number; "
             "without it, the number is inserted before the extension if the scene has several frames. -: write to standard "
             "output, as PNG or in the format of the scene's first display, one frame after the other")
        ->type_name("FILE")
        ->group("Pictures");
    c.add_option("--display", a.displays,
                 "Add a display, for example png:view.png or openexr:all.exr:rgba,N,z; tev:HOST:PORT shows the picture in the "
                 "viewer tev while it renders")
        ->type_name("TYPE:NAME[:MODE]")
        ->allow_extra_args(false)
        ->group("Pictures");
    c.add_flag("--preview{auto}", a.preview,
               "Show the picture in the terminal while it renders: by kitty or sixel graphics if the terminal has them, else by "
               "half blocks; --preview=kitty, sixel or blocks selects one")
        ->check(CLI::IsMember({"auto", "kitty", "sixel", "blocks"}))
        ->group("Pictures");
    c.add_option("--format", a.format, "Size of the picture in pixels")->type_name("WxH")->group("Pictures");
    c.add_option("--resolution-factor", s.resolutionFactor, "Scale both sides of the picture")
        ->check(between(1e-4, 1e4))
        ->type_name("F")
        ->group("Pictures");
    c.add_option("--crop", a.crop, "Render only this window, in fractions of the picture from its upper left corner")
        ->type_name("X0,X1,Y0,Y1")
        ->group("Pictures");
    c.add_option("--gamma", a.gamma,
                 "Transfer curve of the pictures, instead of that of Exposure or of path: a display gamma, 1 for linear, or srgb "
                 "(8-bit pictures; docs/colour.md)")
        ->type_name("G|srgb")
        ->group("Pictures");
    c.add_option("--frames", a.frames, "Render only these frames, for example 1,4-6")->type_name("LIST")->group("Pictures");
}

void addQuality(CLI::App& c, RenderArguments& a) {
    render::RenderSettings& s = a.settings;
    c.add_option("--hider", s.hider, "Override the scene's Hider")
        ->check(CLI::IsMember({"hidden", "raytrace", "path", "photon"}))
        ->type_name("NAME")
        ->group("Quality");
    c.add_option("--spp", s.spp, "Samples per pixel, overrides PixelSamples (default of path: 64)")
        ->check(wholeBetween(1, limits::kSamplesPerPixel))
        ->type_name("N")
        ->group("Quality");
    c.add_option(
         "--noise", s.noise,
         "path: render until the printed noise, the mean relative error of the light on surfaces, is at most E, for example 0.01")
        ->check(positive("0.02 for 2 %"))
        ->type_name("E")
        ->group("Quality");
    c.add_option("--time", s.seconds, "path: stop after approximately this many seconds")
        ->check(positive())
        ->type_name("SECONDS")
        ->group("Quality");
    c.add_option(
         "--samples", a.samples,
         "path: render only samples A to B-1 of every pixel, and write a part file next to the picture for alpenglow merge")
        ->type_name("A:B")
        ->group("Quality");
    c.add_option("--part", a.part, "path: render the K-th of N equal sample ranges; otherwise like --samples")
        ->type_name("K/N")
        ->excludes("--samples")
        ->group("Quality");
    c.add_option("--seed", a.seed,
                 "Seed of all random numbers; equal seeds give equal bits. frame: use the number of each frame, so that noise "
                 "changes from frame to frame")
        ->type_name("N|frame")
        ->group("Quality");
    c.add_option("--max-depth", s.maxDepth, "Maximum number of bounces")
        ->check(wholeBetween(0, limits::kPathDepth))
        ->type_name("N")
        ->group("Quality");
    c.add_option("--sample-clamp", s.sampleClamp, "Scale samples brighter than X down to X: less noise, but biased")
        ->check(notNegative())
        ->type_name("X")
        ->group("Quality");
    c.add_flag("--no-direct", a.noDirect, "Omit direct light")->group("Quality");
    c.add_flag("--no-indirect", a.noIndirect, "Omit diffuse interreflection")->group("Quality");
    c.add_flag("--unbiased", s.unbiased, "Disable energy clamping of shaders that reflect more light than they receive")
        ->group("Quality");
    c.add_option("--preset", a.preset,
                 "slproject: path, gamma 2.2, sample clamp 3, local roulette, box filter, Pathtraced_<spp>_<no>.png")
        ->check(CLI::IsMember({"slproject"}))
        ->type_name("NAME")
        ->group("Quality");
}

void addMachine(CLI::App& c, RenderArguments& a) {
    render::RenderSettings& s = a.settings;
    c.add_option("--threads", s.threads,
                 "Number of threads; default: all processors available to the process (affinity, control groups, Slurm). Does "
                 "not affect the picture")
        ->check(wholeBetween(1, 1024))
        ->type_name("N")
        ->group("Machine");
    c.add_option("--frames-at-once", a.framesAtOnce,
                 "Render N frames of an animation at a time and share --threads and --memory-limit among them. Pictures, "
                 "messages and their order do not change; a frame that reads a file of an earlier frame waits for it")
        ->check(wholeBetween(1, limits::kFramesAtOnce))
        ->type_name("N")
        ->group("Machine");
    c.add_option("--lanes", s.lanes, "SIMD width of shaders, in points; does not affect the picture")
        ->check(CLI::IsMember({4, 8, 16}))
        ->type_name("N")
        ->group("Machine");
    c.add_option("--memory-limit", a.memory,
                 "Stop with status 4 before memory use exceeds SIZE, for example 800M or 4G; default: nine tenths of the "
                 "machine's memory")
        ->type_name("SIZE")
        ->group("Machine");
    c.add_option("--checkpoint", s.checkpoint, "path: save the samples to FILE every half minute and at the end")
        ->type_name("FILE")
        ->group("Machine");
    CLI::Option* resume =
        c.add_flag("--resume", s.resume, "Continue from the checkpoint; start anew if there is none")->group("Machine");
    c.add_flag("--restart", s.restart, "Start anew and replace an existing checkpoint")->excludes(resume)->group("Machine");
    c.add_option("--stats", s.statsFile, "Write statistics of the render and of each frame as JSON (docs/statistics.md)")
        ->type_name("FILE.json")
        ->group("Machine");
    c.add_flag("--stamp", s.stamp,
               "Store command, host, date and render time in the pictures; without it, equal pictures are equal files")
        ->group("Machine");
    c.add_option("--pixel", a.pixel,
                 "Print red, green, blue and coverage of one pixel or of one of its samples; write no picture")
        ->type_name("X,Y[,SAMPLE]")
        ->group("Machine");
    c.add_flag("--watch", a.watch, "Render again when a file of the scene changes: shaders, includes, maps, archives")
        ->group("Machine");
}

void addInput(CLI::App& c, RenderArguments& a) {
    render::RenderSettings& s = a.settings;
    addDialect(c, a.settings.dialect);
    c.add_option("--cwd", a.folder, "Working folder: relative names on the command line and in the scene start here")
        ->type_name("DIR")
        ->group("Input");
    c.add_option("--searchpath", a.searchPaths, "Folders for shaders, textures and archives, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false)
        ->group("Input");
    c.add_option("--rib", a.rib, "RIB requests to read before the scene")
        ->type_name("'REQUESTS'")
        ->allow_extra_args(false)
        ->group("Input");
    c.add_option(
         "--filter", a.filters,
         "A filter that is asked about each request of the scenes and their archives: a library in C++ (RifPlugin.h) with "
         "its arguments, FILE.py, FILE.py:FUNCTION or python:MODULE.FUNCTION; several stand one behind the other")
        ->type_name("'NAME ARGUMENT..'")
        ->allow_extra_args(false)
        ->group("Input");
    c.add_flag("--no-rc", a.noRc, "Read no .alpenglowrc (docs/options.md)")->group("Input");
    c.add_flag("--allow-exec", s.allowExec, "Allow the scene to run programs and load plug-ins")->group("Input");
    c.add_flag("--allow-read", s.allowRead,
               "Allow the scene to read maps and archives anywhere, not only below its own folders and --searchpath")
        ->group("Input");
    c.add_flag("--allow-write", s.allowWrite,
               "Allow the scene to write outside the current folder, to hidden files, and over files that are not pictures")
        ->group("Input");
}

void addMessages(CLI::App& c, RenderArguments& a) {
    c.add_option("--progress", a.progress, "auto, bar, plain or none")
        ->check(CLI::IsMember({"auto", "bar", "plain", "none"}))
        ->type_name("MODE")
        ->group("Messages");
    c.add_flag("-q,--quiet", a.quiet, "Print errors only: no progress, no warnings, no table at the end")->group("Messages");
    c.add_flag("-v,--verbose", a.verbose, "Print notes too")->group("Messages");
}

} // namespace

void checkRenderArguments(RenderArguments& a, const CLI::App& app) {
    takeScenes(a);
    checkSettings(a, app);
}

void addRenderOptions(CLI::App& c, RenderArguments& a) {
    addScenes(c, a);
    addPictures(c, a);
    addQuality(c, a);
    addMachine(c, a);
    addInput(c, a);
    addMessages(c, a);
    c.footer("Examples:\n  alpenglow scene.rib                          as the scene says\n"
             "  alpenglow render --hider path --noise 0.02 -o out.exr scene.rib\n"
             "  alpenglow render --samples 0:32 -o a.exr scene.rib    and 32:64 to b.exr elsewhere; then merge a.exr b.exr -o "
             "whole.exr\n"
             "Ctrl-C keeps the complete passes and writes the picture; a second Ctrl-C stops at once.");
    for (CLI::Option* o : c.get_options())
        if (o->get_items_expected_max() == 1) o->take_last(); // a script's option gives way to the user's behind it
}

} // namespace alpenglow::cli
