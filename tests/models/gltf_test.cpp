// glTF as the module reads it: closed forms of what small files that the test writes hold, and faults one by one.
#include "base/installation.h"
#include "gltfwriter.h"
#include "models/check.h"
#include "models/modelfile.h"
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>

namespace models_gltf_test {

using namespace alpenglow;
using namespace alpenglow::models;
using gltf_test::GltfWriter;
using gltf_test::square;

namespace {

class Gltf : public ::testing::Test {
protected:
    std::filesystem::path dir;
    std::string said;
    int errors = 0;
    void SetUp() override {
        if (moduleFile("libalpenglow_gltf.so", "ALPENGLOW_GLTF").empty()) GTEST_SKIP() << "built without tinygltf";
        std::string name = (std::filesystem::temp_directory_path() / "alpenglow-test-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        dir = name;
    }
    void TearDown() override {
        if (!dir.empty()) std::filesystem::remove_all(dir);
    }
    std::optional<Model> read(const std::string& bytes, const std::string& name = "m.gltf") {
        std::ofstream(dir / name, std::ios::binary) << bytes;
        Diagnostics d;
        auto m = readForeignModel((dir / name).string(), d);
        said.clear();
        for (const Diagnostic& x : d.all()) said += x.message + "\n";
        errors = d.errors();
        return m;
    }
};

double area(const Part& p) {
    double sum = 0;
    for (size_t i = 0; i + 2 < p.corners.size(); i += 3) {
        const auto at = [&](size_t k) {
            const float* v = &p.P[size_t(p.corners[i + k]) * 3];
            return Vec3d(v[0], v[1], v[2]);
        };
        sum += .5 * length(cross(at(1) - at(0), at(2) - at(0)));
    }
    return sum;
}

} // namespace

TEST_F(Gltf, ReadsASquareFromTextAndBinary) {
    const GltfWriter w =
        square(R"({"name":"red","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,0.125,1],"metallicFactor":0}})");
    for (const bool binary : {false, true}) {
        const auto m = binary ? read(w.binary(), "m.glb") : read(w.text());
        ASSERT_TRUE(m) << said;
        EXPECT_EQ(said, "");
        EXPECT_EQ(m->generator, "test");
        ASSERT_EQ(m->meshes.size(), 1u);
        const Part& p = m->meshes[0].parts.at(0);
        EXPECT_EQ(p.vertices(), 4u);
        EXPECT_DOUBLE_EQ(area(p), 4);
        EXPECT_EQ(p.st.at(0), (std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}));
        ASSERT_EQ(m->materials.size(), 1u);
        EXPECT_EQ(m->materials[0].baseColor[1], .25);
        EXPECT_EQ(m->materials[0].metalness, 0);
        EXPECT_EQ(m->materials[0].roughness, 1);
    }
}

TEST_F(Gltf, ReadsStripsFansAndNumbersThatStandForFractions) {
    for (const int mode : {5, 6}) {
        GltfWriter w = square("{}");
        const int P = mode == 5 ? w.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0}, "VEC3", 3)
                                : w.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 1, 2, 0, 0, 2, 0}, "VEC3", 3);
        const int C =
            mode == 5
                ? w.bytes({255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 0},
                          "VEC4", 4, R"(,"normalized":true)")
                : -1;
        w.meshes = R"([{"primitives":[{"mode":)" + std::to_string(mode) + R"(,"attributes":{"POSITION":)" + std::to_string(P) +
                   (C >= 0 ? R"(,"COLOR_0":)" + std::to_string(C) : "") + "}}]}]";
        const auto m = read(w.text());
        ASSERT_TRUE(m) << said;
        const Part& p = m->meshes.at(0).parts.at(0);
        EXPECT_DOUBLE_EQ(area(p), 2) << mode; // all triangles wind the same way
        for (size_t i = 0; i < p.corners.size(); i += 3) {
            const float *a = &p.P[size_t(p.corners[i]) * 3], *b = &p.P[size_t(p.corners[i + 1]) * 3],
                        *c = &p.P[size_t(p.corners[i + 2]) * 3];
            EXPECT_GT((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]), 0) << mode << " " << i;
        }
        if (mode != 5) continue;
        ASSERT_EQ(p.color.size(), 24u);
        EXPECT_FLOAT_EQ(p.color[2], .2f);
        EXPECT_FLOAT_EQ(p.color[23], 0);
    }
}

