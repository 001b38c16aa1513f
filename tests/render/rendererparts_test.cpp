// Renders in parts, of tiles or of samples: merged, resumed, kept.
#include "fakeengine.h"
#include "render/filmpicture.h"
#include "render/partfile.h"

namespace renderer_test {

TEST(Renderer, MergedPartsAreTheWhole) {
    Folder dir;
    auto render = [&](const std::string& out, std::optional<SampleRange> r) {
        RenderSettings s;
        s.output = out;
        s.spp = 11;
        s.samples = r;
        Session run(s);
        auto f = frameOf("path");
        f->options.filter = {"mitchell", 4, 4};
        run.frame(f);
        EXPECT_EQ(run.diags.errors(), 0);
    };
    render(dir / "whole.exr", {});
    render(dir / "a.exr", SampleRange{0, 3});
    render(dir / "b.exr", SampleRange{3, 4});
    render(dir / "c.exr", SampleRange{4, 11});
    Diagnostics d;
    EXPECT_EQ(mergePictures({dir / "c.exr", dir / "a.exr", dir / "b.exr.part"}, dir / "m.exr", {}, d), MergeResult::Done);
    EXPECT_EQ(d.errors(), 0);
    EXPECT_TRUE(bytesOf(dir / "m.exr") == bytesOf(dir / "whole.exr"));
    EXPECT_EQ(mergePictures({dir / "a.exr", dir / "a.exr"}, dir / "n.exr", {}, d),
              MergeResult::NoInput); // the same samples twice
    EXPECT_FALSE(fs::exists(dir / "n.exr"));
    EXPECT_EQ(mergePictures({dir / "none.exr"}, dir / "n.exr", {}, d), MergeResult::NoInput);
}

TEST(Renderer, PartsOfDifferentScenesDoNotMerge) {
    Folder dir;
    for (int k = 0; k < 2; ++k) {
        RenderSettings s;
        s.output = dir / (k ? "b.exr" : "a.exr");
        s.samples = SampleRange{uint32_t(k), uint32_t(k) + 1};
        Session run(s);
        auto f = frameOf("path");
        if (k) f->options.fov = 80;
        run.frame(f);
    }
    Diagnostics d;
    EXPECT_EQ(mergePictures({dir / "a.exr", dir / "b.exr"}, dir / "m.exr", {}, d), MergeResult::NoInput);
    EXPECT_GT(d.errors(), 0);
}

TEST(Renderer, ResumeGivesTheBitsOfOneRender) {
    Folder dir;
    auto render = [&](const std::string& out, uint32_t spp, bool resume) {
        RenderSettings s;
        s.output = out;
        s.spp = spp;
        if (resume) s.checkpoint = dir / "c.part";
        s.resume = resume && fs::exists(s.checkpoint);
        Session run(s);
        run.frame(frameOf("path"));
        EXPECT_EQ(run.diags.errors(), 0);
    };
    render(dir / "whole.exr", 20, false);
    render(dir / "x.exr", 5, true);
    render(dir / "y.exr", 20, true);
    EXPECT_TRUE(bytesOf(dir / "y.exr") == bytesOf(dir / "whole.exr"));
}

TEST(Renderer, PartsOfTheSamplesAreTheWhole) {
    Folder dir;
    const auto render = [&](const std::string& name, std::optional<std::array<uint32_t, 2>> part) {
        RenderSettings s;
        s.output = dir / name;
        s.spp = 11;
        s.part = part;
        Session run(s);
        run.frame(frameOf("path"));
        return run.diags.errors();
    };
    EXPECT_EQ(render("whole.exr", {}), 0);
    std::vector<std::string> parts;
    for (uint32_t k = 1; k <= 4; ++k) {
        parts.push_back(dir / ("p" + std::to_string(k) + ".exr"));
        EXPECT_EQ(render("p" + std::to_string(k) + ".exr", std::array{k, 4u}), 0);
    }
    Diagnostics d;
    EXPECT_EQ(mergePictures(parts, dir / "all.exr", {}, d), MergeResult::Done);
    EXPECT_TRUE(d.all().empty());
    EXPECT_TRUE(bytesOf(dir / "all.exr") == bytesOf(dir / "whole.exr"));
    EXPECT_EQ(render("e.exr", std::array{1u, 12u}), 1) << "an empty part";
    EXPECT_FALSE(fs::exists(dir / "e.exr"));
    // A part that is missing: at the end too, because parts know the whole. Later it is added.
    EXPECT_EQ(mergePictures({parts[0], parts[1], parts[2]}, dir / "three.exr", {}, d), MergeResult::Done);
    ASSERT_EQ(d.all().size(), 1u);
    EXPECT_EQ(d.warnings(), 1);
    EXPECT_NE(d.all()[0].message.find("8:11 of 0:11"), std::string::npos) << d.all()[0].message;
    Diagnostics late;
    EXPECT_EQ(mergePictures({dir / "three.exr", parts[3]}, dir / "late.exr", {}, late), MergeResult::Done);
    EXPECT_TRUE(late.all().empty());
    EXPECT_TRUE(bytesOf(dir / "late.exr") == bytesOf(dir / "whole.exr"));
}

TEST(Renderer, MissingSamples) {
    using Ranges = std::vector<SampleRange>;
    EXPECT_EQ(missingSamples({{0, 8}}, {0, 8}), Ranges{});
    EXPECT_EQ(missingSamples({{0, 8}, {12, 16}}, {0, 16}), (Ranges{{8, 12}}));
    EXPECT_EQ(missingSamples({{2, 4}, {6, 8}}, {0, 10}), (Ranges{{0, 2}, {4, 6}, {8, 10}}));
    EXPECT_EQ(missingSamples({{2, 20}}, {4, 8}), Ranges{});
    EXPECT_EQ(missingSamples({{20, 30}}, {4, 8}), (Ranges{{4, 8}}));
    EXPECT_EQ(rangeFromText("3:64"), (SampleRange{3, 64}));
    for (const char* bad : {"", "3", "3:", "4:4", "5:4", "0:8x", "-1:4", "0:99999999999"})
        EXPECT_FALSE(rangeFromText(bad)) << bad;
}

TEST(Renderer, ACheckpointIsNotReplacedUnasked) {
    Folder dir;
    const auto render = [&](uint32_t spp, bool resume, bool restart) {
        RenderSettings s;
        s.output = dir / "a.exr";
        s.checkpoint = dir / "c.part";
        s.spp = spp;
        s.resume = resume;
        s.restart = restart;
        Session run(s);
        run.frame(frameOf("path"));
        return run.diags.errors();
    };
    EXPECT_EQ(render(4, false, false), 0);
    const std::string first = bytesOf(dir / "c.part");
    EXPECT_EQ(render(2, false, false), 1);
    EXPECT_TRUE(bytesOf(dir / "c.part") == first);
    EXPECT_EQ(render(6, true, false), 0);
    EXPECT_EQ(render(2, false, true), 0);
    Diagnostics d;
    auto film = loadPart(dir / "c.part", d);
    ASSERT_TRUE(film);
    EXPECT_EQ(film->samplesPerPixel(), 2u);
}

} // namespace renderer_test
