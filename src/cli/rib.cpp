// alpenglow rib: RIB from one form to another, archives put in, requests left out and put in, checked and counted.
#include "base/file.h"
#include "base/printable.h"
#include "cli/command.h"
#include "cli/jsonreport.h"
#include "cli/ranges.h"
#include "cli/ribfilters.h"
#include "ri/requestfilter.h"
#include "ri/requeststats.h"
#include "ri/writer.h"
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <unistd.h>

namespace alpenglow::cli {

namespace {

struct RibArguments {
    std::vector<std::string> files, searchPaths, rib, drop, only, replace, filters;
    std::string output, frames;
    int indent = 4, columns = 100;
    bool binary = false, ascii = false, format = false, gzip = false, expand = false, validate = false, stats = false,
         json = false, allowExec = false, allowRead = false, quiet = false, verbose = false;
    /// Whether RIB is to be written: checks and counts alone write none.
    bool writes() const { return !validate && (!stats || !output.empty()); }
};

/// Writes what comes, or counts it, or both.
class Writing : public ri::RequestReceiver {
public:
    /// flushes: requests that come by a pipe leave by a pipe at once. Pointers may be null.
    Writing(ri::RibWriter* to, bool flushes, ri::RequestStats* counts) : to_(to), flushes_(flushes), counts_(counts) {}
    void request(const ri::Call& c) override {
        if (counts_) counts_->add(c);
        if (to_) to_->write(c);
        flush();
    }
    void unknown(const std::string& name, const std::vector<ri::Value>& values) override {
        if (counts_) counts_->addUnknown(name, values);
        if (to_) to_->write(name, values);
        flush();
    }
    void comment(const std::string& kind, const std::string& text) override {
        if (to_) kind == "structure" ? to_->structure(text) : to_->comment(text);
        flush();
    }
    bool over() const override { return to_ && !to_->failure().empty(); }

private:
    void flush() {
        if (to_ && flushes_) to_->flush();
    }
    ri::RibWriter* to_;
    bool flushes_;
    ri::RequestStats* counts_;
};

/// Throws CLI::ValidationError.
ri::RequestPattern patternOf(const std::string& option, const std::string& text) {
    std::string error;
    auto p = ri::RequestPattern::make(text, error);
    if (!p) throw CLI::ValidationError(option, "\"" + text + "\" is no pattern: " + error);
    return std::move(*p);
}

/// Requests on the command line. Throws CLI::ValidationError.
std::vector<ri::Call> callsOf(const std::string& option, const std::string& text) {
    std::string fault;
    Diagnostics reported([&](const Diagnostic& d) {
        if (fault.empty()) fault = d.message;
    });
    std::vector<ri::Call> calls = ri::requestsOf(text, option, reported);
    if (!fault.empty()) throw CLI::ValidationError(option, "\"" + text + "\": " + fault);
    return calls;
}

/// Throws CLI::ValidationError.
ri::FilterRules rulesOf(const RibArguments& a) {
    ri::FilterRules r;
    if (!a.frames.empty()) {
        const auto frames = parseFrames(a.frames);
        if (!frames) throw CLI::ValidationError("--frames", "takes numbers and ranges as 1,4-6, not " + a.frames);
        r.frames = *frames;
    }
    for (const std::string& text : a.rib)
        for (ri::Call& c : callsOf("--rib", text)) r.before.push_back(std::move(c));
    for (const std::string& p : a.drop) r.drop.push_back(patternOf("--drop", p));
    for (const std::string& p : a.only) r.only.push_back(patternOf("--only", p));
    for (const std::string& p : a.replace) {
        size_t at = p.find('=');
        while (at != p.npos && at > 0 && p[at - 1] == '\\') at = p.find('=', at + 1);
        if (at == p.npos) throw CLI::ValidationError("--replace", "takes PATTERN=REQUESTS, not " + p);
        std::string pattern = p.substr(0, at);
        for (size_t k = 0; (k = pattern.find("\\=", k)) != pattern.npos; ++k) pattern.erase(k, 1);
        r.replacements.push_back({patternOf("--replace", pattern), callsOf("--replace", p.substr(at + 1))});
    }
    return r;
}

ri::ReaderOptions readerOf(const RibArguments& a, const StopFlag* stop) {
    ri::ReaderOptions o;
    o.searchPaths = folders(a.searchPaths);
    o.allowExec = a.allowExec;
    o.allowRead = a.allowRead;
    o.stop = stop;
    return o;
}

nlohmann::ordered_json statsJson(const ri::RequestStats& s) {
    using Json = nlohmann::ordered_json;
    const auto count = [](const ri::RequestStats::Count& c) {
        return Json{{"times", c.times}, {"numbers", c.numbers}, {"bytes", c.bytes}};
    };
    Json requests = Json::object();
    for (const auto& [name, c] : s.requests) requests[printable(name)] = count(c);
    const auto names = [](const std::set<std::string>& of) {
        Json list = Json::array();
        for (const std::string& n : of) list.push_back(printable(n));
        return list;
    };
    return {{"requests", std::move(requests)},
            {"all", count(s.all)},
            {"primitives", count(s.primitives)},
            {"lights", count(s.lights)},
            {"frames", s.frames},
            {"worlds", s.worlds},
            {"depth", s.depth},
            {"shaders", names(s.shaders)},
            {"archives", names(s.archives)}};
}

struct Outcome {
    bool read = true, written = true, interrupted = false, filtered = true;
};

Outcome rewrite(const RibArguments& a, ri::FilterRules rules, std::unique_ptr<ri::ByteSink> sink, ri::RequestStats* counts,
                Diagnostics& diags) {
    const StopFlag* stop = watchInterrupts();
    Outcome done;
    const std::vector<int> frames = rules.frames;
    std::optional<ri::RibWriter> writer;
    if (sink) writer.emplace(std::move(sink), ri::RibFormat{a.binary, a.gzip, a.indent, a.columns});
    const bool piped = a.writes() && (a.output.empty() || a.output == "-");
    const bool flushes = piped && a.files.size() == 1 && a.files[0] == "-" && !a.gzip;
    Writing last(writer ? &*writer : nullptr, flushes, counts);
    const auto filters = RibFilters::make(a.filters, last, diags, stop);
    if (!filters) {
        done.filtered = false;
        return done;
    }
    ri::RequestFilter filter(std::move(rules), filters->first());
    for (const std::string& f : a.files) {
        const bool all = a.expand || a.validate;
        done.read &= all ? ri::passOnExpanded(f, readerOf(a, stop), filter, diags) : ri::passOn(f, filter, diags, stop);
    }
    filter.finish();
    done.interrupted = *stop != 0;
    done.written = !writer || writer->finish();
    if (!done.written && piped && writer->failure() != std::strerror(EPIPE)) // a reader that went away (head) needs no message
        diags.report(Severity::Error, Rie::System, {}, "standard output takes no more: " + writer->failure());
    for (const int f : frames)
        if (!filter.frames().count(f) && !done.interrupted)
            diags.report(Severity::Warning, Rie::MissingData, {}, fmt::format("there is no frame {} in it", f));
    return done;
}

int runRib(const RibArguments& a, ri::FilterRules rules, Diagnostics& diags, nlohmann::ordered_json& found) {
    std::optional<OutputFile> file;
    std::unique_ptr<ri::ByteSink> sink;
    if (!a.writes()) {
        // only checks and counts
    } else if (a.output.empty() || a.output == "-") {
        sink = ri::descriptorSink(STDOUT_FILENO);
    } else {
        OutputPolicy anywhere;
        anywhere.allowWrite = true; // the user gave the name
        auto opened = OutputFile::open(a.output, anywhere, diags);
        if (!opened) return kOutputFailed;
        file.emplace(std::move(*opened));
        sink = ri::outputSink(*file);
    }
    ri::RequestStats counts;
    const Outcome done = rewrite(a, std::move(rules), std::move(sink), a.stats ? &counts : nullptr, diags);
    if (!done.filtered) return kWrongUse;      // what was there stays, here too
    if (done.interrupted) return kInterrupted; // what was there stays
    if (!done.read) return kNothingRendered;
    if (file && !file->commit(diags)) return kOutputFailed;
    if (!done.written) return kOutputFailed;
    if (a.stats && a.json) found["stats"] = statsJson(counts);
    else if (a.stats) std::fputs(printable(ri::statsText(counts)).c_str(), a.writes() && !file ? stderr : stdout);
    return diags.errors() ? kDoneWithErrors : kDone;
}

void addRules(CLI::App& c, RibArguments& a) {
    auto* g = c.add_option_group("What is left out and put in");
    g->add_flag("--expand", a.expand,
                "Put in what archives hold, and with --allow-exec what procedurals make; conditions are decided");
    g->add_option("--frames", a.frames, "Of FrameBegin blocks these only; what stands outside stays")->type_name("LIST");
    g->add_option("--rib", a.rib, "Requests that are put in before the others")->type_name("'REQUESTS'")->allow_extra_args(false);
    g->add_option("--drop", a.drop, "Leave out requests that fit: Imager, 'Surface \"fog.*', '.*Source'")
        ->type_name("PATTERN")
        ->allow_extra_args(false);
    g->add_option("--only", a.only, "Leave out all that do not fit")->type_name("PATTERN")->allow_extra_args(false);
    g->add_option("--replace", a.replace, "Put requests, or nothing, in the place of those that fit")
        ->type_name("PATTERN=REQUESTS")
        ->allow_extra_args(false);
    g->add_option("--filter", a.filters,
                  "A filter that is asked about each request: a library in C++ (RifPlugin.h) with its arguments, FILE.py, "
                  "FILE.py:FUNCTION or python:MODULE.FUNCTION; several stand one behind the other")
        ->type_name("'NAME ARGUMENT..'")
        ->allow_extra_args(false);
    c.add_option("--searchpath", a.searchPaths, "Folders for archives, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    c.add_flag("--allow-exec", a.allowExec, "Let --expand run programs and load libraries");
    c.add_flag("--allow-read", a.allowRead, "Let --expand read archives anywhere, not only below the scene's folders");
}

void addForm(CLI::App& c, RibArguments& a) {
    auto* g = c.add_option_group("Form", "Text when none is named");
    auto* binary = g->add_flag("--binary", a.binary, "Binary RIB: smaller, and faster to read");
    g->add_flag("--ascii", a.ascii, "Text")->excludes(binary);
    g->add_flag("--format", a.format, "Text in one layout: a request a line, blocks indented (as --ascii)")->excludes(binary);
    g->add_flag("--gzip", a.gzip, "Packed; names that end in .gz or .ribz are, too");
    g->add_option("--indent", a.indent, "Blanks for each block in text")
        ->check(wholeBetween(0, 16))
        ->type_name("N")
        ->excludes(binary);
    g->add_option("--columns", a.columns, "Break lines of text behind this column; 0: never")
        ->check(wholeBetween(0, 100000))
        ->type_name("N")
        ->excludes(binary);
}

} // namespace

void addRib(CLI::App& app, int* status) {
    auto a = std::make_shared<RibArguments>();
    CLI::App* c = app.add_subcommand("rib", "Convert, expand, filter, check and count RIB");
    c->add_option("files", a->files, "RIB, text or binary, packed or not; - is standard input, as when none is named")
        ->type_name("FILE");
    c->add_option("-o", a->output, "What is written; - is standard output, as when none is named")->type_name("FILE");
    addForm(*c, *a);
    addRules(*c, *a);
    c->add_flag("--validate", a->validate, "Write nothing, check all as a renderer would: status 1 when there are errors");
    c->add_flag("--stats", a->stats, "Count requests, numbers and bytes; without -o no RIB is written");
    c->add_flag("--json", a->json, "--stats and messages as JSON")->needs(c->get_option("--stats"));
    c->add_flag("-q,--quiet", a->quiet, "Errors only");
    c->add_flag("-v,--verbose", a->verbose, "Notes too");
    c->footer("A PATTERN is a regular expression that begins where a request does, as it stands in text, and ends with one of\n"
              "its words. docs/rib-tool.md has examples.");
    c->callback([a, status] {
        nlohmann::ordered_json reported, found = nlohmann::ordered_json::object();
        Diagnostics diags(a->json ? printerOr(true, reported)
                                  : printer(a->quiet     ? Severity::Error
                                            : a->verbose ? Severity::Info
                                                         : Severity::Warning));
        if (a->files.empty()) a->files.push_back("-");
        const auto packed = [&](const char* end) { return a->output.ends_with(end); };
        a->gzip |= packed(".gz") || packed(".ribz") || packed(".rz");
        const bool terminal = a->writes() && (a->output.empty() || a->output == "-") && isatty(STDOUT_FILENO) != 0;
        if (terminal && (a->binary || a->gzip)) throw CLI::ValidationError("-o", "is needed: a terminal takes text only");
        if (a->json && a->writes() && a->output == "-") throw CLI::ValidationError("--json", "needs standard output for itself");
        *status = runRib(*a, rulesOf(*a), diags, found);
        if (a->json) printReport(std::move(found), std::move(reported));
    });
}

} // namespace alpenglow::cli
