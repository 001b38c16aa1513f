// Materials of assimp as glTF's: those of physically based formats as they are, those of Phong's kind by their colours and
// shininess.
#include "assimpread.h"
#include <algorithm>
#include <assimp/material.h>
#include <cmath>
#include <filesystem>

namespace alpenglow::models {

namespace fs = std::filesystem;

namespace {

Wrap wrapFor(aiTextureMapMode m) {
    return m == aiTextureMapMode_Clamp || m == aiTextureMapMode_Decal ? Wrap::Clamp
           : m == aiTextureMapMode_Mirror                             ? Wrap::Mirror
                                                                      : Wrap::Repeat;
}

/// Three numbers of a material; false: it has none of that name.
bool color(const aiMaterial& m, const char* key, unsigned type, unsigned index, double* to) {
    aiColor4D c;
    if (aiGetMaterialColor(&m, key, type, index, &c) != aiReturn_SUCCESS) return false;
    to[0] = double(c.r), to[1] = double(c.g), to[2] = double(c.b);
    return true;
}

bool number(const aiMaterial& m, const char* key, unsigned type, unsigned index, double* to) {
    ai_real v = 0;
    if (aiGetMaterialFloatArray(&m, key, type, index, &v, nullptr) != aiReturn_SUCCESS) return false;
    *to = double(v);
    return true;
}

} // namespace

/// Pictures inside of the file; "*0", or the name of one, is how materials call them.
void AssimpReader::images() {
    for (unsigned i = 0; i < scene_.mNumTextures; ++i) {
        const aiTexture& t = *scene_.mTextures[i];
        Image& to = out_.images.emplace_back();
        to.name = fs::path(t.mFilename.C_Str()).filename().string();
        if (t.mHeight == 0) {
            const auto* b = reinterpret_cast<const uint8_t*>(t.pcData);
            to.bytes.assign(b, b + t.mWidth);
        } else { // texels as they are: a Targa file of them
            const unsigned w = std::min(t.mWidth, 65535u), h = std::min(t.mHeight, 65535u);
            to.bytes = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, uint8_t(w), uint8_t(w >> 8), uint8_t(h), uint8_t(h >> 8), 32, 0x28};
            for (size_t y = 0; y < h; ++y)
                for (size_t x = 0; x < w; ++x) {
                    const aiTexel& e = t.pcData[y * t.mWidth + x];
                    for (const uint8_t c : {e.b, e.g, e.r, e.a}) to.bytes.push_back(c);
                }
        }
        images_["*" + std::to_string(i)] = int(i);
        if (!to.name.empty()) images_.try_emplace(t.mFilename.C_Str(), int(i));
    }
}

/// The picture of a name: in the model's folder or below, wherever the file says that it was.
int AssimpReader::imageOf(const std::string& name) {
    if (const auto at = images_.find(name); at != images_.end()) return at->second;
    std::string slashes = name;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    std::error_code e;
    const fs::path parent = fs::path(path_).parent_path(), folder = fs::canonical(parent.empty() ? fs::path(".") : parent, e);
    int found = kNone;
    for (const fs::path& p : {fs::path(slashes), fs::path(slashes).filename(), "textures" / fs::path(slashes).filename()}) {
        if (p.empty()) continue;
        const fs::path file = fs::canonical(folder / p, e);
        if (e || !fs::is_regular_file(file, e)) continue;
        if (std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first != folder.end()) continue;
        found = int(out_.images.size());
        out_.images.push_back({p.filename().string(), file.string(), {}});
        break;
    }
    if (found == kNone)
        error("picture \"" + name.substr(0, 200) + "\" is not in the model's folder or below; its materials do without");
    images_[name] = found;
    return found;
}

Texture AssimpReader::texture(const aiMaterial& m, aiTextureType type) {
    Texture t;
    aiString name;
    unsigned set = 0;
    aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
    if (m.GetTextureCount(type) == 0 || m.GetTexture(type, 0, &name, nullptr, &set, nullptr, nullptr, modes) != aiReturn_SUCCESS)
        return t;
    t.image = imageOf(name.C_Str());
    t.set = int(set);
    t.s = wrapFor(modes[0]);
    t.t = wrapFor(modes[1]);
    return t;
}

void AssimpReader::material(const aiMaterial& m, Material& to) {
    aiString name;
    if (m.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) to.name = name.C_Str();
    to.metalness = 0;
    to.roughness = .5;
    to.baseColorMap = texture(m, aiTextureType_BASE_COLOR);
    if (!to.baseColorMap.used()) to.baseColorMap = texture(m, aiTextureType_DIFFUSE);
    if (!color(m, AI_MATKEY_BASE_COLOR, to.baseColor)) color(m, AI_MATKEY_COLOR_DIFFUSE, to.baseColor);
    if (to.baseColorMap.used() && std::max({to.baseColor[0], to.baseColor[1], to.baseColor[2]}) == 0)
        std::fill(to.baseColor, to.baseColor + 3, 1.0); // black under a map is what exporters leave there
    number(m, AI_MATKEY_METALLIC_FACTOR, &to.metalness);
    double shininess = 0;
    number(m, AI_MATKEY_SHININESS, &shininess);
    if (!number(m, AI_MATKEY_ROUGHNESS_FACTOR, &to.roughness) && shininess > 0)
        to.roughness = std::sqrt(std::sqrt(2 / (shininess + 2))); // Blinn's exponent as GGX's width, alpha = sqrt(2 / (n + 2))
    double specular[3] = {1, 1, 1};
    if (color(m, AI_MATKEY_COLOR_SPECULAR, specular) && std::max({specular[0], specular[1], specular[2]}) == 0) to.specular = 0;
    color(m, AI_MATKEY_COLOR_EMISSIVE, to.emission);
    to.emissionMap = texture(m, aiTextureType_EMISSIVE);
    to.normalMap = texture(m, aiTextureType_NORMALS);
    number(m, AI_MATKEY_REFRACTI, &to.ior);
    number(m, AI_MATKEY_TRANSMISSION_FACTOR, &to.transmission);
    number(m, AI_MATKEY_CLEARCOAT_FACTOR, &to.coat);
    number(m, AI_MATKEY_CLEARCOAT_ROUGHNESS_FACTOR, &to.coatRoughness);
    if (number(m, AI_MATKEY_OPACITY, &to.baseColor[3]) && to.baseColor[3] < 1) to.alphaMode = AlphaMode::Blend;
    if (texture(m, aiTextureType_OPACITY).used()) warn("textures of opacity are left out");
    if (texture(m, aiTextureType_HEIGHT).used()) warn("textures of heights are left out");
    if (to.ior <= 1) to.ior = 1.5; // formats without one say 0 or 1
}

void AssimpReader::materials() {
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i) material(*scene_.mMaterials[i], out_.materials.emplace_back());
}

} // namespace alpenglow::models
