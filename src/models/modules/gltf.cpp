// libalpenglow_gltf.so: glTF 2.0 by tinygltf, with Draco where that was there. Loaded by a child process when such a file is met
// (modelfile.h); nothing else of the program knows tinygltf.
#include "gltfread.h"
#include "models/modelfile.h"
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>

namespace alpenglow::models {

namespace fs = std::filesystem;

namespace {

/// The folder of a model, and the file, which may be a link: the user named it.
struct Place {
    fs::path folder, model;
};

/// Whether a file lies in the folder of the model or below, links followed.
bool inFolder(const std::string& path, void* place) {
    std::error_code e;
    const fs::path file = fs::canonical(path, e);
    if (e || !fs::is_regular_file(file, e)) return false;
    const Place& of = *static_cast<const Place*>(place);
    const auto [end, rest] = std::mismatch(of.folder.begin(), of.folder.end(), file.begin(), file.end());
    return end == of.folder.end() || file == of.model;
}

/// Pictures stay as they are encoded. Those in buffers are fetched later, when their places have been looked at.
bool keepPicture(tinygltf::Image* to, const int, std::string*, std::string*, int, int, const unsigned char* bytes, int size,
                 void*) {
    if (to->bufferView == -1 && size > 0) to->image.assign(bytes, bytes + size);
    to->as_is = true;
    return true;
}

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

Matrix matrixOf(const double* m) {
    Matrix out; // columns of p' = M p are the rows of p' = p M
    std::memcpy(out.m, m, sizeof out.m);
    return out;
}

void copy(const std::vector<double>& from, double* to, size_t n) {
    if (from.size() == n) std::copy(from.begin(), from.end(), to);
}

void read(const std::string& path, Model& out) {
    tinygltf::TinyGLTF loader;
    std::error_code e;
    const fs::path parent = fs::path(path).parent_path();
    Place place{fs::canonical(parent.empty() ? fs::path(".") : parent, e), fs::canonical(path, e)};
    tinygltf::FsCallbacks files{};
    files.FileExists = inFolder;
    files.ExpandFilePath = [](const std::string& p, void*) { return p; }; // no "~" and no variables
    files.ReadWholeFile = [](std::vector<unsigned char>* to, std::string* err, const std::string& p, void* user) {
        if (inFolder(p, user)) return tinygltf::ReadWholeFile(to, err, p, nullptr);
        *err += "\"" + p + "\" is not there, or not below the model's folder\n";
        return false;
    };
    files.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; };
    files.user_data = &place;
    loader.SetFsCallbacks(files);
    loader.SetImageLoader(keepPicture, nullptr);
    const fs::path whole = fs::absolute(path, e);
    FILE* f = std::fopen(whole.c_str(), "rb");
    if (!f) throw std::runtime_error(std::strerror(errno));
    char magic[4] = {};
    const bool binary = std::fread(magic, 1, 4, f) == 4 && std::memcmp(magic, "glTF", 4) == 0;
    std::fclose(f);
    tinygltf::Model model;
    std::string error, warning;
    const bool good = binary ? loader.LoadBinaryFromFile(&model, &error, &warning, whole.string())
                             : loader.LoadASCIIFromFile(&model, &error, &warning, whole.string());
    if (!good) throw std::runtime_error(error.empty() ? "it is no glTF" : firstLine(error));
    if (model.asset.version.rfind("2", 0) != 0)
        throw std::runtime_error("it is glTF " + model.asset.version.substr(0, 20) + "; version 2 is read");
    for (size_t at = 0; at < warning.size();) {
        const std::string line = firstLine(warning.substr(at));
        at += line.size() + 1;
        if (!line.empty()) out.notes.push_back({false, line});
    }
    GltfReader(model, out).all();
}

} // namespace

void GltfReader::required() {
    static const char* const known[] = {"KHR_draco_mesh_compression",
                                        "KHR_lights_punctual",
                                        "KHR_materials_clearcoat",
                                        "KHR_materials_emissive_strength",
                                        "KHR_materials_ior",
                                        "KHR_materials_sheen",
                                        "KHR_materials_specular",
                                        "KHR_materials_transmission",
                                        "KHR_materials_unlit",
                                        "KHR_materials_volume",
                                        "KHR_mesh_quantization",
                                        "KHR_texture_transform",
                                        "EXT_texture_webp"};
    for (const std::string& name : in_.extensionsRequired) {
        const bool here = std::any_of(std::begin(known), std::end(known), [&](const char* k) { return name == k; });
#ifndef TINYGLTF_ENABLE_DRACO
        if (name == known[0]) error("its meshes are compressed by Draco, without which this program was built");
#endif
        if (!here) error("it requires the extension " + name + ", which is not known here; what is known is shown");
    }
}

void GltfReader::node(const tinygltf::Node& n, Node& to) {
    to.name = n.name;
    if (n.matrix.size() == 16) {
        to.hasMatrix = true;
        to.matrix = matrixOf(n.matrix.data());
    }
    copy(n.translation, to.translation, 3);
    copy(n.rotation, to.rotation, 4);
    copy(n.scale, to.scale, 3);
    if (n.mesh >= 0) to.meshes.push_back(n.mesh);
    to.skin = n.skin;
    to.camera = n.camera;
    to.weights = n.weights;
    if (const auto l = n.extensions.find("KHR_lights_punctual"); l != n.extensions.end())
        to.light = int(numberOf(l->second, "light", kNone));
}

