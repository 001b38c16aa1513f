// alpenglow view: a scene in the browser while it renders.
#include "view/view.h"
#include "base/installation.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/processors.h"
#include "cli/command.h"
#include "cli/foreignmodel.h"
#include "cli/modelscene.h"
#include "cli/ranges.h"
#include "cli/shaderdescription.h"
#include "cli/version.h"
#include "models/modelfile.h"
#include "ri/models/model.h"
#include "rsl/compiler.h"
#include <CLI/CLI.hpp>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <spawn.h>
#include <unistd.h>

namespace alpenglow::cli {
namespace {

struct ViewArguments {
    render::RenderSettings settings;
    std::string scene, format, memory, folder, gamma;
    std::vector<std::string> searchPaths, rib;
    int port = 0, frame = 0;
    bool noDirect = false, noIndirect = false, open = false, watch = false, quiet = false, verbose = false, framed = false;
};

void checkLate(ViewArguments& a) {
    render::RenderSettings& s = a.settings;
    auto wrong = [](const std::string& option, const std::string& what) { throw CLI::ValidationError(option, what); };
    if (!a.folder.empty() && chdir(a.folder.c_str()) != 0) wrong("--cwd", "there is no folder \"" + a.folder + "\"");
    if (a.scene == "-") wrong("scene", "is a file: what comes from standard input cannot be read again");
    if (!a.format.empty()) readFormat(a.format, &s.width, &s.height);
    s.memoryLimit = defaultMemoryLimit();
    if (!a.memory.empty()) {
        auto bytes = parseMemorySize(a.memory);
        if (!bytes) wrong("--memory-limit", "takes a size like 800M or 4G");
        s.memoryLimit = *bytes;
    }
    s.srgb = a.gamma == "srgb" || a.gamma == "sRGB";
    if (!a.gamma.empty() && !s.srgb) {
        auto v = parseNumbers(a.gamma, 1);
        if (!v || !(v->front() >= 0.01 && v->front() <= 100))
            wrong("--gamma", "takes a number from 0.01 to 100, or srgb, not " + a.gamma);
        s.gamma = float(v->front());
    }
    s.texturePaths = s.shaderPaths = folders(a.searchPaths);
    for (std::string& e : environmentShaders()) s.shaderPaths.push_back(std::move(e));
    s.shippedShaders = shippedShaders();
}

/// What alpenglow info says of a shader, without what it says on the way.
nlohmann::json aboutShader(const std::string& name, const std::vector<std::string>& folders, const std::string& dialect) {
    Diagnostics quiet;
    rsl::ShaderCompiler::Settings settings;
    settings.dialect = dialect;
    settings.keepWritten = true;
    rsl::ShaderCompiler compiler(settings);
    const auto shader = compiler.load(name, folders, quiet);
    return shader ? nlohmann::json(descriptionJson(describe(compiler, shader, quiet))) : nlohmann::json();
}

/// Hands the address to the desktop's browser, by xdg-open. "" or why not.
std::string openInBrowser(std::string address) {
    std::string program = "xdg-open";
    char* const words[] = {program.data(), address.data(), nullptr};
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files); // what browsers print does not belong between our lines
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&files, fd, "/dev/null", O_RDWR, 0);
    posix_spawnattr_t how;
    posix_spawnattr_init(&how);
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP); // Ctrl-C is for us
    pid_t child = 0;
    const int fault = posix_spawnp(&child, words[0], &files, &how, words, environ);
    posix_spawnattr_destroy(&how);
    posix_spawn_file_actions_destroy(&files);
    return fault ? std::strerror(fault) : "";
}

