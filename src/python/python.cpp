#include "python/python.h"
#include <chrono>
#include <condition_variable>
#include <exception>
#include <thread>

namespace alpenglow::python {
namespace {

using namespace std::chrono_literals;

const char* nameOf(Severity s) {
    switch (s) {
    case Severity::Info:
        return "info";
    case Severity::Warning:
        return "warning";
    case Severity::Error:
        return "error";
    case Severity::Severe:
        break;
    }
    return "severe";
}

/// What the two threads of runInterruptibly() tell each other.
struct Meeting {
    std::mutex mutex;
    std::condition_variable changed;
    bool over = false;
    std::exception_ptr failure;
};

} // namespace

void runInterruptibly(StopFlag& stop, const std::function<void()>& work, const std::function<void()>& poll) {
    std::exception_ptr raised;
    const auto look = [&](bool signals) {
        try {
            if (signals && PyErr_CheckSignals() != 0) throw py::error_already_set();
            poll();
        } catch (...) {
            if (!raised) raised = std::current_exception();
            stop = 1;
        }
    };
    Meeting met;
    {
        const py::gil_scoped_release released;
        std::thread worker([&] {
            try {
                work();
            } catch (...) { met.failure = std::current_exception(); }
            const std::lock_guard lock(met.mutex);
            met.over = true;
            met.changed.notify_one();
        });
        for (std::unique_lock lock(met.mutex); !met.over;) {
            if (met.changed.wait_for(lock, 50ms, [&] { return met.over; })) break;
            lock.unlock();
            {
                const py::gil_scoped_acquire held;
                look(true);
            }
            lock.lock();
        }
        worker.join();
    }
    look(false);
    if (raised) std::rethrow_exception(raised);
    if (met.failure) std::rethrow_exception(met.failure);
}

py::dict messageDict(const Diagnostic& d) {
    py::dict m;
    const auto text = [](const std::string& s) { // names of files are bytes
        return py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(s.data(), Py_ssize_t(s.size()), "replace"));
    };
    m["severity"] = nameOf(d.severity);
    m["code"] = int(d.code);
    m["file"] = text(d.place.file);
    m["line"] = d.place.line;
    m["column"] = d.place.column;
    m["message"] = text(d.message);
    m["hint"] = text(d.hint);
    m["text"] = text(toString(d));
    m["always"] = d.always;
    return m;
}

Messages::Messages()
    : diagnostics([this](const Diagnostic& d) {
          const std::lock_guard lock(mutex_);
          waiting_.push_back(d);
      }) {}

void Messages::deliver(const py::object& receiver) {
    std::vector<Diagnostic> now;
    {
        const std::lock_guard lock(mutex_);
        now.swap(waiting_);
    }
    for (size_t i = 0; i < now.size(); ++i) try {
            receiver(messageDict(now[i]));
        } catch (...) {
            const std::lock_guard lock(mutex_);
            waiting_.insert(waiting_.begin(), now.begin() + long(i) + 1, now.end());
            throw;
        }
}

} // namespace alpenglow::python
