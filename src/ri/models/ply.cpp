#include "ri/models/model.h"
#include "ri/models/ply_file.h"
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

using scene::Class;
using scene::Type;

/// What a stored colour of this type is divided by; 1: it is light as it is.
constexpr double kWhite[] = {127, 255, 32767, 65535, 2147483647.0, 4294967295.0, 1, 1, 1, 1};

/// Makes primitives of the vertices and faces of a file.
class PlyReader {
public:
    PlyReader(const std::string& path, std::string_view bytes, ModelLog& log) : path_(path), file_(path, bytes, log), log_(log) {}
    std::vector<scene::Primitive> read();

private:
    bool elements(const PlyElement&);
    void takeVertex(const PlyElement&, const PlyRow&);
    void takeFace(const PlyElement&, const PlyRow&, bool strips);
    void addFace(const std::vector<double>& corners, const PlyElement&, const PlyRow&);
    void faceVariables(scene::Primitive&);
    void vertexVariables(scene::Primitive&);
    scene::Primitive cloud();

    const std::string& path_;
    PlyFile file_;
    ModelLog& log_;

    const PlyElement* vertex_ = nullptr;
    std::vector<std::vector<float>> columns_; ///< by property of the vertex; empty for lists
    size_t vertices_ = 0, badVertices_ = 0;
    std::vector<bool> bad_;
    const PlyElement* face_ = nullptr;
    std::vector<int> counts_, corners_;
    std::vector<std::vector<float>> faceColumns_;
    std::vector<float> faceSt_;
    bool faceHasSt_ = true;
    struct Drawn {
        size_t lost = 0, thin = 0;
        SourcePlace first;
    } faults_;
};

void PlyReader::takeVertex(const PlyElement& e, const PlyRow& r) {
    bool bad = false;
    for (size_t i = 0; i < e.properties.size(); ++i) {
        if (e.properties[i].count) continue;
        const std::string& name = e.properties[i].name;
        float f = float(r.values[i]);
        if (!std::isfinite(f)) {
            bad |= name == "x" || name == "y" || name == "z";
            f = 0;
        }
        columns_[i].push_back(f);
    }
    if (bad && !badVertices_++)
        log_.error(Rie::Range, file_.here(), "a vertex is not finite: it and its faces are left out" + file_.where());
    bad_.push_back(bad);
    ++vertices_;
}

void PlyReader::addFace(const std::vector<double>& corners, const PlyElement& e, const PlyRow& r) {
    if (corners.size() < 3) {
        ++faults_.thin;
        return;
    }
    for (double c : corners)
        if (!(c >= 0 && c < double(vertices_)) || c != std::floor(c) || bad_[size_t(c)]) {
            if (!faults_.lost++) faults_.first = file_.here();
            return;
        }
    counts_.push_back(int(corners.size()));
    for (double c : corners) corners_.push_back(int(c));
    for (size_t i = 0; i < e.properties.size(); ++i)
        if (!e.properties[i].count) faceColumns_[i].push_back(std::isfinite(float(r.values[i])) ? float(r.values[i]) : 0.f);
    const int st = e.find("texcoord");
    if (st < 0 || !e.properties[size_t(st)].count || r.lists[size_t(st)].size() != 2 * corners.size()) {
        faceHasSt_ = false;
        return;
    }
    if (!faceHasSt_) return;
    for (size_t i = 0; i < 2 * corners.size(); ++i) {
        const float f = float(r.lists[size_t(st)][i]);
        faceSt_.push_back(!std::isfinite(f) ? 0 : i % 2 ? 1 - f : f);
    }
}

void PlyReader::takeFace(const PlyElement& e, const PlyRow& r, bool strips) {
    int list = e.find("vertex_indices");
    if (list < 0) list = e.find("vertex_index");
    if (list < 0 || !e.properties[size_t(list)].count) return;
    const std::vector<double>& all = r.lists[size_t(list)];
    if (!strips) return addFace(all, e, r);
    size_t begun = 0;
    for (size_t i = 0; i < all.size(); ++i) {
        if (all[i] < 0) {
            begun = i + 1;
            continue;
        }
        if (i - begun < 2) continue;
        const bool even = (i - begun) % 2 == 0;
        addFace({all[i - 2], even ? all[i - 1] : all[i], even ? all[i] : all[i - 1]}, e, r);
    }
}

bool PlyReader::elements(const PlyElement& e) {
    const bool vertex = e.name == "vertex" && !vertex_, face = e.name == "face" && !face_,
               strips = e.name == "tristrips" && !face_;
    if (vertex) {
        vertex_ = &e;
        columns_.resize(e.properties.size());
    }
    if (face || strips) {
        face_ = &e;
        faceColumns_.resize(e.properties.size());
    }
    if (e.properties.empty()) return true; // an element without data
    PlyRow r;
    for (double k = 0; k < e.count; ++k) {
        if (!file_.row(e, r)) {
            log_.error(Rie::MissingData, file_.here(),
                       fmt::format("{} of {} elements \"{}\" could be read; what was is drawn", k, e.count, e.name));
            return false;
        }
        if (vertex) takeVertex(e, r);
        else if (face || strips) takeFace(e, r, strips);
    }
    return true;
}

