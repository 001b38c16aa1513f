// The mode of a Display request: its variables and the names of its channels (RISpec 3.2, 4.1.2).
#pragma once
#include "base/diagnostics.h"
#include "scene/param.h"
#include <map>
#include <string>
#include <vector>

namespace alpenglow::display {

/// One variable of a mode. "rgb" is Ci with channels r g b; "a" is "alpha" with channel a; "z" is "z" with channel z (camera
/// space). An AOV N has N.x N.y N.z, a colour c c.r c.g c.b, a float f f, others name.000 ... (docs/design/ri.md).
struct ModeVariable {
    std::string name;
    scene::Type type = scene::Type::Float; ///< how many numbers a value has, and their names
    int arrayLength = 0;                   ///< 0 = not an array
    bool declared = false;                 ///< false: the type is undeclared; treated as color, the shader's declaration decides
    std::vector<std::string> channels;
};

/// Parses the variables: rgb rgba rgbz rgbaz a z az, a variable's name ("list[1]": an element of an array), an inline declaration
/// ("varying color mycolor"), or a comma separated list of these. Types are from the declaration, else from DisplayChannel (keys
/// are names), else RSL's predefined variables. Unknown parts are errors, and the other parts remain; an empty mode means rgba.
/// Duplicate variables are dropped with a warning.
std::vector<ModeVariable> parseMode(const std::string& mode, Diagnostics&, const SourcePlace& = {},
                                    const std::map<std::string, scene::Param>& displayChannels = {});

/// The channel names of a mode, in order.
std::vector<std::string> channelNames(const std::vector<ModeVariable>&);

/// A declaration "class type name", "type name", "type[n] name" in any order RI allows; false when it is none.
bool parseDeclaration(const std::string& text, ModeVariable&);

} // namespace alpenglow::display
