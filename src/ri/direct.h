// Requests of binary RIB read straight into a call: no tokens, no values to be matched, and no memory asked for where the call
// before had as much. Only what stands whole in the buffer, in the form that writers of RIB give it; everything else, and all
// that is wrong, is left to Lexer, Parser and matchArguments(), which say the same of it at a quarter of the speed.
#pragma once
#include "ri/call.h"
#include <cstddef>

namespace alpenglow::ri {

class Lexer;

/// What is read of a stream and not used yet, and where in its line a byte of it is.
struct Ahead {
    const char *p = nullptr, *end = nullptr; ///< next byte, and behind the last one that was read
    const char* mark = nullptr;              ///< a byte of the line that p is in, at or before p
    int line = 0, markColumn = 0;            ///< from 1; column of mark
    /// Of p.
    int column() const { return markColumn + int(p - mark); }
};

/// Fills calls of one stream. Not thread safe.
class DirectReader {
public:
    /// The arguments and parameters of call.request, from the lexer's place on, which moves behind them. False: the call holds
    /// parts of what was tried, the lexer stays, and the request is to be read in the general way.
    bool read(Lexer& lexer, Call& call);
    /// Gives a call that many arguments and parameters, with room that earlier ones had. What is in them is not defined.
    void resize(Call& call, size_t arguments, size_t params);

private:
    std::vector<Argument> arguments_; ///< spare ones
    std::vector<RawParam> params_;
};

} // namespace alpenglow::ri
