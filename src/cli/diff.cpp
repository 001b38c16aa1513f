// alpenglow diff: how far two pictures are apart.
#include "display/diff.h"
#include "cli/command.h"
#include "cli/ranges.h"
#include "display/imageio.h"
#include <CLI/CLI.hpp>
#include <memory>

namespace alpenglow::cli {

void addDiff(CLI::App& app, int* status) {
    struct Arguments {
        std::string a, b, output;
        double tolerance = 0;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = app.add_subcommand("diff", "Compare two pictures: mean and maximum error, RMSE");
    c->add_option("a", a->a, "Picture: EXR, TIFF, PNG, JPEG, Radiance, zfile or Pixar's native texture")
        ->type_name("FILE")
        ->required();
    c->add_option("b", a->b, "Picture of the same size")->type_name("FILE")->required();
    c->add_option("-o", a->output, "Write the absolute difference as a picture")->type_name("FILE");
    c->add_option("--tolerance", a->tolerance, "Largest error that is still equal; 0 when not given")
        ->check(notNegative())
        ->type_name("X");
    c->footer("Exit status 0 when the largest error is within the tolerance, 1 when it is not, 3 when the pictures cannot be "
              "compared,\n"
              "5 when the difference cannot be written.");
    c->callback([a, status] {
        Diagnostics diags(printer());
        if (const std::string fault = a->output.empty() ? "" : faultOfPictureName(a->output, false); !fault.empty())
            throw CLI::ValidationError("-o", fault);
        auto first = display::readImage(a->a, diags), second = display::readImage(a->b, diags);
        auto result = first && second ? display::compareImages(*first, *second, diags) : std::nullopt;
        if (!result) {
            *status = kNothingRendered;
            return;
        }
        std::fputs(display::toString(*result).c_str(), stdout);
        *status = result->within(a->tolerance) ? kDone : kDoneWithErrors;
        if (a->output.empty()) return;
        display::WriteOptions w;
        w.format = display::formatOfExtension(a->output).value_or(display::Format::Exr);
        if (w.format == display::Format::Png || w.format == display::Format::Jpeg) w.sample = display::Sample::UInt8;
        w.policy.allowWrite = true;
        if (!display::writeImage(a->output, result->difference, w, diags)) *status = kOutputFailed;
    });
}

} // namespace alpenglow::cli