/// Three columns as one variable of threes, by any of some sets of names.
std::optional<std::vector<float>> joined(const PlyElement& e, const std::vector<std::vector<float>>& columns,
                                         std::initializer_list<std::array<const char*, 3>> names, size_t width, bool color) {
    for (const auto& set : names) {
        int at[3] = {-1, -1, -1};
        bool all = true;
        for (size_t k = 0; k < width; ++k) {
            at[k] = e.find(set[k]);
            all = all && at[k] >= 0 && !e.properties[size_t(at[k])].count;
        }
        if (!all) continue;
        std::vector<float> out;
        const size_t n = columns[size_t(at[0])].size();
        out.reserve(n * width);
        for (size_t i = 0; i < n; ++i)
            for (size_t k = 0; k < width; ++k) {
                const float v = columns[size_t(at[k])][i];
                const double white = kWhite[int(e.properties[size_t(at[k])].type)];
                out.push_back(color && white != 1 ? storedColor(v / white) : v);
            }
        return out;
    }
    return {};
}

constexpr std::initializer_list<std::array<const char*, 3>> kColors = {
    {"red", "green", "blue"}, {"r", "g", "b"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}};
constexpr std::initializer_list<std::array<const char*, 3>> kCoordinates = {
    {"s", "t", ""}, {"u", "v", ""}, {"texture_u", "texture_v", ""}, {"texture_s", "texture_t", ""}};

std::optional<std::vector<float>> opacities(const PlyElement& e, const std::vector<std::vector<float>>& columns) {
    int a = e.find("alpha");
    if (a < 0) a = e.find("a");
    if (a < 0 || e.properties[size_t(a)].count) return {};
    std::vector<float> out;
    bool any = false;
    for (float v : columns[size_t(a)]) {
        const float o = float(std::clamp(v / kWhite[int(e.properties[size_t(a)].type)], 0.0, 1.0));
        any |= o != 1;
        out.insert(out.end(), 3, o);
    }
    return any ? std::optional(out) : std::nullopt;
}

/// Other properties become primitive variables of their name, for shaders.
void others(const PlyElement& e, const std::vector<std::vector<float>>& columns, Class cls, scene::Primitive& out) {
    static const char* const taken[] = {"x",
                                        "y",
                                        "z",
                                        "nx",
                                        "ny",
                                        "nz",
                                        "red",
                                        "green",
                                        "blue",
                                        "r",
                                        "g",
                                        "b",
                                        "alpha",
                                        "a",
                                        "s",
                                        "t",
                                        "u",
                                        "v",
                                        "texture_u",
                                        "texture_v",
                                        "texture_s",
                                        "texture_t",
                                        "diffuse_red",
                                        "diffuse_green",
                                        "diffuse_blue",
                                        "radius",
                                        "width",
                                        "P",
                                        "N",
                                        "I",
                                        "E",
                                        "L",
                                        "Cs",
                                        "Os",
                                        "Ci",
                                        "Oi",
                                        "Cl",
                                        "Ol",
                                        "Ng",
                                        "Pw",
                                        "Pz",
                                        "st"};
    for (size_t i = 0; i < e.properties.size(); ++i) {
        const std::string& name = e.properties[i].name;
        const bool word = !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
                          std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
        const bool known = std::any_of(std::begin(taken), std::end(taken), [&](const char* t) { return name == t; });
        if (e.properties[i].count || known || !word || e.find(name) != int(i)) continue;
        out.params.push_back(variable(name.c_str(), cls, Type::Float, columns[i]));
    }
}

void PlyReader::vertexVariables(scene::Primitive& p) {
    const PlyElement& e = *vertex_;
    p.params.push_back(variable("P", Class::Vertex, Type::Point, *joined(e, columns_, {{"x", "y", "z"}}, 3, false)));
    if (auto n = joined(e, columns_, {{"nx", "ny", "nz"}}, 3, false))
        p.params.push_back(variable("N", Class::Vertex, Type::Normal, std::move(*n)));
    if (auto c = joined(e, columns_, kColors, 3, true))
        p.params.push_back(variable("Cs", Class::Vertex, Type::Color, std::move(*c)));
    if (auto o = opacities(e, columns_)) p.params.push_back(variable("Os", Class::Vertex, Type::Color, std::move(*o)));
    if (auto st = joined(e, columns_, kCoordinates, 2, false); st && faceSt_.empty()) {
        for (size_t i = 1; i < st->size(); i += 2) (*st)[i] = 1 - (*st)[i];
        p.params.push_back(variable("st", Class::Vertex, Type::Float, std::move(*st)));
        p.params.back().arrayLength = 2;
    }
    others(e, columns_, Class::Vertex, p);
}

