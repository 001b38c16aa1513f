#include "rsl/front/structs.h"
#include "base/limits.h"
#include "rsl/front/source.h"

namespace alpenglow::rsl::front {

bool arrayPossible(const Structures& all, Type t, Place place, SourceSet& sources) {
    if (t.array == 0) return true;
    if (const StructMember* open = all.openMember(t)) {
        sources.report(place, msg::kStructArray(open->name, all.shown(t.element())),
                       "with a length of its own, as in " + open->name + "[8], there are");
        return false;
    }
    for (const Leaf& l : all.leaves(t))
        if (l.type.array > limits::kShaderArray) {
            sources.report(place, msg::kArrayLengthRange(limits::kShaderArray),
                           "this one has " + std::to_string(l.type.array) + " elements of '" + l.member->name + "'");
            return false;
        }
    return true;
}

void checkStructs(Program& program, SourceSet& sources) {
    const Structures all(program.structs);
    std::vector<size_t> members; // by structure: itself, its members, and those of members that are structures
    for (size_t index = 0; index < program.structs.size(); ++index) {
        size_t& count = members.emplace_back(1);
        for (auto& m : program.structs[index].members) {
            if (!isStruct(m.type)) {
                ++count;
                continue;
            }
            const size_t inner = size_t(m.type.structure);
            if (inner >= index) { // the parser knows only earlier ones; it could be itself after a second definition
                sources.report(m.place, msg::kStructRecursive);
                m.type = {Base::Float, 0};
            } else if (count + members[inner] > limits::kStructMembers) {
                sources.report(m.place, msg::kStructMembers(limits::kStructMembers));
                m.type = {Base::Float, 0};
            } else if (count += members[inner]; !arrayPossible(all, m.type, m.place, sources)) {
                m.type.array = 0;
            }
        }
    }
}

} // namespace alpenglow::rsl::front
