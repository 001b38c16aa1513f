#include "rsl/front/checker.h"
#include "base/limits.h"
#include "rsl/front/clone.h"
#include "rsl/front/protocol.h"
#include <algorithm>
#include <utility>

namespace alpenglow::rsl::front {

void Checker::run() {
    for (const auto& f : main_.functions)
        if (f->name.find("->") != f->name.npos) methods_.emplace(f->name, f.get());
    for (auto& s : main_.shaders) checkShader(*s);
    // Callers usually follow what they call. Going backwards checks the helpers of an uncalled function once.
    for (size_t i = main_.functions.size(); i-- > 0;) {
        Function& f = *main_.functions[i];
        // A header's functions that are not called cannot do harm; those of the main file are checked on their own.
        if (used_.count(&f) || (f.place.file != 0 && sources_.name(f.place.file) != sources_.name(0))) continue;
        checkStandalone(f);
    }
    program_.shaders = std::move(main_.shaders);
}

void Checker::checkShader(Shader& s) {
    shader_ = &s;
    kind_ = s.kind;
    globalOwner_ = &s.symbols;
    globals_.clear();
    shaderParameters_.clear();
    instances_.clear();
    unit_ = &main_;
    function_ = nullptr;
    scopes_.assign(1, {});
    for (auto& p : s.parameters) {
        Symbol& symbol = *p.symbol;
        if (isStruct(symbol.type)) isPossible(symbol);
        if (symbol.storage == Storage::Unspecified && !isStruct(symbol.type)) symbol.storage = Storage::Uniform;
        if (!p.defaultValue && isStruct(symbol.type) && !symbol.type.array) p.defaultValue = defaultOf(symbol.type, symbol.place);
        if (p.defaultValue) initialise(symbol, p.defaultValue); // earlier parameters are visible
        if (!shaderParameters_.emplace(symbol.name, &symbol).second)
            sources_.report(symbol.place, msg::kTwoParameters(symbol.name));
        scopes_[0].names[symbol.name] = &symbol;
    }
    check(s.body);
    shader_ = nullptr;
    scopes_.clear();
}

void Checker::checkStandalone(Function& f) {
    shader_ = nullptr;
    kind_.reset();
    std::vector<std::unique_ptr<Symbol>> owned;
    globalOwner_ = &owned;
    globals_.clear();
    shaderParameters_.clear();
    instances_.clear();
    scopes_.clear();
    const size_t before = program_.functions.size();
    const int excused = sources_.excused;
    sources_.unused = !main_.shaders.empty();
    Function* checked = instance(f, main_, {}, f.place);
    sources_.unused = false;
    for (auto& s : owned) checked->symbols.push_back(std::move(s));
    globalOwner_ = nullptr;
    if (sources_.excused > excused) program_.functions.resize(before); // what is wrong is not handed on
}

/// The copy of a function that belongs to the current shader, made and checked when first called. Null inside itself: recursion.
Function* Checker::instance(Function& f, const Unit& unit, const std::pair<std::string, std::string>& rename, Place call) {
    used_.insert(&f);
    const auto key = std::make_pair(static_cast<const Function*>(&f), rename.second);
    if (const auto found = instances_.find(key); found != instances_.end()) return found->second;
    if (checking_.count(&f) || instanceDepth_ >= limits::kCallDepth) {
        sources_.report(call, checking_.count(&f) ? msg::kRecursion(f.name) : msg::kCallsTooDeep(limits::kCallDepth));
        return nullptr;
    }
    checking_.insert(&f);
    ++instanceDepth_;
    auto copy = clone(f, rename);
    Function* raw = copy.get();
    auto scopes = std::move(scopes_);
    auto infos = std::move(infos_);
    scopes_.clear();
    infos_.clear();
    const Unit* outerUnit = std::exchange(unit_, &unit);
    checkBody(*raw);
    unit_ = outerUnit;
    scopes_ = std::move(scopes);
    infos_ = std::move(infos);
    --instanceDepth_;
    checking_.erase(&f);
    instances_[key] = raw;
    if (sources_.unused) uncalled_.insert(raw);
    program_.functions.push_back(std::move(copy));
    return raw;
}

/// Parameters and body, inside the scopes that are open now.
void Checker::checkBody(Function& f) {
    Function* outer = std::exchange(function_, &f);
    const int loops = std::exchange(loops_, 0);
    scopes_.emplace_back();
    for (Symbol*& p : f.parameters) {
        if (isStruct(p->type)) isPossible(*p);
        if (p->storage == Storage::Unspecified && !isStruct(p->type)) {
            p->storage = isStringLike(p->type.base) ? Storage::Uniform : Storage::Varying;
            if (p->storage == Storage::Varying) unclassed_.insert(p);
        }
        if (p->name == "," || p->name == ")" || p->name == ";") continue; // it has no name
        const size_t n = size_t(&p - f.parameters.data());
        if (n < f.defaults.size() && f.defaults[n]) { // earlier parameters are visible
            const int length = p->type.array;
            initialise(*p, f.defaults[n]);
            p->type.array = length;
        }
        if (!scopes_.back().names.emplace(p->name, p).second) sources_.report(p->place, msg::kTwoParameters(p->name));
    }
    check(f.body);
    scopes_.pop_back();
    if (f.result.base != Base::Void && !endsInReturn(*f.body)) sources_.report(f.place, msg::kReturnMissing(f.name));
    if (varyingFunctions_.count(&f) && outer) varyingFunctions_.insert(outer);
    function_ = outer;
    loops_ = loops;
}

const Unit& Checker::rslUnit(const Shadeop& op) {
    auto& unit = rslUnits_[&op];
    if (!unit) {
        const int file = sources_.add("<" + op.name + ">", op.rsl);
        const Preprocessed text = preprocess(sources_, file, {});
        Parser parser(sources_);
        parser.read(text);
        unit = std::make_unique<Unit>(std::move(parser.unit()));
    }
    return *unit;
}

Symbol* Checker::lookup(const std::string& name) {
    for (size_t i = scopes_.size(); i-- > 0;)
        if (const auto s = scopes_[i].names.find(name); s != scopes_[i].names.end()) return s->second;
    return global(name);
}

/// A predefined variable of the shader, as a symbol of it.
Symbol* Checker::global(const std::string& name) {
    if (const auto g = globals_.find(name); g != globals_.end()) return g->second;
    const auto find = [&](ShaderKind kind) -> Symbol* {
        for (const GlobalVariable& g : globalVariables(kind)) {
            if (name != g.name) continue;
            auto s = std::make_unique<Symbol>();
            s->name = name;
            s->type = g.type;
            s->storage = g.uniform ? Storage::Uniform : Storage::Varying;
            s->origin = Symbol::Origin::Global;
            s->writable = g.writable || !kind_;
            globalOwner_->push_back(std::move(s));
            return globals_[name] = globalOwner_->back().get();
        }
        return nullptr;
    };
    if (kind_) {
        if (Symbol* s = find(*kind_)) return s;
        // emit() in a class: Cs and Os are those of the primitive that emits the light.
        const bool emits = *kind_ == ShaderKind::Light && shaderParameters_.contains(kEmits);
        return emits && (name == "Cs" || name == "Os") ? find(ShaderKind::Surface) : nullptr;
    }
    for (int k = 0; k < 6; ++k)
        if (Symbol* s = find(ShaderKind(k))) return s;
    return nullptr;
}

/// `extern T x;`: x is the variable of that name further out.
void Checker::bindExtern(Symbol& declared) {
    Symbol* outer = lookup(declared.name);
    if (!outer)
        if (const auto p = shaderParameters_.find(declared.name); p != shaderParameters_.end()) outer = p->second;
    if (!outer && shader_ && shader_->object && shader_->body) // a member of the class: functions outside of it see it so
        for (const StmtPtr& s : shader_->body->body)
            for (const Stmt::Declarator& d : s->declarators)
                if (d.symbol->name == declared.name && !d.symbol->isExtern) outer = d.symbol;
    if (!outer && (declared.name == "Ps" || declared.name == "Ns" || declared.name == "Ngs"))
        outer = global(declared.name == "Ngs" ? "Ng" : declared.name.substr(0, 1)); // functions for all kinds
    if (!outer && !kind_) {
        // In a function that is not called it may be a parameter of a later shader.
        auto s = std::make_unique<Symbol>(declared);
        s->isExtern = false;
        s->origin = Symbol::Origin::ShaderParameter;
        s->output = true;
        if (s->storage == Storage::Unspecified && !isStruct(s->type)) s->storage = Storage::Uniform;
        globalOwner_->push_back(std::move(s));
        outer = globalOwner_->back().get();
    }
    if (!outer) {
        std::string near = nearestName(declared.name, visibleNames());
        sources_.report(declared.place,
                        kind_ ? msg::kNoSuchExternIn(declared.name, toString(*kind_)) : msg::kNoSuchExtern(declared.name),
                        near.empty() ? "" : "did you mean '" + near + "'?");
        declared.type = {Base::Void, 0}; // poison
        outer = &declared;
    } else if (outer->type.base != Base::Void) {
        Type a = outer->type, b = declared.type;
        // Old shaders type everything point.
        const bool same = ((a.base == b.base && a.structure == b.structure) || (a.isPointLike() && b.isPointLike())) &&
                          (a.array == b.array || b.array == -1);
        if (!same) sources_.report(declared.place, msg::kExternType(declared.name, structures_.text(a), structures_.text(b)));
    }
    scopes_.back().names[declared.name] = outer;
}

void Checker::declareLocal(Symbol& s) {
    if (s.storage == Storage::Unspecified && !isStruct(s.type))
        s.storage = isStringLike(s.type.base) ? Storage::Uniform : Storage::Varying;
    auto [at, fresh] = scopes_.back().names.emplace(s.name, &s);
    if (fresh) return;
    if (at->second->type != s.type && at->second->type.base != Base::Void && s.type.base != Base::Void)
        sources_.report(s.place, msg::kRedeclared(s.name, structures_.text(at->second->type)));
    else sources_.report(s.place, msg::kRedeclaredNew(s.name));
    at->second = &s;
}

std::vector<std::string> Checker::visibleNames() {
    std::vector<std::string> names = {"PI"};
    for (const auto& s : scopes_)
        for (const auto& [name, symbol] : s.names)
            if (symbol->type.base != Base::Void) names.push_back(name); // otherwise it has been reported as unknown
    for (const auto& [name, symbol] : shaderParameters_) names.push_back(name);
    for (const GlobalVariable& g : globalVariables(kind_.value_or(ShaderKind::Surface))) names.push_back(g.name);
    std::sort(names.begin(), names.end()); // nothing may depend on the order in a hash table
    return names;
}

/// What old shaders use without saying so: a parameter of the shader without `extern` (PRMan takes it), and what the
/// specification gives to other kinds of shaders but has a meaning here too. Null when it is nothing of that.
Symbol* Checker::tolerated(Expr& e) {
    if (const auto p = shaderParameters_.find(e.text); p != shaderParameters_.end() && p->second->type.base != Base::Void) {
        sources_.report(e.place, msg::kMissingExtern(e.text),
                        "declare 'extern " + structures_.text(p->second->type) + " " + e.text + ";'");
        return p->second;
    }
    const bool onSurface = kind_ && (*kind_ == ShaderKind::Surface || *kind_ == ShaderKind::Displacement);
    if (onSurface && (e.text == "Ns" || e.text == "Ps")) {
        const std::string own = e.text.substr(0, 1);
        const auto isLight = [](const auto& f) {
            return f->name == "light";
        }; // a class that is a light, too: its methods speak so
        if (std::any_of(shader_->nested.begin(), shader_->nested.end(), isLight)) return global(own);
        sources_.report(e.place, msg::kLightVariable(e.text, own));
        return global(own);
    }
    return nullptr;
}

void Checker::unknownVariable(Expr& e) {
    if (!unit_->hides(e.text)) {
        std::string hint;
        if (const std::string near = nearestName(e.text, visibleNames()); !near.empty()) {
            hint = "did you mean '" + near + "'?";
        }
        bool elsewhere = false; // a variable of other kinds of shaders
        for (int k = 0; k < 6 && kind_; ++k)
            for (const auto& g : globalVariables(ShaderKind(k))) elsewhere |= e.text == g.name;
        sources_.report(e.place, elsewhere ? msg::kUndeclaredIn(e.text, toString(*kind_)) : msg::kUndeclared(e.text), hint);
    }
    // From now on the name is known as wrong, and silent.
    auto s = std::make_unique<Symbol>();
    s->name = e.text;
    s->place = e.place;
    globalOwner_->push_back(std::move(s));
    if (!scopes_.empty()) scopes_[0].names[e.text] = globalOwner_->back().get();
}

} // namespace alpenglow::rsl::front
