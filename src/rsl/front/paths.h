// Which variable, or which members of one, an expression of the checked tree names: x, x[1], s, s->a, s[2]->inner.
#pragma once
#include "rsl/front/structures.h"
#include <map>
#include <optional>

namespace alpenglow::rsl::front {

/// A variable, or members of one. Elements of an array are not distinguished.
struct Path {
    const Symbol* symbol = nullptr; ///< null: no variable
    Place place;                    ///< of the variable's name
    Type type;                      ///< as declared, without the elements that are chosen
    size_t first = 0;               ///< the first plain member, by its number among members() of the variable
    size_t count = 1;               ///< plain members; of a structure given for one that it extends, those of the latter
    size_t named = 1;               ///< plain members of what the text names, at least `count`
    std::string name;               ///< as the shader writes it, without indices: "s->inner"
    bool whole = true;              ///< no index chooses an element
};

/// Finds paths by the types of variables alone: expressions around them may have errors and no types.
class Paths {
public:
    /// p: has the structures; outlives this.
    explicit Paths(const Program& p) : structures_(p.structs) {}
    /// The path that the expression is; nothing for other expressions, and for members that are not there.
    std::optional<Path> of(const Expr&) const;
    /// The plain members of a variable of a structure or of an array of them, in order; none for other types.
    const std::vector<Leaf>& members(Type) const;
    /// "s->inner->x", the plain member of that number; the variable's name if it is no structure.
    std::string memberName(const Symbol&, size_t member) const;
    /// The type of a plain member.
    Type memberType(const Symbol&, size_t member) const;
    /// Uniform or varying, as docs/language.md says of members: as the variable is declared, else the member, else by default.
    Storage memberStorage(const Symbol&, size_t member) const;
    /// Of the program.
    const Structures& structures() const { return structures_; }

private:
    const Structures structures_;
    mutable std::map<std::pair<int, int>, std::vector<Leaf>> members_; ///< a cache, by structure and length
};

} // namespace alpenglow::rsl::front
