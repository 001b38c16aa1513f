// Filters of requests in C++ libraries (include/RifPlugin.h).
#pragma once
#include "ri/receiver.h"
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::ri {

/// A filter whose requests go on to `to`. Null with a reason where the file is no such library, or refuses the arguments. What a
/// filter throws is reported at the place of the request, which is then left out; `reported` must outlive the filter.
std::unique_ptr<RequestReceiver> loadRif(const std::string& path, std::vector<std::string> arguments, RequestReceiver& to,
                                         Diagnostics& reported, std::string& why);

/// Whether requests are sent to every member of RifFilter that is a function: none is missing in the lists of members.
bool rifComplete();

} // namespace alpenglow::ri
