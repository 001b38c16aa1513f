// Structures before and behind the checker: what is wrong with their definitions, their methods as functions, and how they go.
#pragma once
#include "rsl/front/structures.h"

namespace alpenglow::rsl::front {

class Checker;
class SourceSet;
struct Unit;

/// The type of one structure of this number, or of so many.
inline Type structType(size_t number, int array = 0) { return {Base::Struct, array, int16_t(number)}; }

/// Whether there can be an array of such structures; if not, that is reported: what changes its length has no place in one.
bool arrayPossible(const Structures&, Type, Place, SourceSet&);

/// Reports members that cannot be, and makes them numbers: a structure inside itself would have no end.
void checkStructs(Program&, SourceSet&);

/// Methods of structures to functions of the unit, called "Structure->method". Their first parameter, "this", is the structure.
/// Before names are known: it reads texts only.
void addStructMethods(Unit&, const Program&);

/// Takes all structures of a checked program apart: a variable becomes one variable for each plain member, named as the shader
/// writes it ("ray->origin"). No expression or statement has a structure behind this pass. It stands what is wrong, as reported.
void lowerStructs(Program&, SourceSet&, Checker&);

} // namespace alpenglow::rsl::front
