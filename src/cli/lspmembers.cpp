// What a name means by itself, and what stands behind "->" and ".": of shader objects, structures and handles.
#include "cli/lspdocument.h"
#include "rsl/front/inspect.h"
#include "rsl/front/visit.h"
#include <algorithm>
#include <cctype>
#include <set>

namespace alpenglow::cli {

namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The variable of this name that was declared last before a place; of those behind it the first.
const rsl::Symbol* nearest(const std::vector<std::unique_ptr<rsl::Symbol>>& symbols, const std::string& name, int line,
                           int column) {
    const rsl::Symbol* best = nullptr;
    for (const auto& s : symbols) {
        if (s->name != name || s->origin == rsl::Symbol::Origin::Global) continue;
        const bool before = s->place.line < line || (s->place.line == line && s->place.column <= column);
        if (!best || before) best = s.get();
    }
    return best;
}

} // namespace

Document::Use Document::named(size_t word) const {
    Use use;
    const auto end = wordAt(word);
    if (!program_ || !end) return use;
    const std::string name = text_.substr(word, end->second - word);
    const int line = int(lineOf(word)) + 1, column = int(word - startOf(lineOf(word))) + 1;
    size_t next = end->second;
    while (next < text_.size() && isBlank(text_[next])) ++next;
    const bool call = next < text_.size() && text_[next] == '(';
    if (!call) {
        const Around a = around(word);
        if (a.function) use.symbol = nearest(a.function->symbols, name, line, column);
        if (!use.symbol && a.shader) use.symbol = nearest(a.shader->symbols, name, line, column);
        // Outside of all that was understood: the only shader or function that has it.
        if (!use.symbol && !a.shader && !a.function) {
            for (const auto& s : program_->shaders)
                if (isHere(s->place) && !use.symbol) use.symbol = nearest(s->symbols, name, line, column);
            rsl::front::everyFunction(*program_, [&](const rsl::Function& f) {
                if (isHere(f.place) && !use.symbol) use.symbol = nearest(f.symbols, name, line, column);
            });
        }
        if (use.symbol) return use;
    }
    for (const auto& s : program_->shaders)
        if (s->name == name && isHere(s->place)) use.shader = s.get();
    return use;
}

std::optional<Document::Receiver> Document::receiver(size_t word) const {
    Receiver r;
    std::string chain;
    size_t at = word;
    for (bool first = true;; first = false) {
        size_t end = at;
        while (end > 0 && isBlank(text_[end - 1])) --end;
        const bool arrow = end >= 2 && text_[end - 1] == '>' && text_[end - 2] == '-', dot = end >= 1 && text_[end - 1] == '.';
        if (!arrow && !dot) break;
        end -= arrow ? 2 : 1;
        while (end > 0 && isBlank(text_[end - 1])) --end;
        for (int depth = 0; end > 0 && (depth > 0 || text_[end - 1] == ']'); --end) { // ray[3]
            depth += text_[end - 1] == ']';
            depth -= text_[end - 1] == '[';
            if (depth == 0) {
                --end;
                break;
            }
        }
        size_t begin = end;
        while (begin > 0 && isWord(text_[begin - 1])) --begin;
        if (begin == end || std::isdigit(static_cast<unsigned char>(text_[begin]))) return std::nullopt;
        if (first) r.arrow = arrow;
        chain = text_.substr(begin, end - begin) + (chain.empty() ? "" : "->" + chain);
        at = begin;
    }
    if (chain.empty()) return std::nullopt;
    r.name = chain;
    return r;
}

const rsl::StructType* Document::structure(const std::string& name) const {
    if (program_)
        for (const auto& s : program_->structs)
            if (s.name == name) return &s;
    return nullptr;
}

const rsl::StructType* Document::structureOf(const rsl::Symbol& variable, const std::string& chain) const {
    const auto numbered = [&](int n) {
        return n >= 0 && size_t(n) < program_->structs.size() ? &program_->structs[size_t(n)] : nullptr;
    };
    const rsl::StructType* s = numbered(variable.type.structure);
    for (size_t at = 0; s && at < chain.size();) {
        const size_t begin = at + 2, end = std::min(chain.find("->", begin), chain.size());
        const auto m = std::ranges::find(s->members, chain.substr(begin, end - begin), &rsl::StructMember::name);
        s = m == s->members.end() ? nullptr : numbered(m->type.structure);
        at = end;
    }
    return s;
}

std::vector<Document::Member> Document::members(const Receiver& r, size_t position) const {
    std::vector<Member> list;
    if (!program_) return list;
    std::set<std::string> seen;
    const auto add = [&](Member m) {
        if (!m.name.empty() && m.name[0] != '(' && seen.insert(m.name).second) list.push_back(std::move(m));
    };
    const auto ofClass = [&](const rsl::Shader& s, bool everything) {
        for (const auto& f : s.nested)
            if (everything || s.publics.count(f->name)) add({f->name, signatureOf(*f, *program_), s.name, f->place, true});
        for (const auto& v : s.symbols) {
            const bool parameter = v->origin == rsl::Symbol::Origin::ShaderParameter;
            if (v->origin == rsl::Symbol::Origin::Global) continue;
            if (parameter || s.publics.count(v->name)) add({v->name, declarationOf(*v, *program_), s.name, v->place, false});
        }
        if (!everything || !s.body) return;
        for (const auto& b : s.body->body)
            for (const auto& d : b->declarators)
                if (d.symbol) add({d.symbol->name, declarationOf(*d.symbol, *program_), s.name, d.symbol->place, false});
    };
    const Around a = around(position);
    if (r.name == "this") {
        for (const auto& s : program_->shaders)
            if (s->object && (a.shader ? s->name == a.shader->name : isHere(s->place))) ofClass(*s, true);
        return list;
    }
    const size_t variableEnd = std::min(r.name.find("->"), r.name.size());
    const std::string variable = r.name.substr(0, variableEnd);
    bool handle = false;
    const rsl::StructType* type = nullptr;
    const auto look = [&](const std::vector<std::unique_ptr<rsl::Symbol>>& symbols) {
        for (const auto& s : symbols) {
            handle |= s->type.base == shadeops::Base::Shader && s->name == r.name;
            if (!type && s->name == variable) type = structureOf(*s, r.name.substr(variableEnd));
        }
    };
    if (a.function) look(a.function->symbols);
    if (a.shader) look(a.shader->symbols);
    if (!a.shader && !a.function) {
        for (const auto& s : program_->shaders) look(s->symbols);
        for (const auto& f : program_->functions) look(f->symbols);
    }
    // As the structure declares them, with its methods.
    if (type) {
        for (const auto& m : rsl::summary(*type, *program_).members)
            add({m.name, m.type + " " + m.name, type->name, m.place, false});
        for (const auto& m : type->methods) add({m.name, m.name + "()", type->name, m.place, true});
    }
    // Which shader stands behind a handle, a scene decides: the classes of this text are offered.
    if (handle && r.arrow)
        for (const auto& s : program_->shaders)
            if (s->object) ofClass(*s, false);
    return list;
}

} // namespace alpenglow::cli
