#include "scene/counts.h"
#include "scene/primitivekinds.h"

namespace alpenglow::scene {

int64_t VariableCounts::of(Class cls) const {
    switch (cls) {
    case Class::Constant:
        return 1;
    case Class::Uniform:
        return uniform;
    case Class::Varying:
        return varying;
    case Class::Vertex:
        return vertex;
    case Class::FaceVarying:
    case Class::FaceVertex:
        break;
    }
    return faceVarying;
}

bool variableCounts(const Primitive& p, VariableCounts* c, std::string* why) {
    *c = VariableCounts{};
    if (const PrimitiveKind* kind = primitiveKind(p.kind)) return kind->counts(p, c, why);
    c->varying = c->vertex = c->faceVarying = 1;
    return true;
}

} // namespace alpenglow::scene
