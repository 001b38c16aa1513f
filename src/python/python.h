// What the files of the extension module share. Everything here is called with Python's lock held unless it says otherwise.
#pragma once
#include "base/diagnostics.h"
#include "base/stopflag.h"
#include <functional>
#include <mutex>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace alpenglow::python {

/// As pybind11's documentation abbreviates it.
namespace py = pybind11;

/// Wrong use: alpenglow.Error in Python.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Does `work` in a thread of its own, without Python's lock, while this thread lets Python's signal handlers run and calls
/// `poll` (both with the lock, every 50 ms, and poll once more at the end). What a handler raises (KeyboardInterrupt) or `poll`
/// throws sets `stop`, and is thrown again when the work is over; so is what the work throws.
void runInterruptibly(StopFlag& stop, const std::function<void()>& work, const std::function<void()>& poll);

/// A diagnostic for Python: severity ("info", "warning", "error", "severe"), code (RISpec 3.2, 7.2), file, line, column (0:
/// unknown), message, hint, text (as the program prints it).
py::dict messageDict(const Diagnostic&);

/// Collects what is reported by any thread; Python gets it when this thread asks for it.
class Messages {
public:
    /// With nothing waiting.
    Messages();
    Diagnostics diagnostics; ///< where threads report
    /// Calls receiver(dict) for each message that has come since. What it raises passes through; later messages stay for the
    /// next call.
    void deliver(const py::object& receiver);

private:
    std::mutex mutex_;
    std::vector<Diagnostic> waiting_;
};

/// Adds the parts of the module.
void addRendering(py::module_&);
void addSession(py::module_&);
void addShading(py::module_&);

} // namespace alpenglow::python
