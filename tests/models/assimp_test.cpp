// FBX's kin by assimp, with files that the test writes: STL and Collada.
#include "base/installation.h"
#include "models/check.h"
#include "models/modelfile.h"
#include "models/pose.h"
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace models_assimp_test {

using namespace alpenglow;
using namespace alpenglow::models;

namespace {

class Others : public ::testing::Test {
protected:
    std::filesystem::path dir;
    std::string said;
    int errors = 0;
    void SetUp() override {
        if (moduleFile("libalpenglow_models.so", "ALPENGLOW_MODELS").empty()) GTEST_SKIP() << "built without assimp";
        std::string name = (std::filesystem::temp_directory_path() / "alpenglow-test-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        dir = name;
    }
    void TearDown() override {
        if (!dir.empty()) std::filesystem::remove_all(dir);
    }
    std::optional<Model> read(const std::string& name, const std::string& bytes) {
        std::ofstream(dir / name, std::ios::binary) << bytes;
        Diagnostics d;
        auto m = readForeignModel((dir / name).string(), d);
        said.clear();
        for (const Diagnostic& x : d.all()) said += x.message + "\n";
        errors = d.errors();
        return m;
    }
};

const char* const kStl =
    "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 3 0 0\nvertex 0 4 0\nendloop\nendfacet\nendsolid s\n";

const char* const kCollada =
    R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_cameras><camera id="c"><optics><technique_common><perspective><xfov>90</xfov><aspect_ratio>2</aspect_ratio>
<znear>0.1</znear><zfar>100</zfar></perspective></technique_common></optics></camera></library_cameras>
<library_lights><light id="l"><technique_common><point><color>2 1 0</color>
<quadratic_attenuation>1</quadratic_attenuation></point>
</technique_common></light></library_lights>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><phong><diffuse><color>0.8 0.4 0.2 1</color></diffuse>
<shininess><float>30</float></shininess></phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="paint"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="s"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="vs">
<node id="n" name="n"><translate>5 0 0</translate><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry></node>
<node id="eye" name="eye"><translate>0 0 9</translate><instance_camera url="#c"/></node>
<node id="lamp" name="lamp"><translate>0 3 0</translate><instance_light url="#l"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#vs"/></scene></COLLADA>)";

} // namespace

TEST_F(Others, ReadsStl) {
    const auto m = read("t.stl", kStl);
    ASSERT_TRUE(m) << said;
    ASSERT_EQ(m->meshes.size(), 1u);
    const Part& p = m->meshes[0].parts.at(0);
    ASSERT_EQ(p.corners.size(), 3u);
    Vec3d at[3];
    for (size_t i = 0; i < 3; ++i) {
        const float* v = &p.P[size_t(p.corners[i]) * 3];
        at[i] = Vec3d(v[0], v[1], v[2]);
    }
    EXPECT_DOUBLE_EQ(length(cross(at[1] - at[0], at[2] - at[0])), 12); // twice the area
}

TEST_F(Others, ReadsColladaWithCameraLightAndMaterial) {
    const auto m = read("t.dae", kCollada);
    ASSERT_TRUE(m) << said;
    ASSERT_EQ(m->cameras.size(), 1u);
    const Pose pose = poseAt(*m, kNone, 0);
    int meshes = 0, cameras = 0, lights = 0;
    for (const int n : drawnNodes(*m)) {
        const Node& x = m->nodes[size_t(n)];
        const Vec3d at = transformPoint(pose.world[size_t(n)], Vec3d(0.0));
        meshes += !x.meshes.empty();
        lights += x.light != kNone;
        EXPECT_TRUE(x.meshes.empty() || std::abs(at.x - 5) < 1e-6) << at.x;
        EXPECT_TRUE(x.light == kNone || std::abs(at.y - 3) < 1e-6) << at.y;
        if (x.camera == kNone) continue;
        ++cameras;
        EXPECT_NEAR(at.z, 9, 1e-6);
        const Vec3d sight = transformVector(pose.world[size_t(n)], Vec3d(0, 0, -1));
        EXPECT_NEAR(sight.z, -1, 1e-6);                               // Collada's cameras look along -z
        const bool missing = said.find("field of view") != said.npos; // assimp 5.2 does not read it
        EXPECT_NEAR(m->cameras[0].yfov, missing ? .8 : 2 * std::atan(.5), 1e-3);
    }
    EXPECT_EQ(meshes, 1);
    EXPECT_EQ(cameras, 1);
    EXPECT_EQ(lights, 1);
    ASSERT_EQ(m->lights.size(), 1u);
    EXPECT_NEAR(m->lights[0].intensity, 2 * kPi, 1e-6);
    EXPECT_NEAR(m->lights[0].color[1], .5, 1e-6);
    bool found = false;
    for (const Material& x : m->materials) found = found || std::abs(x.baseColor[1] - .4) < 1e-6;
    EXPECT_TRUE(found);
}

TEST_F(Others, FaultsAreErrors) {
    for (const auto& [name, bytes] : std::vector<std::pair<std::string, std::string>>{{"a.fbx", "hello"},
                                                                                      {"b.dae", "<COLLADA>"},
                                                                                      {"c.3ds", std::string(100, '\x4d')},
                                                                                      {"d.stl", ""},
                                                                                      {"e.blend", "BLENDER"}}) {
        EXPECT_FALSE(read(name, bytes)) << name;
        EXPECT_EQ(errors, 1) << name << said;
    }
}

} // namespace models_assimp_test
