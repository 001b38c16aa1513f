// ASCII floats through the RIB reader against fast_float over the same bytes: rib_bench [MEGABYTES]. CPU time, one thread, the
// two take turns, the best of all turns counts. The reader tokenises, checks, binds and builds the scene; fast_float only
// converts. Then the same scenes in binary, and one of small primitives, through the reader and as requests alone. Exit 1 when
// the reader is slower than the limit, or binary is not so many times as fast.
#include "ri/reader.h"
#include "ri/receiver.h"
#include "ri/writer.h"
#include "scene/scene.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fast_float/fast_float.h>
#include <random>

using namespace alpenglow;

namespace {

constexpr double kLimit = 0.5, kBinary = 4;

double cpuSeconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// PointsPolygons of a 64 x 64 grid each with P, N and st, as exporters write them.
std::string rib(size_t bytes, const char* format) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-10, 10);
    std::string text = "WorldBegin\n";
    constexpr int kSide = 64;
    char buffer[64];
    const auto floats = [&](const char* name, int count) {
        text += std::string(" \"") + name + "\" [";
        for (int i = 0; i < count; i++) {
            text += i % 12 ? " " : "\n";
            text.append(buffer, size_t(std::snprintf(buffer, sizeof buffer, format, double(number(random)))));
        }
        text += "]";
    };
    while (text.size() < bytes) {
        text += "PointsPolygons [";
        for (int i = 0; i < (kSide - 1) * (kSide - 1); i++) text += "4 ";
        text += "] [";
        for (int y = 0; y + 1 < kSide; y++)
            for (int x = 0; x + 1 < kSide; x++) {
                const int a = y * kSide + x;
                text.append(buffer,
                            size_t(std::snprintf(buffer, sizeof buffer, "%d %d %d %d ", a, a + 1, a + kSide + 1, a + kSide)));
            }
        text += "]";
        floats("P", 3 * kSide * kSide);
        floats("N", 3 * kSide * kSide);
        floats("st", 2 * kSide * kSide);
        text += "\n";
    }
    return text + "WorldEnd\n";
}

/// Quadrilaterals with P and st, every eighth in an attribute block with a place and a colour: 13.8 numbers a request.
std::string smallPrimitives(size_t bytes) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-10, 10);
    std::string text = "WorldBegin\n";
    char buffer[64];
    const auto floats = [&](int count) {
        for (int i = 0; i < count; i++)
            text.append(buffer, size_t(std::snprintf(buffer, sizeof buffer, " %.6g", double(number(random)))));
    };
    for (int i = 0; text.size() < bytes; i++) {
        const bool block = i % 8 == 0;
        if (block) text += "AttributeBegin\nTranslate", floats(3), text += "\nColor [1 .5 .25]\n";
        text += "Polygon \"P\" [", floats(12), text += "] \"st\" [", floats(8), text += "]\n";
        if (block) text += "AttributeEnd\n";
    }
    return text + "WorldEnd\n";
}

struct Null : scene::FrameConsumer {
    size_t primitives = 0;
    void render(std::shared_ptr<const scene::Frame> f) override { primitives += f->primitives.size(); }
    void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&, const SourcePlace&) override {}
};

/// Every number of the text, blanks and everything else passed over.
double convertAll(const std::string& text, size_t& count) {
    double sum = 0;
    const char *p = text.data(), *end = p + text.size();
    count = 0;
    while (p < end) {
        double v;
        const auto r = fast_float::from_chars(p, end, v);
        if (r.ec == std::errc()) {
            sum += v;
            ++count;
            p = r.ptr;
        } else {
            ++p;
        }
        while (p < end && (*p == ' ' || *p == '\n')) ++p;
    }
    return sum;
}

/// Seconds of reading; 0: it was not read.
double readingTime(const std::string& bytes, size_t& primitives) {
    Null sink;
    Diagnostics diagnostics([](const Diagnostic& d) { std::fputs(toString(d).c_str(), stderr); });
    const double t = cpuSeconds();
    ri::RibReader r({}, sink, diagnostics);
    const bool read = r.readMemory(bytes, "memory");
    primitives = sink.primitives;
    return read && primitives > 0 ? cpuSeconds() - t : 0;
}

