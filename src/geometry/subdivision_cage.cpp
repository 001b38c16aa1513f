#include "geometry/subdivision_cage.h"
#include "geometry/primvars.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

using scene::Primitive;

int indexFrom(float number, size_t count) {
    return number >= 0 && double(number) < double(count) && number < 2147483520.f ? int(number) : -1;
}

bool subdivisionTags(const Primitive& p, Diagnostics& diag, std::vector<SubdivisionTag>& out) {
    const size_t count = p.strings.empty() ? 0 : p.strings.size() - 1, per = p.kind == "SubdivisionMesh" ? 2 : 3;
    const scene::Param* ints = lastParam(p.params, "intargs");
    const scene::Param* floats = lastParam(p.params, "floatargs");
    const scene::Param* strings = lastParam(p.params, "stringargs");
    const auto fail = [&] {
        diag.report(Severity::Error, Rie::Consistency, p.place,
                    p.kind + ": the counts of the tags' arguments do not fit the arguments; the tags are ignored");
        out.clear();
        return false;
    };
    if (p.ints3.size() < per * count) return fail();
    size_t used[3] = {0, 0, 0};
    const size_t have[3] = {ints ? ints->numbers.size() : 0, floats ? floats->numbers.size() : 0,
                            strings ? strings->strings.size() : 0};
    for (size_t i = 0; i < count; ++i) {
        size_t n[3] = {0, 0, 0};
        for (size_t k = 0; k < per; ++k) {
            const int given = p.ints3[per * i + k];
            if (given < 0 || size_t(given) > have[k] - used[k]) return fail();
            n[k] = size_t(given);
        }
        SubdivisionTag t;
        t.name = p.strings[i + 1];
        if (n[0]) t.ints = {&ints->numbers[used[0]], n[0]};
        if (n[1]) t.floats = {&floats->numbers[used[1]], n[1]};
        if (n[2]) t.strings = {&strings->strings[used[2]], n[2]};
        for (size_t k = 0; k < 3; ++k) used[k] += n[k];
        out.push_back(t);
    }
    return true;
}

namespace {

class TagReader {
public:
    TagReader(const Primitive& p, size_t points, CageInput& in, Diagnostics& diag)
        : p_(p), points_(points), in_(in), diag_(diag) {}

    void read(const SubdivisionTag& t) {
        if (t.name == "crease") crease(t);
        else if (t.name == "corner") corner(t);
        else if (t.name == "hole") hole(t);
        else if (t.name == "interpolateboundary") boundary(t);
        else if (t.name == "facevaryinginterpolateboundary") faceVarying_ = choice(t, 1, 3);
        else if (t.name == "facevaryingpropagatecorners") propagate_ = choice(t, 1, 1) != 0;
        else if (t.name == "smoothtriangles") in_.cage.smoothTriangles = choice(t, 2, 2) == 2;
        else if (t.name == "creasemethod") creaseMethod(t);
        else if (t.name == "vertexedit" || t.name == "edgeedit" || t.name == "faceedit") {
            if (p_.kind == "SubdivisionMesh") say(t, "edits belong to HierarchicalSubdivisionMesh; it is ignored");
        } else say(t, "the tag is unknown; it is ignored");
    }
    void finish() {
        using F = SubdivisionCage::FaceVarying;
        in_.faceVaryingLinear = faceVarying_ == 0;
        // facevertex variables are smooth regardless of the tag.
        in_.cage.faceVarying = faceVarying_ == 2   ? F::EdgeOnly
                               : faceVarying_ == 3 ? F::AlwaysSharp
                               : propagate_        ? F::EdgeAndCornerPropagate
                                                   : F::EdgeAndCorner;
    }

private:
    void say(const SubdivisionTag& t, const std::string& what) {
        diag_.reportOnce("geometry:tag:" + t.name + what,
                         {Severity::Warning, Rie::BadToken, p_.place, p_.kind + " tag \"" + t.name + "\": " + what, {}, {}});
    }
    int vertex(float number) const { return indexFrom(number, points_); }
    static float sharp(float s) { return s > 0 ? std::min(s, 10.f) : 0; }

