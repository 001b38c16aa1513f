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
/// Sets how RiErrorPrint prints the messages of this library. Until then nothing is printed, not even for calls outside
/// RiBegin and RiEnd.
void setErrorPrinter(std::function<void(const Diagnostic&)>);
/// Reports RIE_NOTSTARTED for a call outside RiBegin and RiEnd.
void noteNotStarted(const char* function);

} // namespace alpenglow::ri
