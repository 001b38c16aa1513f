// The part of include/ri.h that declares the calls of requests, written from the table.
#pragma once
#include <string>
#include <string_view>

namespace alpenglow::ri {

/// Whether a request is one of files alone, without a call in C: of a file's form, or of other renderers whose bindings differ.
bool withoutCall(std::string_view request);
/// Whether a request with a parameter list has one form of call, not two: the specification's binding has no list there.
bool hasOneForm(std::string_view request);
/// The prototypes of all calls, by kind and name, as C89 has them: Ri<request>, and with a V where there is a parameter list as
/// arrays. Arguments are those of the signature, numbers as RtFloat, strings as RtToken, but where the binding has others.
std::string callPrototypes();

/// The lines of include/ri.h between which the prototypes stand.
inline constexpr std::string_view kPrototypesBegin =
    "/* Generated from the table of requests by `alpenglow info --requests --header`: */\n";
inline constexpr std::string_view kPrototypesEnd = "/* End of the generated prototypes. */\n";

} // namespace alpenglow::ri
