// The extension module _alpenglow, behind the package python/alpenglow. Names in it may change; the package is what lasts.
#include "cli/version.h"
#include "python/python.h"
#include <pybind11/stl.h>

PYBIND11_MODULE(_alpenglow, m) {
    using namespace alpenglow::python;
    py::register_exception<Error>(m, "Error", PyExc_RuntimeError);
    m.def("software", &alpenglow::cli::softwareName);
    addRendering(m);
    addSession(m);
    addShading(m);
}
