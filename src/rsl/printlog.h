// What shaders print, in an order that no thread and no batch decides.
#pragma once
#include "base/limits.h"
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace alpenglow::rsl {

/// Where a message belongs: samples first, within a sample the pixels row by row, within a pixel the path from the camera on.
struct PrintKey {
    int64_t sample = -1;          ///< -1: before all samples (dicing)
    int32_t y = 0, x = 0;         ///< pixel
    int32_t bounces = 0;          ///< since the camera
    uint32_t vertex = 0;          ///< hash of the path to the point
    std::string program;          ///< file of the shader
    std::array<float, 3> place{}; ///< the point: shaders of lights run for several of one vertex
    /// Of the call in the shader: file, line and column. It orders nothing: messages of one run stay in their order.
    std::array<int32_t, 3> call{};
    /// Of a point that may be shaded more than once, as micropolygons are: its name, and PrintLog::newRun(). What it prints is
    /// kept of the first run that prints. 0: it is shaded once.
    uint64_t point = 0, run = 0;
};

/// Collects messages until flush(). Thread safe. Messages with equal keys come from one run of a shader and stay in their order.
class PrintLog {
public:
    /// Messages of one call at one point: a loop that prints would fill the disk. The others are counted.
    static constexpr size_t kOfOneCall = 10'000;
    /// To: the stream of flush(). most: bytes kept until then; further messages are counted.
    explicit PrintLog(std::FILE* to = stdout, size_t most = limits::kPrintBytes) : most_(most), to_(to) {}
    ~PrintLog() { flush(); }
    PrintLog(const PrintLog&) = delete;
    PrintLog& operator=(const PrintLog&) = delete;
    /// Keeps a copy. Beyond limits::kPrintBytes what was collected goes to a temporary file, sorted, and flush() merges. With
    /// more than limits::kPrintRuns of these, or no room for them, everything is written first: the order then holds within each
    /// part.
    void add(const PrintKey&, const std::string& text);
    uint64_t newRun() { return ++runsBegun_; } ///< a PrintKey::run that has not been used
    /// The same for what construct() prints, which runs once for a shader by the book and here in every run of its code: a text
    /// of one place (`where`, any name for it) is kept once, before all samples, and discard() does not forget it. Beyond
    /// limits::kPrintBytes of them no more are kept.
    void once(const std::string& where, const std::string& program, const std::string& text);
    /// Writes what was collected, sorted.
    void flush();
    /// Forgets it: the samples were void.
    void discard();
    /// Whether there is something to write, or to forget.
    bool pending();
    /// Goes on where another log ended: what that has kept by once() is not kept again. Nobody adds meanwhile.
    void goOn(PrintLog& before);

private:
    std::atomic<uint64_t> runsBegun_{0};
    std::unordered_map<uint64_t, uint64_t> runOf_; ///< by PrintKey::point
    struct Message {
        PrintKey key;
        std::string text;
        bool lasting = false;
    };
    struct CloseFile {
        void operator()(std::FILE* f) const { std::fclose(f); }
    };
    using Run = std::unique_ptr<std::FILE, CloseFile>;      ///< sorted messages in a file without a name
    using Counts = std::unordered_map<std::string, size_t>; ///< of one call at one point
    using Calls = std::map<std::array<int32_t, 3>, size_t>; ///< at one point
    static std::string nameOf(const PrintKey&);
    static bool before(const Message&, const Message&);
    static bool put(std::FILE*, const Message&);
    static bool get(std::FILE*, Message&);
    void sort();
    bool spill();
    void write();
    void writeRest(const Calls& written, PrintKey point);
    void keep(Message);
    std::vector<Run> runs_;
    size_t most_;
    std::mutex mutex_;
    std::vector<Message> messages_;
    Counts kept_;                                            ///< since the last run
    Counts lost_;                                            ///< that were too many to be kept
    std::set<std::pair<std::string, std::string>> reported_; ///< by once()
    size_t saidBytes_ = 0;
    size_t bytes_ = 0;
    std::FILE* to_;
};

} // namespace alpenglow::rsl
