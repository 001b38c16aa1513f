// Meshes of glTF. glTF 2.0, 3.7.2.
#include "gltfread.h"

namespace alpenglow::models {

namespace {

/// The attribute of a name, or -1.
int attribute(const std::map<std::string, int>& all, const std::string& name) {
    const auto at = all.find(name);
    return at == all.end() ? -1 : at->second;
}

/// Strips and fans as triangles, loops and strips of lines as lists.
void ordered(int mode, const std::vector<int32_t>& index, Part& to) {
    const size_t n = index.size();
    const auto triangle = [&](size_t a, size_t b, size_t c) {
        for (const size_t i : {a, b, c}) to.corners.push_back(index[i]);
    };
    switch (mode) {
    case TINYGLTF_MODE_POINTS:
        to.corners = index;
        break;
    case TINYGLTF_MODE_LINE:
        to.corners.assign(index.begin(), index.begin() + std::ptrdiff_t(n / 2 * 2));
        to.counts.assign(n / 2, 2);
        break;
    case TINYGLTF_MODE_LINE_LOOP:
    case TINYGLTF_MODE_LINE_STRIP:
        if (n < 2) break;
        to.corners = index;
        if (mode == TINYGLTF_MODE_LINE_LOOP) to.corners.push_back(index[0]);
        to.counts.push_back(int32_t(to.corners.size()));
        break;
    case TINYGLTF_MODE_TRIANGLE_STRIP:
        for (size_t i = 2; i < n; ++i) triangle(i - 2, i % 2 ? i : i - 1, i % 2 ? i - 1 : i);
        break;
    case TINYGLTF_MODE_TRIANGLE_FAN:
        for (size_t i = 2; i < n; ++i) triangle(i - 1, i, 0);
        break;
    default:
        to.corners.assign(index.begin(), index.begin() + std::ptrdiff_t(n / 3 * 3));
    }
}

} // namespace

void GltfReader::corners(const tinygltf::Primitive& p, Part& to) {
    const size_t n = to.vertices();
    std::vector<int32_t> index;
    if (p.indices >= 0) {
        for (const double v : numbers(p.indices, "indices", 1)) index.push_back(v >= 0 && v < double(n) ? int32_t(v) : -1);
    } else {
        for (size_t i = 0; i < n; ++i) index.push_back(int32_t(i));
    }
    to.kind = p.mode == TINYGLTF_MODE_POINTS                                       ? PartKind::Points
              : p.mode >= TINYGLTF_MODE_LINE && p.mode <= TINYGLTF_MODE_LINE_STRIP ? PartKind::Lines
                                                                                   : PartKind::Polygons;
    if (p.mode < 0 || p.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        error("a mesh has a mode that glTF does not have; triangles are taken");
    ordered(p.mode, index, to);
}

void GltfReader::skinned(const tinygltf::Primitive& p, Part& to) {
    std::vector<std::vector<double>> joints, weights;
    for (int set = 0; set < 4; ++set) {
        const std::string k = std::to_string(set);
        std::vector<double> j = numbers(attribute(p.attributes, "JOINTS_" + k), "joints", 4),
                            w = numbers(attribute(p.attributes, "WEIGHTS_" + k), "weights", 4);
        if (j.empty() || w.empty()) break;
        if (j.size() != to.vertices() * 4 || w.size() != j.size()) {
            error("a mesh has another number of joints or weights than of vertices");
            break;
        }
        joints.push_back(std::move(j));
        weights.push_back(std::move(w));
    }
    to.influences = int32_t(4 * joints.size());
    for (size_t v = 0; v < to.vertices() && !joints.empty(); ++v)
        for (size_t set = 0; set < joints.size(); ++set)
            for (size_t k = 0; k < 4; ++k) {
                to.joints.push_back(int32_t(joints[set][v * 4 + k]));
                to.weights.push_back(float(weights[set][v * 4 + k]));
            }
}

void GltfReader::part(const tinygltf::Primitive& p, Part& to) {
    to.material = p.material;
    to.P = floats(attribute(p.attributes, "POSITION"), "positions", 3);
    if (to.P.empty()) {
        error("a part of a mesh has no positions");
        return;
    }
    to.N = floats(attribute(p.attributes, "NORMAL"), "normals", 3);
    for (int set = 0; set < 8; ++set) {
        const int a = attribute(p.attributes, "TEXCOORD_" + std::to_string(set));
        if (a < 0) break;
        to.st.push_back(floats(a, "texture coordinates", 2));
    }
    if (const int a = attribute(p.attributes, "COLOR_0"); a >= 0) {
        size_t width = 0;
        const std::vector<float> c = floats(a, "colours", 0, &width);
        if (width == 3 || width == 4)
            for (size_t i = 0; i + width <= c.size(); i += width) {
                to.color.insert(to.color.end(), c.begin() + std::ptrdiff_t(i), c.begin() + std::ptrdiff_t(i) + 3);
                to.color.push_back(width == 4 ? c[i + 3] : 1.f);
            }
        else if (!c.empty()) error("the colours of a mesh are neither three nor four numbers");
    }
    corners(p, to);
    skinned(p, to);
    for (const std::map<std::string, int>& t : p.targets) {
        MorphTarget& m = to.targets.emplace_back();
        m.P = floats(attribute(t, "POSITION"), "positions of a morph target", 3);
        m.N = floats(attribute(t, "NORMAL"), "normals of a morph target", 3);
    }
}

void GltfReader::meshes() {
    for (const tinygltf::Mesh& m : in_.meshes) {
        Mesh& to = out_.meshes.emplace_back();
        to.name = m.name;
        to.weights = m.weights;
        for (const tinygltf::Primitive& p : m.primitives) part(p, to.parts.emplace_back());
    }
}

} // namespace alpenglow::models
