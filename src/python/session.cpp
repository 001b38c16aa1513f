#include "python/session.h"
#include "base/exact.h"
#include "python/pictures.h"
#include "python/values.h"
#include "ri/parser.h"
#include <cmath>
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <utility>

namespace alpenglow::python {

struct Session::Rendering {
    cli::RenderArguments arguments;
    MemoryWatcher watcher;
    render::Progress silent{render::ProgressMode::None};
    std::optional<render::Renderer> renderer;
    std::optional<ri::Interpreter> interpreter;
    bool memory = false;
    Rendering(cli::RenderArguments a, bool keep) : arguments(std::move(a)), watcher(true, keep) {}
};

namespace {

/// Which requests may take long: they render, read files or make maps.
bool mayTakeLong(const ri::Request& r) {
    return r.kind == ri::Kind::Texture || r.name == "WorldEnd" || r.name == "ReadArchive" || r.name == "Procedural" ||
           r.name == "FrameEnd";
}

} // namespace

/// One call: by one thread, and not while another one is at work for the session.
class Session::Use {
public:
    explicit Use(Session& s) : session_(s) {
        const auto me = std::this_thread::get_id();
        if (s.away_) throw Error("a request came while this context renders; it waits for that to end");
        if (s.depth_ > 0 && s.user_ != me)
            throw Error("another thread makes requests in this context; each needs one of its own");
        s.user_ = me;
        ++s.depth_;
    }
    ~Use() { --session_.depth_; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

private:
    Session& session_;
};

Session::Session(std::vector<std::string> flags, const std::string& script, bool keep, py::object message, py::object progress)
    : message_(std::move(message)), progress_(std::move(progress)), script_(script) {
    rendering_ = std::make_unique<Rendering>(renderArguments(std::move(flags)), keep);
    Rendering& r = *rendering_;
    r.arguments.settings.stop = &stop_;
    if (keep || !progress_.is_none()) r.arguments.settings.watcher = &r.watcher;
    r.renderer.emplace(r.arguments.settings, render::transportEngine(), messages_.diagnostics, r.silent);
    ri::ReaderOptions options = readerOptions(r.arguments, true);
    options.threads = false; // there is no file to look ahead in for archives
    options.overrides = [&r](scene::Options& o) { r.renderer->override(o); };
    r.interpreter.emplace(options, *r.renderer, messages_.diagnostics);
    r.renderer->setProcedurals([&r](const scene::Frame& f, std::span<const int> which) { return r.interpreter->make(f, which); });
    r.renderer->setScene(script, {});
    r.renderer->canBegin();
    for (const std::string& text : r.arguments.rib) r.interpreter->readStream(ri::memorySource(text), "rib");
    r.interpreter->readStream(ri::memorySource(""), script); // names the folder of the scene
    deliver();
}

Session::Session(const std::string& file, ri::RibFormat format, py::object message)
    : message_(std::move(message)), progress_(py::none()), script_(file) {
    std::string why;
    auto sink = file == "-" ? ri::descriptorSink(1) : ri::fileSink(file, &why);
    if (!sink) throw Error(fmt::format("{} cannot be written: {}", file, why));
    reporter_ = std::make_unique<ri::Reporter>(messages_.diagnostics);
    writer_ = std::make_unique<ri::RibWriter>(std::move(sink), format);
    writer_->structure("RenderMan RIB");
}

Session::~Session() {
    if (!rendering_) return;
    rendering_->interpreter.reset();
    rendering_->renderer.reset();
}

ri::Interpreter& Session::interpreter() { return *rendering_->interpreter; }

void Session::deliver() {
    messages_.deliver(message_);
    if (!rendering_) return;
    const auto latest = rendering_->watcher.latest();
    if (!latest || progress_.is_none()) return;
    if (const py::object answer = progress_(progressDict(*latest)); py::isinstance<py::bool_>(answer) && !answer.cast<bool>())
        stop_ = 1;
}

void Session::perform(bool isLong, const std::function<void()>& work) {
    const auto guarded = [&] {
        try {
            work();
        } catch (const std::bad_alloc&) {
            if (rendering_) rendering_->memory = true;
            messages_.diagnostics.report(Severity::Severe, Rie::NoMem, {script_}, "out of memory");
        }
    };
    if (isLong) {
        away_ = true;
        try {
            runInterruptibly(stop_, guarded, [this] { deliver(); });
        } catch (...) {
            away_ = false;
            throw;
        }
        away_ = false;
    } else {
        guarded();
        deliver();
    }
    if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
}

void Session::execute(const ri::Call& c) {
    if (writer_) writer_->write(c);
    else if (!interpreter().stopped()) interpreter().execute(c);
}

void Session::call(const std::string& name, const py::args& arguments, const py::object& parameters, const std::string& file,
                   int line) {
    const Use use(*this);
    ri::Call call;
    call.place = {file, line, 0};
    call.request = ri::findRequest(name);
    if (!call.request) throw Error("there is no request " + name);
    if (ended_) return fault(int(Rie::NotStarted), name + " after End", file, line);
    std::vector<ri::Value> values;
    for (const py::handle h : arguments) addArgument(h, name, values);
    if (!parameters.is_none()) addParameters(py::cast<py::dict>(parameters), name, values);
    for (ri::Value& v : values) v.line = line;
    ri::Reporter& reporter = writer_ ? *reporter_ : interpreter().reporter;
    if (ri::matchArguments(values, call, reporter)) perform(!writer_ && mayTakeLong(*call.request), [&] { execute(call); });
    else deliver();
}

void Session::procedural(const py::object& make, const py::object& boundGiven, const std::string& file, int line) {
    const Use use(*this);
    if (ended_) return fault(int(Rie::NotStarted), "Procedural after End", file, line);
    const std::vector<float> bound = boundOf(boundGiven);
    ri::Call by;
    by.place = {file, line, 0};
    by.request = ri::findRequest("Procedural");
    const auto run = [&](float detail) {
        try {
            make(detail);
        } catch (py::error_already_set& e) {
            messages_.diagnostics.report(Severity::Error, Rie::System, by.place,
                                         fmt::format("Procedural: the function raised {}", e.what()));
            raised_ = std::current_exception();
        }
    };
    if (writer_) {
        ri::Call block;
        block.request = ri::findRequest("AttributeBegin");
        writer_->write(block);
        run(1e38f);
        block.request = ri::findRequest("AttributeEnd");
        writer_->write(block);
    } else if (!interpreter().stopped()) {
        interpreter().subdivide(run, "Python", bound, by);
    }
    deliver();
    if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
}

void Session::readArchive(const std::string& name, const py::object& take, const std::string& file, int line) {
    const Use use(*this);
    if (ended_) return fault(int(Rie::NotStarted), "ReadArchive after End", file, line);
    ri::Call call;
    call.place = {file, line, 0};
    call.request = ri::findRequest("ReadArchive");
    call.arguments.resize(1);
    call.arguments[0] = {true, {}, {name}};
    if (writer_) return execute(call);
    std::vector<std::pair<std::string, std::string>> comments;
    interpreter().settings.comments = [&](const std::string& kind, const std::string& text) {
        const py::gil_scoped_acquire held;
        if (raised_) return;
        try {
            take(kind, text);
        } catch (py::error_already_set&) { raised_ = std::current_exception(); }
    };
    const auto quiet = [&] { interpreter().settings.comments = {}; };
    try {
        perform(true, [&] { execute(call); });
    } catch (...) {
        quiet();
        throw;
    }
    quiet();
}

void Session::record(const std::string& kind, const std::string& text, const std::string& file, int line) {
    const Use use(*this);
    if (ended_) return fault(int(Rie::NotStarted), "ArchiveRecord after End", file, line);
    if (kind != "comment" && kind != "structure" && kind != "verbatim")
        return fault(int(Rie::BadToken), fmt::format("ArchiveRecord: \"{}\" is no kind of record, which is left out", kind), file,
                     line);
    if (writer_) {
        if (kind == "comment") writer_->comment(text);
        else if (kind == "structure") writer_->structure(text);
        else writer_->verbatim(text);
        return;
    }
    if (kind != "verbatim") return; // comments have no effect
    ri::Call call;
    call.place = {file, line, 0};
    call.request = ri::findRequest("ArchiveRecord");
    perform(true, [&] {
        if (!interpreter().stopped()) interpreter().expand(text, call);
    });
}

py::object Session::transformPoints(const std::string& from, const std::string& to, const py::object& points) {
    const Use use(*this);
    if (!rendering_ || ended_) return py::none();
    const auto a = interpreter().namedSystem(from), b = interpreter().namedSystem(to);
    if (!a || !b) return py::none();
    std::vector<ri::Value> values;
    addArgument(points, "TransformPoints", values);
    const std::vector<double> numbers = values.empty() ? std::vector<double>{} : values[0].numbers;
    if (numbers.size() % 3) throw Error("TransformPoints: points have three numbers each");
    const Matrix m = a->first() * inverse(b->first());
    py::list out;
    for (size_t i = 0; i + 2 < numbers.size(); i += 3) {
        const Vec3d p = transformPoint(m, Vec3d(numbers[i], numbers[i + 1], numbers[i + 2]));
        for (const double d : {p.x, p.y, p.z}) out.append(double(ri::toFloat(d)));
    }
    return out;
}

void Session::end(const std::string& file, int line) {
    const Use use(*this);
    if (depth_ > 1) throw Error("End within a procedural");
    if (ended_) return fault(int(Rie::NotStarted), "End without Begin", file, line);
    ended_ = true;
    if (writer_) {
        const bool whole = writer_->finish();
        const std::string why = writer_->failure();
        writer_.reset();
        deliver();
        if (!whole) throw Error(fmt::format("{} could not be written: {}", script_, why));
        return;
    }
    perform(true, [&] {
        interpreter().finish({file, line, 0}); // closes what is open
        interpreter().endPrograms();
        rendering_->renderer->waitForFrames();
        rendering_->renderer->finish();
        rendering_->renderer->writeStats();
    });
    std::fflush(stdout); // what shaders printed
}

void Session::fault(int code, const std::string& message, const std::string& file, int line) {
    messages_.diagnostics.report(Severity::Error, Rie(code), {file, line, 0}, message);
    deliver();
}

py::list Session::pictures() { return rendering_ ? pictureList(rendering_->watcher.take()) : py::list(); }
std::string Session::stats() const { return rendering_ ? rendering_->renderer->statsText() : "{}"; }
int Session::status() const {
    if (!rendering_) return messages_.diagnostics.errors() ? 1 : 0;
    return statusOf(rendering_->renderer->outcome(), messages_.diagnostics, stop_, rendering_->memory);
}

void addSession(py::module_& m) {
    py::class_<Session>(m, "Session")
        .def(py::init<std::vector<std::string>, const std::string&, bool, py::object, py::object>(), py::arg("flags"),
             py::arg("script"), py::arg("keep"), py::arg("message"), py::arg("progress"))
        .def("call", [](Session& s, const std::string& request, const std::string& file, int line, const py::object& parameters,
                        const py::args& arguments) { s.call(request, arguments, parameters, file, line); })
        .def("procedural", &Session::procedural)
        .def("read_archive", &Session::readArchive)
        .def("record", &Session::record)
        .def("transform_points", &Session::transformPoints)
        .def("end", &Session::end)
        .def("fault", &Session::fault)
        .def("pictures", &Session::pictures)
        .def("stats", &Session::stats)
        .def("status", &Session::status)
        .def("set_message", &Session::setMessage)
        .def_property_readonly("writing", &Session::writing);
    m.def("rib_writer", [](const std::string& file, bool binary, bool gzip, int indentation, int columns, py::object message) {
        return std::make_unique<Session>(file, ri::RibFormat{binary, gzip, indentation, columns}, std::move(message));
    });
}

} // namespace alpenglow::python
