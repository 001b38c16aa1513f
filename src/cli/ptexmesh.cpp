#include "cli/ptexmesh.h"
#include "base/file.h"
#include "base/vec.h"
#include "ptex/limits.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <sstream>

namespace alpenglow::cli {

namespace {

constexpr size_t kTextBytes = size_t(1) << 30;

struct Mesh {
    std::vector<Vec3> points;
    std::vector<Color> ofPoints, ofFaces; ///< none, or as many
    std::vector<std::vector<int>> faces;
};

struct Element {
    std::string name;
    size_t count = 0;
    struct Property {
        std::string name;
        bool list = false, byte = false;
    };
    std::vector<Property> properties;
};

/// Words of a text, by lines in the header and then one after the other.
class Reader {
public:
    explicit Reader(const std::string& text) : in_(text) {}
    std::string read(Mesh& to) {
        if (std::string f = header(); !f.empty()) return f;
        for (const Element& e : elements_)
            for (size_t i = 0; i < e.count; ++i)
                if (std::string f = row(e, to); !f.empty()) return f;
        return "";
    }

private:
    std::string header();
    std::string row(const Element&, Mesh&);
    std::istringstream in_;
    std::vector<Element> elements_;
};

std::string Reader::header() {
    std::string line;
    bool text = false;
    for (int n = 0; std::getline(in_, line); ++n) {
        std::istringstream words(line);
        std::string word, a, b, c, d;
        words >> word >> a >> b >> c >> d;
        if (n == 0 && word != "ply") return "it is no PLY file";
        if (word == "end_header") return text ? "" : "it is not written in text; only such PLY files can be read here";
        if (word == "format") text = a == "ascii";
        if (word == "element") elements_.push_back({a, size_t(std::strtoull(b.c_str(), nullptr, 10)), {}});
        if (word != "property" || elements_.empty()) continue;
        if (a == "list") elements_.back().properties.push_back({d, true, false});
        else elements_.back().properties.push_back({b, false, a == "uchar" || a == "uint8"});
    }
    return "its header does not end";
}

std::string Reader::row(const Element& e, Mesh& to) {
    Vec3 point, colour(0.f);
    bool coloured = false;
    std::vector<int> corners;
    for (const Element::Property& p : e.properties) {
        double v = 0;
        if (!(in_ >> v)) return "it is cut short";
        if (p.list) {
            if (!(v >= 0 && v <= 64)) return "it has a face with more than 64 corners";
            std::vector<int> list(size_t(v), 0);
            for (int& k : list)
                if (!(in_ >> k)) return "it is cut short";
            if (p.name == "vertex_indices" || p.name == "vertex_index") corners = std::move(list);
            continue;
        }
        const size_t axis = std::string("xyz").find(p.name), channel = p.name == "red"     ? 0
                                                                       : p.name == "green" ? 1
                                                                       : p.name == "blue"  ? 2
                                                                                           : 3;
        if (axis < 3 && p.name.size() == 1) point[int(axis)] = float(v);
        if (channel < 3) colour[int(channel)] = float(p.byte ? v / 255 : v), coloured = true;
    }
    if (e.name == "vertex") {
        to.points.push_back(point);
        if (coloured) to.ofPoints.push_back(colour);
    } else if (e.name == "face") {
        to.faces.push_back(std::move(corners));
        if (coloured) to.ofFaces.push_back(colour);
    }
    return "";
}

std::string check(const Mesh& m) {
    if (m.faces.empty()) return "it has no faces";
    if (m.faces.size() > limits::kPtexFaces) return "it has too many faces";
    const size_t corners = m.faces[0].size();
    for (const auto& f : m.faces) {
        if (f.size() != corners || corners < 3 || corners > 4)
            return "its faces must all be triangles, or all have four corners: cut the others first";
        for (const int k : f)
            if (k < 0 || size_t(k) >= m.points.size()) return "a face of it uses a vertex that does not exist";
    }
    if (m.ofFaces.size() != m.faces.size() && m.ofPoints.size() != m.points.size())
        return "it has no colours: properties red, green and blue of its faces or of its vertices";
    return "";
}

/// Which faces are adjacent: edges from a to b and from b to a.
void findNeighbours(const Mesh& m, std::vector<ptex::Face>& faces) {
    std::map<std::pair<int, int>, std::pair<int32_t, uint8_t>> edges;
    const size_t n = m.faces[0].size();
    for (size_t f = 0; f < m.faces.size(); ++f)
        for (size_t e = 0; e < n; ++e) edges.try_emplace({m.faces[f][e], m.faces[f][(e + 1) % n]}, int32_t(f), uint8_t(e));
    for (size_t f = 0; f < m.faces.size(); ++f)
        for (size_t e = 0; e < n; ++e)
            if (const auto at = edges.find({m.faces[f][(e + 1) % n], m.faces[f][e]}); at != edges.end()) {
                faces[f].adjacent[e] = at->second.first;
                faces[f].edge[e] = at->second.second;
            }
}

ptex::Image imageOf(const Mesh& m, size_t face, int side) {
    ptex::Image to;
    if (m.ofFaces.size() == m.faces.size()) {
        for (int k = 0; k < 3; ++k) to.values.push_back(m.ofFaces[face][k]);
        return to;
    }
    to.u = to.v = side;
    const auto& c = m.faces[face];
    const auto at = [&](size_t k) { return m.ofPoints[size_t(c[k])]; };
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            Color v;
            if (c.size() == 4) {
                const float x = (float(i) + .5f) / float(side), y = (float(j) + .5f) / float(side);
                v = (at(0) * (1 - x) + at(1) * x) * (1 - y) + (at(3) * (1 - x) + at(2) * x) * y;
            } else { // the middles of triangles; those on their heads behind the others
                const bool upright = i + j < side;
                const float x = (upright ? float(i) + 1 / 3.f : float(side - 1 - i) + 2 / 3.f) / float(side);
                const float y = (upright ? float(j) + 1 / 3.f : float(side - 1 - j) + 2 / 3.f) / float(side);
                v = at(0) * (1 - x - y) + at(1) * x + at(2) * y;
            }
            for (int k = 0; k < 3; ++k) to.values.push_back(v[k]);
        }
    return to;
}

template <class T> std::vector<uint8_t> bytesOf(const std::vector<T>& numbers) {
    std::vector<uint8_t> to;
    for (const T& n : numbers)
        for (int k = 0; k < 4; ++k) to.push_back(uint8_t(std::bit_cast<uint32_t>(n) >> (8 * k)));
    return to;
}

/// The mesh itself, as painters want it (ptex.us/metakeys.html).
void addGeometry(const Mesh& m, std::vector<ptex::Meta>& metas) {
    std::vector<int32_t> counts, indices;
    std::vector<float> points;
    for (const auto& f : m.faces) {
        counts.push_back(int32_t(f.size()));
        indices.insert(indices.end(), f.begin(), f.end());
    }
    for (const Vec3& p : m.points)
        for (int k = 0; k < 3; ++k) points.push_back(p[k]);
    metas.push_back({"PtexFaceVertCounts", 3, bytesOf(counts)});
    metas.push_back({"PtexFaceVertIndices", 3, bytesOf(indices)});
    metas.push_back({"PtexVertPositions", 4, bytesOf(points)});
}

} // namespace

bool makePtex(const std::string& from, const std::string& to, const PtexOptions& o, Diagnostics& d) {
    const auto bytes = readWholeFile(from, kTextBytes, d, {});
    if (!bytes) return false;
    Mesh m;
    std::string fault = Reader(std::string(bytes->begin(), bytes->end())).read(m);
    if (fault.empty()) fault = check(m);
    if (!fault.empty()) {
        d.report(Severity::Error, Rie::BadFile, {}, "mesh \"" + from + "\" cannot be read: " + fault);
        return false;
    }
    ptex::Head head;
    head.mesh = m.faces[0].size() == 3 ? ptex::Mesh::Triangle : ptex::Mesh::Quad;
    head.number = o.number;
    head.faces.resize(m.faces.size());
    findNeighbours(m, head.faces);
    std::vector<ptex::Image> images;
    for (size_t f = 0; f < m.faces.size(); ++f) {
        images.push_back(imageOf(m, f, 1 << o.log));
        head.faces[f].ulog = head.faces[f].vlog = uint8_t(std::countr_zero(unsigned(images.back().u)));
    }
    addGeometry(m, head.metas);
    return ptex::writeTexture(to, std::move(head), images, {".", o.allowWrite}, d);
}

} // namespace alpenglow::cli
