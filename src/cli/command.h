// What the subcommands share: exit statuses, messages on standard error, ways to read arguments. One file a subcommand; each adds
// itself to the program by its add function.
#pragma once
#include "base/diagnostics.h"
#include "base/stopflag.h"
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace alpenglow::cli {

/// Exit statuses, fixed.
enum Status : int {
    kDone = 0,
    kDoneWithErrors = 1,
    kWrongUse = 2,
    kNothingRendered = 3,
    kLimit = 4,
    kOutputFailed = 5,
    kInterrupted = 130
};

/// What each status means, for help texts.
struct StatusText {
    Status status;
    const char* meaning; ///< for help texts
};
std::span<const StatusText> statusTexts(); ///< in the order of their numbers

/// Runs a command line. Returns the exit status; prints messages. Exceptions of the work pass through.
int runProgram(int argc, char** argv);

/// Each describes its options to the parser and, when its subcommand is called, does the work and sets *status.
void addRender(CLI::App&, int* status, const std::string& command); ///< `command`: the whole line, for --stats and --stamp
void addView(CLI::App&, int* status);
void addEval(CLI::App&, int* status);
void addShade(CLI::App&, int* status);
void addCompile(CLI::App&, int* status);
void addInfo(CLI::App&, int* status);
void addProbe(CLI::App&, int* status);
void addMaketx(CLI::App&, int* status);
void addPtc(CLI::App&, int* status);
void addDiff(CLI::App&, int* status);
void addMerge(CLI::App&, int* status);
void addRib(CLI::App&, int* status);
void addLsp(CLI::App&, int* status);
void addFrom(CLI::App&, int* status);

/// Prints diagnostics of at least this severity to standard error, taking a progress bar off the line first.
Diagnostics::Handler printer(Severity least = Severity::Warning);

/// Flags of the process that a signal sets: 0, then 1 after the first Ctrl-C. A second ends the process at once with status 130.
const StopFlag* watchInterrupts();

/// Treats this signal as the first Ctrl-C. A process uses it to stop the processes that it has started.
void watchStopSignal(int signal);
/// Leaves Ctrl-C to the process that began this one.
void leaveInterrupts();

/// Whether standard input is a file or a pipe: what a program reads that is given no names.
bool standardInputHasData();

/// Folders of ALPENGLOW_SHADERS.
std::vector<std::string> environmentShaders();
/// --searchpath: ':' separated.
std::vector<std::string> folders(const std::vector<std::string>& lists);

/// The option --dialect: the name of the renderer whose compiler's macros are predefined goes to `name`, which outlives the
/// parser.
void addDialect(CLI::App&, std::string& name);

/// For an option that names a picture: what is wrong with the name, or "". Its extension must be of a format that is written;
/// with `output`, "-" is standard output, as long as that is no terminal.
std::string faultOfPictureName(const std::string& name, bool output);

/// Reads the value of --format, "640x480", in pixels; a side may have limits::kImageSide pixels. Throws CLI::ValidationError.
void readFormat(const std::string&, int* width, int* height);
/// The last of these files is made of the others, and is none of them. Throws CLI::ValidationError.
void refuseOwnInput(const std::vector<std::string>& files);
/// Numbers separated by commas; nothing unless there are exactly `count` (0 = any number) and all are finite.
std::optional<std::vector<double>> parseNumbers(const std::string&, size_t count = 0);
/// "1,4-6" gives 1 4 5 6; nothing when it is not such a list, or longer than 100000.
std::optional<std::vector<int>> parseFrames(const std::string&);

} // namespace alpenglow::cli
