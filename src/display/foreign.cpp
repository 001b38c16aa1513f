#include "display/foreign.h"
#include "base/installation.h"
#include "base/limits.h"
#include "display/grids.h"
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <filesystem>
#include <limits>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace alpenglow::display {

namespace {

constexpr int kWhy = 512;                ///< bytes for the error message of a child
constexpr int kKnown = 1, kNoModule = 2; ///< exit codes of the child: failed with a message; module cannot be loaded

/// A file descriptor that is closed.
struct Descriptor {
    int fd = -1;
    ~Descriptor() {
        if (fd >= 0) close(fd);
    }
};

/// Limits the memory of this process to its current size plus `bytes`; larger allocations fail. Disabled under AddressSanitizer,
/// whose own tables exceed any limit.
void limitMemory([[maybe_unused]] uint64_t bytes) {
#if !__has_feature(address_sanitizer)
    unsigned long has = 0; // pages of data
    if (FILE* f = std::fopen("/proc/self/statm", "re")) {
        if (std::fscanf(f, "%*u %*u %*u %*u %*u %lu", &has) != 1) has = 0;
        std::fclose(f);
    }
    const rlim_t all = rlim_t(has) * rlim_t(sysconf(_SC_PAGESIZE)) + bytes;
    rlimit now{};
    if (getrlimit(RLIMIT_DATA, &now) == 0 && (now.rlim_cur == RLIM_INFINITY || now.rlim_cur > all)) {
        now.rlim_cur = all;
        setrlimit(RLIMIT_DATA, &now);
    }
#endif
}

/// In the child: reads the picture into `to` and writes an error message to `tell`. No destructor of the program runs.
[[noreturn]] void readInChild(const std::string& module, const std::string& path, uint64_t memory, int to, int tell) {
    char why[kWhy] = "";
    int code = kNoModule;
    const rlimit noCore{0, 0};
    setrlimit(RLIMIT_CORE, &noCore);
    limitMemory(memory);
    for (const int s : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT}) std::signal(s, SIG_DFL);
    void* handle = dlopen(module.c_str(), RTLD_LAZY | RTLD_LOCAL);
    const auto read = handle ? reinterpret_cast<ReadForeignPicture>(dlsym(handle, kReadForeignPicture)) : nullptr;
    if (read) {
        const ForeignLimits limits{uint64_t(limits::kImageSide), uint64_t(limits::kImageChannels), limits::kImageBytes,
                                   limits::kImageSmallBytes, limits::kImageExpansion};
        code = read(path.c_str(), to, &limits, why, kWhy) == 0 ? 0 : kKnown;
    } else {
        const char* text = dlerror();
        std::strncpy(why, text ? text : "it does not have the expected function", kWhy - 1);
    }
    for (size_t done = 0, n = std::strlen(why); done < n;) {
        const ssize_t k = write(tell, why + done, n - done);
        if (k <= 0) break;
        done += size_t(k);
    }
    _exit(code);
}

/// Reads the child's message until it ends or the time is over; returns false in the latter case.
bool listen(int from, std::string& why) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(limits::kProgramSeconds);
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
        if (left <= 0) return false;
        pollfd p{from, POLLIN, 0};
        const int n = poll(&p, 1, int(left));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        char text[kWhy];
        const ssize_t k = read(from, text, sizeof text);
        if (k < 0 && errno == EINTR) continue;
        if (k <= 0) return true;
        if (why.size() < kWhy) why.append(text, size_t(k));
    }
}

bool readAll(int from, void* to, size_t n) {
    for (size_t done = 0; done < n;) {
        const ssize_t k = pread(from, static_cast<char*>(to) + done, std::min<size_t>(n - done, size_t(1) << 30), off_t(done));
        if (k <= 0) return false;
        done += size_t(k);
    }
    return true;
}

