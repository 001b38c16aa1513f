// fuzz_alpenglow: runs the targets, says what came of them, keeps and shrinks what is a defect.
#include "fuzz.h"
#include "worker.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <unistd.h>

namespace fs = std::filesystem;

namespace alpenglow::fuzz {
namespace {

struct Arguments {
    std::vector<std::string> targets, inputs;
    uint64_t seed = 1;
    double seconds = 0, shrinkSeconds = 30;
    size_t runs = 0, only = SIZE_MAX;
    std::string keep = "fuzz-findings", program;
    bool list = false, check = false, selfTest = false;
    Limits limits;
};

Bytes inputOf(const Target& t, const Seeds& seeds, uint64_t seed, size_t n) {
    uint64_t name = 0;
    for (char c : t.name) name = name * 131 + uint8_t(c);
    Random r(seed * 0x9e3779b97f4a7c15u ^ name);
    Random mine(r.next() + n);
    mine.next();
    return t.input(mine, seeds);
}

/// As few bytes as still do the same: parts are taken out, large ones first.
Bytes shrunk(const Target& t, Bytes b, const Verdict& as, const Limits& limits, double seconds) {
    const double end = clockSeconds() + seconds;
    const auto same = [&](const Bytes& candidate) {
        const Verdict v = runAlone(t, candidate, limits);
        return v.outcome == as.outcome && (as.outcome != Outcome::Crash || v.signature == as.signature);
    };
    for (size_t part = std::max<size_t>(1, b.size() / 2); part > 0 && clockSeconds() < end;) {
        bool less = false;
        for (size_t at = 0; at < b.size() && clockSeconds() < end;) {
            Bytes candidate = b.substr(0, at) + b.substr(std::min(b.size(), at + part));
            if (candidate.size() < b.size() && same(candidate)) b = std::move(candidate), less = true;
            else at += part;
        }
        if (part == 1 && !less) break;
        if (!less || part > b.size()) part = std::max<size_t>(part / 2, part == 1 ? 0 : 1);
    }
    return b;
}

class Session {
public:
    Session(const Arguments& a) : a_(a) {}

    void run(const Target& t, double end, size_t runs) {
        const Seeds seeds = seedsOf(t);
        if (seeds.empty()) {
            std::printf("%-16s no seeds\n", t.name.c_str());
            ++defects_;
            return;
        }
        const double begin = clockSeconds();
        std::map<std::string, size_t> perSignature;
        const auto seed = [&](size_t n) { return seeds[n]; };
        const auto made = [&](size_t n) { return inputOf(t, seeds, a_.seed, n); };
        const auto keeper = [&](const Source& source, const char* what) {
            return [&, source, what](size_t n, const Verdict& v) {
                if (perSignature[v.signature]++ < 2) keep(t, source(n), v, std::string(what) + " " + std::to_string(n));
            };
        };
        // The short check of a costly target runs its own corpus, and only so many of its other seeds.
        const size_t own = filesOf(source("tests/fuzz/corpus/" + t.name), {}).size();
        const size_t first = a_.check && a_.seconds <= 0 ? std::min(seeds.size(), std::max(own, runs)) : seeds.size();
        Tally tally = runMany(t, seed, 0, first, 1e9, a_.limits, keeper(seed, "seed"));
        const size_t last = a_.only != SIZE_MAX ? a_.only + 1 : runs ? runs : SIZE_MAX;
        const Tally more = runMany(t, made, a_.only != SIZE_MAX ? a_.only : 0, last, end, a_.limits, keeper(made, "input"));
        tally.runs += more.runs;
        for (size_t i = 0; i < tally.count.size(); ++i) tally.count[i] += more.count[i];
        row(t.name, tally, clockSeconds() - begin);
        for (size_t i = 0; i < tally.count.size(); ++i) {
            total_.count[i] += tally.count[i];
            if (defect(Outcome(i))) defects_ += tally.count[i];
        }
        total_.runs += tally.runs;
    }

    /// One saved input.
    void replay(const Target& t, const std::string& file) {
        const Verdict v = runAlone(t, contentsOf(file), a_.limits);
        std::printf("%s: %s %s\n%s", file.c_str(), nameOf(v.outcome), defect(v.outcome) ? v.signature.c_str() : "",
                    v.messages.c_str());
        defects_ += defect(v.outcome);
    }

