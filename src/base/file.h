// Files: the one door for everything the renderer writes (reliability: no write outside what was asked for, no torn files),
// bounded reading of whole files, and looking names up along search paths.
#pragma once
#include "base/diagnostics.h"
#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow {

/// Where files may be written.
struct OutputPolicy {
    std::string root = ".";      ///< relative names are below it
    bool allowWrite = false;     ///< --allow-write: any name is taken as it is, "-" is standard output
    int64_t failAfterBytes = -1; ///< fault injection for tests: the write that passes this many bytes fails as a full disk
};

/// The path that a file called `name` will be written to. Without allowWrite it must lie below the root, whether the name is
/// absolute or not and wherever ".." and symbolic links in it lead; names of Windows drives and hosts lie outside. Hidden names
/// (".bashrc", ".git/config") and files that are there and are no pictures, maps or part files are refused as well. Nothing: an
/// error was reported.
std::optional<std::string> resolveOutputPath(const std::string& name, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});

/// The same text for all names of one file that differ in "./", "..", links of folders, or in being absolute. The last part is
/// taken as it is, because a file that is written replaces a link of its name.
std::string fileIdentity(const std::string& path);

/// A file under a temporary name in the directory of its target, renamed to it when whole. Until commit() succeeds the old
/// file stays as it is; the destructor removes the temporary.
class OutputFile {
public:
    /// Resolves the name by the policy, makes missing directories below the root, opens. Nothing: an error was reported.
    /// Temporaries that killed processes left in the folder are removed. "-" under allowWrite is standard output: commit()
    /// sends all.
    static std::optional<OutputFile> open(const std::string& name, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});
    /// Whether such a file can be written now: opens it, writes a block of the disk and leaves no trace but missing directories.
    /// False: an error was reported.
    static bool canBeWritten(const std::string& name, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});
    OutputFile(OutputFile&&) noexcept;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    /// False once any write, read or seek has failed; the reason is kept for commit().
    bool write(const void* bytes, size_t n);
    /// Number of bytes read (for formats that patch what they wrote).
    size_t read(void* bytes, size_t n);
    bool seek(uint64_t position);
    uint64_t tell();
    uint64_t size();
    bool ok() const { return error_ == 0; }
    /// Flushes, syncs, renames. False: an error was reported, the old file is intact, the temporary gone.
    bool commit(Diagnostics&);
    const std::string& path() const { return path_; } ///< where it will be

private:
    OutputFile() = default;
    void fail(int error);
    void report(Diagnostics&) const;
    void discard();
    static std::optional<OutputFile> openStandardOutput(Diagnostics&, const SourcePlace&);
    /// The whole of file_ to standard output.
    void copyOut();
    std::FILE* file_ = nullptr;
    std::string path_, temporary_;
    bool standardOutput_ = false; ///< file_ is in memory
    SourcePlace place_;
    int64_t failAfter_ = -1;
    uint64_t written_ = 0;
    int error_ = 0; ///< errno of the first failure
    bool lastWasRead_ = false;
};

/// The whole of a regular file of at most maxBytes. Nothing: an error was reported (NoFile when it is not there).
std::optional<std::vector<uint8_t>> readWholeFile(const std::string& path, size_t maxBytes, Diagnostics&,
                                                  const SourcePlace& = {});

/// Directories of a search path: separated by ':' (or ';'; a drive letter's colon does not separate). "@" stands for
/// `defaults`, "&" for `previous`; nothing else is expanded.
std::vector<std::string> splitSearchPath(const std::string& path, const std::vector<std::string>& defaults = {},
                                         const std::vector<std::string>& previous = {});

/// How a name was found, when not simply.
struct FoundFile {
    std::string path;
    bool otherCase = false;    ///< letters differ from the name on disk
    bool baseNameOnly = false; ///< the directories of the name were dropped
};
/// Looks for a name: as it is when absolute, else below each directory in order ("" = the working directory). Backslashes count
/// as slashes. Then again without regard to case, then the base name alone (absolute paths of other machines).
std::optional<FoundFile> findFile(const std::string& name, const std::vector<std::string>& directories);

/// Where names that a scene or a shader gives may lead, once links are followed: a link may have come with the scene.
struct ReadPolicy {
    bool anywhere = true;               ///< --allow-read; or the user gave the name
    std::vector<std::string> folders{}; ///< what is below them may be read, beside what is below the folders that are searched
    /// Called with each name before it is looked for, by any thread; may wait until the file is written. May be empty.
    std::function<void(const std::string& name)> before{};
};
/// The policy of a scene in this folder: below it, and below the folder that holds it ("../textures" is how old projects lie).
ReadPolicy readPolicyOf(const std::string& sceneFolder, bool anywhere);
/// Whether a path leads to something below one of the folders, once the links in both are followed.
bool liesBelow(const std::string& path, const std::vector<std::string>& folders);
/// As above, but what lies elsewhere counts as missing; *outside is then its path, else "".
std::optional<FoundFile> findFile(const std::string& name, const std::vector<std::string>& directories, const ReadPolicy&,
                                  std::string* outside);
/// The message about a file that is there and may not be read; what: "texture", "archive".
Diagnostic outsideMessage(const std::string& what, const std::string& name, const std::string& path, const SourcePlace&);

} // namespace alpenglow
