// RiBegin("file.rib"): the program writes RIB.
#include "capi/output.h"
#include "ri/c/ribformat.h"
#include "ri/c/ribtarget.h"
#include <fmt/format.h>
#include <unistd.h>

namespace alpenglow::capi {

namespace {

class RibFile final : public Output {
public:
    RibFile(std::unique_ptr<ri::ByteSink> sink, ri::RibFormat format, Diagnostics& diags)
        : target_(std::move(sink), format, diags) {}
    ri::Target& target() override { return target_; }
    void end(const SourcePlace& where) override { target_.end(where); }

private:
    ri::RibTarget target_;
};

} // namespace

std::unique_ptr<Output> ribFile(const std::string& name, Diagnostics& diags) {
    std::string why;
    auto sink = name == "-" ? ri::descriptorSink(STDOUT_FILENO) : ri::fileSink(name, &why);
    if (!sink) {
        diags.report(Severity::Error, Rie::NoFile, {}, fmt::format("RiBegin: \"{}\" cannot be written: {}", name, why));
        return nullptr;
    }
    ri::RibFormat format = ri::takeRibFormat();
    format.gzip |= name.ends_with(".gz") || name.ends_with(".ribz");
    return std::make_unique<RibFile>(std::move(sink), format, diags);
}

} // namespace alpenglow::capi
