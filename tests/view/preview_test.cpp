// Pictures in the terminal, decoded again by what the protocols say, and pictures that a viewer gets over its socket.
#include "../cli/command_folder.h"
#include "client.h"
#include "display/imageio.h"
#include "view/preview.h"
#include <cmath>
#include <csignal>
#include <gtest/gtest.h>
#include <map>
#include <pty.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace preview_test {

using namespace alpenglow;
using namespace alpenglow::view;

namespace {

Bytes gradient(int w, int h) {
    Bytes b{w, h, {}};
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (int v : {x * 255 / std::max(1, w - 1), y * 255 / std::max(1, h - 1), 128}) b.rgb.push_back(uint8_t(v));
    return b;
}

TEST(Terminal, HalfBlocksHaveTwoPixelsEach) {
    const Bytes b{2, 3, {1, 2, 3, 1, 2, 3, 4, 5, 6, 4, 5, 6, 7, 8, 9, 10, 11, 12}};
    EXPECT_EQ(halfBlocks(b), "\x1b[38;2;1;2;3;48;2;4;5;6m\xe2\x96\x80\xe2\x96\x80\x1b[0m\x1b[K\n"
                             "\x1b[38;2;7;8;9m\xe2\x96\x80\x1b[38;2;10;11;12m\xe2\x96\x80\x1b[0m\x1b[K\n");
}

/// Draws sixels as the VT340 does.
Bytes drawn(const std::string& s) {
    Bytes b;
    const size_t size = s.find("\"1;1;");
    if (std::sscanf(s.c_str() + size + 5, "%d;%d", &b.width, &b.height) != 2) return b;
    b.rgb.assign(size_t(b.width) * size_t(b.height) * 3, 0);
    std::map<int, std::array<int, 3>> palette;
    int x = 0, y = 0, colour = 0;
    for (size_t i = s.find('#'); i < s.size() && s[i] != '\x1b'; ++i) {
        int repeat = 1, used = 0;
        if (s[i] == '#') {
            int c, space, r, g, bl;
            if (std::sscanf(s.c_str() + i, "#%d;%d;%d;%d;%d%n", &c, &space, &r, &g, &bl, &used) == 5) palette[c] = {r, g, bl};
            else if (std::sscanf(s.c_str() + i, "#%d%n", &c, &used) == 1) colour = c;
            i += size_t(used) - 1;
            continue;
        }
        if (s[i] == '$') x = 0;
        else if (s[i] == '-') x = 0, y += 6;
        else {
            if (s[i] == '!') {
                std::sscanf(s.c_str() + i, "!%d%n", &repeat, &used);
                i += size_t(used);
            }
            EXPECT_TRUE(s[i] >= '?' && s[i] <= '~');
            for (; repeat > 0; --repeat, ++x)
                for (int k = 0; k < 6; ++k)
                    if ((s[i] - '?') >> k & 1) {
                        EXPECT_LT(x, b.width);
                        EXPECT_LT(y + k, b.height);
                        for (int c = 0; c < 3; ++c)
                            b.rgb[(size_t(y + k) * size_t(b.width) + size_t(x)) * 3 + size_t(c)] =
                                uint8_t(std::lround(palette[colour][size_t(c)] * 2.55));
                    }
        }
    }
    return b;
}

TEST(Terminal, SixelsShowThePicture) {
    for (auto [w, h] : {std::pair{32, 24}, {7, 5}, {1, 1}, {64, 6}, {5, 13}}) {
        const Bytes b = gradient(w, h);
        const std::string s = sixels(b);
        EXPECT_TRUE(s.starts_with("\x1bP") && s.ends_with("\x1b\\"));
        const Bytes d = drawn(s);
        ASSERT_EQ(d.rgb.size(), b.rgb.size());
        for (size_t i = 0; i < b.rgb.size(); ++i)
            ASSERT_LE(std::abs(int(d.rgb[i]) - int(b.rgb[i])), 51) << i; // a step of the cube
        for (size_t c = 0; c < 3 && w * h > 100; ++c) {                  // and right on average, which is what the dither is for
            double sum = 0;
            for (size_t i = c; i < b.rgb.size(); i += 3) sum += double(d.rgb[i]) - b.rgb[i];
            EXPECT_NEAR(sum / (w * h), 0, 4);
        }
    }
}

TEST(Terminal, KittyGetsEveryByte) {
    for (auto [w, h] : {std::pair{1, 1}, {2, 1}, {5, 1}, {64, 48}}) {
        const Bytes b = gradient(w, h);
        std::string s = kittyGraphics(b), data;
        EXPECT_NE(s.find("s=" + std::to_string(w) + ",v=" + std::to_string(h)), s.npos);
        for (size_t at = 0; at < s.size();) {
            ASSERT_EQ(s.compare(at, 3, "\x1b_G"), 0);
            const size_t body = s.find(';', at), end = s.find("\x1b\\", at);
            ASSERT_LE(end - body - 1, 4096u);
            EXPECT_EQ(s.substr(at, body - at).ends_with(end + 2 == s.size() ? "m=0" : "m=1"), true);
            data += s.substr(body + 1, end - body - 1);
            at = end + 2;
        }
        std::vector<uint8_t> bytes;
        uint32_t bits = 0;
        int have = 0;
        for (char c : data) {
            if (c == '=') break;
            const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
            bits = bits << 6 | uint32_t(std::strchr(digits, c) - digits);
            if ((have += 6) >= 8) bytes.push_back(uint8_t(bits >> (have -= 8)));
        }
        EXPECT_EQ(bytes, b.rgb);
        EXPECT_EQ(data.size() % 4, 0u);
    }
}

// A program in the background that sets its terminal up is stopped: it does without.
TEST(Terminal, IsNotAskedFromTheBackground) {
    int terminal = -1;
    const pid_t shell = forkpty(&terminal, nullptr, nullptr, nullptr);
    ASSERT_GE(shell, 0);
    if (shell == 0) {
        setenv("TERM", "xterm", 1);
        unsetenv("KITTY_WINDOW_ID");
        unsetenv("TERM_PROGRAM");
        const pid_t job = fork();
        if (job == 0) {
            setpgid(0, 0);
            _exit(terminalKind() == TerminalKind::Blocks ? 0 : 3);
        }
        setpgid(job, job);
        int status = 0;
        waitpid(job, &status, WUNTRACED);
        if (WIFSTOPPED(status)) kill(job, SIGKILL);
        _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 7);
    }
    int status = 0;
    waitpid(shell, &status, 0);
    ::close(terminal);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(Terminal, PicturesShrinkInLight) {
    display::Image image = display::makeImage(4, 2, {"r", "g", "b", "a"});
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x) {
            image.pixel(x, y)[0] = x < 2 ? float(x) : 0.25f; // 0 1 beside each other: a half
            image.pixel(x, y)[1] = NAN;
            image.pixel(x, y)[2] = 7;
        }
    const Bytes b = shrunk(image, 2, 1);
    ASSERT_EQ(b.rgb.size(), 6u);
    EXPECT_EQ(b.rgb[0], 188); // 255 (1.055 * .5^(1/2.4) - .055)
    EXPECT_EQ(b.rgb[3], 137); // of .25
    EXPECT_EQ(b.rgb[1], 0);
    EXPECT_EQ(b.rgb[2], 255);
}

