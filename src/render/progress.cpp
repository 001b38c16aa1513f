#include "render/progress.h"
#include "base/printable.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace alpenglow::render {

std::optional<ProgressMode> progressModeByName(std::string_view n) {
    if (n == "auto") return ProgressMode::Auto;
    if (n == "bar") return ProgressMode::Bar;
    if (n == "plain") return ProgressMode::Plain;
    if (n == "none") return ProgressMode::None;
    return {};
}

std::string formatDuration(double seconds) {
    if (!(seconds >= 0) || seconds > 1e9) return "?";
    long s = std::lround(seconds), d = s / 86400;
    std::string text = d ? fmt::format("{}d ", d) : "";
    s %= 86400;
    if (d || s >= 3600) return text + fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
    return text + fmt::format("{}:{:02}", s / 60, s % 60);
}

Progress::Progress(ProgressMode mode, std::FILE* f)
    : Progress(
          mode,
          [f](std::string_view t) {
              std::fwrite(t.data(), 1, t.size(), f);
              std::fflush(f);
          },
          [] { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); },
          isatty(fileno(f)) != 0) {
    winsize size{};
    if (ioctl(fileno(f), TIOCGWINSZ, &size) == 0 && size.ws_col > 0) columns_ = size.ws_col;
}

Progress::Progress(ProgressMode mode, Sink sink, Clock clock, bool terminal, int columns)
    : mode_(mode != ProgressMode::Auto ? mode
            : terminal                 ? ProgressMode::Bar
                                       : ProgressMode::Plain),
      sink_(std::move(sink)), clock_(std::move(clock)), columns_(columns) {}

std::string Progress::line(const ProgressState& s, std::string_view what, bool last) const {
    std::string text;
    if (s.fraction >= 0) text += fmt::format("{:3.0f}%  ", std::floor(100 * std::clamp(s.fraction, 0.0, 1.0)));
    text += fmt::format("{:.0f}", std::floor(s.samplesDone));
    if (s.samplesTotal) text += fmt::format("/{}", s.samplesTotal);
    text += " samples";
    if (s.noise >= 0) text += fmt::format("  noise {:.4g}", s.noise);
    if (s.raysPerMS > 0) text += fmt::format("  {:.0f} rays/ms", s.raysPerMS);
    double elapsed = clock_() - start_;
    if (last) text += "  in " + formatDuration(elapsed);
    else if (s.fraction > 0) text += "  ETA " + formatDuration(elapsed * (1 - std::min(s.fraction, 1.0)) / s.fraction);
    if (!what.empty()) text = printable(what) + "  " + text;
    return text;
}

void Progress::update(const ProgressState& s, std::string_view what) {
    if (mode_ == ProgressMode::None) return;
    double now = clock_();
    if (!begun_) {
        begun_ = true;
        printed_ = false;
        start_ = last_ = now;
        lastFraction_ = 0;
    }
    if (mode_ == ProgressMode::Bar) {
        if (printed_ && now - last_ < kBarSeconds) return;
        std::string text = line(s, what, false);
        int room = columns_ - int(text.size()) - 5;
        if (room >= 8 && s.fraction >= 0) {
            int width = std::min(room, 40), full = int(std::clamp(s.fraction, 0.0, 1.0) * width);
            text = "[" + std::string(size_t(full), '#') + std::string(size_t(width - full), '.') + "] " + text;
        }
        // A wrapped line would leave its first half on the screen at every redraw.
        if (int(text.size()) > columns_ - 1) text.resize(size_t(std::max(0, columns_ - 1)));
        sink_("\r" + text + "\x1b[K");
        visible_ = true;
    } else {
        double since = now - last_, gain = s.fraction - lastFraction_;
        if (since < kPlainLeast || (since < kPlainSeconds && gain < kPlainFraction)) return;
        sink_(line(s, what, false) + "\n");
    }
    printed_ = true;
    last_ = now;
    lastFraction_ = s.fraction;
}

void Progress::finish(const ProgressState& s, std::string_view what) {
    if (mode_ == ProgressMode::None) return;
    if (!begun_) start_ = clock_();
    std::string text = line(s, what, true);
    sink_(mode_ == ProgressMode::Bar ? "\r" + text + "\x1b[K\n" : text + "\n");
    begun_ = printed_ = visible_ = false;
}

void Progress::clear() {
    if (!visible_) return;
    sink_("\r\x1b[K");
    visible_ = printed_ = false;
}

} // namespace alpenglow::render