TEST_F(Gltf, SparseAccessorsReplaceSomeElements) {
    GltfWriter w = square("{}");
    const uint16_t index[] = {1, 3};
    const float value[] = {9, 8, 7, 6, 5, 4};
    const int iv = w.view(index, sizeof index), vv = w.view(value, sizeof value);
    const int base = w.floats({0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3}, "VEC3", 3,
                              R"(,"sparse":{"count":2,"indices":{"bufferView":)" + std::to_string(iv) +
                                  R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(vv) + "}}");
    w.meshes = R"([{"primitives":[{"mode":0,"attributes":{"POSITION":)" + std::to_string(base) + "}}]}]";
    const auto m = read(w.text());
    ASSERT_TRUE(m) << said;
    EXPECT_EQ(m->meshes.at(0).parts.at(0).P, (std::vector<float>{0, 0, 0, 9, 8, 7, 2, 2, 2, 6, 5, 4}));
    EXPECT_EQ(m->meshes[0].parts[0].kind, PartKind::Points);
}

TEST_F(Gltf, ReadsNodesLightsCamerasAndExtensions) {
    GltfWriter w = square(R"({"emissiveFactor":[1,0.5,0],"alphaMode":"MASK","alphaCutoff":0.3,"extensions":{
        "KHR_materials_emissive_strength":{"emissiveStrength":8},"KHR_materials_ior":{"ior":1.33},
        "KHR_materials_clearcoat":{"clearcoatFactor":0.5,"clearcoatRoughnessFactor":0.25},
        "KHR_materials_transmission":{"transmissionFactor":0.75},
        "KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2,"attenuationColor":[0.5,1,1]},
        "KHR_materials_sheen":{"sheenColorFactor":[0.1,0.2,0.3]},"KHR_materials_specular":{"specularFactor":0.5}},
        "pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":0,
        "extensions":{"KHR_texture_transform":{"scale":[2,3],"offset":[0.5,0.25],"rotation":1}}}}})");
    w.textures = R"([{"source":0,"sampler":0}])";
    w.samplers = R"([{"wrapS":33071,"wrapT":33648}])";
    w.images = R"([{"name":"p","uri":"data:image/png;base64,iVBORw0K"}])";
    w.nodes = R"([{"name":"a","children":[1,2],"translation":[1,2,3],"scale":[2,2,2]},{"mesh":0,"camera":0},
        {"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1],"extensions":{"KHR_lights_punctual":{"light":0}}}])";
    w.cameras = R"([{"type":"perspective","perspective":{"yfov":0.5,"aspectRatio":2,"znear":0.1}}])";
    w.extensions = R"({"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":100,"color":[1,0,0],
        "spot":{"innerConeAngle":0.1,"outerConeAngle":0.2}}]}})";
    const auto m = read(w.text());
    ASSERT_TRUE(m) << said;
    EXPECT_EQ(said, "");
    const Material& x = m->materials.at(0);
    EXPECT_EQ(x.emission[0], 8);
    EXPECT_EQ(x.emission[1], 4);
    EXPECT_EQ(x.alphaMode, AlphaMode::Mask);
    EXPECT_EQ(x.alphaCutoff, .3);
    EXPECT_EQ(x.ior, 1.33);
    EXPECT_EQ(x.coat, .5);
    EXPECT_EQ(x.transmission, .75);
    EXPECT_EQ(x.attenuationColor[0], .5);
    EXPECT_EQ(x.sheenColor[2], .3);
    EXPECT_EQ(x.specular, .5);
    EXPECT_EQ(x.baseColorMap.s, Wrap::Clamp);
    EXPECT_EQ(x.baseColorMap.t, Wrap::Mirror);
    EXPECT_EQ(x.baseColorMap.scale[1], 3);
    EXPECT_EQ(x.baseColorMap.rotation, 1);
    EXPECT_EQ(m->nodes.at(2).parent, 0);
    EXPECT_EQ(m->nodes[2].matrix.m[3][1], 6);
    EXPECT_EQ(m->nodes[2].light, 0);
    EXPECT_EQ(m->lights.at(0).outer, .2);
    EXPECT_EQ(m->cameras.at(0).aspect, 2);
    EXPECT_EQ(m->images.at(0).bytes.size(), 6u);
}

