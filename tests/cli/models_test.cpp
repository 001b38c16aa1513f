// alpenglow model.ply and model.obj: framed, lit, and damaged ones reported.
#include "command_folder.h"
#include "display/imageio.h"
#include <cmath>
#include <sstream>

namespace models_test {

namespace {

class Models : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string err;
    int draw(const std::string& model, const std::string& picture) {
        run("--progress none --format 48x36 --spp 2 -o " + picture + " " + model, "2>err");
        std::ifstream in(dir / "err");
        err.assign(std::istreambuf_iterator<char>(in), {});
        return status;
    }
    /// Of a picture the pixels that are red, which the model alone is.
    struct Seen {
        int left = 1000, right = -1, top = 1000, bottom = -1, count = 0;
        float darkest = 1e9f, brightest = 0;
    };
    Seen red(const std::string& picture) const {
        alpenglow::Diagnostics diag;
        const auto image = alpenglow::display::readImage((dir / picture).string(), diag);
        Seen s;
        EXPECT_TRUE(image) << picture;
        for (int y = 0; image && y < image->height; ++y)
            for (int x = 0; x < image->width; ++x) {
                const float* p = &image->data[(size_t(y) * size_t(image->width) + size_t(x)) * size_t(image->channelCount())];
                if (!(p[0] > 3.5f * p[1])) continue; // the floor beside it is lit red as well
                ++s.count;
                s.left = std::min(s.left, x), s.right = std::max(s.right, x), s.top = std::min(s.top, y),
                s.bottom = std::max(s.bottom, y);
                s.darkest = std::min(s.darkest, p[0]), s.brightest = std::max(s.brightest, p[0]);
            }
        return s;
    }
};

struct Box {
    double at[3], size[3];
};
/// Its corners, x fastest.
std::string corners(const Box& b, const char* before, const char* behind) {
    std::ostringstream s;
    for (int k = 0; k < 8; ++k)
        s << before << b.at[0] + (k & 1 ? b.size[0] : 0) << " " << b.at[1] + (k & 2 ? b.size[1] : 0) << " "
          << b.at[2] + (k & 4 ? b.size[2] : 0) << behind << "\n";
    return s.str();
}
const int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
std::string ply(const Box& b) {
    std::string s = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nproperty "
                    "uchar red\nproperty uchar green\nproperty uchar blue\nelement face 6\n"
                    "property list uchar int vertex_indices\nend_header\n" +
                    corners(b, "", " 220 20 20");
    for (auto& f : kFaces) {
        s += "4";
        for (int i : f) s += " " + std::to_string(i);
        s += "\n";
    }
    return s;
}
std::string obj(const Box& b) {
    std::string s = "mtllib box.mtl\nusemtl red\n" + corners(b, "v ", "");
    for (auto& f : kFaces) {
        s += "f";
        for (int i : f) s += " " + std::to_string(i + 1);
        s += "\n";
    }
    return s;
}

const Box kBoxes[] = {{{-1, -1, -1}, {2, 2, 2}}, {{100, 200, -300}, {.01, .01, .01}}, {{-5e5, 0, 0}, {1e6, 2e5, 4e5}}};

} // namespace

TEST_F(Models, AreShownWholeAndLit) {
    write("box.mtl", "newmtl red\nKd .7 .02 .02\n");
    for (const char* name : {"box.ply", "box.obj"})
        for (const Box& b : kBoxes) {
            write(name, std::string(name) == "box.ply" ? ply(b) : obj(b));
            EXPECT_EQ(draw(name, "p.exr"), 0) << err;
            const Seen s = red("p.exr");
            // All of it, with room around it, and no smaller than the ball about it must be: a flat box is at least a quarter
            // high.
            EXPECT_GT(s.left, 0) << name;
            EXPECT_GT(s.top, 0) << name;
            EXPECT_LT(s.right, 47) << name;
            EXPECT_LT(s.bottom, 35) << name;
            EXPECT_GT(std::max(s.right - s.left, s.bottom - s.top), 18) << name;
            EXPECT_GT(s.count, 100) << name;
            EXPECT_NEAR((s.left + s.right) / 2., 23.5, 3) << name;
            EXPECT_NEAR((s.top + s.bottom) / 2., 17.5, 3) << name;
            // The sky and the sun: no side is dark, and they are not the same.
            EXPECT_GT(s.darkest, .02f) << name;
            EXPECT_GT(s.brightest, 1.5f * s.darkest) << name;
        }
}

TEST_F(Models, WhatIsWrongWithThemIsSaid) {
    const std::string whole = ply(kBoxes[0]);
    const struct {
        const char *name, *text, *said;
        int status;
    } cases[] = {
        {"cut.ply", "", "the file ends early", 1},
        {"no.ply", "hello\n", "no.ply:1:1: error: the file is no PLY", 1},
        {"empty.ply", "", "error: the file is no PLY", 1},
        {"word.obj", "v 0 0 0\nv 1 0 x\nv 1 1 0\nf 1 2 3\n", "word.obj:2: error: \"x\" is no number", 1},
        {"index.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n", "faces use vertices that are not there", 1},
        {"none.obj", nullptr, "none.obj: error: the file cannot be read", 3},
    };
    for (const auto& c : cases) {
        if (c.text) write(c.name, std::string(c.name) == "cut.ply" ? whole.substr(0, whole.size() * 2 / 3) : c.text);
        EXPECT_EQ(draw(c.name, "p.png"), c.status) << c.name << "\n" << err;
        EXPECT_NE(err.find(c.said), std::string::npos) << c.name << "\n" << err;
    }
}

} // namespace models_test
