// Pictures that grow elsewhere than on the page: in the terminal, and in a viewer that listens at a socket (tev).
#pragma once
#include "render/watcher.h"
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::view {

/// Observes a render, for at most a fiftieth of its time, and forwards linear float pictures.
class Preview : public render::Watcher {
public:
    /// Messages go there.
    explicit Preview(Diagnostics& d) : diagnostics_(d) {}
    void begin(const render::WatchedFrame&) final;
    void look(const render::Glance&) final;
    void finished(std::unique_ptr<render::Film>) final;

protected:
    /// Which pictures of the frame are wanted.
    virtual bool wants(const render::OutputSpec&) const = 0;
    /// Shows a picture, with its window in the complete one.
    virtual void show(const render::OutputSpec&, const render::PictureFacts&, const display::Image&) = 0;
    Diagnostics& diagnostics_;

private:
    void show(const render::Glance&, const render::OutputPlan& own);
    const render::OutputPlan* own_ = nullptr;
    std::optional<render::OutputPlan> plan_; ///< without curves
    render::PictureFacts facts_;
    std::shared_ptr<const world::World> world_;
    double last_ = -1, cost_ = 0;
    bool stale_ = false;
};

/// Several that look on.
class Watchers final : public render::Watcher {
public:
    std::vector<std::unique_ptr<render::Watcher>> all; ///< in the order of the calls
    void begin(const render::WatchedFrame& f) override {
        for (auto& w : all) w->begin(f);
    }
    void look(const render::Glance& g) override {
        for (auto& w : all) w->look(g);
    }
    void finished(std::unique_ptr<render::Film>) override;
};

// --- the terminal ---

/// Bytes to look at, rows from the top.
struct Bytes {
    int width = 0, height = 0; ///< pixels
    std::vector<uint8_t> rgb;  ///< three a pixel
};
/// The red, green and blue of a picture as sRGB, each pixel the mean of what it covers.
Bytes shrunk(const display::Image&, int width, int height);
/// Two pixels a character, the upper half block in 24-bit colours: lines, each with its end.
std::string halfBlocks(const Bytes&);
/// DEC sixels: 216 colours with ordered dither.
std::string sixels(const Bytes&);
/// The graphics protocol of kitty; the cursor stays.
std::string kittyGraphics(const Bytes&);

/// How a terminal shows pictures. Blocks: two coloured pixels a character.
enum class TerminalKind { Blocks, Sixel, Kitty };
/// "blocks", "sixel", "kitty".
std::optional<TerminalKind> terminalKindByName(const std::string&);
/// Capabilities of this process's terminal: from environment variables and its device attributes.
TerminalKind terminalKind();

/// A terminal.
struct TerminalSize {
    int columns = 80, rows = 24, cellWidth = 8, cellHeight = 16; ///< in characters; of a character in pixels
};
/// Of standard error; defaults where it is no terminal.
TerminalSize terminalSize();

/// Draws over its previous picture, above the progress line.
class TerminalPreview final : public Preview {
public:
    /// Receives text for the terminal.
    using Sink = std::function<void(const std::string&)>;
    /// sink: writes to the terminal, in the thread that renders.
    TerminalPreview(Diagnostics& d, TerminalKind k, TerminalSize s, Sink sink)
        : Preview(d), kind_(k), size_(s), sink_(std::move(sink)) {}
    /// Other output was printed: the next picture is drawn below it.
    void scrolled() { shown_ = 0; }

private:
    bool wants(const render::OutputSpec&) const override;
    void show(const render::OutputSpec&, const render::PictureFacts&, const display::Image&) override;
    const TerminalKind kind_;
    const TerminalSize size_;
    const Sink sink_;
    int shown_ = 0; ///< lines that the last picture took
};

// --- tev ---

/// Packets of tev's protocol (github.com/Tom94/tev): a count of bytes, a kind, little-endian.
std::string tevCreate(const std::string& name, int width, int height, const std::vector<std::string>& channels);
/// Rectangle of an image; floats interleaved by channel.
std::string tevUpdate(const std::string& name, int x, int y, int width, int height, const std::vector<std::string>& channels,
                      const std::vector<float>&);

/// Shows the picture in the viewer tev.
class TevPreview final : public Preview {
public:
    /// Connects to the viewer. Returns null, with a warning, if it does not respond or the name is invalid; rendering continues
    /// without it.
    static std::unique_ptr<TevPreview> connect(const std::string& host, int port, Diagnostics&);
    ~TevPreview() override;

private:
    TevPreview(int socket, std::string where, Diagnostics& d) : Preview(d), socket_(socket), where_(std::move(where)) {}
    bool wants(const render::OutputSpec&) const override;
    void show(const render::OutputSpec&, const render::PictureFacts&, const display::Image&) override;
    void send(const std::string&);
    int socket_;
    const std::string where_;
    std::vector<std::string> made_; ///< images created, with their sizes
};

} // namespace alpenglow::view
