// What is in a stream of requests, counted.
#pragma once
#include "ri/call.h"
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace alpenglow::ri {

/// Counts of requests, for `alpenglow rib --stats`.
class RequestStats {
public:
    /// Sums over requests.
    struct Count {
        uint64_t times = 0;   ///< requests
        uint64_t numbers = 0; ///< in its arguments and parameters
        uint64_t bytes = 0;   ///< about what they take in binary: four for a number
    };
    /// Counts a call, or a request that is not in the table.
    void add(const Call&);
    void addUnknown(const std::string& name, const std::vector<Value>& values);

    std::map<std::string, Count> requests; ///< by name
    Count all, primitives, lights;         ///< all requests, primitives, light sources
    uint64_t frames = 0, worlds = 0;       ///< blocks
    int depth = 0;                         ///< of blocks
    std::set<std::string> shaders;         ///< named by Surface and its like, LightSource and Shader
    std::set<std::string> archives;        ///< named by ReadArchive and procedurals that read one

    RequestStats() = default;
    RequestStats(const RequestStats&) = delete;
    RequestStats& operator=(const RequestStats&) = delete;

private:
    std::unordered_map<const Request*, Count*> known_; ///< into `requests`
    int open_ = 0;
};

/// As a table for people.
std::string statsText(const RequestStats&);

} // namespace alpenglow::ri
