// A small reader of XML for MaterialX: elements and attributes. Text between elements is skipped, names of spaces are part of
// names, there are no document types and no entities but the five of XML 1.0. Source: XML 1.0, fifth edition.
#pragma once
#include "base/diagnostics.h"
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::models {

struct XmlElement {
    std::string name;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::vector<XmlElement> children;
    int line = 0;
    /// "" when there is none.
    const std::string& attribute(std::string_view name) const;
};

inline constexpr size_t kXmlDepth = 64, kXmlElements = 1'000'000;

/// The outermost element. Nothing: an error with its line was reported.
std::optional<XmlElement> parseXml(std::string_view text, const std::string& file, Diagnostics&);

} // namespace alpenglow::models
