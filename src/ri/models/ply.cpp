#include "base/limits.h"
#include "ri/models/model.h"
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <map>

namespace alpenglow::ri {
namespace {

using scene::Class;
using scene::Type;

enum class Number { I8, U8, I16, U16, I32, U32, I64, U64, F32, F64 };
constexpr int kTypeBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
/// What a stored colour of this type is divided by; 1: it is light as it is.
constexpr double kWhite[] = {127, 255, 32767, 65535, 2147483647.0, 4294967295.0, 1, 1, 1, 1};

std::optional<Number> numberType(std::string_view name) {
    static const std::map<std::string_view, Number> known = {
        {"char", Number::I8},    {"int8", Number::I8},    {"uchar", Number::U8},   {"uint8", Number::U8},
        {"short", Number::I16},  {"int16", Number::I16},  {"ushort", Number::U16}, {"uint16", Number::U16},
        {"int", Number::I32},    {"int32", Number::I32},  {"uint", Number::U32},   {"uint32", Number::U32},
        {"int64", Number::I64},  {"uint64", Number::U64}, {"float", Number::F32},  {"float32", Number::F32},
        {"double", Number::F64}, {"float64", Number::F64}};
    const auto i = known.find(name);
    return i == known.end() ? std::nullopt : std::optional(i->second);
}

struct Property {
    std::string name;
    Number type = Number::F32;
    std::optional<Number> count; ///< of a list
};
struct Element {
    std::string name;
    double count = 0;
    std::vector<Property> properties;
    int find(std::string_view n) const {
        for (size_t i = 0; i < properties.size(); ++i)
            if (properties[i].name == n) return int(i);
        return -1;
    }
};
struct Row {
    std::vector<double> values;             ///< by property; of a list its length
    std::vector<std::vector<double>> lists; ///< by property
};

class PlyReader {
public:
    PlyReader(const std::string& path, std::string_view bytes, ModelLog& log) : path_(path), bytes_(bytes), log_(log) {}
    std::vector<scene::Primitive> read();

private:
    enum class Format { Ascii, Little, Big };
    bool header();
    bool headerLine(const std::vector<std::string_view>& words);
    std::string_view line();
    SourcePlace here() const { return {path_, format_ == Format::Ascii || inHeader_ ? line_ : 0, 0}; }
    std::string where() const { return format_ == Format::Ascii || inHeader_ ? "" : fmt::format(" at byte {}", at_); }
    bool fail(Rie code, const std::string& what) {
        log_.error(code, here(), what + where());
        return false;
    }
    bool number(Number, double&);
    bool row(const Element&, Row&);
    bool elements(const Element&);
    void takeVertex(const Element&, const Row&);
    void takeFace(const Element&, const Row&, bool strips);
    void addFace(const std::vector<double>& corners, const Element&, const Row&);
    void vertexColumns(const Element&);
    void faceVariables(scene::Primitive&);
    void vertexVariables(scene::Primitive&);
    scene::Primitive cloud();

    const std::string& path_;
    std::string_view bytes_;
    ModelLog& log_;
    size_t at_ = 0;
    int line_ = 1;
    bool inHeader_ = true, rowBegun_ = false;
    Format format_ = Format::Ascii;
    std::vector<Element> elements_;

