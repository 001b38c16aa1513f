#include "ri/oslnetwork.h"
#include "base/file.h"
#include "base/limits.h"
#include "ri/interpreter.h"
#include "ri/ris.h"
#include <algorithm>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

constexpr char kLayerMark = '\x1e'; // between the handle of a network and a layer: in no text of a file

std::string_view trimmed(std::string_view s) {
    const size_t first = s.find_first_not_of(" \t\r\n"), last = s.find_last_not_of(" \t\r\n");
    return first == s.npos ? std::string_view() : s.substr(first, last - first + 1);
}

/// The tags of a text, one after the other, each with the text behind it.
class Tags {
public:
    explicit Tags(std::string_view xml) : rest_(xml) {}
    /// The next opening or closing ("/Node") tag; false at the end.
    bool next() {
        for (;;) {
            const size_t open = rest_.find('<');
            if (open == rest_.npos) return false;
            rest_.remove_prefix(open);
            if (rest_.starts_with("<!--")) {
                const size_t end = rest_.find("-->");
                if (end == rest_.npos) return false;
                rest_.remove_prefix(end + 3);
                continue;
            }
            const size_t close = rest_.find('>');
            if (close == rest_.npos) return false;
            const std::string_view inside = rest_.substr(1, close - 1);
            rest_.remove_prefix(close + 1);
            if (inside.starts_with('?') || inside.starts_with('!')) continue;
            name = inside.substr(0, inside.find_first_of(" \t\r\n", 1));
            text = trimmed(rest_.substr(0, rest_.find('<')));
            return true;
        }
    }
    std::string_view name, text;

private:
    std::string_view rest_;
};

/// A side of a connection as the file has it.
struct End {
    std::string node, layer, parameter;
};

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

std::optional<OslNetwork> oslNetwork(std::string_view xml, std::string& why) {
    OslNetwork n;
    Tags tags(xml);
    OslNode node;
    End ends[2], *side = nullptr;
    bool ours = false;
    std::vector<std::pair<End, End>> connections;
    const auto wrong = [&](std::string what) -> std::optional<OslNetwork> {
        why = std::move(what);
        return {};
    };
    while (tags.next()) {
        if (tags.name == "RenderManOSLNetwork") ours = true;
        else if (tags.name == "Node") node = {};
        else if (tags.name == "Source") side = &ends[0];
        else if (tags.name == "Destination") side = &ends[1];
        else if (tags.name == "NodeId") (side ? side->node : node.shader) = tags.text;
        else if (tags.name == "NodeLayer") (side ? side->layer : node.layer) = tags.text;
        else if (tags.name == "ParameterName" && side) side->parameter = tags.text;
        else if (tags.name == "/Node") {
            if (node.shader.empty()) return wrong("it has a Node without a NodeId");
            if (node.layer.empty()) node.layer = node.shader;
            n.nodes.push_back(node);
        } else if (tags.name == "/Connection") {
            connections.emplace_back(ends[0], ends[1]);
            ends[0] = ends[1] = {};
            side = nullptr;
        }
        if (n.nodes.size() > kNetworkPatterns || connections.size() > kNetworkPatterns)
            return wrong(fmt::format("it has more than {} nodes or connections", kNetworkPatterns));
    }
    if (!ours || n.nodes.empty()) return wrong("it is no <RenderManOSLNetwork> with nodes");
    for (const auto& [from, to] : connections) {
        OslLink link{layerOf(n, from), from.parameter, layerOf(n, to), to.parameter};
        if (link.from.empty() || link.to.empty()) {
            const End& lost = link.from.empty() ? from : to;
            return wrong(
                fmt::format("it connects \"{}\", which is none of its nodes", lost.layer.empty() ? lost.node : lost.layer));
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
    Diagnostics said;
    const auto bytes = readWholeFile(path, limits::kShaderFileLooked, said);
    for (const Diagnostic& d : said.all()) reporter.error(d.code, named.place, d.message, d.hint);
    if (!bytes) return;
    std::string why;
    const auto network = oslNetwork(std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()), why);
    if (!network) return reporter.error(Rie::BadFile, named.place, fmt::format("OSL network \"{}\" is not read: {}", name, why));
    const std::string& handle = call.text(1);
    for (const OslNode& node : network->nodes) {
        auto layer = std::make_shared<scene::ShaderCall>(given);
        layer->name = node.shader;
        layer->params.clear();
        const auto own = [&](const std::string& parameter) {
            return parameter.starts_with(node.layer + ".") ? parameter.substr(node.layer.size() + 1) : std::string();
        };
        for (const OslLink& l : network->links)
            if (l.to == node.layer)
                layer->params.push_back(
                    scene::connectionParam({l.parameter, -1, layerHandle(handle, l.from), l.output, named.place}));
        for (scene::Param p : given.params)
            if (auto c = scene::connectionOf(p)) {
                c->parameter = own(c->parameter);
                if (!c->parameter.empty()) layer->params.push_back(scene::connectionParam(*c));
            } else if (!(p.name = own(p.name)).empty()) layer->params.push_back(std::move(p));
        attributes().coshaders[layerHandle(handle, node.layer)] = layer;
        attributes().coshaders[handle] = layer;
    }
}

} // namespace alpenglow::ri
