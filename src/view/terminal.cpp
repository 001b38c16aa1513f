// Pictures in a terminal. Sources: VT340 Graphics Programming (sixels), sw.kovidgoyal.net/kitty/graphics-protocol.
#include "view/preview.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace alpenglow::view {
namespace {

std::string number(int n) { return std::to_string(n); }

std::string base64(const std::vector<uint8_t>& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const uint32_t b =
            bytes[i] << 16 | (i + 1 < bytes.size() ? bytes[i + 1] << 8 : 0) | (i + 2 < bytes.size() ? bytes[i + 2] : 0);
        for (int k = 0; k < 4; ++k) text += i + size_t(k) > bytes.size() ? '=' : kDigits[b >> (18 - 6 * k) & 63];
    }
    return text;
}

/// The number of a colour in a cube of six steps a side, with a threshold of a 4 x 4 matrix (Bayer 1973) added.
int cubeColour(const Bytes& b, int x, int y) {
    static constexpr int kBayer[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    const uint8_t* p = b.rgb.data() + (size_t(y) * size_t(b.width) + size_t(x)) * 3;
    int at = 0;
    for (int k = 0; k < 3; ++k) {
        const double v = p[k] / 51.0 + (kBayer[y & 3][x & 3] + 0.5) / 16 - 0.5;
        at = at * 6 + std::clamp(int(std::lround(v)), 0, 5);
    }
    return at;
}

/// Encodes one colour of a band of six rows with run lengths.
void appendBand(std::string& out, const std::string& row) {
    for (size_t i = 0; i < row.size();) {
        size_t n = 1;
        while (i + n < row.size() && row[i + n] == row[i]) ++n;
        if (n > 3) out += "!" + std::to_string(n) + row[i];
        else out.append(n, row[i]);
        i += n;
    }
}

} // namespace

std::string halfBlocks(const Bytes& b) {
    std::string out;
    for (int y = 0; y < b.height; y += 2) {
        std::string before;
        for (int x = 0; x < b.width; ++x) {
            const uint8_t* top = b.rgb.data() + (size_t(y) * size_t(b.width) + size_t(x)) * 3;
            const bool both = y + 1 < b.height;
            const uint8_t* low = both ? top + size_t(b.width) * 3 : top;
            std::string colour = "\x1b[38;2;" + number(top[0]) + ";" + number(top[1]) + ";" + number(top[2]);
            if (both) colour += ";48;2;" + number(low[0]) + ";" + number(low[1]) + ";" + number(low[2]);
            colour += "m";
            if (colour != before) out += colour;
            before = std::move(colour);
            out += "\xe2\x96\x80";
        }
        out += "\x1b[0m\x1b[K\n";
    }
    return out;
}

std::string sixels(const Bytes& b) {
    std::string out = "\x1bP0;1q\"1;1;" + number(b.width) + ";" + number(b.height);
    for (int c = 0; c < 216; ++c)
        out += "#" + number(c) + ";2;" + number(c / 36 * 20) + ";" + number(c / 6 % 6 * 20) + ";" + number(c % 6 * 20);
    std::array<std::string, 216> rows;
    for (int y = 0; y < b.height; y += 6) {
        for (std::string& r : rows) r.clear();
        for (int k = 0; k < 6 && y + k < b.height; ++k)
            for (int x = 0; x < b.width; ++x) {
                std::string& r = rows[size_t(cubeColour(b, x, y + k))];
                if (r.empty()) r.assign(size_t(b.width), '?');
                r[size_t(x)] = char(r[size_t(x)] + (1 << k));
            }
        bool first = true;
        for (int c = 0; c < 216; ++c) {
            if (rows[size_t(c)].empty()) continue;
            if (!first) out += '$';
            first = false;
            out += "#" + number(c);
            appendBand(out, rows[size_t(c)]);
        }
        out += '-';
    }
    return out + "\x1b\\";
}

std::string kittyGraphics(const Bytes& b) {
    constexpr size_t kPiece = 4096;
    const std::string data = base64(b.rgb);
    std::string out;
    for (size_t at = 0; at < data.size() || at == 0; at += kPiece) {
        out += "\x1b_G";
        if (at == 0) out += "a=T,f=24,s=" + number(b.width) + ",v=" + number(b.height) + ",i=1,p=1,q=2,C=1,";
        out += std::string("m=") + (at + kPiece < data.size() ? "1" : "0") + ";" + data.substr(at, kPiece) + "\x1b\\";
    }
    return out;
}

