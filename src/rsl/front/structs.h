// Structures, and how they go: before anything is checked, every variable of a structure becomes one variable for each of its
// members, named as the shader writes them ("ray->origin"). Behind this pass there are no structures.
#pragma once
#include "rsl/front/ast.h"

namespace alpenglow::rsl::front {

class SourceSet;
struct Unit;

struct StructMember {
    std::string name;
    Type type;
    Storage storage = Storage::Unspecified;
    ExprPtr init; ///< null: zero
    Place place;
};

struct StructType {
    std::string name;
    std::vector<StructMember> members;
    std::vector<std::unique_ptr<Function>> methods;
    int base = -1;    ///< the structure it extends, by its number in Unit::structs; its members come first
    std::string text; ///< the definition as written: a repeated, equal one is the same structure
    Place place;
};

/// Until they are gone, types of structures are bases above the built-in ones: their number in Unit::structs behind this one.
inline constexpr int kFirstStruct = 64;
inline bool isStruct(Type t) { return int(t.base) >= kFirstStruct; }
inline Base structBase(size_t index) { return Base(kFirstStruct + int(index)); }

/// Puts members for structures in all shaders, classes and functions of the unit. What has no meaning is reported and left out.
void lowerStructs(Unit&, SourceSet&);

} // namespace alpenglow::rsl::front
