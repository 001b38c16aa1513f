#include "python/settings.h"
#include "base/installation.h"
#include "cli/command.h"
#include "cli/oldflags.h"
#include "cli/version.h"
#include "python/python.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <dlfcn.h>

namespace alpenglow::python {
namespace {

/// Options that are not for a part of somebody else's process, with what to do instead.
constexpr std::pair<const char*, const char*> kRefused[] = {
    {"--watch", "call render() again"},
    {"--cwd", "os.chdir() does this"},
    {"--preview", "progress= reports how far it is"},
    {"--frames-at-once", "processes are yours: multiprocessing"},
    {"--pixel", "take it from the picture"},
};

/// Python keeps the names of a module to itself. Libraries of procedurals (DynamicLoad) are to find the C binding in it.
void showBinding() {
    if (void* self = dlopen(codeFile().c_str(), RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL)) dlclose(self);
}

std::string unknownFlag(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* o : app.get_options())
        for (const std::string& n : o->get_lnames()) names.push_back("--" + n);
    for (const std::string& word : app.remaining()) {
        const std::string name = word.substr(0, word.find('=')), near = nearestName(name, names);
        return "there is no option " + name + (near.empty() ? "" : "; did you mean " + near + "?");
    }
    return "unknown options";
}

} // namespace

cli::RenderArguments renderArguments(std::vector<std::string> flags) {
    cli::TranslatedFlags t = cli::translateOldFlags(flags);
    if (!t.error.empty()) throw Error(t.error);
    for (const auto& [name, instead] : kRefused)
        for (const std::string& f : t.arguments)
            if (f == name || f.starts_with(std::string(name) + "="))
                throw Error(std::string(name) + " is not for use in Python: " + instead);
    cli::RenderArguments a;
    a.settings.software = cli::softwareName();
    a.settings.command = "Python";
    CLI::App app("render");
    cli::addRenderOptions(app, a);
    flags = t.arguments;
    flags.push_back("scene");
    std::reverse(flags.begin(), flags.end()); // as the parser takes vectors
    try {
        app.parse(flags);
        cli::checkRenderArguments(a, app);
    } catch (const CLI::ExtrasError&) { throw Error(unknownFlag(app)); } catch (const CLI::Error& e) {
        throw Error(e.what());
    }
    if (!a.tev.empty()) throw Error("--display tev is not for use in Python");
    a.scenes.clear();
    if (a.memory.empty()) a.settings.memoryLimit = 0; // the process is not ours
    if (a.settings.allowExec) showBinding();
    a.settings.progress = render::ProgressMode::None;
    return a;
}

ri::ReaderOptions readerOptions(const cli::RenderArguments& a, bool defers) {
    ri::ReaderOptions o;
    o.searchPaths = cli::folders(a.searchPaths);
    o.lastArchivePaths = a.lastArchivePaths;
    o.lastProceduralPaths = a.lastProceduralPaths;
    o.allowExec = a.settings.allowExec;
    o.allowRead = a.settings.allowRead;
    o.reads = a.settings.reads;
    o.stop = a.settings.stop;
    o.frames = a.frameList;
    o.defers = defers;
    return o;
}

int statusOf(const render::Outcome& outcome, const Diagnostics& diags, bool interrupted, bool memory) {
    if (interrupted) return cli::kInterrupted;
    if (outcome.outputFailed) return cli::kOutputFailed;
    memory |= outcome.outOfMemory;
    for (const Diagnostic& d : diags.all())
        memory |= d.severity == Severity::Severe && (d.code == Rie::NoMem || d.code == Rie::Limit);
    if (memory) return cli::kLimit;
    if (outcome.rendered == 0 && (outcome.refused > 0 || outcome.textures == 0)) return cli::kNothingRendered;
    return diags.errors() ? cli::kDoneWithErrors : cli::kDone;
}

} // namespace alpenglow::python
