// Reads RIB text and keeps what comes out.
#pragma once
#include "ri/reader.h"
#include "scene/scene.h"
#include <gtest/gtest.h>

namespace alpenglow::ri {

struct Collected : scene::FrameConsumer {
    struct Texture {
        std::string kind;
        std::vector<std::string> files;
        scene::ParamList args;
    };
    std::vector<std::shared_ptr<const scene::Frame>> frames;
    std::vector<Texture> textures;
    Diagnostics diagnostics;
    bool ok = false;

    void render(std::shared_ptr<const scene::Frame> f) override { frames.push_back(std::move(f)); }
    void makeTexture(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                     const SourcePlace&) override {
        textures.push_back({kind, files, args});
    }
    /// All messages, one after the other.
    std::string messages() const {
        std::string s;
        for (const Diagnostic& d : diagnostics.all()) s += toString(d);
        return s;
    }
    size_t count() const { return diagnostics.all().size(); }
    /// The first message; a failure when there is none.
    Diagnostic first() const {
        EXPECT_GE(count(), 1u);
        return count() ? diagnostics.all()[0] : Diagnostic{};
    }
    /// The only message; a failure when there is not exactly one.
    Diagnostic only() const {
        EXPECT_EQ(count(), 1u) << messages();
        return count() ? diagnostics.all()[0] : Diagnostic{};
    }
    const scene::Frame& frame() const {
        static const scene::Frame none;
        EXPECT_EQ(frames.size(), 1u);
        return frames.empty() ? none : *frames[0];
    }
    const scene::Primitive& primitive(size_t i = 0) const {
        static const scene::Primitive none{.attributes = std::make_shared<scene::Attributes>()};
        EXPECT_LT(i, frame().primitives.size());
        return i < frame().primitives.size() ? *frame().primitives[i] : none;
    }
};

inline std::unique_ptr<Collected> read(std::string_view text, ReaderOptions options = {}) {
    auto c = std::make_unique<Collected>();
    RibReader reader(std::move(options), *c, c->diagnostics);
    c->ok = reader.readMemory(text, "t.rib");
    return c;
}
/// `text` inside a world.
inline std::unique_ptr<Collected> inWorld(const std::string& text) { return read("WorldBegin\n" + text + "\nWorldEnd\n"); }

inline void expectMatrix(const Matrix& m, std::initializer_list<double> rows, double tolerance = 1e-12) {
    size_t i = 0;
    for (double v : rows) {
        EXPECT_NEAR(m.m[i / 4][i % 4], v, tolerance) << "row " << i / 4 << " column " << i % 4;
        ++i;
    }
}

} // namespace alpenglow::ri
