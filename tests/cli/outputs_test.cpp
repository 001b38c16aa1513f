// No work and no picture is lost: names of files, several scenes, frames, checkpoints, parts.
#include "command_folder.h"
#include <nlohmann/json.hpp>

namespace outputs_test {

namespace fs = std::filesystem;

namespace {

const char* const kWorld = R"(
Projection "perspective" "fov" 40
LightSource "distantlight" 1 "from" [0 0 0] "to" [0 0 1]
WorldBegin
Translate 0 0 5
Surface "matte"
Sphere 1 -1 1 360
WorldEnd
)";

class Outputs : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string err;
    int go(const std::string& arguments) {
        run(arguments, "2>err");
        err = read("err");
        return status;
    }
    int render(const std::string& arguments) { return go("render --progress none " + arguments); }
    bool has(const std::string& name) const { return fs::exists(dir / name); }
    bool says(const std::string& text) const { return err.find(text) != std::string::npos; }
    std::string read(const std::string& name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void scene(const std::string& name, const std::string& options, const std::string& world = kWorld) const {
        write(name, "Format 16 12 1\n" + options + "\n" + world);
    }
};

} // namespace

// -o is the picture; what else the scene asks for is written to the same folder.
TEST_F(Outputs, OneNamedPictureLeavesOtherOutputs) {
    scene("s.rib", "Display \"f.exr\" \"openexr\" \"rgba\"\nDisplay \"+n.exr\" \"openexr\" \"N\"\n"
                   "Display \"+b.png\" \"png\" \"rgb\"\nHider \"path\"");
    EXPECT_EQ(render("--noise .5 -o o.exr s.rib"), 0) << err;
    EXPECT_TRUE(has("o.exr") && has("n.exr")) << err;
    EXPECT_FALSE(has("f.exr") || has("b.png"));
    fs::remove(dir / "n.exr");
    EXPECT_EQ(render("--spp 2 -q -o - s.rib"), 0) << err;
    EXPECT_TRUE(has("n.exr") && !has("f.exr") && !has("b.png")) << err;
}

// So do parts, and what is merged of them.
TEST_F(Outputs, PartsOfANamedPictureHaveOtherOutputs) {
    scene("s.rib", "Display \"f.exr\" \"openexr\" \"rgba\"\nDisplay \"+n.exr\" \"openexr\" \"N\"\n"
                   "Display \"+b.png\" \"png\" \"rgb\"\nHider \"path\"");
    EXPECT_EQ(render("--spp 4 -o o.exr s.rib"), 0) << err;
    fs::rename(dir / "n.exr", dir / "whole.exr");
    EXPECT_EQ(render("--samples 0:2 -o p.exr s.rib"), 0) << err;
    EXPECT_TRUE(has("n.exr")) << err;
    EXPECT_EQ(render("--spp 4 --part 2/2 -o q.exr s.rib"), 0) << err;
    EXPECT_EQ(go("merge -o m.exr p.exr q.exr"), 0) << err;
    EXPECT_EQ(go("diff --tolerance 0 m.exr o.exr"), 0) << err;
    EXPECT_EQ(go("diff --tolerance 0 n.exr whole.exr"), 0) << err;
    EXPECT_FALSE(has("f.exr") || has("b.png"));
}

TEST_F(Outputs, DisplaysOfOneFileAreBothWritten) {
    scene("s.rib", "Display \"f.exr\" \"openexr\" \"rgba\"\nDisplay \"+./f.exr\" \"openexr\" \"z\"");
    EXPECT_EQ(render("s.rib"), 0) << err;
    EXPECT_TRUE(has("f.exr") && has("f.2.exr"));
    EXPECT_TRUE(says("s.rib:3") && says("s.rib:2")) << err; // both lines
    EXPECT_FALSE(read("f.exr") == read("f.2.exr"));
}

TEST_F(Outputs, AbsoluteNamesOutsideAreRefusedBeforeRendering) {
    scene("s.rib", "Display \"/x/rgb/f.exr\" \"openexr\" \"rgba\"\nDisplay \"+/x/depth/f.exr\" \"openexr\" \"z\"");
    EXPECT_EQ(render("--hider path --spp 1000000 s.rib"), 5);
    EXPECT_TRUE(says("s.rib:2") && says("s.rib:3") && says("--allow-write")) << err;
    EXPECT_FALSE(has("f.exr"));
}