TEST_F(Gltf, FaultsAreErrorsEach) {
    const auto with = [](void (*change)(GltfWriter&)) {
        GltfWriter w = square("{}");
        change(w);
        return w.text();
    };
    const struct {
        std::string text;
        const char* expected;
    } cases[] = {
        {"", "cannot be read"},
        {"hello", "cannot be read"},
        {"{}", "cannot be read"},
        {R"({"asset":{"version":"1.0"}})", "version 2 is read"},
        {"glTF", "cannot be read"},
        {std::string("glTF\2\0\0\0\xff\xff\xff\x7f\xff\xff\xff\x7fJSON{", 21), "cannot be read"},
        {with([](GltfWriter& w) { w.nodes = R"([{"mesh":7}])"; }), "a mesh is named that is not there"},
        {with([](GltfWriter& w) { w.nodes = R"([{"mesh":0,"children":[0]}])"; }), "circle"},
        {with([](GltfWriter& w) { w.nodes = R"([{"children":[1]},{"children":[0],"mesh":0}])"; }), "circle"},
        {with([](GltfWriter& w) { w.nodes = R"([{"mesh":0,"children":[4]}])"; }), "a child that is not there"},
        {with([](GltfWriter& w) { w.meshes = R"([{"primitives":[{"attributes":{"POSITION":44}}]}])"; }), "accessor 44"},
        {with([](GltfWriter& w) { w.meshes = R"([{"primitives":[{"attributes":{"POSITION":1}}]}])"; }),
         "another type than positions"},
        {with([](GltfWriter& w) {
             w.accessor(0, 5126, 2000000000, "VEC3", "");
             w.meshes = R"([{"primitives":[{"attributes":{"POSITION":3}}]}])";
         }),
         "2000000000 elements"},
        {with([](GltfWriter& w) {
             w.accessor(0, 5126, 5, "VEC3", "");
             w.meshes = R"([{"primitives":[{"attributes":{"POSITION":3}}]}])";
         }),
         "reaches beyond"},
        {with([](GltfWriter& w) {
             w.accessor(-1, 5126, 150000000, "VEC3", "");
             w.meshes = R"([{"primitives":[{"attributes":{"POSITION":3}}]}])";
         }),
         "too many elements"},
        {with([](GltfWriter& w) {
             const int i = w.shorts({0, 1, 60000});
             w.meshes = R"([{"primitives":[{"attributes":{"POSITION":0},"indices":)" + std::to_string(i) + "}]}]";
         }),
         "use vertices that are not there"},
        {with([](GltfWriter& w) {
             const int P = w.floats({0, 0, NAN, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
             w.meshes = R"([{"primitives":[{"attributes":{"POSITION":)" + std::to_string(P) + "}}]}]";
         }),
         "not finite"},
        {with([](GltfWriter& w) { w.images = R"([{"uri":"../../../../etc/passwd"}])"; }), "cannot be read"},
        {with([](GltfWriter& w) { w.materials = R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":9}}}])"; }),
         "a texture that is not there"},
    };
    for (const auto& c : cases) {
        read(c.text);
        EXPECT_GT(errors, 0) << c.text.substr(0, 300);
        EXPECT_NE(said.find(c.expected), std::string::npos) << c.expected << "\n" << said;
        EXPECT_EQ(said.find("signal"), std::string::npos) << said << c.text.substr(0, 300);
    }
}

// Two triangles that draco_encoder (1.5.5, 14 bits) has packed.
TEST_F(Gltf, UnpacksDraco) {
    const std::string packed = "RFJBQ08CAgEBAAAABAIAAgAAAR//AREB/wAAAQAJAwAAAgEBAQAPAwEQLwEwAwAoggDA/w8ABAD/PwAAAPz/ACAAAAAAAP8/"
                               "AAAAAAAAAAAAAAAAAAAAAABADg==";
    const auto m = read(R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"],
        "meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0,"extensions":{"KHR_draco_mesh_compression":
        {"bufferView":0,"attributes":{"POSITION":0}}}}]}],"accessors":[{"componentType":5123,"count":6,"type":"SCALAR"},
        {"componentType":5126,"count":4,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":91}],
        "buffers":[{"byteLength":91,"uri":"data:application/octet-stream;base64,)" +
                        packed + R"("}]})");
    if (said.find("compressed by Draco, without") != said.npos) GTEST_SKIP() << "built without Draco";
    ASSERT_TRUE(m) << said;
    EXPECT_EQ(said, "");
    const Part& p = m->meshes.at(0).parts.at(0);
    EXPECT_EQ(p.vertices(), 4u);
    EXPECT_NEAR(area(p), 1 + .5 * std::sqrt(.25 + 1 + 4), 1e-3); // the second: |(0, 1, .5) x (-2, 1, 0)| / 2
}