/// What tev has of an image.
struct Seen {
    int width = 0, height = 0;
    std::vector<std::string> channels;
    std::map<std::string, std::vector<float>> planes;
};

/// Reads packets as tev's own reader does.
void takePackets(std::string& in, std::map<std::string, Seen>& images, int* packets) {
    while (in.size() >= 4) {
        uint32_t length;
        std::memcpy(&length, in.data(), 4);
        ASSERT_GE(length, 6u);
        if (in.size() < length) return;
        size_t at = 4;
        const auto byte = [&] { return in.at(at++); };
        const auto text = [&] {
            std::string s(in.c_str() + at);
            at += s.size() + 1;
            return s;
        };
        const auto whole = [&] {
            int32_t v;
            std::memcpy(&v, in.data() + at, 4);
            at += 4;
            return v;
        };
        const char kind = byte();
        byte();
        Seen& s = images[text()];
        if (kind == 4) {
            s.width = whole();
            s.height = whole();
            for (int n = whole(); n > 0; --n) {
                s.channels.push_back(text());
                s.planes[s.channels.back()].assign(size_t(s.width) * size_t(s.height), NAN);
            }
        } else {
            ASSERT_EQ(kind, 6);
            std::vector<std::string> names(size_t(whole()), "");
            for (std::string& n : names) n = text();
            const int x = whole(), y = whole(), w = whole(), h = whole();
            std::vector<int64_t> offsets(names.size()), strides(names.size());
            std::memcpy(offsets.data(), in.data() + at, names.size() * 8);
            at += names.size() * 8;
            std::memcpy(strides.data(), in.data() + at, names.size() * 8);
            at += names.size() * 8;
            for (size_t c = 0; c < names.size(); ++c)
                for (int j = 0; j < h; ++j)
                    for (int i = 0; i < w; ++i) {
                        float v;
                        std::memcpy(&v, in.data() + at + size_t(offsets[c] + strides[c] * (j * w + i)) * 4, 4);
                        s.planes.at(names[c]).at(size_t(y + j) * size_t(s.width) + size_t(x + i)) = v;
                    }
            ASSERT_EQ(at + size_t(w) * size_t(h) * names.size() * 4, length);
        }
        ++*packets;
        in.erase(0, length);
    }
}

