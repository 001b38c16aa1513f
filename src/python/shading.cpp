// alpenglow.eval(), shade() and info(): RSL without a scene.
#include "base/installation.h"
#include "cli/command.h"
#include "cli/shaderdescription.h"
#include "python/python.h"
#include "python/shadearrays.h"
#include "ri/requests/request.h"
#include "rsl/evaluate.h"
#include "services/withoutscene.h"
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

namespace alpenglow::python {
namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

std::vector<std::string> shaderFolders(const std::vector<std::string>& own) {
    std::vector<std::string> paths{"."};
    paths.insert(paths.end(), own.begin(), own.end());
    for (std::string& f : cli::environmentShaders()) paths.push_back(std::move(f));
    if (std::string s = shippedShaders(); !s.empty()) paths.push_back(std::move(s));
    return paths;
}

rsl::ShaderCompiler::Settings compilerSettings(const std::string& dialect, bool allowExec,
                                               const std::vector<std::string>& paths) {
    rsl::ShaderCompiler::Settings s;
    s.allowExec = allowExec;
    s.dialect = dialect;
    s.pluginPaths = paths;
    return s;
}

py::dict evaluateOne(const std::string& expression, const std::string& setup, int lanes, const std::string& dialect,
                     bool allowExec, const py::object& message) {
    Messages messages;
    rsl::Evaluation e;
    {
        const py::gil_scoped_release released;
        rsl::ShaderCompiler compiler(compilerSettings(dialect, allowExec, shaderFolders({})));
        rsl::KernelOptions options;
        options.lanes = lanes;
        services::WithoutScene services({"."}, messages.diagnostics);
        const Vec3 point;
        services.setPoints({0, 0, -1}, {&point, 1});
        e = rsl::evaluate(compiler, setup, expression, options, messages.diagnostics,
                          [&](const rsl::CompiledKernel& k, int32_t site, int32_t first, uint64_t mask, int32_t width,
                              const float* in, float* out) { return services.answer(k, site, first, mask, width, in, out); });
    }
    messages.deliver(message);
    py::dict d;
    d["ok"] = e.ok;
    d["type"] = e.ok ? shadeops::toString(e.type) : "";
    d["numbers"] = e.numbers;
    d["text"] = e.text;
    d["printed"] = e.printed;
    return d;
}

/// value: (numbers: float array of one or two dimensions, each: bool).
PointRows rowsOf(const py::handle& value) {
    const auto t = py::cast<py::tuple>(value);
    const auto numbers = Floats::ensure(t[0]);
    if (!numbers) throw py::error_already_set();
    PointRows r;
    r.each = py::cast<bool>(t[1]);
    r.width = r.each ? (numbers.ndim() > 1 ? int(numbers.shape(1)) : 1) : int(numbers.size());
    r.numbers.assign(numbers.data(), numbers.data() + numbers.size());
    return r;
}

std::map<std::string, PointRows> rowsByName(const py::dict& d) {
    std::map<std::string, PointRows> rows;
    for (const auto& [name, value] : d) rows.emplace(py::cast<std::string>(name), rowsOf(value));
    return rows;
}

py::dict arraysOf(std::vector<ShadeOutput> outputs, size_t points) {
    py::dict d;
    for (ShadeOutput& o : outputs) {
        auto numbers = std::make_unique<std::vector<float>>(std::move(o.numbers));
        float* data = numbers->data();
        const py::capsule owner(numbers.release(), [](void* v) { delete static_cast<std::vector<float>*>(v); });
        d[py::str(o.name)] = py::array_t<float>(std::vector<py::ssize_t>{py::ssize_t(points), o.width}, data, owner);
    }
    return d;
}

py::dict shade(const std::string& name, const std::string& text, const std::string& kind, size_t points,
               const py::dict& variables, const py::dict& parameters, std::map<std::string, std::string> strings,
               std::vector<std::string> outputs, const std::vector<std::string>& searchPaths, int lanes,
               const std::string& dialect, bool allowExec, const py::object& message) {
    ShadeRequest r{points,   rowsByName(variables), rowsByName(parameters), std::move(strings), std::move(outputs), {"."}, lanes,
                   allowExec};
    r.searchPaths.insert(r.searchPaths.end(), searchPaths.begin(), searchPaths.end());
    Messages messages;
    std::vector<ShadeOutput> made;
    {
        const py::gil_scoped_release released;
        const std::vector<std::string> paths = shaderFolders(searchPaths);
        rsl::ShaderCompiler compiler(compilerSettings(dialect, allowExec, paths));
        auto shader =
            text.empty() ? compiler.load(name, paths, messages.diagnostics) : compiler.loadText(text, name, messages.diagnostics);
        if (shader && !kind.empty()) {
            std::shared_ptr<const rsl::CompiledShader> wanted;
            for (const auto& s : shader->program().shaders)
                if (s->name == shader->name() && kind == rsl::toString(s->kind))
                    wanted = rsl::ShaderCompiler::variant(shader, s->kind);
            if (!wanted) messages.diagnostics.report(Severity::Error, Rie::BadToken, {name}, "it is no " + kind + " shader");
            shader = wanted;
        }
        if (shader) made = shadeArrays(compiler, shader, r, messages.diagnostics);
    }
    std::fflush(stdout); // what it printed
    messages.deliver(message);
    return arraysOf(std::move(made), points);
}

std::string describeShader(const std::string& name, const std::vector<std::string>& searchPaths, const std::string& dialect,
                           bool allowExec, const py::object& message) {
    Messages messages;
    std::string json;
    {
        const py::gil_scoped_release released;
        const std::vector<std::string> paths = shaderFolders(searchPaths);
        rsl::ShaderCompiler compiler(compilerSettings(dialect, allowExec, paths));
        if (const auto shader = compiler.load(name, paths, messages.diagnostics))
            json = cli::descriptionJson(cli::describe(compiler, shader, messages.diagnostics))
                       .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    }
    messages.deliver(message);
    return json;
}

py::list requests() {
    py::list all;
    for (const ri::Request& r : ri::requestTable()) {
        py::list arguments;
        for (const ri::ArgSpec& a : r.args) {
            using Form = ri::ArgSpec::Form;
            const char* form = a.form == Form::Int      ? "int"
                               : a.form == Form::String ? "string"
                               : a.form == Form::Handle ? "handle"
                               : a.form == Form::Basis  ? "basis"
                                                        : "number";
            arguments.append(py::make_tuple(a.name, form, a.array ? 0 : a.count, a.optional));
        }
        py::dict d;
        d["name"] = std::string(r.name);
        d["kind"] = ri::toString(r.kind);
        d["signature"] = std::string(r.signature);
        d["doc"] = std::string(r.doc);
        d["sample"] = std::string(r.sample);
        d["arguments"] = arguments;
        d["parameters"] = r.parameters;
        all.append(d);
    }
    return all;
}

} // namespace

void addShading(py::module_& m) {
    m.def("evaluate", &evaluateOne);
    m.def("shade", &shade);
    m.def("info", &describeShader);
    m.def("requests", &requests);
    m.def("shader_folders", &shaderFolders);
}

} // namespace alpenglow::python
