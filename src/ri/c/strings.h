// Strings that C passes by their addresses, as far as a program that passes something else can be survived.
#pragma once
#include <optional>
#include <string>

namespace alpenglow::ri {

/// Programs pass "on" where the address of an RtString that is "on" is due. What stands at `value` is then no address: nothing
/// can be read there. In that case the text at `value`; nothing where `value` holds an address that can be read, or cannot be
/// read itself. Asks the system and touches neither.
std::optional<std::string> textInsteadOfAddress(const void* value);

/// Whether the last byte of an array can be read: lengths follow from what a program says, and it may say too much. Short ones
/// are not looked at.
bool endsWhereItCanBeRead(const void* array, size_t bytes);

} // namespace alpenglow::ri
