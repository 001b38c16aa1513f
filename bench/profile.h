// Where CPU time goes: the place of the program is noted 1000 times a second of CPU time and named by the file's own symbols.
#pragma once
#include <cstdint>
#include <map>
#include <string>

namespace alpenglow::bench {

/// One at a time. Counts what every thread does between start() and stop().
class Profile {
public:
    void start();
    void stop();
    /// Samples by symbol (mangled); "[kernel code]" for machine code made at run time, "[libx.so]" for shared libraries.
    std::map<std::string, uint64_t> bySymbol() const;
};

} // namespace alpenglow::bench
