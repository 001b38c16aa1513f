// Services that need no renderer: strings and standard output (3Delight manual, 6.4.7). `alpenglow eval` and the renderer answer
// with these.
#pragma once
#include "base/diagnostics.h"
#include "rsl/kernel.h"
#include <functional>

namespace alpenglow::rsl {

/// A value handed to format() or printf().
struct FormatValue {
    Base base = Base::Float; ///< Float, Color..Normal, Matrix or String
    float numbers[16] = {};  ///< the first componentCount() count
    std::string text;        ///< of String
};

/// format(): %f %e %g %d %p %c %m %s %h with flags, width and precision; %% is a percent sign. A conversion without a value is
/// copied as it stands; a value of another type than the conversion expects is printed by its own type.
std::string formatText(const std::string& pattern, const std::vector<FormatValue>& values);

/// match(): whether the POSIX extended regular expression occurs in the subject. False, with the reason in `error`, for a bad
/// expression.
bool matchText(const std::string& pattern, const std::string& subject, std::string* error = nullptr);

/// stringhash(): three numbers in [0,1), the first of which is the float form. The same in every run.
void hashText(const std::string&, float out[3]);

/// Takes one printf() of one lane.
using PrintFn = std::function<void(int lane, const std::string&)>;

/// Answers format, printf, concat, match and stringhash, and reports arrays at their limit, for the lanes of `mask`; arguments
/// as of ServiceFn. False for other sites. `files`: CompiledKernel::files, for messages. Without `print` the text goes to
/// standard output.
bool basicService(const ir::Site&, uint64_t mask, int32_t lanes, const float* in, float* out, Diagnostics&,
                  const PrintFn& print = {}, const std::vector<std::string>* files = nullptr);

} // namespace alpenglow::rsl
