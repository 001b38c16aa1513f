#include "rsl/front/lint_calls.h"
#include "base/knownoptions.h"
#include "base/printable.h"
#include <algorithm>
#include <initializer_list>
#include <string_view>

namespace alpenglow::rsl::front {

namespace {

using Names = std::vector<std::string>;

/// Filters of texture(), environment() and the like; some are kinds of one another.
const Names& filters() {
    static const Names all = {
        "box",  "triangle", "gaussian", "catmull-rom",     "separable-catmull-rom", "mitchell", "lanczos", "sinc",
        "disk", "bessel",   "b-spline", "blackman-harris", "radial-bspline",        "point",    "bspline", "catmullrom"};
    return all;
}

/// Names of one argument of a shadeop: all that mean something, or only those that are well known, where scenes may have more.
struct NamedArgument {
    const char* shadeop;
    size_t argument;
    size_t least; ///< arguments in the call, for this one to be the name
    bool all;
    const char* what;
    Names names;
};

Names namesOf(std::span<const known::OptionDescription> table) {
    Names names;
    for (const known::OptionDescription& d : table) names.emplace_back(d.name);
    return names;
}

const std::vector<NamedArgument>& namedArguments() {
    static const Names spaces = {"current", "world", "camera", "object", "shader", "screen", "raster", "NDC", "eye"};
    static const std::vector<NamedArgument> all = {
        {"rayinfo",
         0,
         2,
         true,
         "rayinfo",
         {"type", "label", "depth", "speculardepth", "diffusedepth", "origin", "direction", "length", "weight"}},
        {"textureinfo",
         1,
         3,
         true,
         "textureinfo",
         {"resolution", "type", "channels", "viewingmatrix", "projectionmatrix", "exists", "bitsperchannel", "min", "max"}},
        {"rendererinfo", 0, 2, true, "rendererinfo", {"renderer", "version", "versionstring"}},
        {"area", 1, 2, true, "area", {"shading", "dicing"}},
        {"spline",
         0,
         3,
         true,
         "basis",
         {"catmull-rom", "catmullrom", "bezier", "b-spline", "bspline", "hermite", "linear", "solvecatmull-rom",
          "solvecatmullrom", "solvebezier", "solveb-spline", "solvebspline", "solvehermite", "solvelinear"}},
        {"transform", 0, 2, false, "space", spaces},
        {"transform", 1, 3, false, "space", spaces},
        {"vtransform", 0, 2, false, "space", spaces},
        {"vtransform", 1, 3, false, "space", spaces},
        {"ntransform", 0, 2, false, "space", spaces},
        {"ntransform", 1, 3, false, "space", spaces},
        {"option", 0, 2, false, "option", namesOf(known::knownOptions())},
        {"attribute", 0, 2, false, "attribute", namesOf(known::knownAttributes())}};
    return all;
}

bool contains(const Names& names, const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); }

std::string didYouMean(const std::string& near) { return near.empty() ? "" : "did you mean \"" + near + "\"?"; }

/// The same, or all that there are.
std::string oneOf(const std::string& near, const Names& names) {
    if (!near.empty()) return didYouMean(near);
    std::string all;
    for (const std::string& n : names) all += (all.empty() ? "" : ", ") + n;
    return "there are: " + all;
}

/// A name of a list that is complete, or that is at least well known.
void name(const std::string& given, Place place, const NamedArgument& a, SourceSet& sources) {
    // The names of the interface have a prefix today and had none in the specification: "Clipping", "Sides".
    if (given.empty() || contains(a.names, given) || contains(a.names, "Ri:" + given)) return;
    const std::string near = nearestName(given, a.names);
    if (!a.all && (near.empty() || near == given)) return;
    const std::string what = a.what;
    if (what == "basis") sources.report(place, msg::kUnknownBasis(given), oneOf(near, a.names));
    else if (what == "area") sources.report(place, msg::kUnknownAreaStrategy(given), oneOf(near, a.names));
    else if (what == "space") sources.report(place, msg::kUnknownSpace(given), didYouMean(near));
    else sources.report(place, msg::kUnknownName(what, given), oneOf(near, a.names));
}

/// `point "wrold" (...)`; the spaces of colours are the checker's.
void space(const Expr& e, SourceSet& sources) {
    if (!e.space || e.space->kind != ExprKind::String || e.type.base == Base::Color) return;
    for (const NamedArgument& a : namedArguments())
        if (std::string_view(a.what) == "space" && a.argument == 0) return name(e.space->text, e.space->place, a, sources);
}

/// One conversion of a pattern: its letter, 0 at the end of the text.
std::vector<char> conversions(const std::string& pattern) {
    std::vector<char> letters;
    for (size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != '%') continue;
        for (++i; i < pattern.size() && std::string_view("-+ #0123456789.*").find(pattern[i]) != std::string_view::npos;) ++i;
        const char c = i < pattern.size() ? pattern[i] : '\0';
        if (c != '%') letters.push_back(c == 'v' || c == 'n' ? 'p' : c == 'i' ? 'd' : c);
    }
    return letters;
}

