#include "rsl/ir/complaint.h"

namespace alpenglow::rsl::ir {

Site complaint(const Raised& message) {
    Site s;
    s.op = "complaint";
    const std::string text = message.text();
    const size_t hole = text.find(kWhenRun);
    s.strings = {text.substr(0, hole)};
    if (hole != std::string::npos) s.strings.insert(s.strings.end(), {"", text.substr(hole + 1)}); // "": an argument
    s.names = {"id"};
    s.pairStrings = {message.message->kind.id};
    return s;
}

} // namespace alpenglow::rsl::ir
