#include "ri/models/model.h"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>
#include <unordered_map>

namespace alpenglow::ri {
namespace {

using scene::Class;
using scene::Type;

struct Material {
    std::string name, texture;
    std::optional<Color> color, opacity;
};

/// Lines of a text, those that end in a backslash joined with the next.
class Lines {
public:
    explicit Lines(std::string_view t) : text_(t) {}
    bool next() {
        if (at_ >= text_.size()) return false;
        words_.clear();
        joined_.clear();
        number_ = after_;
        for (;;) {
            const size_t end = std::min(text_.find('\n', at_), text_.size());
            std::string_view one = text_.substr(at_, end - at_);
            at_ = end + 1;
            ++after_;
            if (!one.empty() && one.back() == '\r') one.remove_suffix(1);
            const bool more = !one.empty() && one.back() == '\\' && at_ < text_.size();
            if (more) one.remove_suffix(1);
            if (!more && joined_.empty()) {
                split(one);
                return true;
            }
            joined_ += one;
            joined_ += ' ';
            if (!more) break;
        }
        split(joined_);
        return true;
    }
    int number() const { return number_; }
    const std::vector<std::string_view>& words() const { return words_; }
    /// All behind the first word.
    std::string rest() const {
        if (words_.size() < 2) return {};
        const char* begin = words_[1].data();
        return std::string(begin, size_t(words_.back().data() + words_.back().size() - begin));
    }

private:
    void split(std::string_view s) {
        const size_t comment = s.find('#');
        if (comment != s.npos) s = s.substr(0, comment);
        for (size_t i = 0; i < s.size();) {
            while (i < s.size() && (s[i] == ' ' || s[i] == '\t')) ++i;
            size_t end = i;
            while (end < s.size() && s[end] != ' ' && s[end] != '\t') ++end;
            if (end > i) words_.push_back(s.substr(i, end - i));
            i = end;
        }
    }
    std::string_view text_;
    std::string joined_;
    size_t at_ = 0;
    int number_ = 0, after_ = 1;
    std::vector<std::string_view> words_;
};

bool toNumber(std::string_view w, double& v) {
    const char* first = w.data() + (!w.empty() && w[0] == '+');
    const auto [end, fault] = std::from_chars(first, w.data() + w.size(), v);
    if (fault == std::errc::result_out_of_range) return v = 0, true;
    return fault == std::errc() && end == w.data() + w.size();
}

class ObjReader {
public:
    ObjReader(const std::string& path, const ReadLibrary& library, ModelLog& log) : path_(path), library_(library), log_(log) {}
    std::vector<scene::Primitive> read(std::string_view text);

private:
    struct Corner {
        int v, t, n;
    };
    struct Face {
        uint32_t first, count;
        int material, group;
    };
    SourcePlace here() const { return {path_, line_, 0}; }
    bool numbers(const std::vector<std::string_view>& w, size_t least, size_t most, double* out);
    void vertex(const std::vector<std::string_view>&);
    void face(const std::vector<std::string_view>&);
    bool corner(std::string_view word, Corner&);
    bool index(std::string_view word, size_t count, int& out);
    void library(const std::string& names);
    void materials(std::string_view text, const std::string& name);
    void use(const std::string& name);
    void dropMissing();
    void smooth();
    Vec3d normalOf(const Face&) const;
    Vec3d cornerNormal(const Face&, uint32_t corner, const Vec3d& flat) const;
    scene::Primitive part(int material, const std::vector<const Face*>&);
    void partVariables(scene::Primitive&, const std::vector<const Face*>&, const std::vector<int>& used);

