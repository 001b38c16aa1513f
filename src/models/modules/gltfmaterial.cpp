// Materials and pictures of glTF. glTF 2.0, 3.8 and 3.9; KHR_materials_*, KHR_texture_transform.
#include "gltfread.h"
#include <algorithm>

namespace alpenglow::models {

namespace {

const tinygltf::Value& extension(const tinygltf::ExtensionMap& all, const char* name) {
    static const tinygltf::Value none;
    const auto at = all.find(name);
    return at == all.end() ? none : at->second;
}

Wrap wrapOf(int w) {
    return w == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::Clamp
           : w == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::Mirror
                                                        : Wrap::Repeat;
}

void copy(const std::vector<double>& from, double* to, size_t n) {
    for (size_t i = 0; i < std::min(n, from.size()); ++i) to[i] = from[i];
}

} // namespace

void GltfReader::images() {
    for (const tinygltf::Image& i : in_.images) {
        Image& to = out_.images.emplace_back();
        to.name = !i.name.empty() ? i.name : i.uri;
        to.bytes = i.image;
        if (i.bufferView >= 0 && size_t(i.bufferView) < in_.bufferViews.size()) {
            const size_t length = in_.bufferViews[size_t(i.bufferView)].byteLength;
            size_t stride = 0;
            if (const unsigned char* b = bytes(i.bufferView, 0, length, 1, stride)) to.bytes.assign(b, b + length);
        }
        if (to.bytes.empty()) error("picture \"" + to.name + "\" cannot be read; its materials do without");
    }
}

Texture GltfReader::texture(int index, int set, const tinygltf::ExtensionMap& extensions) {
    Texture to;
    if (index < 0) return to;
    if (size_t(index) >= in_.textures.size()) {
        error("a material names a texture that is not there");
        return to;
    }
    const tinygltf::Texture& t = in_.textures[size_t(index)];
    to.image = t.source;
    to.set = set;
    if (t.source < 0) to.image = int(numberOf(extension(t.extensions, "EXT_texture_webp"), "source", kNone));
    if (to.image < 0 && extension(t.extensions, "KHR_texture_basisu").IsObject())
        error("textures in Basis Universal are not read; materials do without");
    if (to.image >= 0 && size_t(to.image) < out_.images.size() && out_.images[size_t(to.image)].bytes.empty()) to.image = kNone;
    if (t.sampler >= 0 && size_t(t.sampler) < in_.samplers.size()) {
        to.s = wrapOf(in_.samplers[size_t(t.sampler)].wrapS);
        to.t = wrapOf(in_.samplers[size_t(t.sampler)].wrapT);
    }
    const tinygltf::Value& moved = extension(extensions, "KHR_texture_transform");
    numbersOf(moved, "scale", to.scale, 2);
    numbersOf(moved, "offset", to.offset, 2);
    to.rotation = numberOf(moved, "rotation", 0);
    to.set = int(numberOf(moved, "texCoord", to.set));
    return to;
}

/// A texture that an extension names.
Texture GltfReader::textureOf(const tinygltf::Value& v, const char* name) {
    if (!v.IsObject() || !v.Has(name) || !v.Get(name).IsObject()) return {};
    const tinygltf::Value& t = v.Get(name);
    tinygltf::ExtensionMap more;
    if (t.Has("extensions") && t.Get("extensions").IsObject())
        for (const std::string& k : t.Get("extensions").Keys()) more[k] = t.Get("extensions").Get(k);
    return texture(int(numberOf(t, "index", kNone)), int(numberOf(t, "texCoord", 0)), more);
}

void GltfReader::extensions(const tinygltf::Material& m, Material& to) {
    const auto of = [&](const char* name) -> const tinygltf::Value& { return extension(m.extensions, name); };
    to.unlit = m.extensions.count("KHR_materials_unlit") > 0;
    const double strength = numberOf(of("KHR_materials_emissive_strength"), "emissiveStrength", 1);
    for (double& e : to.emission) e *= strength;
    to.ior = numberOf(of("KHR_materials_ior"), "ior", 1.5);
    const tinygltf::Value& coat = of("KHR_materials_clearcoat");
    to.coat = numberOf(coat, "clearcoatFactor", 0);
    to.coatRoughness = numberOf(coat, "clearcoatRoughnessFactor", 0);
    to.coatMap = textureOf(coat, "clearcoatTexture");
    to.coatRoughnessMap = textureOf(coat, "clearcoatRoughnessTexture");
    if (textureOf(coat, "clearcoatNormalTexture").used()) warn("the normal texture of a clear coat is left out");
    const tinygltf::Value& glass = of("KHR_materials_transmission");
    to.transmission = numberOf(glass, "transmissionFactor", 0);
    to.transmissionMap = textureOf(glass, "transmissionTexture");
    const tinygltf::Value& volume = of("KHR_materials_volume");
    to.thickness = numberOf(volume, "thicknessFactor", 0);
    to.attenuationDistance = numberOf(volume, "attenuationDistance", 0);
    numbersOf(volume, "attenuationColor", to.attenuationColor, 3);
    const tinygltf::Value& specular = of("KHR_materials_specular");
    to.specular = numberOf(specular, "specularFactor", 1);
    numbersOf(specular, "specularColorFactor", to.specularColor, 3);
    to.specularMap = textureOf(specular, "specularTexture");
    to.specularColorMap = textureOf(specular, "specularColorTexture");
    const tinygltf::Value& sheen = of("KHR_materials_sheen");
    numbersOf(sheen, "sheenColorFactor", to.sheenColor, 3);
    to.sheenRoughness = numberOf(sheen, "sheenRoughnessFactor", 0);
    to.sheenColorMap = textureOf(sheen, "sheenColorTexture");
    to.sheenRoughnessMap = textureOf(sheen, "sheenRoughnessTexture");
    static const std::set<std::string> known = {"KHR_materials_unlit",        "KHR_materials_emissive_strength",
                                                "KHR_materials_ior",          "KHR_materials_clearcoat",
                                                "KHR_materials_transmission", "KHR_materials_volume",
                                                "KHR_materials_specular",     "KHR_materials_sheen"};
    for (const auto& [name, value] : m.extensions)
        if (!known.count(name)) warn("the extension " + name + " of materials is left out");
}

void GltfReader::material(const tinygltf::Material& m, Material& to) {
    to.name = m.name;
    const tinygltf::PbrMetallicRoughness& p = m.pbrMetallicRoughness;
    copy(p.baseColorFactor, to.baseColor, 4);
    copy(m.emissiveFactor, to.emission, 3);
    to.metalness = p.metallicFactor;
    to.roughness = p.roughnessFactor;
    to.alphaCutoff = m.alphaCutoff;
    to.alphaMode = m.alphaMode == "MASK" ? AlphaMode::Mask : m.alphaMode == "BLEND" ? AlphaMode::Blend : AlphaMode::Opaque;
    to.normalScale = m.normalTexture.scale;
    to.baseColorMap = texture(p.baseColorTexture.index, p.baseColorTexture.texCoord, p.baseColorTexture.extensions);
    to.metalRoughMap =
        texture(p.metallicRoughnessTexture.index, p.metallicRoughnessTexture.texCoord, p.metallicRoughnessTexture.extensions);
    to.normalMap = texture(m.normalTexture.index, m.normalTexture.texCoord, m.normalTexture.extensions);
    to.emissionMap = texture(m.emissiveTexture.index, m.emissiveTexture.texCoord, m.emissiveTexture.extensions);
    if (m.occlusionTexture.index >= 0)
        warn("occlusion textures are left out: light is followed, so corners darken by themselves");
    extensions(m, to);
}

void GltfReader::materials() {
    for (const tinygltf::Material& m : in_.materials) material(m, out_.materials.emplace_back());
}

} // namespace alpenglow::models