// A scene may read a map that it has just made, wherever that is; textureinfo() says that it may not read another.
TEST_F(Outputs, MapsThatASceneMadeAreReadable) {
    const fs::path elsewhere = dir.string() + "-elsewhere"; // neither below the scene nor below the current folder
    fs::create_directories(elsewhere);
    fs::create_directories(dir / "a/b");
    const std::string map = (elsewhere / "m.tx").string(), wall = "Polygon \"P\" [-9 -9 1 -9 9 1 9 9 1 9 -9 1]\nWorldEnd\n";
    scene("p.rib", "Display \"p.exr\" \"openexr\" \"rgba\"", "WorldBegin\nColor [.25 .5 .75]\nSurface \"constant\"\n" + wall);
    ASSERT_EQ(render("p.rib"), 0) << err;
    write("a/b/own.sl", "surface own(string map = \"\") { float c = 0, known = textureinfo(map, \"channels\", c);\n"
                        "  Oi = 1; Ci = known == 1 ? color texture(map) : color (1, 0, 1); }\n");
    const std::string use = "WorldBegin\nSurface \"own\" \"string map\" \"" + map + "\"\n" + wall;
    scene("a/b/s.rib", "MakeTexture \"../../p.exr\" \"" + map + "\" \"clamp\" \"clamp\" \"box\" 1 1", use);
    EXPECT_EQ(run("render --progress none --allow-write --pixel 8,6 a/b/s.rib", "2>err").rfind("0.25 0.5 0.75", 0), 0u)
        << read("err");
    EXPECT_EQ(status, 0);
    scene("a/b/t.rib", "", use);
    EXPECT_EQ(run("render --progress none --allow-write --pixel 8,6 a/b/t.rib", "2>err"), "1 0 1 1\n");
    err = read("err");
    EXPECT_TRUE(says("outside the folders that a scene may read; to textureinfo() it is missing")) << err;
    EXPECT_EQ(status, 1);
    fs::remove_all(elsewhere);
}

TEST_F(Outputs, FilesOfTheCommandLineAreTriedBeforeTheSceneIsRead) {
    write("file", "a file, no folder");
    for (const char* bad : {"-o file/a.png", "--stats file/s.json", "--checkpoint file/c.part"}) {
        EXPECT_EQ(render(std::string(bad) + " none.rib"), 5) << bad;
        EXPECT_TRUE(says("cannot write") && !says("none.rib")) << err;
    }
}

TEST_F(Outputs, EachFileIsASceneAndOptionsComeBefore) {
    // Were the state kept, the second scene would see the inside of nothing: its camera would be turned twice.
    scene("a.rib", "Display \"a.exr\" \"openexr\" \"rgba\"\nRotate 180 0 1 0\nRotate 180 0 1 0\nScale 1 1 1\nTranslate 0 0 3");
    EXPECT_EQ(render("a.rib a.rib"), 0) << err;
    ASSERT_TRUE(has("a.exr") && has("a.2.exr"));
    EXPECT_TRUE(read("a.exr") == read("a.2.exr"));
    write("options.rib", "Format 20 10 1\nHider \"path\"\nPixelSamples 1 1\n");
    write("w.rib", kWorld);
    EXPECT_EQ(render("-o o.exr options.rib w.rib a.rib w.rib"), 0) << err;
    ASSERT_TRUE(has("o.exr") && has("o.0002.exr") && has("o.0003.exr"));
    EXPECT_TRUE(read("o.exr") == read("o.0003.exr"));
    EXPECT_FALSE(read("o.exr") == read("o.0002.exr"));
    write("w.rib", "Format 20 10 1\nHider \"path\"\nPixelSamples 1 1\n" + std::string(kWorld));
    EXPECT_EQ(render("-o both.exr w.rib"), 0) << err;
    EXPECT_TRUE(read("o.exr") == read("both.exr")); // options reach all scenes behind them
}

