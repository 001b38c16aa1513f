// Procedurals outside of the picture wait until somebody asks for their content, which is what it would have been at once.
#include "collect.h"
#include "scene/deferred.h"
#include "scene/scene.h"
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace unmade_test {

using namespace alpenglow;
using namespace alpenglow::ri;
namespace fs = std::filesystem;

namespace {

/// Hands frames over while they are rendered.
struct Renders : Collected {
    RibReader* reader = nullptr;
    std::function<void(Renders&, std::shared_ptr<const scene::Frame>)> then;
    void render(std::shared_ptr<const scene::Frame> f) override {
        frames.push_back(f);
        if (then) then(*this, f);
    }
    std::shared_ptr<const scene::Frame> make(const scene::Frame& f, std::vector<int> which) { return reader->make(f, which); }
};

class DeferredBounds : public ::testing::Test {
protected:
    void SetUp() override {
        dir = fs::temp_directory_path() / ("alpenglow_unmade_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(dir);
    }
    void TearDown() override { fs::remove_all(dir); }
    void write(const std::string& name, const std::string& text) { std::ofstream(dir / name, std::ios::binary) << text; }
    void readHere(Renders& c, const std::string& text, bool defers = true) {
        write("main.rib", text);
        ReaderOptions o;
        o.defers = defers;
        RibReader reader(o, c, c.diagnostics);
        c.reader = &reader;
        c.ok = reader.readFile((dir / "main.rib").string());
        EXPECT_EQ(reader.make(scene::Frame(), {}), nullptr); // no frame is being rendered
        c.reader = nullptr;
    }
    fs::path dir;
};

const std::string camera = "Format 100 100 1 Projection \"perspective\" \"fov\" 90 WorldBegin ";
/// An archive far to the left of the picture.
std::string left(const std::string& archive, const std::string& bound = "[-1 1 -1 1 -1 1]") {
    return "TransformBegin Translate -50 0 5 Procedural \"DelayedReadArchive\" [\"" + archive + "\"] " + bound + " TransformEnd ";
}

/// What tells primitives apart, in order; of procedurals whether they are expanded.
std::string summary(const scene::Frame& f, bool procedurals = true) {
    std::string s;
    for (const scene::PrimitiveRef& p : f.primitives) {
        if (scene::isProcedural(*p)) s += !procedurals ? "" : scene::isDeferred(*p) ? "? " : "! ";
        else
            s += p->kind.substr(0, 2) + std::to_string(int(p->numbers[0])) + "@" +
                 std::to_string(int(p->toWorld.first().m[3][0])) + " ";
    }
    for (const scene::Instance& i : f.instances)
        s += f.objects[size_t(i.object)].handle + "@" + std::to_string(int(i.toWorld.first().m[3][0])) + " ";
    return s;
}

TEST_F(DeferredBounds, ContentIsWhatItWouldHaveBeenAtOnce) {
    write("a.rib", "Color [1 0 0] Sphere 1 -1 1 360 Translate 1 0 0 Sphere 2 -2 2 360");
    write("b.rib", "Sphere 3 -3 3 360");
    write("seen.rib", "Sphere 7 -7 7 360");
    const std::string scene = camera + "Color [0 0 1] Declare \"x\" \"uniform float\" " + left("a.rib") + "Sphere 4 -4 4 360 " +
                              left("b.rib") +
                              "Translate 0 0 5 Procedural \"DelayedReadArchive\" [\"seen.rib\"] [-1 1 -1 1 -1 1] WorldEnd";
    Renders c;
    c.then = [](Renders& r, const std::shared_ptr<const scene::Frame>& f) {
        EXPECT_EQ(summary(*f), "? Sp4@0 ? Sp7@0 ");
        EXPECT_EQ(f->primitives[0]->numbers, (std::vector<float>{-1, 1, -1, 1, -1, 1}));
        const auto one = r.make(*f, {0});
        EXPECT_EQ(summary(*one), "! Sp1@-50 Sp2@-49 Sp4@0 ? Sp7@0 ");
        EXPECT_EQ(one->primitives[1]->attributes->color.x, 1);
        EXPECT_EQ(one->primitives[1]->attributes->color.z, 0);
        EXPECT_EQ(one->primitives[3]->attributes->color.z, 1);
        const auto both = r.make(*one, {1});
        EXPECT_EQ(summary(*both), "! Sp1@-50 Sp2@-49 Sp4@0 ! Sp3@-50 Sp7@0 ");
        EXPECT_EQ(summary(*r.make(*f, {})), summary(*both));
        EXPECT_EQ(summary(*f), "? Sp4@0 ? Sp7@0 "); // frames do not change
    };
    readHere(c, scene);
    EXPECT_EQ(c.messages(), "");
    ASSERT_EQ(c.frames.size(), 1u);
    Renders at;
    readHere(at, scene, false);
    EXPECT_EQ(summary(at.frame()), "Sp1@-50 Sp2@-49 Sp4@0 Sp3@-50 Sp7@0 ");
}

TEST_F(DeferredBounds, WhatIsNotAskedForIsNotRead) {
    write("bad.rib", "Sphere \"one\"");
    Renders c;
    readHere(c, camera + left("bad.rib") + left("missing.rib") + "WorldEnd");
    EXPECT_EQ(c.messages(), "");
    c.then = [](Renders& r, const std::shared_ptr<const scene::Frame>& f) { EXPECT_NE(r.make(*f, {0, 1}), nullptr); };
    readHere(c, camera + left("bad.rib") + left("missing.rib") + "WorldEnd");
    EXPECT_NE(c.messages().find("bad.rib"), std::string::npos) << c.messages();
    EXPECT_NE(c.messages().find("missing.rib"), std::string::npos) << c.messages();
}

TEST_F(DeferredBounds, NestsAndComesInTheOrderOfTheSceneWhateverIsMadeFirst) {
    write("leaf.rib", "Sphere 1 -1 1 360 ObjectInstance \"o\"");
    write("branch.rib",
          "Sphere 2 -2 2 360 " + left("leaf.rib") + "Sphere 3 -3 3 360 " + left("leaf.rib") + "ObjectInstance \"o\"");
    const std::string scene = camera + "ObjectBegin \"o\" Sphere 9 -9 9 360 ObjectEnd " +
                              left("branch.rib", "[-60 1 -1 1 -1 9]") + left("leaf.rib") + "ObjectInstance \"o\" WorldEnd";
    Renders c;
    c.then = [](Renders& r, const std::shared_ptr<const scene::Frame>& f) {
        EXPECT_EQ(summary(*f), "? ? o@0 ");
        const auto outer = r.make(*f, {0});
        EXPECT_EQ(summary(*outer), "! Sp2@-50 ? Sp3@-50 ? ? o@0 o@-50 ");
        std::vector<int> inner;
        for (const auto& p : outer->primitives)
            if (scene::isDeferred(*p)) inner.push_back(scene::deferredNumber(*p));
        ASSERT_EQ(inner.size(), 3u);
        const std::string whole = "! Sp2@-50 ! Sp1@-100 Sp3@-50 ! Sp1@-100 ! Sp1@-50 o@0 o@-50 o@-100 o@-100 o@-50 ";
        EXPECT_EQ(summary(*r.make(*r.make(*outer, {inner[2]}), {inner[1], inner[0]})), whole);
        EXPECT_EQ(summary(*r.make(*r.make(*outer, {inner[1]}), {inner[0], inner[2]})), whole);
        const auto late = r.make(*r.make(*f, {1}), {});
        EXPECT_EQ(summary(*late), whole);
        EXPECT_EQ(scene::partOf(*late->primitives[1]->attributes), "0");
        EXPECT_EQ(scene::partOf(*late->primitives[6]->attributes), "0/1");
        EXPECT_EQ(scene::partOf(*late->primitives[8]->attributes), "1");
    };
    readHere(c, scene);
    EXPECT_EQ(c.messages(), "");
    ASSERT_EQ(c.frames.size(), 1u);
}

TEST_F(DeferredBounds, LightsHaveNumbersByTheOrderOfTheScene) {
    write("lamp.rib", "LightSource \"pointlight\" 5 \"intensity\" [2] Sphere 1 -1 1 360");
    write("plain.rib", "Sphere 2 -2 2 360");
    Renders c;
    c.then = [](Renders& r, const std::shared_ptr<const scene::Frame>& f) {
        EXPECT_EQ(summary(*r.make(*f, {1})), "? ! Sp2@-50 ? ");
        const auto made = r.make(*f, {2}); // a lamp: all are made
        EXPECT_EQ(summary(*made), "! Sp1@-50 ! Sp2@-50 ! Sp1@-50 ");
        ASSERT_EQ(made->lights.size(), 3u);
        EXPECT_EQ(made->primitives[1]->attributes->lights.last(), 1);
        EXPECT_EQ(made->primitives[5]->attributes->lights.last(), 2);
        EXPECT_EQ(made->primitives[3]->attributes->lights.last(), 0);
    };
    readHere(c,
             camera + "LightSource \"distantlight\" 1 " + left("lamp.rib") + left("plain.rib") + left("lamp.rib") + "WorldEnd");
    EXPECT_EQ(c.messages(), "");
    ASSERT_EQ(c.frames.size(), 1u);
}

TEST_F(DeferredBounds, NamesAreItsOwnAndWorldsCannotEndInIt) {
    write("a.rib", "Declare \"own\" \"uniform float\" Sphere 1 -1 1 360 \"own\" [1] WorldEnd WorldBegin FrameEnd Format 7 7 1");
    write("b.rib", "Sphere 2 -2 2 360 \"own\" [1]");
    Renders c;
    c.then = [](Renders& r, const std::shared_ptr<const scene::Frame>& f) {
        if (r.frames.size() > 1) return; // the world behind it
        const auto made = r.make(*f, {});
        ASSERT_EQ(summary(*made), "! Sp1@-50 ! Sp2@-50 ");
        ASSERT_EQ(made->primitives[1]->params.size(), 1u);
        EXPECT_TRUE(made->primitives[1]->params[0].declared);
        EXPECT_TRUE(made->primitives[3]->params.empty() || !made->primitives[3]->params[0].declared);
        EXPECT_EQ(made->options.xres, 100);
    };
    readHere(c, "Display \"x.tif\" \"file\" \"rgb\" " + camera + left("a.rib") + left("b.rib") +
                    "WorldEnd Format 8 8 1 WorldBegin Sphere 3 -3 3 360 WorldEnd");
    ASSERT_EQ(c.frames.size(), 2u);
    EXPECT_EQ(c.frames[1]->options.xres, 8);
    EXPECT_EQ(summary(*c.frames[1]), "Sp3@0 ");
    for (const char* what : {"WorldEnd inside a procedural", "WorldBegin inside a procedural", "FrameEnd inside a procedural"})
        EXPECT_NE(c.messages().find(what), std::string::npos) << what << "\n" << c.messages();
}

TEST_F(DeferredBounds, WhatShinesOrIsSeenOrBelongsToOthersDoesNotWait) {
    write("a.rib", "Sphere 1 -1 1 360");
    const auto waits = [&](const std::string& scene) {
        Renders c;
        readHere(c, scene + " WorldEnd");
        return !c.frames.empty() && summary(*c.frames[0]).find('?') != std::string::npos;
    };
    EXPECT_TRUE(waits(camera + left("a.rib")));
    EXPECT_TRUE(waits("Hider \"path\" " + camera + left("a.rib")));
    EXPECT_FALSE(waits("Hider \"photon\" " + camera + left("a.rib")));
    EXPECT_FALSE(waits(camera + "AreaLightSource \"arealight\" 1 " + left("a.rib")));
    EXPECT_FALSE(waits(camera + left("a.rib", "[-1 50 -1 1 -1 1]"))); // reaches into the picture
    EXPECT_FALSE(waits(camera + left("a.rib", "[-1e30 1 -1 1 -1 1]")));
    EXPECT_FALSE(waits(camera + "ObjectBegin 1 " + left("a.rib") + "ObjectEnd ObjectInstance 1"));
    EXPECT_FALSE(waits(camera + "SolidBegin \"union\" SolidBegin \"primitive\" " + left("a.rib") + "SolidEnd SolidEnd"));
    EXPECT_FALSE(waits(camera + "Displacement \"dented\" " + left("a.rib"))); // nobody says how far
    EXPECT_TRUE(waits(camera + "Displacement \"dented\" Attribute \"displacementbound\" \"sphere\" [1] " + left("a.rib")));
    EXPECT_FALSE(waits(camera + "Displacement \"dented\" Attribute \"displacementbound\" \"sphere\" [60] " + left("a.rib")));
    // Moving into the picture.
    EXPECT_FALSE(
        waits("Shutter 0 1 " + camera + "MotionBegin [0 1] Translate 0 0 0 Translate 50 0 0 MotionEnd " + left("a.rib")));
    EXPECT_TRUE(
        waits("Shutter 0 1 " + camera + "MotionBegin [0 1] Translate 0 0 0 Translate -50 0 0 MotionEnd " + left("a.rib")));
}

} // namespace

} // namespace unmade_test