    const std::string& path_;
    const ReadLibrary& library_;
    ModelLog& log_;
    int line_ = 0;
    std::vector<float> v_, color_, vt_, vn_;
    std::vector<bool> bad_;
    std::vector<Corner> corners_;
    std::vector<Face> faces_;
    std::vector<Material> materials_;
    std::map<std::string, int> byName_;
    std::set<std::string> unknown_;
    int material_ = -1, group_ = 0;
    size_t thin_ = 0;
    std::unordered_map<uint64_t, Vec3d> smooth_; ///< by vertex and group
};

bool ObjReader::numbers(const std::vector<std::string_view>& w, size_t least, size_t most, double* out) {
    const size_t n = std::min(w.size() - 1, most);
    for (size_t i = 0; i < n; ++i)
        if (!toNumber(w[i + 1], out[i])) {
            log_.error(Rie::Syntax, here(), fmt::format("\"{}\" is no number", w[i + 1].substr(0, 40)));
            return false;
        }
    if (n >= least) return true;
    log_.error(Rie::MissingData, here(), fmt::format("{} needs {} numbers", w[0], least));
    return false;
}

void ObjReader::vertex(const std::vector<std::string_view>& w) {
    double x[6] = {};
    bool good = numbers(w, 3, 6, x);
    if (good && !(std::isfinite(float(x[0])) && std::isfinite(float(x[1])) && std::isfinite(float(x[2])))) {
        log_.error(Rie::Range, here(), "a vertex is not finite: it and its faces are left out");
        good = false;
    }
    for (int k = 0; k < 3; ++k) v_.push_back(good ? float(x[k]) : 0.f);
    bad_.push_back(!good); // it keeps its number
    if (good && w.size() >= 7) {
        color_.resize(v_.size() - 3, 1.f);
        for (int k = 3; k < 6; ++k) color_.push_back(storedColor(std::isfinite(x[k]) ? x[k] : 1));
    }
}

/// An index of the file: from 1, or backwards from the last with a minus.
bool ObjReader::index(std::string_view word, size_t count, int& out) {
    long long i = 0;
    const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), i);
    if (fault != std::errc() || end != word.data() + word.size() || i == 0) {
        log_.error(Rie::Syntax, here(), fmt::format("\"{}\" is no index", word.substr(0, 40)));
        return false;
    }
    i = i > 0 ? i - 1 : (long long)(count) + i;
    if (i < 0 || i > 0x7ffffff0) {
        log_.error(Rie::Range, here(), fmt::format("index {} is before the first", word.substr(0, 40)));
        return false;
    }
    out = int(i);
    return true;
}

bool ObjReader::corner(std::string_view word, Corner& c) {
    c = {-1, -1, -1};
    const size_t a = word.find('/'), b = a == word.npos ? a : word.find('/', a + 1);
    if (!index(word.substr(0, a), v_.size() / 3, c.v)) return false;
    if (a == word.npos) return true;
    const std::string_view t = word.substr(a + 1, b == word.npos ? b : b - a - 1), n = b == word.npos ? "" : word.substr(b + 1);
    return (t.empty() || index(t, vt_.size() / 2, c.t)) && (n.empty() || index(n, vn_.size() / 3, c.n));
}

void ObjReader::face(const std::vector<std::string_view>& w) {
    const size_t first = corners_.size();
    Corner c;
    for (size_t i = 1; i < w.size(); ++i) {
        if (!corner(w[i], c)) {
            corners_.resize(first);
            return;
        }
        corners_.push_back(c);
    }
    if (corners_.size() - first < 3) {
        ++thin_;
        corners_.resize(first);
        return;
    }
    if (corners_.size() > 0x7ffffff0) {
        log_.error(Rie::Limit, here(), "there are too many corners");
        corners_.resize(first);
        return;
    }
    faces_.push_back({uint32_t(first), uint32_t(corners_.size() - first), material_, group_});
}

void ObjReader::materials(std::string_view text, const std::string& name) {
    Lines lines(text);
    Material* m = nullptr;
    while (lines.next()) {
        const auto& w = lines.words();
        if (w.empty()) continue;
        if (w[0] == "newmtl") {
            materials_.push_back({lines.rest(), "", {}, {}});
            byName_[lines.rest()] = int(materials_.size()) - 1;
            m = &materials_.back();
            continue;
        }
        if (!m || w.size() < 2) continue;
        double x[3] = {};
        const auto read = [&](size_t n) {
            for (size_t i = 0; i < n; ++i)
                if (i + 1 >= w.size() || !toNumber(w[i + 1], x[i]) || !std::isfinite(float(x[i]))) {
                    log_.error(Rie::Syntax, {name, lines.number(), 0}, fmt::format("{} needs {} numbers", w[0].substr(0, 20), n));
                    return false;
                }
            return true;
        };
        if (w[0] == "Kd" && w[1] != "spectral" && w[1] != "xyz") {
            if (read(w.size() < 4 ? 1 : 3))
                m->color = w.size() < 4 ? Color(float(x[0])) : Color(float(x[0]), float(x[1]), float(x[2]));
        } else if (w[0] == "d" && w[1] != "-halo") {
            if (read(1)) m->opacity = Color(float(std::clamp(x[0], 0.0, 1.0)));
        } else if (w[0] == "Tr") {
            if (read(1)) m->opacity = Color(float(1 - std::clamp(x[0], 0.0, 1.0)));
        } else if (w[0] == "map_Kd") {
            // Options begin with a minus and have no fixed number of words: the name is what follows the last of them.
            m->texture = w[1][0] == '-' ? std::string(w.back()) : lines.rest();
            std::replace(m->texture.begin(), m->texture.end(), '\\', '/');
        }
    }
}