TEST_F(Outputs, FramesCarryTheirNumbers) {
    std::string frames = "Format 16 12 1\n";
    for (int k : {1, 2, 3, 5}) frames += "FrameBegin " + std::to_string(k) + kWorld + "FrameEnd\n";
    write("t.rib", frames);
    EXPECT_EQ(render("-o h.png --frames 3,5 t.rib"), 0) << err;
    EXPECT_TRUE(has("h.0003.png") && has("h.0005.png") && !has("h.png"));
    EXPECT_EQ(render("-o p.png --frames 5 t.rib"), 0) << err; // the name does not depend on the list
    EXPECT_TRUE(has("p.0005.png") && !has("p.png"));
    EXPECT_EQ(render("-o 'q%02d.png' --frames 5 t.rib"), 0) << err;
    EXPECT_EQ(render("-o 'q.###.png' --frames 5 t.rib"), 0) << err;
    EXPECT_TRUE(has("q05.png") && has("q.005.png"));
    EXPECT_EQ(render("-o r.png --frames 30 t.rib"), 3);
    EXPECT_TRUE(says("not 30")) << err;
    EXPECT_EQ(render("-o r.png --frames 5-7 t.rib"), 0);
    EXPECT_TRUE(says("not 6-7") && has("r.0005.png")) << err;
    EXPECT_EQ(render("--display png:d.png --frames 2 t.rib"), 0) << err;
    EXPECT_TRUE(has("d.0002.png"));
    scene("s.rib", "");
    EXPECT_EQ(render("-o plain.png s.rib"), 0) << err;
    EXPECT_TRUE(has("plain.png"));
}

// Exporters write FrameBegin 1 around a single picture: it has the name that was asked for.
TEST_F(Outputs, ASingleFrameHasThePlainName) {
    const std::string shadow = "Display \"l.z\" \"zfile\" \"z\"\nWorldBegin Translate 0 0 5 Sphere 1 -1 1 360 WorldEnd\n";
    write("one.rib", "Format 16 12 1\nFrameBegin 1\n" + shadow + "FrameEnd\nFrameBegin 2\n" + kWorld + "FrameEnd\n");
    EXPECT_EQ(render("-o one.png one.rib"), 0) << err; // a shadow pass is no picture
    EXPECT_TRUE(has("one.png") && !has("one.0002.png"));
    EXPECT_EQ(render("-o f7.png --frames 2 one.rib"), 0) << err;
    EXPECT_TRUE(has("f7.png"));
    // A second frame gives both their numbers; the files are those of a render by frames.
    const std::string frame = std::string("FrameBegin 4\n") + kWorld + "FrameEnd\n";
    write("two.rib", "Format 16 12 1\nHider \"path\"\nPixelSamples 2 1\n" + frame +
                         "FrameBegin 9\nProjection \"orthographic\"\n" + kWorld + "FrameEnd\n");
    EXPECT_EQ(render("-o two.exr --samples 0:2 --stats two.json two.rib"), 0) << err;
    EXPECT_FALSE(has("two.exr") || has("two.exr.part"));
    ASSERT_TRUE(has("two.0004.exr") && has("two.0009.exr") && has("two.0004.exr.part"));
    EXPECT_NE(read("two.json").find("\"two.0004.exr\""), std::string::npos);
    EXPECT_EQ(read("two.json").find("\"two.exr\""), std::string::npos);
    EXPECT_EQ(render("-o 'by.####.exr' --samples 0:2 two.rib"), 0) << err;
    EXPECT_TRUE(read("two.0004.exr") == read("by.0004.exr"));
    EXPECT_TRUE(read("two.0009.exr") == read("by.0009.exr"));
    for (const char* k : {"4", "9"}) EXPECT_EQ(render(std::string("-o list.exr --frames ") + k + " two.rib"), 0) << err;
    EXPECT_TRUE(has("list.0004.exr") && has("list.0009.exr") && !has("list.exr")); // whatever is listed
    // The frame of another file is a second one, too; of the same number it is distinguished.
    write("a.rib", "Format 16 12 1\n" + frame);
    EXPECT_EQ(render("-o files.png a.rib a.rib"), 0) << err;
    EXPECT_TRUE(has("files.0004.png") && has("files.0004.0004.png") && !has("files.png"));
    // Started again behind an interruption: the first frame is found done, and numbered again.
    const std::string job = "--checkpoint c.ckp --resume -o job.exr ";
    EXPECT_EQ(render(job + "a.rib"), 0) << err; // as far as it had come
    ASSERT_TRUE(has("job.exr"));
    EXPECT_EQ(render("--hider path --spp 2 " + job + "two.rib"), 0) << err;
    EXPECT_TRUE(has("job.0004.exr") && has("job.0009.exr") && !has("job.exr"));
    const std::string first = read("job.0004.exr");
    EXPECT_EQ(render("--hider path --spp 2 " + job + "two.rib"), 0) << err;
    EXPECT_TRUE(read("job.0004.exr") == first && !has("job.exr"));
}