/// Reads the output of a child, which is untrusted like any file.
std::optional<Image> pictureFrom(int file, const DecodeContext& ctx) {
    ForeignPicture p{};
    struct stat about{};
    if (fstat(file, &about) != 0 || !readAll(file, &p, sizeof p) || p.stamp != kForeignStamp || p.width <= 0 || p.height <= 0 ||
        p.channels <= 0)
        return ctx.refuse("the module that reads it was built for another version of this program");
    const uint64_t slices = std::max<uint64_t>(1, p.depth), side = uint64_t(limits::kImageSide);
    if (slices > side || uint64_t(p.height) * slices > uint64_t(std::numeric_limits<int>::max()) || // rows of an Image
        uint64_t(p.height) * slices * uint64_t(p.width) > limits::kImageBytes / sizeof(float) / uint64_t(p.channels))
        return ctx.refuse("its voxels would take more than " + std::to_string(limits::kImageBytes >> 30) + " GiB", Rie::Limit);
    if (!ctx.sizeAllowed(uint64_t(p.width), uint64_t(p.height), uint64_t(p.channels))) return {};
    const size_t names = size_t(p.channels) * kForeignName,
                 numbers = size_t(p.width) * size_t(p.height) * slices * size_t(p.channels) * sizeof(float);
    if (size_t(about.st_size) != sizeof p + names + numbers) return ctx.refuse("its reader returned too little data");
    void* all = mmap(nullptr, size_t(about.st_size), PROT_READ, MAP_SHARED, file, 0);
    if (all == MAP_FAILED) return ctx.refuse("out of memory", Rie::NoMem);
    const char* at = static_cast<const char*>(all) + sizeof p;
    std::vector<std::string> channels;
    for (int c = 0; c < p.channels; ++c)
        channels.emplace_back(at + size_t(c) * kForeignName, strnlen(at + size_t(c) * kForeignName, kForeignName));
    Image m = makeImage(p.width, int(uint64_t(p.height) * slices), channels);
    if (p.depth) m.metadata["depth"] = std::to_string(p.depth);
    std::memcpy(m.data.data(), at + names, numbers);
    munmap(all, size_t(about.st_size));
    m.bits = p.bits;
    m.floating = p.floating != 0;
    const std::string space(p.colourSpace, strnlen(p.colourSpace, kForeignName));
    if (space == "sRGB") m.metadata["colorspace"] = space;
    else if (const double g = std::atof(space.c_str()); g > 0) m.metadata["gamma"] = space;
    return m;
}

} // namespace

const ForeignModule& pictureModule() {
    static const ForeignModule m{
        "libalpenglow_pictures.so", "ALPENGLOW_PICTURES", "OpenImageIO (libopenimageio2.4)",
        "it is in none of the formats that are read here (OpenEXR, TIFF, PNG, JPEG, Radiance, Targa, KTX, zfile, "
        "Pixar's native textures)"};
    return m;
}

const ForeignModule& gridModule() {
    static const ForeignModule m{"libalpenglow_grids.so", "ALPENGLOW_GRIDS", "OpenVDB (libopenvdb10.0)",
                                 "grids of OpenVDB are read by a module"};
    return m;
}

std::string fileOf(const ForeignModule& m) { return moduleFile(m.file, m.variable); }

std::optional<Image> readForeign(const ForeignModule& of, const std::string& path, const DecodeContext& ctx) {
    const std::string module = fileOf(of);
    if (module.empty())
        return ctx.refuse(std::string(of.known) + ", and the module for others, " + of.file + ", is not installed");
    Descriptor picture{memfd_create("alpenglow-picture", MFD_CLOEXEC)};
    int ends[2] = {-1, -1};
    if (picture.fd < 0 || pipe2(ends, O_CLOEXEC) != 0)
        return ctx.refuse(std::string("no child process: ") + std::strerror(errno));
    Descriptor from{ends[0]}, to{ends[1]};
    // Twice the size of a picture: file data, and floats.
    const uint64_t allowed = std::max<uint64_t>(limits::kImageSmallBytes, uint64_t(ctx.fileBytes) * limits::kImageExpansion);
    const uint64_t memory = kForeignBytes + 2 * std::min<uint64_t>(limits::kImageBytes, allowed);
    const pid_t child = fork();
    if (child == 0) readInChild(module, path, memory, picture.fd, to.fd);
    close(to.fd);
    to.fd = -1;
    if (child < 0) return ctx.refuse(std::string("no child process: ") + std::strerror(errno));
    std::string why;
    const bool ended = listen(from.fd, why);
    if (!ended) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    for (char& c : why)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    if (!ended)
        return ctx.refuse("its reader took more than " + std::to_string(limits::kProgramSeconds) + " seconds", Rie::Limit);
    if (WIFSIGNALED(status)) return ctx.refuse("its reader ended by signal " + std::to_string(WTERMSIG(status)));
    if (WEXITSTATUS(status) == kNoModule)
        return ctx.refuse(std::string(of.known) + ", and the module for others cannot be loaded: " + why + " (it needs " +
                          of.needs + ")");
    if (WEXITSTATUS(status) != 0) return ctx.refuse(why.empty() ? "its reader failed" : why);
    return pictureFrom(picture.fd, ctx);
}

std::optional<Image> readGrids(const std::string& path, Diagnostics& diags, const SourcePlace& place) {
    ReadOptions options;
    options.place = place;
    std::error_code e;
    const size_t bytes = size_t(std::filesystem::file_size(path, e));
    const DecodeContext ctx{path, diags, options, e ? 0 : bytes};
    if (e) return ctx.refuse(e.message(), Rie::NoFile);
    return readForeign(gridModule(), path, ctx);
}

} // namespace alpenglow::display
