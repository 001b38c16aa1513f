// Words that shaders borrow from C, or from one of the compilers: bool, int, integer, true, false.
#pragma once
#include "rsl/front/preprocessor.h"

namespace alpenglow::rsl::front {

/// '#' behind other words of a line: the rest of the line is a comment, with a warning. No directive can begin there.
void hashComments(SourceSet&, Preprocessed&);

/// Where a type stands, bool, int and integer become float, with a warning for each word; true and false become 1 and 0 unless
/// the text gives them another meaning. Numbers are not rounded.
void readBorrowedWords(SourceSet&, Preprocessed&);

/// Gives light shaders Ps for P (dialectLitPoint()).
void readLitPoints(Preprocessed&);

/// Behind the bracket that closes the one at `open`; the end of the text if there is none.
size_t behind(const std::vector<Token>&, size_t open);

} // namespace alpenglow::rsl::front
