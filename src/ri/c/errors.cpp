#include "ri/c/errors.h"
#include "ri/c/client.h"
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fmt/format.h>
#include <mutex>

extern "C" RtInt RiLastError = 0;

namespace alpenglow::ri {

namespace {

/// The state of the C binding: C has no object that it could be in.
struct ErrorState {
    std::recursive_mutex mutex; ///< a printer may report
    RtErrorHandler handler = RiErrorPrint;
    std::function<void(const Diagnostic&)> print;
    std::deque<Diagnostic> kept;
    bool aborts = false;
    int notStarted = 0;
};

ErrorState& errorState() {
    static auto* state = new ErrorState; // also for calls while the program ends
    return *state;
}

constexpr size_t kMostKept = 10'000;
constexpr int kNotStartedShown = 3;

std::string handlersMessage(const Diagnostic& d) {
    std::string text = d.place.file.empty() ? "" : fmt::format("{}:{}: ", d.place.file, d.place.line);
    text += d.message;
    if (!d.hint.empty()) text += " (" + d.hint + ")";
    return text;
}

} // namespace

void noteError(const Diagnostic& d) {
    ErrorState& s = errorState();
    const std::lock_guard lock(s.mutex);
    if (d.severity != Severity::Info) RiLastError = RtInt(d.code);
    if (s.handler == RiErrorIgnore) return;
    const bool own = s.handler != RiErrorPrint && s.handler != RiErrorAbort;
    if (!own && s.print) s.print(d);
    if (!own) s.aborts |= s.handler == RiErrorAbort && d.severity >= Severity::Error;
    else if (s.kept.size() < kMostKept && (d.severity != Severity::Info || d.always)) s.kept.push_back(d);
}

void deliverErrors() {
    ErrorState& s = errorState();
    while (true) {
        RtErrorHandler handler = nullptr;
        RtInt code = 0, severity = 0;
        std::string message;
        {
            const std::lock_guard lock(s.mutex);
            if (s.aborts) handler = RiErrorAbort;
            else {
                if (s.kept.empty()) return;
                handler = s.handler;
                code = RtInt(s.kept.front().code);
                severity = RtInt(s.kept.front().severity);
                message = handlersMessage(s.kept.front());
                s.kept.pop_front();
            }
        }
        if (handler == RiErrorAbort) std::exit(EXIT_FAILURE); // the message has been printed
        handler(code, severity, message.data());
    }
}

void setErrorPrinter(std::function<void(const Diagnostic&)> print) {
    ErrorState& s = errorState();
    const std::lock_guard lock(s.mutex);
    s.print = std::move(print);
}

void noteNotStarted(const char* function) {
    ErrorState& s = errorState();
    const std::lock_guard lock(s.mutex);
    if (!s.print) return; // a program that draws scenes, in which a library calls when it should not
    Diagnostic d;
    d.code = Rie::NotStarted;
    d.message = fmt::format("{}: nobody takes the call", function);
    d.hint = "RiBegin comes first, and RiContext chooses one of several contexts";
    const bool prints = s.handler == RiErrorPrint;
    if (prints && ++s.notStarted > kNotStartedShown) {
        RiLastError = RIE_NOTSTARTED;
        return;
    }
    noteError(d);
}

} // namespace alpenglow::ri

extern "C" {

RtVoid RiErrorHandler(RtErrorHandler handler) {
    using namespace alpenglow::ri;
    const Boundary boundary;
    const char* style = handler == RiErrorIgnore  ? "ignore"
                        : handler == RiErrorAbort ? "abort"
                                                  : "print"; // a function of a program's own has no name
    ErrorState& s = errorState();
    const std::lock_guard lock(s.mutex);
    s.handler = handler ? handler : RiErrorPrint;
    if (Client* c = Client::current()) c->to.errorHandler(style);
}

RtVoid RiErrorIgnore(RtInt, RtInt, char*) {}

RtVoid RiErrorPrint(RtInt code, RtInt severity, char* message) {
    static constexpr const char* kWords[] = {"note", "warning", "error", "severe error"};
    const char* word = severity >= 0 && severity <= RIE_SEVERE ? kWords[severity] : "error";
    std::fprintf(stderr, "%s: %s [RIE %d]\n", word, message ? message : "", code);
}

RtVoid RiErrorAbort(RtInt code, RtInt severity, char* message) {
    RiErrorPrint(code, severity, message);
    if (severity >= RIE_ERROR) std::exit(EXIT_FAILURE);
}

} // extern "C"
