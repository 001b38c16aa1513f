#include "cli/optionmanual.h"
#include "base/diagnostics.h"
#include "base/knownoptions.h"
#include "base/printable.h"
#include "cli/command.h"
#include "cli/foreignvariables.h"
#include "cli/messagemanual.h"
#include "cli/oldflags.h"
#include "cli/oldnames.h"
#include "cli/rcfile.h"
#include "display/driver.h"
#include "ri/requests/manual.h"
#include <fmt/format.h>

namespace alpenglow::cli {
namespace {

using OrderedJson = nlohmann::ordered_json;
using known::Effect;
using known::OptionDescription;

std::span<const OptionDescription> tableOf(Topic t) {
    switch (t) {
    case Topic::Options:
        return known::knownOptions();
    case Topic::Attributes:
        return known::knownAttributes();
    case Topic::Hiders:
        return known::knownHiderParameters();
    case Topic::Displays:
        return known::knownDisplayParameters();
    case Topic::Requests:
    case Topic::Messages:
        break;
    }
    return {};
}

const char* effectName(Effect e) {
    return e == Effect::Used ? "used" : e == Effect::ForShaders ? "for shaders" : e == Effect::Computed ? "computed" : "ignored";
}

std::string_view lastPart(std::string_view name) { return name.substr(name.find(':') + 1); }

/// "trace:maxdepth", "maxdepth" and "trace" name an entry; "" names all.
bool wanted(std::string_view entry, const std::string& name) {
    return name.empty() || entry == name || lastPart(entry) == name || entry.substr(0, entry.find(':')) == name;
}

/// The request that sets it.
std::string example(Topic t, const OptionDescription& d) {
    const std::string type = d.type.empty() ? "" : std::string(d.type) + " ";
    const std::string parameter = fmt::format("\"{}{}\" {}", type, lastPart(d.name), d.sample);
    const std::string_view category = d.name.substr(0, d.name.find(':'));
    switch (t) {
    case Topic::Options:
        return fmt::format("Option \"{}\" {}", category, parameter);
    case Topic::Attributes:
        return fmt::format("Attribute \"{}\" {}", category, parameter);
    case Topic::Hiders:
        return fmt::format("Hider \"hidden\" {}", parameter);
    case Topic::Displays:
        return fmt::format("Display \"a.tif\" \"tiff\" \"rgba\" {}", parameter);
    case Topic::Requests:
    case Topic::Messages:
        break;
    }
    return "";
}

std::string typeText(const OptionDescription& d) { return d.type.empty() ? "number or string" : std::string(d.type); }
std::string standardText(const OptionDescription& d) { return d.standard.empty() ? "none" : std::string(d.standard); }

std::string oneText(Topic t, const OptionDescription& d) {
    if (d.effect == Effect::Ignored) return fmt::format("{}\n    Accepted, no effect. A name of {}.\n", d.name, d.doc);
    if (d.effect == Effect::Computed)
        return fmt::format("{}  ({})\n    {}\n    Only {} reads it; nothing sets it by this name.\n", d.name, typeText(d), d.doc,
                           t == Topic::Options ? "option()" : "attribute()");
    return fmt::format("{}  ({})\n    {}\n    Default: {}.{}\n    Example: {}\n", d.name, typeText(d), d.doc, standardText(d),
                       d.effect == Effect::ForShaders ? " It has no effect by itself; shaders and RIB's If can read it." : "",
                       example(t, d));
}

OrderedJson oneJson(Topic t, const OptionDescription& d) {
    OrderedJson j{{"name", d.name}, {"type", d.type}, {"effect", effectName(d.effect)}, {"default", d.standard}, {"doc", d.doc}};
    if (d.settable()) j["example"] = example(t, d);
    return j;
}

std::string namesOf(const display::DriverDescriptor& d) {
    std::string names;
    for (const std::string& n : d.names) names += (names.empty() ? "" : ", ") + n;
    return names;
}

bool answersTo(const display::DriverDescriptor& d, const std::string& name) {
    return name.empty() || std::find(d.names.begin(), d.names.end(), name) != d.names.end();
}

OrderedJson requestJson(const ri::Request& r) {
    return {{"name", r.name}, {"kind", ri::toString(r.kind)}, {"arguments", r.signature}, {"motion", r.motion},
            {"doc", r.doc},   {"example", r.sample}};
}

/// What comes before a topic's parameters: the hiders, the display types, the requests.
std::string headText(Topic t, const std::string& name) {
    std::string out;
    if (t == Topic::Hiders)
        for (const auto& h : known::knownHiders())
            if (name.empty() || h.name == name) out += fmt::format("{}\n    {}\n", h.name, h.doc);
    if (t == Topic::Displays)
        for (const auto* d : display::drivers())
            if (answersTo(*d, name)) out += fmt::format("{}\n    {}\n", namesOf(*d), d->doc);
    if (t == Topic::Requests)
        for (const auto& r : ri::requestTable()) {
            if (name == r.name) return ri::requestText(r);
            if (name.empty()) out += fmt::format("{:<24} {}\n", r.name, r.doc);
        }
    return out;
}

/// A bar would end a table's cell.
std::string cell(std::string_view s) {
    std::string t;
    for (char c : s) t += c == '|' ? std::string("\\|") : std::string(1, c);
    return t;
}

std::string pageTable(Topic t, Effect effect) {
    std::string out = "| name | type | default | what it does | example |\n|---|---|---|---|---|\n";
    for (const OptionDescription& d : tableOf(t))
        if (d.effect == effect)
            out += fmt::format("| {} | {} | {} | {} | `{}` |\n", d.name, typeText(d), cell(standardText(d)), cell(d.doc),
                               cell(example(t, d)));
    return out;
}

std::string pageComputed(Topic t) {
    std::string out = "| name | type | value |\n|---|---|---|\n";
    for (const OptionDescription& d : tableOf(t))
        if (d.effect == Effect::Computed) out += fmt::format("| {} | {} | {} |\n", d.name, typeText(d), cell(d.doc));
    return out;
}

std::string pageIgnored(Topic t) {
    std::string out = "| name | renderer, and why it has no effect |\n|---|---|\n";
    for (const OptionDescription& d : tableOf(t))
        if (d.effect == Effect::Ignored) out += fmt::format("| {} | {} |\n", d.name, cell(d.doc));
    return out;
}

std::string optionsPage() {
    std::string out =
        "# Options, attributes, hiders, displays\n\n"
        "What can be set by name, with what it does here, from the tables that the reader itself uses. Made by\n"
        "`alpenglow info --options --markdown`; a test holds this page to the tables. `alpenglow info --options trace`\n"
        "prints a part of it, and so do `--attributes`, `--hiders` and `--displays`; requests with a name of their own "
        "(`Format`,\n"
        "`PixelSamples`, `Exposure` ...) are in [rib.md](rib.md).\n\n"
        "Shaders read every one of these by `option(\"trace:maxdepth\", x)` and `attribute(\"identifier:name\", s)`, and so do "
        "RIB's `IfBegin`\n"
        "and `ElseIf` (`$trace:maxdepth`, `${Attribute:identifier:name}`), where a name without a class is one of `user` or of "
        "the environment.\n"
        "Where nothing is set they get the default, if it is a value.\n\n"
        "The category `user` takes any name of any type, arrays too: `Attribute \"user\" \"float wet\" 1`, `Option \"user\" "
        "\"color[2] tones\"\n"
        "[1 0 0 0 0 1]`. All kinds of shaders read it (`attribute(\"user:wet\", x)`; a light has the attributes of its request), "
        "into a\n"
        "variable of as many numbers or strings; a single number also goes into a color, a point or a matrix, as the language "
        "converts it.\n"
        "Points and matrices are the numbers of the file: `transform(\"object\", \"current\", p)` says where they are.\n";
    out += "\n## Options\n\n`Option \"category\" \"type name\" value`, before `WorldBegin`.\n\n" +
           pageTable(Topic::Options, Effect::Used);
    out += "\n`option()` also reads these values of the frame:\n\n" + pageComputed(Topic::Options);
    out += "\n## Attributes\n\n`Attribute \"category\" \"type name\" value`, up to the end of the block.\n\n" +
           pageTable(Topic::Attributes, Effect::Used);
    out += "\nThese have no effect by themselves. Shaders read them, and get the default where nothing is set.\n\n" +
           pageTable(Topic::Attributes, Effect::ForShaders);
    out +=
        "\n`attribute()` also reads these values of the graphics state and of the point:\n\n" + pageComputed(Topic::Attributes);
    out += "\n## Hiders\n\n`Hider \"name\" \"type parameter\" value`; `--hider` overrides it.\n\n| hider | what it does "
           "|\n|---|---|\n";
    for (const auto& h : known::knownHiders()) out += fmt::format("| {} | {} |\n", h.name, cell(h.doc));
    out += "\n" + pageTable(Topic::Hiders, Effect::Used);
    out += "\n## Displays\n\n`Display \"file\" \"type\" \"mode\" \"type parameter\" value`. The mode names what is written: "
           "`rgba`, `rgb`, `a`, `z`, or\n"
           "variables of shaders, separated by commas (`\"rgba,N,color specular\"`).\n\n| type | what it writes |\n|---|---|\n";
    for (const auto* d : display::drivers()) out += fmt::format("| {} | {} |\n", namesOf(*d), cell(d->doc));
    out += "\n" + pageTable(Topic::Displays, Effect::Used);
    out += "\n## Names of other renderers\n\nAccepted, no effect: `-v` notes each. Shaders and RIB's If read what is set. "
           "Options:\n\n" +
           pageIgnored(Topic::Options);
    out += "\nAttributes:\n\n" + pageIgnored(Topic::Attributes) + "\nParameters of hiders:\n\n" + pageIgnored(Topic::Hiders) +
           "\nParameters of displays:\n\n" + pageIgnored(Topic::Displays);
    out += "\n## Defaults of a user: .alpenglowrc\n\n" + std::string(kRcFilesText) +
           "\nlibalpenglow, the Python module and other commands read none.\n\n"
           "    # ~/.alpenglowrc\n"
           "    --threads 12\n"
           "    Option \"searchpath\" \"string texture\" [\"~/maps:&\"]\n"
           "    Hider \"path\"\n";
    out += "\n## Environment variables\n\nThose of other renderers name folders, separated by `:`. Alpenglow looks there last of "
           "all, "
           "behind the\n"
           "paths of the scene, `--searchpath`, the scene's own folder and the shipped shaders: a picture whose files are found "
           "without\n"
           "them is the same with them. `-v` and `--stats` show which are in effect. `man alpenglow` lists those of Alpenglow "
           "itself.\n"
           "In `Option \"searchpath\"`, `$NAME`, `${NAME}` and `~` are taken from the environment.\n\n" +
           foreignVariablesPage();
    out += "\n## Command lines of other renderers\n\n`alpenglow render` takes these flags of prman, renderdl and aqsis. $1, $2 "
           "are their values, which may\n"
           "also stand behind a colon or an equals sign (`-t:4`). `-v` notes what became of each.\n\n" +
           oldFlagsPage();
    out += "\n## Programs of other renderers\n\nUnder these names, by links to it (`ln -s $(which alpenglow) ~/bin/txmake`), the "
           "program does what it has in\n"
           "their place. None is made when it is installed, for they may be those of another package.\n\n" +
           oldNamesPage();
    return out;
}

} // namespace

std::string topicText(Topic t, const std::string& name) {
    if (t == Topic::Messages) return messageText(name);
    std::string out = headText(t, name), ignored;
    const auto table = tableOf(t);
    std::vector<const OptionDescription*> those;
    for (const OptionDescription& d : table)
        if (wanted(d.name, name)) those.push_back(&d);
    if (!name.empty() && (t == Topic::Options || t == Topic::Attributes || out.empty())) {
        for (const OptionDescription* d : those) out += oneText(t, *d);
        return out;
    }
    if (!name.empty()) return out;
    if (!those.empty() && !out.empty()) out += "\nParameters\n";
    for (const OptionDescription* d : those) {
        if (d->effect == Effect::Ignored) ignored += (ignored.empty() ? "" : ", ") + std::string(d->name);
        else out += fmt::format("{:<36} {:<17} {:<24} {}\n", d->name, typeText(*d), standardText(*d), d->doc);
    }
    if (!ignored.empty()) out += "\nNames of other renderers, without effect here: " + ignored + "\n";
    return out;
}

OrderedJson topicJson(Topic t, const std::string& name) {
    if (t == Topic::Messages) return messageJson(name);
    OrderedJson all = OrderedJson::array();
    if (t == Topic::Hiders)
        for (const auto& h : known::knownHiders())
            if (name.empty() || h.name == name) all.push_back({{"hider", h.name}, {"doc", h.doc}});
    if (t == Topic::Displays)
        for (const auto* d : display::drivers())
            if (answersTo(*d, name)) all.push_back({{"types", d->names}, {"doc", d->doc}, {"writes", d->writes}});
    if (t == Topic::Requests)
        for (const auto& r : ri::requestTable())
            if (name.empty() || name == r.name) all.push_back(requestJson(r));
    for (const OptionDescription& d : tableOf(t))
        if (wanted(d.name, name)) all.push_back(oneJson(t, d));
    return all;
}

std::string topicPage(Topic t) {
    return t == Topic::Messages ? messagesPage() : t == Topic::Requests ? ri::requestManual() : optionsPage();
}

std::vector<std::string> topicNames(Topic t) {
    if (t == Topic::Messages) return messageIds();
    std::vector<std::string> names;
    for (const OptionDescription& d : tableOf(t)) {
        names.emplace_back(d.name);
        names.emplace_back(lastPart(d.name));
    }
    if (t == Topic::Options || t == Topic::Attributes)
        for (std::string& c : known::knownNames(tableOf(t), "")) names.push_back(std::move(c));
    if (t == Topic::Hiders)
        for (const auto& h : known::knownHiders()) names.emplace_back(h.name);
    if (t == Topic::Displays)
        for (const auto* d : display::drivers()) names.insert(names.end(), d->names.begin(), d->names.end());
    if (t == Topic::Requests) names = ri::requestNames();
    return names;
}

int printTopic(Topic t, const std::string& name, bool json) {
    const std::string text = topicText(t, name);
    if (text.empty()) {
        const std::string near = nearestName(name, topicNames(t));
        std::fprintf(stderr, "alpenglow: there is nothing of the name \"%s\"%s%s%s\n", printable(name).c_str(),
                     near.empty() ? "" : "; did you mean \"", near.c_str(), near.empty() ? "" : "\"?");
        return kDoneWithErrors;
    }
    std::fputs((json ? topicJson(t, name).dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n" : text).c_str(),
               stdout);
    return kDone;
}

} // namespace alpenglow::cli
