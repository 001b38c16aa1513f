// alpenglow compile: checks shaders, compiles them to machine code, shows what became of them.
#include "base/installation.h"
#include "base/limits.h"
#include "base/printable.h"
#include "cli/command.h"
#include "cli/jsonreport.h"
#include "cli/optionmanual.h"
#include "rsl/compiler.h"
#include "rsl/front/complete.h"
#include "rsl/messages/messages.h"
#include "rsl/nonlinear.h"
#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <tuple>

namespace alpenglow::cli {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr const char* kStandardInput = "<stdin>";

/// The line of a place; `input` is what came by standard input.
std::string lineOf(const SourcePlace& p, const std::string& input) {
    std::ifstream file;
    std::istringstream text;
    const bool own = p.file == kStandardInput;
    if (own) text.str(input);
    else file.open(p.file, std::ios::binary);
    std::istream& in = own ? static_cast<std::istream&>(text) : file;
    std::string line;
    for (int n = 0; n < p.line && std::getline(in, line); ++n) {}
    while (!line.empty() && (line.back() == '\r' || line.back() == '\n')) line.pop_back();
    return in || !line.empty() ? line : "";
}

/// The warnings of rsl/nonlinear.h with their lines.
void warnNonlinear(const rsl::CompiledShader& shader, const rsl::KernelOptions& options, Diagnostics& diags) {
    for (Diagnostic& d : rsl::nonlinearUses(shader.program(), shader.shader(), options)) {
        if (d.place.file.empty()) d.place.file = shader.path();
        diags.report(std::move(d));
    }
}

/// The shader and, of a class, what else its methods make it.
std::vector<std::shared_ptr<const rsl::CompiledShader>> kindsOf(const std::shared_ptr<const rsl::CompiledShader>& shader) {
    std::vector<std::shared_ptr<const rsl::CompiledShader>> all{shader};
    for (const auto& s : shader->program().shaders)
        if (shader->shader().object && s->name == shader->name() && s->kind != shader->kind())
            if (auto v = rsl::ShaderCompiler::variant(shader, s->kind)) all.push_back(std::move(v));
    return all;
}

struct CompileArguments {
    std::vector<std::string> files, searchPaths, defines;
    std::string dialect, explain;
    int lanes = 16;
    bool ir = false, llvm = false, path = false, mixed = false, suspend = false, quiet = false, warn = false, json = false,
         allowExec = false;
};

/// The command's options. The one that asks for an explanation comes back.
CLI::Option* addOptions(CLI::App& c, CompileArguments& a) {
    c.add_option("shaders", a.files, "RSL files; - is standard input")->type_name("FILE");
    CLI::Option* explain = c.add_option("--explain", a.explain, "Explain the message with this id, or list all messages")
                               ->expected(0, 1)
                               ->type_name("[ID]");
    c.add_option("-I,--searchpath", a.searchPaths, "Folders for #include, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    c.add_option("-D", a.defines, "Define a macro")->type_name("NAME[=TEXT]")->allow_extra_args(false);
    addDialect(c, a.dialect);
    c.add_flag("--allow-exec", a.allowExec, "Allow the shader to load plug-ins");
    c.add_option("--lanes", a.lanes, "SIMD width of the code, in points")->check(CLI::IsMember({4, 8, 16}))->type_name("N");
    c.add_flag("--path", a.path, "As for Hider \"path\": diffuse, specular and phong become requests");
    c.add_flag("--mixed", a.mixed, "Compile the varying build: uniform values in lanes, for batches of several instances");
    c.add_flag("--suspend", a.suspend, "Compile the suspending form even if the shader is affine");
    c.add_flag("--dump-ir", a.ir, "Print the intermediate code after all passes");
    c.add_flag("--dump-llvm", a.llvm, "Print the LLVM code too");
    c.add_flag("-W,--warnings", a.warn, "Warn about unused, uninitialised and (under path) non-linear use, too");
    c.add_flag("--json", a.json, "Print diagnostics as JSON on standard output, for editors");
    c.add_flag("-q,--quiet", a.quiet, "Print errors only");
    c.footer("All shaders of a file are compiled. Errors are shown with file:line:column, the line and a caret. Exit status 0 "
             "when all shaders compile, else 1.");
    return explain;
}

/// `paths`: where shaders are looked for.
rsl::ShaderCompiler::Settings settingsOf(const CompileArguments& a, std::vector<std::string>& paths) {
    rsl::ShaderCompiler::Settings settings;
    for (const std::string& d : a.defines) {
        size_t eq = d.find('=');
        settings.defines.emplace_back(d.substr(0, eq), eq == std::string::npos ? "1" : d.substr(eq + 1));
    }
    settings.lint = a.warn;
    settings.dialect = a.dialect;
    paths = {"."};
    for (std::string& f : folders(a.searchPaths)) paths.push_back(std::move(f));
    for (std::string& f : environmentShaders()) paths.push_back(std::move(f));
    if (std::string s = shippedShaders(); !s.empty()) paths.push_back(s);
    settings.allowExec = a.allowExec;
    settings.pluginPaths = paths;
    return settings;
}

} // namespace

void addCompile(CLI::App& app, int* status) {
    auto a = std::make_shared<CompileArguments>();
    CLI::App* c = app.add_subcommand("compile", "Check and compile shaders");
    CLI::Option* explain = addOptions(*c, *a);
    c->callback([a, explain, status] {
        if (explain->count()) {
            *status = printTopic(Topic::Messages, a->explain, a->json);
            return;
        }
        if (a->files.empty()) throw CLI::RequiredError("shaders");
        OrderedJson report = OrderedJson::array();
        const auto print = printer(a->quiet ? Severity::Error : Severity::Warning);
        std::string current, input;                                       // the current shader, and the text from standard input
        std::set<std::tuple<std::string, int, int, std::string>> printed; // messages of a file, each printed once
        Diagnostics diags([&, print, lines = limits::kSourceLines](Diagnostic d) mutable {
            if (d.place.line > 0 && !printed.emplace(d.place.file, d.place.line, d.place.column, d.message).second) return;
            if (d.place.file.empty() && a->json) d.place.file = current;
            if (d.sourceLine.empty() && d.place.line > 0 && lines-- > 0) d.sourceLine = lineOf(d.place, input);
            rsl::complete(d);
            if (d.id == rsl::msg::kKindNullHandle.id) return; // which co-shaders there are, only a scene knows
            if (!a->json) print(d);
            else if (!a->quiet || d.severity >= Severity::Error) report.push_back(diagnosticJson(d));
        });
        std::vector<std::string> paths;
        rsl::ShaderCompiler::Settings settings = settingsOf(*a, paths);
        rsl::ShaderCompiler compiler(settings);
        rsl::KernelOptions options;
        options.lanes = a->lanes;
        options.path = a->path;
        options.mixed = a->mixed;
        options.suspend = a->suspend;
        int failed = 0;
        OrderedJson shaders = OrderedJson::array();
        for (const std::string& f : a->files) {
            current = f;
            const int before = diags.errors();
            if (f == "-") input.assign(std::istreambuf_iterator<char>(std::cin), {});
            const auto first = f == "-" ? compiler.loadText(input, kStandardInput, diags) : compiler.load(f, paths, diags);
            bool all = first != nullptr;
            if (!first) shaders.push_back({{"file", f}, {"ok", false}});
            for (const auto& shader : rsl::ShaderCompiler::allOfFile(first)) {
                bool ok = true;
                for (const auto& s : kindsOf(shader)) {
                    if (!a->json && (a->ir || a->llvm)) {
                        std::string text = compiler.dump(s, options, diags, a->llvm);
                        std::fputs(printable(text).c_str(), stdout);
                        ok = ok && !text.empty();
                    }
                    ok = ok && compiler.kernel(s, options, diags) != nullptr;
                    if (ok && a->warn && s->kind() == rsl::ShaderKind::Surface) warnNonlinear(*s, options, diags);
                }
                shaders.push_back({{"file", f}, {"ok", ok}, {"name", shader->name()}, {"type", toString(shader->kind())}});
                all = all && ok;
            }
            if (!all) {
                ++failed;
                if (diags.errors() == before) diags.report(diagnostic(rsl::msg::kCannotCompile, Rie::NoShader, {f}));
            }
        }
        if (a->json) printReport({{"shaders", std::move(shaders)}}, std::move(report));
        *status = failed ? kDoneWithErrors : kDone;
    });
}

} // namespace alpenglow::cli