TEST_F(Outputs, ShadowPassesKeepTheirFiles) {
    write("v.rib", std::string("Format 16 16 1\nDisplay \"l.z\" \"zfile\" \"z\"\nWorldBegin Translate 0 0 5 Sphere 1 -1 1 360 "
                               "WorldEnd\nMakeShadow \"l.z\" \"l.shd\"\nDisplay \"v.tif\" \"file\" \"rgb\"\n") +
                       kWorld);
    EXPECT_EQ(render("-o v.png --format 30x20 --gamma 2 --hider path --spp 4 v.rib"), 0) << err;
    EXPECT_TRUE(has("l.z") && has("l.shd") && has("v.png"));
    EXPECT_FALSE(has("v.tif") || has("v.0002.png"));
    EXPECT_EQ(render("--pixel 8,8 v.rib"), 0) << err; // makes the map and no picture
    EXPECT_FALSE(has("v.tif"));
    const std::string map = read("l.z");
    EXPECT_EQ(render("v.rib"), 0) << err;
    EXPECT_TRUE(read("l.z") == map); // the same map with and without the options
    // A picture that the scene reads itself is no picture to look at either.
    write("e.rib", std::string("Format 16 16 1\nDisplay \"e.tif\" \"file\" \"rgb\"\n") + kWorld +
                       "MakeTexture \"e.tif\" \"e.tx\" \"black\" \"black\" \"box\" 1 1\nDisplay \"ve.tif\" \"file\" \"rgb\"\n" +
                       kWorld);
    EXPECT_EQ(render("-o ve.png --hider path --spp 1 e.rib"), 0) << err;
    EXPECT_TRUE(has("e.tif") && has("e.tx") && has("ve.png"));
    EXPECT_FALSE(has("ve.tif") || has("ve.0002.png"));
    scene("z.rib", "Display \"only.z\" \"zfile\" \"z\"");
    EXPECT_EQ(render("-o w.png z.rib"), 0);
    EXPECT_TRUE(says("-o: without effect") && has("only.z") && !has("w.png")) << err;
}

TEST_F(Outputs, Checkpoints) {
    scene("s.rib", "");
    const std::string how = "--hider path --checkpoint c.ckp -o a.exr ";
    EXPECT_EQ(render(how + "--spp 4 --resume s.rib"), 0) << err; // the line of a job that is started again and again
    const std::string four = read("c.ckp");
    EXPECT_EQ(render(how + "--spp 2 s.rib"), 3);
    EXPECT_TRUE(says("--resume") && says("--restart")) << err;
    EXPECT_EQ(render(how + "--spp 2 --seed 9 --resume s.rib"), 3);
    EXPECT_TRUE(read("c.ckp") == four);
    EXPECT_EQ(render(how + "--spp 8 --resume s.rib"), 0) << err;
    EXPECT_EQ(render(how + "--spp 4 --restart s.rib"), 0) << err;
    EXPECT_TRUE(read("c.ckp") == four);
    EXPECT_EQ(render("--restart s.rib"), 2);
    EXPECT_EQ(render(how + "--restart --resume s.rib"), 2);
    EXPECT_EQ(render(how + "--spp 4 --resume s.rib"), 0) << err; // it has them all
    EXPECT_TRUE(says("nothing to do") && !says("empty")) << err;
    EXPECT_TRUE(read("c.ckp") == four);
}

// merge takes the part file next to a picture for that picture's.
TEST_F(Outputs, PartsOfOlderPicturesGo) {
    scene("s.rib", "");
    const std::string how = "--hider path --seed 7 ";
    const auto parts = [&] {
        EXPECT_EQ(render(how + "--spp 4 --samples 0:2 -o a.exr s.rib"), 0) << err;
        EXPECT_EQ(render(how + "--spp 4 --samples 2:4 -o b.exr s.rib"), 0) << err;
    };
    parts();
    EXPECT_EQ(render(how + "--spp 2 -o a.exr s.rib"), 0) << err; // another picture
    EXPECT_FALSE(has("a.exr.part"));
    EXPECT_EQ(go("merge -o m.exr a.exr b.exr"), 3) << err;
    parts();
    EXPECT_EQ(render("--hider hidden -o a.exr s.rib"), 0) << err;
    EXPECT_FALSE(has("a.exr.part"));
    // What is whole has no part, and parts that were given stay.
    parts();
    EXPECT_EQ(go("merge -o m.exr b.exr"), 0) << err;
    EXPECT_TRUE(has("m.exr.part"));
    EXPECT_EQ(go("merge -o m.exr a.exr b.exr"), 0) << err;
    EXPECT_FALSE(has("m.exr.part"));
    EXPECT_TRUE(has("a.exr.part") && has("b.exr.part"));
    // A checkpoint may have that name, and what is no part file is not ours.
    EXPECT_EQ(render(how + "--spp 2 --checkpoint c.exr.part -o c.exr s.rib"), 0) << err;
    EXPECT_TRUE(has("c.exr.part"));
    write("d.exr.part", "mine");
    EXPECT_EQ(render(how + "--spp 2 -o d.exr s.rib"), 0) << err;
    EXPECT_TRUE(has("d.exr.part"));
}

