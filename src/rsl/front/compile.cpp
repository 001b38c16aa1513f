// The way of one file: read, preprocess, parse, check, report.
#include "rsl/front/borrowed.h"
#include "rsl/front/checker.h"
#include "rsl/front/classes.h"
#include "rsl/front/clone.h"
#include "rsl/front/colournames.h"
#include "rsl/front/headers.h"
#include "rsl/front/inspect.h"
#include "rsl/front/library.h"
#include "rsl/front/lint.h"
#include "rsl/front/structs.h"
#include "rsl/messages/messages.h"
#include <algorithm>

namespace alpenglow::rsl {

using namespace front;

namespace {

/// What `plugin "name"` asks for. What is missing is reported once; the calls of its functions then say nothing.
void findPlugins(Unit& unit, const FrontOptions& options, const std::string& file, SourceSet& sources, Program& program) {
    const size_t slash = file.find_last_of('/');
    const std::string folder = slash == std::string::npos ? "." : file.substr(0, slash);
    for (const PluginUse& use : unit.plugins) {
        Raised why = msg::kPluginRefused(use.name);
        std::string hint;
        std::shared_ptr<const Plugin> plugin;
        if (options.plugin) plugin = options.plugin(use.name, folder, why, hint);
        if (plugin) {
            if (std::find(program.plugins.begin(), program.plugins.end(), plugin) == program.plugins.end())
                program.plugins.push_back(std::move(plugin));
            continue;
        }
        sources.report(use.place, why, hint);
        unit.incomplete = true;
    }
}

/// keep: the program is returned after errors, too.
std::unique_ptr<Program> compile(const std::string& text, const std::string& name, bool isFile, const FrontOptions& options,
                                 Diagnostics& diagnostics, bool keep = false) {
    SourceSet sources;
    auto program = std::make_unique<Program>();
    program->rispecSpecular = options.rispecSpecular || dialectRispecSpecular(options.dialect);
    const int main = sources.add(name, text);
    if (isFile) program->dependencies.push_back(name);
    Preprocessed p = preprocess(sources, main, options);
    if (dialectLitPoint(options.dialect)) readLitPoints(p);
    program->preprocessed = p.text();
    program->dependencies.insert(program->dependencies.end(), p.dependencies.begin(), p.dependencies.end());
    hashComments(sources, p);
    readBorrowedWords(sources, p);
    Parser parser(sources);
    Library library(sources, parser);
    library.readNamed(p.tokens);
    parser.read(p);
    Unit& unit = parser.unit();
    addLightMethods(unit, library);
    addLightingMethods(unit, library, sources);
    program->structs = std::move(unit.structs);
    checkStructs(*program, sources);
    addStructMethods(unit, *program);
    expandClasses(unit, sources);
    if (unit.shaders.empty() && unit.functions.empty() && sources.errors() == 0) sources.report({main, 1, 1}, msg::kNoShader);
    findPlugins(unit, options, name, sources, *program);
    Checker checker(sources, unit, *program);
    checker.run();
    std::unique_ptr<Program> written; // with its structures, which the warnings of -W and tools read
    if ((options.lint || options.keepWritten) && !program->structs.empty()) written = clone(*program);
    lowerStructs(*program, sources, checker);
    // An include that is missing does no harm when nothing of it is missed.
    for (const auto& m : p.missing) {
        const bool harm = unit.missed || sources.errors() > 0;
        sources.report(m.place, harm ? msg::kIncludeMissing(m.name) : msg::kIncludeUnused(m.name));
    }
    const bool failed = sources.errors() > 0;
    checkColourNames(*program, sources);
    if (options.lint) checker.warnOfNumbers();
    if (options.lint) lint(written ? *written : *program, p.tokens, unit.skipped, sources);
    sources.flush(diagnostics);
    program->files = sources.names();
    if (written) written->files = program->files;
    if (options.keepWritten) program->written = std::move(written);
    if (failed && !keep) return nullptr;
    return program;
}

} // namespace

std::unique_ptr<Program> compileFile(const std::string& path, const FrontOptions& options, Diagnostics& diagnostics) {
    auto text = readSource(path);
    if (!text) {
        diagnostics.report(diagnostic(msg::kShaderUnreadable, Rie::NoFile, {path, 0, 0}));
        return nullptr;
    }
    return compile(*text, path, true, options, diagnostics);
}

std::unique_ptr<Program> compileText(const std::string& text, const std::string& name, const FrontOptions& options,
                                     Diagnostics& diagnostics) {
    return compile(text, name, false, options, diagnostics);
}

std::unique_ptr<Program> inspectText(const std::string& text, const std::string& name, const FrontOptions& options,
                                     Diagnostics& diagnostics) {
    FrontOptions o = options;
    o.keepWritten = true;
    return compile(text, name, false, o, diagnostics, true);
}

} // namespace alpenglow::rsl
