// The files that a render reads, for `render --watch`.
#pragma once
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace alpenglow {

/// Thread safe. Stores the state of each file when it was first added, so that changes during the render are noticed, but not
/// files that the render itself wrote before reading them.
class ReadLog {
public:
    /// A file that is about to be read, or one that was looked for and is not there.
    void add(const std::string& path);
    /// For a name that was not found: the places where it would have been, one in each folder.
    void addMissing(const std::string& name, const std::vector<std::string>& folders);
    /// Whether any of the files has changed: its time or size differs, it was removed, or created.
    bool changed() const;

private:
    using State = std::pair<int64_t, int64_t>; ///< nanoseconds since 1970 and bytes; {0, -1}: there is no such file
    static State stateOf(const std::string& path);
    mutable std::mutex mutex_;
    std::map<std::string, State> files_;
};

} // namespace alpenglow
