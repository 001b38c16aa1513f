// What the parts of the module for glTF share. The file is a stranger's: each index is looked at before it is used.
#pragma once
#include "models/model.h"
#include <set>
#include <string>
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace alpenglow::models {

/// Takes a file that tinygltf has parsed over into a Model.
class GltfReader {
public:
    /// File and model must outlive the reader.
    GltfReader(const tinygltf::Model& in, Model& out) : in_(in), out_(out) {}
    /// Fills the model; what cannot be taken over becomes a note.
    void all();

private:
    void note(bool error, std::string text) {
        if (reported_.insert(text).second) out_.notes.push_back({error, std::move(text)});
    }
    void warn(std::string text) { note(false, std::move(text)); }
    void error(std::string text) { note(true, std::move(text)); }

    // gltfaccess.cpp
    /// The bytes of `count` elements of `size` bytes, `stride` apart; nullptr: an error was noted.
    const unsigned char* bytes(int view, size_t offset, size_t count, size_t size, size_t& stride);
    bool dense(const tinygltf::Accessor&, size_t width, size_t size, std::vector<double>&);
    bool sparse(const tinygltf::Accessor&, size_t width, size_t size, std::vector<double>&);
    /// The numbers of an accessor, `width` each; whole numbers that stand for fractions become these. Empty: there is none, or
    /// an error was noted. wanted: 0, or the only width that will do.
    std::vector<double> numbers(int accessor, const char* what, size_t wanted, size_t* width = nullptr);
    std::vector<float> floats(int accessor, const char* what, size_t wanted, size_t* width = nullptr);

    // gltfmesh.cpp
    void meshes();
    void part(const tinygltf::Primitive&, Part&);
    void corners(const tinygltf::Primitive&, Part&);
    void skinned(const tinygltf::Primitive&, Part&);

    // gltfmaterial.cpp
    void images();
    void materials();
    void material(const tinygltf::Material&, Material&);
    void extensions(const tinygltf::Material&, Material&);
    Texture texture(int index, int set, const tinygltf::ExtensionMap&);
    Texture textureOf(const tinygltf::Value& extension, const char* name);

    // gltf.cpp
    void nodes();
    void node(const tinygltf::Node&, Node&);
    void roots();
    void cameras();
    void lights();
    void skins();
    void animations();
    void required();

    const tinygltf::Model& in_;
    Model& out_;
    std::set<std::string> reported_;
};

/// A number of an extension; the default where there is none.
double numberOf(const tinygltf::Value& v, const char* name, double byDefault);
/// As many as there are, at most `most`.
void numbersOf(const tinygltf::Value& v, const char* name, double* to, size_t most);

} // namespace alpenglow::models
