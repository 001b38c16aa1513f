// alpenglow eval: RSL at one point.
#include "base/printable.h"
#include "cli/command.h"
#include "cli/jsonreport.h"
#include "rsl/evaluate.h"
#include "services/withoutscene.h"
#include <CLI/CLI.hpp>
#include <memory>
#include <unistd.h>

namespace alpenglow::cli {

void addEval(CLI::App& app, int* status) {
    struct Arguments {
        std::string setup, expression, dialect;
        int lanes = 16;
        bool allowExec = false, json = false;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = app.add_subcommand("eval", "Run RSL at one point and print the value");
    c->add_option("expression", a->expression, "An expression, or statements that print")->type_name("RSL")->required();
    c->add_option("--setup", a->setup, "Statements to run first, for example 'float x = 2;'")->type_name("'STATEMENTS'");
    c->add_option("--lanes", a->lanes, "SIMD width of the machine code, in points")
        ->check(CLI::IsMember({4, 8, 16}))
        ->type_name("N");
    addDialect(*c, a->dialect);
    c->add_flag("--allow-exec", a->allowExec, "Allow the shader to load plug-ins");
    c->add_flag("--json", a->json, "Print JSON, with messages under \"diagnostics\"");
    c->footer(
        "The point: u=v=s=t=0.5, P=(0,0,0), N=(0,0,1), I=(0,0,1), Cs=Os=1, du=dv=1. Numbers are printed as %.7g, separated by\n"
        "spaces, a string as it is. Maps are searched for in the current folder. There are no lights and no "
        "geometry.\n\nExamples:\n  alpenglow eval 'noise(P + 1.5)'\n"
        "  alpenglow eval --setup 'color c = (1, .5, 0);' 'ctransform(\"hsv\", c)'");
    c->callback([a, status] {
        nlohmann::ordered_json reported;
        Diagnostics diags(printerOr(a->json, reported));
        rsl::ShaderCompiler::Settings settings;
        settings.allowExec = a->allowExec;
        settings.dialect = a->dialect;
        settings.pluginPaths = {"."};
        for (std::string& f : environmentShaders()) settings.pluginPaths.push_back(std::move(f));
        rsl::ShaderCompiler compiler(settings);
        rsl::KernelOptions options;
        options.lanes = a->lanes;
        services::WithoutScene services({"."}, diags);
        const Vec3 point;
        services.setPoints({0, 0, -1}, {&point, 1});
        const auto answer = [&](const rsl::CompiledKernel& k, int32_t site, int32_t first, uint64_t mask, int32_t lanes,
                                const float* in, float* out) { return services.answer(k, site, first, mask, lanes, in, out); };
        rsl::Evaluation e = rsl::evaluate(compiler, a->setup, a->expression, options, diags, answer);
        if (a->json) {
            nlohmann::ordered_json found = {{"ok", e.ok}, {"printed", e.printed}};
            if (e.ok && e.type.base != shadeops::Base::Void)
                found.update({{"type", toString(e.type)}, {"text", e.text}, {"numbers", e.numbers}});
            printReport(std::move(found), std::move(reported));
        } else {
            std::fputs(printable(e.printed).c_str(), stdout);
        }
        if (!a->json && e.ok && e.type.base != shadeops::Base::Void)
            std::printf("%s\n", (isatty(STDOUT_FILENO) ? printable(e.text) : e.text).c_str());
        *status = e.ok && diags.errors() == 0 ? kDone : kDoneWithErrors;
    });
}

} // namespace alpenglow::cli
