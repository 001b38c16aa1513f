#include "cli/commandtext.h"
#include <CLI/CLI.hpp>

namespace alpenglow::cli {

namespace {

/// "NAME:{a,b}", as the parser describes an option with a list of values, in its two parts.
void splitArgumentType(const std::string& type, OptionText& o) {
    const size_t list = type.find(":{");
    o.argument = type.substr(0, list);
    if (list == type.npos) return;
    std::string word;
    for (size_t i = list + 2; i < type.size() && type[i] != '}'; ++i) {
        if (type[i] != ',') word += type[i];
        else o.choices.push_back(std::exchange(word, ""));
    }
    o.choices.push_back(word);
}

OptionText optionTextOf(const CLI::Option& option, const std::string& group) {
    OptionText o;
    o.positional = !option.nonpositional();
    if (o.positional) o.names.push_back(option.get_name(true));
    for (const std::string& n : option.get_snames()) o.names.push_back("-" + n);
    for (const std::string& n : option.get_lnames()) o.names.push_back("--" + n);
    splitArgumentType(option.get_type_name(), o);
    const bool flag = option.get_items_expected_max() == 0;
    o.attached = flag && !o.choices.empty();
    if (o.attached) o.argument = joined(o.choices, "|");
    else if (flag) o.argument.clear();
    o.optionalArgument = !o.argument.empty() && option.get_items_expected_min() == 0;
    o.required = option.get_required();
    o.repeated = option.get_items_expected_max() > 1;
    o.help = option.get_description();
    o.group = group;
    return o;
}

/// The options of a command, then those of its groups, which the parser keeps as commands without a name.
std::vector<OptionText> optionTextsOf(const CLI::App& app, const std::string& group) {
    std::vector<OptionText> all;
    for (const CLI::Option* o : app.get_options())
        if (!o->get_group().empty()) all.push_back(optionTextOf(*o, group.empty() ? o->get_group() : group));
    for (const CLI::App* g : app.get_subcommands([](const CLI::App* s) { return s->get_name().empty(); }))
        for (OptionText& o : optionTextsOf(*g, g->get_group()))
            if (o.names != all.front().names) all.push_back(std::move(o)); // --help comes first, and groups have it again
    return all;
}

} // namespace

bool OptionText::takesFile() const { return argument.starts_with("FILE"); }
bool OptionText::takesFolders() const { return argument == "DIR" || argument == "DIRS"; }
bool OptionText::takesListed() const { return argument == "[NAME]" || argument == "[ID]"; }

ProgramText programText(const CLI::App& app) {
    ProgramText p{app.get_name(), app.get_description(), app.get_footer(), optionTextsOf(app, ""), {}};
    for (const CLI::App* c : app.get_subcommands([](const CLI::App* s) { return !s->get_name().empty(); }))
        p.commands.push_back({c->get_name(), c->get_description(), c->get_footer(), optionTextsOf(*c, "")});
    return p;
}

std::string summary(const std::string& help) {
    size_t end = help.size();
    for (const char* stop : {". ", "; ", " ("}) end = std::min(end, help.find(stop));
    return help.substr(0, end);
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
    std::string all;
    for (const std::string& w : words) all += (&w == &words.front() ? "" : separator) + w;
    return all;
}

} // namespace alpenglow::cli
