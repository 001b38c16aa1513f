// What only RIS knows (docs/ris.md): bounds of networks of patterns, geometry of lights.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace alpenglow::ri {

inline constexpr size_t kNetworkDepth = 64;      ///< patterns behind each other
inline constexpr size_t kNetworkPatterns = 1024; ///< of one Bxdf
inline constexpr size_t kLightFilters = 64;      ///< of one light

/// The words of a token that names a connection: "reference color diffuseColor" gives its last. Empty: it is none.
std::string connectedName(const std::string& token);

/// The requests that draw Geometry "rectlight" and its like, one across; "" for those that have no shape. Nothing: no light's.
std::optional<std::string_view> lightGeometry(std::string_view name);

} // namespace alpenglow::ri
