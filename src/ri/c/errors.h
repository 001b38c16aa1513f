// Error handling of the C binding (RISpec 3.2, 7.2): one handler and one RiLastError for the process, as C has them.
#pragma once
#include "base/diagnostics.h"
#include <functional>

namespace alpenglow::ri {

/// Notes a diagnostic: sets RiLastError (warnings and errors), prints it where RiErrorPrint or RiErrorAbort is the handler, and
/// keeps it for a program's own handler. From any thread.
void noteError(const Diagnostic&);
/// To be called where the program's thread leaves the library: the program's own handler gets what was kept; RiErrorAbort ends
/// the program after an error.
void deliverErrors();
/// How RiErrorPrint prints what this library reports; nothing is printed, and nothing is said of calls that nobody wants, until
/// it is set.
void setErrorPrinter(std::function<void(const Diagnostic&)>);
/// A call that nobody wants: RIE_NOTSTARTED.
void noteNotStarted(const char* function);

} // namespace alpenglow::ri