    static void head() {
        std::printf("%-16s %9s %9s %9s %6s %6s %7s %7s %7s %6s %7s %8s\n", "target", "runs", "ok", "errors", "slow", "hangs",
                    "memory", "crashes", "status", "mute", "differs", "seconds");
    }
    void foot() const {
        row("all", total_, clockSeconds());
        for (const std::string& l : kept_) std::printf("%s\n", l.c_str());
    }
    size_t defects() const { return defects_; }

private:
    static void row(const std::string& name, const Tally& t, double seconds) {
        const auto n = [&](Outcome o) { return t.count[size_t(o)]; };
        std::printf("%-16s %9zu %9zu %9zu %6zu %6zu %7zu %7zu %7zu %6zu %7zu %8.1f\n", name.c_str(), t.runs, n(Outcome::Ok),
                    n(Outcome::Refused), n(Outcome::Slow), n(Outcome::Hang), n(Outcome::Memory), n(Outcome::Crash),
                    n(Outcome::Status), n(Outcome::Mute), n(Outcome::Differs), seconds);
        std::fflush(stdout);
    }

    void keep(const Target& t, const Bytes& bytes, const Verdict& first, const std::string& where) {
        if (a_.keep.empty()) return;
        Verdict v = first;
        Bytes small = bytes;
        std::string note;
        if (defect(first.outcome)) {
            const Verdict again = runAlone(t, bytes, a_.limits);
            if (again.outcome == first.outcome) {
                v = again;
                small = shrunk(t, bytes, v, a_.limits, a_.shrinkSeconds);
            } else note = " (not when run alone: " + std::string(nameOf(again.outcome)) + ")";
        }
        const fs::path folder = fs::absolute(fs::path(a_.keep) / t.name);
        std::error_code e;
        fs::create_directories(folder, e);
        const std::string stem = std::string(nameOf(v.outcome)) + "-" + std::to_string(a_.seed) + "-" + std::to_string(++number_),
                          file = (folder / (stem + t.extension)).string();
        std::ofstream(file, std::ios::binary) << small;
        std::ofstream(folder / (stem + ".whole" + t.extension), std::ios::binary) << bytes;
        const std::string again = a_.program + " --target " + t.name + " --input " + file;
        std::ofstream(folder / (stem + ".txt")) << where << " of seed " << a_.seed << note << "\n"
                                                << again << "\n"
                                                << v.signature << "\n"
                                                << v.messages;
        if (defect(v.outcome))
            kept_.push_back(std::string(nameOf(v.outcome)) + " in " + t.name + ", " + std::to_string(small.size()) + " bytes" +
                            note + ":\n    " + again);
    }

