// docs/tutorial.md as someone follows it: files are written as the page has them, commands run one after the other, and what a
// block is said to make is there. Only the pictures are a quarter as wide: no block says anything that depends on it.
#include "command_folder.h"
#include <cstring>
#include <regex>
#include <sstream>

namespace tutorial_test {

namespace {

class Tutorial : public alpenglow::cli::testing::CommandFolder {
protected:
    static std::string page() {
        std::ifstream in(ALPENGLOW_SOURCE_DIR "/docs/tutorial.md", std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// The exit status of a block of shell commands; the first that fails ends it.
    int shell(const std::string& commands) const {
        write("block.sh",
              "set -e\nexport PATH='" + std::filesystem::path(ALPENGLOW_PROGRAM).parent_path().string() + "':$PATH\n" + commands);
        const int s = std::system(("cd '" + dir.string() + "' && bash block.sh > out 2>&1").c_str());
        return WIFEXITED(s) ? WEXITSTATUS(s) : 128;
    }
    std::string text(const std::string& name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

} // namespace

TEST_F(Tutorial, EveryBlockWorks) {
    const std::string all = page();
    int files = 0, commands = 0, made = 0;
    const std::regex name("`([^`]+)`");
    std::istringstream lines(all);
    std::string kind, file, block;
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("```")) {
            if (inside) block += line + "\n";
            else if (line.starts_with("Makes `"))
                for (std::sregex_iterator i(line.begin(), line.end(), name), end; i != end; ++i, ++made)
                    EXPECT_GT(text((*i)[1]).size(), 100u) << (*i)[1];
            continue;
        }
        if (!inside) {
            std::istringstream head(line.substr(3));
            kind = file = block = "";
            head >> kind >> file;
        } else if (kind == "sh") {
            EXPECT_EQ(shell(block), 0) << block << text("out");
            ++commands;
        } else {
            for (const auto& [is, smaller] :
                 {std::pair{"Format 320 240 1", "Format 80 60 1"}, {"Format 160 120 1", "Format 40 30 1"}})
                if (const size_t at = block.find(is); at != std::string::npos) block.replace(at, std::strlen(is), smaller);
            ASSERT_TRUE((kind == "rib" || kind == "sl") && !file.empty()) << "a block of the tutorial that nobody runs: " << line;
            write(file, block);
            ++files;
        }
        inside = !inside;
    }
    EXPECT_FALSE(inside);
    EXPECT_GE(files, 5);
    EXPECT_GE(commands, 9);
    EXPECT_GE(made, 16);
    EXPECT_NE(text("turn.rib").find("FrameBegin 6"), std::string::npos);
}

// Every picture that the page shows is there.
TEST_F(Tutorial, PicturesExist) {
    const std::string all = page();
    const std::regex picture("\\]\\((tutorial/[^)]+)\\)");
    int found = 0;
    for (std::sregex_iterator i(all.begin(), all.end(), picture), end; i != end; ++i, ++found)
        EXPECT_TRUE(std::filesystem::exists(std::string(ALPENGLOW_SOURCE_DIR "/docs/") + std::string((*i)[1]))) << (*i)[1];
    EXPECT_GE(found, 6);
}

// The README's lines for Slurm, run by a loop in place of the scheduler; one task is killed by its requeueing, so it runs twice.
TEST_F(Tutorial, SlurmLinesOfTheReadme) {
    std::ifstream in(ALPENGLOW_SOURCE_DIR "/README.md", std::ios::binary);
    const std::string readme{std::istreambuf_iterator<char>(in), {}};
    const size_t from = readme.find("    #!/bin/bash\n    #SBATCH"), to = readme.find("\n\nand then `", from);
    ASSERT_NE(to, std::string::npos);
    const size_t merge = to + std::string("\n\nand then `").size();
    const std::string job = readme.substr(from, to - from), whole = readme.substr(merge, readme.find('`', merge) - merge);
    write("job.sh", job);
    write("scene.rib", "Format 8 6 1\nLightSource \"distantlight\" 1 \"to\" [0 0 1]\nWorldBegin\nTranslate 0 0 5\nSurface "
                       "\"matte\"\nSphere 1 -1 1 360\nWorldEnd\n");
    ASSERT_EQ(shell("for i in $(seq 16) 7; do SLURM_ARRAY_TASK_ID=$i bash -e job.sh; done\n" + whole), 0) << text("out");
    ASSERT_EQ(shell("alpenglow render --hider path --spp 256 -o one.exr scene.rib"), 0) << text("out");
    EXPECT_TRUE(text("whole.exr") == text("one.exr")) << "the very bits of one render";
    EXPECT_NE(shell("rm parts/3.exr.part; " + whole), 0) << "a part is missing";
}

} // namespace tutorial_test
