// What is in a stream of requests, counted.
#pragma once
#include "ri/call.h"
#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace alpenglow::ri {

class RequestStats {
public:
    struct Count {
        uint64_t times = 0;
        uint64_t numbers = 0; ///< in its arguments and parameters
        uint64_t bytes = 0;   ///< as it is written
    };
    void add(const Call&, uint64_t bytes);
    void addUnknown(const std::string& name, uint64_t numbers, uint64_t bytes);

    std::map<std::string, Count> requests; ///< by name
    Count all, primitives, lights;
    uint64_t frames = 0, worlds = 0;
    int depth = 0;                  ///< of blocks
    std::set<std::string> shaders;  ///< named by Surface and its like, LightSource and Shader
    std::set<std::string> archives; ///< named by ReadArchive and procedurals that read one

private:
    int open_ = 0;
};

/// As a table for people.
std::string statsText(const RequestStats&);

} // namespace alpenglow::ri
