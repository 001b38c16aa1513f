#include "models/materialx.h"
#include "base/file.h"
#include "base/xml.h"
#include "models/mtlxgraph.h"
#include "models/standardtext.h"
#include <cctype>
#include <fmt/format.h>

namespace alpenglow::models {

namespace {

constexpr size_t kMtlxBytes = size_t(64) << 20;

/// Inputs of other surfaces under the names of standard_surface.
const std::vector<std::pair<const char*, const char*>>& namesIn(const std::string& node) {
    static const std::vector<std::pair<const char*, const char*>> standard = {{"normal", "bump_normal"}},
                                                                  gltf = {{"metallic", "metalness"},
                                                                          {"roughness", "specular_roughness"},
                                                                          {"ior", "specular_IOR"},
                                                                          {"clearcoat", "coat"},
                                                                          {"clearcoat_roughness", "coat_roughness"},
                                                                          {"emissive", "emission_color"},
                                                                          {"emissive_strength", "emission"},
                                                                          {"alpha", "opacity"},
                                                                          {"normal", "bump_normal"}},
                                                                  usd = {{"diffuseColor", "base_color"},
                                                                         {"metallic", "metalness"},
                                                                         {"roughness", "specular_roughness"},
                                                                         {"ior", "specular_IOR"},
                                                                         {"clearcoat", "coat"},
                                                                         {"clearcoatRoughness", "coat_roughness"},
                                                                         {"emissiveColor", "emission_color"},
                                                                         {"normal", "bump_normal"}};
    return node == "gltf_pbr" ? gltf : node == "UsdPreviewSurface" ? usd : standard;
}

bool isSurface(const std::string& node) {
    return node == "standard_surface" || node == "gltf_pbr" || node == "UsdPreviewSurface";
}

const XmlElement* child(const XmlElement& of, const std::string& name) {
    for (const XmlElement& c : of.children)
        if (c.attribute("name") == name) return &c;
    return nullptr;
}

/// The surface node of a material of this name, or of the first; a material may also be named by its surface node.
const XmlElement* surfaceOf(const XmlElement& root, const std::string& wanted) {
    for (const XmlElement& m : root.children)
        if (m.name == "surfacematerial" && (wanted.empty() || m.attribute("name") == wanted))
            for (const XmlElement& x : m.children)
                if (x.name == "input" && x.attribute("name") == "surfaceshader")
                    if (const XmlElement* s = child(root, x.attribute("nodename")); s && isSurface(s->name)) return s;
    for (const XmlElement& s : root.children)
        if (isSurface(s.name) && (wanted.empty() || s.attribute("name") == wanted)) return &s;
    return nullptr;
}

std::string identifier(const std::string& name) {
    std::string out;
    for (const char c : name) out += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    if (out.empty() || std::isdigit(static_cast<unsigned char>(out[0]))) out = "m_" + out;
    return out;
}

/// The head of the shader: parameters that the file gives numbers keep these as defaults, those that nodes work out become
/// variables, whose values go to `locals`.
class Head {
public:
    Head(const StandardText& t, const XmlElement& surface, MtlxGraph& graph) : text_(t), surface_(surface), graph_(graph) {}
    void make() {
        for (const StandardParameter& p : text_.parameters) parameter(p);
        unknown();
    }
    std::string parameters, locals;

private:
    std::string inputName(const StandardParameter& p) const {
        for (const auto& [theirs, ours] : namesIn(surface_.name))
            if (p.name == ours) return theirs;
        return p.name;
    }
    void keep(const StandardParameter& p, const std::string& value) {
        parameters += fmt::format("    {} {}{} = {};\n", p.type, p.name, p.array, value);
    }
    void parameter(const StandardParameter& p) {
        const std::string type = p.plainType(), name = inputName(p);
        const bool number = (type == "float" || type == "color" || type == "normal") && p.array.empty();
        std::optional<MtlxValue> v;
        if (number) v = graph_.input(surface_, name, type == "float" ? 1 : 3);
        if (!v && p.name == "emission" && surface_.name != "standard_surface") v = MtlxValue{"1"};
        if (!v && p.name == "emission_color" && surface_.name != "standard_surface") v = MtlxValue{"0", "0", "0"};
        if (!v) return keep(p, p.value);
        const std::string text = type == "float" ? (*v)[0] : fmt::format("{} ({}, {}, {})", type, (*v)[0], (*v)[1], (*v)[2]);
        if (graph_.constant(surface_, name)) return keep(p, text);
        if (p.type.rfind("varying", 0) != 0) graph_.warn(surface_, fmt::format("{} is made by nodes", name));
        locals += fmt::format("    {} {} = {};\n", type, p.name, text);
    }
    /// Inputs that no parameter takes.
    void unknown() {
        for (const XmlElement& x : surface_.children) {
            const std::string& name = x.attribute("name");
            bool known = false;
            for (const StandardParameter& p : text_.parameters) known = known || inputName(p) == name;
            if (!known && x.name == "input") graph_.warn(x, fmt::format("the input {} has no effect here", name.substr(0, 60)));
        }
    }
    const StandardText& text_;
    const XmlElement& surface_;
    MtlxGraph& graph_;
};

} // namespace

std::string materialxShader(const MaterialxOptions& o, const MaterialxMaps& maps, Diagnostics& d) {
    const auto bytes = readWholeFile(o.file, kMtlxBytes, d, {o.file, 0, 0});
    if (!bytes) return "";
    const auto root = parseXml({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, o.file, d);
    if (!root) return "";
    const auto fail = [&](const std::string& why, const std::string& hint = "") {
        d.report(Severity::Error, Rie::BadFile, {o.file, root->line, root->column}, why, hint);
        return std::string();
    };
    if (root->name != "materialx")
        return fail("this is no MaterialX: its outermost element is <" + root->name.substr(0, 40) + ">");
    const XmlElement* surface = surfaceOf(*root, o.material);
    if (!surface)
        return fail(o.material.empty() ? "it has no material with a standard_surface, gltf_pbr or UsdPreviewSurface"
                                       : "it has no material \"" + o.material + "\" with such a surface");
    const auto standard = takeApart(o.standard);
    if (!standard) return fail("shaders/standard.sl is not there, or has another form than is known");
    MtlxGraph graph(*root, o.file, maps, d);
    Head head(*standard, *surface, graph);
    head.make();
    std::string out = fmt::format("/* {}: made of a material of MaterialX: {} \"{}\". */\n", identifier(o.shader), surface->name,
                                  identifier(surface->attribute("name")));
    for (const std::string& line : standard->includes) out += line + "\n";
    out += fmt::format("surface {}(\n{})\n{{\n{}{}", identifier(o.shader), head.parameters, graph.code(), head.locals);
    return out + standard->body + "}\n";
}

} // namespace alpenglow::models
