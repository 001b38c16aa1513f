// Scenes that come through pipes: the program waits for their writer, and ends when it is asked to.
#include "command_folder.h"
#include <sys/stat.h>
#include <unistd.h>

namespace waitinginput_test {

namespace {

class WaitingInput : public alpenglow::cli::testing::CommandFolder {
protected:
    /// Runs it in the background, does `then`, and gives how it ended; one that hangs is killed (status 137).
    std::string ended(const std::string& arguments, const std::string& then) {
        write("job.sh", "'" ALPENGLOW_PROGRAM "' " + arguments + " 2>&1 & p=$!\n(sleep 8; kill -9 $p) >/dev/null 2>&1 & k=$!\n" +
                            then + "\nwait $p; echo ended with $?; kill $k\n");
        return run("--version >/dev/null;", "sh job.sh 2>&1");
    }
};

const std::string kScene = "Format 8 8 1\nDisplay \"w.exr\" \"openexr\" \"rgba\"\nProjection \"perspective\"\n"
                           "WorldBegin\nTranslate 0 0 3\nSphere 1 -1 1 360\nWorldEnd\n";

TEST_F(WaitingInput, OneSignalEndsIt) {
    ASSERT_EQ(mkfifo((dir / "pipe.rib").c_str(), 0600), 0);
    const std::string kill = "sleep 1; kill -TERM $p";
    const std::string file = ended("render -q pipe.rib", kill);
    EXPECT_NE(file.find("ended with 130"), std::string::npos) << file;
    const std::string waits = ended("render -q - 0<>pipe.rib", kill);
    EXPECT_NE(waits.find("ended with 130"), std::string::npos) << waits;
}

TEST_F(WaitingInput, AWriterThatComesLaterIsRead) {
    write("scene.txt", kScene);
    ASSERT_EQ(mkfifo((dir / "pipe.rib").c_str(), 0600), 0);
    const std::string text = ended("render -q pipe.rib", "sleep .5; cat scene.txt > pipe.rib");
    EXPECT_NE(text.find("ended with 0"), std::string::npos) << text;
    EXPECT_EQ(access((dir / "w.exr").c_str(), R_OK), 0);
}

} // namespace

} // namespace waitinginput_test