void PlyReader::faceVariables(scene::Primitive& p) {
    const auto has = [&](const char* name) {
        return std::any_of(p.params.begin(), p.params.end(), [&](const scene::Param& v) { return v.name == name; });
    };
    if (!has("Cs"))
        if (auto c = joined(*face_, faceColumns_, kColors, 3, true))
            p.params.push_back(variable("Cs", Class::Uniform, Type::Color, std::move(*c)));
    if (!has("Os"))
        if (auto o = opacities(*face_, faceColumns_))
            p.params.push_back(variable("Os", Class::Uniform, Type::Color, std::move(*o)));
    if (faceHasSt_ && !faceSt_.empty()) {
        p.params.push_back(variable("st", Class::FaceVarying, Type::Float, std::move(faceSt_)));
        p.params.back().arrayLength = 2;
    }
    scene::Primitive more;
    others(*face_, faceColumns_, Class::Uniform, more);
    for (scene::Param& v : more.params)
        if (!has(v.name.c_str())) p.params.push_back(std::move(v));
}

/// A file without faces: points as wide as they lie apart on a surface of the size of their box, or as the file says.
scene::Primitive PlyReader::cloud() {
    scene::Primitive p;
    p.kind = "Points";
    if (badVertices_) { // faces leave bad vertices out; here nothing else does
        for (auto& c : columns_) {
            size_t kept = 0;
            for (size_t i = 0; i < c.size(); ++i)
                if (!bad_[i]) c[kept++] = c[i];
            c.resize(kept);
        }
        vertices_ -= badVertices_;
    }
    vertexVariables(p);
    for (const auto& [name, factor] : {std::pair("radius", 2.f), {"width", 1.f}})
        if (const int i = vertex_->find(name); i >= 0 && !vertex_->properties[size_t(i)].count) {
            std::vector<float> w = columns_[size_t(i)];
            for (float& x : w) x = std::max(0.f, x * factor);
            p.params.push_back(variable("width", Class::Varying, Type::Float, std::move(w)));
            return p;
        }
    Vec3d lo(INFINITY), hi(-INFINITY);
    const std::vector<float>& P = p.params[0].numbers;
    for (size_t i = 0; i + 2 < P.size(); i += 3)
        for (int k = 0; k < 3; ++k) {
            lo[k] = std::min(lo[k], double(P[i + size_t(k)]));
            hi[k] = std::max(hi[k], double(P[i + size_t(k)]));
        }
    const double size = P.empty() ? 0 : length(hi - lo);
    p.params.push_back(
        variable("constantwidth", Class::Constant, Type::Float, {float(size > 0 ? size / std::sqrt(double(vertices_)) : 1)}));
    return p;
}

std::vector<scene::Primitive> PlyReader::read() {
    if (!file_.header()) return {};
    for (const PlyElement& e : file_.elements())
        if (!elements(e)) break;
    if (!vertex_ || vertices_ == 0 || !joined(*vertex_, columns_, {{"x", "y", "z"}}, 3, false)) {
        log_.error(Rie::MissingData, {path_, 0, 0}, "there are no vertices with x, y and z");
        return {};
    }
    if (vertices_ > 0x7fffffff || corners_.size() > 0x7fffffff) {
        log_.error(Rie::Limit, {path_, 0, 0}, "there are too many vertices");
        return {};
    }
    if (faults_.lost)
        log_.error(Rie::Range, faults_.first,
                   fmt::format("{} faces use vertices that are not there; they are left out", faults_.lost));
    if (faults_.thin)
        log_.warning(Rie::Range, {path_, 0, 0},
                     fmt::format("{} faces have fewer than three corners; they are left out", faults_.thin));
    std::vector<scene::Primitive> out;
    const bool faces = std::any_of(file_.elements().begin(), file_.elements().end(), [](const PlyElement& e) {
        return (e.name == "face" || e.name == "tristrips") && e.count > 0;
    });
    if (!faces) {
        out.push_back(cloud());
    } else if (!counts_.empty()) {
        scene::Primitive p;
        p.kind = "PointsPolygons";
        vertexVariables(p);
        faceVariables(p);
        p.ints = std::move(counts_);
        p.ints2 = std::move(corners_);
        out.push_back(std::move(p));
    }
    return out;
}

} // namespace

std::vector<scene::Primitive> readPly(const std::string& path, std::string_view bytes, ModelLog& log) {
    return PlyReader(path, bytes, log).read();
}

} // namespace alpenglow::ri
