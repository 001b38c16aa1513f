#include "python/values.h"
#include "base/printable.h"
#include <cstring>
#include <fmt/format.h>

namespace alpenglow::python {
namespace {

constexpr int kDeepest = 32; // lists in lists

bool isNumber(const py::handle& h) { return PyFloat_Check(h.ptr()) || PyLong_Check(h.ptr()); }

/// numpy.float32 and its kin: numbers that are neither float nor int.
bool actsAsNumber(const py::handle& h) { return PyNumber_Check(h.ptr()) && !PySequence_Check(h.ptr()); }

double numberOf(const py::handle& h) {
    const double d = PyFloat_AsDouble(h.ptr());
    if (d == -1 && PyErr_Occurred()) throw py::error_already_set();
    return d;
}

bool isText(const py::handle& h) { return PyUnicode_Check(h.ptr()) || PyBytes_Check(h.ptr()); }

std::string textOf(const py::handle& h) { return py::cast<std::string>(h); }

template <class T> void numbersOf(const py::buffer_info& b, py::ssize_t dimension, const char* at, std::vector<double>& to) {
    if (dimension == b.ndim) {
        T v;
        std::memcpy(&v, at, sizeof v);
        to.push_back(double(v));
        return;
    }
    for (py::ssize_t i = 0; i < b.shape[size_t(dimension)]; ++i)
        numbersOf<T>(b, dimension + 1, at + i * b.strides[size_t(dimension)], to);
}

/// False: the memory holds something else than numbers.
bool takeBuffer(const py::buffer_info& b, std::vector<double>& to) {
    if (b.size > 0) to.reserve(to.size() + size_t(b.size));
    const char* at = static_cast<const char*>(b.ptr);
    std::string f = b.format;
    if (f.size() == 2 && (f[0] == '@' || f[0] == '=' || f[0] == '<')) f.erase(0, 1);
    if (f.size() != 1) return false;
    switch (f[0]) {
    case 'f':
        return numbersOf<float>(b, 0, at, to), true;
    case 'd':
        return numbersOf<double>(b, 0, at, to), true;
    case 'b':
        return numbersOf<int8_t>(b, 0, at, to), true;
    case 'B':
    case '?':
        return numbersOf<uint8_t>(b, 0, at, to), true;
    case 'h':
        return numbersOf<int16_t>(b, 0, at, to), true;
    case 'H':
        return numbersOf<uint16_t>(b, 0, at, to), true;
    case 'i':
        return numbersOf<int32_t>(b, 0, at, to), true;
    case 'I':
        return numbersOf<uint32_t>(b, 0, at, to), true;
    case 'l':
    case 'q':
        return numbersOf<int64_t>(b, 0, at, to), true;
    case 'L':
    case 'Q':
        return numbersOf<uint64_t>(b, 0, at, to), true;
    default:
        return false;
    }
}

[[noreturn]] void wrongType(const py::handle& h, const std::string& what) {
    throw Error(fmt::format("{}: takes numbers, strings and lists of them, not {}", what, Py_TYPE(h.ptr())->tp_name));
}

void flatten(const py::handle& h, const std::string& what, ri::Value& to, int depth) {
    using Kind = ri::Value::Kind;
    if (isText(h)) to.strings.push_back(textOf(h));
    else if (isNumber(h)) to.numbers.push_back(numberOf(h));
    else if (PyObject_CheckBuffer(h.ptr()) && takeBuffer(py::reinterpret_borrow<py::buffer>(h).request(), to.numbers)) {
    } else if (actsAsNumber(h)) to.numbers.push_back(numberOf(h));
    else if (!h.is_none() && !py::isinstance<py::dict>(h) && depth < kDeepest) {
        const auto iterator = py::reinterpret_steal<py::object>(PyObject_GetIter(h.ptr()));
        if (!iterator) {
            PyErr_Clear();
            wrongType(h, what);
        }
        while (const auto item = py::reinterpret_steal<py::object>(PyIter_Next(iterator.ptr())))
            flatten(item, what, to, depth + 1);
        if (PyErr_Occurred()) throw py::error_already_set();
    } else wrongType(h, what);
    if (!to.numbers.empty() && !to.strings.empty()) throw Error(what + ": a list has numbers or strings, not both");
    to.kind = !to.strings.empty() ? Kind::Strings : !to.numbers.empty() ? Kind::Numbers : Kind::Empty;
}

} // namespace

void addArgument(const py::handle& h, const std::string& what, std::vector<ri::Value>& to) {
    if (h.is_none()) return;
    ri::Value v;
    flatten(h, what, v, 0);
    v.array = !isText(h) && !isNumber(h) && !(actsAsNumber(h) && v.numbers.size() == 1);
    to.push_back(std::move(v));
}

void addParameters(const py::dict& parameters, const std::string& what, std::vector<ri::Value>& to) {
    for (const auto& [key, value] : parameters) {
        if (!isText(key)) throw Error(what + ": names of parameters are strings");
        ri::Value token;
        token.kind = ri::Value::Kind::Strings;
        token.strings = {textOf(key)};
        ri::Value v;
        flatten(value, fmt::format("{} \"{}\"", what, printable(token.strings[0])), v, 0);
        v.array = true;
        to.push_back(std::move(token));
        to.push_back(std::move(v));
    }
}

std::vector<float> boundOf(const py::handle& h) {
    ri::Value v;
    flatten(h, "bound", v, 0);
    if (v.numbers.size() != 6) throw Error("bound: takes six numbers, xmin xmax ymin ymax zmin zmax");
    std::vector<float> bound;
    for (const double d : v.numbers) bound.push_back(ri::toFloat(d));
    return bound;
}

} // namespace alpenglow::python
