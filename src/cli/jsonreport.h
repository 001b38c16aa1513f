// What --json prints: one object with what the command found, and its messages under "diagnostics".
#pragma once
#include "base/diagnostics.h"
#include <nlohmann/json.hpp>

namespace alpenglow::cli {

/// A message as JSON; lines and columns count from 1, columns and lengths in bytes.
nlohmann::ordered_json diagnosticJson(const Diagnostic&);

/// With `json` a handler that adds warnings and errors to `reported`, which outlives it; else printer().
Diagnostics::Handler printerOr(bool json, nlohmann::ordered_json& reported);

/// Prints the object to standard output, with `reported` as its "diagnostics".
void printReport(nlohmann::ordered_json found, nlohmann::ordered_json reported);

} // namespace alpenglow::cli
