// What becomes of the calls between RiBegin and RiEnd.
#pragma once
#include "base/diagnostics.h"
#include "ri/c/target.h"
#include <memory>
#include <string>

namespace alpenglow::capi {

/// Where the calls of a context go.
class Output {
public:
    virtual ~Output() = default;
    /// The receiver of the calls; valid as long as the output.
    virtual ri::Target& target() = 0;
    /// RiEnd: closes what is open, and ends the work.
    virtual void end(const SourcePlace&) = 0;
};

/// Draws pictures, as `alpenglow render` does. options: the flags of that command (ALPENGLOW_OPTIONS).
std::unique_ptr<Output> drawing(const std::string& options, Diagnostics&);
/// Writes RIB. "-" is standard output. Null, with an error, when the file cannot be opened.
std::unique_ptr<Output> ribFile(const std::string& name, Diagnostics&);

} // namespace alpenglow::capi
