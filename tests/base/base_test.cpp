#include "base/diagnostics.h"
#include "base/limits.h"
#include "base/matrix.h"
#include "base/printable.h"
#include <gtest/gtest.h>

namespace base_test {

using namespace alpenglow;

namespace {

TEST(Matrix, RotateAboutZFollowsTheSpecification) { // RISpec 3.2, 4.3: x' = x cos - y sin, y' = x sin + y cos
    Vec3d p = transformPoint(rotateMatrix(90, 0, 0, 1), {1, 0, 0});
    EXPECT_NEAR(p.x, 0, 1e-15);
    EXPECT_NEAR(p.y, 1, 1e-15);
    Vec3d q = transformPoint(rotateMatrix(90, 1, 0, 0), {0, 1, 0});
    EXPECT_NEAR(q.z, 1, 1e-15);
    Vec3d r = transformPoint(rotateMatrix(90, 0, 1, 0), {0, 0, 1});
    EXPECT_NEAR(r.x, 1, 1e-15);
}

TEST(Matrix, RowVectorsComposeLeftToRight) {
    Matrix m = scaleMatrix(2, 2, 2) * translateMatrix(1, 0, 0); // scale first
    EXPECT_EQ(transformPoint(m, {1, 1, 1}), Vec3d(3, 2, 2));
    EXPECT_EQ(transformVector(m, {1, 1, 1}), Vec3d(2, 2, 2));
}

TEST(Matrix, InverseAndDeterminant) {
    Matrix m = rotateMatrix(33, 1, 2, 3) * scaleMatrix(2, 3, 4) * translateMatrix(5, -6, 7);
    EXPECT_NEAR(determinant(m), 24, 1e-12);
    EXPECT_NEAR(determinant3(m), 24, 1e-12);
    Matrix i = m * inverse(m);
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(i.m[r][c], r == c, 1e-14);
    bool singular = false;
    inverse(scaleMatrix(1, 0, 1), &singular);
    EXPECT_TRUE(singular);
}

TEST(Matrix, NormalsStayPerpendicular) {
    Matrix m = scaleMatrix(1, 4, 1) * rotateMatrix(20, 0, 0, 1);
    Vec3d t(1, 1, 0), n(1, -1, 0);
    EXPECT_NEAR(dot(transformVector(m, t), transformNormal(m, n)), 0, 1e-14);
}

TEST(Matrix, SkewTurnsTheFirstAxisTowardTheSecond) { // docs/design/ri.md: d1 ends at angle `deg` less from d2
    Matrix m = skewMatrix(30, {0, 1, 0}, {1, 0, 0});
    Vec3d p = transformPoint(m, {0, 1, 0});
    EXPECT_NEAR(p.y, 1, 1e-15);
    EXPECT_NEAR(p.x, std::tan(30 * kPi / 180), 1e-14);
}

TEST(Matrix, PerspectiveFormula) { // x' = x/(z t), z' = (z-1)/z
    Vec3d p = transformPoint(perspectiveMatrix(90), {2, 4, 8});
    EXPECT_NEAR(p.x, 0.25, 1e-14);
    EXPECT_NEAR(p.y, 0.5, 1e-14);
    EXPECT_NEAR(p.z, 7.0 / 8, 1e-14);
}

TEST(Diagnostics, TextHasPlaceCaretAndHint) {
    Diagnostic d{Severity::Error, Rie::Syntax, {"a.sl", 3, 5}, "no such thing", "did you mean \"that\"?", "\tfoo bar"};
    EXPECT_EQ(toString(d), "a.sl:3:5: error: no such thing\n  \tfoo bar\n  \t   ^\n  hint: did you mean \"that\"?\n");
}

// Names from files may hold what a terminal obeys: it is shown by its bytes, and the caret stands where it belongs.
TEST(Diagnostics, ControlCharactersAreShownByTheirBytes) {
    EXPECT_EQ(printable("a\tb\nc"), "a\tb\nc");
    EXPECT_EQ(printable("\x1b[31mred\x07\x7f\r"), "\\x1b[31mred\\x07\\x7f\\x0d");
    EXPECT_EQ(printable("\xC2\x9B"
                        "31m \x9B"
                        "31m"),
              "\\xc2\\x9b31m \\x9b31m"); // the one-byte CSI, as UTF-8 and by itself
    EXPECT_EQ(printable("gr\xC3\xBC\xC3\x9F \xE2\x82\xAC \xF0\x9F\x8C\x84 caf\xE9"),
              "gr\xC3\xBC\xC3\x9F \xE2\x82\xAC \xF0\x9F\x8C\x84 caf\xE9");
    EXPECT_EQ(printable(std::string("\0x", 2)), "\\x00x");
    Diagnostic d;
    d.place = {"a\x1b]0;x\x07.sl", 1, 4};
    d.message = "no \x1b[2J";
    d.sourceLine = "\x1b\x01 foo\r";
    d.length = 3;
    d.hint = "did you mean '\b'?";
    d.notes = {"candidate \x1b"};
    EXPECT_EQ(toString(d), "a\\x1b]0;x\\x07.sl:1:4: error: no \\x1b[2J\n  \\x1b\\x01 foo\n           ^~~\n"
                           "  note: candidate \\x1b\n  hint: did you mean '\\x08'?\n");
    d.place.column = 2;
    d.length = 1;
    EXPECT_NE(toString(d).find("\n  \\x1b\\x01 foo\n      ^~~~\n"), std::string::npos) << toString(d);
}

// A letter of several bytes takes one place, and of a long line only what stands around the column is shown.
TEST(Diagnostics, ExcerptsOfTextAndLongLines) {
    Diagnostic d;
    d.place = {"a.sl", 1, 9};
    d.message = "no";
    d.sourceLine = "\xC3\xA9\xE2\x82\xAC \tKq;"; // two letters of two and three bytes
    d.length = 2;
    d.place.column = 8;
    EXPECT_EQ(toString(d), "a.sl:1:8: error: no\n  \xC3\xA9\xE2\x82\xAC \tKq;\n     \t^~\n");
    const std::string before(10'000, 'a'), behind(10'000, 'b');
    d.sourceLine = before + "here" + behind;
    d.place.column = int(before.size()) + 1;
    d.length = 4;
    const std::string text = toString(d);
    const size_t first = text.find('\n') + 1, second = text.find('\n', first) + 1;
    const std::string line = text.substr(first, second - first), caret = text.substr(second);
    EXPECT_LE(line.size(), size_t(limits::kExcerptColumns) + 16);
    EXPECT_EQ(line.substr(0, 6), "  ... ");
    EXPECT_EQ(line.substr(line.size() - 5), " ...\n");
    EXPECT_EQ(caret.find('^'), line.find("here"));
    EXPECT_EQ(caret.substr(caret.find('^')), "^~~~\n");
    d.place.column = 30'000; // beyond the line
    EXPECT_NE(toString(d).find('^'), std::string::npos);
}

TEST(Diagnostics, CountsAndReportsOnce) {
    int seen = 0;
    Diagnostics ds([&](const Diagnostic&) { ++seen; });
    ds.reportOnce("k", {Severity::Warning, Rie::NoError, {}, "w", {}, {}});
    ds.reportOnce("k", {Severity::Warning, Rie::NoError, {}, "w", {}, {}});
    ds.report(Severity::Error, Rie::Range, {}, "e");
    EXPECT_EQ(seen, 2);
    EXPECT_EQ(ds.warnings(), 1);
    EXPECT_EQ(ds.errors(), 1);
}

TEST(Diagnostics, NearestName) {
    EXPECT_EQ(nearestName("smothstep", {"step", "smoothstep", "spline"}), "smoothstep");
    EXPECT_EQ(nearestName("Spere", {"Sphere", "Torus"}), "Sphere");
    EXPECT_EQ(nearestName("xyzzy", {"Sphere", "Torus"}), "");
}

} // namespace

} // namespace base_test