void ObjReader::library(const std::string& names) {
    // One name with blanks, or several names.
    if (auto text = library_(names)) return materials(*text, names);
    bool any = false;
    size_t words = 0;
    for (size_t i = 0; i < names.size() && words < 100;) {
        const size_t end = std::min(names.find_first_of(" \t", i), names.size());
        const std::string one = names.substr(i, end - i);
        i = end + 1;
        if (one.empty() || one == names) continue;
        ++words;
        if (auto text = library_(one)) materials(*text, one), any = true;
    }
    if (!any)
        log_.warning(Rie::NoFile, here(),
                     fmt::format("material library \"{}\" was not found: its materials are left out", names.substr(0, 200)));
}

void ObjReader::use(const std::string& name) {
    auto i = byName_.find(name);
    if (i == byName_.end()) { // unknown: a part of its own all the same, with its name
        materials_.push_back({name, "", {}, {}});
        i = byName_.emplace(name, int(materials_.size()) - 1).first;
    }
    material_ = i->second;
}

Vec3d ObjReader::normalOf(const Face& f) const { // Newell's
    Vec3d n(0, 0, 0);
    const auto at = [&](uint32_t k) {
        const float* p = &v_[3 * size_t(corners_[f.first + k % f.count].v)];
        return Vec3d(p[0], p[1], p[2]);
    };
    const Vec3d o = at(0);
    for (uint32_t k = 1; k + 1 < f.count; ++k) n = n + cross(at(k) - o, at(k + 1) - o);
    return n;
}

void ObjReader::smooth() {
    for (const Face& f : faces_) {
        if (!f.group) continue;
        const Vec3d n = normalOf(f); // longer for larger faces: they count for more
        for (uint32_t k = 0; k < f.count; ++k)
            if (const Corner& c = corners_[f.first + k]; c.n < 0) {
                Vec3d& sum = smooth_[uint64_t(uint32_t(f.group)) << 32 | uint32_t(c.v)];
                sum = sum + n;
            }
    }
}

/// Faces whose indices lead beyond what was read go, indices of textures and normals only.
void ObjReader::dropMissing() {
    const int n = int(v_.size() / 3);
    size_t lost = 0, kept = 0;
    for (const Face& f : faces_) {
        bool bad = false;
        for (uint32_t k = 0; k < f.count; ++k) {
            Corner& c = corners_[f.first + k];
            bad |= c.v >= n || bad_[size_t(std::min(c.v, n - 1))];
            if (c.t >= int(vt_.size() / 2)) c.t = -1;
            if (c.n >= int(vn_.size() / 3)) c.n = -1;
        }
        lost += bad;
        if (!bad) faces_[kept++] = f;
    }
    faces_.resize(kept);
    if (lost)
        log_.error(Rie::Range, {path_, 0, 0}, fmt::format("{} faces use vertices that are not there; they are left out", lost));
    if (thin_)
        log_.warning(Rie::Range, {path_, 0, 0}, fmt::format("{} faces have fewer than three corners; they are left out", thin_));
}

Vec3d ObjReader::cornerNormal(const Face& f, uint32_t k, const Vec3d& flat) const {
    const Corner& c = corners_[f.first + k];
    if (c.n >= 0) return Vec3d(vn_[3 * size_t(c.n)], vn_[3 * size_t(c.n) + 1], vn_[3 * size_t(c.n) + 2]);
    const auto i = f.group ? smooth_.find(uint64_t(uint32_t(f.group)) << 32 | uint32_t(c.v)) : smooth_.end();
    const Vec3d n = i == smooth_.end() ? flat : i->second;
    const double l = length(n);
    return l > 0 && std::isfinite(l) ? n / l : Vec3d(0, 0, 0);
}

void ObjReader::partVariables(scene::Primitive& p, const std::vector<const Face*>& faces, const std::vector<int>& used) {
    std::vector<float> P, Cs, st, N;
    for (int v : used)
        for (size_t k = 0; k < 3; ++k) {
            P.push_back(v_[3 * size_t(v) + k]);
            if (!color_.empty()) Cs.push_back(3 * size_t(v) + k < color_.size() ? color_[3 * size_t(v) + k] : 1);
        }
    bool anyT = false, anyN = false;
    for (const Face* f : faces)
        for (uint32_t k = 0; k < f->count; ++k) {
            anyT |= corners_[f->first + k].t >= 0;
            anyN |= corners_[f->first + k].n >= 0 || f->group;
        }
    for (const Face* f : faces) {
        const Vec3d flat = anyN ? normalOf(*f) : Vec3d(0, 0, 0);
        for (uint32_t k = 0; k < f->count; ++k) {
            const Corner& c = corners_[f->first + k];
            if (anyT) {
                st.push_back(c.t >= 0 ? vt_[2 * size_t(c.t)] : 0);
                st.push_back(c.t >= 0 ? 1 - vt_[2 * size_t(c.t) + 1] : 0);
            }
            if (!anyN) continue;
            const Vec3d n = cornerNormal(*f, k, flat);
            N.insert(N.end(), {float(n.x), float(n.y), float(n.z)});
        }
    }
    p.params.push_back(variable("P", Class::Vertex, Type::Point, std::move(P)));
    if (!Cs.empty()) p.params.push_back(variable("Cs", Class::Vertex, Type::Color, std::move(Cs)));
    if (anyN) p.params.push_back(variable("N", Class::FaceVarying, Type::Normal, std::move(N)));
    if (anyT) {
        p.params.push_back(variable("st", Class::FaceVarying, Type::Float, std::move(st)));
        p.params.back().arrayLength = 2;
    }
}

