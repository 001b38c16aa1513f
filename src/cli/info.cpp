// alpenglow info: what a shader is, and the manual of the shadeops.
#include "cli/command.h"
#include "cli/lspdocument.h"
#include "cli/manual.h"
#include "rsl/compiler.h"
#include "rsl/evaluate.h"
#include "shadeops/descriptor.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <memory>
#include <nlohmann/json.hpp>

namespace alpenglow::cli {
namespace {

using Json = nlohmann::ordered_json;

int shadeops(const std::string& name, bool json) {
    if (name.empty()) {
        if (json) {
            Json all = Json::array();
            for (const auto& s : rsl::shadeops()) all.push_back(manualJson(s));
            std::printf("%s\n", all.dump(2).c_str());
            return kDone;
        }
        for (const auto& s : rsl::shadeops())
            std::printf("%-18s %-24s %s\n", s.name.c_str(), s.section.c_str(),
                        s.lowering == rsl::Lowering::Unavailable ? "(not yet available)" : "");
        return kDone;
    }
    const rsl::Shadeop* s = rsl::findShadeop(name);
    if (!s) {
        std::vector<std::string> names;
        for (const auto& o : rsl::shadeops()) names.push_back(o.name);
        std::string near = nearestName(name, names);
        std::fprintf(stderr, "alpenglow: there is no shadeop \"%s\"%s%s\n", name.c_str(), near.empty() ? "" : "; did you mean ",
                     near.c_str());
        return kDoneWithErrors;
    }
    if (json) std::printf("%s\n", manualJson(*s).dump(2).c_str());
    else std::fputs(manualText(*s).c_str(), stdout);
    return kDone;
}

/// The name of the space in which a default value is written; "" for none.
std::string spaceOf(const rsl::Expr* e) {
    while (e && !e->space && e->kind == rsl::ExprKind::Cast && !e->args.empty()) e = e->args[0].get();
    if (!e || !e->space || e->space->kind != rsl::ExprKind::String) return "";
    return e->space->text;
}

const char* storageText(rsl::Storage s) { return s == rsl::Storage::Varying ? "varying" : "uniform"; }

std::string kindText(const rsl::CompiledShader& s) {
    std::string k = rsl::toString(s.kind());
    std::transform(k.begin(), k.end(), k.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return k;
}

/// The type as the shader writes it: handles are of type shader, arrays of open length have none.
std::string typeText(rsl::Type t, const rsl::Symbol* s) {
    if (s && (s->type.array < 0 || s->open)) t.array = -1;
    std::string text = rsl::toString(t);
    if (s && s->handle && text.rfind("string", 0) == 0) text.replace(0, 6, "shader");
    return text;
}

/// What other shaders may read of a class, with types.
std::vector<std::string> membersOf(const rsl::Shader& s) {
    std::vector<std::string> list;
    for (const auto& v : s.symbols)
        if (v->origin == rsl::Symbol::Origin::Local && s.publics.count(v->name)) list.push_back(typeText(v->type, v.get()) + " " + v->name);
    return list;
}

std::string valueText(const rsl::ParameterValue& v) {
    if (v.type.base == rsl::Base::String) {
        std::string t;
        for (const std::string& s : v.strings) t += (t.empty() ? "\"" : " \"") + s + "\"";
        return t;
    }
    return rsl::formatNumbers(v.numbers);
}

} // namespace

void addInfo(CLI::App& app, int* status) {
    struct Arguments {
        std::string file, shadeop, dialect;
        std::vector<std::string> searchPaths;
        bool json = false, markdown = false, allowExec = false;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = app.add_subcommand("info", "Tell what a shader is, or how a shadeop works");
    c->add_option("shader", a->file, "RSL file, or the name of a shader on the search path");
    CLI::Option* ops = c->add_option("--shadeops", a->shadeop, "List the shadeops, or print the manual of one")
                           ->expected(0, 1)
                           ->type_name("[NAME]");
    c->add_flag("--json", a->json, "As JSON");
    c->add_flag("--markdown", a->markdown, "With --shadeops: the whole manual as a Markdown page, docs/shadeops.md");
    c->add_option("--searchpath", a->searchPaths, "Folders for shaders and #include, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    addDialect(*c, a->dialect);
    c->add_flag("--allow-exec", a->allowExec, "Let the shader load plug-ins");
    c->callback([a, ops, status] {
        if (ops->count()) {
            if (a->markdown && a->shadeop.empty()) {
                std::fputs(manualPage().c_str(), stdout);
                *status = kDone;
            } else *status = shadeops(a->shadeop, a->json);
            return;
        }
        if (a->file.empty()) throw CLI::RequiredError("shader or --shadeops");
        Diagnostics diags(printer());
        rsl::ShaderCompiler::Settings settings;
        settings.dialect = a->dialect;
        std::vector<std::string> paths{"."};
        for (std::string& f : folders(a->searchPaths)) paths.push_back(std::move(f));
        for (std::string& f : environmentShaders()) paths.push_back(std::move(f));
        if (std::string s = shippedShaders(); !s.empty()) paths.push_back(s);
        settings.allowExec = a->allowExec;
        settings.pluginPaths = paths;
        rsl::ShaderCompiler compiler(settings);
        auto shader = compiler.load(a->file, paths, diags);
        *status = shader ? kDone : kDoneWithErrors;
        if (!shader) return;
        rsl::KernelOptions options;
        options.path = true;
        auto kernel = compiler.analyse(*shader, options, diags);
        auto defaults = compiler.parameterDefaults(shader, diags);
        const auto& written = shader->shader().parameters;
        for (size_t i = 0; i < std::min(defaults.size(), written.size()); ++i) // {} has no elements
            if (const rsl::Expr* e = written[i].defaultValue.get(); e && e->kind == rsl::ExprKind::ArrayList && e->text == "{}")
                defaults[i].strings.clear(), defaults[i].numbers.clear();
        Json j;
        j["name"] = shader->name();
        j["type"] = kindText(*shader);
        j["file"] = shader->path();
        j["parameters"] = Json::array();
        for (size_t i = 0; i < shader->parameters().size(); ++i) {
            const rsl::ParameterInfo& p = shader->parameters()[i];
            Json q = {{"name", p.name},
                      {"type", typeText(p.type, i < shader->shader().parameters.size() ? shader->shader().parameters[i].symbol : nullptr)},
                      {"storage", storageText(p.storage)},
                      {"output", p.output}};
            if (p.type.array != 0) q["arraySize"] = p.type.array;
            if (p.open) q["open"] = true;
            const auto& declared = shader->shader().parameters;
            if (i < declared.size())
                if (const std::string space = spaceOf(declared[i].defaultValue.get()); !space.empty()) q["space"] = space;
            if (p.hasDefault && i < defaults.size()) {
                if (defaults[i].type.base == rsl::Base::String) q["default"] = defaults[i].strings;
                else q["default"] = defaults[i].numbers;
            }
            j["parameters"].push_back(q);
        }
        std::vector<std::string> methods;
        for (const auto& f : shader->shader().nested) methods.push_back(signatureOf(*f));
        j["methods"] = methods;
        j["class"] = shader->shader().object;
        const std::vector<std::string> members = membersOf(shader->shader());
        j["members"] = members;
        std::string offered; // by plug-ins
        for (const auto& plugin : shader->program().plugins)
            for (const rsl::Shadeop& f : plugin->functions)
                for (const rsl::Signature& s : f.signatures) {
                    j["plugins"][plugin->name].push_back({{"signature", s.text}, {"doc", f.doc}});
                    offered += "plug-in \"" + plugin->name + "\": " + s.text + (f.doc.empty() ? "" : "  " + f.doc) + "\n";
                }
        for (const auto& [key, value] : shader->shader().annotations) j["annotations"][key] = value;
        if (kernel) {
            j["writes"] = kernel->facts.writes;
            j["affine"] = kernel->facts.affine;
            if (!kernel->facts.affine) j["whyNot"] = kernel->facts.whyNot;
            j["suspends"] = kernel->facts.suspends;
            j["lightLoops"] = kernel->facts.lightLoops;
            j["direct"] = kernel->facts.direct;
        }
        if (a->json) {
            std::printf("%s\n", j.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
            return;
        }
        std::printf("%s \"%s\"  (%s%s)\n", kindText(*shader).c_str(), shader->name().c_str(), shader->shader().object ? "class, " : "", shader->path().c_str());
        for (size_t i = 0; i < shader->parameters().size(); ++i) {
            const rsl::ParameterInfo& p = shader->parameters()[i];
            std::string value = p.hasDefault && i < defaults.size() ? " = " : "";
            if (!value.empty()) {
                const std::string space = spaceOf(shader->shader().parameters[i].defaultValue.get());
                if (!space.empty()) value += "\"" + space + "\" ";
                value += valueText(defaults[i]);
            }
            std::printf("    %s%s %s %s%s\n", p.output ? "output " : "", storageText(p.storage),
                        typeText(p.type, i < shader->shader().parameters.size() ? shader->shader().parameters[i].symbol : nullptr).c_str(), p.name.c_str(), value.c_str());
        }
        for (const std::string& m : members) std::printf("member: %s\n", m.c_str());
        for (const std::string& m : methods) std::printf("method: %s\n", m.c_str());
        std::fputs(offered.c_str(), stdout);
        for (const auto& [key, v] : shader->shader().annotations) std::printf("annotation %s: %s\n", key.c_str(), v.c_str());
        if (!kernel) return;
        std::string writes;
        for (const std::string& w : kernel->facts.writes) writes += " " + w;
        std::printf("writes:%s\n", writes.empty() ? " nothing" : writes.c_str());
        if (kernel->facts.affine) std::printf("affine: yes; it never waits for a ray\n");
        else std::printf("affine: no; %s\n", kernel->facts.whyNot.c_str());
        if (kernel->facts.suspends) std::printf("suspends: it waits for its rays as a coroutine\n");
        for (const std::string& d : kernel->facts.direct) std::printf("direct light only under path: %s\n", d.c_str());
    });
}

} // namespace alpenglow::cli
