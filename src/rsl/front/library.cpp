#include "rsl/front/library.h"
#include "rsl/front/borrowed.h"
#include <algorithm>
#include <iterator>

namespace alpenglow::rsl::front {

namespace {

struct Mentioned {
    bool named = false, defined = false;
};

/// How a text uses a name of the library. Variables may have the names of functions; these count only where they are
/// called.
Mentioned mentioned(const std::vector<Token>& t, const LibraryText& of) {
    Mentioned m;
    for (size_t i = 0; i < t.size(); ++i) {
        if (t[i].kind != Tok::Identifier || t[i].text != of.name) continue;
        const bool called = i + 1 < t.size() && t[i + 1].is("("); // or defined
        const size_t next = called ? behind(t, i + 1) : t.size();
        m.named |= called || of.kind == LibraryText::Kind::Structure;
        m.defined |= next < t.size() && t[next].is("{");
        m.defined |= i > 0 && (t[i - 1].is("struct") || t[i - 1].is("void"));
    }
    return m;
}

} // namespace

Preprocessed Library::preprocessed(const LibraryText& text, const Defines& defines) {
    FrontOptions options;
    options.defines = defines;
    return preprocess(sources_, sources_.add("<" + std::string(text.name) + ">", text.text), options);
}

void Library::readNamed(const std::vector<Token>& tokens) {
    for (const LibraryText& text : libraryTexts()) {
        if (text.kind == LibraryText::Kind::Class || read_.count(text.name)) continue;
        const Mentioned m = mentioned(tokens, text);
        if (m.defined) read_.insert(text.name);
        if (!m.named || !read_.insert(text.name).second) continue;
        const Preprocessed own = preprocessed(text, {});
        readNamed(own.tokens);
        parser_.read(own);
    }
}

ClassDefinition Library::classNamed(const std::string& name, const Defines& defines) {
    for (const LibraryText& text : libraryTexts()) {
        if (text.kind != LibraryText::Kind::Class || name != text.name) continue;
        const Preprocessed own = preprocessed(text, defines);
        readNamed(own.tokens);
        std::vector<ClassDefinition>& classes = parser_.unit().classes;
        const size_t before = classes.size();
        parser_.read(own);
        if (classes.size() == before) return {};
        ClassDefinition c = std::move(classes.back());
        classes.pop_back();
        return c;
    }
    return {};
}

Function* methodOf(const ClassDefinition& c, std::string_view name) {
    const auto found = std::ranges::find_if(c.shader->nested, [&](const auto& f) { return f->name == name; });
    return found == c.shader->nested.end() ? nullptr : found->get();
}

void mixIn(ClassDefinition& to, ClassDefinition from) {
    if (!from.shader) return;
    Shader &own = *to.shader, &added = *from.shader;
    std::set<std::string> has;
    for (const auto& p : own.parameters) has.insert(p.symbol->name);
    for (const auto& f : own.nested) has.insert(f->name);
    for (const auto& s : own.body->body)
        for (const auto& d : s->declarators) has.insert(d.symbol->name);
    const auto missing = [&](const std::string& name) { return !has.count(name); };

    std::erase_if(added.parameters, [&](const ShaderParameter& p) { return !missing(p.symbol->name); });
    own.parameters.insert(own.parameters.begin(), std::make_move_iterator(added.parameters.begin()),
                          std::make_move_iterator(added.parameters.end()));
    std::vector<StmtPtr> members, methods;
    for (StmtPtr& s : added.body->body) {
        std::erase_if(s->declarators, [&](const auto& d) { return !missing(d.symbol->name); });
        if (s->definition ? missing(s->definition->name) : !s->declarators.empty())
            (s->definition ? methods : members).push_back(std::move(s));
    }
    // members precede methods
    const auto insert = [&](auto at, std::vector<StmtPtr>& s) {
        own.body->body.insert(at, std::make_move_iterator(s.begin()), std::make_move_iterator(s.end()));
    };
    insert(std::ranges::find_if(own.body->body, [](const StmtPtr& s) { return s->definition; }), methods);
    insert(own.body->body.begin(), members);
    std::erase_if(added.nested, [&](const auto& f) { return !missing(f->name); });
    own.nested.insert(own.nested.begin(), std::make_move_iterator(added.nested.begin()),
                      std::make_move_iterator(added.nested.end()));
    for (auto& s : added.symbols) own.symbols.push_back(std::move(s));
    for (const std::string& p : from.publics)
        if (missing(p)) to.publics.insert(p);
}

} // namespace alpenglow::rsl::front
