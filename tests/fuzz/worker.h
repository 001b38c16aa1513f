// Inputs run in child processes, which are watched: their time, their memory, how they end.
#pragma once
#include "fuzz.h"
#include <array>

namespace alpenglow::fuzz {

struct Limits {
    double processorSeconds = 10;    ///< of one input
    double stallSeconds = 60;        ///< on the wall without any work: it waits for what does not come
    double graceSeconds = 5;         ///< of processor time after an interrupt
    size_t memory = size_t(2) << 30; ///< resident bytes of a child
};

struct Verdict {
    Outcome outcome = Outcome::Ok;
    std::string signature; ///< the same for the same defect, as far as that is known
    std::string messages;  ///< the end of what the input made the program say
};

/// One input in a child of its own.
Verdict runAlone(const Target&, const Bytes&, const Limits&);

/// Where an input comes from, by its number.
using Source = std::function<Bytes(size_t)>;
struct Tally {
    std::array<size_t, size_t(Outcome::Count)> count{};
    size_t runs = 0;
};
/// Inputs first, first+1, ... of `source` in children of many inputs each, until `last` or until the clock (seconds since the
/// program began) reaches `end`. Of each that is not Ok or Refused `found` is called, with its number.
Tally runMany(const Target&, const Source&, size_t first, size_t last, double end, const Limits&,
              const std::function<void(size_t, const Verdict&)>& found);

/// Makes files in a folder in a child process (so that this one never has threads) and reads them.
Seeds madeInChild(const std::function<void()>& make, const std::vector<std::string>& extensions);

/// Standard output of the running input so far; for targets that compare.
std::string outputSoFar();
/// Empties it.
void clearOutput();
/// Whether the running input has written anything to standard error or standard output.
bool saidAnything();

/// Seconds since the program began.
double clockSeconds();
/// Whether AddressSanitizer is built in.
constexpr bool kSanitized =
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
    true;
#else
    false;
#endif
#else
    false;
#endif

} // namespace alpenglow::fuzz
