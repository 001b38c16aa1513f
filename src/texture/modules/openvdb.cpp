// libalpenglow_grids.so: reads OpenVDB grids as blocks of voxels. A child process loads it for the first .vdb file
// (display/foreign.h); nothing else links OpenVDB.
#include "display/foreign.h"
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <openvdb/openvdb.h>
#include <string>
#include <vector>

namespace {

using alpenglow::display::ForeignLimits;
using alpenglow::display::ForeignPicture;
using alpenglow::display::kForeignName;
using alpenglow::display::sendForeign;

/// The grids of numbers or vectors, and the bounding box of their active voxels.
struct Grids {
    std::vector<openvdb::FloatGrid::Ptr> floats;
    std::vector<openvdb::Vec3SGrid::Ptr> vectors;
    openvdb::CoordBBox box;
    std::vector<std::string> names;

    explicit Grids(const openvdb::GridPtrVec& all) {
        for (const auto& g : all) {
            const std::string name = g->getName().empty() ? "density" : g->getName();
            if (auto f = openvdb::gridPtrCast<openvdb::FloatGrid>(g)) {
                floats.push_back(f);
                names.insert(names.begin() + std::ptrdiff_t(floats.size() - 1), name);
            } else if (auto v = openvdb::gridPtrCast<openvdb::Vec3SGrid>(g)) {
                vectors.push_back(v);
                for (const char* part : {".x", ".y", ".z"}) names.push_back(name + part);
            } else {
                continue;
            }
            box.expand(g->evalActiveVoxelBoundingBox());
        }
    }
};

std::string readTo(const char* path, int to, const ForeignLimits& limits) {
    std::error_code e;
    const uint64_t fileBytes = std::filesystem::file_size(path, e);
    openvdb::initialize();
    openvdb::io::File file(path);
    file.open();
    const Grids g(*file.getGrids());
    if (g.names.empty()) return "it has no grid of floats or of vectors of floats";
    if (g.box.empty()) return "its grids have no active voxels";
    const openvdb::Coord size = g.box.dim();
    const uint64_t w = uint64_t(size.x()), h = uint64_t(size.y()), d = uint64_t(size.z()), n = g.names.size();
    if (w > limits.side || h > limits.side || d > limits.side)
        return "a side is longer than " + std::to_string(limits.side) + " voxels";
    if (n > limits.channels) return "it has more than " + std::to_string(limits.channels) + " channels";
    const uint64_t bytes = w * h * d * n * sizeof(float);
    if (bytes > limits.bytes) return "its voxels would take more than " + std::to_string(limits.bytes >> 30) + " GiB";
    if (bytes > limits.smallBytes && bytes / limits.expansion > fileBytes) return "it is too short for its stated size";
    ForeignPicture p{};
    p.stamp = alpenglow::display::kForeignStamp;
    p.width = int(w), p.height = int(h), p.depth = uint32_t(d), p.channels = int(n);
    p.bits = 32, p.floating = 1;
    bool good = sendForeign(to, &p, sizeof p);
    for (const std::string& name : g.names) {
        char text[kForeignName] = "";
        std::strncpy(text, name.c_str(), kForeignName - 1);
        good = good && sendForeign(to, text, kForeignName);
    }
    std::vector<openvdb::FloatGrid::ConstAccessor> floats;
    for (const auto& f : g.floats) floats.push_back(f->getConstAccessor());
    std::vector<openvdb::Vec3SGrid::ConstAccessor> vectors;
    for (const auto& v : g.vectors) vectors.push_back(v->getConstAccessor());
    std::vector<float> slice;
    for (uint64_t z = 0; z < d && good; ++z) {
        slice.clear();
        for (uint64_t y = 0; y < h; ++y)
            for (uint64_t x = 0; x < w; ++x) {
                const openvdb::Coord at = g.box.min().offsetBy(int(x), int(y), int(z));
                for (auto& f : floats) slice.push_back(f.getValue(at));
                for (auto& v : vectors)
                    for (int k = 0; k < 3; ++k) slice.push_back(v.getValue(at)[k]);
            }
        good = sendForeign(to, slice.data(), slice.size() * sizeof(float));
    }
    return good ? "" : "out of memory";
}

} // namespace

extern "C" int alpenglow_read_picture(const char* path, int to, const ForeignLimits* limits, char* why, int whySize) {
    std::string text;
    try {
        text = readTo(path, to, *limits);
    } catch (const std::exception& e) { text = e.what(); }
    std::strncpy(why, text.c_str(), size_t(whySize) - 1);
    return text.empty() ? 0 : 1;
}
