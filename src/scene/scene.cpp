#include "scene/scene.h"

namespace alpenglow::scene {

int componentCount(Type t) {
    switch (t) {
    case Type::Color:
    case Type::Point:
    case Type::Vector:
    case Type::Normal:
        return 3;
    case Type::HPoint:
        return 4;
    case Type::Matrix:
        return 16;
    default:
        return 1;
    }
}

const Param* find(const ParamList& list, std::string_view name) {
    // "P" given twice: the last one counts (docs/design/ri.md, "Reading").
    for (auto i = list.rbegin(); i != list.rend(); ++i)
        if (i->name == name) return &*i;
    return nullptr;
}

} // namespace alpenglow::scene
