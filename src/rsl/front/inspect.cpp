#include "rsl/front/inspect.h"

namespace alpenglow::rsl {

StructSummary summary(const StructType& s, const Program& program) {
    StructSummary r{s.name, {}, s.methods};
    for (const StructMember& m : s.members) {
        std::string type = isStruct(m.type) ? program.structs[size_t(m.type.structure)].name : toString(m.type.element());
        if (m.storage != Storage::Unspecified) type.insert(0, m.storage == Storage::Uniform ? "uniform " : "varying ");
        if (m.type.array) type += m.type.array > 0 ? "[" + std::to_string(m.type.array) + "]" : "[]";
        r.members.push_back({std::move(type), m.name, m.place});
    }
    return r;
}

std::vector<StructSummary> summaries(const Program& program) {
    std::vector<StructSummary> all;
    for (const StructType& s : program.structs) all.push_back(summary(s, program));
    return all;
}

} // namespace alpenglow::rsl
