#include "geometry/hierarchical_edits.h"
#include "base/limits.h"
#include "geometry/primvars.h"
#include "geometry/refined_cage.h"
#include <algorithm>

namespace alpenglow::geometry {

using scene::Class;
using scene::Primitive;

namespace {

/// An edit. Tags hold: per path its length, a face, indices of its subfaces, and a vertex or edge (not for faces); string
/// triples: "set", "add" or "subtract", a variable, and "value" or "sharpness"; floats per path in order of the strings.
struct Edit {
    enum What { Value, VertexSharpness, EdgeSharpness, Hole } what = Value;
    enum How { Set, Add, Subtract } how = Set;
    std::vector<int> path; ///< face and parts
    int corner = -1;       ///< of the last face: vertex or edge; -1: the face
    std::string variable;
    std::span<const float> floats;
};

class EditReader {
public:
    EditReader(const Primitive& p, const std::vector<scene::Param>& values, Diagnostics& diag)
        : p_(p), values_(values), diag_(diag) {}

    void read(const SubdivisionTag& t, std::vector<Edit>& out) {
        const bool faces = t.name == "faceedit";
        std::vector<Edit> ops;
        std::vector<size_t> widths;
        if (!operations(t, ops, widths)) return;
        size_t stride = 0;
        for (size_t w : widths) stride += w;
        size_t at = 0, floats = 0;
        while (at < t.ints.size()) {
            const int length = indexFrom(t.ints[at], t.ints.size() + 1);
            if (length < (faces ? 1 : 2) || at + 1 + size_t(length) > t.ints.size())
                return say(t, "the length of a path does not fit the integers; the rest is ignored");
            if (floats + stride > t.floats.size())
                return say(t, "there are fewer numbers than its paths need; the rest is ignored");
            size_t from = floats;
            for (size_t k = 0; k < ops.size(); ++k) {
                Edit e = ops[k];
                for (int i = 0; i < length; ++i) {
                    const int n = indexFrom(t.ints[at + 1 + size_t(i)], 1u << 30);
                    if (!faces && i + 1 == length) e.corner = n;
                    else e.path.push_back(n);
                }
                e.floats = widths[k] ? t.floats.subspan(from, widths[k]) : std::span<const float>();
                from += widths[k];
                out.push_back(std::move(e));
            }
            floats += stride;
            at += 1 + size_t(length);
        }
    }
    void say(const SubdivisionTag& t, const std::string& what) {
        diag_.reportOnce("geometry:edit:" + t.name + what,
                         {Severity::Warning, Rie::Consistency, p_.place, p_.kind + " tag \"" + t.name + "\": " + what, {}, {}});
    }

private:
    bool operations(const SubdivisionTag& t, std::vector<Edit>& ops, std::vector<size_t>& widths) {
        for (size_t k = 0; k < t.strings.size();) {
            Edit e;
            if (t.name == "faceedit" && t.strings[k] == "hole") {
                e.what = Edit::Hole;
                ops.push_back(e);
                widths.push_back(0);
                ++k;
                continue;
            }
            if (k + 3 > t.strings.size())
                return say(t, "its strings must be triples (operation, variable, value); it is ignored"), false;
            const std::string &how = t.strings[k], &what = t.strings[k + 2];
            e.variable = t.strings[k + 1];
            if (how == "set") e.how = Edit::Set;
            else if (how == "add") e.how = Edit::Add;
            else if (how == "subtract") e.how = Edit::Subtract;
            else return say(t, "\"" + how + "\" is none of \"set\", \"add\", \"subtract\"; it is ignored"), false;
            size_t width = 1;
            if (what == "sharpness" && t.name != "faceedit") {
                e.what = t.name == "edgeedit" ? Edit::EdgeSharpness : Edit::VertexSharpness;
            } else if (what == "value" && t.name != "edgeedit") {
                const auto v =
                    std::find_if(values_.begin(), values_.end(), [&](const scene::Param& q) { return q.name == e.variable; });
                if (v == values_.end())
                    return say(t, "there is no editable variable \"" + e.variable + "\"; it is ignored"), false;
                width = size_t(scene::componentCount(v->type)) * size_t(std::max(1, v->arrayLength));
            } else {
                return say(t, "\"" + what + "\" cannot be edited; it is ignored"), false;
            }
            ops.push_back(e);
            widths.push_back(width);
            k += 3;
        }
        if (ops.empty()) say(t, "it has no operation; it is ignored");
        return !ops.empty();
    }

