// base/file.h: path policy, atomic publication, faults, search paths.
#include "support.h"

namespace file_test {

using namespace alpenglow;
using namespace alpenglow::display::test;
namespace fs = std::filesystem;

TEST(OutputPath, StaysBelowTheRoot) {
    Scratch s;
    Diagnostics d;
    OutputPolicy p = s.policy();
    EXPECT_EQ(resolveOutputPath("a.tif", p, d), s / "a.tif");
    EXPECT_EQ(resolveOutputPath("sub/a.tif", p, d), s / "sub/a.tif");
    EXPECT_EQ(resolveOutputPath(s / "abs.tif", p, d), s / "abs.tif"); // exporters write absolute names
    EXPECT_EQ(resolveOutputPath(s / "new/abs.tif", p, d), s / "new/abs.tif");
    fs::create_directories(s / "sub");
    EXPECT_EQ(resolveOutputPath("sub/../b.tif", p, d), fs::canonical(s.dir).string() + "/b.tif");
    EXPECT_TRUE(d.all().empty());
    int errors = 0;
    const std::string parent = s.dir.parent_path().string();
    for (const std::string& outside : {std::string("/etc/passwd"), std::string("../../x.exr"), std::string("a/../../y.exr"),
                                       std::string("C:\\pictures\\z.tif"), std::string("\\\\host\\share\\w.tif"),
                                       std::string("..\\v.tif"), s.dir.string() + "x/a.tif", s / "../u.tif", parent + "/t.tif"}) {
        EXPECT_FALSE(resolveOutputPath(outside, p, d)) << outside;
        EXPECT_EQ(d.errors(), ++errors) << outside;
        EXPECT_NE(d.all().back().message.find("outside"), std::string::npos) << d.all().back().message;
        EXPECT_NE(d.all().back().hint.find("--allow-write"), std::string::npos) << outside;
    }
}

TEST(OutputPath, AHiddenFolderThatHoldsTheRootIsNoObstacle) {
    Scratch s;
    fs::create_directories(s / ".cache/job");
    Diagnostics d;
    const OutputPolicy p{s / ".cache/job", false, -1};
    EXPECT_EQ(resolveOutputPath(s / ".cache/job/a.tif", p, d), s / ".cache/job/a.tif");
    EXPECT_FALSE(resolveOutputPath(s / ".cache/job/.a.tif", p, d));
    EXPECT_EQ(d.errors(), 1);
}

TEST(OutputPath, NamesOfOneFile) {
    Scratch s;
    fs::create_directories(s / "sub");
    fs::create_directory_symlink(s / "sub", s / "link");
    for (const char* same : {"sub/a.exr", "./sub/a.exr", "sub/../sub/a.exr", "link/a.exr", "sub//a.exr"})
        EXPECT_EQ(fileIdentity(s / same), fileIdentity(s / "sub/a.exr")) << same;
    EXPECT_NE(fileIdentity(s / "sub/b.exr"), fileIdentity(s / "sub/a.exr"));
    EXPECT_NE(fileIdentity(s / "a.exr"), fileIdentity(s / "sub/a.exr"));
    EXPECT_EQ(fileIdentity("not-there/a.exr"), fileIdentity(fs::current_path().string() + "/not-there/a.exr"));
}

TEST(OutputPath, WhetherAFileCanBeWritten) {
    Scratch s;
    Diagnostics d;
    EXPECT_TRUE(OutputFile::canBeWritten("a.tif", s.policy(), d));
    EXPECT_EQ(s.files(), 0u);
    OutputPolicy full = s.policy();
    full.failAfterBytes = 100;
    EXPECT_FALSE(OutputFile::canBeWritten("a.tif", full, d));
    ASSERT_EQ(d.errors(), 1);
    EXPECT_EQ(d.all()[0].code, Rie::DiskFull);
    EXPECT_EQ(s.files(), 0u);
}

TEST(OutputPath, RefusesWhatHasNoName) {
    Scratch s;
    Diagnostics d;
    EXPECT_FALSE(resolveOutputPath("", s.policy(), d));
    EXPECT_FALSE(resolveOutputPath("/", s.policy(), d));
    EXPECT_FALSE(resolveOutputPath("a/..", s.policy(), d));
    EXPECT_FALSE(resolveOutputPath(std::string("a\0b", 3), s.policy(), d));
    EXPECT_EQ(d.errors(), 4);
}

TEST(OutputPath, HiddenNamesAndWhatIsNoPicture) {
    Scratch s;
    putBytes(s / "notes.txt", {'m', 'i', 'n', 'e'});
    putBytes(s / "old.tif", {'I', 'I', '*', 0, 8, 0, 0, 0});
    putBytes(s / "empty", {});
    Diagnostics d;
    for (const char* name : {".bashrc", "a/.ssh/keys", ".git/config", "notes.txt"})
        EXPECT_FALSE(resolveOutputPath(name, s.policy(), d)) << name;
    EXPECT_EQ(d.errors(), 4);
    for (const char* name : {"old.tif", "empty", "new.tif", "./a.tif", "a.b/c.tif"})
        EXPECT_TRUE(resolveOutputPath(name, s.policy(), d)) << name;
    EXPECT_EQ(d.errors(), 4);
}

TEST(OutputPath, AllowWriteTakesThePathAsItIs) {
    Scratch s;
    Diagnostics d;
    OutputPolicy p = s.policy();
    p.allowWrite = true;
    EXPECT_EQ(resolveOutputPath("/tmp/q.tif", p, d), "/tmp/q.tif");
    EXPECT_EQ(resolveOutputPath("../q.tif", p, d), s / "../q.tif");
    EXPECT_TRUE(d.all().empty());
}

TEST(OutputPath, SymbolicLinksDoNotLeadOut) {
    Scratch s;
    fs::create_directories(s / "root");
    fs::create_directories(s / "outside");
    fs::create_directory_symlink(s / "outside", s / "root/link");
    Diagnostics d;
    OutputPolicy p{s / "root", false, -1};
    EXPECT_FALSE(resolveOutputPath("link/a.tif", p, d));
    EXPECT_FALSE(resolveOutputPath(s / "root/link/a.tif", p, d));
    EXPECT_EQ(d.errors(), 2);
}

TEST(OutputFileTest, AppearsWholeOrNotAtAll) {
    Scratch s;
    Diagnostics d;
    OutputPolicy any = s.policy();
    any.allowWrite = true; // the old file is no picture
    putBytes(s / "a.bin", {'o', 'l', 'd'});
    {
        auto f = OutputFile::open("a.bin", any, d);
        ASSERT_TRUE(f);
        EXPECT_TRUE(f->write("new!", 4));
        EXPECT_EQ(bytesOf(s / "a.bin"), (std::vector<uint8_t>{'o', 'l', 'd'}));
    } // never committed
    EXPECT_EQ(bytesOf(s / "a.bin"), (std::vector<uint8_t>{'o', 'l', 'd'}));
    EXPECT_EQ(s.files(), 1u);
    auto f = OutputFile::open("a.bin", any, d);
    ASSERT_TRUE(f);
    EXPECT_TRUE(f->write("new!", 4));
    EXPECT_TRUE(f->seek(0));
    EXPECT_TRUE(f->write("N", 1));
    EXPECT_TRUE(f->commit(d));
    EXPECT_EQ(bytesOf(s / "a.bin"), (std::vector<uint8_t>{'N', 'e', 'w', '!'}));
    EXPECT_EQ(s.files(), 1u);
    EXPECT_TRUE(d.all().empty());
}

TEST(OutputFileTest, FullDiskKeepsTheOldFile) {
    Scratch s;
    Diagnostics d;
    putBytes(s / "a.bin", {'o', 'l', 'd'});
    OutputPolicy p = s.policy();
    p.allowWrite = true; // the old file is no picture
    p.failAfterBytes = 5;
    auto f = OutputFile::open("a.bin", p, d);
    ASSERT_TRUE(f);
    EXPECT_TRUE(f->write("12345", 5));
    EXPECT_FALSE(f->write("6", 1));
    EXPECT_FALSE(f->commit(d));
    EXPECT_EQ(d.errors(), 1);
    EXPECT_EQ(d.all()[0].code, Rie::DiskFull);
    EXPECT_EQ(bytesOf(s / "a.bin"), (std::vector<uint8_t>{'o', 'l', 'd'}));
    EXPECT_EQ(s.files(), 1u);
}

TEST(OutputFileTest, MakesDirectoriesAndRefusesWhatIsNoFile) {
    Scratch s;
    Diagnostics d;
    auto f = OutputFile::open("maps/deep/a.bin", s.policy(), d);
    ASSERT_TRUE(f);
    EXPECT_TRUE(f->commit(d));
    EXPECT_TRUE(fs::exists(s / "maps/deep/a.bin"));
    EXPECT_FALSE(OutputFile::open("maps", s.policy(), d)); // a directory
    OutputPolicy all;
    all.allowWrite = true;
    EXPECT_FALSE(OutputFile::open("/dev/null", all, d));
    EXPECT_EQ(d.errors(), 2);
    EXPECT_TRUE(fs::exists("/dev/null"));
}

TEST(ReadWholeFile, LimitsAndKinds) {
    Scratch s;
    Diagnostics d;
    putBytes(s / "a", {1, 2, 3});
    EXPECT_EQ(readWholeFile(s / "a", 3, d), (std::vector<uint8_t>{1, 2, 3}));
    EXPECT_FALSE(readWholeFile(s / "a", 2, d));
    EXPECT_EQ(d.all()[0].code, Rie::Limit);
    EXPECT_FALSE(readWholeFile(s / "b", 2, d));
    EXPECT_EQ(d.all()[1].code, Rie::NoFile);
    EXPECT_FALSE(readWholeFile("/dev/zero", 100, d));
    EXPECT_FALSE(readWholeFile(s.dir.string(), 100, d));
    EXPECT_EQ(d.errors(), 4);
}

TEST(SearchPath, Splits) {
    using V = std::vector<std::string>;
    EXPECT_EQ(splitSearchPath("a:b;c"), (V{"a", "b", "c"}));
    EXPECT_EQ(splitSearchPath("@:x:&", {"d1", "d2"}, {"p"}), (V{"d1", "d2", "x", "p"}));
    EXPECT_EQ(splitSearchPath("C:\\a;b"), (V{"C:\\a", "b"}));
    EXPECT_EQ(splitSearchPath("$HOME:~"), (V{"$HOME", "~"})); // nothing is expanded
}

TEST(SearchPath, FindsByCaseSlashAndBaseName) {
    Scratch s;
    fs::create_directories(s / "tex");
    putBytes(s / "tex/Wood.tif", {1});
    std::vector<std::string> dirs{s.dir.string(), s / "tex"};
    auto f = findFile("Wood.tif", dirs);
    ASSERT_TRUE(f);
    EXPECT_FALSE(f->otherCase || f->baseNameOnly);
    f = findFile("wood.TIF", dirs);
    ASSERT_TRUE(f);
    EXPECT_EQ(f->path, s / "tex/Wood.tif");
    EXPECT_TRUE(f->otherCase);
    EXPECT_TRUE(findFile("tex\\Wood.tif", dirs));
    f = findFile("/home/someone/maps/Wood.tif", dirs);
    ASSERT_TRUE(f);
    EXPECT_TRUE(f->baseNameOnly);
    EXPECT_TRUE(findFile("D:\\maps\\Wood.tif", dirs));
    EXPECT_FALSE(findFile("Stone.tif", dirs));
    EXPECT_FALSE(findFile("", dirs));
}

} // namespace file_test
