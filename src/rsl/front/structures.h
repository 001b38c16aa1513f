// What there is to know about the structures of a program: their members, what extends what, and the plain members that one
// variable of a structure stands for.
#pragma once
#include "rsl/front/ast.h"
#include <string>
#include <vector>

namespace alpenglow::rsl::front {

/// One plain member of a structure, members of members included.
struct Leaf {
    std::string path; ///< "->origin", as the shader writes it behind the variable
    Type type;        ///< an array where a structure around it is one, of all elements of all structures
    Storage storage;  ///< its own, or else that of the nearest member around it
    const StructMember* member;
};

/// The structures of a program, which must outlive this. Types that are no structures have no members.
class Structures {
public:
    /// all: outlives this.
    explicit Structures(const std::vector<StructType>& all) : all_(all) {}
    /// The structure of a type; one without members for all other types.
    const StructType& of(Type) const;
    /// "structure 'S[3]'"; other types as toString() has them.
    std::string shown(Type) const;
    /// "S[3]"; other types as toString() has them.
    std::string text(Type) const;
    /// The first structure of this name, by its number; -1 if there is none.
    int named(const std::string&) const;
    /// The member of this name; null if there is none.
    const StructMember* member(Type, const std::string& name) const;
    /// How many structures above `have` the wanted one is: 0 is the same, -1 that it cannot be given for it. A structure can be
    /// given where one that it extends is wanted, if both are arrays or neither is; lengths that are known must be the same.
    int extensions(Type have, Type want) const;
    /// The plain members of one structure, or of an array of structures.
    std::vector<Leaf> leaves(Type) const;
    /// Whether a member has a value where the shader gives none.
    bool hasDefaults(Type) const;
    /// The first member that changes its length, in the structure or in members of it; null where there is none.
    const StructMember* openMember(Type) const;
    /// m structures of so many elements each; -1: as many as there are.
    static int flatLength(int outer, int inner);

private:
    const std::vector<StructType>& all_;
};

} // namespace alpenglow::rsl::front