    const Primitive& p_;
    const std::vector<scene::Param>& values_;
    Diagnostics& diag_;
};

float changed(Edit::How how, float old, float by) { return how == Edit::Set ? by : how == Edit::Add ? old + by : old - by; }

/// Applies an edit to a face of the cage at its level. Returns false if it names a missing corner, or an invalid value.
bool make(const Edit& e, int face, const std::vector<size_t>& first, RefinedCage& r) {
    const size_t f = size_t(face), n = size_t(r.corners[f]);
    if (e.what != Edit::Hole && e.corner < 0 && e.what != Edit::Value) return false;
    if (e.corner >= int(n)) return false;
    const auto vertexAt = [&](size_t k) { return r.vertex[first[f] + k % n]; };
    const auto sharpness = [&](std::vector<float>& list, size_t at, bool isNew) {
        if (isNew) list.push_back(0);
        list[at] = std::clamp(changed(e.how, list[at], e.floats[0]), 0.f, 10.f);
    };
    if (e.what == Edit::Hole) {
        r.cage.holes.push_back(face);
        return true;
    }
    if (e.what == Edit::VertexSharpness) {
        auto& list = r.cage.cornerVertex;
        const int v = vertexAt(size_t(e.corner));
        const size_t at = size_t(std::find(list.begin(), list.end(), v) - list.begin());
        const bool isNew = at == list.size();
        if (isNew) list.push_back(v);
        sharpness(r.cage.cornerSharpness, at, isNew);
        return true;
    }
    if (e.what == Edit::EdgeSharpness) {
        const int a = vertexAt(size_t(e.corner)), b = vertexAt(size_t(e.corner) + 1);
        auto& ends = r.cage.creaseEnds;
        size_t at = 0;
        while (2 * at < ends.size() && std::minmax(ends[2 * at], ends[2 * at + 1]) != std::minmax(a, b)) ++at;
        const bool isNew = 2 * at == ends.size();
        if (isNew) ends.insert(ends.end(), {a, b});
        sharpness(r.cage.creaseSharpness, at, isNew);
        return true;
    }
    for (scene::Param& p : r.values) {
        if (p.name != e.variable) continue;
        const size_t width = e.floats.size();
        size_t at;
        if (p.cls == Class::Uniform && e.corner < 0) at = f;
        else if (e.corner < 0) return false;
        else if (p.cls == Class::Vertex || p.cls == Class::Varying) at = size_t(vertexAt(size_t(e.corner)));
        else if (p.cls == Class::FaceVarying || p.cls == Class::FaceVertex) at = first[f] + size_t(e.corner);
        else return false;
        if ((at + 1) * width > p.numbers.size()) return false;
        for (size_t k = 0; k < width; ++k) p.numbers[at * width + k] = changed(e.how, p.numbers[at * width + k], e.floats[k]);
        return true;
    }
    return false;
}

/// The cage of the request as the first level. Other code reports variables that do not match it.
RefinedCage firstLevel(const Primitive& p, const CageInput& in) {
    RefinedCage r;
    r.cage = in.cage;
    r.corners.assign(in.cage.corners.begin(), in.cage.corners.end());
    r.vertex.assign(in.cage.vertex.begin(), in.cage.vertex.end());
    r.look();
    r.origin.assign(r.corners.size(), {0, 0});
    r.along.assign(r.corners.size(), {1, 0});
    r.across.assign(r.corners.size(), {0, 1});
    int used = -1;
    for (int v : p.ints2) used = std::max(used, v);
    const size_t vertices = size_t(std::min(used + 1, in.cage.vertices));
    for (const scene::Param& q : p.params) {
        if (q.type == scene::Type::String || q.cls == Class::Constant) continue;
        const size_t width = size_t(scene::componentCount(q.type)) * size_t(std::max(1, q.arrayLength));
        const bool byFace = q.cls == Class::Uniform, byCorner = q.cls == Class::FaceVarying || q.cls == Class::FaceVertex;
        const size_t need = byFace ? in.requestFaces : byCorner ? in.requestCorners : vertices;
        if (q.numbers.size() < need * width) continue;
        scene::Param v = q;
        const auto gather = [&](const std::vector<uint32_t>& from, size_t n) {
            v.numbers.clear();
            for (size_t i = 0; i < n; ++i) {
                const auto at = q.numbers.begin() + ptrdiff_t((from.empty() ? i : from[i]) * width);
                v.numbers.insert(v.numbers.end(), at, at + ptrdiff_t(width));
            }
        };
        if (byFace) gather(in.faceOf, r.corners.size());
        else if (byCorner) gather(in.cornerOf, r.vertex.size());
        else v.numbers.resize(size_t(in.cage.vertices) * width, 0); // points that no face uses
        r.values.push_back(std::move(v));
        r.smooth.push_back(byCorner && in.cage.scheme != SubdivisionScheme::Bilinear &&
                           (q.cls == Class::FaceVertex || !in.faceVaryingLinear));
    }
    return r;
}

/// The request with the values of the last level.
std::shared_ptr<Primitive> refinedPrimitive(const Primitive& p, RefinedCage&& r, Diagnostics& diag) {
    auto out = std::make_shared<Primitive>(p);
    out->ints = r.corners;
    out->ints2 = r.vertex;
    out->ints3.clear();
    out->strings.resize(std::min<size_t>(1, out->strings.size()));
    scene::ParamList kept;
    for (scene::Param& q : out->params) {
        if (q.name == "intargs" || q.name == "floatargs" || q.name == "stringargs") continue;
        const auto v = std::find_if(r.values.begin(), r.values.end(),
                                    [&](const scene::Param& x) { return x.name == q.name && x.cls == q.cls; });
        if (v != r.values.end()) kept.push_back(std::move(*v));
        else if (q.cls == Class::Constant) kept.push_back(std::move(q));
        else if (q.type == scene::Type::String)
            diag.report(Severity::Warning, Rie::Incapable, q.place,
                        p.kind + " \"" + q.name + "\": strings that are not constant are lost where a mesh is edited");
        else kept.push_back(std::move(q)); // reported where variables are checked
    }
    out->params = std::move(kept);
    return out;
}

} // namespace

EditedCage applyEdits(const Primitive& p, const CageInput& in, Diagnostics& diag) {
    std::vector<SubdivisionTag> tags;
    Diagnostics quiet; // readCage() has reported errors
    subdivisionTags(p, quiet, tags);
    if (std::none_of(tags.begin(), tags.end(), [](const SubdivisionTag& t) { return t.name.ends_with("edit"); })) return {};
    RefinedCage r = firstLevel(p, in);
    EditReader reader(p, r.values, diag);
    std::vector<Edit> edits;
    for (const SubdivisionTag& t : tags)
        if (t.name == "vertexedit" || t.name == "edgeedit" || t.name == "faceedit") reader.read(t, edits);
    if (edits.empty()) return {};
    size_t deepest = 0, lost = 0, tooDeep = 0;
    for (const Edit& e : edits) deepest = std::max(deepest, e.path.size() - 1);
    // By edit: face reached so far on its path; -1: none.
    std::vector<int> at(edits.size(), -1);
    for (size_t i = 0; i < edits.size(); ++i) {
        const int f = edits[i].path[0];
        if (in.faceOf.empty()) at[i] = f < int(r.corners.size()) ? f : -1;
        else if (const auto k = std::lower_bound(in.faceOf.begin(), in.faceOf.end(), uint32_t(f));
                 f >= 0 && k != in.faceOf.end() && *k == uint32_t(f))
            at[i] = int(k - in.faceOf.begin());
        if (at[i] < 0) ++lost;
    }
    for (size_t level = 0;; ++level) {
        std::vector<size_t> first(r.corners.size(), 0);
        for (size_t f = 1; f < first.size(); ++f) first[f] = first[f - 1] + size_t(r.corners[f - 1]);
        for (size_t i = 0; i < edits.size(); ++i)
            if (at[i] >= 0 && edits[i].path.size() == level + 1 && !make(edits[i], at[i], first, r)) ++lost;
        if (level == deepest) break;
        if (r.vertex.size() > limits::kEditedFaces || !r.refine()) {
            for (size_t i = 0; i < edits.size(); ++i) tooDeep += edits[i].path.size() > level + 1;
            break;
        }
        for (size_t i = 0; i < edits.size(); ++i) {
            if (at[i] < 0 || edits[i].path.size() < level + 2) continue;
            const auto& children = r.children[size_t(at[i])];
            const int k = edits[i].path[level + 1];
            at[i] = k >= 0 && k < int(children.size()) ? children[size_t(k)] : (++lost, -1);
        }
    }
    if (lost)
        diag.report(Severity::Warning, Rie::Range, p.place,
                    p.kind + ": " + std::to_string(lost) +
                        " edits name a face, vertex or edge that does not exist; they are left out");
    if (tooDeep)
        diag.report(Severity::Warning, Rie::Limit, p.place,
                    p.kind + ": " + std::to_string(tooDeep) +
                        " edits are so deep that the mesh would have too many faces; they are left out");
    EditedCage out;
    out.in.faceVaryingLinear = in.faceVaryingLinear;
    for (size_t f = 0; f < r.corners.size(); ++f) out.domains.push_back({r.origin[f], r.along[f], r.across[f]});
    out.in.cage = r.cage;
    out.primitive = refinedPrimitive(p, std::move(r), diag);
    out.in.requestFaces = out.primitive->ints.size();
    out.in.requestCorners = out.primitive->ints2.size();
    out.in.cage.corners = out.primitive->ints;
    out.in.cage.vertex = out.primitive->ints2;
    return out;
}

} // namespace alpenglow::geometry