const Expr& bare(const Expr& e) {
    const Expr* x = &e;
    while (x->kind == ExprKind::Cast && !x->space && !x->args.empty() && x->place.line == x->args[0]->place.line &&
           x->place.column == x->args[0]->place.column)
        x = x->args[0].get(); // put there by the checker
    return *x;
}

void pattern(const Expr& e, SourceSet& sources) {
    if (e.args.empty() || e.args[0]->kind != ExprKind::String) return;
    const std::vector<char> letters = conversions(e.args[0]->text);
    const size_t values = e.args.size() - 1;
    size_t takes = 0;
    for (const char c : letters) {
        if (c && std::string_view("fegdpcmsh").find(c) != std::string_view::npos) {
            const size_t n = ++takes;
            if (n > values) continue;
            const Expr& v = *e.args[n];
            const Base b = v.type.base;
            const bool triple = b == Base::Color || b == Base::Point || b == Base::Vector || b == Base::Normal;
            const char* wants =
                c == 's' || c == 'h' ? (isStringLike(b) ? nullptr
                                        : c == 's'      ? "strings"
                                                        : "shaders")
                : c == 'm'           ? (b == Base::Matrix ? nullptr : "matrices")
                : c == 'p' || c == 'c'
                    ? (triple     ? nullptr
                       : c == 'p' ? "points, vectors and normals"
                                  : "colours")
                    : (b == Base::Float || b == Base::Bool || triple ? nullptr : "floats"); // a triple shows its parts
            if (wants && v.type.base != Base::Void) sources.report(v.place, msg::kFormatKind(c, wants, toString(v.type)));
        } else {
            sources.report(e.args[0]->place, c ? msg::kFormatConversion(c) : Raised(msg::kFormatEnd));
        }
    }
    if (takes > values)
        sources.report(e.args[0]->place,
                       msg::kFormatFew(counted(takes, "value"), values == 1   ? std::string("is 1")
                                                                : values == 0 ? std::string("is none")
                                                                              : "are " + std::to_string(values)));
    else if (takes < values)
        sources.report(e.args[takes + 1]->place,
                       msg::kFormatMany(takes == 0 ? std::string("no value") : "only " + counted(takes, "value")));
}

void filter(const Expr& e, SourceSet& sources) {
    if (e.text == "filterstep") return; // the checker knows its own
    for (const NamedArg& p : e.pairs)
        if (p.name == "filter" && p.value && p.value->kind == ExprKind::String && !contains(filters(), p.value->text))
            sources.report(p.value->place, msg::kNoSuchFilter(p.value->text, e.text),
                           oneOf(nearestName(p.value->text, filters()), filters()));
}

} // namespace

