// Numbers as text: the shortest decimals that read back as they were.
#pragma once
#include <string>

namespace alpenglow::ri {

/// What a reader of RIB gets of a float that is written as its shortest decimal: .1f is .1, which differs from .1f as a double.
/// Arguments of transformations are read in double (docs/design/ri.md): a program that means .1 and a file that says .1 make the
/// same picture when floats become numbers of requests by this. NaN and infinity stay.
double decimalOf(float);

/// Appends the shortest decimal that reads back as v. Integers have no point; nan, inf and -inf are written so, and the reader
/// names them.
void appendNumber(std::string& to, double v);
/// The same for a value of which only the nearest float counts: where v is a float, the shortest decimal that gives that float.
void appendAsFloat(std::string& to, double v);

} // namespace alpenglow::ri
