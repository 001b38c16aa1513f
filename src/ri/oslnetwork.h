// Networks of OSL shaders in one Pattern "PxrOSL" "string network": an XML file has their nodes and connections
// ("Working with PxrOSL", renderman.pixar.com/resources/RenderMan_20/PxrOSLRef.html).
#pragma once
#include "base/diagnostics.h"
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::ri {

/// A shader of a network, under a name that is its own there.
struct OslNode {
    std::string shader, layer; ///< name of the shader; of the layer
};
/// An output of a layer that gives a parameter of another its value.
struct OslLink {
    std::string from, output, to, parameter; ///< `output` of layer `from` to `parameter` of layer `to`
};
struct OslNetwork {
    std::vector<OslNode> nodes; ///< in the order of the file
    std::vector<OslLink> links; ///< in the order of the file
};

/// Reads a network. A node without <NodeLayer> has its <NodeId> as its name; connections name layers, or shaders where they name
/// no layer that is there. Names of closing tags are not compared: files in use have wrong ones. Nothing: an error with its place
/// in `file`, the name for messages, was reported.
std::optional<OslNetwork> oslNetwork(std::string_view xml, const std::string& file, Diagnostics&);

/// Handle of the pattern that a layer of the Pattern "handle" is, with a byte that no handle of a scene has.
std::string layerHandle(std::string_view handle, std::string_view layer);
/// What all handles of layers of a Pattern begin with.
std::string layersOf(std::string_view handle);
/// The handle as messages have it: "handle:layer".
std::string shownHandle(std::string_view handle);

} // namespace alpenglow::ri
