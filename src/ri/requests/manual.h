// The reference page of RIB requests, written from the table.
#pragma once
#include <string>

namespace alpenglow::ri {

/// Markdown: one table a kind, with signature, scopes, motion and description of every request.
std::string requestManual();

} // namespace alpenglow::ri
