// The whole program under another name, so that one process runs thousands of command lines.
#define main alpenglowMain
#include "../../src/cli/main.cpp"
#undef main
#include "program.h"
#include <iostream>

namespace alpenglow::fuzz {

int program(const std::vector<std::string>& arguments) {
    std::vector<std::string> copy{"alpenglow"};
    copy.insert(copy.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& a : copy) argv.push_back(a.data());
    argv.push_back(nullptr);
    const int status = alpenglowMain(int(copy.size()), argv.data());
    std::fflush(nullptr);
    std::cout.flush();
    return status;
}

} // namespace alpenglow::fuzz
