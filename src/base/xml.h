// The one reader of XML: elements, attributes and character data. Names of spaces are part of names. Document types are refused,
// so there are no entities but the five of XML 1.0 and numbers of characters (&#65; &#x41;), and nothing else is ever opened.
// Source: XML 1.0, fifth edition.
#pragma once
#include "base/diagnostics.h"
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alpenglow {

/// An element and everything in it.
struct XmlElement {
    std::string name;                                            ///< with its prefix
    std::vector<std::pair<std::string, std::string>> attributes; ///< in their order, entities replaced
    std::vector<XmlElement> children;                            ///< elements in it, in their order
    std::string text;         ///< what stands in it outside of its children, entities replaced, without blanks at both ends
    int line = 0, column = 0; ///< of its '<', from 1
    /// The value of an attribute; "" when there is none.
    const std::string& attribute(std::string_view name) const;
    /// The first child of that name; null when there is none.
    const XmlElement* child(std::string_view name) const;
};

/// How a file is read, and how large it may be.
struct XmlRules {
    bool anyEndTag = false;      ///< an end tag ends the innermost element, whatever its name: some programs write wrong ones
    size_t depth = 64;           ///< elements in each other
    size_t elements = 1'000'000; ///< of the whole text
    size_t bytes = size_t(256) << 20; ///< of the text
};

/// The outermost element of a text. Nothing: one error with file:line:column was reported. `file`: for messages.
std::optional<XmlElement> parseXml(std::string_view text, const std::string& file, Diagnostics&, const XmlRules& = {});

} // namespace alpenglow
