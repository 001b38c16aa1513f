#include "pointcloud/bakefile.h"
#include "base/file.h"
#include "pointcloud/bytes.h"
#include "pointcloud/limits.h"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace alpenglow::pointcloud {

namespace {

constexpr std::string_view kText = "# bake 1", kBinary = "ALPGBAKE", kAmpersand = "&binary";
constexpr uint32_t kBakeVersion = 1;
constexpr size_t kHeader = 24;

std::string_view headOf(std::span<const uint8_t> b) {
    return {reinterpret_cast<const char*>(b.data()), std::min<size_t>(b.size(), 8)};
}

void appendNumber(std::string& to, float v) {
    char text[32];
    to.append(text, std::to_chars(text, text + sizeof text, v).ptr);
}

std::string readBinary(std::span<const uint8_t> b, Baked& to) {
    if (b.size() < kHeader + 4) return "it is cut short";
    if (takeNumber<uint32_t>(&b[8]) != kBakeVersion) return "it has another version than this program reads";
    const uint32_t type = takeNumber<uint32_t>(&b[12]);
    const uint64_t count = takeNumber<uint64_t>(&b[16]);
    if (type > uint32_t(ChannelType::Normal)) return "its header is damaged";
    to.type = ChannelType(type);
    const size_t width = 2 + size_t(sizeOf(to.type));
    if (count > limits::kCloudPoints) return "it has more than " + std::to_string(limits::kCloudPoints) + " points";
    if (const uint64_t want = kHeader + count * width * 4 + 4; b.size() != want)
        return b.size() < want ? "it is cut short" : "there is extra data after its points";
    if (checksum(b.first(b.size() - 4)) != takeNumber<uint32_t>(b.data() + b.size() - 4)) return "it is damaged";
    to.rows.resize(size_t(count) * width);
    for (size_t i = 0; i < to.rows.size(); ++i) to.rows[i] = takeFloat(&b[kHeader + 4 * i]);
    return "";
}

std::string readText(std::span<const uint8_t> b, Baked& to) {
    const char *at = reinterpret_cast<const char*>(b.data()), *end = at + b.size();
    const char* line = std::find(at, end, '\n');
    std::string type(at + kText.size(), line);
    type.erase(0, type.find_first_not_of(" \r"));
    while (!type.empty() && std::isspace(static_cast<unsigned char>(type.back()))) type.pop_back();
    bool known = false;
    for (int t = 0; t <= int(ChannelType::Normal); ++t)
        if (type == nameOf(ChannelType(t))) known = true, to.type = ChannelType(t);
    if (!known) return "its first line does not name the type of its values";
    const size_t width = 2 + size_t(sizeOf(to.type));
    size_t number = 1, inLine = 0;
    for (at = line; at < end;) {
        if (*at == '\n') {
            if (inLine != 0 && inLine != width)
                return "line " + std::to_string(number) + " has not " + std::to_string(width) + " numbers";
            inLine = 0, ++number, ++at;
        } else if (*at == '#') {
            at = std::find(at, end, '\n');
        } else if (*at == ' ' || *at == '\t' || *at == '\r') {
            ++at;
        } else {
            float v = 0;
            const auto r = std::from_chars(at, end, v);
            if (r.ec != std::errc() || ++inLine > width)
                return "line " + std::to_string(number) + " has not " + std::to_string(width) + " numbers";
            to.rows.push_back(v);
            at = r.ptr;
        }
    }
    return inLine == 0 ? "" : "its last line is incomplete";
}

/// Solves the normal equations of a plane a + b x + c y; returns a, or the mean if the points do not span a plane.
struct Plane {
    double w = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    double v[3] = {}, vx[3] = {}, vy[3] = {};
    void add(double weight, double dx, double dy, const float* value, int channels) {
        w += weight, x += weight * dx, y += weight * dy;
        xx += weight * dx * dx, xy += weight * dx * dy, yy += weight * dy * dy;
        for (int k = 0; k < channels; ++k) {
            const double f = weight * double(value[k]);
            v[k] += f, vx[k] += f * dx, vy[k] += f * dy;
        }
    }
    double cxx() const { return xx - x * x / w; } // about the mean
    double cyy() const { return yy - y * y / w; }
    double cxy() const { return xy - x * y / w; }
    /// Whether the points are no point and no line.
    bool spans() const {
        return w > 0 && cxx() > 1e-4 * w && cyy() > 1e-4 * w && cxx() * cyy() - cxy() * cxy() > 1e-3 * cxx() * cyy();
    }
    float at0(int k) const {
        if (!spans()) return float(v[k] / w);
        const double cxx = this->cxx(), cyy = this->cyy(), cxy = this->cxy(), det = cxx * cyy - cxy * cxy;
        const double fx = vx[k] - x * v[k] / w, fy = vy[k] - y * v[k] / w;
        const double b = (fx * cyy - fy * cxy) / det, c = (fy * cxx - fx * cxy) / det;
        return float((v[k] - b * x - c * y) / w);
    }
};

/// Pixels without a value get that of the same picture at half the size, which is the mean of those that have one.
void fillHoles(std::vector<float>& pixels, std::vector<uint8_t>& known, int side, int channels) {
    if (side < 2 || std::count(known.begin(), known.end(), 0) == 0) return;
    const int half = side / 2;
    std::vector<float> small(size_t(half) * size_t(half) * size_t(channels));
    std::vector<uint8_t> smallKnown(size_t(half) * size_t(half));
    const auto at = [&](int px, int py) { return size_t(py) * size_t(side) + size_t(px); };
    for (int py = 0; py < half; ++py)
        for (int px = 0; px < half; ++px) {
            const size_t to = size_t(py) * size_t(half) + size_t(px);
            int n = 0;
            for (int q = 0; q < 4; ++q) {
                const size_t from = at(2 * px + q % 2, 2 * py + q / 2);
                if (!known[from]) continue;
                ++n;
                for (int k = 0; k < channels; ++k)
                    small[to * size_t(channels) + size_t(k)] += pixels[from * size_t(channels) + size_t(k)];
            }
            for (int k = 0; n && k < channels; ++k) small[to * size_t(channels) + size_t(k)] /= float(n);
            smallKnown[to] = n > 0;
        }
    fillHoles(small, smallKnown, half, channels);
    for (int py = 0; py < side; ++py)
        for (int px = 0; px < side; ++px)
            for (int k = 0; !known[at(px, py)] && k < channels; ++k)
                pixels[at(px, py) * size_t(channels) + size_t(k)] =
                    small[(size_t(py / 2) * size_t(half) + size_t(px / 2)) * size_t(channels) + size_t(k)];
}

} // namespace

