// libalpenglow_models.so: FBX, Collada, 3DS, STL and what else assimp reads. Loaded by a child process when such a file is met
// (modelfile.h); nothing else of the program knows assimp.
#include "assimpread.h"
#include "models/modelfile.h"
#include <algorithm>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>

namespace alpenglow::models {

namespace fs = std::filesystem;

namespace {

/// Rows of base/matrix.h; assimp's are those of column vectors.
Matrix turned(const aiMatrix4x4& a) {
    Matrix m;
    for (unsigned r = 0; r < 4; ++r)
        for (unsigned c = 0; c < 4; ++c) m.m[r][c] = double(a[c][r]);
    return m;
}

/// Opens what lies in the folder of the model or below, links followed, and only to read it.
class FolderFiles : public Assimp::DefaultIOSystem {
public:
    explicit FolderFiles(const std::string& model) {
        std::error_code e;
        const fs::path parent = fs::path(model).parent_path();
        folder_ = fs::canonical(parent.empty() ? fs::path(".") : parent, e);
        model_ = fs::canonical(model, e); // it may be a link: the user named it
    }
    bool Exists(const char* file) const override { return inside(file) && DefaultIOSystem::Exists(file); }
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        return std::string_view(mode).find_first_of("wa+") == std::string_view::npos && inside(file)
                   ? DefaultIOSystem::Open(file, mode)
                   : nullptr;
    }
    bool DeleteFile(const std::string&) override { return false; }
    bool CreateDirectory(const std::string&) override { return false; }

private:
    bool inside(const char* name) const {
        std::error_code e;
        const fs::path file = fs::canonical(name, e);
        const bool below = std::mismatch(folder_.begin(), folder_.end(), file.begin(), file.end()).first == folder_.end();
        return !e && (below || file == model_);
    }
    fs::path folder_, model_;
};

void readAny(const std::string& path, Model& out) {
    Assimp::Importer importer;
    importer.SetIOHandler(new FolderFiles(path)); // the importer's from now on
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, 0);
    importer.SetPropertyInteger(AI_CONFIG_PP_LBW_MAX_WEIGHTS, 8);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    const aiScene* scene =
        importer.ReadFile(path, aiProcess_FlipUVs | aiProcess_ValidateDataStructure | aiProcess_LimitBoneWeights |
                                    aiProcess_JoinIdenticalVertices | aiProcess_TransformUVCoords | aiProcess_SortByPType);
    if (!scene || !scene->mRootNode) {
        const std::string why = importer.GetErrorString();
        throw std::runtime_error(why.empty() ? "it has no scene" : why);
    }
    AssimpReader(*scene, path, out).all();
}

/// The matrix that looks from a place along -z.
Matrix looking(const aiVector3D& from, const aiVector3D& at, const aiVector3D& up) {
    const Vec3d z = -normalizeOr(Vec3d(at.x, at.y, at.z), Vec3d(0, 0, 1)); // mLookAt is a direction
    Vec3d x = cross(Vec3d(up.x, up.y, up.z), z);
    x = normalizeOr(x, normalizeOr(cross(Vec3d(0, 1, 0), z), Vec3d(1, 0, 0)));
    const Vec3d y = cross(z, x);
    Matrix m;
    for (int k = 0; k < 3; ++k) m.m[0][k] = x[k], m.m[1][k] = y[k], m.m[2][k] = z[k];
    m.m[3][0] = double(from.x), m.m[3][1] = double(from.y), m.m[3][2] = double(from.z);
    return m;
}

} // namespace

void AssimpReader::node(const aiNode& n, int parent, int depth) {
    if (depth > 2000) {
        error("nodes lie more than 2000 deep; what is below is left out");
        return;
    }
    const int own = int(out_.nodes.size());
    Node& to = out_.nodes.emplace_back();
    to.name = n.mName.C_Str();
    to.parent = parent;
    to.hasMatrix = true;
    to.matrix = turned(n.mTransformation);
    for (unsigned i = 0; i < n.mNumMeshes; ++i) to.meshes.push_back(int(n.mMeshes[i]));
    aiVector3D s, t;
    aiQuaternion r;
    n.mTransformation.Decompose(s, r, t);
    for (unsigned k = 0; k < 3; ++k) {
        to.translation[k] = double(t[k]);
        to.scale[k] = double(s[k]);
    }
    to.rotation[0] = double(r.x), to.rotation[1] = double(r.y), to.rotation[2] = double(r.z), to.rotation[3] = double(r.w);
    names_.try_emplace(to.name, own);
    for (unsigned i = 0; i < n.mNumChildren; ++i)
        if (n.mChildren[i]) node(*n.mChildren[i], own, depth + 1);
}

/// A node below that of a camera's or light's name, which looks as that does.
Node& AssimpReader::below(const aiString& name, const aiVector3D& from, const aiVector3D& direction, const aiVector3D& up) {
    const auto at = names_.find(name.C_Str());
    Node& n = out_.nodes.emplace_back();
    n.name = name.C_Str();
    n.parent = at == names_.end() ? (out_.nodes.size() > 1 ? 0 : kNone) : at->second;
    n.hasMatrix = true;
    n.matrix = looking(from, direction, up);
    return n;
}