using PreviewProgram = alpenglow::cli::testing::CommandFolder;
const char* const kScene =
    "Display \"x.exr\" \"openexr\" \"rgba\"\nFormat 20 16 1\nHider \"path\"\nPixelSamples 3 3\nPixelFilter \"box\" 1 "
    "1\nTranslate 0 0 3\nWorldBegin\n"
    "LightSource \"pointlight\" 1 \"from\" [1 1 -3] \"intensity\" 9\nSurface \"matte\"\nSphere 1 -1 1 360\nWorldEnd\n";

TEST_F(PreviewProgram, TevGetsTheWholePicture) {
    write("s.rib", kScene);
    const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in a{};
    a.sin_family = AF_INET;
    a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof a;
    ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&a), size), 0);
    ASSERT_EQ(::listen(listener, 1), 0);
    getsockname(listener, reinterpret_cast<sockaddr*>(&a), &size);
    std::map<std::string, Seen> images;
    int packets = 0;
    std::thread tev([&] {
        const int s = ::accept(listener, nullptr, nullptr);
        std::string in;
        char piece[65536];
        for (ssize_t n; (n = ::recv(s, piece, sizeof piece, 0)) > 0;) {
            in.append(piece, size_t(n));
            takePackets(in, images, &packets);
        }
        ::close(s);
    });
    const std::string out = run(
        "render -q --display openexr:n.exr:N --display tev:127.0.0.1:" + std::to_string(ntohs(a.sin_port)) + " s.rib", "2>&1");
    tev.join();
    ::close(listener);
    EXPECT_EQ(status, 0) << out;
    EXPECT_GE(packets, 4); // two images, made and filled
    Diagnostics diags;
    const auto written = display::readImage((dir / "x.exr").string(), diags);
    ASSERT_TRUE(written);
    const Seen& s = images["x.exr"];
    EXPECT_EQ(s.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    ASSERT_EQ(s.planes.at("R").size(), 20u * 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 20; ++x) {
            const size_t i = size_t(y) * 20 + size_t(x);
            ASSERT_EQ(s.planes.at("R")[i], written->pixel(x, y)[written->channel("r")]);
            ASSERT_EQ(s.planes.at("B")[i], written->pixel(x, y)[written->channel("b")]);
            ASSERT_EQ(s.planes.at("A")[i], written->pixel(x, y)[written->channel("a")]);
        }
    EXPECT_EQ(images.at("n.exr").channels.size(), 3u);
}

TEST_F(PreviewProgram, NobodyWhoListensIsSaidAndThePictureIsMade) {
    write("s.rib", kScene);
    const std::string out = run("render --progress none --display tev:127.0.0.1:1 s.rib", "2>&1");
    EXPECT_EQ(status, 0);
    EXPECT_NE(out.find("tev:127.0.0.1:1: no viewer listens there; rendering continues without it"), out.npos) << out;
    EXPECT_TRUE(std::filesystem::exists(dir / "x.exr"));
    for (const char* wrong : {"tev:localhost", "tev:localhost:0", "tev:localhost:99999", "tev:localhost:x"}) {
        const std::string said = run(std::string("render --display ") + wrong + " s.rib", "2>&1");
        EXPECT_EQ(status, 2) << wrong;
        EXPECT_NE(said.find("tev:HOST:PORT"), said.npos) << said;
    }
}

TEST_F(PreviewProgram, TheTerminalShowsThePictureAndItIsTheSame) {
    write("s.rib", kScene);
    run("render -q -o plain.exr s.rib", "2>/dev/null");
    ASSERT_EQ(status, 0);
    for (const auto& [kind, sign] : {std::pair{"blocks", "\xe2\x96\x80"}, {"sixel", "\x1bP0;1q"}, {"kitty", "\x1b_Ga=T"}}) {
        const std::string out = run(std::string("render -q --preview=") + kind + " -o seen.exr s.rib", "2>&1");
        EXPECT_EQ(status, 0) << out;
        EXPECT_NE(out.find(sign), out.npos) << kind;
        EXPECT_EQ(run("diff --tolerance 0 plain.exr seen.exr", "2>&1 >/dev/null"), "");
        EXPECT_EQ(status, 0); // to the last bit
    }
    const std::string out = run("render --preview --progress none s.rib", "2>&1");
    EXPECT_EQ(status, 0);
    EXPECT_NE(out.find("standard error is no terminal"), out.npos) << out;
    run("render --preview=television s.rib", "2>&1");
    EXPECT_EQ(status, 2);
}

} // namespace

} // namespace preview_test