std::string bakeFileName(const std::string& name, bool* binary) {
    *binary = name.ends_with(kAmpersand);
    return *binary ? name.substr(0, name.size() - kAmpersand.size()) : name;
}

bool saveBaked(const std::string& name, const Baked& baked, const OutputPolicy& policy, Diagnostics& d,
               const SourcePlace& place) {
    bool binary = false;
    auto file = OutputFile::open(bakeFileName(name, &binary), policy, d, place);
    if (!file) return false;
    const size_t width = 2 + size_t(sizeOf(baked.type));
    if (binary) {
        std::vector<uint8_t> all(kBinary.begin(), kBinary.end());
        putNumber(all, kBakeVersion);
        putNumber(all, uint32_t(baked.type));
        putNumber(all, uint64_t(baked.size()));
        for (const float v : baked.rows) putFloat(all, v);
        putNumber(all, checksum(all));
        file->write(all.data(), all.size());
        return file->commit(d);
    }
    std::string text = std::string(kText) + " " + nameOf(baked.type) + "\n";
    for (size_t i = 0; i < baked.rows.size(); ++i) {
        appendNumber(text, baked.rows[i]);
        text += (i + 1) % width == 0 ? '\n' : ' ';
        if (text.size() < 1u << 16) continue;
        file->write(text.data(), text.size());
        text.clear();
    }
    file->write(text.data(), text.size());
    return file->commit(d);
}

bool isBaked(const std::string& path) {
    char head[8];
    std::FILE* f = std::fopen(path.c_str(), "rb");
    if (!f) return false;
    const size_t n = std::fread(head, 1, sizeof head, f);
    std::fclose(f);
    const std::string_view have(head, n);
    return have == kText || have == kBinary;
}

