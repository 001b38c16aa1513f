// render --watch: it renders again when any file that the scene uses becomes another.
#include "command_folder.h"

namespace watch_test {

using Watch = alpenglow::cli::testing::CommandFolder;

TEST_F(Watch, FollowsEveryFileOfTheScene) {
    write("tint.h", "#define TINT color(1, .5, .25)\n");
    write("mine.sl", "#include \"tint.h\"\nsurface mine() { Ci = TINT * color texture(\"map.tif\", .5, .5); Oi = 1; }\n");
    write("part.rib", "Sphere 1 -1 1 360\n");
    write("s.rib", "Format 8 8 1\nTranslate 0 0 3\nWorldBegin\nSurface \"mine\"\nReadArchive \"part.rib\"\n"
                   "Surface \"later\"\nSphere .1 -.1 .1 360\nWorldEnd\n");
    write("flat.rib",
          "Format 4 4 1\nDisplay \"map.tif\" \"tiff\" \"rgb\"\nImager \"background\" \"color background\" [.5 .5 .5]\n"
          "WorldBegin\nWorldEnd\n");
    run("render -q flat.rib", "2>flat.txt");
    // After each change the program must come to its waiting line once more.
    write("drive.sh",
          "turns() { grep -c 'waiting for a file' log.txt; }\n"
          "reach() { i=0; while [ \"$(turns)\" -lt $1 ] && [ $i -lt 600 ]; do sleep .05; i=$((i + 1)); done; turns; }\n"
          ": > log.txt; \"$1\" render --watch -q -o w.png s.rib 2>log.txt &\npid=$!\nreach 1\n"
          "sleep .02; echo '#define TINT color(.1, .2, .3)' > tint.h; reach 2\n"
          "sleep .02; echo 'Sphere .5 -.5 .5 360' > part.rib; reach 3\n"
          "sleep .02; cp map.tif new.tif; mv new.tif map.tif; reach 4\n"
          "sleep .02; echo 'surface later() { Ci = 1; }' > later.sl; reach 5\n"
          "sleep .6; turns\n" // nothing else changed
          "kill -INT $pid; wait $pid\n");
    std::string out;
    const std::string command = "cd '" + dir.string() + "' && sh drive.sh '" ALPENGLOW_PROGRAM "'";
    FILE* p = popen(command.c_str(), "r");
    ASSERT_NE(p, nullptr);
    char buffer[256];
    while (fgets(buffer, sizeof buffer, p)) out += buffer;
    pclose(p);
    EXPECT_EQ(out, "1\n2\n3\n4\n5\n5\n");
}

} // namespace watch_test
