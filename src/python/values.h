// Values of Python as arguments of requests.
#pragma once
#include "python/python.h"
#include "ri/call.h"

namespace alpenglow::python {

/// Appends one argument: a number or a string as it is, else an array: of a list, a tuple, anything that is iterated over, or
/// what has numbers in memory (NumPy, array, memoryview); what is nested is flattened, row after row. None appends nothing. what:
/// for messages, "Sphere". Throws Error where there are neither numbers nor strings, or both.
void addArgument(const py::handle&, const std::string& what, std::vector<ri::Value>& to);
/// Appends the parameters of a dictionary, each a token and an array.
void addParameters(const py::dict&, const std::string& what, std::vector<ri::Value>& to);
/// Six numbers.
std::vector<float> boundOf(const py::handle&);

} // namespace alpenglow::python
