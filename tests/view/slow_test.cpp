// A scene of which a single pass takes long: a change of its file and Ctrl-C do not wait for the pass. Times are of a processor,
// so that a busy machine does not matter.
#include "../cli/command_folder.h"
#include "client.h"
#include <csignal>
#include <fcntl.h>

namespace slow_test {

using namespace alpenglow::view::testing;

namespace {

class SlowView : public alpenglow::cli::testing::CommandFolder {
protected:
    pid_t pid = -1;
    int port = 0;
    std::string token;

    void TearDown() override {
        if (pid > 0) {
            kill(pid, SIGKILL);
            waitpid(pid, nullptr, 0);
        }
        CommandFolder::TearDown();
    }
    void begin() {
        int out[2];
        ASSERT_EQ(pipe2(out, O_CLOEXEC), 0);
        pid = fork();
        if (pid == 0) {
            dup2(out[1], 1);
            if (chdir(dir.c_str()) != 0) _exit(99);
            execl(ALPENGLOW_PROGRAM, ALPENGLOW_PROGRAM, "view", "-q", "--watch", "--threads", "1", "s.rib",
                  static_cast<char*>(nullptr));
            _exit(99);
        }
        close(out[1]);
        std::string line;
        for (char c; read(out[0], &c, 1) == 1 && c != '\n';) line += c;
        close(out[0]);
        char digits[64] = "";
        ASSERT_EQ(std::sscanf(line.c_str(), "http://127.0.0.1:%d/%63[0-9a-f]/", &port, digits), 2) << line;
        token = digits;
    }
    nlohmann::json state() const {
        Socket s(port);
        s.send(get(port, "/" + token + "/picture?have=0"));
        const std::string body = bodyOf(s.answer());
        uint32_t n = 0;
        if (body.size() > 4) std::memcpy(&n, body.data(), 4);
        return n + 4 <= body.size() ? nlohmann::json::parse(body.substr(4, n), nullptr, false) : nlohmann::json();
    }
    /// Seconds of a processor that the program has had.
    double spent() const {
        std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
        std::string word;
        double ticks = 0;
        for (int k = 1; k <= 15 && in >> word; ++k)
            if (k >= 14) ticks += std::atof(word.c_str());
        return ticks / double(sysconf(_SC_CLK_TCK));
    }
    void scene(int balls, const std::string& more) {
        std::string s =
            "Format 400 300 1\nProjection \"perspective\"\nTranslate 0 0 2\nWorldBegin\nSurface \"constant\"\n" + more;
        for (int i = 0; i < balls; ++i) s += "Sphere 1 -1 1 360\n";
        write("new.rib", s + "WorldEnd\n");
        std::filesystem::rename(dir / "new.rib", dir / "s.rib");
    }
};

TEST_F(SlowView, FollowsItsFileAndEnds) {
    constexpr int kBalls = 20'000; // each ray meets all of them
    scene(kBalls, "");
    begin();
    const auto rendering = [&](const nlohmann::json& j) {
        const std::string phase = j.value("phase", "");
        return phase == "coarse" || phase == "whole";
    };
    nlohmann::json j;
    for (int i = 0; i < 2000 && !rendering(j = state()); ++i) usleep(20'000);
    ASSERT_TRUE(rendering(j)) << j;
    const auto serial = j["scene"];
    usleep(500'000); // in the middle of a pass
    const double before = spent();
    scene(kBalls, "Color 1 0 0\n");
    for (int i = 0; i < 3000 && (j = state())["scene"] == serial; ++i) usleep(10'000);
    EXPECT_NE(j["scene"], serial);
    EXPECT_LT(spent() - before, 1.5);
    for (int i = 0; i < 2000 && !rendering(j = state()); ++i) usleep(20'000);
    usleep(500'000);
    const double last = spent();
    kill(pid, SIGINT);
    double now = last;
    int how = 0;
    while (waitpid(pid, &how, WNOHANG) == 0) {
        now = std::max(now, spent());
        usleep(5'000);
    }
    pid = -1;
    EXPECT_TRUE(WIFEXITED(how) && WEXITSTATUS(how) == 0);
    EXPECT_LT(now - last, 1.0);
}

} // namespace

} // namespace slow_test
