// Programs that a scene has make RIB (Procedural "RunProgram"): one process a command, asked again and again.
#pragma once
#include "base/limits.h"
#include "base/stopflag.h"
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::ri {

/// A process that gets lines and answers each with text up to a byte 0377. Never by way of a shell; it shares no file of ours but
/// standard error, where its own messages belong.
class Program {
public:
    /// arguments[0] is the path of the file. Null with a reason when it cannot be started.
    static std::unique_ptr<Program> start(const std::vector<std::string>& arguments, std::string& why);
    /// Its input ends; it is given a second to end by itself and then killed.
    ~Program();
    Program(const Program&) = delete;
    /// Leaves the process to another one of ours, whose copy this one is.
    void leave();
    Program& operator=(const Program&) = delete;

    /// Sends a line and waits for the answer, at most `seconds`. False with a reason when it ended, took too long, said too much
    /// (more bytes than `most`) or the user stopped the render; then it is killed, and `answer` holds what came.
    bool ask(const std::string& line, double seconds, const StopFlag* stop, std::string& answer, std::string& why,
             size_t most = limits::kProgramBytes);

private:
    Program() = default;
    void kill();
    int process_ = -1, to_ = -1, from_ = -1;
    std::string rest_; ///< read beyond the last answer
};

/// What ask() says of an answer that ends with the character 0377, not with the byte.
inline constexpr const char* kEndsAsText = "its answer ends with the bytes C3 BF, not with the byte FF (0377) alone";

/// The words of a command: blanks separate, quotes join. No variables, no patterns.
std::vector<std::string> commandWords(const std::string& command);

} // namespace alpenglow::ri
