// RIB that calls of C become.
#pragma once
#include "ri/c/target.h"
#include "ri/writer.h"
#include <memory>

namespace alpenglow::ri {

/// Writes calls as they come. Nothing is known of a scene but what Sketch follows: the requests are not checked against each
/// other, but for Ends without their Begins, which are reported and left out.
class RibTarget : public Target {
public:
    /// Option "rib" "format" ("ascii", "binary") and "compression" ("none", "gzip") change `format` until the first other call.
    RibTarget(std::unique_ptr<ByteSink>, RibFormat format, Diagnostics&);
    void execute(const Call&) override;
    Reporter& reporter() override { return reporter_; }
    const Declarations& declarations() const override { return sketch_.declarations; }
    int colorSamples() const override { return sketch_.colorSamples; }
    scene::AttributesRef attributes() override { return sketch_.attributes; }
    int nextHandle() override { return ++serial_; }
    std::optional<Matrix> between(const std::string&, const std::string&) override { return {}; }
    void subdivide(const std::function<void(float)>& make, const std::vector<float>& bound, const Call& by) override;
    void readArchive(const Call& call, const Lexer::Comments&) override { execute(call); }
    void record(const std::string& type, const std::string& text, const Call& by) override;
    void errorHandler(const std::string& style) override;
    /// Ends the stream, with an error for a block that is open. False: it could not be written; reported.
    bool end(const SourcePlace&);

private:
    std::string nameOf(int number) const override { return std::to_string(number); }
    bool formatOption(const Call&);
    RibWriter& writer(bool headed = false); ///< headed: the program writes the first lines itself
    void check(const SourcePlace&);
    std::unique_ptr<ByteSink> sink_; ///< until something is written
    RibFormat format_;
    std::unique_ptr<RibWriter> writer_;
    Reporter reporter_;
    Sketch sketch_;
    uint64_t checked_ = 0; ///< bytes after which the sink was asked how it is
    bool failed_ = false;
    int serial_ = 0;
};

} // namespace alpenglow::ri
