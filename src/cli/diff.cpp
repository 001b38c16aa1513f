// alpenglow diff: how far two pictures are apart.
#include "display/diff.h"
#include "cli/command.h"
#include "cli/jsonreport.h"
#include "cli/ranges.h"
#include "display/imageio.h"
#include <CLI/CLI.hpp>
#include <memory>

namespace alpenglow::cli {

namespace {

using OrderedJson = nlohmann::ordered_json;

/// Infinities, which JSON has no numbers for, become null.
OrderedJson differenceJson(const display::ChannelDiff& c) {
    return {{"name", c.name},   {"meanAbs", c.meanAbs}, {"rmse", c.rmse},         {"max", c.max},
            {"meanA", c.meanA}, {"meanB", c.meanB},     {"at", {c.maxX, c.maxY}}, {"nonFinite", c.nonFinite}};
}

OrderedJson differencesJson(const display::DiffResult& r, bool within) {
    OrderedJson channels = OrderedJson::array();
    for (const display::ChannelDiff& c : r.channels) channels.push_back(differenceJson(c));
    return {{"within", within}, {"channels", std::move(channels)}, {"all", differenceJson(r.all)}};
}

bool writeDifference(const std::string& name, const display::Image& difference, Diagnostics& diags) {
    display::WriteOptions w;
    w.format = display::formatOfExtension(name).value_or(display::Format::Exr);
    if (!display::written(w.format).floats) w.sample = display::Sample::UInt8;
    w.policy.allowWrite = true;
    return display::writeImage(name, difference, w, diags);
}

} // namespace

void addDiff(CLI::App& app, int* status) {
    struct Arguments {
        std::string a, b, output;
        double tolerance = 0;
        bool json = false;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = app.add_subcommand("diff", "Compare two pictures: mean and maximum error, RMSE");
    c->add_option("a", a->a, "Picture: " + display::readFormats())->type_name("FILE")->required();
    c->add_option("b", a->b, "Picture of the same size")->type_name("FILE")->required();
    c->add_option("-o", a->output, "Write the absolute difference as a picture")->type_name("FILE");
    c->add_option("--tolerance", a->tolerance, "Largest error that counts as equal; default 0")
        ->check(notNegative())
        ->type_name("X");
    c->add_flag("--json", a->json, "Print JSON, with messages under \"diagnostics\"");
    c->footer("Exit status 0 when the largest error is within the tolerance, 1 when it is not, 3 when the pictures cannot be "
              "compared,\n"
              "5 when the difference cannot be written.");
    c->callback([a, status] {
        OrderedJson reported, found = OrderedJson::object();
        Diagnostics diags(printerOr(a->json, reported));
        if (const std::string fault = a->output.empty() ? "" : faultOfPictureName(a->output, false); !fault.empty())
            throw CLI::ValidationError("-o", fault);
        auto first = display::readImage(a->a, diags), second = display::readImage(a->b, diags);
        auto result = first && second ? display::compareImages(*first, *second, diags) : std::nullopt;
        if (result) {
            const bool within = result->within(a->tolerance);
            *status = within ? kDone : kDoneWithErrors;
            if (a->json) found = differencesJson(*result, within);
            else std::fputs(display::toString(*result).c_str(), stdout);
            if (!a->output.empty() && !writeDifference(a->output, result->difference, diags)) *status = kOutputFailed;
        } else {
            *status = kNothingRendered;
        }
        if (a->json) printReport(std::move(found), std::move(reported));
    });
}

} // namespace alpenglow::cli
