// alpenglow merge: one picture of parts that were rendered with --samples.
#include "cli/command.h"
#include "cli/jsonreport.h"
#include "render/filmpicture.h"
#include <CLI/CLI.hpp>
#include <memory>

namespace alpenglow::cli {

void addMerge(CLI::App& app, int* status) {
    struct Arguments {
        std::vector<std::string> parts;
        std::string output, expect;
        std::vector<std::string> searchPaths;
        render::MergeSettings settings;
        bool json = false;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = app.add_subcommand("merge", "Add parts rendered with --samples; the same bits as one render");
    c->add_option("parts", a->parts, "Pictures with their .part files in the same folder, or .part files, in any order")
        ->type_name("FILE")
        ->required();
    c->add_option(
         "-o", a->output,
         "Write the picture to FILE, and displays of other outputs as the scene says; default: all displays of the scene")
        ->type_name("FILE");
    c->add_option("--expect", a->expect, "Samples that the parts must contain together; missing or additional ones are errors")
        ->type_name("A:B");
    c->add_flag("--allow-write", a->settings.allowWrite, "Allow display names outside the current folder");
    c->add_flag("--allow-exec", a->settings.allowExec, "Allow the imager to load plug-ins");
    c->add_option("--searchpath", a->searchPaths,
                  "Folders for imager shaders, searched before those of the render, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    c->add_flag("--json", a->json, "Print messages as JSON, under \"diagnostics\"");
    c->footer(
        "Parts fit when scene, options, seed and crop window are the same and no sample is in two of them. Samples that are\n"
        "missing between them are warned about; the picture is written all the same, with a part file next to it, so that\n"
        "the missing part can be merged with it later.");
    c->callback([a, status] {
        if (const std::string fault = a->output.empty() ? "" : faultOfPictureName(a->output, true); !fault.empty())
            throw CLI::ValidationError("-o", fault);
        if (!a->expect.empty()) {
            a->settings.expect = render::rangeFromText(a->expect);
            if (!a->settings.expect)
                throw CLI::ValidationError("--expect", "takes A:B with A < B: samples A to B-1, for example 0:64");
        }
        nlohmann::ordered_json reported;
        Diagnostics diags(printerOr(a->json, reported));
        a->settings.shaderPaths = folders(a->searchPaths);
        switch (render::mergePictures(a->parts, a->output, a->settings, diags)) {
        case render::MergeResult::Done:
            *status = diags.errors() ? kDoneWithErrors : kDone;
            break;
        case render::MergeResult::NoInput:
            *status = kNothingRendered;
            break;
        case render::MergeResult::NoOutput:
            *status = kOutputFailed;
            break;
        }
        if (a->json) printReport({{"merged", *status == kDone || *status == kDoneWithErrors}}, std::move(reported));
    });
}

} // namespace alpenglow::cli
