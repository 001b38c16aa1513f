// Calls of directlighting(this, ...) and indirectspecular(this, ...) in the methods of a class (PRMan) become calls of methods of
// the library, which the class is given. A call has token/value pairs and a method has none: each token is the name of a
// parameter.
#include "base/limits.h"
#include "rsl/front/clone.h"
#include "rsl/front/library.h"
#include "rsl/front/nodes.h"
#include "rsl/front/sentlights.h"
#include "rsl/front/visit.h"
#include <algorithm>
#include <map>

namespace alpenglow::rsl::front {

namespace {

enum class Part { None = -1, All, Diffuse, Specular };

/// Which part of the light a call in this method asks for.
Part partOf(std::string_view name, std::string_view method) {
    if (name == "diffuselighting") return Part::Diffuse;
    if (name == "specularlighting") return Part::Specular;
    if (name != "directlighting") return Part::None;
    return method == "diffuselighting" ? Part::Diffuse : method == "specularlighting" ? Part::Specular : Part::All;
}

bool isText(const Expr& e) { return e.kind == ExprKind::String && !e.handle; }

/// Whether a call can store a value there.
bool isPlace(const Expr& e) {
    return e.kind == ExprKind::Variable || ((e.kind == ExprKind::Index || e.kind == ExprKind::Member) && isPlace(*e.args[0]));
}

/// The value behind a token of a call; null if it is not given.
ExprPtr* valueOf(Expr& call, std::string_view token) {
    for (size_t i = 1; i + 1 < call.args.size(); ++i)
        if (isText(*call.args[i]) && call.args[i]->text == token) return &call.args[i + 1];
    return nullptr;
}

ExprPtr numberAt(double value, Place place) {
    auto e = node(ExprKind::Number, place);
    e->number = value;
    return e;
}

void moveTo(Expr& e, Place place) {
    e.place = place;
    eachSlot(e, [&](ExprPtr& x) { moveTo(*x, place); });
}

/// Makes a call with tokens the call of a method. Each parameter is what `given` has, else the value behind the token of its
/// name, else its default, else, of an output, the member "__NAME".
void callMethod(Expr& e, const Function& method, std::map<std::string_view, ExprPtr> given, SourceSet& sources) {
    std::vector<ExprPtr> arguments;
    for (size_t i = 0; i < method.parameters.size(); ++i) {
        const std::string& name = method.parameters[i]->name;
        const ExprPtr* value = valueOf(e, name);
        if (value && method.parameters[i]->output && !isPlace(**value)) {
            sources.report((*value)->place, msg::kOutputPairValue(name));
            value = nullptr;
        }
        if (const auto g = given.find(name); g != given.end()) arguments.push_back(std::move(g->second));
        else if (value) arguments.push_back(clone(**value));
        else if (i < method.defaults.size() && method.defaults[i]) {
            arguments.push_back(clone(*method.defaults[i]));
            moveTo(*arguments.back(), e.place);
        } else arguments.push_back(variable("__" + name, e.place));
    }
    e.text = method.name;
    e.args.clear();
    for (ExprPtr& a : arguments) adopt(e, std::move(a));
}

class Calls {
public:
    Calls(ClassDefinition& c, Library& l, SourceSet& s) : class_(c), library_(l), sources_(s) {}

    void run() {
        for (StmtPtr& s : class_.shader->body->body) {
            method_ = s->definition ? s->definition->name : "";
            statement(*s);
        }
        // The library's texts join the class when its own statements have been read.
        for (ClassDefinition& part : parts_) mixIn(class_, std::move(part));
    }

private:
    void statement(Stmt& s) {
        eachSlot(s, [&](ExprPtr& e) { expression(*e); });
        eachBody(s, [&](StmtPtr& b) { statement(*b); });
        if (s.definition && s.definition->body) statement(*s.definition->body);
    }

    void expression(Expr& e) {
        eachSlot(e, [&](ExprPtr& x) { expression(*x); });
        const bool ofThis = e.kind == ExprKind::ShadeopCall && !e.args.empty() && e.args[0]->kind == ExprKind::String &&
                            e.args[0]->handle && e.args[0]->text == "(this)";
        if (!ofThis) return;
        if (const Part part = partOf(e.text, method_); part != Part::None) return direct(e, part);
        if (e.text != "indirectspecular") return;
        checkTokens(e, 1);
        if (const Function* m = libraryMethod("indirectspecular", "__indirect", {})) callMethod(e, *m, {}, sources_);
    }

    /// Tokens from argument `first` on. What stands there and is none, the shadeop would refuse in a call of another handle.
    void checkTokens(const Expr& e, size_t first) {
        const Shadeop* op = findShadeop(e.text);
        for (size_t i = first; op && i < e.args.size(); i += 2) {
            const Expr& token = *e.args[i];
            if (!isText(token) || token.text == "materialsamples") continue; // an array of structures, which stays as it is
            std::vector<std::string> names;
            for (const OptionalParameter& o : op->optional) names.push_back(o.name);
            if (std::ranges::count(names, token.text)) continue;
            const std::string near = nearestName(token.text, names);
            sources_.report(token.place, msg::kNoSuchParameter(e.text, token.text),
                            near.empty() ? "" : "did you mean \"" + near + "\"?");
        }
    }

    void direct(Expr& e, Part part) {
        const bool lights = e.args.size() > 1 && !isText(*e.args[1]);
        checkTokens(e, lights ? 2 : 1);
        Defines defines = {{"LOOP", "\"" + std::string(kSampleLoop) + "\""}};
        if (lights) defines.insert(defines.end(), {{"LIGHTS", ""}, {"HANDLES", std::to_string(limits::kLightHandles)}});
        const Function* m = libraryMethod("directlighting", lights ? "__directof" : "__direct", defines);
        if (!m) return;
        std::map<std::string_view, ExprPtr> given;
        given["part"] = numberAt(int(part), e.place);
        const ExprPtr* domain = valueOf(e, "integrationdomain");
        const bool sphere = domain && isText(**domain) && (*domain)->text.starts_with("spher");
        given["angle"] = variable("PI", e.place);
        if (!sphere) {
            auto half = node(ExprKind::Binary, e.place, ExprOp::Div);
            adopt(*half, std::move(given["angle"]));
            adopt(*half, numberAt(2, e.place));
            given["angle"] = std::move(half);
        }
        if (lights) given["lights"] = clone(*e.args[1]);
        callMethod(e, *m, std::move(given), sources_);
    }

    /// A method of a class of the library, which the class is given; null after too many errors.
    const Function* libraryMethod(const char* text, const std::string& name, const Defines& defines) {
        for (const ClassDefinition& p : parts_)
            if (const Function* m = methodOf(p, name)) return m;
        ClassDefinition part = library_.classNamed(text, defines);
        if (!part.shader) return nullptr;
        parts_.push_back(std::move(part));
        return methodOf(parts_.back(), name);
    }

    ClassDefinition& class_;
    Library& library_;
    SourceSet& sources_;
    std::string method_; ///< of the class, in which the statement stands; empty in members
    std::vector<ClassDefinition> parts_;
};

} // namespace

void addLightingMethods(Unit& u, Library& library, SourceSet& sources) {
    for (size_t i = 0; i < u.classes.size(); ++i) { // the library reads into the same unit
        ClassDefinition c = std::move(u.classes[i]);
        Calls(c, library, sources).run();
        u.classes[i] = std::move(c);
    }
}

} // namespace alpenglow::rsl::front