std::optional<Baked> loadBaked(const std::string& path, Diagnostics& d, const SourcePlace& place) {
    const auto bytes = readWholeFile(path, limits::kCloudBytes, d, place);
    if (!bytes) return {};
    Baked b;
    std::string fault = headOf(*bytes) == kText     ? readText(*bytes, b)
                        : headOf(*bytes) == kBinary ? readBinary(*bytes, b)
                                                    : "it is no .bake file";
    if (fault.empty() && b.size() > limits::kCloudPoints)
        fault = "it has more than " + std::to_string(limits::kCloudPoints) + " points";
    if (fault.empty() && !std::all_of(b.rows.begin(), b.rows.end(), [](float v) { return std::isfinite(v); }))
        fault = "a number in it is not finite";
    if (fault.empty()) return b;
    d.report(Severity::Error, Rie::BadFile, place, "\"" + path + "\" cannot be read: " + fault, "bake() writes such files");
    return {};
}

BakedPicture pictureOf(const Baked& baked) {
    BakedPicture p;
    p.channels = sizeOf(baked.type);
    const size_t width = 2 + size_t(p.channels);
    const auto inside = [&](size_t i) {
        const float s = baked.rows[i * width], t = baked.rows[i * width + 1];
        return s >= 0 && s <= 1 && t >= 0 && t <= 1;
    };
    std::vector<uint32_t> points;
    for (size_t i = 0; i < baked.size(); ++i)
        if (inside(i)) points.push_back(uint32_t(i));
    p.outside = baked.size() - points.size();
    for (p.side = 1; p.side < limits::kBakedSide && double(p.side) * p.side * 2 < double(points.size()); p.side *= 2) {}
    // Points by pixel, in their order.
    const auto pixelOf = [&](float x) { return std::clamp(int(x * float(p.side)), 0, p.side - 1); };
    const size_t count = size_t(p.side) * size_t(p.side);
    std::vector<uint32_t> first(count + 1), by(points.size());
    const auto cellOf = [&](uint32_t i) {
        return size_t(pixelOf(baked.rows[i * width + 1])) * size_t(p.side) + size_t(pixelOf(baked.rows[i * width]));
    };
    for (const uint32_t i : points) ++first[cellOf(i) + 1];
    for (size_t c = 0; c < count; ++c) first[c + 1] += first[c];
    std::vector<uint32_t> next(first.begin(), first.end() - 1);
    for (const uint32_t i : points) by[next[cellOf(i)]++] = i;
    p.pixels.resize(count * size_t(p.channels));
    std::vector<uint8_t> known(count);
    const auto planeAt = [&](int x, int y, int reach) {
        Plane plane;
        for (int ny = std::max(0, y - reach); ny <= std::min(p.side - 1, y + reach); ++ny) {
            const size_t row = size_t(ny) * size_t(p.side);
            for (size_t c = row + size_t(std::max(0, x - reach)), end = row + size_t(std::min(p.side - 1, x + reach)); c <= end;
                 ++c)
                for (uint32_t k = first[c]; k < first[c + 1]; ++k) {
                    const float* at = &baked.rows[by[k] * width];
                    const double dx = double(at[0]) * p.side - (x + .5), dy = double(at[1]) * p.side - (y + .5);
                    const double q = 1 - (dx * dx + dy * dy) / (reach * reach);
                    if (q > 0) plane.add(q * q, dx, dy, at + 2, p.channels);
                }
        }
        return plane;
    };
    for (int y = 0; y < p.side; ++y)
        for (int x = 0; x < p.side; ++x) {
            Plane plane = planeAt(x, y, 2);
            if (plane.w > 0 && !plane.spans()) plane = planeAt(x, y, 4);
            const size_t at = size_t(y) * size_t(p.side) + size_t(x);
            known[at] = plane.w > 0;
            for (int k = 0; plane.w > 0 && k < p.channels; ++k) p.pixels[at * size_t(p.channels) + size_t(k)] = plane.at0(k);
        }
    fillHoles(p.pixels, known, p.side, p.channels);
    return p;
}

} // namespace alpenglow::pointcloud
