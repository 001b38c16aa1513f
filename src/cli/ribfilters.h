// Filters of `alpenglow rib`: libraries in C++ and functions in Python, one after the other.
#pragma once
#include "base/stopflag.h"
#include "ri/receiver.h"
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::cli {

/// Filters in their order. Each gets what the one before passes on; the last passes on to a given receiver.
class RibFilters {
public:
    /// specs: "lib.so ARGUMENT..", "file.py", "file.py:function" or "python:module.function"; blanks separate words, quotes join
    /// them. Null after a report where one cannot be used. `to`, `reported` and `stop` (may be null) must outlive it.
    static std::unique_ptr<RibFilters> make(const std::vector<std::string>& specs, ri::RequestReceiver& to, Diagnostics& reported,
                                            const StopFlag* stop);
    /// The receiver of the requests that are filtered.
    ri::RequestReceiver& first() { return stages_.empty() ? to_ : *stages_.back(); }

private:
    explicit RibFilters(ri::RequestReceiver& to) : to_(to) {}
    ri::RequestReceiver& to_;
    std::vector<std::unique_ptr<ri::RequestReceiver>> stages_; ///< the last one first
};

/// A function in Python, in a separate process; see RibFilters::make for `spec`. Null with a reason where there is none.
std::unique_ptr<ri::RequestReceiver> pythonFilter(const std::string& spec, const std::vector<std::string>& arguments,
                                                  ri::RequestReceiver& to, Diagnostics& reported, const StopFlag* stop,
                                                  std::string& why);

} // namespace alpenglow::cli
