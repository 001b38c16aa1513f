// The program inside this one.
#pragma once
#include <string>
#include <vector>

namespace alpenglow::fuzz {

/// `alpenglow ARGUMENTS...` in this process; its exit status.
int program(const std::vector<std::string>& arguments);

} // namespace alpenglow::fuzz
