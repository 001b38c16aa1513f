// alpenglow info: what a shader is, and the manual of the shadeops.
#include "cli/command.h"
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

const char* loweringText(rsl::Lowering l) {
    switch (l) {
    case rsl::Lowering::Runtime:
        return "machine code inside the kernel";
    case rsl::Lowering::Rsl:
        return "written in RSL, inlined";
    case rsl::Lowering::Special:
        return "built into the compiler";
    case rsl::Lowering::Service:
        return "answered by the renderer at once";
    case rsl::Lowering::Request:
        return "answered by rays or lights";
    case rsl::Lowering::Unavailable:
        return "not yet available: it type-checks, a call is reported once";
    }
    return "";
}

const char* derivativeText(rsl::DerivativeRule d) {
    switch (d) {
    case rsl::DerivativeRule::Jet:
        return "exact";
    case rsl::DerivativeRule::Zero:
        return "zero (constant almost everywhere)";
    case rsl::DerivativeRule::ZeroWarn:
        return "taken as zero, with a warning";
    case rsl::DerivativeRule::Inherent:
        return "exact";
    }
    return "";
}

Json shadeopJson(const rsl::Shadeop& s) {
    Json j;
    j["name"] = s.name;
    j["section"] = s.section;
    for (const auto& g : s.signatures) j["signatures"].push_back(g.text);
    j["doc"] = s.doc;
    j["evaluation"] = loweringText(s.lowering);
    j["available"] = s.lowering != rsl::Lowering::Unavailable;
    j["derivatives"] = derivativeText(s.derivative);
    j["pure"] = s.pure;
    j["bias"] = s.bias == rsl::Bias::Unbiased ? "unbiased" : s.bias == rsl::Bias::Consistent ? "consistent" : "biased";
    if (!s.biasReason.empty()) j["biasReason"] = s.biasReason;
    j["optional"] = Json::array();
    for (const auto& o : s.optional)
        j["optional"].push_back({{"name", o.name},
                                 {"type", rsl::toString(o.type)},
                                 {"output", o.output},
                                 {"default", o.defaultText},
                                 {"doc", o.doc}});
    j["examples"] = Json::array();
    for (const auto& e : s.examples) j["examples"].push_back({{"expression", e.expression}, {"value", e.value}});
    if (!s.source.empty()) j["source"] = s.source;
    return j;
}

void printShadeop(const rsl::Shadeop& s) {
    std::printf("%s  (%s)\n\n", s.name.c_str(), s.section.c_str());
    for (const auto& g : s.signatures) std::printf("    %s\n", g.text.c_str());
    if (!s.doc.empty()) std::printf("\n%s\n", s.doc.c_str());
    if (!s.optional.empty()) {
        std::printf("\nOptional parameters\n");
        for (const auto& o : s.optional)
            std::printf("    %s%s \"%s\"%s%s  %s\n", o.output ? "output " : "", rsl::toString(o.type).c_str(), o.name.c_str(),
                        o.defaultText.empty() ? "" : " = ", o.defaultText.c_str(), o.doc.c_str());
    }
    if (!s.examples.empty()) std::printf("\nExamples\n");
    for (const auto& e : s.examples) std::printf("    %s  gives  %s\n", e.expression.c_str(), e.value.c_str());
    std::printf("\nEvaluation: %s. Derivatives: %s.", loweringText(s.lowering), derivativeText(s.derivative));
    if (s.bias != rsl::Bias::Unbiased)
        std::printf(" %s: %s.", s.bias == rsl::Bias::Consistent ? "Consistent" : "Biased", s.biasReason.c_str());
    std::printf("\n");
    if (!s.source.empty()) std::printf("Source: %s\n", s.source.c_str());
}

int shadeops(const std::string& name, bool json) {
    if (name.empty()) {
        if (json) {
            Json all = Json::array();
            for (const auto& s : rsl::shadeops()) all.push_back(shadeopJson(s));
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
    if (json) std::printf("%s\n", shadeopJson(*s).dump(2).c_str());
    else printShadeop(*s);
    return kDone;
}

const char* storageText(rsl::Storage s) { return s == rsl::Storage::Varying ? "varying" : "uniform"; }

std::string kindText(const rsl::CompiledShader& s) {
    std::string k = rsl::toString(s.kind());
    std::transform(k.begin(), k.end(), k.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return k;
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
        std::string file, shadeop;
        std::vector<std::string> searchPaths;
        bool json = false;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = app.add_subcommand("info", "Tell what a shader is, or how a shadeop works");
    c->add_option("shader", a->file, "RSL file, or the name of a shader on the search path");
    CLI::Option* ops = c->add_option("--shadeops", a->shadeop, "List the shadeops, or print the manual of one")
                           ->expected(0, 1)
                           ->type_name("[NAME]");
    c->add_flag("--json", a->json, "As JSON");
    c->add_option("--searchpath", a->searchPaths, "Folders for shaders and #include, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    c->callback([a, ops, status] {
        if (ops->count()) {
            *status = shadeops(a->shadeop, a->json);
            return;
        }
        if (a->file.empty()) throw CLI::RequiredError("shader or --shadeops");
        Diagnostics diags(printer());
        rsl::ShaderCompiler compiler;
        std::vector<std::string> paths{"."};
        for (std::string& f : folders(a->searchPaths)) paths.push_back(std::move(f));
        for (std::string& f : environmentShaders()) paths.push_back(std::move(f));
        if (std::string s = shippedShaders(); !s.empty()) paths.push_back(s);
        auto shader = compiler.load(a->file, paths, diags);
        *status = shader ? kDone : kDoneWithErrors;
        if (!shader) return;
        rsl::KernelOptions options;
        options.path = true;
        auto kernel = compiler.analyse(*shader, options, diags);
        auto defaults = compiler.parameterDefaults(shader, diags);
        Json j;
        j["name"] = shader->name();
        j["type"] = kindText(*shader);
        j["file"] = shader->path();
        j["parameters"] = Json::array();
        for (size_t i = 0; i < shader->parameters().size(); ++i) {
            const rsl::ParameterInfo& p = shader->parameters()[i];
            Json q = {
                {"name", p.name}, {"type", rsl::toString(p.type)}, {"storage", storageText(p.storage)}, {"output", p.output}};
            if (p.hasDefault && i < defaults.size()) {
                if (defaults[i].type.base == rsl::Base::String) q["default"] = defaults[i].strings;
                else q["default"] = defaults[i].numbers;
            }
            j["parameters"].push_back(q);
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
        std::printf("%s \"%s\"  (%s)\n", kindText(*shader).c_str(), shader->name().c_str(), shader->path().c_str());
        for (size_t i = 0; i < shader->parameters().size(); ++i) {
            const rsl::ParameterInfo& p = shader->parameters()[i];
            std::string value = p.hasDefault && i < defaults.size() ? " = " + valueText(defaults[i]) : "";
            std::printf("    %s%s %s %s%s\n", p.output ? "output " : "", storageText(p.storage), rsl::toString(p.type).c_str(),
                        p.name.c_str(), value.c_str());
        }
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
