#include "cli/jsonreport.h"
#include "cli/command.h"
#include <cstdio>
#include <utility>

namespace alpenglow::cli {

using OrderedJson = nlohmann::ordered_json;

namespace {

OrderedJson placeJson(const SourcePlace& p, int length) {
    return {{"file", p.file}, {"line", p.line}, {"column", p.column}, {"length", length}};
}

} // namespace

OrderedJson diagnosticJson(const Diagnostic& d) {
    OrderedJson j = placeJson(d.place, d.length);
    j["severity"] = d.severity == Severity::Info ? "note" : d.severity == Severity::Warning ? "warning" : "error";
    j["id"] = d.id;
    j["message"] = d.message;
    if (!d.hint.empty()) j["hint"] = d.hint;
    if (!d.notes.empty()) j["notes"] = d.notes;
    for (const FixIt& f : d.fixes) {
        OrderedJson fix = placeJson(f.place, f.length);
        fix["text"] = f.text;
        j["fixes"].push_back(std::move(fix));
    }
    return j;
}

Diagnostics::Handler printerOr(bool json, OrderedJson& reported) {
    if (!json) return printer();
    reported = OrderedJson::array();
    return [&reported](const Diagnostic& d) {
        if (d.severity >= Severity::Warning) reported.push_back(diagnosticJson(d));
    };
}

void printReport(OrderedJson found, OrderedJson reported) {
    found["diagnostics"] = std::move(reported);
    std::printf("%s\n", found.dump(2, ' ', false, OrderedJson::error_handler_t::replace).c_str());
}

} // namespace alpenglow::cli
