// Graphs of MaterialX as statements of RSL. Every value is a list of one to four numbers, each an expression of type float; what
// a node makes of them stands in variables.
#pragma once
#include "base/xml.h"
#include "models/materialx.h"
#include <map>
#include <set>

namespace alpenglow::models {

/// 1: float, integer, boolean; 2: vector2; 3: color3, vector3; 4: color4, vector4.
using MtlxValue = std::vector<std::string>;

/// Translates the nodes of one file, each once.
class MtlxGraph {
public:
    /// root: the element materialx. file: for messages. All must outlive the graph.
    MtlxGraph(const XmlElement& root, const std::string& file, const MaterialxMaps& maps, Diagnostics& d)
        : root_(root), file_(file), maps_(maps), diags_(d) {}

    /// An input of a shader node at the top of the file: nothing when it is not given.
    std::optional<MtlxValue> input(const XmlElement& node, const std::string& name, size_t width);
    /// Whether an input has a value that is written in the file, not made by nodes.
    bool constant(const XmlElement& node, const std::string& name) const;
    /// The statements so far.
    const std::string& code() const { return code_; }
    /// Warns once of something that the translation leaves out.
    void warn(const XmlElement& at, const std::string& text);

private:
    friend struct MtlxNodes;
    /// Where a node is looked up: a nodegraph, or the file (graph null).
    struct Scope {
        const XmlElement* graph = nullptr;
        bool operator<(const Scope& o) const { return graph < o.graph; }
    };
    static const XmlElement* inputOf(const XmlElement& node, const std::string& name);
    const XmlElement* named(const XmlElement& in, const std::string& name) const;
    std::optional<MtlxValue> resolve(const XmlElement& input, Scope, size_t width);
    std::optional<MtlxValue> outputOf(const XmlElement& graph, const std::string& output, size_t width);
    MtlxValue node(const XmlElement&, Scope, const std::string& output);

    // for nodes
    MtlxValue in(const XmlElement& n, Scope s, const char* name, size_t width, double byDefault);
    MtlxValue in(const XmlElement& n, Scope s, const char* name, size_t width, const MtlxValue& byDefault);
    std::string text(const XmlElement& n, Scope s, const char* name, const std::string& byDefault);
    MtlxValue emit(const MtlxValue& expressions);
    std::string variable(const char* type, const std::string& expression);
    MtlxValue coordinates();
    const std::string& spaceOfColours(const XmlElement& n, Scope s) const;

    const XmlElement& root_;
    const std::string& file_;
    const MaterialxMaps& maps_;
    Diagnostics& diags_;
    std::string code_;
    int count_ = 0, graphs_ = 0; ///< graphs_: how many lie in each other now
    std::map<std::pair<const XmlElement*, std::string>, MtlxValue> known_;
    std::set<const XmlElement*> open_;
    std::set<std::string> reported_;
};

/// Numbers of a type; 0: no type that is a value here.
size_t mtlxWidth(const std::string& type);
/// As many numbers as wanted: one is repeated, too many are cut, missing ones are 0 (the fourth: 1).
MtlxValue mtlxFit(MtlxValue, size_t width);
/// A number of RSL, in brackets when it is negative.
std::string mtlxNumber(double);
/// What nodes see of the graph while one of them is made.
struct MtlxNodes {
    MtlxGraph& g;            ///< the graph that is translated
    const XmlElement& n;     ///< the node
    const XmlElement* graph; ///< the nodegraph that it is in, or null
    std::string output;      ///< which of its outputs
    /// The value of the node; nothing: its kind is not known.
    std::optional<MtlxValue> value();

private:
    MtlxValue in(const char* name, size_t width, double byDefault = 0);
    MtlxValue in(const char* name, size_t width, const MtlxValue& byDefault);
    std::string text(const char* name, const std::string& byDefault);
    MtlxValue emit(const MtlxValue&);
    size_t width() const;
    /// An expression for each number; %a, %b, %c, %d, %e stand for those of the values.
    MtlxValue each(const std::string& expression, const std::vector<MtlxValue>&);
    std::optional<MtlxValue> plain();
    std::optional<MtlxValue> ranges();
    std::optional<MtlxValue> vectors();
    std::optional<MtlxValue> colours();
    std::optional<MtlxValue> channels();
    std::optional<MtlxValue> choices();
    std::optional<MtlxValue> geometry();
    std::optional<MtlxValue> patterns();
    std::optional<MtlxValue> noises();
    MtlxValue picture();
    MtlxValue normalMap();
};

} // namespace alpenglow::models
