// Archives that a scene is going to read, parsed by all threads before they are executed one by one in the order of the file.
// What is executed is the same with and without: an archive that has anything to say while it is parsed is left to the ordinary
// reader.
#pragma once
#include "ri/call.h"
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::ri {

/// The requests of a file, and where it ends.
struct ParsedArchive {
    std::vector<Call> calls; ///< in their order
    SourcePlace end;         ///< behind the last one, for messages
};

/// The requests of a file. Null: packed, more than some thousand, or there is something to say about them.
std::unique_ptr<ParsedArchive> parseArchive(const std::string& path);

/// Parses archives on other threads before the scene reads them.
class ReadAhead {
public:
    /// Notes the archives that a scene names, in order: those of ReadArchive and DelayedReadArchive in plain text. Forgets what
    /// was there.
    void scan(const std::string& sceneFile);
    /// The requests of the archive that the scene calls `name` and that was found at `path`. Null: it is to be read in the
    /// ordinary way.
    std::unique_ptr<ParsedArchive> take(const std::string& name, const std::string& path);

    /// Lets go of what was parsed and is not wanted yet.
    void forget() { parsed_.clear(); }

private:
    struct Ahead {
        std::string path;
        std::unique_ptr<ParsedArchive> archive;
    };
    void parseFrom(size_t first, const std::string& folder);
    std::vector<std::string> names_;
    size_t next_ = 0;                ///< the first that may still come
    std::map<size_t, Ahead> parsed_; ///< by place among names_
};

/// A line of a file for messages, at most 200 bytes; "" when there is none or it is not plain text.
std::string lineOfFile(const std::string& path, int line);

} // namespace alpenglow::ri
