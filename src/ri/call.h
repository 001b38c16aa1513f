// A request as read: its arguments matched to its signature, its parameter list not yet typed.
#pragma once
#include "base/diagnostics.h"
#include <string>
#include <vector>

namespace alpenglow::ri {

struct Request;

/// Consecutive bare numbers, one bare string, or one bracketed array.
struct Value {
    enum class Kind { Empty /* [ ] */, Numbers, Strings };
    Kind kind = Kind::Empty; ///< of the contents
    bool array = false;
    int line = 0, column = 0; ///< of the first byte, from 1
    std::vector<double> numbers;
    std::vector<std::string> strings; ///< of Strings
};

/// One argument of a signature; `given` is false for an optional one that was left out.
struct Argument {
    bool given = false;
    std::vector<double> numbers;      ///< of a number, or an array of them
    std::vector<std::string> strings; ///< of a text, a handle, or an array of them
};

/// "token" value, before declarations are looked up.
struct RawParam {
    std::string token;
    Value value;
    int line = 0, column = 0; ///< of the token, from 1
};

/// A request with its arguments. Accessors take the index of an entry of the signature; the argument must be given and have
/// that type, which matchArguments() ensures.
struct Call {
    const Request* request = nullptr;
    std::vector<Argument> arguments; ///< one per entry of the signature
    std::vector<RawParam> params;    ///< in their order
    SourcePlace place;               ///< of the request

    /// Whether an argument was given; its first or k-th number; its text; all its numbers and texts.
    bool given(size_t i) const { return i < arguments.size() && arguments[i].given; }
    double number(size_t i, size_t k = 0) const { return arguments[i].numbers[k]; }
    float real(size_t i, size_t k = 0) const;                            ///< as float, clamped to +-3.4e38
    int integer(size_t i) const { return int(arguments[i].numbers[0]); } ///< matched: whole and in range
    /// The text of an argument, or all its numbers and texts.
    const std::string& text(size_t i) const { return arguments[i].strings[0]; }
    const std::vector<double>& numbers(size_t i) const { return arguments[i].numbers; }
    const std::vector<std::string>& strings(size_t i) const { return arguments[i].strings; }
    std::vector<float> reals(size_t i) const; ///< as floats, clamped to +-3.4e38
    std::vector<int> ints(size_t i) const;    ///< matched: whole and in range
    /// Place of a parameter's token.
    SourcePlace at(const RawParam& p) const { return {place.file, p.line, p.column}; }
};

/// d as float; beyond the range of float the nearest finite one. NaN and infinity stay.
float toFloat(double d);
std::vector<float> toFloats(const std::vector<double>& d); ///< each of them

} // namespace alpenglow::ri
