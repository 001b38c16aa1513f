// Meshes of assimp: faces, bones, shapes.
#include "assimpread.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::models {

namespace {

void add(std::vector<float>& to, const aiVector3D& v) {
    for (unsigned k = 0; k < 3; ++k) to.push_back(float(v[k]));
}

} // namespace

/// The joints that hold a vertex, as many for each as the one that has most.
void AssimpReader::bones(const aiMesh& m, Part& to, Skin& skin) {
    std::vector<std::vector<std::pair<int, float>>> of(to.vertices());
    for (unsigned b = 0; b < m.mNumBones; ++b) {
        const aiBone& bone = *m.mBones[b];
        const auto at = names_.find(bone.mName.C_Str());
        skin.joints.push_back(at == names_.end() ? kNone : at->second);
        skin.bindings.push_back(assimpMatrix(bone.mOffsetMatrix));
        for (unsigned w = 0; w < bone.mNumWeights; ++w)
            if (bone.mWeights[w].mVertexId < of.size())
                of[bone.mWeights[w].mVertexId].push_back({int(b), bone.mWeights[w].mWeight});
    }
    size_t most = 0;
    for (const auto& v : of) most = std::max(most, v.size());
    most = std::min<size_t>(most, 16);
    to.influences = int32_t(most);
    for (const auto& v : of)
        for (size_t k = 0; k < most; ++k) {
            to.joints.push_back(k < v.size() ? v[k].first : 0);
            to.weights.push_back(k < v.size() ? v[k].second : 0.f);
        }
}

/// Targets as differences, which assimp has as whole shapes.
void AssimpReader::shapes(const aiMesh& m, Part& to) {
    for (unsigned i = 0; i < m.mNumAnimMeshes; ++i) {
        const aiAnimMesh& a = *m.mAnimMeshes[i];
        MorphTarget& t = to.targets.emplace_back();
        if (a.mNumVertices != m.mNumVertices) continue;
        for (unsigned v = 0; v < m.mNumVertices && a.mVertices; ++v) add(t.P, a.mVertices[v] - m.mVertices[v]);
        for (unsigned v = 0; v < m.mNumVertices && a.mNormals && m.mNormals; ++v) add(t.N, a.mNormals[v] - m.mNormals[v]);
    }
}

void AssimpReader::part(const aiMesh& m, Part& to) {
    to.material = int(m.mMaterialIndex);
    for (unsigned v = 0; v < m.mNumVertices; ++v) add(to.P, m.mVertices[v]);
    for (unsigned v = 0; v < m.mNumVertices && m.mNormals; ++v) add(to.N, m.mNormals[v]);
    for (unsigned set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS && m.mTextureCoords[set]; ++set) {
        auto& st = to.st.emplace_back();
        for (unsigned v = 0; v < m.mNumVertices; ++v) {
            st.push_back(float(m.mTextureCoords[set][v].x));
            st.push_back(float(m.mTextureCoords[set][v].y));
        }
    }
    for (unsigned v = 0; v < m.mNumVertices && m.mColors[0]; ++v)
        for (unsigned k = 0; k < 4; ++k) to.color.push_back(float(m.mColors[0][v][k]));
    to.kind = m.mPrimitiveTypes & aiPrimitiveType_POINT  ? PartKind::Points
              : m.mPrimitiveTypes & aiPrimitiveType_LINE ? PartKind::Lines
                                                         : PartKind::Polygons;
    for (unsigned f = 0; f < m.mNumFaces; ++f) {
        const aiFace& face = m.mFaces[f];
        if (to.kind != PartKind::Points) to.counts.push_back(int32_t(face.mNumIndices));
        for (unsigned i = 0; i < face.mNumIndices; ++i) to.corners.push_back(int32_t(face.mIndices[i]));
    }
    shapes(m, to);
}

void AssimpReader::meshes() {
    for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
        const aiMesh& m = *scene_.mMeshes[i];
        Mesh& to = out_.meshes.emplace_back();
        to.name = m.mName.C_Str();
        part(m, to.parts.emplace_back());
        for (unsigned k = 0; k < m.mNumAnimMeshes; ++k) to.weights.push_back(double(m.mAnimMeshes[k]->mWeight));
        if (m.mNumBones == 0) continue;
        to.skin = int(out_.skins.size());
        bones(m, to.parts.back(), out_.skins.emplace_back());
    }
}

} // namespace alpenglow::models