/// Seconds of reading requests alone.
double parsingTime(const std::string& bytes) {
    struct Counting : ri::RequestReceiver {
        void request(const ri::Call& c) override { parameters += c.params.size(); }
        void unknown(const std::string&, const std::vector<ri::Value>&) override {}
        void comment(const std::string&, const std::string&) override {}
        size_t parameters = 0;
    } counting;
    Diagnostics diagnostics;
    const double t = cpuSeconds();
    ri::passOnText(bytes, "memory", counting, diagnostics);
    return counting.parameters > 0 ? cpuSeconds() - t : 0;
}

std::string binary(const std::string& text) {
    struct To : ri::RequestReceiver {
        explicit To(ri::RibWriter& w) : writer(w) {}
        void request(const ri::Call& c) override { writer.write(c); }
        void unknown(const std::string&, const std::vector<ri::Value>&) override {}
        void comment(const std::string&, const std::string&) override {}
        ri::RibWriter& writer;
    };
    std::string out;
    ri::RibWriter writer(ri::stringSink(out), {.binary = true});
    To to(writer);
    Diagnostics diagnostics;
    ri::passOnText(text, "memory", to, diagnostics);
    writer.finish();
    return out;
}

} // namespace

int main(int argc, char** argv) {
    const size_t megabytes = argc > 1 ? size_t(std::max(1, std::atoi(argv[1]))) : 20;
    bool good = true;
    for (const char* format : {"%.6g", "%.9g", "%.3f"}) {
        const std::string text = rib(megabytes << 20, format), packed = binary(text);
        double reader = 1e9, plain = 1e9, compact = 1e9, sum = 0;
        size_t count = 0, primitives = 0;
        for (int turn = 0; turn < 7; turn++) {
            double t = cpuSeconds();
            sum += convertAll(text, count);
            plain = std::min(plain, cpuSeconds() - t);
            const double ascii = readingTime(text, primitives), bytes = readingTime(packed, primitives);
            if (ascii == 0 || bytes == 0) {
                std::fprintf(stderr, "rib_bench: the text was not read\n");
                return 1;
            }
            reader = std::min(reader, ascii);
            compact = std::min(compact, bytes);
        }
        const double mb = double(text.size()) / 1e6, ratio = plain / reader;
        good = good && ratio >= kLimit;
        std::printf("%-5s %5.1f MB, %zu numbers, %zu primitives: fast_float %4.0f MB/s, reader %4.0f MB/s, reader / fast_float "
                    "%.2f >= %g %s%s\n",
                    format, mb, count, primitives, mb / plain, mb / reader, ratio, kLimit, ratio >= kLimit ? "PASS" : "MISS",
                    sum == 0.5 ? " " : "");
        const double times = reader / compact;
        good = good && times >= kBinary;
        std::printf("      the same in binary: %.1f MB, %.0f MB/s, %.1f times as fast >= %g %s\n", double(packed.size()) / 1e6,
                    double(packed.size()) / 1e6 / compact, times, kBinary, times >= kBinary ? "PASS" : "MISS");
    }
    const std::string text = smallPrimitives(megabytes << 20), packed = binary(text);
    double best[2][2] = {{1e9, 1e9}, {1e9, 1e9}}; // scene or requests alone; text or binary
    for (int turn = 0; turn < 7; turn++)
        for (const bool b : {false, true}) {
            size_t primitives = 0;
            best[0][b] = std::min(best[0][b], readingTime(b ? packed : text, primitives));
            best[1][b] = std::min(best[1][b], parsingTime(b ? packed : text));
        }
    for (const bool alone : {false, true}) {
        const double times = best[alone][0] / best[alone][1];
        const double most = alone ? kBinary : 0; // a scene of primitives costs the same for both, and more than the bytes
        good = good && times >= most;
        std::printf("small primitives, %s: %.3f s, in binary %.3f s: %.2f times as fast >= %g %s\n",
                    alone ? "requests" : "with their scene", best[alone][0], best[alone][1], times, most,
                    times >= most ? "PASS" : "MISS");
    }
    return good ? 0 : 1;
}
