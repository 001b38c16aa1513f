#include "shadeops/types.h"
#include <iterator>

namespace alpenglow::shadeops {

int componentCount(Base base) {
    switch (base) {
    case Base::Void:
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
    static constexpr const char* kNames[] = {"void",   "bool",   "float",  "color",  "point",
                                             "vector", "normal", "matrix", "string", "shader"};
    const size_t base = static_cast<size_t>(type.base); // beyond the table: structures, numbered by the front end while it reads
    std::string text = base < std::size(kNames) ? kNames[base] : "structure";
    if (type.array > 0) text += "[" + std::to_string(type.array) + "]";
    else if (type.array < 0) text += "[]";
    return text;
}

} // namespace alpenglow::shadeops