void GltfReader::nodes() {
    out_.nodes.resize(in_.nodes.size());
    for (size_t i = 0; i < in_.nodes.size(); ++i) node(in_.nodes[i], out_.nodes[i]);
    for (size_t i = 0; i < in_.nodes.size(); ++i)
        for (const int c : in_.nodes[i].children) {
            if (c < 0 || size_t(c) >= in_.nodes.size()) error("a node names a child that is not there");
            else if (out_.nodes[size_t(c)].parent != kNone) error("a node has two parents; it stays with the first");
            else out_.nodes[size_t(c)].parent = int(i);
        }
}

void GltfReader::roots() {
    const size_t which = in_.defaultScene >= 0 ? size_t(in_.defaultScene) : 0;
    if (which < in_.scenes.size()) {
        out_.roots.assign(in_.scenes[which].nodes.begin(), in_.scenes[which].nodes.end());
        if (in_.scenes.size() > 1) warn(fmt::format("scene {} of {} is shown", which, in_.scenes.size()));
        return;
    }
    if (in_.defaultScene >= 0) error("the scene that is to be shown is not there; all nodes are shown");
    for (size_t i = 0; i < out_.nodes.size(); ++i)
        if (out_.nodes[i].parent == kNone) out_.roots.push_back(int(i));
}

void GltfReader::cameras() {
    for (const tinygltf::Camera& c : in_.cameras) {
        Camera& to = out_.cameras.emplace_back();
        to.name = c.name;
        to.perspective = c.type != "orthographic";
        if (to.perspective) {
            to.yfov = c.perspective.yfov;
            to.aspect = c.perspective.aspectRatio;
            to.near = c.perspective.znear;
            to.far = c.perspective.zfar;
        } else {
            to.halfHeight = c.orthographic.ymag;
            to.aspect = c.orthographic.ymag != 0 ? c.orthographic.xmag / c.orthographic.ymag : 0;
            to.near = c.orthographic.znear;
            to.far = c.orthographic.zfar;
        }
    }
}

void GltfReader::lights() {
    for (const tinygltf::Light& l : in_.lights) {
        Light& to = out_.lights.emplace_back();
        to.name = l.name;
        to.kind = l.type == "directional" ? LightKind::Sun : l.type == "spot" ? LightKind::Spot : LightKind::Point;
        copy(l.color, to.color, 3);
        to.intensity = l.intensity;
        to.inner = l.spot.innerConeAngle;
        to.outer = l.spot.outerConeAngle;
        if (l.range > 0) warn("the range of lights is not kept: light falls with the square of the distance");
    }
}

void GltfReader::skins() {
    for (const tinygltf::Skin& s : in_.skins) {
        Skin& to = out_.skins.emplace_back();
        to.joints.assign(s.joints.begin(), s.joints.end());
        const std::vector<double> m = numbers(s.inverseBindMatrices, "inverse bind matrices", 16);
        for (size_t i = 0; i + 16 <= m.size() && to.bindings.size() < to.joints.size(); i += 16)
            to.bindings.push_back(matrixOf(&m[i]));
    }
}

void GltfReader::animations() {
    for (const tinygltf::Animation& a : in_.animations) {
        Animation& to = out_.animations.emplace_back();
        to.name = a.name;
        for (const tinygltf::AnimationChannel& c : a.channels) {
            if (c.sampler < 0 || size_t(c.sampler) >= a.samplers.size()) {
                error("an animation names a sampler that is not there");
                continue;
            }
            const tinygltf::AnimationSampler& s = a.samplers[size_t(c.sampler)];
            Channel ch;
            ch.node = c.target_node;
            if (c.target_path == "translation") ch.path = Path::Translation;
            else if (c.target_path == "rotation") ch.path = Path::Rotation;
            else if (c.target_path == "scale") ch.path = Path::Scale;
            else if (c.target_path == "weights") ch.path = Path::Weights;
            else {
                warn("an animation of \"" + c.target_path.substr(0, 40) + "\" is left out");
                continue;
            }
            ch.interpolation = s.interpolation == "STEP"          ? Interpolation::Step
                               : s.interpolation == "CUBICSPLINE" ? Interpolation::Cubic
                                                                  : Interpolation::Linear;
            ch.times = floats(s.input, "times", 1);
            ch.values = floats(s.output, "keys", 0);
            to.channels.push_back(std::move(ch));
        }
    }
}

void GltfReader::all() {
    out_.generator = in_.asset.generator;
    required();
    images();
    materials();
    meshes();
    nodes();
    roots();
    cameras();
    lights();
    skins();
    animations();
}

} // namespace alpenglow::models

extern "C" int alpenglow_read_model(const char* path, int to, char* why, int whySize) {
    return alpenglow::models::sendModel(path, to, why, whySize, alpenglow::models::read);
}
