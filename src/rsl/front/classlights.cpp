// Which class lights of PRMan are given a light() of the library, and with what. A light that has generateSamples() says nothing
// of its light in light(): that is empty, sets zero, or is missing.
#include "base/limits.h"
#include "rsl/front/clone.h"
#include "rsl/front/library.h"
#include "rsl/front/nodes.h"
#include "rsl/front/visit.h"
#include <algorithm>

namespace alpenglow::rsl::front {

namespace {

bool isZero(const Expr& e) {
    switch (e.kind) {
    case ExprKind::Number:
        return e.number == 0;
    case ExprKind::Cast:
    case ExprKind::Unary:
    case ExprKind::Tuple:
        return std::ranges::all_of(e.args, [](const ExprPtr& a) { return isZero(*a); });
    default:
        return false;
    }
}

/// Whether a statement does nothing but set variables to zero: a light() of such statements only says that the class is a light.
bool setsZero(const Stmt& s) {
    switch (s.kind) {
    case StmtKind::Block:
        return std::ranges::all_of(s.body, [](const StmtPtr& b) { return !b || setsZero(*b); });
    case StmtKind::Declare:
        return !s.definition && std::ranges::all_of(s.declarators, [](const auto& d) { return !d.init || isZero(*d.init); });
    case StmtKind::Expression:
        return s.value->kind == ExprKind::Assign && s.value->op == ExprOp::Assign &&
               s.value->args[0]->kind == ExprKind::Variable && isZero(*s.value->args[1]);
    case StmtKind::Return:
        return !s.value;
    default:
        return false;
    }
}

bool calls(const Function& f, std::string_view name) {
    bool found = false;
    const auto call = [&](const Expr& e) { found |= e.kind == ExprKind::ShadeopCall && e.text == name; };
    if (f.body) everyExpr(*f.body, call);
    return found;
}

/// A method without a result that has so many parameters; null if the class has no such one.
Function* method(const ClassDefinition& c, std::string_view name, size_t parameters) {
    Function* f = methodOf(c, name);
    return f && f->result.base == Base::Void && f->parameters.size() == parameters ? f : nullptr;
}

/// Whether generateSamples() has a parameter of radiance samples.
bool takesSamples(const Function& f, const Unit& u) {
    return std::ranges::any_of(f.parameters, [&](const Symbol* p) {
        return isStruct(p->type) && u.structs[size_t(p->type.structure)].name == "__radiancesample";
    });
}

bool isEmit(const StmtPtr& s) {
    return s && s->kind == StmtKind::Expression && s->value->kind == ExprKind::ShadeopCall && s->value->text == "emit" &&
           !s->value->args.empty();
}

bool emits(const Stmt& s) {
    bool found = false;
    const auto below = [&](const Stmt& x) { eachBody(x, [&](const StmtPtr& b) { found |= isEmit(b); }); };
    everyStmt(s, below, [](const Expr&) {});
    return found;
}

/// Before each call of emit(), its first argument is added to __emitted.
void addEmission(Stmt& s) {
    eachBody(s, [](StmtPtr& b) {
        addEmission(*b);
        if (!isEmit(b)) return;
        const Place place = b->value->place;
        auto sum = node(ExprKind::Assign, place, ExprOp::Add);
        adopt(*sum, variable("__emitted", place));
        auto light = node(ExprKind::Cast, place);
        light->type.base = Base::Color;
        adopt(*light, clone(*b->value->args[0]));
        adopt(*sum, std::move(light));
        auto both = make(StmtKind::Block, place);
        both->body.push_back(run(std::move(sum)));
        both->body.push_back(std::move(b));
        b = std::move(both);
    });
}

/// A surface, or another kind of shader than a light.
bool isOtherKind(const ClassDefinition& c) {
    return std::ranges::any_of(c.shader->nested, [](const auto& f) {
        static constexpr std::string_view kOthers[] = {"surface",      "lighting", "diffuselighting", "specularlighting",
                                                       "displacement", "volume",   "imager",          "opacity"};
        return f->result.base == Base::Void && std::ranges::count(kOthers, f->name) > 0;
    });
}

void addLight(ClassDefinition& c, Unit& u, Library& library) {
    Function* light = methodOf(c, "light");
    if (light && light->result.base != Base::Void) light = nullptr;
    const Function* samples = method(c, "generateSamples", 2);
    if (samples && !takesSamples(*samples, u)) samples = nullptr;
    const bool photons = method(c, "generatePhoton", 4);
    const Function* prelighting = method(c, "prelighting", 2);
    if (!light && !samples) {
        if (!prelighting || !emits(*prelighting->body)) return;
        addEmission(*prelighting->body);
        return mixIn(c, library.classNamed("emittinglight", {}));
    }
    // Layers of materials have generateSamples(), too, but call its first parameter otherwise.
    const bool isLight = samples && (light ? setsZero(*light->body)
                                           : !isOtherKind(c) && std::ranges::count(samples->parameters, "integrationdomain",
                                                                                   [](const Symbol* p) { return p->name; }) > 0);
    if (!isLight) {
        if (!light || !photons) return;
        auto call = node(ExprKind::ShadeopCall, light->place);
        call->text = "__givePhoton";
        light->body->body.insert(light->body->body.begin(), run(std::move(call)));
        return mixIn(c, library.classNamed("photonlight", {}));
    }
    const Function* shadows = methodOf(c, "shadowSamples");
    const bool casts = shadows && calls(*shadows, "areashadow");
    Defines defines = {{"PLACES", std::to_string(limits::kLightIterations)}};
    if (photons) defines.emplace_back("PHOTONS", "");
    if (casts) defines.emplace_back("CASTS", "");
    if (shadows && !casts) defines.emplace_back("SHADOWED", "");
    if (light) {
        defines.emplace_back("ONLY", "");
        light->name = kReplacedLight;
        if (c.publics.count("light")) c.publics.insert(kReplacedLight);
    }
    mixIn(c, library.classNamed("sampledlight", defines));
}

} // namespace

void addLightMethods(Unit& u, Library& library) {
    for (size_t i = 0; i < u.classes.size(); ++i) { // the library reads into the same unit
        ClassDefinition c = std::move(u.classes[i]);
        addLight(c, u, library);
        u.classes[i] = std::move(c);
    }
}

} // namespace alpenglow::rsl::front
