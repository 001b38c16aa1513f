// Binary requests that are read straight into calls (ri/direct.h) compared with the general way, which a source of single bytes
// forces: the same calls, places and messages, whatever the bytes are.
#include "calls.h"
#include "ri/writer.h"
#include <random>

namespace direct_test {

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

/// Gives a byte at a time, so that never a whole request is in the buffer.
class Drops : public ByteSource {
public:
    explicit Drops(std::string_view t) : text_(t) {}
    size_t read(char* out, size_t size) override {
        if (text_.empty() || size == 0) return 0;
        *out = text_.front();
        text_.remove_prefix(1);
        return 1;
    }

private:
    std::string_view text_;
};

/// All that the reader says and gives of a stream.
std::string readingOf(std::unique_ptr<ByteSource> source) {
    Diagnostics d;
    Reporter reporter(d);
    std::string all;
    const auto put = [&](const Value& v) {
        all += v.array ? "[" : "";
        for (const double n : v.numbers) all += std::to_string(n) + " ";
        for (const std::string& s : v.strings) all += "\"" + s + "\" ";
        all += (v.array ? "]" : "") + std::to_string(int(v.kind)) + "@" + std::to_string(v.line) + ":" +
               std::to_string(v.column) + " ";
    };
    Parser parser(std::move(source), "d.rib", reporter,
                  [&](const std::string&, const std::string& text) { all += "#" + text + "\n"; });
    for (Call c; parser.next(c);) {
        all += std::string(c.request->name) + "@" + std::to_string(c.place.line) + ":" + std::to_string(c.place.column) + " ";
        for (const Argument& a : c.arguments) {
            all += a.given ? "given " : "none ";
            for (const double n : a.numbers) all += std::to_string(n) + " ";
            for (const std::string& s : a.strings) all += "\"" + s + "\" ";
        }
        for (const RawParam& p : c.params) {
            all += p.token + "@" + std::to_string(p.line) + ":" + std::to_string(p.column) + " ";
            put(p.value);
        }
        all += "\n";
    }
    for (const Diagnostic& m : d.all())
        all += m.place.file + ":" + std::to_string(m.place.line) + ":" + std::to_string(m.place.column) + " " + m.message + "\n";
    return all;
}

void expectSameReading(const std::string& bytes, const std::string& what) {
    ASSERT_EQ(readingOf(memorySource(bytes)), readingOf(std::make_unique<Drops>(bytes))) << what;
}

std::string binaryOf(const std::string& text) {
    std::string out;
    RibWriter w(stringSink(out), {.binary = true});
    for (const Call& c : callsOf(text)) w.write(c);
    EXPECT_TRUE(w.finish());
    return out;
}

/// Every request of the table, each several times, so that tokens have codes.
std::string everyRequest() {
    std::string text;
    for (int turn = 0; turn < 4; ++turn)
        for (const Request& r : requestTable())
            text += std::string(r.name) + " " + std::string(r.sample) + "\n" +
                    "Polygon \"P\" [0 0 0 1 0 0 1 1 0] \"uniform string name\" [\"a\"] \"st\" [0 0 1 0 1 1] \"Kd\" .5\n";
    return text;
}

} // namespace

TEST(Direct, EveryRequestIsReadAsInTheGeneralWay) { expectSameReading(binaryOf(everyRequest()), "samples"); }

TEST(Direct, ArraysOfAllLengthsAndPlacesInTheBuffer) {
    std::string text;
    for (int n = 0; n < 400; ++n) {
        text += "Polygon \"P\" [";
        for (int i = 0; i < 3 * n; ++i) text += std::to_string(i) + ".5 ";
        text += "] \"float w\" " + std::to_string(n) + " \"uniform string s\" [\"x\" \"y\"]\n";
    }
    expectSameReading(binaryOf(text), "lengths"); // some of them cross the end of the buffer
}

TEST(Direct, DamagedBytesAreReadAsInTheGeneralWay) {
    const std::string whole = binaryOf(everyRequest());
    std::mt19937 random(7);
    for (int round = 0; round < 300; ++round) {
        std::string bytes = whole.substr(random() % (whole.size() / 2), 3000);
        for (int k = 0; k < 20; ++k) {
            const size_t at = random() % bytes.size();
            switch (random() % 4) {
            case 0:
                bytes[at] = char(random());
                break;
            case 1:
                bytes.erase(at, 1 + random() % 5);
                break;
            case 2:
                bytes.insert(at, 1, " \n\r\t#\"[]\xa6\xcf\xc8\xa4"[random() % 12]);
                break;
            default:
                bytes.insert(at, whole.substr(random() % (whole.size() - 20), 1 + random() % 20));
            }
        }
        expectSameReading(bytes, "round " + std::to_string(round));
    }
}

// What a call held before never shows in the next one.
TEST(Direct, CallsAreReused) {
    const std::string bytes =
        binaryOf("Polygon \"P\" [0 0 0 1 0 0 1 1 0] \"Cs\" [1 0 0 1 0 0 1 0 0] \"uniform string n\" [\"a\"]\n"
                 "Polygon \"P\" [0 0 0 1 0 0 1 1 0]\nTranslate 1 2 3\nWorldBegin\nColor [1 0 0]\n"
                 "Polygon \"uniform string n\" [\"b\"] \"P\" [1 0 0 1 0 0 1 1 0]\n");
    expectSameReading(bytes + bytes + bytes, "reuse");
}

} // namespace direct_test