// A file whose bytes were changed at random is read, or it is an error; this process goes on.
TEST_F(Gltf, TakesNoHarmFromAnyBytes) {
    const std::string whole = square(R"({"pbrMetallicRoughness":{"metallicFactor":0}})").binary();
    std::mt19937 random(3);
    int readable = 0;
    for (int k = 0; k < 60; ++k) {
        std::string bytes = whole;
        for (int i = 0; i < 1 + k % 3; ++i) bytes[random() % bytes.size()] = char(random());
        const auto m = read(bytes, "m.glb");
        readable += m.has_value();
        EXPECT_TRUE(m || errors > 0);
    }
    EXPECT_GT(readable, 0);
}

// What the user names may be a link; what the file names must lie below its folder, wherever links lead.
TEST_F(Gltf, ReadsOnlyBelowItsFolder) {
    namespace fs = std::filesystem;
    fs::create_directory(dir / "in");
    std::ofstream(dir / "out.gltf") << square("{}").text();
    std::ofstream(dir / "data.bin") << std::string(12, 'x');
    fs::create_symlink(dir / "out.gltf", dir / "in/link.gltf");
    Diagnostics d;
    EXPECT_TRUE(readForeignModel((dir / "in/link.gltf").string(), d));
    fs::create_symlink(dir / "data.bin", dir / "in/data.bin");
    for (const std::string uri : {"../data.bin", "data.bin"}) {
        EXPECT_FALSE(read(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":12,"uri":")" + uri + R"("}]})", "in/m.gltf"))
            << uri;
        EXPECT_EQ(errors, 1);
    }
    fs::remove(dir / "in/data.bin");
    fs::copy(dir / "data.bin", dir / "in/data.bin");
    EXPECT_TRUE(read(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":12,"uri":"data.bin"}]})", "in/m.gltf")) << said;
}

TEST_F(Gltf, AMissingModuleIsAnErrorThatSaysSo) {
    setenv("ALPENGLOW_GLTF", "/nowhere/none.so", 1);
    EXPECT_FALSE(read(square("{}").text()));
    unsetenv("ALPENGLOW_GLTF");
    EXPECT_NE(said.find("libalpenglow_gltf.so, is not there"), std::string::npos) << said;
}

} // namespace models_gltf_test
