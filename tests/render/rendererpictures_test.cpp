// Which pictures a render writes: names, displays, frames, maps.
#include "fakeengine.h"

namespace renderer_test {

TEST(Renderer, StopBeforeAPassWritesNothing) {
    Folder dir;
    StopFlag stop{1};
    RenderSettings s;
    s.output = dir / "a.exr";
    s.stop = &stop;
    Session run(s);
    run.frame(frameOf("path"));
    EXPECT_TRUE(run.renderer.outcome().interrupted);
    EXPECT_EQ(run.renderer.outcome().rendered, 0);
    EXPECT_FALSE(fs::exists(s.output));
}

TEST(Renderer, NamesOfSeveralFrames) {
    Folder dir;
    RenderSettings s;
    s.output = dir / "a.exr";
    Session run(s);
    for (int k : {1, 2}) {
        auto f = frameOf("hidden", 4, 4);
        f->options.frameNumber = k;
        run.frame(f);
    }
    EXPECT_FALSE(fs::exists(dir / "a.exr"));
    EXPECT_TRUE(fs::exists(dir / "a.0001.exr"));
    EXPECT_TRUE(fs::exists(dir / "a.0002.exr"));
    // Worlds outside of frames: the first has the name itself.
    s.output = dir / "b.exr";
    Session worlds(s);
    for (int k = 0; k < 2; ++k) worlds.frame(frameOf("hidden", 4, 4));
    EXPECT_TRUE(fs::exists(dir / "b.exr"));
    EXPECT_TRUE(fs::exists(dir / "b.0002.exr"));
    EXPECT_EQ(worlds.diags.all().size(), 0u);
}

// Published scenes show in a window what they write: Display "a.tif" "file" "rgba", Display "+a.tif" "framebuffer" "rgb".
TEST(Renderer, OneDisplayForEachFile) {
    for (int order : {0, 1, 2}) {
        Folder dir;
        RenderSettings s;
        s.allowWrite = true;
        Session run(s);
        auto f = frameOf("hidden", 4, 4);
        const std::string a = dir / "a.tif";
        const scene::Display file{a, "file", "rgba", {}, {}}, window{a, "framebuffer", "rgb", {}, {}},
            more{a, "tiff", "z", {}, {}};
        using Displays = std::vector<scene::Display>;
        f->options.displays = order == 0   ? Displays{file, window}
                              : order == 1 ? Displays{window, file}
                                           : Displays{file, more, {dir / "b.tif", "tiff", "z", {}, {}}};
        run.frame(f);
        EXPECT_EQ(read(dir / "a.tif").channels.size(), 4u) << order;
        EXPECT_EQ(run.diags.warnings(), order == 2) << order;
        EXPECT_EQ(fs::exists(dir / "b.tif"), order == 2);
        // Two files of one name: neither is lost.
        EXPECT_EQ(fs::exists(dir / "a.2.tif"), order == 2);
        if (order == 2) EXPECT_EQ(read(dir / "a.2.tif").channels, std::vector<std::string>{"z"});
    }
}

// A shadow pass and a picture, as old scenes have them: what the command line says about pictures leaves the map as it is.
TEST(Renderer, OptionsAboutPicturesLeaveMapsAlone) {
    for (const char* hider : {"hidden", "path"}) {
        Folder dir;
        RenderSettings s;
        s.allowWrite = true;
        s.output = dir / "picture.exr";
        s.width = 12;
        s.height = 9;
        s.gamma = 2;
        s.hider = "path";
        s.spp = 4;
        Session run(s);
        auto pass = frameOf(hider, 24, 16), picture = frameOf("hidden", 24, 16);
        pass->options.displays = {{dir / "light.z", "zfile", "z", {}, {}}};
        picture->options.displays = {{dir / "scene.tif", "file", "rgba", {}, {}}, {dir / "depth.exr", "openexr", "z", {}, {}}};
        run.frame(pass);
        EXPECT_EQ(run.renderer.stats().spp, 4u) << "PixelSamples 2 2 of the scene";
        run.frame(picture);
        run.renderer.finish();
        EXPECT_EQ(run.diags.all().size(), 0u);
        const display::Image map = read(dir / "light.z");
        EXPECT_EQ(map.width, 24);
        EXPECT_EQ(pass->options.hider, "hidden");
        EXPECT_EQ(map.channels, std::vector<std::string>{"z"});
        EXPECT_NEAR(map.pixel(3, 3)[0], 5, 1e-5);
        EXPECT_EQ(read(dir / "picture.exr").width, 12);
        EXPECT_EQ(picture->options.hider, "path");
        EXPECT_EQ(read(dir / "depth.exr").width, 12) << "depth of the same camera";
        EXPECT_FALSE(fs::exists(dir / "scene.tif"));
    }
}

TEST(Renderer, ASceneOfMapsAloneSaysThatOptionsHaveNoEffect) {
    Folder dir;
    RenderSettings s;
    s.allowWrite = true;
    s.output = dir / "a.png";
    s.hider = "path";
    Session run(s);
    auto f = frameOf("hidden", 4, 4);
    f->options.displays = {{dir / "light.z", "shadow", "z", {}, {}}};
    run.frame(f);
    run.renderer.finish();
    EXPECT_TRUE(fs::exists(dir / "light.z"));
    EXPECT_FALSE(fs::exists(dir / "a.png"));
    ASSERT_EQ(run.diags.all().size(), 1u);
    EXPECT_EQ(run.diags.all()[0].message.rfind("-o, --hider: without effect", 0), 0u) << run.diags.all()[0].message;
}

TEST(Renderer, FramesNeverWriteEachOthersPictures) {
    const auto frame = [](int number, const std::string& name, const char* type, const char* mode) {
        auto f = frameOf("hidden", 4, 4);
        f->options.inFrame = true;
        f->options.frameNumber = number;
        f->options.displays = {{name, type, mode, {}, {}}};
        return f;
    };
    Folder dir;
    RenderSettings s;
    s.allowWrite = true;
    {
        Session run(s);
        for (int k : {1, 2, 3}) run.frame(frame(k, dir / "a.exr", "openexr", "rgba"));
        EXPECT_EQ(run.diags.warnings(), 2);
    }
    for (const char* name : {"a.exr", "a.0002.exr", "a.0003.exr"}) EXPECT_TRUE(fs::exists(dir / name)) << name;
    // The names do not depend on which frames are wanted.
    fs::remove_all(dir.path);
    fs::create_directory(dir.path);
    {
        Session run(s);
        for (int k : {1, 2}) run.renderer.passOver(frame(k, dir / "a.exr", "openexr", "rgba")->options);
        run.frame(frame(3, dir / "a.exr", "openexr", "rgba"));
    }
    EXPECT_TRUE(fs::exists(dir / "a.0003.exr"));
    EXPECT_FALSE(fs::exists(dir / "a.exr"));
    // What a Make request reads, and maps, are made anew for each frame under the same name.
    Session run(s);
    for (int k : {1, 2}) {
        run.frame(frame(k, dir / "seen.exr", "openexr", "rgba"));
        run.renderer.passOverTexture({dir / "seen.exr", dir / "seen.tx"});
        run.frame(frame(k, dir / "light.z", "zfile", "z"));
        run.frame(frame(k, dir / "picture.####.exr", "openexr", "rgba"));
    }
    EXPECT_EQ(run.diags.all().size(), 0u);
    for (const char* name : {"seen.exr", "light.z", "picture.0001.exr", "picture.0002.exr"})
        EXPECT_TRUE(fs::exists(dir / name)) << name;
    EXPECT_FALSE(fs::exists(dir / "seen.0002.exr") || fs::exists(dir / "light.0002.z"));
}

} // namespace renderer_test
