#include "cli/manpage.h"
#include "base/version.h"
#include "cli/command.h"
#include "cli/foreignvariables.h"
#include "cli/rcfile.h"
#include <algorithm>
#include <sstream>

namespace alpenglow::cli {

namespace {

/// Text as it is, whatever of it means something to roff.
std::string roffText(const std::string& text) {
    std::string s;
    for (const char c : text) switch (c) {
        case '\\':
            s += "\\e";
            break;
        case '-':
            s += "\\-";
            break;
        case '\'':
            s += "\\(aq";
            break;
        case '`':
            s += "\\(ga";
            break;
        case '^':
            s += "\\(ha";
            break;
        case '~':
            s += "\\(ti";
            break;
        default:
            s += c;
        }
    return s.starts_with('.') ? "\\&" + s : s;
}

std::string roffBold(const std::string& s) { return "\\fB" + roffText(s) + "\\fR"; }
std::string roffItalic(const std::string& s) { return "\\fI" + roffText(s) + "\\fR"; }

std::string roffSection(const std::string& name) { return ".SH " + name + "\n"; }

/// Paragraphs that are filled; lines that begin with a blank stay as they are.
std::string roffParagraphs(const std::string& text) {
    std::istringstream in(text);
    std::string out, line;
    bool kept = false;
    while (std::getline(in, line)) {
        const bool keep = line.starts_with(' ');
        if (keep != kept) out += keep ? ".PP\n.nf\n" : ".fi\n.PP\n";
        kept = keep;
        out += line.empty() ? ".PP\n" : roffText(line) + "\n";
    }
    return out + (kept ? ".fi\n" : "");
}

/// "-o FILE", "--preview[=auto|kitty]".
std::string optionUsage(const OptionText& o) {
    std::string s;
    for (const std::string& n : o.names) s += (&n == &o.names.front() ? "" : ", ") + (o.positional ? roffItalic(n) : roffBold(n));
    if (o.positional) return s + (o.repeated ? " ..." : "");
    if (o.argument.empty()) return s;
    if (o.attached) return s + "[=" + roffItalic(o.argument) + "]";
    return s + " " + roffItalic(o.argument);
}

std::string roffEntry(const std::string& term, const std::string& text) { return ".TP\n" + term + "\n" + roffText(text) + "\n"; }

std::string optionHelp(const OptionText& o) {
    const bool named =
        std::all_of(o.choices.begin(), o.choices.end(), [&](const std::string& c) { return o.help.find(c) != c.npos; });
    return named ? o.help : o.help + " (" + joined(o.choices, ", ") + ")";
}

std::string optionSections(const std::vector<OptionText>& all) {
    std::string arguments, rest;
    for (const OptionText& o : all)
        if (o.positional) arguments += roffEntry(optionUsage(o), optionHelp(o));
    if (!arguments.empty()) arguments = roffSection("ARGUMENTS") + arguments;
    std::vector<std::string> groups;
    for (const OptionText& o : all)
        if (!o.positional && std::find(groups.begin(), groups.end(), o.group) == groups.end()) groups.push_back(o.group);
    for (const std::string& g : groups) {
        if (g != "Options") rest += ".SS " + roffText(g) + "\n";
        for (const OptionText& o : all)
            if (!o.positional && o.group == g) rest += roffEntry(optionUsage(o), optionHelp(o));
    }
    return arguments + roffSection("OPTIONS") + rest;
}

std::string pageHeader(const std::string& page) {
    std::string title = page;
    for (char& c : title) c = char(std::toupper(static_cast<unsigned char>(c)));
    return ".\\\" Made by the program from the descriptions of its options: alpenglow help --man\n.TH " + roffText(title) +
           " 1 \"\" \"Alpenglow " + versionText() + "\" \"Alpenglow\"\n";
}

std::string statusSection() {
    std::string s = roffSection("EXIT STATUS");
    for (const StatusText& t : statusTexts()) s += roffEntry(roffBold(std::to_string(t.status)), t.meaning);
    return s;
}

std::string seeAlsoSection(const std::vector<std::string>& pages) {
    std::string s = roffSection("SEE ALSO");
    for (const std::string& p : pages) s += roffBold(p) + "(1)" + (&p == &pages.back() ? "\n" : ",\n");
    return s;
}

std::string programPage(const ProgramText& p) {
    std::string s = pageHeader(p.name) + roffSection("NAME") + roffText(p.name) + " \\- RenderMan renderer\n";
    s += roffSection("SYNOPSIS") + roffBold(p.name) + " " + roffItalic("scene") + " ...\n.br\n" + roffBold(p.name) + " " +
         roffItalic("command") + " [" + roffItalic("options") + "] [" + roffItalic("arguments") + "]\n";
    // The footer ends with the exit statuses, which have a section of their own here.
    s += roffSection("DESCRIPTION") + roffParagraphs(p.description) + ".PP\n" +
         roffParagraphs(p.footer.substr(0, p.footer.find("\n\nExit")));
    s +=
        roffSection("COMMANDS") + "Each command has a manual page of its own, such as " + roffBold(p.name + "-render") + "(1).\n";
    std::vector<std::string> pages;
    for (const CommandText& c : p.commands) {
        s += roffEntry(roffBold(c.name), c.description);
        pages.push_back(p.name + "-" + c.name);
    }
    s += optionSections(p.options) + statusSection() + roffSection("ENVIRONMENT");
    for (const VariableText& v : environmentVariables()) s += roffEntry(roffBold(v.name), v.help);
    for (const ForeignVariable& v : foreignVariables()) s += roffEntry(roffBold(std::string(v.name)), textOf(v));
    s += roffSection("FILES") + roffEntry(roffBold("~/.alpenglowrc"), kRcFilesText);
    return s + seeAlsoSection(pages);
}

std::string commandPage(const ProgramText& p, const CommandText& c) {
    const std::string name = p.name + "-" + c.name;
    std::string s = pageHeader(name) + roffSection("NAME") + roffText(name) + " \\- " + roffText(c.description) + "\n";
    s += roffSection("SYNOPSIS") + roffBold(p.name + " " + c.name) + " [" + roffItalic("options") + "]";
    for (const OptionText& o : c.options)
        if (o.positional) s += (o.required ? " " : " [") + optionUsage(o) + (o.required ? "" : "]");
    s += "\n" + optionSections(c.options);
    if (!c.footer.empty()) s += roffSection("NOTES") + roffParagraphs(c.footer);
    if (c.footer.find("Exit status") == c.footer.npos) s += statusSection();
    return s + seeAlsoSection({p.name});
}

} // namespace

const std::vector<VariableText>& environmentVariables() {
    static const std::vector<VariableText> all = {
        {"ALPENGLOW_CACHE", "Folder of the compiled shaders; off keeps none. When not set, $XDG_CACHE_HOME/alpenglow or "
                            "~/.cache/alpenglow."},
        {"ALPENGLOW_RC", "File to read instead of .alpenglowrc in its three places; off reads none."},
        {"ALPENGLOW_SHADERS", "Folders of shaders, separated by :, searched before the shaders that ship with the program."},
        {"ALPENGLOW_JIT", "File to load as the shader compiler's module, instead of libalpenglow_jit.so."},
        {"ALPENGLOW_GLTF", "File to load as the module for glTF, instead of libalpenglow_gltf.so."},
        {"ALPENGLOW_MODELS", "File to load as the module for further models, instead of libalpenglow_models.so."},
        {"ALPENGLOW_OPTIONS", "Options of alpenglow render for programs that draw through libalpenglow.so or the Python module."},
        {"ALPENGLOW_PICTURES", "File to load as the module for further picture formats, instead of libalpenglow_pictures.so."},
        {"ALPENGLOW_GRIDS", "File to load as the module for OpenVDB grids, instead of libalpenglow_grids.so."},
        {"SLURM_CPUS_PER_TASK", "The most threads that are used when --threads is not given."},
        {"TMPDIR", "Folder of the scratch files for large maps; /var/tmp when not set."},
    };
    return all;
}

std::string manPage(const ProgramText& p, const std::string& command) {
    for (const CommandText& c : p.commands)
        if (c.name == command) return commandPage(p, c);
    return programPage(p);
}

} // namespace alpenglow::cli
