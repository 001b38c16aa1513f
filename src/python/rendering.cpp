// alpenglow.render(): scenes to pictures in memory.
#include "base/memory.h"
#include "cli/command.h"
#include "cli/modelscene.h"
#include "python/pictures.h"
#include "python/settings.h"
#include "ri/lookahead.h"
#include "ri/models/model.h"
#include <pybind11/stl.h>
#include <set>
#include <unistd.h>

namespace alpenglow::python {
namespace {

/// A file, or RIB itself.
struct Scene {
    std::string name;
    std::optional<std::string> text;
};

std::vector<Scene> scenesOf(const py::list& given) {
    std::vector<Scene> scenes;
    for (const py::handle h : given) {
        const auto t = py::cast<py::tuple>(h);
        scenes.push_back({py::cast<std::string>(t[0]), {}});
        if (!t[1].is_none()) scenes.back().text = py::cast<std::string>(py::cast<py::bytes>(t[1]));
    }
    return scenes;
}

void readScene(const Scene& s, ri::RibReader& reader, render::Renderer& renderer, const render::RenderSettings& settings,
               const ri::ReaderOptions& options) {
    reader.nextScene();
    if (s.text) {
        renderer.setScene(s.name, {});
        reader.readMemory(*s.text, s.name);
    } else if (ri::namedAsModel(s.name) && ::access(s.name.c_str(), R_OK) == 0) {
        renderer.setScene(s.name, {});
        reader.readMemory(cli::modelScene(s.name), s.name);
    } else {
        renderer.setScene(s.name, render::pictureOptions(settings).empty() ? std::set<std::string>{}
                                                                           : ri::picturesOfMakeRequests(s.name, options));
        reader.readFile(s.name);
    }
}

py::dict renderScenes(std::vector<std::string> flags, const py::list& given, bool write, const py::object& message,
                      const py::object& progress, const py::object& preview) {
    cli::RenderArguments a = renderArguments(std::move(flags));
    const std::vector<Scene> scenes = scenesOf(given);
    StopFlag stop;
    Messages messages;
    MemoryWatcher watcher(write, true, !preview.is_none());
    a.settings.stop = &stop;
    a.settings.watcher = &watcher;
    std::optional<MemoryLimit> limit;
    if (!a.memory.empty()) limit.emplace(a.settings.memoryLimit, a.settings.threads);
    render::Progress silent(render::ProgressMode::None);
    render::Renderer renderer(a.settings, render::transportEngine(), messages.diagnostics, silent);
    ri::ReaderOptions options = readerOptions(a, true);
    options.overrides = [&](scene::Options& o) { renderer.override(o); };
    bool memory = false;
    const auto work = [&] {
        if (!renderer.canBegin()) return;
        try {
            ri::RibReader reader(options, renderer, messages.diagnostics);
            renderer.setProcedurals(
                [&reader](const scene::Frame& f, std::span<const int> which) { return reader.make(f, which); });
            for (const std::string& r : a.rib) reader.readMemory(r, "rib");
            for (const Scene& s : scenes)
                if (!stop) readScene(s, reader, renderer, a.settings, options);
        } catch (const std::bad_alloc&) { memory = true; }
        renderer.waitForFrames();
        renderer.finish();
        renderer.writeStats();
    };
    bool ended = false;
    const auto poll = [&] {
        messages.deliver(message);
        if (auto picture = watcher.grown()) preview(pictureDict(std::move(*picture)));
        const auto latest = watcher.latest();
        if (!latest || progress.is_none() || ended) return;
        if (const py::object answer = progress(progressDict(*latest));
            py::isinstance<py::bool_>(answer) && !answer.cast<bool>()) {
            ended = true;
            stop = 1;
        }
    };
    py::object raised = py::none();
    try {
        runInterruptibly(stop, work, poll);
    } catch (py::error_already_set& e) { raised = e.value(); }
    std::fflush(stdout); // what shaders printed
    const bool interrupted = renderer.outcome().interrupted || stop;
    py::dict result;
    result["status"] = statusOf(renderer.outcome(), messages.diagnostics, interrupted, memory);
    result["rendered"] = renderer.outcome().rendered;
    result["pictures"] = pictureList(watcher.take());
    result["stats"] = renderer.statsText();
    result["raised"] = raised;
    return result;
}

} // namespace

void addRendering(py::module_& m) {
    m.def("render", &renderScenes, py::arg("flags"), py::arg("scenes"), py::arg("write"), py::arg("message"), py::arg("progress"),
          py::arg("preview"));
}

} // namespace alpenglow::python
