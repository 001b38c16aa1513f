// Definitions of structures and of shader objects.
#include "base/limits.h"
#include "rsl/front/clone.h"
#include "rsl/front/parser.h"
#include <utility>

namespace alpenglow::rsl::front {

/// Behind the name of a structure: ": Other", the structure that it extends. Its members come first in the new one.
void Parser::extends(StructType& type) {
    if (!accept(":")) return;
    if (at("public") || at("private")) take();
    const auto base = peek().kind == Tok::Identifier ? structs_.find(std::string(peek().text)) : structs_.end();
    if (base == structs_.end()) failHere(msg::kExpectedName("a structure that is defined before this one", shown()));
    take();
    type.base = base->second;
    for (const StructMember& m : unit_.structs[size_t(type.base)].members) {
        type.members.push_back({m.name, m.type, m.storage, m.init ? clone(*m.init) : nullptr, m.place});
    }
}

/// Notes where a method begins, at "(", and goes on behind it: it is read once all members are known.
void Parser::skipMethod(size_t begin, std::vector<size_t>& methods) {
    methods.push_back(begin);
    take();
    skipBalanced();
    if (at("{")) skipBalanced();
    else expectSemicolon("the parameters of a method");
}

/// At a type: one member or several of that type, or a method.
void Parser::structureMember(StructType& type, std::vector<size_t>& methods) {
    takeAccess();
    const size_t begin = at_;
    const Specifiers s = specifiers();
    const auto call = [&](size_t name) { return peek(name).kind == Tok::Identifier && peek(name + 1).is("("); };
    if (call(0)) return skipMethod(begin, methods);
    if (at(type.name) && call(1)) {
        take();
        return skipMethod(begin, methods);
    }
    if (at(type.name) && !structs_.count(type.name) && peek(1).kind == Tok::Identifier) fail(peek().place, msg::kStructRecursive);
    if (!atTypeName()) failHere(msg::kExpectedMemberType(shown()));
    const Type base = takeType();
    if (call(0)) return skipMethod(begin, methods);
    if (at("[") && peek(1).is("]") && call(2)) {
        take(), take();
        return skipMethod(begin, methods);
    }
    if (base.base == Base::Void) fail(s.place, msg::kStructVoid);
    const ExprPtr space = declaredSpace(base);
    const Type group = dimensions(base);
    do {
        if (peek().kind != Tok::Identifier) failHere(msg::kExpectedName("a member", shown()));
        StructMember m;
        m.place = peek().place;
        m.name = std::string(take().text);
        m.type = dimensions(group);
        m.storage = s.storage;
        if (accept("=")) m.init = inSpace(at("{") ? arrayList() : assignment(), base, space.get());
        for (const StructMember& other : type.members)
            if (other.name == m.name) sources_.report(m.place, msg::kTwoMembers(m.name));
        type.members.push_back(std::move(m));
    } while (accept(","));
    if (!at("}")) expectSemicolon("a member");
}

/// The members, up to "}". Where methods begin goes to `methods`.
void Parser::structureBody(StructType& type, std::vector<size_t>& methods) {
    while (!accept("}")) {
        if (peek().kind == Tok::End) failHere(msg::kExpectedToken("'}' of structure '" + type.name + "'", shown()));
        const size_t before = at_;
        try {
            if (accept(";") || accept(",")) continue;
            structureMember(type, methods);
        } catch (const SyntaxError&) {
            if (tooDeep_) throw;
            recover();
            skippedFrom(before);
            if (at_ == before && !at("}")) take();
        }
    }
    accept(";");
}

/// Methods of the structure, by the places where they begin.
void Parser::structureMethods(size_t index, const std::vector<size_t>& methods) {
    const size_t behind = at_;
    const bool inObject = std::exchange(inObject_, false);
    for (const size_t begin : methods) {
        at_ = begin;
        try {
            specifiers();
            const bool typed = !(peek().kind == Tok::Identifier && peek(1).is("("));
            Type result{};
            if (typed) { result = dimensions(takeType()); }
            if (auto f = function(result, typed)) {
                unit_.structs[index].methods.push_back({f->name, f->place});
                unit_.methods[index].push_back(std::move(f));
            }
        } catch (const SyntaxError&) {
            if (tooDeep_) throw;
        }
    }
    inObject_ = inObject;
    at_ = behind;
}

/// At "struct": struct Name { members }; or struct Name : Other { members };
void Parser::structure() {
    const size_t begins = at_;
    take();
    if (peek().kind != Tok::Identifier) failHere(msg::kExpectedName("a structure", shown()));
    const Token& name = take();
    StructType type;
    extends(type);
    const size_t inherited = type.members.size();
    if (!at("{")) failHere(msg::kExpectedToken("'{' of structure '" + std::string(name.text) + "'", shown()));
    take();
    type.name = std::string(name.text);
    type.place = name.place;
    const int errors = sources_.errors();
    std::vector<size_t> methods;
    structureBody(type, methods);
    for (size_t i = begins; i < at_ && sources_.errors() == errors; ++i) {
        type.text += (*tokens_)[i].text;
        type.text += ' ';
    }
    if (const auto old = structs_.find(type.name); old != structs_.end() && !type.text.empty()) // two files brought the same one
        if (unit_.structs[size_t(old->second)].text == type.text) return;
    const bool empty = type.members.size() == inherited && type.base < 0 && methods.empty();
    if (empty && sources_.errors() == errors) sources_.report(type.place, msg::kStructEmpty(type.name));
    if (unit_.structs.size() >= size_t(limits::kStructs)) {
        sources_.report(type.place, msg::kStructCount(limits::kStructs));
        unit_.incomplete = true;
        return;
    }
    if (const auto old = structs_.find(type.name); old != structs_.end())
        sources_.report(type.place, msg::kStructRedefined(type.name));
    const size_t index = unit_.structs.size();
    structs_[type.name] = int(index);
    unit_.structs.push_back(std::move(type));
    unit_.methods.emplace_back();
    structureMethods(index, methods);
}

/// "public" and "private" of members: what is public is what others see, and the rest they do not; nothing else depends on it
/// here.
void Parser::takeAccess() {
    if ((at("public") || at("private")) && peek(1).kind == Tok::Identifier) take();
}

/// At "class": class name(parameters) { members; methods }
void Parser::shaderObject() {
    take();
    ClassDefinition c;
    c.shader = std::make_unique<Shader>();
    Shader& s = *c.shader;
    s.place = peek().place;
    s.name = std::string(take().text);
    owner_ = {&s.symbols, &s.nested};
    if (accept("(")) parameters(owner_, &s.parameters, nullptr);
    if (!at("{")) failHere(msg::kExpectedToken("'{' of class '" + s.name + "'", shown()));
    s.body = make(StmtKind::Block, take().place);
    std::vector<StmtPtr> methods;
    inObject_ = true;
    while (!accept("}")) {
        if (peek().kind == Tok::End) {
            sources_.report(peek().place, msg::kExpectedBrace, "the class began at line " + std::to_string(s.place.line));
            unit_.incomplete = true;
            break;
        }
        const size_t before = at_;
        try {
            if (accept(";")) continue;
            if (at("struct") && peek(1).kind == Tok::Identifier && peek(2).is("{")) {
                structure();
                continue;
            }
            if (at("private")) takeAccess();
            const bool isPublic = at("public");
            StmtPtr member;
            if (isPublic ? peek(2).is("(") && peek(1).kind == Tok::Identifier
                         : peek().kind == Tok::Identifier && peek(1).is("(")) {
                // A method without a type: void, or what it returns.
                accept("public");
                member = make(StmtKind::Declare, peek().place);
                auto f = function({}, false);
                if (!f) continue;
                member->definition = f.get();
                s.nested.push_back(std::move(f));
            } else {
                const bool starts = atTypeName() || at("public") || at("uniform") || at("varying") || at("constant") ||
                                    at("const") || at("output") || at("extern");
                if (!starts) failHere(msg::kExpectedToken("a member or a method of class '" + s.name + "'", shown()));
                member = declaration(true);
            }
            if (!member) continue;
            if (isPublic && member->definition) c.publics.insert(member->definition->name);
            if (isPublic)
                for (const auto& d : member->declarators) c.publics.insert(d.symbol->name);
            (member->definition ? methods : s.body->body).push_back(std::move(member));
        } catch (const SyntaxError&) {
            if (tooDeep_) throw;
            recover();
            skippedFrom(before);
            if (at_ == before && !at("}")) take();
        }
    }
    accept(";");
    // Methods follow all members, which they may use before the text declares them.
    for (auto& m : methods) s.body->body.push_back(std::move(m));
    owner_ = {};
    inObject_ = false;
    takeAnnotations(s);
    unit_.classes.push_back(std::move(c));
}

} // namespace alpenglow::rsl::front