    const Arguments& a_;
    Tally total_;
    size_t defects_ = 0, number_ = 0;
    std::vector<std::string> kept_;
};

/// A target that does what the input says, so that each kind of end is known beforehand.
int selfTest() {
    Target t{"self-test", "", ".txt"};
    t.run = [](const Bytes& b) {
        const auto has = [&](const char* word) { return b.find(word) != Bytes::npos; };
        if (has("crash")) std::abort();
        if (has("leave")) _exit(9);
        if (has("deaf")) std::signal(SIGINT, SIG_IGN);
        std::vector<std::string> held;
        for (volatile bool on = has("loop") || has("deaf") || has("eat"); on;)
            if (has("eat")) held.emplace_back(size_t(1) << 20, 'x');
        return has("error") ? Outcome::Refused : has("mute") ? Outcome::Mute : Outcome::Ok;
    };
    Limits limits;
    limits.processorSeconds = kSanitized ? 3 : 2; // "eat" comes to the limit of memory before
    limits.graceSeconds = 1;
    limits.memory = size_t(kSanitized ? 1200 : 300) << 20;
    int wrong = 0;
    const auto expect = [&](bool loops, const Bytes& input, Outcome o) {
        t.loops = loops;
        const Verdict v = runAlone(t, input, limits);
        const bool good = v.outcome == o;
        std::printf("%-8s %-24s %s\n", good ? "ok" : "WRONG", input.c_str(), nameOf(v.outcome));
        wrong += !good;
        return v;
    };
    expect(false, "nothing", Outcome::Ok);
    expect(false, "an error", Outcome::Refused);
    expect(false, "mute", Outcome::Mute);
    expect(false, "leave", Outcome::Crash);
    expect(false, "loop", Outcome::Hang);
    expect(true, "loop", Outcome::Slow);
    expect(true, "deaf", Outcome::Hang);
    expect(false, "eat", Outcome::Memory);
    const Bytes large = "one two three crash four five";
    const Bytes small = shrunk(t, large, expect(false, large, Outcome::Crash), limits, 30);
    if (small != "crash") std::printf("WRONG    made smaller: \"%s\"\n", small.c_str()), ++wrong;
    // A batch goes on behind an input that ends its process, and numbers stay right.
    const Bytes inputs[] = {"a", "crash", "error", "leave", "b"};
    std::string ends;
    const Tally tally = runMany(
        t, [&](size_t n) { return inputs[n]; }, 0, 5, 1e9, limits, [&](size_t n, const Verdict&) { ends += std::to_string(n); });
    if (tally.runs != 5 || ends != "13" || tally.count[size_t(Outcome::Ok)] != 2)
        std::printf("WRONG    a batch: %zu runs, ends at %s\n", tally.runs, ends.c_str()), ++wrong;
    return wrong ? 1 : 0;
}

int run(const Arguments& a) {
    std::vector<Target> targets = allTargets();
    if (a.list) {
        for (const Target& t : targets) std::printf("%-16s %s\n", t.name.c_str(), t.about.c_str());
        return 0;
    }
    std::vector<Target> chosen;
    for (const Target& t : targets)
        if (a.targets.empty() || std::find(a.targets.begin(), a.targets.end(), t.name) != a.targets.end()) chosen.push_back(t);
    if (chosen.empty() || (!a.inputs.empty() && chosen.size() != 1)) {
        std::fprintf(stderr, "fuzz_alpenglow: %s; --list shows the targets\n",
                     chosen.empty() ? "no such target" : "--input takes one --target");
        return 2;
    }
    Session session(a);
    if (!a.inputs.empty()) {
        for (const std::string& file : a.inputs) session.replay(chosen[0], file);
        return session.defects() ? 1 : 0;
    }
    // The clock goes to the targets in equal shares; what one leaves, the others have.
    Session::head();
    for (size_t i = 0; i < chosen.size(); ++i) {
        const double now = clockSeconds(),
                     share = a.seconds > 0 ? std::max(0.5, (a.seconds - now) / double(chosen.size() - i)) : 1e9;
        session.run(chosen[i], now + share,
                    a.check && a.seconds <= 0 ? std::max<size_t>(1, a.runs / size_t(chosen[i].cost)) : a.runs);
    }
    session.foot();
    return session.defects() ? 1 : 0;
}

} // namespace

const char* nameOf(Outcome o) {
    static const char* const names[] = {"ok", "error", "slow", "hang", "memory", "crash", "status", "mute", "differs"};
    return names[size_t(o)];
}

} // namespace alpenglow::fuzz

int main(int argc, char** argv) {
    using namespace alpenglow::fuzz;
    clockSeconds();
    Arguments a;
    a.program = argv[0];
    CLI::App app("Damaged and generated input for everything that reads a stranger's bytes", "fuzz_alpenglow");
    app.add_option("--target", a.targets, "Only these targets");
    app.add_option("--seconds", a.seconds, "Go on for about so long, shared by the targets");
    app.add_option("--runs", a.runs, "Inputs a target, in addition to its seeds");
    app.add_option("--seed", a.seed, "Of all random numbers: the same seed makes the same inputs");
    app.add_option("--only", a.only, "Only the input of this number");
    app.add_option("--input", a.inputs, "Run saved inputs of one target, and show what is said");
    app.add_option("--keep", a.keep, "Folder for findings; \"\": keep none");
    app.add_option("--shrink", a.shrinkSeconds, "Seconds for making one finding smaller");
    app.add_option("--limit", a.limits.processorSeconds, "Processor seconds of one input");
    app.add_flag("--self-test", a.selfTest, "Whether crashes, hangs and the rest are noticed and made smaller");
    app.add_flag("--list", a.list, "List the targets");
    app.add_flag("--check", a.check, "As ./check runs it: the seeds and a few inputs; with ALPENGLOW_NIGHTLY set, ten minutes");
    CLI11_PARSE(app, argc, argv);
    if (kSanitized) { // shadow memory, and several times slower
        a.limits.memory *= 4;
        a.limits.processorSeconds *= 6;
        a.limits.stallSeconds *= 4;
        a.limits.graceSeconds *= 4;
    }
    if (a.selfTest) return selfTest();
    if (a.check) {
        if (std::getenv("ALPENGLOW_NIGHTLY") && a.seconds <= 0) a.seconds = 600;
        if (a.seconds <= 0 && a.runs == 0) a.runs = 120;
    } else if (a.seconds <= 0 && a.runs == 0) a.seconds = 60;
    return run(a);
}
