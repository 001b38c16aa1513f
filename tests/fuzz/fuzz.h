// The fuzz runner: damaged and generated input for everything that reads a stranger's bytes. One program, fuzz_alpenglow;
// scripts/fuzz builds and runs it. Input n of a target with a seed is always the same bytes.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace alpenglow::fuzz {

using Bytes = std::string;
using Seeds = std::vector<Bytes>;

/// splitmix64: the same numbers on every machine.
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    uint64_t next() {
        uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    /// 0 .. n-1; 0 when n is 0.
    size_t below(size_t n) { return n ? size_t(next() % n) : 0; }
    /// True once in n times.
    bool once(size_t n) { return below(n) == 0; }
    template <class List> const auto& of(const List& list) { return list[below(std::size(list))]; }

private:
    uint64_t state_;
};

/// What became of one input. From Hang on they are defects.
enum class Outcome : uint8_t {
    Ok,
    Refused, ///< an error was reported
    Slow,    ///< over the limit of processor time, but it ended when it was interrupted
    Hang,    ///< over the limit, and an interrupt did not end it
    Memory,  ///< over the limit of memory
    Crash,   ///< a signal or a sanitizer's report
    Status,  ///< an exit status that is not documented
    Mute,    ///< an exit status of failure and not a word about it
    Differs, ///< two runs that have to agree did not
    Count
};
const char* nameOf(Outcome);
inline bool defect(Outcome o) { return o >= Outcome::Hang; }

/// Something that reads bytes.
struct Target {
    std::string name, about;
    std::string extension;                             ///< of a saved input
    int cost = 1;                                      ///< the short check makes so many times fewer inputs of it
    bool loops = false;                                ///< an input may ask for endless work, so that an interrupt is a fair end
    std::function<Seeds()> seeds;                      ///< in addition to the corpus of its name
    std::function<Bytes(Random&, const Seeds&)> input; ///< a new input; there is at least one seed
    std::function<Outcome(const Bytes&)> run;          ///< in a process and a folder of its own
    bool caches = false; ///< compiled kernels are kept for the next inputs: where compiling is not what is tested
};
std::vector<Target> allTargets();

/// The seeds of a target: tests/fuzz/corpus/NAME and what its function gives. Sorted, so that numbers stay what they are.
Seeds seedsOf(const Target&);
/// The file, or "".
Bytes contentsOf(const std::string& path);
/// The files of a folder (and below) with one of the extensions, at most so many bytes each, in the order of their names.
Seeds filesOf(const std::string& folder, const std::vector<std::string>& extensions, size_t most = 16384);
/// A file of the checkout.
std::string source(const std::string& relative);

} // namespace alpenglow::fuzz
