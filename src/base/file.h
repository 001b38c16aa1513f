// Files: the single interface for everything that the renderer writes (no writes outside of the permitted folders, no partial
// files), bounded reading of complete files, and lookup of names along search paths.
#pragma once
#include "base/diagnostics.h"
#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow {

/// Restricts where files may be written.
struct OutputPolicy {
    std::string root = ".";      ///< relative names are resolved against it
    bool allowWrite = false;     ///< --allow-write: any name is accepted, "-" is standard output
    int64_t failAfterBytes = -1; ///< fault injection for tests: the write beyond this many bytes fails like a full disk
};

/// The path for writing a file `name`. Without allowWrite it must be below the root, absolute or not, after resolving ".." and
/// symbolic links; names of Windows drives and hosts are outside. Rejects hidden names (".bashrc", ".git/config") and existing
/// files that are not pictures, maps or part files. Returns nothing after an error, which is reported.
std::optional<std::string> resolveOutputPath(const std::string& name, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});

/// An equal text for all names of one file that differ in "./", "..", folder links, or in being absolute. The last component is
/// not resolved, because writing a file replaces a link of its name.
std::string fileIdentity(const std::string& path);

/// A file under a temporary name in the folder of its target, renamed when complete. Until commit() succeeds the old file is
/// unchanged; the destructor removes the temporary file.
class OutputFile {
public:
    /// Resolves the name by the policy, makes missing folders below the root, opens the file. Returns nothing after an error,
    /// which is reported. Removes temporary files of killed processes from the folder. "-" with allowWrite is standard output,
    /// written by commit().
    static std::optional<OutputFile> open(const std::string& name, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});
    /// Whether such a file can be written now: opens it, writes a disk block and removes it; missing folders remain. Returns
    /// false after an error, which is reported.
    static bool canBeWritten(const std::string& name, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});
    /// Leaves an object that can only be destroyed.
    OutputFile(OutputFile&&) noexcept;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    /// Returns false after any write, read or seek has failed; commit() reports the reason.
    bool write(const void* bytes, size_t n);
    /// Returns the number of bytes read (for formats that patch their output).
    size_t read(void* bytes, size_t n);
    /// Sets the position of the next read or write, in bytes from the start. False as write().
    bool seek(uint64_t position);
    /// The current position, in bytes from the start.
    uint64_t tell();
    /// The bytes of the file so far; the position stays.
    uint64_t size();
    /// Whether nothing has failed so far.
    bool ok() const { return error_ == 0; }
    /// Flushes, syncs, renames. Returns false after an error, which is reported; the old file is then intact and the temporary
    /// file removed.
    bool commit(Diagnostics&);
    const std::string& path() const { return path_; } ///< final path

private:
    OutputFile() = default;
    void fail(int error);
    void report(Diagnostics&) const;
    void discard();
    static std::optional<OutputFile> openStandardOutput(Diagnostics&, const SourcePlace&);
    /// Copies file_ to standard output.
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

/// Reads a regular file of at most maxBytes. Returns nothing after an error, which is reported (NoFile if it does not exist).
std::optional<std::vector<uint8_t>> readWholeFile(const std::string& path, size_t maxBytes, Diagnostics&,
                                                  const SourcePlace& = {});

/// Folders of a search path, separated by ':' (or ';'; the colon of a drive letter does not separate). "@" is replaced by
/// `defaults`, "&" by `previous`; nothing else is expanded.
std::vector<std::string> splitSearchPath(const std::string& path, const std::vector<std::string>& defaults = {},
                                         const std::vector<std::string>& previous = {});

/// Result of a lookup, and how it differs from the name.
struct FoundFile {
    std::string path;          ///< where the file is
    bool otherCase = false;    ///< letters differ from the name on disk
    bool baseNameOnly = false; ///< the folders of the name were ignored
};
/// Finds a file: an absolute name as given, else below each folder in order ("" = the current folder). Backslashes count as
/// slashes. Then tries again without regard to case, then the base name only (absolute paths of other machines).
std::optional<FoundFile> findFile(const std::string& name, const std::vector<std::string>& directories);

/// Restricts files that scenes and shaders may read, after resolving links: a link may have come with the scene.
struct ReadPolicy {
    bool anywhere = true;               ///< --allow-read; or the user gave the name
    std::vector<std::string> folders{}; ///< readable folders, with their subfolders, in addition to the search path
    /// Called with each name before it is looked up, by any thread; may wait until the file is written. May be empty.
    std::function<void(const std::string& name)> before{};
};
/// The policy for a scene in this folder: includes the folder and its parent ("../textures" is common in old projects).
ReadPolicy readPolicyOf(const std::string& sceneFolder, bool anywhere);
/// Whether a path is below one of the folders, after resolving links in both.
bool liesBelow(const std::string& path, const std::vector<std::string>& folders);
/// As above, but files elsewhere count as missing; *outside is then their path, else "".
std::optional<FoundFile> findFile(const std::string& name, const std::vector<std::string>& directories, const ReadPolicy&,
                                  std::string* outside);
/// Message for an existing file that may not be read; what: "texture", "archive".
Diagnostic outsideMessage(const std::string& what, const std::string& name, const std::string& path, const SourcePlace&);

} // namespace alpenglow
