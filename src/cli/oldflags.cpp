#include "cli/oldflags.h"
#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <unistd.h>

namespace alpenglow::cli {
namespace {

using Use = OldFlag::Use;

constexpr std::string_view
    kDisplay = "the scene's displays are written as files; --display TYPE:NAME:MODE adds one, `alpenglow view` shows "
               "the picture as it grows",
    kPaths = "--searchpath $1", kRib = "`alpenglow rib` converts, expands and filters RIB",
    kNetwork = "there is no network render here";

constexpr OldFlag kFlags[] = {
    {"-Progress", 0, "prman, aqsis", Use::Accepted, "--progress plain"},
    {"-P", 1, "renderdl", Use::Accepted, "--threads $1"},
    {"-addtype", 1, "aqsis", Use::Noted, kDisplay},
    {"-archives", 1, "aqsis", Use::Accepted, kPaths},
    {"-base", 1, "aqsis", Use::Accepted, "--cwd $1"},
    {"-beep", 0, "renderdl", Use::Dropped, "nothing beeps"},
    {"-beeps", 0, "renderdl", Use::Dropped, "nothing beeps"},
    {"-binary", 0, "renderdl", Use::Answered, kRib},
    {"-capture", 1, "prman", Use::Answered, kRib},
    {"-checkpoint", 1, "prman", Use::Noted, "name a file: --checkpoint FILE; it is written every half minute"},
    {"-crop", 4, "prman, renderdl, aqsis", Use::Accepted, "--crop $1,$2,$3,$4"},
    {"-cwd", 1, "prman", Use::Accepted, "--cwd $1"},
    {"-d", 1, "prman, renderdl, rendrib", Use::Noted, kDisplay},
    {"-D", 0, "renderdl", Use::Noted, kDisplay},
    {"-displays", 1, "aqsis", Use::Dropped, "there are no display plug-ins"},
    {"-dspyframe", 1, "prman", Use::Dropped, kNetwork},
    {"-dspyserver", 1, "prman", Use::Dropped, kNetwork},
    {"-endofframe", 1, "aqsis", Use::Dropped, "a table is printed after each run; --stats FILE.json has more"},
    {"-f", 1, "prman", Use::Accepted, "--frames $1"},
    {"-fb", 0, "aqsis", Use::Noted, kDisplay},
    {"-frames", 1, "renderdl, aqsis", Use::Accepted, "--frames $1"},
    {"-frameslist", 1, "aqsis", Use::Accepted, "--frames $1"},
    {"-help", 0, "all", Use::Accepted, "--help"},
    {"-i", 0, "renderdl", Use::Noted, kDisplay},
    {"-id", 0, "renderdl", Use::Noted, kDisplay},
    {"-info", 0, "aqsis", Use::Accepted, "--verbose"},
    {"-jobid", 1, "renderdl", Use::Dropped, kNetwork},
    {"-loglevel", 1, "prman", Use::Dropped, "-q and -v choose the messages"},
    {"-maxsamples", 1, "prman", Use::Accepted, "--spp $1"},
    {"-mode", 1, "aqsis", Use::Noted, kDisplay},
    {"-nd", 0, "renderdl", Use::Dropped, "no window is opened"},
    {"-nobake", 0, "prman", Use::Dropped, "nothing is baked"},
    {"-nocolor", 0, "aqsis", Use::Dropped, "messages have no colours"},
    {"-noinit", 0, "renderdl", Use::Dropped, "there is no file of settings"},
    {"-option", 1, "aqsis", Use::Accepted, "--rib $1"},
    {"-p", 1, "prman", Use::Accepted, "--threads $1"},
    {"-pause", 0, "aqsis", Use::Dropped, "there is no window to wait for"},
    {"-plugins", 1, "aqsis", Use::Dropped, "shaders find plug-ins along --searchpath"},
    {"-priority", 1, "aqsis", Use::Noted, "start the program with nice"},
    {"-procedurals", 1, "aqsis", Use::Accepted, kPaths},
    {"-progress", 0, "prman, renderdl, aqsis", Use::Accepted, "--progress plain"},
    {"-rc", 1, "aqsis", Use::Dropped, "there is no file of settings"},
    {"-recover", 1, "prman", Use::Noted,
     "keep the samples with --checkpoint FILE, and begin with them by --checkpoint FILE --resume"},
    {"-res", 2, "prman, renderdl, aqsis", Use::Accepted, "--format $1x$2"},
    {"-rif", 1, "prman", Use::Accepted, "--filter $1"},
    {"-shaders", 1, "aqsis", Use::Accepted, kPaths},
    {"-silent", 0, "rendrib", Use::Accepted, "--quiet"},
    {"-stats", 0, "renderdl", Use::Dropped, "a table is printed after each run; --stats FILE.json has more"},
    {"-stats1", 0, "renderdl", Use::Dropped, "a table is printed after each run; --stats FILE.json has more"},
    {"-stats2", 0, "renderdl", Use::Dropped, "a table is printed after each run; --stats FILE.json has more"},
    {"-stats3", 0, "renderdl", Use::Dropped, "a table is printed after each run; --stats FILE.json has more"},
    {"-statsfile", 1, "prman, renderdl", Use::Accepted, "--stats $1"},
    {"-statslevel", 1, "prman", Use::Dropped, "--stats FILE.json has everything"},
    {"-syslog", 0, "aqsis", Use::Dropped, "messages go to standard error"},
    {"-t", 1, "prman, renderdl", Use::Accepted, "--threads $1"},
    {"-textures", 1, "aqsis", Use::Accepted, kPaths},
    {"-threads", 1, "aqsis", Use::Accepted, "--threads $1"},
    {"-timestamp", 0, "aqsis", Use::Dropped, "messages have no time"},
    {"-type", 1, "aqsis", Use::Noted, kDisplay},
    {"-verbose", 1, "aqsis", Use::Accepted, "--verbose"},
    {"-version", 0, "all", Use::Accepted, "--version"},
    {"-warning", 0, "aqsis", Use::Dropped, "warnings are always printed; -q leaves them out"},
    {"-warnings", 0, "prman", Use::Dropped, "warnings are always printed; -q leaves them out"},
    {"-woff", 1, "prman", Use::Dropped, "-q leaves warnings out"},
    {"-xcpu", 0, "prman", Use::Dropped, "--time ends a run"},
};

bool wholeNumber(const std::string& s) {
    return !s.empty() && std::all_of(s.begin(), s.end(), [](unsigned char c) { return std::isdigit(c); });
}

const OldFlag* find(std::span<const OldFlag> table, const std::string& argument, std::string* inlineValue) {
    if (argument.size() < 2 || argument[0] != '-' || argument[1] == '-') return nullptr;
    const size_t at = argument.find_first_of(":=");
    const std::string name = argument.substr(0, at);
    for (const OldFlag& f : table)
        if (f.name == name && (at == argument.npos || f.values > 0)) {
            *inlineValue = at == argument.npos ? "" : argument.substr(at + 1);
            return &f;
        }
    return nullptr;
}

/// The values of a flag: what stands behind ':' or '=', else what follows. Moves `i` to the last one. False: there are too few.
bool valuesOf(const OldFlag& f, const std::string& inlineValue, const std::vector<std::string>& all, size_t* i,
              std::vector<std::string>* values) {
    if (!inlineValue.empty()) {
        std::string item; // -res=320,200
        for (char c : inlineValue + (f.values > 1 ? "," : "")) {
            if (f.values > 1 && (c == ',' || c == 'x')) {
                values->push_back(item);
                item.clear();
            } else item += c;
        }
        if (f.values == 1) values->push_back(item);
        return values->size() == size_t(f.values);
    }
    for (int k = 0; k < f.values; ++k) {
        if (*i + 1 >= all.size()) return false;
        values->push_back(all[++*i]);
    }
    return true;
}

/// Where a flag's values have forms of their own; the rest is the table's.
void adjust(const OldFlag& f, const std::vector<std::string>& all, size_t* i, std::vector<std::string>* values) {
    std::string& v = values->front();
    // Two numbers are the first and the last frame.
    if (f.name == "-f" && wholeNumber(v) && *i + 1 < all.size() && wholeNumber(all[*i + 1])) v += "-" + all[++*i];
}

/// Whether a flag whose value may be missing has none: -recover and -verbose have a number behind them, prman's -d the name of a
/// display driver, which is no file.
bool hasNoValue(const OldFlag& f, const std::vector<std::string>& all, size_t i) {
    const std::string next = i + 1 < all.size() ? all[i + 1] : "";
    if (f.name == "-recover" || f.name == "-verbose" || f.name == "-endofframe") return !wholeNumber(next);
    const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    return f.name == "-d" && (next.empty() || !std::all_of(next.begin(), next.end(), plain) || access(next.c_str(), F_OK) == 0);
}

void takeFlag(const OldFlag& f, const std::string& inlineValue, const std::vector<std::string>& all, size_t* i,
              TranslatedFlags* out) {
    std::vector<std::string> values;
    const std::string& written = all[*i];
    if (inlineValue.empty() && hasNoValue(f, all, *i)) {
        values.push_back("1");
    } else if (!valuesOf(f, inlineValue, all, i, &values)) {
        out->error = fmt::format("{} takes {} value{}", f.name, f.values, f.values == 1 ? "" : "s");
        return;
    }
    if (!values.empty()) adjust(f, all, i, &values);
    const bool threads = f.here.starts_with("--threads"); // 0, "all" and negative numbers: as many as there are
    if ((threads && !wholeNumber(values[0])) || (threads && values[0] == "0") || (f.name == "-recover" && values[0] == "0")) {
        out->notes.push_back(written + " is what holds without it");
        return;
    }
    if (f.name == "-recover" && std::find(all.begin(), all.end(), "--checkpoint") != all.end()) {
        out->arguments.push_back("--resume");
        out->notes.push_back(written + " is --resume here");
        return;
    }
    if (f.use == Use::Answered) {
        out->error = fmt::format("{} of {}: {}", f.name, f.renderers, f.here);
        return;
    }
    if (f.use == Use::Dropped || f.use == Use::Noted) {
        (f.use == Use::Noted ? out->withoutEquivalent : out->notes)
            .push_back(fmt::format("{} of {} has no effect: {}", f.name, f.renderers, f.here));
        return;
    }
    std::string reported = written + " is";
    std::string_view rest = f.here;
    while (!rest.empty()) { // words of the template, each an argument
        const size_t space = std::min(rest.find(' '), rest.size());
        std::string word(rest.substr(0, space));
        rest.remove_prefix(std::min(space + 1, rest.size()));
        for (size_t k = 0; k < values.size(); ++k)
            if (const size_t at = word.find("$" + std::to_string(k + 1)); at != word.npos) word.replace(at, 2, values[k]);
        reported += " " + word;
        out->arguments.push_back(std::move(word));
    }
    out->notes.push_back(reported + " here");
}

} // namespace

std::span<const OldFlag> oldFlags() { return kFlags; }

TranslatedFlags translateOldFlags(const std::vector<std::string>& arguments) { return translateFlags(kFlags, arguments); }

TranslatedFlags translateFlags(std::span<const OldFlag> table, const std::vector<std::string>& arguments) {
    TranslatedFlags out;
    for (size_t i = 0; i < arguments.size() && out.error.empty(); ++i) {
        std::string inlineValue;
        const OldFlag* f = find(table, arguments[i], &inlineValue);
        if (f) takeFlag(*f, inlineValue, arguments, &i, &out);
        else out.arguments.push_back(arguments[i]);
    }
    return out;
}

std::string oldFlagsPage() { return flagsPage(kFlags); }

std::string flagsPage(std::span<const OldFlag> table) {
    std::string out = "| flag | of | here |\n|---|---|---|\n";
    std::vector<const OldFlag*> sorted;
    for (const OldFlag& f : table) sorted.push_back(&f);
    std::sort(sorted.begin(), sorted.end(), [](const OldFlag* a, const OldFlag* b) { return a->name < b->name; });
    for (const OldFlag* f : sorted) {
        const std::string text = f->use == Use::Accepted  ? "`" + std::string(f->here) + "`"
                                 : f->use == Use::Dropped ? "ignored: " + std::string(f->here)
                                 : f->use == Use::Noted   ? "ignored, with a note: " + std::string(f->here)
                                                          : "refused: " + std::string(f->here);
        std::string values;
        for (int k = 1; k <= f->values; ++k) values += " $" + std::to_string(k);
        out += fmt::format("| `{}{}` | {} | {} |\n", f->name, values, f->renderers, text);
    }
    return out;
}

} // namespace alpenglow::cli