    void crease(const SubdivisionTag& t) {
        const size_t edges = t.ints.size() < 2 ? 0 : t.ints.size() - 1;
        if (!edges || (t.floats.size() != 1 && t.floats.size() != edges))
            return say(t, "needs two vertices or more, and one sharpness or one an edge; it is ignored");
        bool bad = false;
        for (size_t k = 0; k < edges; ++k) {
            const int a = vertex(t.ints[k]), b = vertex(t.ints[k + 1]);
            if (a < 0 || b < 0 || a == b) {
                bad = true;
                continue;
            }
            in_.cage.creaseEnds.insert(in_.cage.creaseEnds.end(), {a, b});
            in_.cage.creaseSharpness.push_back(sharp(t.floats[t.floats.size() == 1 ? 0 : k]));
        }
        if (bad) say(t, "names a vertex that does not exist; that edge is ignored");
    }
    void corner(const SubdivisionTag& t) {
        if (t.ints.empty() || (t.floats.size() != 1 && t.floats.size() != t.ints.size()))
            return say(t, "needs vertices, and one sharpness or one a vertex; it is ignored");
        bool bad = false;
        for (size_t k = 0; k < t.ints.size(); ++k) {
            const int a = vertex(t.ints[k]);
            if (a < 0) {
                bad = true;
                continue;
            }
            in_.cage.cornerVertex.push_back(a);
            in_.cage.cornerSharpness.push_back(sharp(t.floats[t.floats.size() == 1 ? 0 : k]));
        }
        if (bad) say(t, "names a vertex that does not exist; it is left out");
    }
    void hole(const SubdivisionTag& t) {
        bool bad = false;
        for (float f : t.ints) {
            const int face = indexFrom(f, in_.requestFaces);
            if (face < 0) bad = true;
            else in_.cage.holes.push_back(face);
        }
        if (bad) say(t, "names a face that does not exist; it is left out");
    }
    void boundary(const SubdivisionTag& t) {
        using B = SubdivisionCage::Boundary;
        const int n = choice(t, 1, 2);
        in_.cage.boundary = n == 0 ? B::None : n == 2 ? B::EdgeOnly : B::EdgeAndCorner;
    }
    /// The integer of a tag that has one at most: `none` where it is missing.
    int choice(const SubdivisionTag& t, int none, int most) {
        float n = float(none);
        if (!t.ints.empty()) n = t.ints[0];
        else if (!t.floats.empty()) n = t.floats[0];
        if (!(n >= 0 && n <= float(most))) {
            say(t, "its value is none of 0 to " + std::to_string(most) + "; taken as " + std::to_string(none));
            return none;
        }
        return int(n);
    }
    void creaseMethod(const SubdivisionTag& t) {
        if (t.strings.empty()) in_.cage.chaikin = choice(t, 0, 1) == 1;
        else if (t.strings[0] == "chaikin") in_.cage.chaikin = true;
        else if (t.strings[0] == "normal") in_.cage.chaikin = false;
        else say(t, "\"" + t.strings[0] + "\" is neither \"normal\" nor \"chaikin\"; it is ignored");
    }

    const Primitive& p_;
    size_t points_;
    CageInput& in_;
    Diagnostics& diag_;
    int faceVarying_ = 0;
    bool propagate_ = false;
};

SubdivisionScheme schemeOf(const Primitive& p, Diagnostics& diag) {
    const std::string name = p.strings.empty() ? "catmull-clark" : p.strings[0];
    bool triangles = true;
    for (int n : p.ints) triangles &= n == 3;
    const auto say = [&](const std::string& what) {
        diag.report(Severity::Warning, Rie::BadToken, p.place, p.kind + ": " + what);
    };
    if (name == "loop") {
        if (triangles) return SubdivisionScheme::Loop;
        say("scheme \"loop\" is for triangles, and it has other faces; drawn as \"catmull-clark\"");
        return SubdivisionScheme::CatmullClark;
    }
    if (name == "bilinear") return SubdivisionScheme::Bilinear;
    if (name != "catmull-clark" && name != "catmark") say("scheme \"" + name + "\" is unknown; drawn as \"catmull-clark\"");
    return SubdivisionScheme::CatmullClark;
}

/// Valid faces: at least three corners, on existing points, without repetition.
struct Sound {
    size_t beyond = 0, thin = 0, twice = 0;
    std::vector<uint8_t> face;
    bool all() const { return beyond + thin + twice == 0; }
};

Sound soundFaces(const Primitive& p, size_t points) {
    constexpr int kMostCorners = 4096; // of a face; the pieces of a face grow with them, and their neighbours' patterns
    Sound s;
    s.face.assign(p.ints.size(), 1);
    size_t corner = 0;
    std::vector<int> sorted;
    for (size_t f = 0; f < p.ints.size(); ++f) {
        const size_t n = size_t(std::max(0, p.ints[f])), first = corner;
        corner += n;
        size_t* why = nullptr;
        if (n < 3 || n > size_t(kMostCorners)) why = &s.thin;
        for (size_t c = first; c < corner && !why; ++c)
            if (p.ints2[c] < 0 || size_t(p.ints2[c]) >= points) why = &s.beyond;
        if (!why && n <= 4) {
            for (size_t a = first; a < corner && !why; ++a)
                for (size_t b = a + 1; b < corner; ++b)
                    if (p.ints2[a] == p.ints2[b]) why = &s.twice;
        } else if (!why) {
            sorted.assign(p.ints2.begin() + ptrdiff_t(first), p.ints2.begin() + ptrdiff_t(corner));
            std::sort(sorted.begin(), sorted.end());
            if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) why = &s.twice;
        }
        if (why) s.face[f] = 0, ++*why;
    }
    return s;
}