    const Element* vertex_ = nullptr;
    std::vector<std::vector<float>> columns_; ///< by property of the vertex; empty for lists
    size_t vertices_ = 0, badVertices_ = 0;
    std::vector<bool> bad_;
    const Element* face_ = nullptr;
    std::vector<int> counts_, corners_;
    std::vector<std::vector<float>> faceColumns_;
    std::vector<float> faceSt_;
    bool faceHasSt_ = true;
    struct Drawn {
        size_t lost = 0, thin = 0;
        SourcePlace first;
    } faults_;
};

std::string_view PlyReader::line() {
    if (at_ >= bytes_.size()) return {};
    size_t end = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
    std::string_view text = bytes_.substr(at_, end - at_);
    if (end < bytes_.size()) end += bytes_[end] == '\r' && end + 1 < bytes_.size() && bytes_[end + 1] == '\n' ? 2 : 1;
    at_ = end;
    ++line_;
    return text;
}

std::vector<std::string_view> fieldsOf(std::string_view text) {
    std::vector<std::string_view> words;
    for (size_t i = 0; i < text.size();) {
        while (i < text.size() && (text[i] == ' ' || text[i] == '\t')) ++i;
        size_t end = i;
        while (end < text.size() && text[end] != ' ' && text[end] != '\t') ++end;
        if (end > i) words.push_back(text.substr(i, end - i));
        i = end;
    }
    return words;
}

bool PlyReader::headerLine(const std::vector<std::string_view>& w) {
    const auto is = [&](const char* name, size_t words) { return w[0] == name && w.size() >= words; };
    if (w[0] == "comment" || w[0] == "obj_info") return true;
    if (is("format", 2)) {
        if (w[1] == "ascii") format_ = Format::Ascii;
        else if (w[1] == "binary_little_endian") format_ = Format::Little;
        else if (w[1] == "binary_big_endian") format_ = Format::Big;
        else return fail(Rie::BadFile, fmt::format("format \"{}\" is not known", w[1].substr(0, 40)));
        return true;
    }
    if (is("element", 3)) {
        Element e{std::string(w[1].substr(0, 80)), 0, {}};
        const auto [end, fault] = std::from_chars(w[2].data(), w[2].data() + w[2].size(), e.count);
        if (fault != std::errc() || end != w[2].data() + w[2].size() || !(e.count >= 0) || e.count != std::floor(e.count) ||
            e.count > 1e15)
            return fail(Rie::Syntax, fmt::format("\"{}\" is no count of elements", w[2].substr(0, 40)));
        if (elements_.size() >= size_t(limits::kModelProperties)) return fail(Rie::Limit, "there are too many elements");
        elements_.push_back(std::move(e));
        return true;
    }
    if (is("property", 3)) {
        if (elements_.empty()) return fail(Rie::Syntax, "a property without an element");
        Element& e = elements_.back();
        const bool list = w[1] == "list";
        if (list && w.size() < 5) return fail(Rie::Syntax, "property list needs two types and a name");
        Property p;
        p.name = std::string(w[list ? 4 : 2].substr(0, 80));
        const auto type = numberType(w[list ? 3 : 1]);
        if (list) p.count = numberType(w[2]);
        if (!type || (list && !p.count))
            return fail(Rie::Syntax, fmt::format("the type of property \"{}\" is not known", p.name));
        p.type = *type;
        if (e.properties.size() >= size_t(limits::kModelProperties))
            return fail(Rie::Limit, "an element has too many properties");
        e.properties.push_back(std::move(p));
        return true;
    }
    return fail(Rie::Syntax, fmt::format("\"{}\" is not known in a header", w[0].substr(0, 40)));
}

bool PlyReader::header() {
    if (line().substr(0, 3) != "ply") {
        log_.error(Rie::BadFile, {path_, 1, 1}, "the file is no PLY: it does not begin with \"ply\"");
        return false;
    }
    while (at_ < bytes_.size()) {
        const int begun = line_;
        const auto words = fieldsOf(line());
        if (words.empty()) continue;
        if (words[0] == "end_header") {
            inHeader_ = false;
            return true;
        }
        line_ = begun; // faults are of this line
        if (!headerLine(words)) return false;
        line_ = begun + 1;
    }
    return fail(Rie::BadFile, "the header does not end");
}

bool PlyReader::number(Number type, double& v) {
    if (format_ == Format::Ascii) {
        const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f'; };
        while (at_ < bytes_.size() && blank(bytes_[at_])) line_ += bytes_[at_++] == '\n';
        if (at_ >= bytes_.size()) return fail(Rie::BadFile, "the file ends early");
        size_t end = at_;
        while (end < bytes_.size() && !blank(bytes_[end])) ++end;
        const std::string_view word = bytes_.substr(at_, end - at_);
        const char* first = word.data() + (word[0] == '+');
        const auto [stop, fault] = std::from_chars(first, word.data() + word.size(), v);
        at_ = end;
        if (stop == word.data() + word.size() && fault == std::errc()) return true;
        if (fault == std::errc::result_out_of_range) return v = 0, true;
        return fail(Rie::Syntax, fmt::format("\"{}\" is no number", word.substr(0, 40)));
    }
    const size_t n = size_t(kTypeBytes[int(type)]);
    if (bytes_.size() - at_ < n) return fail(Rie::BadFile, "the file ends early");
    uint64_t bits = 0;
    for (size_t i = 0; i < n; ++i)
        bits |= uint64_t(uint8_t(bytes_[at_ + i])) << (8 * (format_ == Format::Little ? i : n - 1 - i));
    at_ += n;
    switch (type) {
    case Number::I8:
        v = int8_t(bits);
        break;
    case Number::I16:
        v = int16_t(bits);
        break;
    case Number::I32:
        v = int32_t(bits);
        break;
    case Number::I64:
        v = double(int64_t(bits));
        break;
    case Number::F32:
        v = std::bit_cast<float>(uint32_t(bits));
        break;
    case Number::F64:
        v = std::bit_cast<double>(bits);
        break;
    default:
        v = double(bits);
    }
    return true;
}

bool PlyReader::row(const Element& e, Row& r) {
    r.values.resize(e.properties.size());
    r.lists.resize(e.properties.size());
    for (size_t i = 0; i < e.properties.size(); ++i) {
        const Property& p = e.properties[i];
        if (!p.count) {
            if (!number(p.type, r.values[i])) return false;
            continue;
        }
        double n = 0;
        if (!number(*p.count, n)) return false;
        const double least = format_ == Format::Ascii ? 1 : kTypeBytes[int(p.type)];
        if (!(n >= 0) || n != std::floor(n) || n * least > double(bytes_.size() - at_))
            return fail(Rie::Range, fmt::format("a list of {} values is longer than the file", n));
        r.values[i] = n;
        r.lists[i].clear();
        for (double k = 0; k < n; ++k) {
            double v = 0;
            if (!number(p.type, v)) return false;
            r.lists[i].push_back(v);
        }
    }
    return true;
}

void PlyReader::takeVertex(const Element& e, const Row& r) {
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
    if (bad && !badVertices_++) log_.error(Rie::Range, here(), "a vertex is not finite: it and its faces are left out" + where());
    bad_.push_back(bad);
    ++vertices_;
}

void PlyReader::addFace(const std::vector<double>& corners, const Element& e, const Row& r) {
    if (corners.size() < 3) {
        ++faults_.thin;
        return;
    }
    for (double c : corners)
        if (!(c >= 0 && c < double(vertices_)) || c != std::floor(c) || bad_[size_t(c)]) {
            if (!faults_.lost++) faults_.first = here();
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

void PlyReader::takeFace(const Element& e, const Row& r, bool strips) {
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

bool PlyReader::elements(const Element& e) {
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
    if (e.properties.empty()) return true; // nothing stands for them
    Row r;
    for (double k = 0; k < e.count; ++k) {
        if (!row(e, r)) {
            log_.error(Rie::MissingData, here(),
                       fmt::format("{} of {} elements \"{}\" could be read; what was is drawn", k, e.count, e.name));
            return false;
        }
        if (vertex) takeVertex(e, r);
        else if (face || strips) takeFace(e, r, strips);
    }
    return true;
}

/// Three columns as one variable of threes, by any of some sets of names.
std::optional<std::vector<float>> joined(const Element& e, const std::vector<std::vector<float>>& columns,
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

std::optional<std::vector<float>> opacities(const Element& e, const std::vector<std::vector<float>>& columns) {
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

/// Numbers that have no meaning of their own here: shaders may ask for them by name.
void others(const Element& e, const std::vector<std::vector<float>>& columns, Class cls, scene::Primitive& out) {
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
    const Element& e = *vertex_;
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
    if (!header()) return {};
    for (const Element& e : elements_)
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
    const bool faces = std::any_of(elements_.begin(), elements_.end(),
                                   [](const Element& e) { return (e.name == "face" || e.name == "tristrips") && e.count > 0; });
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
