// The RenderMan Interface called from Python: requests one by one, to the renderer or to a RIB file.
#pragma once
#include "python/memorywatcher.h"
#include "python/python.h"
#include "python/settings.h"
#include "ri/interpreter.h"
#include "ri/writer.h"
#include <optional>
#include <thread>

namespace alpenglow::python {

/// From RiBegin to RiEnd. One thread at a time; requests of another one, or while a frame is rendered, are an Error.
class Session {
public:
    /// Renders. flags: of `alpenglow render`. script: the file that calls; archives, shaders and maps are looked for next to it,
    /// too. keep: pictures are kept for pictures(). progress: called with progressDict(), or None.
    Session(std::vector<std::string> flags, const std::string& script, bool keep, py::object message, py::object progress);
    /// Writes RIB to a file, or to standard output ("-").
    Session(const std::string& file, ri::RibFormat, py::object message);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// One request. arguments: those of its RIB form in order; parameters: a dictionary, or None. Faults are reported as the
    /// reader reports them, at file:line. Renders when it is a WorldEnd.
    void call(const std::string& request, const py::args& arguments, const py::object& parameters, const std::string& file,
              int line);
    /// Procedural by a function of Python, at once: make(detail), with the graphics state saved before and restored after.
    void procedural(const py::object& make, const py::object& bound, const std::string& file, int line);
    /// ReadArchive, whose comments go to heard(kind, text).
    void readArchive(const std::string& name, const py::object& take, const std::string& file, int line);
    /// RiArchiveRecord: "comment", "structure" and "verbatim".
    void record(const std::string& kind, const std::string& text, const std::string& file, int line);
    /// RiTransformPoints: n points of three numbers each, from one space to another; None where one is not known.
    py::object transformPoints(const std::string& from, const std::string& to, const py::object& points);
    /// Closes what is open and ends; further requests are errors.
    void end(const std::string& file, int line);
    /// Reports a fault of the caller.
    void fault(int code, const std::string& message, const std::string& file, int line);

    /// The pictures kept since the last call, as pictureDict() has them; empty when RIB is written.
    py::list pictures();
    /// Figures of the last frame as JSON (docs/statistics.md); "{}" where there are none.
    std::string stats() const;
    /// As the exit status of `alpenglow render`.
    int status() const;
    /// RIB is written; nothing is rendered.
    bool writing() const { return rendering_ == nullptr; }
    /// Sets what is called with each message; None: they are dropped.
    void setMessage(py::object m) { message_ = std::move(m); }

private:
    struct Rendering; // what only a session that renders has
    class Use;
    ri::Interpreter& interpreter();
    /// Does `work` on the interpreter: here, or in a thread of its own where it can take long.
    void perform(bool isLong, const std::function<void()>& work);
    void deliver();
    void execute(const ri::Call&);
    Messages messages_;
    py::object message_, progress_;
    StopFlag stop_;
    std::unique_ptr<Rendering> rendering_; ///< null: RIB is written
    std::unique_ptr<ri::RibWriter> writer_;
    std::unique_ptr<ri::Reporter> reporter_; ///< of a session that writes
    std::string script_;
    std::thread::id user_; ///< the thread that is in here
    int depth_ = 0;        ///< how deep: procedurals call requests
    bool away_ = false;    ///< another thread is at work for it
    bool ended_ = false;
    std::exception_ptr raised_; ///< by Python within the interpreter
};

} // namespace alpenglow::python
