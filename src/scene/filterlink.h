// Which light filters of RIS act on the light that a primitive receives (docs/ris.md, "Light filters"; Pixar's manual, "Writing
// Light Filters").
#pragma once
#include "scene/primitive.h"
#include <optional>
#include <string>

namespace alpenglow::scene {

/// A filter of a light, as Attribute "lightfilter" and EnableLightFilter name it. Shaders of lights pass it as a text
/// (shaders/include/rislight.h), which they do not read.
struct FilterLink {
    std::string light, filter; ///< handles
    std::string groups;        ///< "linkingGroups" of the filter; "": it acts on everything
    /// The text that of() reads. Handles and groups may hold anything but line ends, which become blanks.
    std::string text() const;
    /// The reverse; nothing: the text is none of text().
    static std::optional<FilterLink> of(const std::string& text);
    /// Whether the filter acts on the light that a primitive with these attributes receives; null: nothing is known of it.
    /// EnableLightFilter decides; else a filter without groups acts, one with groups where "lightfilter:subset" names one of
    /// them, and none that "lightfilter:excludesubset" names by a group or its handle.
    bool acts(const Attributes*) const;
};

/// The key of Attributes::values under which EnableLightFilter keeps its number.
std::string enabledFilterKey(const std::string& light, const std::string& filter);

} // namespace alpenglow::scene
