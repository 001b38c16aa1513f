// A block of a solid.
#pragma once
#include <cstdint>

namespace alpenglow::scene {

/// The argument of SolidBegin; Part: "primitive".
enum class SolidOperation { Part, Union, Intersection, Difference };

/// One SolidBegin around a primitive. id: its number in the scene; child: which of the block around it, from 0.
struct SolidStep {
    uint32_t id = 0;
    SolidOperation operation = SolidOperation::Part; ///< of the block
    int child = 0;
    bool operator==(const SolidStep&) const = default;
};

} // namespace alpenglow::scene
