// Point clouds as PLY (Turk, "The PLY Polygon File Format"): the element "vertex", one property a number.
#include "base/file.h"
#include "pointcloud/bytes.h"
#include "pointcloud/cloudfile.h"
#include "pointcloud/limits.h"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <sstream>

namespace alpenglow::pointcloud {

namespace {

constexpr size_t kHeaderBytes = 1u << 20;

/// Suffixes of the property names of a channel.
std::vector<std::string> endingsOf(ChannelType t) {
    switch (t) {
    case ChannelType::Float:
        return {""};
    case ChannelType::Color:
        return {"_r", "_g", "_b"};
    case ChannelType::Point:
        return {"_px", "_py", "_pz"};
    case ChannelType::Vector:
        return {"_vx", "_vy", "_vz"};
    case ChannelType::Normal:
        return {"_nx", "_ny", "_nz"};
    case ChannelType::Matrix:
        break;
    }
    std::vector<std::string> all;
    for (int i = 0; i < 16; ++i) all.push_back("_m" + std::to_string(i));
    return all;
}

constexpr const char* kReserved[] = {"x", "y", "z", "nx", "ny", "nz", "radius", "red", "green", "blue"};
constexpr std::string_view kPrefix = "channel_"; ///< prefix of channels whose names conflict, or start with it

enum class Number : uint8_t { I8, U8, I16, U16, I32, U32, F32, F64 };
constexpr size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};

std::optional<Number> numberByName(const std::string& s) {
    constexpr const char* names[][2] = {{"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
                                        {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
    for (size_t i = 0; i < 8; ++i)
        if (s == names[i][0] || s == names[i][1]) return Number(i);
    return {};
}

struct Property {
    std::string name;
    Number type;
};
struct Header {
    enum class Form { Text, Little, Big } form = Form::Text;
    std::vector<Property> properties;
    uint64_t count = 0;
    size_t data = 0; ///< start of the numbers
};

/// Parses one line of the header; returns "" or an error message.
std::string readLine(const std::string& line, Header& h, std::string& element, bool& seen) {
    std::istringstream in(line);
    std::string word, a, b;
    in >> word >> a >> b;
    if (word == "format") {
        if (a != "ascii" && a != "binary_little_endian" && a != "binary_big_endian") return "its format \"" + a + "\" is unknown";
        h.form = a == "ascii" ? Header::Form::Text : a == "binary_big_endian" ? Header::Form::Big : Header::Form::Little;
    } else if (word == "element") {
        element = a;
        uint64_t n = 0;
        const auto end = std::from_chars(b.data(), b.data() + b.size(), n);
        if (end.ec != std::errc() || end.ptr != b.data() + b.size()) return "its element \"" + a + "\" has no count";
        if (a == "vertex" && !seen) seen = true, h.count = n;
        else if (!seen && n > 0) return "its element \"" + a + "\" precedes the vertices";
    } else if (word == "property" && element == "vertex") {
        const auto type = numberByName(a);
        if (!type) return "the type \"" + a + "\" of a property of its vertices is no number";
        if (h.properties.size() >= size_t(limits::kCloudChannels) + 7) return "its vertices have too many properties";
        for (const Property& p : h.properties)
            if (p.name == b) return "its vertices have two properties \"" + b + "\"";
        h.properties.push_back({b.substr(0, 255), *type});
    }
    return "";
}

std::string readHeader(std::span<const uint8_t> bytes, Header& h) {
    std::string element;
    bool seen = false;
    for (size_t at = 0; at < std::min(bytes.size(), kHeaderBytes);) {
        size_t end = at;
        while (end < bytes.size() && end - at < 4096 && bytes[end] != '\n') ++end;
        if (end == bytes.size() || bytes[end] != '\n') break;
        std::string line(bytes.begin() + long(at), bytes.begin() + long(end));
        while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
        at = end + 1;
        if (line == "end_header") {
            h.data = at;
            return seen ? "" : "it has no vertices";
        }
        if (std::string fault = readLine(line, h, element, seen); !fault.empty()) return fault;
    }
    return "its header is incomplete";
}

double numberAt(const uint8_t* from, Number type, bool big) {
    uint8_t b[8];
    const size_t n = kBytes[size_t(type)];
    for (size_t i = 0; i < n; ++i) b[i] = from[big ? n - 1 - i : i];
    switch (type) {
    case Number::I8:
        return double(int8_t(b[0]));
    case Number::U8:
        return double(b[0]);
    case Number::I16:
        return double(int16_t(takeNumber<uint16_t>(b)));
    case Number::U16:
        return double(takeNumber<uint16_t>(b));
    case Number::I32:
        return double(int32_t(takeNumber<uint32_t>(b)));
    case Number::U32:
        return double(takeNumber<uint32_t>(b));
    case Number::F32:
        return double(takeFloat(b));
    case Number::F64:
        break;
    }
    return std::bit_cast<double>(takeNumber<uint64_t>(b));
}

/// Positions of a point's numbers among the properties; -1: missing.
struct Places {
    int P[3] = {-1, -1, -1}, N[3] = {-1, -1, -1}, radius = -1;
    std::vector<int> values;
    std::vector<float> scale; ///< of values: bytes are parts of 255
};

Places placesOf(const Header& h, std::vector<Channel>& channels) {
    Places p;
    const auto& all = h.properties;
    const auto find = [&](const std::string& name) {
        const auto i = std::find_if(all.begin(), all.end(), [&](const Property& q) { return q.name == name; });
        return i == all.end() ? -1 : int(i - all.begin());
    };
    const char *xyz[] = {"x", "y", "z"}, *normal[] = {"nx", "ny", "nz"}, *colour[] = {"red", "green", "blue"};
    std::vector<bool> taken(all.size());
    const auto take = [&](int i) {
        if (i >= 0) taken[size_t(i)] = true;
        return i;
    };
    for (int k = 0; k < 3; ++k) p.P[k] = take(find(xyz[k]));
    const bool normals = find("nx") >= 0 && find("ny") >= 0 && find("nz") >= 0;
    for (int k = 0; k < 3 && normals; ++k) p.N[k] = take(find(normal[k]));
    p.radius = take(find("radius"));
    const auto addChannel = [&](const std::string& name, ChannelType type, const std::vector<int>& from) {
        channels.push_back({name.starts_with(kPrefix) ? name.substr(kPrefix.size()) : name, type});
        for (const int i : from) {
            p.values.push_back(take(i));
            p.scale.push_back(all[size_t(i)].type == Number::U8 ? 255.f : 1.f);
        }
    };
    for (size_t i = 0; i < all.size(); ++i) {
        if (taken[i]) continue;
        std::vector<int> parts;
        if (all[i].name == "red") {
            for (const char* c : colour) parts.push_back(find(c));
            if (std::count(parts.begin(), parts.end(), -1) == 0) {
                addChannel("color", ChannelType::Color, parts);
                continue;
            }
        }
        bool grouped = false;
        for (int t = 1; t <= int(ChannelType::Matrix) && !grouped; ++t) {
            const auto endings = endingsOf(ChannelType(t));
            if (!all[i].name.ends_with(endings[0]) || all[i].name.size() == endings[0].size()) continue;
            const std::string name = all[i].name.substr(0, all[i].name.size() - endings[0].size());
            parts.clear();
            for (const std::string& e : endings) parts.push_back(find(name + e));
            if (std::any_of(parts.begin(), parts.end(), [&](int q) { return q < 0 || taken[size_t(q)]; })) continue;
            addChannel(name, ChannelType(t), parts);
            grouped = true;
        }
        if (!grouped) addChannel(all[i].name, ChannelType::Float, {int(i)});
    }
    return p;
}

/// Gives the numbers of one vertex after the other.
class Vertices {
public:
    Vertices(std::span<const uint8_t> bytes, const Header& h) : b_(bytes), h_(h), at_(h.data) {
        for (const Property& p : h.properties) record_ += kBytes[size_t(p.type)];
    }
    bool next(std::vector<double>& row) {
        if (h_.form != Header::Form::Text) {
            if (b_.size() - at_ < record_) return false;
            for (size_t i = 0; i < row.size(); ++i) {
                row[i] = numberAt(b_.data() + at_, h_.properties[i].type, h_.form == Header::Form::Big);
                at_ += kBytes[size_t(h_.properties[i].type)];
            }
            return true;
        }
        for (double& v : row) {
            while (at_ < b_.size() && std::isspace(b_[at_])) ++at_;
            const char *from = reinterpret_cast<const char*>(b_.data()) + at_,
                       *end = reinterpret_cast<const char*>(b_.data()) + b_.size();
            const auto r = std::from_chars(from, end, v);
            if (r.ec != std::errc()) return false;
            at_ += size_t(r.ptr - from);
        }
        return true;
    }
    /// Minimum size of a vertex in bytes.
    size_t record() const { return h_.form == Header::Form::Text ? 2 * h_.properties.size() - 1 : record_; }

private:
    std::span<const uint8_t> b_;
    const Header& h_;
    size_t at_, record_ = 0;
};

} // namespace

std::string readPly(std::span<const uint8_t> bytes, PointCloud& to) {
    Header h;
    if (std::string fault = readHeader(bytes, h); !fault.empty()) return fault;
    const Places p = placesOf(h, to.channels);
    for (const int i : p.P)
        if (i < 0) return "its vertices have no x, y and z";
    if (to.width() > limits::kCloudChannels)
        return "it has more than " + std::to_string(limits::kCloudChannels) + " numbers a point";
    for (size_t i = 0; i < to.channels.size(); ++i)
        for (size_t k = 0; k < i; ++k)
            if (to.channels[k].name == to.channels[i].name) return "it has two channels \"" + to.channels[i].name + "\"";
    if (h.count > limits::kCloudPoints) return "it has more than " + std::to_string(limits::kCloudPoints) + " points";
    Vertices vertices(bytes, h);
    if (h.count > (bytes.size() - h.data + 1) / vertices.record()) return "it is cut short";
    to.reserve(size_t(h.count));
    std::vector<double> row(h.properties.size());
    std::vector<float> values(p.values.size());
    const auto number = [&](int i) { return i < 0 ? 0.f : float(row[size_t(i)]); };
    for (uint64_t i = 0; i < h.count; ++i) {
        if (!vertices.next(row)) return "vertex " + std::to_string(i) + " is no row of numbers";
        for (const double v : row)
            if (!std::isfinite(float(v))) return "vertex " + std::to_string(i) + " has a number that is not finite";
        for (size_t k = 0; k < values.size(); ++k) values[k] = number(p.values[k]) / p.scale[k];
        to.add({number(p.P[0]), number(p.P[1]), number(p.P[2])}, {number(p.N[0]), number(p.N[1]), number(p.N[2])},
               std::max(0.f, number(p.radius)), values);
    }
    return "";
}

bool savePly(const std::string& name, const PointCloud& cloud, const OutputPolicy& policy, Diagnostics& d,
             const SourcePlace& place) {
    auto file = OutputFile::open(name, policy, d, place);
    if (!file) return false;
    std::string head = "ply\nformat binary_little_endian 1.0\ncomment point cloud of Alpenglow\nelement vertex " +
                       std::to_string(cloud.size()) + "\n";
    for (const char* p : {"x", "y", "z", "nx", "ny", "nz", "radius"}) head += std::string("property float ") + p + "\n";
    for (const Channel& c : cloud.channels) {
        std::string word = c.name; // a name with spaces would be several words
        for (char& l : word)
            if (std::isspace(static_cast<unsigned char>(l))) l = '_';
        const auto reserved = [&](const char* r) { return word == r; };
        if (std::any_of(std::begin(kReserved), std::end(kReserved), reserved) || word.starts_with(kPrefix))
            word.insert(0, kPrefix);
        for (const std::string& e : endingsOf(c.type)) head += "property float " + word + e + "\n";
    }
    head += "end_header\n";
    file->write(head.data(), head.size());
    std::vector<uint8_t> some;
    for (size_t at = 0; at < cloud.size() && file->ok(); at += 4096) {
        some.clear();
        for (size_t i = at; i < std::min(cloud.size(), at + 4096); ++i) packPoint(cloud, i, some);
        file->write(some.data(), some.size());
    }
    return file->commit(d);
}

} // namespace alpenglow::pointcloud