void lintCall(const Expr& e, SourceSet& sources) {
    if (e.kind == ExprKind::Tuple || e.kind == ExprKind::MatrixTuple || e.kind == ExprKind::Cast) space(e, sources);
    if (!e.shadeop || (e.kind != ExprKind::ShadeopCall && e.kind != ExprKind::FunctionCall)) return;
    const std::string& op = e.shadeop->name;
    if (op == "printf" || op == "print" || op == "format") pattern(e, sources);
    filter(e, sources);
    for (const NamedArgument& a : namedArguments()) {
        if (op != a.shadeop || e.args.size() < a.least || a.argument >= e.args.size() || !e.args[a.argument]) continue;
        const Expr& given = *e.args[a.argument];
        if (given.kind != ExprKind::String) continue;
        name(given.text, given.place, a, sources);
    }
    // Shadeops that are not available yet have parameters, too; only names close to one are reported.
    if (e.shadeop->lowering != Lowering::Unavailable) return;
    Names known;
    for (const auto& o : e.shadeop->optional) known.push_back(o.name);
    for (const NamedArg& p : e.pairs) {
        if (contains(known, p.name) || p.name.find(':') != std::string::npos) continue;
        if (const std::string near = nearestName(p.name, known); !near.empty())
            sources.report(p.place, msg::kNoSuchParameter(op, p.name), didYouMean(near));
    }
}

void lintMessage(const Expr& e, const Program& program, const Paths& paths, SourceSet& sources) {
    if (!e.shadeop || e.args.size() < 2 || e.args[0]->kind != ExprKind::String) return;
    const std::string& op = e.shadeop->name;
    ShaderKind kind;
    if (op == "surface") kind = ShaderKind::Surface;
    else if (op == "displacement") kind = ShaderKind::Displacement;
    else if (op == "lightsource") kind = ShaderKind::Light;
    else if (op == "atmosphere" || op == "incident" || op == "opposite") kind = ShaderKind::Volume;
    else return;
    const auto to = paths.of(*e.args[1]);
    if (!to || paths.memberStorage(*to->symbol, to->first) != Storage::Uniform || isStringLike(to->type.base)) return;
    const Shader* varying = nullptr;
    for (const auto& s : program.shaders)
        for (const ShaderParameter& p : s->parameters) {
            if (s->kind != kind || p.symbol->name != e.args[0]->text) continue;
            if (p.symbol->storage != Storage::Varying) return; // of one that it may take
            varying = s.get();
        }
    if (varying) sources.report(e.args[1]->place, msg::kUniformReceiver(to->name, e.args[0]->text, varying->name, op));
}

void lintCondition(const Expr& e, SourceSet& sources) {
    const Expr& x = bare(e);
    if (x.kind == ExprKind::Assign && x.op == ExprOp::Assign) sources.report(x.place, msg::kAssignmentCondition);
    if (x.kind == ExprKind::Unary || x.kind == ExprKind::Cast ||
        (x.kind == ExprKind::Binary && (x.op == ExprOp::And || x.op == ExprOp::Or || x.op == ExprOp::NotEqual)))
        for (const auto& a : x.args)
            if (a) lintCondition(*a, sources);
}

void lintPairs(const Stmt& s, SourceSet& sources) {
    if (s.kind != StmtKind::Gather) return;
    static const Names names = {"bias",     "maxdist", "samplebase", "distribution", "label",         "subset",     "hitmode",
                                "hitsides", "type",    "raytype",    "raylabel",     "excludesubset", "maxhitdist", "othreshold"};
    static const Names sends = {"surface", "displacement", "volume", "ray", "primitive", "attribute", "environment"};
    for (const NamedArg& p : s.pairs) {
        const size_t colon = p.name.find(':');
        const std::string head = p.name.substr(0, colon);
        const Names& known = colon == std::string::npos ? names : sends;
        if (contains(known, head)) continue;
        const std::string near = nearestName(head, known);
        if (!near.empty())
            sources.report(p.place, msg::kNoSuchParameter("gather", p.name),
                           didYouMean(colon == std::string::npos ? near : near + p.name.substr(colon)));
    }
}

void lintCommas(const std::vector<Token>& tokens, SourceSet& sources) {
    for (size_t i = 0; i + 1 < tokens.size(); ++i)
        if (tokens[i].is(",") && tokens[i + 1].is(")") && tokens[i].place.file >= 0 &&
            sources.name(tokens[i].place.file) == sources.name(0))
            sources.report(tokens[i].place, msg::kTrailingComma);
}

} // namespace alpenglow::rsl::front
