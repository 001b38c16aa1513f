#include "shadeops/types.h"

namespace alpenglow::shadeops {

int componentCount(Base base) {
    switch (base) {
    case Base::Void:
    case Base::Struct:
        return 0;
    case Base::Bool:
    case Base::Float:
    case Base::String:
    case Base::Shader:
        return 1;
    case Base::Color:
    case Base::Point:
    case Base::Vector:
    case Base::Normal:
        return 3;
    case Base::Matrix:
        return 16;
    }
    return 0;
}

std::string toString(Type type) {
    static constexpr const char* kNames[] = {"void",   "bool",   "float",  "color",  "point",    "vector",
                                             "normal", "matrix", "string", "shader", "structure"};
    std::string text = kNames[static_cast<size_t>(type.base)];
    if (type.array > 0) text += "[" + std::to_string(type.array) + "]";
    else if (type.array < 0) text += "[]";
    return text;
}

} // namespace alpenglow::shadeops
