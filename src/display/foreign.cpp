#include "display/foreign.h"
#include "base/childmodule.h"
#include "base/installation.h"
#include "base/limits.h"
#include "display/grids.h"
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <sys/mman.h>

namespace alpenglow::display {

namespace {

/// What a child has written, looked at as a stranger's file is.
std::optional<Image> pictureFrom(const ChildResult& child, const DecodeContext& ctx) {
    ForeignPicture p{};
    const size_t written = writtenBytes(child);
    if (!readWritten(child, &p, sizeof p) || p.stamp != kForeignStamp || p.width <= 0 || p.height <= 0 || p.channels <= 0)
        return ctx.refuse("the module that reads it was built from other sources than this program");
    const uint64_t slices = std::max<uint64_t>(1, p.depth), side = uint64_t(limits::kImageSide);
    if (slices > side || uint64_t(p.height) * slices > uint64_t(std::numeric_limits<int>::max()) || // rows of an Image
        uint64_t(p.height) * slices * uint64_t(p.width) > limits::kImageBytes / sizeof(float) / uint64_t(p.channels))
        return ctx.refuse("its voxels would take more than " + std::to_string(limits::kImageBytes >> 30) + " GiB", Rie::Limit);
    if (!ctx.sizeAllowed(uint64_t(p.width), uint64_t(p.height), uint64_t(p.channels))) return {};
    const size_t names = size_t(p.channels) * kForeignName,
                 numbers = size_t(p.width) * size_t(p.height) * slices * size_t(p.channels) * sizeof(float);
    if (written != sizeof p + names + numbers) return ctx.refuse("its reader gave too little");
    void* all = mmap(nullptr, written, PROT_READ, MAP_SHARED, child.written.fd, 0);
    if (all == MAP_FAILED) return ctx.refuse("out of memory", Rie::NoMem);
    const char* at = static_cast<const char*>(all) + sizeof p;
    std::vector<std::string> channels;
    for (int c = 0; c < p.channels; ++c)
        channels.emplace_back(at + size_t(c) * kForeignName, strnlen(at + size_t(c) * kForeignName, kForeignName));
    Image m = makeImage(p.width, int(uint64_t(p.height) * slices), channels);
    if (p.depth) m.metadata["depth"] = std::to_string(p.depth);
    std::memcpy(m.data.data(), at + names, numbers);
    munmap(all, written);
    m.bits = p.bits;
    m.floating = p.floating != 0;
    const std::string space(p.colourSpace, strnlen(p.colourSpace, kForeignName));
    if (space == "sRGB") m.metadata["colorspace"] = space;
    else if (const double g = std::atof(space.c_str()); g > 0) m.metadata["gamma"] = space;
    return m;
}

} // namespace

const ForeignModule& pictureModule() {
    static const ForeignModule m{"libalpenglow_pictures.so", "ALPENGLOW_PICTURES", "OpenImageIO (libopenimageio2.4)",
                                 "it is in none of the formats that are read here (" + readFormats() + ")"};
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
    if (module.empty()) return ctx.refuse(std::string(of.known) + ", and the module for others, " + of.file + ", is not there");
    // Twice what the picture may be: as it is in the file, and as floats.
    const uint64_t allowed = std::max<uint64_t>(limits::kImageSmallBytes, uint64_t(ctx.fileBytes) * limits::kImageExpansion);
    const uint64_t memory = kForeignBytes + 2 * std::min<uint64_t>(limits::kImageBytes, allowed);
    const ChildResult child =
        runChildModule(module, kReadForeignPicture, memory, [&](void* function, int to, char* why, int size) {
            const ForeignLimits limits{uint64_t(limits::kImageSide), uint64_t(limits::kImageChannels), limits::kImageBytes,
                                       limits::kImageSmallBytes, limits::kImageExpansion};
            return reinterpret_cast<ReadForeignPicture>(function)(path.c_str(), to, &limits, why, size);
        });
    using End = ChildResult::End;
    switch (child.end) {
    case End::Done:
        return pictureFrom(child, ctx);
    case End::NoChild:
        return ctx.refuse(child.why);
    case End::Late:
        return ctx.refuse("its reader took more than " + std::to_string(limits::kProgramSeconds) + " seconds", Rie::Limit);
    case End::Signal:
        return ctx.refuse("its reader ended by signal " + std::to_string(child.signal));
    case End::NoModule:
        return ctx.refuse(std::string(of.known) + ", and the module for others cannot be loaded: " + child.why + " (it needs " +
                          of.needs + ")");
    case End::Failed:
        break;
    }
    return ctx.refuse(child.why.empty() ? "its reader failed" : child.why);
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
