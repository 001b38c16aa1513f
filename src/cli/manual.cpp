#include "cli/manual.h"
#include "rsl/front/ast.h"
#include <cctype>
#include <map>
#include <vector>

namespace alpenglow::cli {

using OrderedJson = nlohmann::ordered_json;

namespace {

const char* loweringText(shadeops::Lowering l) {
    switch (l) {
    case shadeops::Lowering::Runtime:
        return "machine code inside the kernel";
    case shadeops::Lowering::Rsl:
        return "written in RSL, inlined";
    case shadeops::Lowering::Special:
        return "built into the compiler";
    case shadeops::Lowering::Service:
        return "answered by the renderer at once";
    case shadeops::Lowering::Request:
        return "answered by rays or lights";
    case shadeops::Lowering::Unavailable:
        return "not yet available: it type-checks, a call is reported once";
    }
    return "";
}

const char* derivativeText(shadeops::DerivativeRule d) {
    switch (d) {
    case shadeops::DerivativeRule::Jet:
        return "exact";
    case shadeops::DerivativeRule::Zero:
        return "zero (constant almost everywhere)";
    case shadeops::DerivativeRule::ZeroWarn:
        return "taken as zero, with a warning";
    case shadeops::DerivativeRule::Gradient:
        return "from the slope of the filtered map; second ones those of the coordinates alone";
    case shadeops::DerivativeRule::Inherent:
        return "exact";
    }
    return "";
}

const char* biasName(shadeops::Bias b) {
    return b == shadeops::Bias::Unbiased ? "unbiased" : b == shadeops::Bias::Consistent ? "consistent" : "biased";
}

std::string biasText(const shadeops::Shadeop& s) {
    return std::string(biasName(s.bias)) + (s.biasReason.empty() ? "" : " (" + s.biasReason + ")");
}

std::string optionalText(const shadeops::OptionalParameter& o) {
    return std::string(o.output ? "output " : "") + shadeops::toString(o.type) + " \"" + o.name + "\"" +
           (o.defaultText.empty() ? "" : " = " + o.defaultText);
}

/// '<' and '|' mean something to Markdown, but not in a table's text.
std::string cell(const std::string& s) {
    std::string t;
    for (char c : s) {
        if (c == '|') t += '\\';
        t += c;
    }
    return t;
}

/// The anchor of a heading, as web pages make it.
std::string headingAnchor(std::string name) {
    for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
    return name;
}

bool isInternal(const shadeops::Shadeop& s) { return s.name.rfind("__", 0) == 0; }

} // namespace

std::string contextText(uint32_t contexts) {
    if ((contexts & shadeops::kAnyContext) == shadeops::kAnyContext) return "any shader";
    std::string t;
    for (int k = 0; k < 6; ++k)
        if (const auto kind = rsl::ShaderKind(k); contexts & rsl::contextOf(kind))
            t += (t.empty() ? "" : ", ") + std::string(toString(kind));
    return t;
}

OrderedJson manualJson(const shadeops::Shadeop& s) {
    OrderedJson j;
    j["name"] = s.name;
    j["section"] = s.section;
    for (const auto& g : s.signatures) j["signatures"].push_back(g.text);
    j["doc"] = s.doc;
    j["contexts"] = OrderedJson::array();
    for (int k = 0; k < 6; ++k)
        if (s.contexts & rsl::contextOf(rsl::ShaderKind(k))) j["contexts"].push_back(toString(rsl::ShaderKind(k)));
    j["evaluation"] = loweringText(s.lowering);
    j["available"] = s.lowering != shadeops::Lowering::Unavailable;
    j["derivatives"] = derivativeText(s.derivative);
    j["pure"] = s.pure;
    j["bias"] = biasName(s.bias);
    if (!s.biasReason.empty()) j["biasReason"] = s.biasReason;
    j["optional"] = OrderedJson::array();
    for (const auto& o : s.optional)
        j["optional"].push_back({{"name", o.name},
                                 {"type", shadeops::toString(o.type)},
                                 {"output", o.output},
                                 {"default", o.defaultText},
                                 {"doc", o.doc}});
    j["examples"] = OrderedJson::array();
    for (const auto& e : s.examples) {
        j["examples"].push_back({{"expression", e.expression}, {"value", e.value}});
        if (!e.setup.empty()) j["examples"].back()["setup"] = e.setup;
        if (!e.when.empty()) j["examples"].back()["when"] = e.when;
    }
    if (!s.source.empty()) j["source"] = s.source;
    return j;
}

std::string manualText(const shadeops::Shadeop& s) {
    std::string t = s.name + "  (" + s.section + ")\n\n";
    for (const auto& g : s.signatures) t += "    " + g.text + "\n";
    if (!s.doc.empty()) t += "\n" + s.doc + "\n";
    if (!s.optional.empty()) {
        t += "\nOptional parameters\n";
        for (const auto& o : s.optional) t += "    " + optionalText(o) + "  " + o.doc + "\n";
    }
    if (!s.examples.empty()) t += "\nExamples\n";
    for (const auto& e : s.examples)
        t += "    " + (e.setup.empty() ? "" : e.setup + "  ") + e.expression + "  gives  " + e.value +
             (e.when.empty() ? "" : "  when " + e.when) + "\n";
    t += "\nUsable in: " + contextText(s.contexts) + ".\n";
    t += "Evaluation: " + std::string(loweringText(s.lowering)) + ". Derivatives: " + derivativeText(s.derivative) + ".\n";
    t += "Expected value: " + biasText(s) + ".\n";
    if (!s.source.empty()) t += "Source: " + s.source + "\n";
    return t;
}

std::string manualMarkdown(const shadeops::Shadeop& s, const shadeops::Signature* first) {
    std::string t = "```rsl\n";
    if (first) t += first->text + "\n";
    for (const auto& g : s.signatures)
        if (&g != first) t += g.text + "\n";
    t += "```\n\n" + s.doc + "\n";
    if (!s.optional.empty()) {
        t += "\n| optional parameter | default | meaning |\n|---|---|---|\n";
        for (const auto& o : s.optional)
            t += "| `" + std::string(o.output ? "output " : "") + shadeops::toString(o.type) + " \"" + o.name + "\"` | " +
                 cell(o.defaultText) + " | " + cell(o.doc) + " |\n";
    }
    if (!s.examples.empty()) t += "\nExamples:\n\n";
    for (const auto& e : s.examples)
        t += "- " + (e.setup.empty() ? "" : "`" + e.setup + "` Then ") + "`" + e.expression + "` gives `" + e.value + "`" +
             (e.when.empty() ? "" : " when " + e.when) + "\n";
    t += "\nUsable in " + contextText(s.contexts) + "; " + loweringText(s.lowering) + "; derivatives " +
         derivativeText(s.derivative) + "; " + biasText(s) + ".";
    if (!s.source.empty()) t += " Source: " + s.source + ".";
    return t + "\n";
}

std::string manualPage() {
    std::vector<std::string> sections;
    std::map<std::string, std::vector<const shadeops::Shadeop*>> bySection;
    for (const auto& s : shadeops::allShadeops()) {
        if (isInternal(s)) continue;
        bySection[s.section].push_back(&s);
    }
    for (const auto& [name, list] : bySection) sections.push_back(name);
    std::string t =
        "# Shadeops\n\n"
        "Every built-in function of the shading language, from the descriptors that the compiler itself reads. Made by\n"
        "`alpenglow info --shadeops --markdown`; a test holds this page to them. `alpenglow info --shadeops NAME` prints\n"
        "one of them, `alpenglow eval` runs it.\n\n"
        "*exact* derivatives are those of the function itself, by the rules of calculus. *unbiased* results have the right\n"
        "mean for any number of samples, *consistent* ones in the limit, *biased* ones for the reason that is given.\n\n";
    for (const auto& name : sections) {
        t += "**" + name + "**:";
        for (const shadeops::Shadeop* s : bySection[name]) t += " [" + s->name + "](#" + headingAnchor(s->name) + ")";
        t += "\n\n";
    }
    for (const auto& name : sections) {
        t += "## " + name + "\n\n";
        for (const shadeops::Shadeop* s : bySection[name]) t += "### " + s->name + "\n\n" + manualMarkdown(*s) + "\n";
    }
    t.pop_back();
    return t;
}

} // namespace alpenglow::cli
