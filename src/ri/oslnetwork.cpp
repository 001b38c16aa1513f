#include "ri/oslnetwork.h"
#include "base/file.h"
#include "base/limits.h"
#include "base/xml.h"
#include "ri/interpreter.h"
#include "ri/ris.h"
#include <algorithm>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

constexpr char kLayerMark = '\x1e'; // between the handle of a network and a layer: in no text of a file

constexpr size_t kXmlDepth = 64;

/// A side of a connection as the file has it.
struct End {
    const XmlElement* element = nullptr;
    std::string node, layer, parameter;
};

const std::string& textOf(const XmlElement& e, std::string_view child) {
    static const std::string none;
    const XmlElement* c = e.child(child);
    return c ? c->text : none;
}

End endOf(const XmlElement& connection, std::string_view side) {
    const XmlElement* e = connection.child(side);
    if (!e) return {&connection, "", "", ""};
    return {e, textOf(*e, "NodeId"), textOf(*e, "NodeLayer"), textOf(*e, "ParameterName")};
}

/// Elements of that name anywhere below `in`, in their order. No deeper than the reader of XML lets them be.
void below(const XmlElement& in, std::string_view name, std::vector<const XmlElement*>& out) {
    for (const XmlElement& e : in.children)
        if (e.name == name) out.push_back(&e);
        else below(e, name, out);
}

/// The layer that is meant; empty: none.
std::string layerOf(const OslNetwork& n, const End& e) {
    const auto named = [&](const std::string& name, std::string OslNode::* by) {
        const auto at = std::find_if(n.nodes.begin(), n.nodes.end(), [&](const OslNode& o) { return o.*by == name; });
        return at == n.nodes.end() ? std::string() : at->layer;
    };
    const std::string layer = e.layer.empty() ? std::string() : named(e.layer, &OslNode::layer);
    return layer.empty() ? named(e.node, &OslNode::shader) : layer;
}

bool namedAsNetwork(const std::string& path) { return path.ends_with(".xml"); }

} // namespace

std::optional<OslNetwork> oslNetwork(std::string_view xml, const std::string& file, Diagnostics& reported) {
    const auto root = parseXml(xml, file, reported, {.anyEndTag = true, .depth = kXmlDepth});
    if (!root) return {};
    const auto wrong = [&](const XmlElement& at, std::string what) -> std::optional<OslNetwork> {
        reported.report(Severity::Error, Rie::BadFile, {file, at.line, at.column}, std::move(what));
        return {};
    };
    std::vector<const XmlElement*> nodes, connections;
    below(*root, "Node", nodes);
    below(*root, "Connection", connections);
    if (root->name != "RenderManOSLNetwork" || nodes.empty()) return wrong(*root, "it is no <RenderManOSLNetwork> with nodes");
    if (nodes.size() > kNetworkPatterns || connections.size() > kNetworkPatterns)
        return wrong(*root, fmt::format("it has more than {} nodes or connections", kNetworkPatterns));
    OslNetwork n;
    for (const XmlElement* e : nodes) {
        OslNode node{textOf(*e, "NodeId"), textOf(*e, "NodeLayer")};
        if (node.shader.empty()) return wrong(*e, "it has a Node without a NodeId");
        if (node.layer.empty()) node.layer = node.shader;
        n.nodes.push_back(std::move(node));
    }
    for (const XmlElement* e : connections) {
        const End from = endOf(*e, "Source"), to = endOf(*e, "Destination");
        OslLink link{layerOf(n, from), from.parameter, layerOf(n, to), to.parameter};
        if (link.from.empty() || link.to.empty()) {
            const End& lost = link.from.empty() ? from : to;
            return wrong(*lost.element, fmt::format("it connects \"{}\", which is none of its nodes",
                                                    lost.layer.empty() ? lost.node : lost.layer));
        }
        n.links.push_back(std::move(link));
    }
    return n;
}

std::string layersOf(std::string_view handle) { return std::string(handle) + kLayerMark; }
std::string layerHandle(std::string_view handle, std::string_view layer) { return layersOf(handle) + std::string(layer); }

std::string shownHandle(std::string_view handle) {
    std::string shown(handle);
    std::replace(shown.begin(), shown.end(), kLayerMark, ':');
    return shown;
}

/// Pattern "PxrOSL" with a network: each layer becomes a pattern, of which the last answers to the handle itself, too.
void Interpreter::oslPatterns(const Call& call, const scene::ShaderCall& given, const scene::Param& named) {
    std::string name = named.strings.empty() ? std::string() : named.strings[0];
    if (!namedAsNetwork(name)) name += ".xml";
    const std::string path = locate("OSL network", name, named.place, namedAsNetwork, "shader");
    if (path.empty()) return; // which is said
    Diagnostics reported;
    const auto bytes = readWholeFile(path, limits::kShaderFileLooked, reported);
    for (const Diagnostic& d : reported.all()) reporter.error(d.code, named.place, d.message, d.hint);
    if (!bytes) return;
    Diagnostics faults;
    const auto network = oslNetwork(std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()), path, faults);
    for (const Diagnostic& d : faults.all())
        reporter.error(Rie::BadFile, d.place, fmt::format("OSL network \"{}\" is not read: {}", name, d.message),
                       fmt::format("it is named at {}:{}:{}", named.place.file, named.place.line, named.place.column));
    if (!network) return;
    const std::string& handle = call.text(1);
    for (const OslNode& node : network->nodes) {
        auto layer = std::make_shared<scene::ShaderCall>(given);
        layer->name = node.shader;
        layer->params.clear();
        layer->connections.clear();
        const auto own = [&](const std::string& parameter) {
            return parameter.starts_with(node.layer + ".") ? parameter.substr(node.layer.size() + 1) : std::string();
        };
        for (const OslLink& l : network->links)
            if (l.to == node.layer)
                layer->connections.push_back({l.parameter, -1, layerHandle(handle, l.from), l.output, named.place});
        for (scene::Connection c : given.connections)
            if (!(c.parameter = own(c.parameter)).empty()) layer->connections.push_back(std::move(c));
        for (scene::Param p : given.params)
            if (!(p.name = own(p.name)).empty()) layer->params.push_back(std::move(p));
        attributes().coshaders[layerHandle(handle, node.layer)] = layer;
        attributes().coshaders[handle] = layer;
    }
}

} // namespace alpenglow::ri
