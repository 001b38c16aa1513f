// alpenglow compile: checks shaders, compiles them to machine code, shows what became of them.
#include "cli/command.h"
#include "rsl/compiler.h"
#include <CLI/CLI.hpp>
#include <memory>

namespace alpenglow::cli {

void addCompile(CLI::App& app, int* status) {
    struct Arguments {
        std::vector<std::string> files, searchPaths, defines;
        int lanes = 16;
        bool ir = false, llvm = false, path = false, mixed = false, suspend = false, quiet = false;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = app.add_subcommand("compile", "Check and compile shaders");
    c->add_option("shaders", a->files, "RSL files")->required();
    c->add_option("-I,--searchpath", a->searchPaths, "Folders for #include, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    c->add_option("-D", a->defines, "Define a macro")->type_name("NAME[=TEXT]")->allow_extra_args(false);
    c->add_option("--lanes", a->lanes, "Width of the machine code")->check(CLI::IsMember({4, 8, 16}))->type_name("N");
    c->add_flag("--path", a->path, "As under Hider \"path\": diffuse, specular and phong are requests to the light transport");
    c->add_flag("--mixed", a->mixed, "Build V: uniform values in lanes, for batches of several instances");
    c->add_flag("--suspend", a->suspend, "The suspending form even where the affine one is possible");
    c->add_flag("--dump-ir", a->ir, "Print our intermediate code after all passes");
    c->add_flag("--dump-llvm", a->llvm, "Print LLVM's too");
    c->add_flag("-q,--quiet", a->quiet, "Errors only");
    c->footer("Errors are shown with file:line:column, the line and a caret. Exit status 0 when all shaders compile, else 1.");
    c->callback([a, status] {
        Diagnostics diags(printer(a->quiet ? Severity::Error : Severity::Warning));
        rsl::ShaderCompiler::Settings settings;
        for (const std::string& d : a->defines) {
            size_t eq = d.find('=');
            settings.defines.emplace_back(d.substr(0, eq), eq == std::string::npos ? "1" : d.substr(eq + 1));
        }
        rsl::ShaderCompiler compiler(settings);
        std::vector<std::string> paths{"."};
        for (std::string& f : folders(a->searchPaths)) paths.push_back(std::move(f));
        for (std::string& f : environmentShaders()) paths.push_back(std::move(f));
        if (std::string s = shippedShaders(); !s.empty()) paths.push_back(s);
        rsl::KernelOptions options;
        options.lanes = a->lanes;
        options.path = a->path;
        options.mixed = a->mixed;
        options.suspend = a->suspend;
        int failed = 0;
        for (const std::string& f : a->files) {
            auto shader = compiler.load(f, paths, diags);
            bool ok = shader != nullptr;
            if (ok && (a->ir || a->llvm)) {
                std::string text = compiler.dump(shader, options, diags, a->llvm);
                std::fputs(text.c_str(), stdout);
                ok = !text.empty();
            }
            if (ok) ok = compiler.kernel(shader, options, diags) != nullptr;
            if (!ok) {
                ++failed;
                if (diags.errors() == 0) diags.report(Severity::Error, Rie::NoShader, {f}, "it cannot be compiled");
            }
        }
        *status = failed ? kDoneWithErrors : kDone;
    });
}

} // namespace alpenglow::cli
