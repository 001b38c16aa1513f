// Ways to damage and to make input.
#pragma once
#include "fuzz.h"

namespace alpenglow::fuzz {

/// Some of: bytes flipped, set to extremes, taken out, doubled, cut off, exchanged with a part of another seed; numbers of two
/// and four bytes set to extremes in both byte orders.
Bytes mutateBytes(Random&, Bytes, const Seeds&);
/// The same on words: taken out, doubled, exchanged, replaced by a word of `words`, numbers by extremes, a run of words repeated
/// or spliced in from another seed; now and then a byte.
Bytes mutateText(Random&, const Bytes&, const Seeds&, const std::vector<std::string>& words);

/// Names, strings with their quotes, numbers, single signs, blanks as they are.
std::vector<std::string> wordsOf(const Bytes&);

/// An ASCII RIB stream in the binary encoding: some requests by code, numbers as integers, fixed point and floats, strings short,
/// long and defined.
Bytes binaryRib(Random&, const Bytes&);
Bytes gzipped(const Bytes&);
/// Right check sums of a PNG's chunks, of a part file's header and sums; files that are neither stay as they are.
Bytes repaired(Bytes);
/// Messages of the language server with lengths that are right.
Bytes framed(const std::vector<std::string>& messages);
/// The bodies of such a stream.
std::vector<std::string> messagesOf(const Bytes&);

/// Random requests with arguments of about the right form.
Bytes generateRib(Random&);
/// An expression of RSL with types that fit; `type`: "float", "color", "point", "vector", "normal", "string", "matrix".
std::string generateExpression(Random&, const std::string& type, int depth);
/// A whole shader whose types fit and whose loops end.
Bytes generateShader(Random&);

} // namespace alpenglow::fuzz