int runView(const ViewArguments& a) {
    const MemoryLimit limit(a.settings.memoryLimit, a.settings.threads > 0 ? a.settings.threads : defaultThreads());
    const StopFlag* stop = watchInterrupts();
    const Diagnostics::Handler print = printer(a.quiet ? Severity::Error : a.verbose ? Severity::Info : Severity::Warning);
    view::ViewOptions o;
    o.settings = a.settings;
    o.scene = a.scene;
    o.watch = a.watch;
    if (a.framed) o.frame = a.frame;
    o.reader.searchPaths = folders(a.searchPaths);
    o.reader.regularFiles = true;
    o.reader.allowExec = a.settings.allowExec;
    o.reader.allowRead = a.settings.allowRead;
    ModelFolder folder; // of the maps of a model
    if (const std::string& f = folder.pathFor({a.scene}); !f.empty()) o.settings.texturePaths.push_back(f);
    Diagnostics reported(print);
    o.read = [&a, &folder, &reported](ri::RibReader& reader) {
        for (const std::string& r : a.rib) reader.readMemory(r, "--rib");
        reader.nextScene();
        if (models::namedAsForeignModel(a.scene) && ::access(a.scene.c_str(), R_OK) == 0) {
            if (const std::string text = folder.scene(a.scene, 0, reported); !text.empty()) reader.readMemory(text, a.scene);
        } else if (ri::namedAsModel(a.scene) && ::access(a.scene.c_str(), R_OK) == 0)
            reader.readMemory(modelScene(a.scene), a.scene);
        else reader.readFile(a.scene);
    };
    o.describe = [dialect = a.settings.dialect](const std::string& name, const std::vector<std::string>& paths) {
        return aboutShader(name, paths, dialect);
    };
    o.print = print;
    std::string fault;
    const view::ViewEnd end = view::view(
        std::move(o), a.port, stop,
        [&](const std::string& address) {
            std::printf("%s\n", address.c_str());
            std::fflush(stdout);
            if (a.open)
                if (const std::string why = openInBrowser(address); !why.empty())
                    print(
                        {Severity::Warning, Rie::System, {}, "xdg-open cannot be run: " + why, "open the address yourself", {}});
            if (!a.quiet) std::fputs("alpenglow: open this address in a browser on this machine; Ctrl-C ends\n", stderr);
        },
        &fault);
    if (end == view::ViewEnd::PortTaken) {
        Diagnostic d{Severity::Error, Rie::System, {}, fault, "without --port a free one is taken", {}};
        print(d);
        return kWrongUse;
    }
    return end == view::ViewEnd::NoScene ? kNothingRendered : kDone;
}

} // namespace

void addView(CLI::App& app, int* status) {
    auto a = std::make_shared<ViewArguments>();
    render::RenderSettings& s = a->settings;
    s.software = softwareName();
    CLI::App* c = app.add_subcommand("view", "Show a scene in the browser while it renders (docs/view.md)");
    c->add_option("scene", a->scene, "RIB file, ASCII, binary or gzipped, or a model (.ply, .obj, .glb, ...)")
        ->type_name("FILE")
        ->required();
    c->add_option("--port", a->port, "Port on 127.0.0.1; default: a free port")->check(wholeBetween(1, 65535))->type_name("N");
    c->add_flag("--open", a->open, "Open the page in the default browser (xdg-open)");
    c->add_flag("--watch", a->watch, "Reload the scene when one of its files changes; keep the camera");
    CLI::Option* frame =
        c->add_option("--frame", a->frame, "Frame number; default: the first frame with a picture")->type_name("N");
    c->add_option("--format", a->format, "Size of the picture in pixels")->type_name("WxH");
    c->add_option("--resolution-factor", s.resolutionFactor, "Scale both sides of the picture")
        ->check(between(1e-4, 1e4))
        ->type_name("F");
    c->add_option("--hider", s.hider, "Override the scene's Hider")
        ->check(CLI::IsMember({"hidden", "raytrace", "path"}))
        ->type_name("NAME");
    c->add_option("--gamma", a->gamma, "Initial transfer curve of the page: a display gamma, or srgb")->type_name("G|srgb");
    c->add_option("--seed", s.seed, "Seed of all random numbers")->type_name("N");
    c->add_option("--threads", s.threads, "Number of threads; default: all processors available to the process")
        ->check(wholeBetween(1, 1024))
        ->type_name("N");
    c->add_option("--memory-limit", a->memory, "Use no more memory than SIZE, for example 800M or 4G")->type_name("SIZE");
    addDialect(*c, s.dialect);
    c->add_option("--cwd", a->folder, "Working folder; pictures are saved here")->type_name("DIR");
    c->add_option("--searchpath", a->searchPaths, "Folders for shaders, textures and archives, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    c->add_option("--rib", a->rib, "RIB requests to read before the scene")->type_name("'REQUESTS'")->allow_extra_args(false);
    c->add_flag("--allow-exec", s.allowExec, "Allow the scene to run programs and load plug-ins");
    c->add_flag("--allow-read", s.allowRead,
                "Allow the scene to read maps and archives anywhere, not only below its own folders and --searchpath");
    c->add_flag("-q,--quiet", a->quiet, "Print errors only");
    c->add_flag("-v,--verbose", a->verbose, "Print notes too");
    c->footer("Prints the address of the page, which contains a secret token, and serves the page on 127.0.0.1 until Ctrl-C.");
    c->callback([a, frame, status] {
        a->framed = frame->count() > 0;
        checkLate(*a);
        *status = runView(*a);
    });
}

} // namespace alpenglow::cli