/// Removes invalid faces, and updates the indices of holes.
void leaveOut(const Primitive& p, const Sound& sound, CageInput& in) {
    std::vector<int> place(p.ints.size(), -1);
    size_t corner = 0;
    for (size_t f = 0; f < p.ints.size(); ++f) {
        const size_t n = size_t(std::max(0, p.ints[f]));
        if (sound.face[f]) {
            place[f] = int(in.corners.size());
            in.corners.push_back(p.ints[f]);
            in.faceOf.push_back(uint32_t(f));
            for (size_t c = corner; c < corner + n; ++c) {
                in.vertex.push_back(p.ints2[c]);
                in.cornerOf.push_back(uint32_t(c));
            }
        }
        corner += n;
    }
    std::vector<int> holes;
    for (int h : in.cage.holes)
        if (place[size_t(h)] >= 0) holes.push_back(place[size_t(h)]);
    in.cage.holes = std::move(holes);
    in.cage.corners = in.corners;
    in.cage.vertex = in.vertex;
}

} // namespace

bool readCage(const Primitive& p, Diagnostics& diag, CageInput& in) {
    const scene::Param* P = lastParam(p.params, "P");
    const auto fail = [&](Rie code, const std::string& why) {
        diag.report(Severity::Error, code, p.place, p.kind + ": " + why + "; it is not drawn");
        return false;
    };
    if (!P || P->numbers.size() < 3) return fail(Rie::MissingData, "\"P\" is missing");
    const size_t points = P->numbers.size() / 3;
    for (float f : P->numbers)
        if (!std::isfinite(f)) return fail(Rie::Range, "\"P\" holds a number that is not finite");
    size_t corners = 0;
    for (int n : p.ints) {
        if (n < 0 || size_t(n) > p.ints2.size() - corners)
            return fail(Rie::Consistency, "nverts and verts do not fit each other");
        corners += size_t(n);
    }
    if (points > size_t(INT32_MAX) || corners > size_t(INT32_MAX) / 2) return fail(Rie::Limit, "too many points");
    in.requestFaces = p.ints.size();
    in.requestCorners = corners;
    in.cage.scheme = schemeOf(p, diag);
    in.cage.vertices = int(points);
    TagReader reader(p, points, in, diag);
    std::vector<SubdivisionTag> tags;
    subdivisionTags(p, diag, tags);
    for (const SubdivisionTag& t : tags) reader.read(t);
    reader.finish();
    const Sound sound = soundFaces(p, points);
    if (sound.beyond)
        diag.report(Severity::Error, Rie::Range, P->place,
                    p.kind + ": " + std::to_string(sound.beyond) + " faces use points beyond the " + std::to_string(points) +
                        " given; they are not drawn");
    if (sound.thin)
        diag.report(Severity::Warning, Rie::Range, p.place,
                    p.kind + ": " + std::to_string(sound.thin) +
                        " faces have fewer than three corners or more than 4096; they are not drawn");
    if (sound.twice)
        diag.report(Severity::Warning, Rie::Range, p.place,
                    p.kind + ": " + std::to_string(sound.twice) + " faces use one of their points twice; they are not drawn");
    if (sound.all()) {
        in.cage.corners = p.ints;
        in.cage.vertex = {p.ints2.data(), corners};
    } else {
        leaveOut(p, sound, in);
    }
    if (in.cage.corners.empty()) return sound.all() ? fail(Rie::MissingData, "it has no faces") : false;
    return true;
}

} // namespace alpenglow::geometry
