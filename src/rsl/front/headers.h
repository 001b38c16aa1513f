// What a shader expects from its surroundings: the headers of well-known names, and the macros that a compiler predefines.
#pragma once
#include <span>
#include <string_view>

namespace alpenglow::rsl::front {

/// A header of ours, under a name that published shaders include. Its text lies in shaders/include.
struct ShippedHeader {
    std::string_view name, text;
};

/// All of them, by name.
std::span<const ShippedHeader> shippedHeaders();
/// The header of that name, in upper or lower case, or under one of its other names; null when there is none.
const ShippedHeader* shippedHeader(std::string_view name);

/// Names of the dialects, the default first.
std::span<const std::string_view> dialects();
/// "NAME VALUE" of each macro that the compiler of this dialect predefines. "" is 3Delight's; an unknown name has none.
std::span<const std::string_view> dialectMacros(std::string_view dialect);
/// Text that is read before every file of this dialect: definitions of what its compiler has built in and this one has not.
std::string_view dialectPrelude(std::string_view dialect);
/// The dialect whose shaders call a function that no other has, and that its macros put another in place of; "" for others.
std::string_view dialectOfFunction(std::string_view function);
/// Whether specular() and specularbrdf() have RISpec's exponent in this dialect (shadeops/specular.h).
bool dialectRispecSpecular(std::string_view dialect);
/// Whether P of a light shader is the point being lit, as Ps is.
bool dialectLitPoint(std::string_view dialect);
/// The bias of shadow() where neither a scene nor a shader sets one, in world units.
float dialectShadowBias(std::string_view dialect);

} // namespace alpenglow::rsl::front
