// A DelayedReadArchive of shapes alone, read again under the same attributes, is an instance; what is drawn stays the same.
#include "collect.h"
#include "geometry/instance_attributes.h"
#include "scene/scene.h"
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace sharedarchives_test {

using namespace alpenglow;
using namespace alpenglow::ri;
namespace fs = std::filesystem;

class SharedArchives : public ::testing::Test {
protected:
    void SetUp() override {
        dir = fs::temp_directory_path() / ("alpenglow_shared_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(dir);
    }
    void TearDown() override { fs::remove_all(dir); }
    void write(const std::string& name, const std::string& text) { std::ofstream(dir / name, std::ios::binary) << text; }
    std::unique_ptr<Collected> readHere(const std::string& text) {
        write("main.rib", "WorldBegin " + text + " WorldEnd");
        auto c = std::make_unique<Collected>();
        RibReader reader({}, *c, c->diagnostics);
        c->ok = reader.readFile((dir / "main.rib").string());
        EXPECT_EQ(c->messages(), "");
        return c;
    }
    /// Shapes with radius, place and colour, of primitives and of instances.
    static std::multiset<std::string> shapes(const scene::Frame& f) {
        std::multiset<std::string> all;
        const auto add = [&](const scene::Primitive& p, const Matrix& m, const scene::Attributes& a) {
            all.insert(std::to_string(p.numbers.at(0)) + " at " + std::to_string(m.m[3][0]) + ", red " +
                       std::to_string(a.color.x) + (a.surface ? ", " + a.surface->name : ""));
        };
        for (const auto& p : f.primitives) add(*p, p->toWorld.first(), *p->attributes);
        for (const scene::Instance& i : f.instances)
            for (const auto& p : f.objects[size_t(i.object)].primitives)
                add(*p, p->toWorld.first() * i.toWorld.first(), *geometry::instanceAttributes(*p, i));
        return all;
    }
    fs::path dir;
};

std::string three(const std::string& archive, const std::string& between = "") {
    const std::string box = "\" [-9 9 -9 9 -9 9] TransformEnd ";
    std::string s;
    for (const char* x : {"1", "2", "3"})
        s += "TransformBegin Translate " + std::string(x) + " 0 0 " + "Procedural \"DelayedReadArchive\" \"" + archive + box +
             between;
    return s;
}

TEST_F(SharedArchives, AreInstancesFromTheSecondTimeOn) {
    write("plain.rib", "Sphere 1 -1 1 360 TransformBegin Translate 5 0 0 Sphere 2 -2 2 360 TransformEnd");
    const auto c = readHere("Color [1 0 0] " + three("plain.rib"));
    EXPECT_EQ(c->frame().primitives.size(), 2u);
    EXPECT_EQ(c->frame().objects.size(), 1u);
    EXPECT_EQ(c->frame().instances.size(), 2u);
    std::multiset<std::string> want;
    for (const int x : {1, 2, 3})
        for (const int r : {1, 2})
            want.insert(std::to_string(double(r)) + " at " + std::to_string(double(x + (r == 2 ? 5 : 0))) + ", red 1.000000");
    EXPECT_EQ(shapes(c->frame()), want);
}

// Without attributes in it, an archive has those of each call.
TEST_F(SharedArchives, WithoutAttributesHaveThoseOfTheCall) {
    write("plain.rib", "Sphere 1 -1 1 360");
    const auto c = readHere(three("plain.rib") + "Color [.5 0 0] Surface \"matte\" " + three("plain.rib"));
    EXPECT_EQ(c->frame().instances.size(), 5u);
    const auto all = shapes(c->frame());
    EXPECT_EQ(all.count("1.000000 at 1.000000, red 0.500000, matte"), 1u);
    EXPECT_EQ(all.count("1.000000 at 3.000000, red 1.000000"), 1u);
    EXPECT_EQ(all.size(), 6u);
}

// An archive that sets its colour to what it is around the first call stays like that where another is around it.
TEST_F(SharedArchives, KeepTheAttributesThatTheySet) {
    write("red.rib", "Color [1 0 0] Sphere 1 -1 1 360");
    const auto c = readHere("Color [1 0 0] " + three("red.rib") + "Color [0 0 1] " + three("red.rib"));
    EXPECT_EQ(c->frame().objects.size(), 2u) << "of each surroundings one";
    EXPECT_EQ(c->frame().instances.size(), 4u);
    for (const std::string& s : shapes(c->frame())) EXPECT_NE(s.find("red 1.000000"), std::string::npos) << s;
}

// What is more than shapes is read each time.
TEST_F(SharedArchives, WithMoreInThemAreRead) {
    write("light.rib", "LightSource \"pointlight\" 1 Sphere 1 -1 1 360");
    write("toggles.rib", "ReverseOrientation Sphere 1 -1 1 360");
    write("nested.rib", "ReadArchive \"light.rib\"");
    write("named.rib", "CoordinateSystem \"here\" Sphere 1 -1 1 360");
    for (const char* name : {"light.rib", "toggles.rib", "nested.rib", "named.rib"}) {
        const auto c = readHere(three(name));
        EXPECT_EQ(c->frame().instances.size(), 0u) << name;
        EXPECT_EQ(c->frame().primitives.size(), 3u) << name;
    }
    write("a.rib", "Sphere 1 -1 1 360");
    EXPECT_EQ(readHere("SolidBegin \"primitive\" " + three("a.rib") + "SolidEnd")->frame().instances.size(), 0u);
    EXPECT_EQ(readHere("ObjectBegin 1 " + three("a.rib") + "ObjectEnd ObjectInstance 1")->frame().instances.size(), 1u);
}

} // namespace sharedarchives_test
