#include "texture/volume.h"
#include "base/limits.h"
#include "display/imageio.h"
#include "texture/lookup.h"
#include "texture/vdb.h"
#include <algorithm>
#include <cmath>
#include <fstream>

namespace alpenglow::texture {

const char* const volumeFormat = "Volume";

namespace {

/// Position of the slice number in a name, and its number of digits. Length 0: none.
struct SliceNumber {
    size_t at = 0, length = 0;
    int digits = 1;
};

SliceNumber sliceNumberIn(const std::string& name) {
    if (const size_t at = name.find('%'); at != std::string::npos) {
        size_t end = at + 1;
        while (end < name.size() && name[end] >= '0' && name[end] <= '9') ++end;
        if (end < name.size() && name[end] == 'd' && end - at <= 4)
            return {at, end + 1 - at, end > at + 1 ? std::clamp(std::atoi(name.c_str() + at + 1), 1, 20) : 1};
    }
    if (const size_t at = name.find("##"); at != std::string::npos) {
        const size_t end = std::min(name.find_first_not_of('#', at), name.size());
        return {at, end - at, int(std::min<size_t>(end - at, 20))};
    }
    return {};
}

std::string sliceName(const std::string& name, const SliceNumber& s, int number) {
    std::string digits = std::to_string(number);
    if (int(digits.size()) < s.digits) digits.insert(0, size_t(s.digits) - digits.size(), '0');
    return std::string(name).replace(s.at, s.length, digits);
}

/// "a.png*16": the file and its depth; 0: no such name.
int depthIn(const std::string& name, std::string& file) {
    const size_t star = name.rfind('*');
    if (star == std::string::npos || star + 1 >= name.size() || name.size() - star > 6) return 0;
    for (size_t i = star + 1; i < name.size(); ++i)
        if (name[i] < '0' || name[i] > '9') return 0;
    file = name.substr(0, star);
    return std::atoi(name.c_str() + star + 1);
}

class Loader {
public:
    Loader(const std::string& name, const VolumeFiles& f, Diagnostics& d) : name_(name), files_(f), diags_(d) {}