TEST_F(Outputs, PartsAndGaps) {
    scene("s.rib", "");
    const std::string how = "--hider path --spp 10 ";
    EXPECT_EQ(render(how + "-o whole.exr s.rib"), 0) << err;
    for (int k : {1, 2, 3})
        EXPECT_EQ(render(how + "--part " + std::to_string(k) + "/3 -o p" + std::to_string(k) + ".exr s.rib"), 0);
    EXPECT_EQ(render(how + "--samples 3:6 -o r.exr s.rib"), 0) << err;
    EXPECT_TRUE(read("p2.exr") == read("r.exr"));
    EXPECT_EQ(go("merge p3.exr p1.exr p2.exr -o m.exr"), 0) << err;
    EXPECT_EQ(err, "");
    EXPECT_TRUE(read("m.exr") == read("whole.exr"));
    EXPECT_EQ(go("merge --expect 0:10 p3.exr p1.exr p2.exr -o m.exr"), 0) << err;
    EXPECT_EQ(go("merge p1.exr p3.exr -o gap.exr"), 0);
    EXPECT_TRUE(says("warning") && says("3:6")) << err;
    EXPECT_EQ(go("merge --expect 0:10 p1.exr p3.exr -o gap.exr"), 1);
    EXPECT_TRUE(says("error") && says("3:6") && has("gap.exr")) << err;
    EXPECT_EQ(go("merge --expect 0:12 p1.exr p2.exr p3.exr -o gap.exr"), 1);
    EXPECT_TRUE(says("10:12")) << err;
    EXPECT_EQ(go("merge --expect 0:8 p1.exr p2.exr p3.exr -o more.exr"), 1);
    EXPECT_TRUE(says("more than")) << err;
    EXPECT_EQ(go("merge p1.exr p3.exr -o gap.exr"), 0);
    EXPECT_EQ(go("merge gap.exr p2.exr -o late.exr"), 0) << err;
    EXPECT_TRUE(read("late.exr") == read("whole.exr"));
    for (const char* bad :
         {"--part 0/4", "--part 5/4", "--part 2", "--part 1/2x", "--part 1/2 --samples 0:4", "--part 1/2 --noise 0.1"}) {
        EXPECT_EQ(render(std::string(bad) + " s.rib"), 2) << bad;
    }
    EXPECT_EQ(go("merge --expect 8 p1.exr -o m.exr"), 2);
}

// The repelling plane of an old file reads the depth map that the same file makes (Pixar's application note 31): the blob over a
// wall at 4 ends above it.
TEST_F(Outputs, BlobbiesAreRepelledByADepthMapOfTheScene) {
    const std::string blob = "Blobby 2 [1001 0 1003 0 16 0 2 0 1] [2 0 0 0 0 2 0 0 0 0 2 0 0 0 4 1  1 1 1 0] [\"wall.z\"]\n";
    write("blob.rib",
          "Format 16 16 1\nPixelSamples 1 1\nProjection \"orthographic\"\nFrameBegin 1\nDisplay \"wall.z\" \"zfile\" "
          "\"z\"\nWorldBegin\nPolygon \"P\" [-9 -9 4  -9 9 4  9 9 4  9 -9 4]\nWorldEnd\nFrameEnd\nFrameBegin 2\nDisplay "
          "\"b.exr\" \"openexr\" \"rgba\"\nProjection \"orthographic\"\nWorldBegin\n" +
              blob + "WorldEnd\nFrameEnd\n");
    EXPECT_EQ(render("-o b.exr blob.rib"), 0) << err;
    EXPECT_EQ(err.find("depth map"), std::string::npos) << err;
    EXPECT_EQ(read("wall.z").substr(0, 4), "\xab\x67\x08\x2f");
}

} // namespace outputs_test