void AssimpReader::cameras() {
    for (unsigned i = 0; i < scene_.mNumCameras; ++i) {
        const aiCamera& c = *scene_.mCameras[i];
        Camera& to = out_.cameras.emplace_back();
        to.name = c.mName.C_Str();
        to.aspect = double(c.mAspect);
        to.near = double(c.mClipPlaneNear);
        to.far = double(c.mClipPlaneFar);
        const double aspect = to.aspect > 0 ? to.aspect : 16.0 / 9, half = double(c.mHorizontalFOV) / 2;
        to.perspective = !(c.mOrthographicWidth > 0);
        if (to.perspective && half < .01) { // assimp 5.2 reads none of Collada's and leaves its default, taken for degrees
            warn("the field of view of camera \"" + to.name + "\" cannot be read; 46 degrees are taken");
        } else if (to.perspective) {
            to.yfov = 2 * std::atan(std::tan(half) / aspect);
        } else {
            to.halfHeight = double(c.mOrthographicWidth) / aspect;
        }
        below(c.mName, c.mPosition, c.mLookAt, c.mUp).camera = int(i);
    }
}

/// Lights of these files have no unit: a colour is what a white surface that faces the light shows, of lamps at the distance
/// where their attenuation is one.
void AssimpReader::lights() {
    for (unsigned i = 0; i < scene_.mNumLights; ++i) {
        const aiLight& l = *scene_.mLights[i];
        if (l.mType != aiLightSource_POINT && l.mType != aiLightSource_SPOT && l.mType != aiLightSource_DIRECTIONAL) {
            warn("lights that are neither points, spots nor suns are left out");
            continue;
        }
        Light to;
        to.name = l.mName.C_Str();
        to.kind = l.mType == aiLightSource_POINT  ? LightKind::Point
                  : l.mType == aiLightSource_SPOT ? LightKind::Spot
                                                  : LightKind::Sun;
        const double strength = std::max({double(l.mColorDiffuse.r), double(l.mColorDiffuse.g), double(l.mColorDiffuse.b)});
        const double f = strength > 0 ? 1 / strength : 0;
        const float color[3] = {l.mColorDiffuse.r, l.mColorDiffuse.g, l.mColorDiffuse.b};
        for (int k = 0; k < 3; ++k) to.color[k] = f > 0 ? double(color[k]) * f : 1;
        to.intensity = strength * kPi; // of a white surface: irradiance / pi is one
        if (to.kind != LightKind::Sun && l.mAttenuationQuadratic > 0) to.intensity /= double(l.mAttenuationQuadratic);
        else if (to.kind != LightKind::Sun) warn("lamps without a fall-off fall with the square of the distance, from 1 on");
        to.inner = double(l.mAngleInnerCone) / 2;
        to.outer = double(l.mAngleOuterCone) / 2;
        out_.lights.push_back(to);
        below(l.mName, l.mPosition, l.mDirection, l.mUp).light = int(out_.lights.size()) - 1;
    }
}

void AssimpReader::animations() {
    for (unsigned i = 0; i < scene_.mNumAnimations; ++i) {
        const aiAnimation& a = *scene_.mAnimations[i];
        Animation& to = out_.animations.emplace_back();
        to.name = a.mName.C_Str();
        const double second = a.mTicksPerSecond > 0 ? 1 / a.mTicksPerSecond : 1.0 / 25;
        for (unsigned k = 0; k < a.mNumChannels; ++k) {
            const aiNodeAnim& c = *a.mChannels[k];
            const auto at = names_.find(c.mNodeName.C_Str());
            if (at == names_.end()) continue;
            const auto vectors = [&](const aiVectorKey* keys, unsigned n, Path path) {
                Channel ch{at->second, path, Interpolation::Linear, {}, {}};
                for (unsigned x = 0; x < n; ++x) {
                    ch.times.push_back(float(keys[x].mTime * second));
                    for (unsigned d = 0; d < 3; ++d) ch.values.push_back(float(keys[x].mValue[d]));
                }
                if (n) to.channels.push_back(std::move(ch));
            };
            vectors(c.mPositionKeys, c.mNumPositionKeys, Path::Translation);
            vectors(c.mScalingKeys, c.mNumScalingKeys, Path::Scale);
            Channel turn{at->second, Path::Rotation, Interpolation::Linear, {}, {}};
            for (unsigned x = 0; x < c.mNumRotationKeys; ++x) {
                const aiQuaternion& q = c.mRotationKeys[x].mValue;
                turn.times.push_back(float(c.mRotationKeys[x].mTime * second));
                for (const float v : {float(q.x), float(q.y), float(q.z), float(q.w)}) turn.values.push_back(v);
            }
            if (!turn.times.empty()) to.channels.push_back(std::move(turn));
        }
        if (a.mNumMeshChannels || a.mNumMorphMeshChannels) warn("animations of meshes are left out, those of nodes are kept");
    }
}

void AssimpReader::all() {
    if (scene_.mMetaData) {
        aiString tool;
        if (scene_.mMetaData->Get(AI_METADATA_SOURCE_GENERATOR, tool)) out_.generator = tool.C_Str();
    }
    if (scene_.mFlags & AI_SCENE_FLAGS_INCOMPLETE) warn("the file is not complete");
    node(*scene_.mRootNode, kNone, 0);
    out_.roots.push_back(0);
    images();
    materials();
    meshes();
    cameras();
    lights();
    animations();
}

Matrix assimpMatrix(const aiMatrix4x4& a) { return turned(a); }

} // namespace alpenglow::models

extern "C" int alpenglow_read_model(const char* path, int to, char* why, int whySize) {
    return alpenglow::models::sendModel(path, to, why, whySize, alpenglow::models::readAny);
}
