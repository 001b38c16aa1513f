// The reference page of RIB requests, written from the table.
#pragma once
#include "ri/requests/request.h"
#include <string>

namespace alpenglow::ri {

/// The kinds in the order of the manual, and their headings.
inline constexpr Kind kManualOrder[] = {Kind::Structure, Kind::Option,    Kind::Attribute, Kind::Shader,  Kind::Light,
                                        Kind::Transform, Kind::Primitive, Kind::Archive,   Kind::Texture, Kind::Other};
const char* titleOf(Kind);
/// For one request: arguments, what it does, where it may stand, an example.
std::string requestText(const Request&);
/// The page docs/rib.md: one table a kind, with signature, scopes, motion and description of every request.
std::string requestManual();

} // namespace alpenglow::ri
