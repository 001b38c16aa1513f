// The part of the warnings for those who write shaders (lint.h) that follows statements in the order in which they run: variables
// that are read before they have a value, uniform ones that change where a varying condition holds, light where none shines.
#pragma once
#include "rsl/front/paths.h"
#include "rsl/front/source.h"
#include <map>
#include <set>

namespace alpenglow::rsl::front {

/// What functions read of the light that shines where they are called: the first such variable; null: none.
using LightReads = std::map<const Function*, const Symbol*>;

/// What is known of a body beside its text.
struct FlowRules {
    const std::set<const Symbol*>& ignored; ///< variables that may get a value at any time
    bool surface;                           ///< the body of a surface shader
    bool lit; ///< the body of a shader that meets light in illuminance() only; a function may be called from there
};

/// Warns about one body of a checked program. `reads` is shared by all bodies of the program.
void lintFlow(const Stmt& body, const FlowRules&, const Paths&, LightReads& reads, SourceSet&);

} // namespace alpenglow::rsl::front