scene::Primitive ObjReader::part(int material, const std::vector<const Face*>& faces) {
    scene::Primitive p;
    p.kind = "PointsPolygons";
    std::vector<int> used;
    std::unordered_map<int, int> number;
    for (const Face* f : faces) {
        p.ints.push_back(int(f->count));
        for (uint32_t k = 0; k < f->count; ++k) {
            const int v = corners_[f->first + k].v;
            const auto [i, fresh] = number.try_emplace(v, int(used.size()));
            if (fresh) used.push_back(v);
            p.ints2.push_back(i->second);
        }
    }
    partVariables(p, faces, used);
    if (material < 0) return p;
    const Material& m = materials_[size_t(material)];
    const auto text = [&](const char* name, const std::string& value) {
        scene::Param t = variable(name, Class::Constant, Type::String, {});
        t.strings = {value};
        p.params.push_back(std::move(t));
    };
    const bool painted = std::any_of(p.params.begin(), p.params.end(), [](const scene::Param& v) { return v.name == "Cs"; });
    if (m.color && !painted)
        p.params.push_back(variable("Cs", Class::Constant, Type::Color, {m.color->x, m.color->y, m.color->z}));
    if (m.opacity && m.opacity->x < 1)
        p.params.push_back(variable("Os", Class::Constant, Type::Color, std::vector<float>(3, m.opacity->x)));
    text("material", m.name);
    if (!m.texture.empty()) text("texturename", m.texture);
    return p;
}

std::vector<scene::Primitive> ObjReader::read(std::string_view text) {
    Lines lines(text);
    double x[3];
    while (lines.next()) {
        line_ = lines.number();
        const auto& w = lines.words();
        if (w.empty()) continue;
        if (w[0] == "v") vertex(w);
        else if (w[0] == "f" || w[0] == "fo") face(w);
        else if (w[0] == "vt") {
            x[0] = x[1] = 0;
            const bool good = numbers(w, 1, 2, x);
            for (int k = 0; k < 2; ++k) vt_.push_back(good && std::isfinite(float(x[k])) ? float(x[k]) : 0.f);
        } else if (w[0] == "vn") {
            const bool good = numbers(w, 3, 3, x);
            for (int k = 0; k < 3; ++k) vn_.push_back(good && std::isfinite(float(x[k])) ? float(x[k]) : 0.f);
        } else if (w[0] == "s") {
            double g = 0;
            group_ = w.size() > 1 && w[1] != "off" && toNumber(w[1], g) && g >= 0 && g < 0x7fffffff ? int(g) : 0;
        } else if (w[0] == "usemtl") use(lines.rest());
        else if (w[0] == "mtllib") library(lines.rest());
        else if (w[0] != "g" && w[0] != "o" && unknown_.size() < 50 && unknown_.insert(std::string(w[0].substr(0, 40))).second)
            log_.warning(Rie::Unimplement, here(), fmt::format("\"{}\" is not drawn", w[0].substr(0, 40)));
    }
    if (v_.empty()) {
        log_.error(Rie::MissingData, {path_, 0, 0}, "there are no vertices");
        return {};
    }
    color_.resize(color_.empty() ? 0 : v_.size(), 1.f);
    dropMissing();
    smooth();
    std::vector<std::vector<const Face*>> parts;
    std::map<int, size_t> place; // of a material among the parts
    for (const Face& f : faces_) {
        const auto [i, fresh] = place.try_emplace(f.material, parts.size());
        if (fresh) parts.emplace_back();
        parts[i->second].push_back(&f);
    }
    std::vector<scene::Primitive> out;
    for (const auto& faces : parts) out.push_back(part(faces[0]->material, faces));
    return out;
}

} // namespace

std::vector<scene::Primitive> readObj(const std::string& path, std::string_view bytes, const ReadLibrary& library,
                                      ModelLog& log) {
    return ObjReader(path, library, log).read(bytes);
}

} // namespace alpenglow::ri
