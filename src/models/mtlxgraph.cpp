#include "models/mtlxgraph.h"
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <sstream>

namespace alpenglow::models {

namespace {

constexpr size_t kDepth = 400, kStatements = size_t(4) << 20; ///< nodes below each other; bytes of a shader

/// "0.8, 0.5, 0.3" or "true".
std::optional<MtlxValue> numbersIn(const std::string& text) {
    if (text == "true") return MtlxValue{"1"};
    if (text == "false") return MtlxValue{"0"};
    MtlxValue out;
    std::istringstream list(text);
    for (std::string one; std::getline(list, one, ',');) {
        char* end = nullptr;
        const double v = std::strtod(one.c_str(), &end);
        if (end == one.c_str() || !std::isfinite(v)) return {};
        out.push_back(mtlxNumber(v));
    }
    if (out.empty() || out.size() > 4) return {};
    return out;
}

} // namespace

std::string mtlxNumber(double v) {
    if (!std::isfinite(v)) v = 0;
    return v < 0 ? fmt::format("({:.9g})", v) : fmt::format("{:.9g}", v);
}

size_t mtlxWidth(const std::string& type) {
    if (type == "float" || type == "integer" || type == "boolean") return 1;
    if (type == "vector2") return 2;
    if (type == "color3" || type == "vector3") return 3;
    return type == "color4" || type == "vector4" ? 4 : 0;
}

MtlxValue mtlxFit(MtlxValue v, size_t width) {
    if (v.empty()) v = {"0"};
    if (v.size() == 1 && width > 1) v.resize(std::min<size_t>(width, 3), std::string(v[0]));
    while (v.size() < width) v.push_back(v.size() == 3 ? "1" : "0");
    v.resize(width);
    return v;
}

void MtlxGraph::warn(const XmlElement& at, const std::string& text) {
    if (reported_.insert(text).second && reported_.size() < 50)
        diags_.report(Severity::Warning, Rie::Incapable, {file_, at.line, at.column}, text);
}

const XmlElement* MtlxGraph::inputOf(const XmlElement& node, const std::string& name) {
    for (const XmlElement& c : node.children)
        if ((c.name == "input" || c.name == "parameter") && c.attribute("name") == name) return &c;
    return nullptr;
}

const XmlElement* MtlxGraph::named(const XmlElement& in, const std::string& name) const {
    for (const XmlElement& c : in.children)
        if (c.name != "input" && c.name != "output" && c.attribute("name") == name) return &c;
    return nullptr;
}

/// Statements that make variables of expressions; numbers and names stay as they are.
MtlxValue MtlxGraph::emit(const MtlxValue& expressions) {
    MtlxValue out;
    for (const std::string& e : expressions) {
        const bool simple = e.find_first_not_of("0123456789.abcdefghijklmnopqrstuvwxyz_") == e.npos;
        out.push_back(simple ? e : variable("float", e));
    }
    return out;
}

std::string MtlxGraph::variable(const char* type, const std::string& expression) {
    const std::string name = fmt::format("mx{}", ++count_);
    if (code_.size() < kStatements) code_ += fmt::format("    {} {} = {};\n", type, name, expression);
    return name;
}

MtlxValue MtlxGraph::coordinates() { return emit({"s", "1 - t"}); }

std::optional<MtlxValue> MtlxGraph::outputOf(const XmlElement& graph, const std::string& output, size_t width) {
    for (const XmlElement& c : graph.children)
        if (c.name == "output" && (output.empty() || c.attribute("name") == output) && graphs_ < 50) {
            ++graphs_;
            auto v = resolve(c, {&graph}, width);
            --graphs_;
            return v;
        }
    warn(graph, fmt::format("nodegraph \"{}\" has no output \"{}\"", graph.attribute("name"), output));
    return {};
}

/// What an input or output is connected to, or its value.
std::optional<MtlxValue> MtlxGraph::resolve(const XmlElement& x, Scope scope, size_t width) {
    const XmlElement& in = scope.graph ? *scope.graph : root_;
    const std::string &graph = x.attribute("nodegraph"), &name = x.attribute("nodename"), &face = x.attribute("interfacename");
    std::optional<MtlxValue> v;
    if (!face.empty() && scope.graph) {
        if (const XmlElement* outer = inputOf(*scope.graph, face); outer && outer != &x) v = resolve(*outer, {}, width);
    } else if (!graph.empty()) {
        const XmlElement* g = named(root_, graph);
        if (g && open_.size() < kDepth) v = outputOf(*g, x.attribute("output"), width);
        else warn(x, fmt::format("there is no nodegraph \"{}\"", graph));
    } else if (!name.empty()) {
        const XmlElement* n = named(in, name);
        if (!n) warn(x, fmt::format("there is no node \"{}\"", name));
        else if (n->name == "nodegraph") v = outputOf(*n, x.attribute("output"), width);
        else v = node(*n, scope, x.attribute("output"));
    } else if (const std::string& value = x.attribute("value"); !value.empty()) {
        v = numbersIn(value);
        if (!v) warn(x, fmt::format("\"{}\" is no value", value.substr(0, 80)));
    }
    if (v && !x.attribute("channels").empty()) { // of 1.37: picked from what is connected
        MtlxValue picked;
        for (const char c : x.attribute("channels")) {
            const size_t k = c == 'r' || c == 'x' ? 0 : c == 'g' || c == 'y' ? 1 : c == 'b' || c == 'z' ? 2 : 3;
            picked.push_back(c == '0' ? "0" : c == '1' ? "1" : k < v->size() ? (*v)[k] : "0");
        }
        v = picked;
    }
    if (v) v = mtlxFit(*v, width);
    return v;
}

std::optional<MtlxValue> MtlxGraph::input(const XmlElement& n, const std::string& name, size_t width) {
    const XmlElement* x = inputOf(n, name);
    return x ? resolve(*x, {}, width) : std::nullopt;
}

bool MtlxGraph::constant(const XmlElement& n, const std::string& name) const {
    const XmlElement* x = inputOf(n, name);
    return x && x->attribute("nodename").empty() && x->attribute("nodegraph").empty() && x->attribute("interfacename").empty();
}

MtlxValue MtlxGraph::node(const XmlElement& n, Scope scope, const std::string& output) {
    const std::pair key{&n, output};
    if (const auto at = known_.find(key); at != known_.end()) return at->second;
    const size_t width = std::max<size_t>(1, mtlxWidth(n.attribute("type")));
    if (open_.count(&n) || open_.size() >= kDepth) {
        warn(n, open_.count(&n) ? fmt::format("node \"{}\" is connected to itself; 0 is taken", n.attribute("name"))
                                : fmt::format("nodes lie more than {} below each other; 0 is taken", kDepth));
        return mtlxFit({"0"}, width);
    }
    open_.insert(&n);
    MtlxNodes nodes{*this, n, scope.graph, output};
    auto v = nodes.value();
    if (!v) {
        warn(n, fmt::format("nodes <{}> are not known here; 0 is taken", n.name.substr(0, 60)));
        v = mtlxFit({"0"}, width);
    }
    open_.erase(&n);
    return known_[key] = *v;
}

MtlxValue MtlxGraph::in(const XmlElement& n, Scope s, const char* name, size_t width, const MtlxValue& byDefault) {
    const XmlElement* x = inputOf(n, name);
    std::optional<MtlxValue> v;
    if (x) v = resolve(*x, s, width);
    return v ? *v : mtlxFit(byDefault, width);
}

MtlxValue MtlxGraph::in(const XmlElement& n, Scope s, const char* name, size_t width, double byDefault) {
    return in(n, s, name, width, MtlxValue(width, mtlxNumber(byDefault)));
}

std::string MtlxGraph::text(const XmlElement& n, Scope s, const char* name, const std::string& byDefault) {
    const XmlElement* x = inputOf(n, name);
    if (x && s.graph && !x->attribute("interfacename").empty()) x = inputOf(*s.graph, x->attribute("interfacename"));
    return x && !x->attribute("value").empty() ? x->attribute("value") : byDefault;
}

/// The nearest that is given: of the file's name, the node, the graph, the document.
const std::string& MtlxGraph::spaceOfColours(const XmlElement& n, Scope s) const {
    const XmlElement* x = inputOf(n, "file");
    if (x && s.graph && !x->attribute("interfacename").empty()) x = inputOf(*s.graph, x->attribute("interfacename"));
    for (const XmlElement* e : {x, &n, s.graph})
        if (e && !e->attribute("colorspace").empty()) return e->attribute("colorspace");
    return root_.attribute("colorspace");
}

} // namespace alpenglow::models
