#include "base/file.h"
#include "base/digest.h"
#include "base/folder.h"
#include "base/limits.h"
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <string_view>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace alpenglow {
namespace {

bool isSeparator(char c) { return c == '/' || c == '\\'; }

bool hasDrive(const std::string& s) {
    return s.size() >= 3 && std::isalpha((unsigned char)s[0]) && s[1] == ':' && isSeparator(s[2]);
}

std::string baseName(const std::string& s) {
    size_t p = s.find_last_of("/\\");
    return p == std::string::npos ? s : s.substr(p + 1);
}

bool climbs(const std::string& s) {
    for (size_t i = 0; i <= s.size();) {
        size_t j = i;
        while (j < s.size() && !isSeparator(s[j])) ++j;
        if (j - i == 2 && s[i] == '.' && s[i + 1] == '.') return true;
        i = j + 1;
    }
    return false;
}

/// Whether a path below root stays there after resolving symbolic links.
bool staysBelow(const fs::path& root, const fs::path& path) {
    std::error_code e;
    fs::path r = fs::weakly_canonical(root, e);
    if (e) return false;
    fs::path p = fs::weakly_canonical(path.parent_path(), e);
    if (e) return false;
    auto m = std::mismatch(r.begin(), r.end(), p.begin(), p.end());
    return m.first == r.end() || m.first->empty(); // a trailing slash leaves an empty component
}

bool isRegular(const fs::path& p) {
    std::error_code e;
    return fs::is_regular_file(p, e);
}

/// Whether a component of a path is hidden: ".ssh", "a/.git/config". Excludes "." and "..".
bool hidden(const std::string& s) {
    for (size_t i = 0; i <= s.size();) {
        size_t j = i;
        while (j < s.size() && !isSeparator(s[j])) ++j;
        if (j - i >= 2 && s[i] == '.' && !(j - i == 2 && s[i + 1] == '.')) return true;
        i = j + 1;
    }
    return false;
}

/// Whether a scene may replace an existing file: one of a kind that the renderer writes, by its first bytes, or an empty one.
/// Scenes, shaders, programs and notes are protected.
bool replaceable(const fs::path& p) {
    using namespace std::string_view_literals;
    constexpr std::string_view kKnown[] = {
        "II*\0"sv,
        "MM\0*"sv,
        "II+\0"sv,
        "MM\0+"sv, // TIFF, BigTIFF
        "\x76\x2f\x31\x01"sv,
        "\x89PNG"sv,
        "\xff\xd8\xff"sv,
        "#?"sv, // OpenEXR, PNG, JPEG, Radiance
        "\x2f\x08\x67\xab"sv,
        "\xab\x67\x08\x2f"sv, // zfile
        "\xfa\xce"sv,
        "\xce\xfa"sv, // Pixar's maps
        "ALPGPART"sv,
        "ALPGPHOT"sv,
        "ALPGCLOU"sv,
        "ALPGBRIC"sv,
        "# bake 1"sv,
        "ALPGBAKE"sv,
        "ply\nformat binary_little_endian 1.0\ncomment point cloud of Alpenglow\n"sv}; // baked by shaders
    if (!isRegular(p)) return true;                                                    // nothing, or open() reports it
    int fd = ::open(p.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return errno == ENOENT;
    char head[80];
    ssize_t n = ::read(fd, head, sizeof head);
    ::close(fd);
    if (n <= 0) return n == 0;
    const std::string_view have(head, size_t(n));
    return std::any_of(std::begin(kKnown), std::end(kKnown), [&](std::string_view k) { return have.substr(0, k.size()) == k; });
}

constexpr const char* kTemporary = ".alpenglow-";

/// Eight digits for this machine and process namespace: in a folder shared by machines a process number is not unique.
std::string machineName() {
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    char space[64] = "";
    [[maybe_unused]] ssize_t n = readlink("/proc/self/ns/pid", space, sizeof space - 1);
    return digestText(digest(std::string(host) + space)).substr(0, 8);
}

/// Removes temporary files of killed renders from a folder: those of ended processes of this machine, and any older than a day.
void removeAbandoned(const fs::path& dir) {
    constexpr auto kOld = std::chrono::hours(24);
    const std::string mine = kTemporary + machineName() + "-";
    for (const std::string& name : namesIn(dir.string(), limits::kFolderEntries)) {
        if (!name.starts_with(kTemporary) || !name.ends_with(".tmp")) continue;
        std::error_code unknown;
        const fs::path path = dir / name;
        if (fs::symlink_status(path, unknown).type() != fs::file_type::regular || unknown) continue;
        const long process = name.starts_with(mine) ? std::strtol(name.c_str() + mine.size(), nullptr, 10) : 0;
        const bool gone = process > 0 && ::kill(pid_t(process), 0) != 0 && errno == ESRCH;
        const auto written = fs::last_write_time(path, unknown);
        if (gone || (!unknown && fs::file_time_type::clock::now() - written > kOld)) fs::remove(path, unknown);
    }
}

Rie codeOf(int error) { return error == ENOSPC || error == EDQUOT ? Rie::DiskFull : Rie::System; }

std::string lower(std::string s) {
    for (char& c : s) c = char(std::tolower((unsigned char)c));
    return s;
}

/// The directory entry whose name equals `name` without regard to case; the first in byte order.
std::optional<std::string> entryIgnoringCase(const fs::path& dir, const std::string& name) {
    std::optional<std::string> best;
    std::string want = lower(name);
    for (const std::string& n : namesIn(dir.string()))
        if (n.size() == want.size() && lower(n) == want && (!best || n < *best)) best = n;
    return best;
}

std::optional<std::string> existingIgnoringCase(const std::string& dir, const std::string& name) {
    fs::path at = dir;
    fs::path rest = name;
    if (rest.is_absolute()) {
        at = rest.root_path();
        rest = rest.relative_path();
    }
    for (const fs::path& part : rest) {
        std::string p = part.string();
        if (p == "." || p == ".." || p.empty()) {
            at /= p;
            continue;
        }
        auto entry = entryIgnoringCase(at, p);
        if (!entry) return {};
        at /= *entry;
    }
    if (!isRegular(at)) return {};
    return at.string();
}

} // namespace

std::optional<std::string> resolveOutputPath(const std::string& name, const OutputPolicy& policy, Diagnostics& diags,
                                             const SourcePlace& place) {
    auto refuse = [&](const std::string& why, const char* hint = "--allow-write permits it") -> std::optional<std::string> {
        diags.report(Severity::Error, Rie::NoFile, place, why, hint);
        return {};
    };
    if (name.empty() || name.find('\0') != std::string::npos) return refuse("cannot write a file without a proper name", "");
    const fs::path root = policy.root.empty() ? fs::path(".") : fs::path(policy.root);
    const bool absolute = fs::path(name).is_absolute();
    if (policy.allowWrite) return (absolute ? fs::path(name) : root / name).string();
    const std::string last = baseName(name);
    if (last.empty() || last == "." || last == "..")
        return refuse("cannot write \"" + name + "\": it is the name of a folder", "");

    // Decided on canonical paths: links and ".." may lead out, an absolute name may lead in.
    std::error_code e;
    const std::string folder = fs::weakly_canonical(root, e).string();
    const fs::path given = absolute ? fs::path(name) : root / name;
    const bool foreign = hasDrive(name) || name[0] == '\\' || (climbs(name) && name.find('\\') != std::string::npos);
    if (foreign || e || !staysBelow(root, given))
        return refuse("\"" + name + "\" lies outside the output folder \"" + folder + "\"");
    const fs::path real = fs::weakly_canonical(given.parent_path(), e) / given.filename();
    if (hidden(real.lexically_relative(folder).string()) || (!absolute && hidden(name)))
        return refuse("\"" + name + "\" is a hidden name, which a scene may not write");
    const bool plain = policy.root.empty() || policy.root == ".";
    std::string path = climbs(name) ? real.string() : absolute || plain ? name : given.string();
    if (!replaceable(path))
        return refuse("\"" + path + "\" exists and is not a picture; a scene may not replace it",
                      "choose another name, or permit it by --allow-write");
    return path;
}

std::optional<OutputFile> OutputFile::openStandardOutput(Diagnostics& diags, const SourcePlace& place) {
    OutputFile f;
    f.path_ = "-";
    f.place_ = place;
    f.standardOutput_ = true;
    const int fd = memfd_create("alpenglow", MFD_CLOEXEC); // formats seek in their output, which a pipe cannot do
    f.file_ = fd < 0 ? nullptr : fdopen(fd, "w+b");
    if (f.file_) return f;
    diags.report(Severity::Error, codeOf(errno), place, std::string("cannot write to standard output: ") + std::strerror(errno));
    if (fd >= 0) ::close(fd);
    return {};
}

void OutputFile::copyOut() {
    std::rewind(file_);
    char bytes[1 << 16];
    while (size_t n = std::fread(bytes, 1, sizeof bytes, file_))
        for (size_t at = 0; at < n;) {
            const ssize_t sent = ::write(STDOUT_FILENO, bytes + at, n - at);
            if (sent < 0 && errno == EINTR) continue;
            if (sent < 0) return fail(errno);
            at += size_t(sent);
        }
    if (std::ferror(file_)) fail(EIO);
}

std::string fileIdentity(const std::string& path) {
    std::error_code e;
    const fs::path given = fs::absolute(path, e), folder = given.parent_path();
    const fs::path real = fs::weakly_canonical(folder, e);
    return ((e ? folder : real) / given.filename()).string();
}

std::optional<OutputFile> OutputFile::open(const std::string& name, const OutputPolicy& policy, Diagnostics& diags,
                                           const SourcePlace& place) {
    if (policy.allowWrite && name == "-") return openStandardOutput(diags, place);
    auto resolved = resolveOutputPath(name, policy, diags, place);
    if (!resolved) return {};
    OutputFile f;
    f.path_ = *resolved;
    f.place_ = place;
    f.failAfter_ = policy.failAfterBytes;
    std::error_code e;
    fs::path target = f.path_;
    fs::file_status status = fs::status(target, e);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        diags.report(Severity::Error, Rie::System, place, "cannot write \"" + f.path_ + "\": it is not a regular file",
                     "the display type \"null\" writes nothing");
        return {};
    }
    fs::path dir = target.parent_path();
    if (!dir.empty() && !fs::exists(dir, e) && !fs::create_directories(dir, e) && e) {
        diags.report(Severity::Error, codeOf(e.value()), place,
                     "cannot write \"" + f.path_ + "\": cannot create its folder: " + e.message());
        return {};
    }
    removeAbandoned(dir);
    // The name contains machine and process, so that two processes never share one; O_EXCL separates threads.
    int fd = -1;
    const std::string own = kTemporary + machineName() + "-" + std::to_string(getpid()) + "-";
    for (int n = 0; n < 10000 && fd < 0; ++n) {
        f.temporary_ = (dir / (own + std::to_string(n) + ".tmp")).string();
        fd = ::open(f.temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd < 0 && errno != EEXIST) break;
    }
    if (fd < 0) {
        int error = errno;
        f.temporary_.clear();
        diags.report(Severity::Error, codeOf(error), place, "cannot write \"" + f.path_ + "\": " + std::strerror(error));
        return {};
    }
    f.file_ = fdopen(fd, "w+b");
    if (!f.file_) {
        ::close(fd);
        f.fail(ENOMEM);
    }
    return f;
}

bool OutputFile::canBeWritten(const std::string& name, const OutputPolicy& policy, Diagnostics& diags, const SourcePlace& place) {
    auto file = open(name, policy, diags, place);
    if (!file) return false;
    constexpr char kBlock[4096] = {}; // smaller than any picture file on disk
    file->write(kBlock, sizeof kBlock);
    if (file->file_ && std::fflush(file->file_) != 0) file->fail(errno);
    if (file->ok()) return true;
    file->report(diags);
    return false;
}

OutputFile::OutputFile(OutputFile&& o) noexcept
    : file_(o.file_), path_(std::move(o.path_)), temporary_(std::move(o.temporary_)), standardOutput_(o.standardOutput_),
      place_(std::move(o.place_)), failAfter_(o.failAfter_), written_(o.written_), error_(o.error_),
      lastWasRead_(o.lastWasRead_) {
    o.file_ = nullptr;
    o.temporary_.clear();
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::discard() {
    if (file_) std::fclose(file_);
    file_ = nullptr;
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    temporary_.clear();
}

void OutputFile::fail(int error) {
    if (!error_) error_ = error ? error : EIO;
}

bool OutputFile::write(const void* bytes, size_t n) {
    if (!file_ || error_) return false;
    // stdio requires a seek between reading and writing.
    if (lastWasRead_ && std::fseek(file_, 0, SEEK_CUR) != 0) {
        fail(errno);
        return false;
    }
    lastWasRead_ = false;
    written_ += n;
    if (failAfter_ >= 0 && written_ > uint64_t(failAfter_)) {
        fail(ENOSPC);
        return false;
    }
    if (n && std::fwrite(bytes, 1, n, file_) != n) fail(errno);
    return !error_;
}

size_t OutputFile::read(void* bytes, size_t n) {
    if (!file_ || error_) return 0;
    if (!lastWasRead_ && std::fseek(file_, 0, SEEK_CUR) != 0) {
        fail(errno);
        return 0;
    }
    lastWasRead_ = true;
    const size_t got = std::fread(bytes, 1, n, file_);
    if (got < n && std::ferror(file_)) fail(errno);
    return got;
}

bool OutputFile::seek(uint64_t position) {
    if (!file_ || error_) return false;
    if (fseeko(file_, off_t(position), SEEK_SET) != 0) fail(errno);
    return !error_;
}

uint64_t OutputFile::tell() {
    off_t p = file_ ? ftello(file_) : 0;
    if (p < 0) fail(errno);
    return p < 0 ? 0 : uint64_t(p);
}

uint64_t OutputFile::size() {
    if (!file_) return 0;
    struct stat st{};
    if (std::fflush(file_) != 0) fail(errno);
    if (fstat(fileno(file_), &st) != 0) {
        fail(errno);
        return 0;
    }
    return uint64_t(st.st_size);
}

bool OutputFile::commit(Diagnostics& diags) {
    if (file_) {
        if (!error_ && std::fflush(file_) != 0) fail(errno);
        if (standardOutput_ && !error_) copyOut();
        else if (!error_ && fsync(fileno(file_)) != 0 && errno != EINVAL) fail(errno);
        if (std::fclose(file_) != 0) fail(errno);
        file_ = nullptr;
    } else if (!error_) {
        fail(EBADF);
    }
    if (!error_ && !standardOutput_ && std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(errno);
    if (!error_) {
        temporary_.clear();
        return true;
    }
    report(diags);
    discard();
    return false;
}

void OutputFile::report(Diagnostics& diags) const {
    diags.report(Severity::Error, codeOf(error_), place_,
                 "cannot write " + (standardOutput_ ? "to standard output" : "\"" + path_ + "\"") + ": " + std::strerror(error_));
}

std::optional<std::vector<uint8_t>> readWholeFile(const std::string& path, size_t maxBytes, Diagnostics& diags,
                                                  const SourcePlace& place) {
    auto refuse = [&](Rie code, const std::string& why) {
        diags.report(Severity::Error, code, place, "cannot read \"" + path + "\": " + why);
        return std::nullopt;
    };
    // O_NONBLOCK: opening a pipe without a writer must not block.
    int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return refuse(Rie::NoFile, std::strerror(errno));
    struct Closer {
        int fd;
        ~Closer() { ::close(fd); }
    } closer{fd};
    struct stat st{};
    if (fstat(fd, &st) != 0) return refuse(Rie::System, std::strerror(errno));
    if (!S_ISREG(st.st_mode)) return refuse(Rie::NoFile, "it is not a regular file");
    if (st.st_size < 0 || uint64_t(st.st_size) > maxBytes) return refuse(Rie::Limit, "it is larger than the limit");
    std::vector<uint8_t> bytes;
    try {
        bytes.resize(size_t(st.st_size));
    } catch (const std::exception&) { return refuse(Rie::NoMem, "out of memory"); }
    size_t at = 0;
    while (at < bytes.size()) {
        ssize_t n = ::read(fd, bytes.data() + at, bytes.size() - at);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return refuse(Rie::System, std::strerror(errno));
        if (n == 0) break;
        at += size_t(n);
    }
    bytes.resize(at);
    return bytes;
}

std::vector<std::string> splitSearchPath(const std::string& path, const std::vector<std::string>& defaults,
                                         const std::vector<std::string>& previous) {
    std::vector<std::string> out;
    std::string word;
    auto flush = [&] {
        if (word == "@") out.insert(out.end(), defaults.begin(), defaults.end());
        else if (word == "&") out.insert(out.end(), previous.begin(), previous.end());
        else if (!word.empty()) out.push_back(word);
        word.clear();
    };
    for (size_t i = 0; i < path.size(); ++i) {
        char c = path[i];
        bool drive = c == ':' && word.size() == 1 && std::isalpha((unsigned char)word[0]) && i + 1 < path.size() &&
                     isSeparator(path[i + 1]) && path[i + 1] == '\\';
        if ((c == ':' && !drive) || c == ';') flush();
        else word += c;
    }
    flush();
    return out;
}

std::optional<FoundFile> findFile(const std::string& name, const std::vector<std::string>& directories) {
    std::string outside;
    return findFile(name, directories, {}, &outside);
}

std::optional<FoundFile> findFile(const std::string& name, const std::vector<std::string>& directories, const ReadPolicy& policy,
                                  std::string* outside) {
    outside->clear();
    if (name.empty() || name.find('\0') != std::string::npos) return {};
    if (policy.before) policy.before(name);
    std::string slashed = name;
    std::replace(slashed.begin(), slashed.end(), '\\', '/');
    bool absolute = fs::path(slashed).is_absolute();
    std::vector<std::string> names{name};
    if (slashed != name) names.push_back(slashed);
    const auto allowed = [&](const std::string& p) {
        if (policy.anywhere || liesBelow(p, directories) || liesBelow(p, policy.folders)) return true;
        if (outside->empty()) *outside = p;
        return false;
    };
    auto look = [&](const std::string& n, bool anyCase) -> std::optional<std::string> {
        if (fs::path(n).is_absolute()) {
            std::optional<std::string> p = anyCase ? existingIgnoringCase("", n) : isRegular(n) ? std::optional(n) : std::nullopt;
            return p && allowed(*p) ? p : std::nullopt;
        }
        for (const std::string& d : directories) {
            if (anyCase) {
                if (auto p = existingIgnoringCase(d, n); p && allowed(*p)) return p;
            } else {
                std::string p = (fs::path(d) / n).string();
                if (isRegular(p) && allowed(p)) return p;
            }
        }
        return {};
    };
    for (bool anyCase : {false, true})
        for (const std::string& n : names)
            if (auto p = look(n, anyCase)) return FoundFile{*p, anyCase, false};
    std::string base = baseName(slashed);
    if (base == slashed && !absolute) return {};
    for (bool anyCase : {false, true})
        if (auto p = look(base, anyCase); p && !base.empty()) return FoundFile{*p, anyCase, true};
    return {};
}

} // namespace alpenglow
