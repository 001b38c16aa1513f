#include "ri/c/ribtarget.h"
#include "ri/c/ribformat.h"
#include <fmt/format.h>

namespace alpenglow::ri {

RibTarget::RibTarget(std::unique_ptr<ByteSink> sink, RibFormat format, Diagnostics& diags)
    : sink_(std::move(sink)), format_(format), reporter_(diags) {}

RibWriter& RibTarget::writer(bool headed) {
    if (writer_) return *writer_;
    writer_ = std::make_unique<RibWriter>(std::move(sink_), format_);
    if (headed) return *writer_;
    writer_->structure("RenderMan RIB-Structure 1.0");
    Call version;
    version.request = findRequest("version");
    version.arguments.resize(1);
    version.arguments[0] = {true, {3.03}, {}};
    writer_->write(version);
    return *writer_;
}

/// Option "rib" is about the file and is not written to it.
bool RibTarget::formatOption(const Call& call) {
    if (call.request->name != "Option" || call.text(0) != "rib") return false;
    for (const RawParam& p : call.params) {
        const std::string_view token = p.token, name = token.substr(token.find_last_of(' ') + 1);
        RibFormat now = format_;
        const std::string wrong = setRibFormat(now, name, p.value.strings.empty() ? "" : p.value.strings[0]);
        const bool changes = now.binary != format_.binary || now.gzip != format_.gzip;
        if (!wrong.empty()) reporter_.error(Rie::BadToken, call.place, wrong);
        else if (changes && writer_)
            reporter_.error(Rie::IllState, call.place, fmt::format("Option \"rib\" \"{}\" comes too late", name),
                            "it stands before RiBegin, or before all other calls");
        else format_ = now;
    }
    return true;
}

void RibTarget::execute(const Call& call) {
    if (formatOption(call)) return;
    if (const std::string wrong = sketch_.note(call); !wrong.empty()) {
        reporter_.error(Rie::Nesting, call.place, fmt::format("{}: {}", call.request->name, wrong));
        if (wrong.starts_with("there is no")) return;
    }
    writer().write(call);
    check(call.place);
}

/// Called from time to time, so that a full disk is reported while the program runs, and only once.
void RibTarget::check(const SourcePlace& place) {
    constexpr uint64_t kBytes = 1u << 20;
    if (failed_ || writer_->bytes() < checked_ + kBytes) return;
    checked_ = writer_->bytes();
    failed_ = !writer_->flush();
    if (failed_)
        reporter_.report(Severity::Severe, Rie::DiskFull, place, "the RIB file cannot be written: " + writer_->failure());
}

void RibTarget::subdivide(const std::function<void(float)>& make, const std::vector<float>&, const Call& by) {
    subdivideHere(*this, make, by);
}

void RibTarget::record(const std::string& type, const std::string& text, const Call& by) {
    if (type == "comment") writer().comment(text);
    else if (type == "structure") writer(true).structure(text);
    else writer().verbatim(text);
    check(by.place);
}

void RibTarget::errorHandler(const std::string& style) {
    Call c;
    c.request = findRequest("ErrorHandler");
    c.arguments.resize(1);
    c.arguments[0] = {true, {}, {style}};
    execute(c);
}

bool RibTarget::end(const SourcePlace& where) {
    if (const std::string open = sketch_.open(); !open.empty())
        reporter_.error(Rie::Nesting, where, fmt::format("RiEnd comes before the {} is closed", open));
    const bool whole = writer().finish();
    if (!whole && !failed_)
        reporter_.report(Severity::Severe, Rie::DiskFull, where, "the RIB file cannot be written: " + writer_->failure());
    reporter_.flush(where);
    return whole;
}

} // namespace alpenglow::ri