    std::nullopt_t refuse(const std::string& why, Rie code = Rie::BadFile) {
        diags_.report(Severity::Error, code, files_.place, "volume \"" + name_ + "\": " + why);
        return std::nullopt;
    }
    std::optional<std::string> pathOf(const std::string& file) {
        std::string outside;
        const auto found = findFile(file, files_.searchPath, files_.read, &outside);
        if (found) return found->path;
        if (!outside.empty()) diags_.reportOnce("volume:" + name_, outsideMessage("picture", file, outside, files_.place));
        return {};
    }
    std::optional<display::Image> picture(const std::string& path) {
        display::ReadOptions o;
        o.place = files_.place;
        return display::readImage(path, diags_, o);
    }
    /// Slices one below the other, `depth` of them.
    std::optional<Volume> strip(display::Image m, int depth) {
        Volume v;
        v.width = m.width;
        v.height = m.height / depth;
        v.depth = depth;
        v.names = m.channels;
        v.values = std::move(m.data);
        return v;
    }
    std::optional<Volume> stack(const SliceNumber& number) {
        int n = 0;
        while (n < 2 && !pathOf(sliceName(name_, number, n))) ++n;
        Volume v;
        for (; n < limits::kImageSide; ++n) {
            const auto path = pathOf(sliceName(name_, number, n));
            if (!path) break;
            auto m = picture(*path);
            if (!m) return {};
            if (v.depth == 0) {
                v.width = m->width;
                v.height = m->height;
                v.names = m->channels;
            }
            if (m->width != v.width || m->height != v.height || m->channels != v.names)
                return refuse("slice \"" + *path + "\" differs from the first one in size or channels");
            if ((v.values.size() + m->data.size()) * sizeof(float) > limits::kImageBytes)
                return refuse("its slices would take more than " + std::to_string(limits::kImageBytes >> 30) + " GiB",
                              Rie::Limit);
            v.values.insert(v.values.end(), m->data.begin(), m->data.end());
            ++v.depth;
        }
        if (v.depth == 0) return refuse("there is no slice 0 or 1", Rie::NoFile);
        return v;
    }
    std::optional<Volume> load() {
        if (const SliceNumber number = sliceNumberIn(name_); number.length) return stack(number);
        std::string file = name_;
        int depth = depthIn(name_, file);
        if (depth == 0) file = name_;
        const auto path = pathOf(file);
        if (!path) return refuse("\"" + file + "\" was not found", Rie::NoFile);
        if (path->ends_with(".vdb")) return loadVdb(*path, diags_, files_.place);
        auto m = picture(*path);
        if (!m) return {};
        const bool known = textOf(*m, "textureformat") == volumeFormat;
        if (depth == 0) depth = known ? std::atoi(textOf(*m, "depth").c_str()) : 1;
        if (depth < 1 || depth > limits::kImageSide) return refuse("its depth must be at least 1");
        if (m->height % depth == 0 && (known || m->height / depth >= m->width)) return strip(std::move(*m), depth);
        if (known) return refuse("its height is not a multiple of its depth");
        if (m->data.size() * size_t(depth) * sizeof(float) > limits::kImageBytes)
            return refuse("its slices would take more than " + std::to_string(limits::kImageBytes >> 30) + " GiB", Rie::Limit);
        Volume v = *strip(*m, 1);
        v.depth = depth;
        for (int z = 1; z < depth; ++z) v.values.insert(v.values.end(), m->data.begin(), m->data.end());
        return v;
    }

private:
    const std::string& name_;
    const VolumeFiles& files_;
    Diagnostics& diags_;
};

int channelOf(const Volume& v, const char* name) {
    const auto at = std::find(v.names.begin(), v.names.end(), name);
    return at == v.names.end() ? -1 : int(at - v.names.begin());
}

/// The opacity of a voxel.
struct Opacity {
    int alpha, colours;
    explicit Opacity(const Volume& v) : alpha(channelOf(v, "a")), colours(std::min(v.channels(), 3)) {}
    float operator()(const float* p) const {
        if (alpha >= 0) return p[alpha];
        float sum = 0;
        for (int c = 0; c < colours; ++c) sum += p[c];
        return sum / float(colours);
    }
};

} // namespace

bool namesVolume(const std::string& name) {
    std::string file;
    return sliceNumberIn(name).length || depthIn(name, file) > 0 || name.ends_with(".vdb");
}

bool holdsVolume(const std::string& path) {
    std::ifstream f(path, std::ios::binary);
    char head[4096] = "";
    f.read(head, sizeof head);
    const std::string_view text(head, size_t(f.gcount()));
    const size_t at = text.find("textureformat");
    return text.starts_with("\x76\x2f\x31\x01") && at != text.npos && text.substr(at, 64).find(volumeFormat) != text.npos;
}

std::optional<Volume> loadVolume(const std::string& name, const VolumeFiles& files, Diagnostics& diags) {
    Loader l(name, files, diags);
    try {
        return l.load();
    } catch (const std::bad_alloc&) { return l.refuse("out of memory", Rie::NoMem); }
}

Volume gradientsOf(const Volume& v, int radius) {
    const int r = std::max(1, radius);
    const Opacity opacity(v);
    Volume to{v.width, v.height, v.depth, {"r", "g", "b", "a"}, {}};
    to.values.resize(size_t(v.width) * size_t(v.height) * size_t(v.depth) * 4);
    for (int z = 0; z < v.depth; ++z)
        for (int y = 0; y < v.height; ++y)
            for (int x = 0; x < v.width; ++x) {
                Vec3 n(0);
                const bool inside = x >= r && y >= r && z >= r && x + r < v.width && y + r < v.height && z + r < v.depth;
                if (inside)
                    n = Vec3(opacity(v.at(x + r, y, z)) - opacity(v.at(x - r, y, z)),
                             opacity(v.at(x, y + r, z)) - opacity(v.at(x, y - r, z)),
                             opacity(v.at(x, y, z + r)) - opacity(v.at(x, y, z - r)));
                const float l = length(n);
                n = l > 1e-4f ? n / l : Vec3(0);
                float* p = to.at(x, y, z);
                for (int k = 0; k < 3; ++k) p[k] = .5f * (n[k] + 1);
                p[3] = opacity(v.at(x, y, z));
            }
    return to;
}

void smoothGradients(Volume& v, int radius) {
    if (radius < 1 || v.channels() < 3) return;
    // One axis after the other: the mean over a box is a mean of means, weighted by the number of voxels, which is a product over
    // the axes.
    const int sizes[3] = {v.width, v.height, v.depth};
    const size_t n = v.names.size();
    const size_t steps[3] = {n, n * size_t(v.width), n * size_t(v.width) * size_t(v.height)};
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<float> from = v.values;
        const int size = sizes[axis];
        const size_t step = steps[axis];
        for (size_t first = 0; first < from.size(); first += n) {
            const int at = int(first / step % size_t(size));
            const int lo = std::max(0, at - radius), hi = std::min(size - 1, at + radius);
            for (size_t k = 0; k < 3; ++k) {
                double sum = 0;
                for (int i = lo; i <= hi; ++i) sum += double(from[first + k + size_t(i) * step - size_t(at) * step]);
                v.values[first + k] = float(sum / (hi - lo + 1));
            }
        }
    }
}

bool makeGradients(const std::string& name, const std::string& picture, int radius, int smooth, const MakeOptions& o,
                   Diagnostics& diags) {
    auto v = loadVolume(name, {o.searchPath, o.read, o.place}, diags);
    if (!v) return false;
    if (size_t(v->height) * size_t(v->depth) > size_t(limits::kImageSide)) {
        diags.report(Severity::Error, Rie::Limit, o.place, "volume \"" + name + "\": its slices are too many for one picture");
        return false;
    }
    Volume g = gradientsOf(*v, radius);
    smoothGradients(g, smooth);
    display::Image m = display::makeImage(g.width, g.height * g.depth, g.names);
    m.data = std::move(g.values);
    m.metadata = {
        {"textureformat", volumeFormat}, {"depth", std::to_string(g.depth)}, {"Software", "Alpenglow"}, {"colorspace", kLight}};
    display::WriteOptions w;
    w.sample = display::Sample::Float;
    w.policy = o.policy;
    w.place = o.place;
    return display::writeImage(picture, m, w, diags);
}

} // namespace alpenglow::texture
