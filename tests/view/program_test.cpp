// alpenglow view as a user runs it, and as a stranger on this machine meets it. Raw sockets, no browser.
#include "../cli/command_folder.h"
#include "client.h"
#include <csignal>
#include <fcntl.h>
#include <sys/stat.h>

namespace program_test {

using namespace alpenglow::view::testing;

namespace {

class ViewProgram : public alpenglow::cli::testing::CommandFolder {
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
    /// Starts it and reads the address that it prints.
    void begin(const std::string& scene, const std::vector<std::string>& more = {}) {
        int out[2];
        ASSERT_EQ(pipe2(out, O_CLOEXEC), 0);
        pid = fork();
        if (pid == 0) {
            std::vector<std::string> words{ALPENGLOW_PROGRAM, "view", "-q", scene};
            words.insert(words.end(), more.begin(), more.end());
            std::vector<char*> arguments;
            for (std::string& w : words) arguments.push_back(w.data());
            arguments.push_back(nullptr);
            dup2(out[1], 1);
            if (chdir(dir.c_str()) != 0) _exit(99);
            execv(arguments[0], arguments.data());
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
    std::string ask(const std::string& request) const {
        Socket s(port);
        s.send(request);
        return s.answer();
    }
    std::string path(const std::string& name) const { return "/" + token + "/" + name; }
    static constexpr const char* kScene =
        "Display \"x.png\" \"png\" \"rgb\"\nFormat 8 8 1\nHider \"path\"\nPixelSamples 2 2\nTranslate 0 0 3\nWorldBegin\n"
        "Surface \"constant\"\nSphere 1 -1 1 360\nWorldEnd\n";
};

TEST_F(ViewProgram, ServesItsPageToWhoKnowsTheToken) {
    write("s.rib", kScene);
    begin("s.rib");
    ASSERT_EQ(token.size(), 32u);
    const std::string page = ask(get(port, path("")));
    EXPECT_EQ(statusOf(page), 200);
    EXPECT_NE(page.find("Content-Security-Policy: default-src 'none'"), page.npos);
    EXPECT_NE(bodyOf(page).find("<title>Alpenglow</title>"), page.npos);
    EXPECT_EQ(bodyOf(page).find("//"), page.npos) << "something from outside";
    for (const char* name : {"page.js", "page.css", "stage.js"}) EXPECT_EQ(statusOf(ask(get(port, path(name)))), 200) << name;
    const std::string wrong = std::string(token[0] == '0' ? "1" : "0") + token.substr(1);
    for (const std::string& p : {std::string("/"), std::string("/page.js"), "/" + wrong + "/", "/" + token,
                                 "/" + token.substr(1) + "/", std::string("//")}) {
        const std::string a = ask(get(port, p));
        EXPECT_EQ(statusOf(a), 403) << p;
        EXPECT_NE(bodyOf(a).find("token"), a.npos);
        EXPECT_EQ(a.find(token), a.npos); // nobody sees it
    }
}

TEST_F(ViewProgram, DoesNotWaitForAPipe) {
    ASSERT_EQ(mkfifo((dir / "pipe.rib").c_str(), 0600), 0);
    const std::string said =
        run("view -q pipe.rib", "2>&1 & p=$!; (sleep 20; kill -9 $p) >/dev/null 2>&1 & k=$!; wait $p; s=$?; kill $k; exit $s");
    EXPECT_EQ(status, 3) << said;
    EXPECT_NE(said.find("not a regular file"), said.npos) << said;
}

TEST_F(ViewProgram, OpensTheDesktopsBrowser) {
    write("s.rib", kScene);
    write("xdg-open", "#!/bin/sh\necho \"$1\" >opened.new && mv opened.new opened\n");
    std::filesystem::permissions(dir / "xdg-open", std::filesystem::perms::owner_all);
    const std::string path = std::getenv("PATH");
    setenv("PATH", (dir.string() + ":" + path).c_str(), 1);
    begin("s.rib", {"--open"});
    setenv("PATH", path.c_str(), 1);
    for (int i = 0; i < 1000 && !std::filesystem::exists(dir / "opened"); ++i) usleep(10000);
    std::ifstream in(dir / "opened");
    std::string opened;
    std::getline(in, opened);
    EXPECT_EQ(opened, "http://127.0.0.1:" + std::to_string(port) + "/" + token + "/");
}

TEST_F(ViewProgram, ServesNoFileThatIsNotThePages) {
    write("s.rib", kScene);
    begin("s.rib");
    for (const char* name : {"../../../../etc/passwd", "..%2f..%2f..%2fetc/passwd", "%2e%2e/s.rib", "s.rib", "./s.rib",
                             "/etc/passwd", "//etc/passwd", "index.html/../s.rib", "page.js%00.rib", "picture/..", "do"})
        EXPECT_EQ(statusOf(ask(get(port, path(name)))), 404) << name;
    EXPECT_EQ(statusOf(ask(post(port, path("page.js"), "{}"))), 404);
}

TEST_F(ViewProgram, PagesFromElsewhereAreRefused) {
    write("s.rib", kScene);
    begin("s.rib");
    // A name that somebody has made to point here, and a page that asks across.
    EXPECT_EQ(statusOf(ask("GET " + path("") + " HTTP/1.1\r\nHost: evil.example:" + std::to_string(port) + "\r\n\r\n")), 403);
    EXPECT_EQ(statusOf(ask("GET " + path("") + " HTTP/1.1\r\n\r\n")), 403);
    EXPECT_EQ(statusOf(ask(get(port, path(""), "Origin: http://evil.example\r\n"))), 403);
    EXPECT_EQ(statusOf(ask(get(port, path(""), "Origin: null\r\n"))), 403);
    EXPECT_EQ(statusOf(ask(get(port, path(""), "Origin: http://127.0.0.1:" + std::to_string(port) + "\r\n"))), 200);
}

TEST_F(ViewProgram, HandsOutPixelsAndTakesRequests) {
    write("s.rib", kScene);
    begin("s.rib");
    EXPECT_EQ(bodyOf(ask(post(port, path("do"), "{\"do\": \"set\", \"wishes\": {\"continuous\": false, \"spp\": 4}}"))),
              "{\"ok\":true}");
    nlohmann::json state;
    std::string body;
    for (int i = 0; i < 200; ++i) {
        body = bodyOf(ask(get(port, path("picture?have=0"))));
        ASSERT_GT(body.size(), 4u);
        uint32_t n;
        std::memcpy(&n, body.data(), 4);
        ASSERT_LE(n + 4, body.size());
        state = nlohmann::json::parse(body.substr(4, n));
        body.erase(0, 4 + n);
        if (state["done"] == true && state.contains("picture")) break;
        usleep(20000);
    }
    EXPECT_EQ(state["figures"]["spp"], 4);
    ASSERT_EQ(body.size(), 8u * 8 * 8); // four halves a pixel
    uint16_t pixel[4];
    std::memcpy(pixel, body.data() + (4 * 8 + 4) * 8, 8);
    for (uint16_t h : pixel) EXPECT_EQ(h, 0x3c00); // "constant" is 1
    const auto exact = nlohmann::json::parse(bodyOf(ask(get(port, path("pixel?x=4&y=4")))));
    EXPECT_EQ(exact["values"]["picture/r"], 1.0);
    EXPECT_NEAR(exact["values"]["picture/z"].get<double>(), 2, 0.1);
    EXPECT_NE(
        bodyOf(ask(post(port, path("do"), "{\"do\": \"set\", \"wishes\": {\"spp\": -1}}"))).find("\"spp\\\" cannot be that"),
        std::string::npos);
    EXPECT_EQ(statusOf(ask(post(port, path("do"), "{nonsense"))), 400);
    EXPECT_EQ(statusOf(ask(post(port, path("do"), std::string(60000, '[')))), 400); // as deep as it can be
    EXPECT_FALSE(std::filesystem::exists(dir / "x.png"));
    kill(pid, SIGINT);
    int how = 0;
    waitpid(pid, &how, 0);
    pid = -1;
    EXPECT_TRUE(WIFEXITED(how) && WEXITSTATUS(how) == 0);
}

TEST_F(ViewProgram, APortInUseIsSaid) {
    write("s.rib", kScene);
    begin("s.rib");
    const std::string out = run("view --port " + std::to_string(port) + " s.rib", "2>&1");
    EXPECT_EQ(status, 2);
    EXPECT_NE(out.find("port " + std::to_string(port) + " of 127.0.0.1 is in use by another program"), out.npos) << out;
    EXPECT_NE(out.find("without --port a free one is taken"), out.npos) << out;
}

TEST_F(ViewProgram, ASceneThatCannotBeReadIsSaid) {
    std::string out = run("view none.rib", "2>&1");
    EXPECT_EQ(status, 3);
    EXPECT_NE(out.find("none.rib"), out.npos) << out;
    write("empty.rib", "Format 8 8 1\n");
    out = run("view empty.rib", "2>&1");
    EXPECT_EQ(status, 3);
    EXPECT_NE(out.find("there is no picture in the scene"), out.npos) << out;
    run("view -", "2>/dev/null");
    EXPECT_EQ(status, 2);
}

} // namespace

} // namespace program_test
