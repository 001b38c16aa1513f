#include "python/pictures.h"
#include <memory>
#include <pybind11/numpy.h>

namespace alpenglow::python {

py::dict pictureDict(KeptPicture p) {
    py::dict d;
    d["name"] = p.name;
    d["type"] = p.type;
    d["frame"] = p.frame;
    d["size"] = py::make_tuple(p.width, p.height);
    d["window"] = py::make_tuple(p.window.x0, p.window.y0, p.window.x1, p.window.y1);
    d["pixel_aspect"] = p.pixelAspect;
    py::list variables, channels;
    for (const KeptPicture::Variable& v : p.variables) variables.append(py::make_tuple(v.name, v.first, v.count));
    for (const std::string& c : p.image.channels) channels.append(c);
    d["variables"] = variables;
    d["channels"] = channels;
    auto pixels = std::make_unique<std::vector<float>>(std::move(p.image.data));
    float* data = pixels->data();
    const py::capsule owner(pixels.release(), [](void* v) { delete static_cast<std::vector<float>*>(v); });
    const std::vector<py::ssize_t> shape{p.image.height, p.image.width, py::ssize_t(p.image.channels.size())};
    d["data"] = py::array_t<float>(shape, data, owner);
    return d;
}

py::list pictureList(std::vector<KeptPicture> pictures) {
    py::list all;
    for (KeptPicture& p : pictures) all.append(pictureDict(std::move(p)));
    return all;
}

py::dict progressDict(const MemoryWatcher::Progress& t) {
    py::dict d;
    d["fraction"] = t.state.fraction;
    d["samples"] = t.state.samplesDone;
    d["total"] = t.state.samplesTotal;
    d["noise"] = t.state.noise;
    d["rays_per_ms"] = t.state.raysPerMS;
    d["what"] = t.what;
    return d;
}

} // namespace alpenglow::python
