// The mode of a Display request: which variables it shows and what its channels are called (RISpec 3.2, 4.1.2).
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
    scene::Type type = scene::Type::Float;
    int arrayLength = 0;   ///< 0 = not an array
    bool declared = false; ///< false: nothing said the type; taken as color, the shader's own declaration decides
    std::vector<std::string> channels;
};

/// Variables of rgb rgba rgbz rgbaz a z az, of a variable's name ("list[1]": an element of an array), of an inline declaration
/// ("varying color mycolor"), or of a comma separated list of these. Types come from the declaration, else from DisplayChannel
/// (keys are names), else from RSL's predefined variables. A mode that is not understood is an error, and its parts that are
/// understood remain; an empty mode means rgba. A variable named twice is kept once, with a warning.
std::vector<ModeVariable> parseMode(const std::string& mode, Diagnostics&, const SourcePlace& = {},
                                    const std::map<std::string, scene::Param>& displayChannels = {});

/// The channel names of a mode, in order.
std::vector<std::string> channelNames(const std::vector<ModeVariable>&);

/// A declaration "class type name", "type name", "type[n] name" in any order RI allows; false when it is none.
bool parseDeclaration(const std::string& text, ModeVariable&);

} // namespace alpenglow::display
