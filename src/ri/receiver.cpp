#include "ri/receiver.h"
#include "ri/parser.h"
#include "scene/scene.h"
#include <algorithm>

namespace alpenglow::ri {

namespace {

/// Frames are of no interest.
class Nobody : public scene::FrameConsumer {
    void render(std::shared_ptr<const scene::Frame>) override {}
    void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&, const SourcePlace&) override {}
};

void pass(std::unique_ptr<ByteSource> source, const std::string& name, RequestReceiver& to, Diagnostics& reported,
          const StopFlag* stop) {
    Reporter reporter(reported);
    Parser parser(inflating(std::move(source)), name, reporter,
                  [&](const std::string& kind, const std::string& text) { to.comment(kind, text); });
    parser.unknown = [&](const std::string& n, const std::vector<Value>& values) { to.unknown(n, values); };
    reporter.lineText = [&](const SourcePlace& p) { return parser.lineText(p); };
    for (Call call; !(stop && *stop) && !to.over() && parser.next(call);) to.request(call);
    reporter.flush(parser.here());
}

} // namespace

bool passOn(const std::string& path, RequestReceiver& to, Diagnostics& reported, const StopFlag* stop) {
    std::string why;
    const bool standard = path == "-";
    auto source = standard ? standardInput(stop) : fileSource(path, &why, false, stop);
    if (!source) {
        reported.report(Severity::Error, Rie::NoFile, {path, 0, 0}, "the file cannot be read: " + why);
        return false;
    }
    pass(std::move(source), standard ? "standard input" : path, to, reported, stop);
    return true;
}

void passOnText(const std::string& text, const std::string& name, RequestReceiver& to, Diagnostics& reported) {
    pass(memorySource(text), name, to, reported, nullptr);
}

bool passOnExpanded(const std::string& path, ReaderOptions options, RequestReceiver& to, Diagnostics& reported) {
    options.executed = [&](const Call& c) { to.request(c); };
    options.unknown = [&](const std::string& n, const std::vector<Value>& values) { to.unknown(n, values); };
    options.comments = [&](const std::string& kind, const std::string& text) { to.comment(kind, text); };
    Nobody nobody;
    RibReader reader(std::move(options), nobody, reported);
    if (reader.readFile(path)) return true;
    const std::vector<Diagnostic> all = reported.all();
    return std::none_of(all.begin(), all.end(),
                        [&](const Diagnostic& d) { return d.code == Rie::NoFile && d.place.file == path && d.place.line == 0; });
}

} // namespace alpenglow::ri
