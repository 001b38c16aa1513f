// The files that a render reads: what `render --watch` waits for.
#pragma once
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace alpenglow {

/// Thread safe. A path keeps the state that its file had when it was first added, so that what changes while the render still
/// runs is noticed, and what the render itself wrote before it read it is not.
class ReadLog {
public:
    /// A file that is about to be read, or one that was looked for and is not there.
    void add(const std::string& path);
    /// For a name that was not found: the places where it would have been, one in each folder.
    void addMissing(const std::string& name, const std::vector<std::string>& folders);
    /// Whether any of the files is another now: its time or size changed, it went, or it came.
    bool changed() const;

private:
    using State = std::pair<int64_t, int64_t>; ///< nanoseconds since 1970 and bytes; {0, -1}: there is no such file
    static State stateOf(const std::string& path);
    mutable std::mutex mutex_;
    std::map<std::string, State> files_;
};

} // namespace alpenglow
