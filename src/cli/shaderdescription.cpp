#include "cli/shaderdescription.h"
#include "cli/lspdocument.h"
#include "rsl/evaluate.h"
#include "rsl/front/protocol.h"
#include "rsl/front/visit.h"
#include "rsl/ir/build.h"
#include "rsl/passes/optimize.h"
#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <tuple>

namespace alpenglow::cli {

namespace {

using OrderedJson = nlohmann::ordered_json;

std::string lower(std::string s) {
    std::transform(s.begin(), s.end(), s.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return s;
}

std::string storageText(rsl::Storage s) { return s == rsl::Storage::Varying ? "varying" : "uniform"; }

/// The type as the shader writes it: handles are of type shader, arrays of open length have none.
std::string typeText(shadeops::Type t, const rsl::Symbol* s) {
    if (s && (s->type.array < 0 || s->open || s->resizable)) t.array = -1;
    if (s && s->type.base == shadeops::Base::Shader)
        t.base = shadeops::Base::Shader; // parameters have the types that scenes give
    return shadeops::toString(t);
}

/// Does the value depend on nothing but numbers and texts in the shader?
bool known(const rsl::ir::Inst* i, int depth = 0) {
    using rsl::ir::Op;
    if (!i || depth > 64) return false;
    switch (i->op) {
    case Op::Const:
    case Op::ConstString:
        return true;
    case Op::Result:
    case Op::Add:
    case Op::Sub:
    case Op::Mul:
    case Op::Div:
    case Op::Neg:
    case Op::Splat:
    case Op::Triple:
    case Op::Extract:
    case Op::MatrixOf:
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::NotEqual:
    case Op::And:
    case Op::Or:
    case Op::Not:
    case Op::Select:
    case Op::ToFloat:
    case Op::Runtime:
        return std::all_of(i->args.begin(), i->args.end(), [&](const rsl::ir::Inst* a) { return known(a, depth + 1); });
    default:
        return false;
    }
}

/// Parameters whose default some scene must be asked for.
std::set<std::string> computedDefaults(const rsl::CompiledShader& s) {
    std::set<std::string> names;
    Diagnostics quiet; // parameterValues() says what there is to say
    const auto k = rsl::buildDefaults(s.program(), s.shader(), quiet);
    if (!k) return names;
    rsl::passes::optimize(*k, {}, quiet);
    for (const rsl::ir::Inst* i : k->body.body) {
        if (i->op != rsl::ir::Op::Output || i->index < 0 || size_t(i->index) >= k->outputs.size() || known(i->args[0])) continue;
        names.insert(rsl::OutputName::parse(k->outputs[size_t(i->index)].name).name);
    }
    return names;
}

/// The value of an expression of numbers alone.
std::optional<double> numberOf(const rsl::Expr& e) {
    using rsl::ExprKind;
    using rsl::ExprOp;
    if (e.kind == ExprKind::Number) return e.number;
    if (e.kind == ExprKind::Cast && !e.space && e.type.base == shadeops::Base::Float && !e.args.empty())
        return numberOf(*e.args[0]);
    if (e.kind == ExprKind::Unary && e.op == ExprOp::Negate) {
        const auto a = numberOf(*e.args[0]);
        return a ? std::optional(-*a) : a;
    }
    if (e.kind != ExprKind::Binary || e.args.size() != 2) return std::nullopt;
    const auto a = numberOf(*e.args[0]), b = numberOf(*e.args[1]);
    if (!a || !b) return std::nullopt;
    switch (e.op) {
    case ExprOp::Add:
        return *a + *b;
    case ExprOp::Sub:
        return *a - *b;
    case ExprOp::Mul:
        return *a * *b;
    case ExprOp::Div:
        return *b == 0 ? 0 : *a / *b;
    default:
        return std::nullopt;
    }
}

/// The numbers of a constructor or of one number for all components; empty when they are not all known.
std::vector<float> numbersOf(const rsl::Expr& e, size_t count) {
    using rsl::ExprKind;
    std::vector<float> all;
    if (e.kind == ExprKind::Tuple || e.kind == ExprKind::MatrixTuple) {
        for (const auto& a : e.args) {
            const auto n = numberOf(*a);
            if (!n) return {};
            all.push_back(float(*n));
        }
    } else if (e.kind == ExprKind::Cast && !e.args.empty()) {
        return numbersOf(*e.args[0], count);
    } else if (const auto n = numberOf(e)) {
        if (count == 16)
            for (int i = 0; i < 16; ++i) all.push_back(i % 5 == 0 ? float(*n) : 0);
        else all.assign(count, float(*n));
    }
    return all.size() == count ? all : std::vector<float>{};
}

/// Whether the value is what a name or a call gives, so that the text says more than the value.
bool asks(const rsl::Expr& e) {
    if (e.kind == rsl::ExprKind::Variable && e.symbol && e.symbol->origin != rsl::Symbol::Origin::Global) return true;
    return std::any_of(e.args.begin(), e.args.end(), [](const auto& a) { return a && asks(*a); });
}

DefaultDescription describeDefault(const rsl::ShaderParameter& p, const rsl::ParameterInfo& info, rsl::ParameterValue value,
                                   bool computed) {
    DefaultDescription d;
    d.there = info.hasDefault;
    if (!d.there) return d;
    d.written = p.defaultText;
    d.value = std::move(value);
    d.computed = computed;
    const rsl::Expr* e = p.defaultValue.get();
    d.null = p.symbol->type == shadeops::Type{shadeops::Base::Shader, 0} && d.value.strings == std::vector<std::string>{""};
    d.named = e && !d.written.empty() && asks(*e);
    if (e && e->kind == rsl::ExprKind::ArrayList && e->text == "{}")
        d.value.strings.clear(), d.value.numbers.clear(); // {} has no elements
    while (e && !e->space && e->kind == rsl::ExprKind::Cast && !e->args.empty()) e = e->args[0].get();
    if (!e || !e->space || e->space->kind != rsl::ExprKind::String) return d;
    d.space = e->space->text;
    d.inSpace = numbersOf(*e, size_t(shadeops::componentCount(e->type.base)));
    // Points stay in the space in which they are written: what they are elsewhere, a scene knows.
    if (computed && !d.inSpace.empty() && e->type.base != shadeops::Base::Color && p.symbol->type.array == 0) {
        d.computed = false;
        d.value.numbers = d.inSpace;
    }
    return d;
}

KindDescription describeKind(rsl::ShaderCompiler& compiler, const rsl::CompiledShader& s, Diagnostics& diagnostics) {
    KindDescription k;
    k.kind = lower(rsl::toString(s.kind()));
    rsl::KernelOptions options;
    options.path = true;
    const auto kernel = compiler.analyse(s, options, diagnostics);
    if (!kernel) return k;
    k.compiled = true;
    k.writes = kernel->facts.writes;
    for (const auto& lobe : kernel->facts.direct) k.direct.push_back(lobe.text());
    for (const auto& site : kernel->sites)
        k.indirectApart |= std::find(site.names.begin(), site.names.end(), rsl::kPairApart) != site.names.end();
    k.affine = kernel->facts.affine;
    k.suspends = kernel->facts.suspends;
    k.lightLoops = kernel->facts.lightLoops;
    k.ambient = s.kind() == rsl::ShaderKind::Light && kernel->facts.ambientLight;
    k.whyNot = kernel->facts.whyNot;
    return k;
}

bool isEntry(const std::string& name) {
    static constexpr const char* kNames[] = {
        "construct",        "begin",        "displacement", "opacity", "prelighting", "lighting", "diffuselighting",
        "specularlighting", "postlighting", "surface",      "volume",  "light",       "imager"};
    return std::any_of(std::begin(kNames), std::end(kNames), [&](const char* n) { return name == n; });
}

std::string quoted(const std::string& s) {
    std::string q = "\"";
    for (const char c : s) {
        if (c == '"' || c == '\\') q += '\\';
        if (c == '\n') q += "\\n";
        else if (c == '\t') q += "\\t";
        else q += c;
    }
    return q + "\"";
}

std::string valueText(const rsl::ParameterValue& v) {
    if (v.type.base != shadeops::Base::String) return rsl::formatNumbers(v.numbers);
    std::string t;
    for (const std::string& s : v.strings) t += (t.empty() ? "" : " ") + quoted(s);
    return t;
}

std::string defaultText(const ParameterDescription& p) {
    const DefaultDescription& d = p.byDefault;
    if (!d.there) return "";
    if (d.computed) return " = " + (d.written.empty() ? "" : d.written + "  ") + "(computed)";
    if (!d.space.empty() && d.value.type.base == shadeops::Base::Color) // both, as they are different numbers
        return " = " + (d.written.empty() ? quoted(d.space) + " " + rsl::formatNumbers(d.inSpace) : d.written) + "  (rgb " +
               valueText(d.value) + ")";
    if (d.null) return " = null";
    if (d.named) return " = " + d.written + "  (" + valueText(d.value) + ")";
    if (!d.space.empty()) return " = " + quoted(d.space) + " " + valueText(d.value);
    return " = " + (d.value.numbers.empty() && d.value.strings.empty() ? "{}" : valueText(d.value));
}

std::tuple<int, int, int> positionOf(const rsl::Place& p) { return {p.file, p.line, p.column}; }

} // namespace

ShaderDescription describe(rsl::ShaderCompiler& compiler, const std::shared_ptr<const rsl::CompiledShader>& shader,
                           Diagnostics& diagnostics) {
    ShaderDescription d;
    const rsl::Shader& s = shader->shader();
    d.name = shader->name();
    d.file = shader->path();
    d.object = s.object;
    d.annotations = s.annotations;
    d.plugins = shader->program().plugins;
    d.structs = rsl::summaries(shader->program());
    const rsl::Program& program = shader->program();
    // What the compiler's library adds stands in a file of its own, "<sampledlight>": users neither set nor call it.
    const auto added = [&](const rsl::Place& place) {
        return place.file >= 0 && size_t(place.file) < program.files.size() && program.files[size_t(place.file)].starts_with("<");
    };
    auto values = compiler.parameterValues(shader, diagnostics);
    const std::set<std::string> computed = computedDefaults(*shader);
    for (size_t i = 0; i < std::min(shader->parameters().size(), s.parameters.size()); ++i) {
        const rsl::ParameterInfo& info = shader->parameters()[i];
        if (added(s.parameters[i].symbol->place)) continue;
        ParameterDescription p;
        p.name = info.name;
        p.type = typeText(info.type, s.parameters[i].symbol);
        p.storage = storageText(info.storage);
        p.output = info.output;
        p.open = info.open;
        p.array = info.type.array;
        if (i < values.size())
            p.byDefault = describeDefault(s.parameters[i], info, std::move(values[i]), computed.count(info.name) > 0);
        if (p.name == rsl::kCategory && p.byDefault.there)
            for (const std::string& list : p.byDefault.value.strings)
                for (size_t at = 0; at < list.size();) {
                    const size_t end = std::min(list.find_first_of(", ", at), list.size());
                    if (end > at) d.categories.push_back(list.substr(at, end - at));
                    at = end + 1;
                }
        d.parameters.push_back(std::move(p));
    }
    std::map<std::tuple<int, int, int>, std::string> signatures; // of methods, as they are written
    rsl::front::everyFunction(rsl::asWritten(program), [&](const rsl::Function& f) {
        signatures.emplace(positionOf(f.place), signatureOf(f, rsl::asWritten(program)));
    });
    std::set<std::tuple<int, int, int>> methods;
    std::set<std::string> members;
    for (const auto& other : shader->program().shaders) {
        if (other.get() != &s && !(s.object && other->object && other->name == s.name)) continue;
        const auto variant = other.get() == &s ? shader : rsl::ShaderCompiler::variant(shader, other->kind);
        if (variant) d.kinds.push_back(describeKind(compiler, *variant, diagnostics));
        for (const auto& f : other->nested)
            if (!added(f->place) && methods.insert(positionOf(f->place)).second) {
                std::string text = signatures[positionOf(f->place)], name = f->name;
                if (name == rsl::kReplacedLight) {
                    text.replace(text.find(name), name.size(), "light");
                    name = "light";
                }
                d.methods.push_back({text, name, other->publics.count(name) > 0, s.object && isEntry(name)});
            }
        if (!s.object || !other->body) continue;
        for (const auto& b : other->body->body)
            for (const auto& v : b->declarators)
                if (v.symbol && !added(v.symbol->place) && v.symbol->name[0] != '(' &&
                    v.symbol->type.base != shadeops::Base::Void && members.insert(v.symbol->name).second)
                    d.members.push_back({typeText(v.symbol->type, v.symbol), v.symbol->name, storageText(v.symbol->storage),
                                         other->publics.count(v.symbol->name.substr(0, v.symbol->name.find("->"))) > 0,
                                         v.symbol->isConstant});
    }
    return d;
}

nlohmann::ordered_json descriptionJson(const ShaderDescription& d) {
    OrderedJson j;
    j["name"] = d.name;
    j["type"] = d.kinds.empty() ? "" : d.kinds[0].kind;
    j["types"] = OrderedJson::array();
    for (const auto& k : d.kinds) j["types"].push_back(k.kind);
    j["file"] = d.file;
    j["parameters"] = OrderedJson::array();
    for (const ParameterDescription& p : d.parameters) {
        OrderedJson q = {{"name", p.name}, {"type", p.type}, {"storage", p.storage}, {"output", p.output}};
        if (p.array != 0) q["arraySize"] = p.array;
        if (p.open) q["open"] = true;
        const DefaultDescription& v = p.byDefault;
        if (!v.space.empty()) q["space"] = v.space;
        if (v.there && !v.computed) {
            if (v.null) q["default"] = nullptr;
            else if (v.value.type.base == shadeops::Base::String) q["default"] = v.value.strings;
            else q["default"] = v.value.numbers;
        }
        if (v.there && v.computed) q["computed"] = true;
        if (!v.inSpace.empty()) q["defaultInSpace"] = v.inSpace;
        if (!v.written.empty()) q["written"] = v.written;
        j["parameters"].push_back(std::move(q));
    }
    j["methods"] = OrderedJson::array();
    j["publicMethods"] = OrderedJson::array();
    for (const auto& m : d.methods) {
        j["methods"].push_back(m.signature);
        if (m.isPublic) j["publicMethods"].push_back(m.name);
    }
    j["class"] = d.object;
    j["members"] = OrderedJson::array();
    for (const auto& m : d.members)
        j["members"].push_back(
            {{"name", m.name}, {"type", m.type}, {"storage", m.storage}, {"public", m.isPublic}, {"constant", m.constant}});
    if (!d.categories.empty()) j["categories"] = d.categories;
    for (const auto& s : d.structs) {
        OrderedJson members = OrderedJson::array();
        for (const auto& m : s.members) members.push_back({{"name", m.name}, {"type", m.type}});
        OrderedJson methods = OrderedJson::array();
        for (const auto& m : s.methods) methods.push_back(m.name);
        j["structs"].push_back({{"name", s.name}, {"members", std::move(members)}, {"methods", std::move(methods)}});
    }
    for (const auto& plugin : d.plugins)
        for (const shadeops::Shadeop& f : plugin->functions)
            for (const shadeops::Signature& s : f.signatures)
                j["plugins"][plugin->name].push_back({{"signature", s.text}, {"doc", f.doc}});
    std::map<std::string, size_t> times;
    for (const auto& [key, value] : d.annotations) {
        OrderedJson& a = j["annotations"][key];
        const size_t n = ++times[key];
        if (n == 1) a = value;
        else if (n == 2) a = OrderedJson::array({a, value});
        else a.push_back(value);
    }
    const auto facts = [](OrderedJson& to, const KindDescription& k) {
        if (!k.compiled) return;
        to["writes"] = k.writes;
        to["affine"] = k.affine;
        if (!k.affine) to["whyNot"] = k.whyNot;
        to["suspends"] = k.suspends;
        to["lightLoops"] = k.lightLoops;
        to["direct"] = k.direct;
        to["indirectApart"] = k.indirectApart;
        if (k.kind == "light") to["ambient"] = k.ambient;
    };
    if (!d.kinds.empty()) facts(j, d.kinds[0]);
    if (d.kinds.size() > 1)
        for (const auto& k : d.kinds) {
            OrderedJson one = {{"type", k.kind}};
            facts(one, k);
            j["kinds"].push_back(std::move(one));
        }
    return j;
}

std::string descriptionText(const ShaderDescription& d) {
    std::string t;
    for (const auto& k : d.kinds) t += (t.empty() ? "" : ", ") + k.kind;
    t += " \"" + d.name + "\"  (" + (d.object ? "class, " : "") + d.file + ")\n";
    for (const ParameterDescription& p : d.parameters)
        t += std::string("    ") + (p.output ? "output " : "") + p.storage + " " + p.type + " " + p.name + defaultText(p) + "\n";
    for (const auto& s : d.structs) {
        t += "struct " + s.name + " {";
        for (const auto& m : s.members) t += " " + m.type + " " + m.name + ";";
        t += " }\n";
        for (const auto& m : s.methods) t += "    method of " + s.name + ": " + m.name + "()\n";
    }
    for (const auto& m : d.members)
        t += "member: " + std::string(m.isPublic ? "public " : "") + (m.constant ? "constant " : m.storage + " ") + m.type + " " +
             m.name + "\n";
    for (const auto& m : d.methods)
        t += "method: " + std::string(m.isPublic ? "public " : "") + m.signature + (m.entry ? "  (run by the renderer)" : "") +
             "\n";
    if (!d.categories.empty()) {
        t += "categories:";
        for (const std::string& c : d.categories) t += " " + c;
        t += "\n";
    }
    for (const auto& plugin : d.plugins)
        for (const shadeops::Shadeop& f : plugin->functions)
            for (const shadeops::Signature& s : f.signatures)
                t += "plug-in \"" + plugin->name + "\": " + s.text + (f.doc.empty() ? "" : "  " + f.doc) + "\n";
    for (const auto& [key, value] : d.annotations) t += "annotation " + key + ": " + value + "\n";
    for (const auto& k : d.kinds) {
        if (!k.compiled) continue;
        const std::string head = d.kinds.size() > 1 ? k.kind + " " : "";
        t += head + "writes:";
        for (const std::string& w : k.writes) t += " " + w;
        t += k.writes.empty() ? " nothing\n" : "\n";
        t +=
            head +
            (k.affine
                 ? "affine: yes; the light it gathers enters its result linearly, so path follows rays without running it again\n"
                 : "affine: no; " + k.whyNot + "\n");
        if (k.suspends) t += head + "suspends: it waits for its rays as a coroutine\n";
        if (k.ambient) t += head + "light: ambient, without illuminate() and solar()\n";
        for (const std::string& direct : k.direct) t += head + "direct light only under path: " + direct + "\n";
        if (k.indirectApart)
            t += head + "under path diffuse() and loops bring the light of lights, indirectdiffuse() that of surfaces\n";
    }
    return t;
}

} // namespace alpenglow::cli
