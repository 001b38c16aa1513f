// Writes small glTF files for tests: buffers as base64 in a .gltf, or as the second chunk of a .glb. glTF 2.0, 3.6 and 4.4.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace gltf_test {

class GltfWriter {
public:
    std::string materials, textures, images, samplers, nodes, meshes, cameras, skins, animations, extensions,
        scenes = R"([{"nodes":[0]}])";
    std::string used; ///< extensionsUsed, as a list in JSON

    /// Adds numbers and gives the accessor. type: "VEC3"; component: 5126 float, 5125 uint, 5123 ushort, 5121 ubyte.
    int floats(const std::vector<float>& v, const std::string& type, size_t width, const std::string& more = "") {
        return accessor(view(v.data(), v.size() * sizeof(float)), 5126, v.size() / width, type, more);
    }
    int shorts(const std::vector<uint16_t>& v, const std::string& type = "SCALAR", size_t width = 1) {
        return accessor(view(v.data(), v.size() * 2), 5123, v.size() / width, type, "");
    }
    int bytes(const std::vector<uint8_t>& v, const std::string& type, size_t width, const std::string& more = "") {
        return accessor(view(v.data(), v.size()), 5121, v.size() / width, type, more);
    }
    int view(const void* data, size_t n) {
        while (bin_.size() % 4) bin_ += '\0';
        views_ += (views_.empty() ? "" : ",") + std::string(R"({"buffer":0,"byteOffset":)") + std::to_string(bin_.size()) +
                  R"(,"byteLength":)" + std::to_string(n) + "}";
        bin_.append(static_cast<const char*>(data), n);
        return viewCount_++;
    }
    int accessor(int of, int component, size_t count, const std::string& type, const std::string& more) {
        accessors_ += (accessors_.empty() ? "" : ",") + std::string("{") +
                      (of >= 0 ? R"("bufferView":)" + std::to_string(of) + "," : "") + R"("componentType":)" +
                      std::to_string(component) + R"(,"count":)" + std::to_string(count) + R"(,"type":")" + type + "\"" + more +
                      "}";
        return accessorCount_++;
    }
    std::string text() const {
        return json(R"({"uri":"data:application/octet-stream;base64,)" + base64() + R"(","byteLength":)" + size() + "}");
    }
    std::string binary() const {
        std::string j = json(R"({"byteLength":)" + size() + "}"), b = bin_;
        while (j.size() % 4) j += ' ';
        while (b.size() % 4) b += '\0';
        return "glTF" + word(2) + word(28 + j.size() + b.size()) + word(j.size()) + "JSON" + j + word(b.size()) +
               std::string("BIN\0", 4) + b;
    }

private:
    static std::string word(size_t n) {
        const auto v = uint32_t(n);
        std::string s(4, '\0');
        std::memcpy(s.data(), &v, 4);
        return s;
    }
    std::string size() const { return std::to_string(bin_.size()); }
    std::string base64() const {
        static const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string out;
        for (size_t i = 0; i < bin_.size(); i += 3) {
            uint32_t v = 0;
            for (size_t k = 0; k < 3; ++k) v = v << 8 | (i + k < bin_.size() ? uint8_t(bin_[i + k]) : 0);
            for (size_t k = 0; k < 4; ++k) out += i + k <= bin_.size() ? letters[v >> (18 - 6 * k) & 63] : '=';
        }
        return out;
    }
    std::string json(const std::string& buffer) const {
        std::string j = R"({"asset":{"version":"2.0","generator":"test"},"scene":0,"scenes":)" + scenes;
        const std::pair<const char*, const std::string*> parts[] = {
            {"nodes", &nodes},           {"meshes", &meshes},         {"materials", &materials}, {"textures", &textures},
            {"images", &images},         {"samplers", &samplers},     {"cameras", &cameras},     {"skins", &skins},
            {"animations", &animations}, {"extensions", &extensions}, {"extensionsUsed", &used}};
        for (const auto& [name, value] : parts)
            if (!value->empty()) j += std::string(",\"") + name + "\":" + *value;
        if (accessorCount_) j += R"(,"accessors":[)" + accessors_ + "]";
        if (viewCount_) j += R"(,"bufferViews":[)" + views_ + R"(],"buffers":[)" + buffer + "]";
        return j + "}";
    }
    std::string bin_, views_, accessors_;
    int viewCount_ = 0, accessorCount_ = 0;
};

/// A square of side 2 about the origin, toward +z; uv (0, 0) at its upper left corner. Node 0 shows it with material 0.
inline GltfWriter square(const std::string& material, const std::string& more = "") {
    GltfWriter w;
    const int P = w.floats({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3", 3, R"(,"min":[-1,-1,0],"max":[1,1,0])");
    const int st = w.floats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 2);
    const int index = w.shorts({0, 1, 2, 0, 2, 3});
    w.meshes = R"([{"name":"square","primitives":[{"attributes":{"POSITION":)" + std::to_string(P) + R"(,"TEXCOORD_0":)" +
               std::to_string(st) + R"(},"indices":)" + std::to_string(index) + R"(,"material":0)" + more + "}]}]";
    w.nodes = R"([{"name":"it","mesh":0}])";
    w.materials = "[" + material + "]";
    return w;
}

} // namespace gltf_test
