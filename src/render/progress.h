// Progress during rendering: a bar on a terminal, plain lines elsewhere. Writes to standard error, never to standard output.
#pragma once
#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace alpenglow::render {

/// Auto: a bar if standard error is a terminal, else plain lines.
enum class ProgressMode { Auto, Bar, Plain, None };
/// "auto" "bar" "plain" "none" (--progress MODE).
std::optional<ProgressMode> progressModeByName(std::string_view);

/// State to show.
struct ProgressState {
    double fraction = 0;       ///< of the work, 0..1; < 0 if unknown
    double samplesDone = 0;    ///< samples per pixel so far (a fraction inside a pass)
    uint64_t samplesTotal = 0; ///< per pixel; 0 if unknown (--noise, --time)
    double noise = -1;         ///< relative noise so far; < 0: unknown
    double raysPerMS = 0;      ///< thousand rays a second
};

/// Writes the progress of one frame. Thread safe.
class Progress {
public:
    using Sink = std::function<void(std::string_view)>; ///< receives text for standard error
    using Clock = std::function<double()>;              ///< seconds, any origin, monotonic
    static constexpr double kBarSeconds = 0.5;          ///< a bar is redrawn at most twice a second
    static constexpr double kPlainSeconds = 5;          ///< a line after this time, if there is progress,
    static constexpr double kPlainFraction = 0.1;       ///< or after this fraction of the work, but no more often than
    static constexpr double kPlainLeast = 1;            ///< every so many seconds

    /// For use: Auto becomes Bar if the file is a terminal, else Plain. The file is not closed.
    explicit Progress(ProgressMode, std::FILE* = stderr);
    /// For tests and viewers: terminal selects the meaning of Auto, columns the width of a bar line.
    Progress(ProgressMode, Sink, Clock, bool terminal, int columns = 80);

    /// Updates the state; prints when due. `what`: name of the picture before the line; may be empty.
    void update(const ProgressState&, std::string_view what = {});
    /// Prints the last line regardless of time, and a line end. Further calls start a new picture.
    void finish(const ProgressState&, std::string_view what = {});
    /// Removes the bar from the terminal so that a message can be printed; the next update redraws it.
    void clear();
    ProgressMode mode() const { return mode_; } ///< never Auto

private:
    std::string line(const ProgressState&, std::string_view what, bool last) const;
    ProgressMode mode_;
    Sink sink_;
    Clock clock_;
    int columns_ = 80;
    double start_ = 0, last_ = 0, lastFraction_ = 0;
    bool begun_ = false, printed_ = false, visible_ = false;
};

/// "0:07", "12:34", "3:05:00", "2d 3:05:00".
std::string formatDuration(double seconds);

} // namespace alpenglow::render
