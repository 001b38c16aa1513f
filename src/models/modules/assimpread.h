// What the parts of the module for assimp share.
#pragma once
#include "models/model.h"
#include <assimp/scene.h>
#include <map>
#include <set>
#include <string>

namespace alpenglow::models {

/// Takes a scene of assimp over into a Model.
class AssimpReader {
public:
    /// path: of the file, whose folder has the pictures. Scene and model must outlive the reader.
    AssimpReader(const aiScene& s, std::string path, Model& out) : scene_(s), path_(std::move(path)), out_(out) {}
    /// Fills the model; what cannot be taken over becomes a note.
    void all();

private:
    void note(bool error, std::string text) {
        if (reported_.insert(text).second) out_.notes.push_back({error, std::move(text)});
    }
    void warn(std::string text) { note(false, std::move(text)); }
    void error(std::string text) { note(true, std::move(text)); }
    void node(const aiNode&, int parent, int depth);
    Node& below(const aiString& name, const aiVector3D& from, const aiVector3D& direction, const aiVector3D& up);
    void cameras();
    void lights();
    void animations();

    // assimpmesh.cpp
    void meshes();
    void part(const aiMesh&, Part&);
    void bones(const aiMesh&, Part&, Skin&);
    void shapes(const aiMesh&, Part&);

    // assimpmaterial.cpp
    void images();
    void materials();
    void material(const aiMaterial&, Material&);
    Texture texture(const aiMaterial&, aiTextureType);
    int imageOf(const std::string& name);

    const aiScene& scene_;
    std::string path_;
    Model& out_;
    std::map<std::string, int> names_;  ///< of nodes
    std::map<std::string, int> images_; ///< by the name that materials use
    std::set<std::string> reported_;
};

/// To row vectors.
Matrix assimpMatrix(const aiMatrix4x4&);

} // namespace alpenglow::models
