// alpenglow info: what a shader is, what is in other files, which shaders there are, and the manuals of shadeops, requests,
// options and displays.
#include "base/installation.h"
#include "base/printable.h"
#include "cli/command.h"
#include "cli/fileinfo.h"
#include "cli/jsonreport.h"
#include "cli/manual.h"
#include "cli/optionmanual.h"
#include "cli/shaderdescription.h"
#include "cli/shaderlist.h"
#include "ri/requests/header.h"
#include "rsl/compiler.h"
#include "shadeops/descriptor.h"
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

namespace alpenglow::cli {
namespace {

using OrderedJson = nlohmann::ordered_json;

int shadeops(const std::string& name, bool json) {
    if (name.empty()) {
        if (json) {
            OrderedJson all = OrderedJson::array();
            for (const auto& s : shadeops::allShadeops()) all.push_back(manualJson(s));
            std::printf("%s\n", all.dump(2).c_str());
            return kDone;
        }
        for (const auto& s : shadeops::allShadeops())
            std::printf("%-18s %-24s %s\n", s.name.c_str(), s.section.c_str(),
                        s.lowering == shadeops::Lowering::Unavailable ? "(not yet available)" : "");
        return kDone;
    }
    const shadeops::Shadeop* s = shadeops::findShadeop(name);
    if (!s) {
        std::vector<std::string> names;
        for (const auto& o : shadeops::allShadeops()) names.push_back(o.name);
        std::string near = nearestName(name, names);
        std::fprintf(stderr, "alpenglow: there is no shadeop \"%s\"%s%s\n", printable(name).c_str(),
                     near.empty() ? "" : "; did you mean ", near.c_str());
        return kDoneWithErrors;
    }
    if (json) std::printf("%s\n", manualJson(*s).dump(2).c_str());
    else std::fputs(manualText(*s).c_str(), stdout);
    return kDone;
}

struct InfoArguments {
    std::string file, shadeop, dialect;
    std::string names[6]; ///< of the topics, by their number
    std::vector<std::string> searchPaths;
    bool header = false; ///< of C
    bool shaders = false, json = false, markdown = false, allowExec = false;
};

std::string dumped(const OrderedJson& j) { return j.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n"; }

/// Options, attributes, hiders, displays, requests, messages.
int topic(Topic t, const InfoArguments& a) {
    const std::string& name = a.names[size_t(t)];
    if (a.header && t == Topic::Requests) {
        std::fputs(ri::callPrototypes().c_str(), stdout);
        return kDone;
    }
    if (a.markdown && name.empty()) {
        std::fputs(topicPage(t).c_str(), stdout);
        return kDone;
    }
    return printTopic(t, name, a.json);
}

std::vector<std::string> searched(const InfoArguments& a) {
    std::vector<std::string> paths{"."};
    for (std::string& f : folders(a.searchPaths)) paths.push_back(std::move(f));
    for (std::string& f : environmentShaders()) paths.push_back(std::move(f));
    if (std::string s = shippedShaders(); !s.empty()) paths.push_back(s);
    return paths;
}

/// Whether what is asked for is a file that holds no shader. A name without a dot or a folder is one of a shader.
bool namesOtherFile(const std::string& name) {
    std::error_code e;
    return name.find_first_of("./") != name.npos && !name.ends_with(".sl") && std::filesystem::is_regular_file(name, e);
}

int otherFile(const InfoArguments& a) {
    OrderedJson reported;
    Diagnostics diags(printerOr(a.json, reported));
    const auto facts = fileFacts(a.file, diags);
    if (a.json) printReport(facts.value_or(OrderedJson::object()), std::move(reported));
    else if (facts) std::fputs(printable(factsText(*facts)).c_str(), stdout);
    if (!facts) return kNothingRendered;
    return diags.errors() > 0 ? kDoneWithErrors : kDone;
}

int shader(const InfoArguments& a) {
    Diagnostics diags(printer());
    rsl::ShaderCompiler::Settings settings;
    settings.dialect = a.dialect;
    const std::vector<std::string> paths = searched(a);
    settings.allowExec = a.allowExec;
    settings.pluginPaths = paths;
    settings.keepWritten = true;
    rsl::ShaderCompiler compiler(settings);
    auto shader = compiler.load(a.file, paths, diags);
    if (!shader) {
        std::vector<std::string> names;
        for (const ListedShader& s : listShaders(paths)) names.push_back(s.name);
        if (const std::string near = nearestName(a.file, names); !near.empty() && near != a.file)
            std::fprintf(stderr, "  hint: did you mean \"%s\"?\n", printable(near).c_str());
        return kDoneWithErrors;
    }
    // A file describes all of its shaders, beginning with the one that its name means; a name about one.
    std::vector<std::shared_ptr<const rsl::CompiledShader>> wanted{shader};
    if (a.file.ends_with(".sl"))
        for (auto& other : rsl::ShaderCompiler::allOfFile(shader))
            if (other != shader) wanted.push_back(std::move(other));
    OrderedJson first;
    for (const auto& s : wanted) {
        const ShaderDescription d = describe(compiler, s, diags);
        if (!a.json) std::fputs(printable((s == shader ? "" : "\n") + descriptionText(d)).c_str(), stdout);
        else if (s == shader) first = descriptionJson(d);
        else first["others"].push_back(descriptionJson(d));
    }
    if (a.json) std::fputs(dumped(first).c_str(), stdout);
    return diags.errors() > 0 ? kDoneWithErrors : kDone;
}

} // namespace

void addInfo(CLI::App& app, int* status) {
    auto a = std::make_shared<InfoArguments>();
    CLI::App* c = app.add_subcommand(
        "info", "Tell what is in a file or what a shader is, or how shadeops, requests, options, displays and messages work");
    c->add_option("file", a->file,
                  "RSL file (all its shaders), name of a shader on the search path, or a picture, map, point cloud, photon map, "
                  "part file, model or scene")
        ->type_name("FILE");
    CLI::Option* ops = c->add_option("--shadeops", a->shadeop, "List the shadeops, or print the manual of one")
                           ->expected(0, 1)
                           ->type_name("[NAME]");
    c->add_flag("--shaders", a->shaders,
                "List the shaders that scenes find: in this folder, on the search path, and the shipped ones");
    const std::pair<const char*, const char*> topics[] = {
        {"--options", "List the options, or print one name or category"},
        {"--attributes", "List the attributes, or print one name or category"},
        {"--hiders", "List the hiders and their parameters"},
        {"--displays", "List the types of Display and their parameters"},
        {"--requests", "List the RIB requests, or print the manual of one"},
        {"--messages", "List the messages of the compiler, or explain one by its id"}};
    std::vector<CLI::Option*> listed;
    for (const auto& [name, help] : topics)
        listed.push_back(c->add_option(name, a->names[listed.size()], help)->expected(0, 1)->type_name("[NAME]"));
    c->add_flag("--json", a->json, "As JSON");
    c->add_flag(
        "--markdown", a->markdown,
        "Print the whole page: docs/shadeops.md with --shadeops, docs/rib.md with --requests, docs/messages.md with --messages, "
        "docs/options.md with the others");
    c->add_flag("--header", a->header, "With --requests: print the prototypes of their calls in C, as ri.h has them");
    c->add_option("--searchpath", a->searchPaths, "Folders for shaders and #include, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    addDialect(*c, a->dialect);
    c->add_flag("--allow-exec", a->allowExec, "Allow the shader to load plug-ins");
    c->callback([a, ops, listed, status] {
        for (size_t t = 0; t < listed.size(); ++t)
            if (listed[t]->count()) {
                *status = topic(Topic(t), *a);
                return;
            }
        if (ops->count()) {
            if (a->markdown && a->shadeop.empty()) {
                std::fputs(manualPage().c_str(), stdout);
                *status = kDone;
            } else *status = shadeops(a->shadeop, a->json);
            return;
        }
        if (a->shaders) {
            const auto list = listShaders(searched(*a));
            std::fputs(a->json ? dumped(shaderListJson(list)).c_str() : printable(shaderListText(list)).c_str(), stdout);
            *status = kDone;
            return;
        }
        if (a->file.empty())
            throw CLI::RequiredError("a file, the name of a shader, or --shaders, --shadeops, --options, --attributes, --hiders, "
                                     "--displays or --requests");
        *status = namesOtherFile(a->file) ? otherFile(*a) : shader(*a);
    });
}

} // namespace alpenglow::cli