std::optional<TerminalKind> terminalKindByName(const std::string& n) {
    if (n == "blocks") return TerminalKind::Blocks;
    if (n == "sixel") return TerminalKind::Sixel;
    if (n == "kitty") return TerminalKind::Kitty;
    return {};
}

namespace {

/// The terminal's device attributes, or "" after a fifth of a second.
std::string deviceAttributes() {
    const int tty = ::open("/dev/tty", O_RDWR | O_CLOEXEC | O_NOCTTY);
    if (tty < 0) return "";
    termios before{};
    std::string answer;
    // Who works in the background would be stopped for it.
    if (tcgetpgrp(tty) == getpgrp() && tcgetattr(tty, &before) == 0) {
        termios raw = before;
        raw.c_lflag &= ~tcflag_t(ICANON | ECHO);
        tcsetattr(tty, TCSANOW, &raw);
        if (::write(tty, "\x1b[c", 3) == 3) {
            pollfd p{tty, POLLIN, 0};
            char c = 0;
            while (answer.size() < 100 && c != 'c' && ::poll(&p, 1, 200) == 1 && ::read(tty, &c, 1) == 1) answer += c;
        }
        tcsetattr(tty, TCSANOW, &before);
    }
    ::close(tty);
    return answer;
}

std::string variable(const char* name) {
    const char* v = std::getenv(name);
    return v ? v : "";
}

} // namespace

TerminalKind terminalKind() {
    if (!isatty(STDERR_FILENO)) return TerminalKind::Blocks;
    const std::string term = variable("TERM"), program = variable("TERM_PROGRAM");
    if (!variable("KITTY_WINDOW_ID").empty() || term.find("kitty") != term.npos || program == "ghostty" || program == "WezTerm")
        return TerminalKind::Kitty;
    // ESC [ ? 62 ; 4 ; 22 c: 4 is sixels.
    const std::string answer = deviceAttributes();
    return answer.find(";4;") != answer.npos || answer.find(";4c") != answer.npos ? TerminalKind::Sixel : TerminalKind::Blocks;
}

TerminalSize terminalSize() {
    TerminalSize s;
    winsize w{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &w) != 0 || w.ws_col == 0 || w.ws_row == 0) return s;
    s.columns = w.ws_col;
    s.rows = w.ws_row;
    if (w.ws_xpixel >= w.ws_col && w.ws_ypixel >= w.ws_row) {
        s.cellWidth = w.ws_xpixel / w.ws_col;
        s.cellHeight = w.ws_ypixel / w.ws_row;
    }
    return s;
}

bool TerminalPreview::wants(const render::OutputSpec& s) const { return s.has(render::OutputVariable::Source::Ci); }

void TerminalPreview::show(const render::OutputSpec&, const render::PictureFacts& f, const display::Image& image) {
    // As large as fits above two lines of text, of the picture's own shape.
    const double aspect = std::max(1e-3, double(image.width) * double(f.pixelAspect) / std::max(1, image.height));
    const bool blocks = kind_ == TerminalKind::Blocks;
    const double cellWidth = blocks ? 1 : size_.cellWidth, cellHeight = blocks ? 2 : size_.cellHeight;
    const double most = std::max(1.0, (size_.columns - 1) * cellWidth),
                 high = std::max(cellHeight, (size_.rows - 2) * cellHeight);
    const double width = std::min({most, high * aspect, double(image.width) * (blocks ? 1 : 2)});
    const Bytes b = shrunk(image, std::max(1, int(width)), std::max(1, int(width / aspect)));
    const int lines = std::max(1, int(std::ceil(b.height / cellHeight)));
    std::string out = "\r\x1b[K";
    if (shown_ > 0) out += "\x1b[" + number(shown_) + "A";
    if (blocks) out += halfBlocks(b);
    else { // makes room first, so that the screen does not scroll under the picture
        for (int i = 0; shown_ == 0 && i < lines; ++i) out += "\n";
        if (shown_ == 0) out += "\x1b[" + number(lines) + "A";
        out += "\x1b"
               "7" +
               (kind_ == TerminalKind::Kitty ? kittyGraphics(b) : sixels(b)) +
               "\x1b"
               "8\x1b[" +
               number(lines) + "B";
    }
    shown_ = lines;
    sink_(out);
}

} // namespace alpenglow::view
