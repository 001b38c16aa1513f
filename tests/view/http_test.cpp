// The server of the page against what strangers send. No browser: raw sockets.
#include "../nightly.h"
#include "../sanitized.h"
#include "client.h"
#include "view/httpserver.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <list>
#include <random>
#include <sys/resource.h>
#include <thread>

namespace http_test {

using namespace alpenglow::view;
using namespace alpenglow::view::testing;

namespace {

class Http : public ::testing::Test {
protected:
    std::unique_ptr<HttpServer> server;
    std::atomic<bool> ready{false};
    std::atomic<int> asked{0};
    void begin(HttpLimits limits = {}) {
        std::string fault;
        server = HttpServer::listen(0, &fault, limits);
        ASSERT_TRUE(server) << fault;
        server->start([this](const HttpRequest& r, bool last, bool* known) -> std::optional<HttpResponse> {
            ++asked;
            *known = r.path == "/known" || r.path == "/wait" || r.path == "/huge";
            if (r.path == "/huge") return HttpResponse{200, "text/plain", std::string(size_t(64) << 20, '.')};
            if (r.path == "/large") throw std::bad_alloc();
            if (r.path == "/wait" && !ready && !last) return {};
            std::string text = r.method + " " + r.path + " [" + r.body + "]";
            for (const auto& [name, value] : r.arguments) text += " " + name + "=" + value;
            return HttpResponse{r.path == "/none" ? 404 : 200, "text/plain", text};
        });
    }
    std::string ask(const std::string& request) {
        Socket s(server->port());
        s.send(request);
        return s.answer();
    }
    size_t residentKiB() const {
        std::ifstream in("/proc/self/status");
        for (std::string line; std::getline(in, line);)
            if (line.starts_with("VmRSS:")) return std::strtoul(line.c_str() + 6, nullptr, 10);
        return 0;
    }
};

TEST_F(Http, AnswersWhatItIsAsked) {
    begin();
    EXPECT_EQ(bodyOf(ask(get(server->port(), "/a/b?x=1&y=%2Fc+d&z"))), "GET /a/b [] x=1 y=/c d z=");
    EXPECT_EQ(bodyOf(ask(post(server->port(), "/p", "hello"))), "POST /p [hello]");
    EXPECT_EQ(statusOf(ask(get(server->port(), "/none"))), 404);
}

TEST_F(Http, ViewersThatTakeNothingAreDropped) {
    HttpLimits l;
    l.connections = 1;
    l.stallSeconds = .5;
    begin(l);
    Socket sleeper(server->port());
    sleeper.send(get(server->port(), "/huge"));
    for (int i = 0; i < 1000 && asked == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_EQ(statusOf(ask(get(server->port(), "/known"))), 503); // all places are taken
    int status = 0;
    for (int i = 0; i < 200 && status != 200; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        status = statusOf(ask(get(server->port(), "/known")));
    }
    EXPECT_EQ(status, 200);
}

TEST_F(Http, RefusesTwoHostsOrOrigins) {
    begin();
    const std::string host = "Host: 127.0.0.1:" + std::to_string(server->port()) + "\r\n";
    for (const std::string& more :
         {host, std::string("Host: evil\r\n"), std::string("Origin: http://a\r\nOrigin: http://b\r\n")}) {
        EXPECT_EQ(statusOf(ask(get(server->port(), "/known", more))), 400) << more;
        EXPECT_EQ(asked, 0);
    }
    EXPECT_EQ(statusOf(ask(get(server->port(), "/known", "Origin: http://a\r\n"))), 200);
}

TEST_F(Http, AnswersThatDoNotFitAreSaid) {
    begin();
    EXPECT_EQ(statusOf(ask(get(server->port(), "/large"))), 503);
    EXPECT_EQ(statusOf(ask(get(server->port(), "/a"))), 200);
}

TEST_F(Http, OneConnectionServesManyRequestsAlsoThoseSentAtOnce) {
    begin();
    Socket s(server->port());
    std::string many;
    for (int i = 0; i < 200; ++i) many += get(server->port(), "/" + std::to_string(i));
    s.send(many);
    for (int i = 0; i < 200; ++i) ASSERT_EQ(bodyOf(s.answer()), "GET /" + std::to_string(i) + " []");
}

TEST_F(Http, PathsAreNotTakenApart) { // what is not known is not found: there are no files behind it
    begin();
    for (const char* path : {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/..%2f..%2fetc/passwd", "//etc/passwd"})
        EXPECT_EQ(bodyOf(ask(get(server->port(), path))), std::string("GET ") + path + " []");
}

TEST_F(Http, ListensOnThisMachineAlone) {
    begin();
    std::ifstream in("/proc/net/tcp");
    char wanted[32];
    std::snprintf(wanted, sizeof wanted, "0100007F:%04X 00000000:0000 0A", unsigned(server->port()));
    std::string all((std::istreambuf_iterator<char>(in)), {});
    EXPECT_NE(all.find(wanted), std::string::npos);
}

TEST_F(Http, APortInUseIsSaid) {
    begin();
    std::string fault;
    EXPECT_FALSE(HttpServer::listen(server->port(), &fault));
    EXPECT_EQ(fault, "port " + std::to_string(server->port()) + " of 127.0.0.1 is in use by another program");
}

TEST_F(Http, WhatIsNoRequestIsRefusedInWords) {
    begin();
    const int port = server->port();
    const std::pair<std::string, int> cases[] = {{"hello\r\n\r\n", 400},
                                                 {"GET  HTTP/1.1\r\n\r\n", 400},
                                                 {"GET http://elsewhere/ HTTP/1.1\r\n\r\n", 400},
                                                 {"GET / HTTP/2\r\n\r\n", 400},
                                                 {std::string("\0\xff\x01\r\n\r\n", 7), 400},
                                                 {"DELETE / HTTP/1.1\r\n\r\n", 405},
                                                 {"POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 411},
                                                 {"POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n", 400},
                                                 {"POST / HTTP/1.1\r\nContent-Length: 4\r\nContent-Length: 5\r\n\r\n", 400},
                                                 {"POST / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n", 413},
                                                 {"POST / HTTP/1.1\r\nContent-Length: 900000000\r\n\r\n", 413}};
    for (const auto& [text, status] : cases) {
        Socket s(port);
        s.send(text);
        const std::string answer = s.answer();
        EXPECT_EQ(statusOf(answer), status) << text;
        EXPECT_GT(bodyOf(answer).size(), 10u) << text;
        EXPECT_TRUE(s.closed(3)) << text;
    }
    EXPECT_EQ(asked, 0);
}

TEST_F(Http, RequestsMayComeByteByByte) {
    begin();
    Socket s(server->port());
    for (const std::string& text : {post(server->port(), "/p?a=b", "hello"), get(server->port(), "/q")})
        for (char c : text) ASSERT_TRUE(s.send(std::string(1, c)));
    EXPECT_EQ(bodyOf(s.answer()), "POST /p [hello] a=b");
    EXPECT_EQ(bodyOf(s.answer()), "GET /q []");
}

TEST_F(Http, DamagedRequestsAreAnsweredOrClosed) {
    HttpLimits l;
    l.requestSeconds = l.idleSeconds = 0.1; // for those that became longer than what is sent
    begin(l);
    std::mt19937 random(1);
    const std::string whole = post(server->port(), "/p?a=%20b", "hello") + get(server->port(), "/q", "Connection: close\r\n");
    for (int k = 0; k < 200; ++k) {
        std::string text = whole;
        for (unsigned n = 1 + random() % 6; n > 0 && !text.empty(); --n) {
            const size_t at = random() % text.size();
            switch (random() % 4) {
            case 0:
                text[at] = char(random());
                break;
            case 1:
                text.erase(at, 1 + random() % 8);
                break;
            case 2:
                text.insert(at, text.substr(random() % text.size(), random() % 20));
                break;
            default:
                text[at] = "0123456789 :/%?\r\n"[random() % 17];
            }
        }
        Socket s(server->port());
        const size_t cut = random() % (text.size() + 1);
        s.send(text.substr(0, cut));
        s.send(text.substr(cut));
        EXPECT_TRUE(s.closed(5)) << text;
    }
    EXPECT_EQ(bodyOf(ask(get(server->port(), "/still"))), "GET /still []");
}

TEST_F(Http, HeadersWithoutEndAreCutOff) {
    begin();
    const size_t before = residentKiB();
    std::vector<Socket> all;
    for (int k = 0; k < 20; ++k) {
        Socket& s = all.emplace_back(server->port());
        s.send("GET / HTTP/1.1\r\n");
        const std::string line = "X-Header: " + std::string(1000, 'a') + "\r\n";
        int lines = 0;
        while (lines < 100000 && s.send(line)) ++lines;
        EXPECT_LT(lines, 100000); // closed long before
    }
    EXPECT_LT(residentKiB(), before + 20000);
    EXPECT_EQ(bodyOf(ask(get(server->port(), "/still"))), "GET /still []");
    Socket s(server->port());
    s.send("GET / HTTP/1.1\r\nX: " + std::string(20000, 'a'));
    EXPECT_EQ(statusOf(s.answer()), 431);
}

TEST_F(Http, WhoSendsSlowlyOrNothingIsLetGo) {
    HttpLimits l;
    l.requestSeconds = 0.3;
    l.idleSeconds = 0.4;
    begin(l);
    Socket slow(server->port()), silent(server->port());
    slow.send("GET / HT");
    EXPECT_EQ(statusOf(slow.answer(5)), 408);
    EXPECT_TRUE(silent.closed(5));
}

// Ten thousand nightly. Whoever is turned away leaves less than 2 KiB behind.
TEST_F(Http, ACrowdOfConnectionsDoesNotKeepOthersOut) {
    const int all = alpenglow::nightly() ? 10000 : 2500;
    rlimit l{};
    getrlimit(RLIMIT_NOFILE, &l);
    begin();
    Socket viewer(server->port());
    viewer.send(get(server->port(), "/known"));
    ASSERT_EQ(statusOf(viewer.answer()), 200);
    const size_t before = residentKiB();
    std::list<Socket> crowd;
    int made = 0;
    for (int i = 0; i < all; ++i) {
        if (crowd.size() >= 400) crowd.pop_front(); // our own files are bounded, too
        Socket& s = crowd.emplace_back(server->port());
        made += s.open();
        if (i % 3 == 0) s.send("GET / HTTP/1.1\r\nX: ");
    }
    EXPECT_EQ(made, all);
    if (!alpenglow::kSanitized) EXPECT_LT(residentKiB(), before + size_t(all) * 2); // a sanitizer keeps what is freed
    viewer.send(get(server->port(), "/known"));                                     // who was known stays
    EXPECT_EQ(bodyOf(viewer.answer()), "GET /known []");
    EXPECT_EQ(bodyOf(ask(get(server->port(), "/new"))), "GET /new []");
    size_t fds = 0;
    for (const auto& e : std::filesystem::directory_iterator("/proc/self/fd")) fds += e.exists() || true;
    EXPECT_LT(fds, 400u + 64 + 50);
}

TEST_F(Http, TooManyWhoAreKnownAreRefusedInWords) {
    HttpLimits l;
    l.connections = 3;
    begin(l);
    std::vector<Socket> waiting;
    for (int i = 0; i < 3; ++i) {
        Socket& s = waiting.emplace_back(server->port());
        s.send(get(server->port(), "/wait"));
    }
    while (asked < 3) std::this_thread::yield();
    Socket late(server->port());
    EXPECT_EQ(statusOf(late.answer(5)), 503);
}

TEST_F(Http, AnswersThatArePutOffComeWhenTheyAreThere) {
    begin();
    Socket s(server->port());
    s.send(get(server->port(), "/wait"));
    while (asked < 1) std::this_thread::yield();
    server->wake(); // for somebody else
    while (asked < 2) std::this_thread::yield();
    ready = true;
    server->wake();
    EXPECT_EQ(bodyOf(s.answer()), "GET /wait []");
}

TEST_F(Http, AnswersThatArePutOffAreGivenInTheEnd) {
    HttpLimits l;
    l.waitSeconds = 0.2;
    begin(l);
    EXPECT_EQ(bodyOf(ask(get(server->port(), "/wait"))), "GET /wait []");
}

TEST_F(Http, ABrowserThatGoesAwayLeavesNothing) {
    HttpLimits l;
    l.connections = 2;
    begin(l);
    for (int i = 0; i < 50; ++i) {
        Socket s(server->port());
        s.send(get(server->port(), "/wait"));
        while (asked <= i) std::this_thread::yield();
    } // closed while it waits for its answer
    const int before = asked;
    ready = true;
    server->wake();
    EXPECT_EQ(bodyOf(ask(get(server->port(), "/known"))), "GET /known []");
    EXPECT_LE(asked, before + 2);
}

TEST(Token, IsLongAndNew) {
    const std::string a = randomToken(), b = randomToken();
    EXPECT_EQ(a.size(), 32u);
    EXPECT_EQ(a.find_first_not_of("0123456789abcdef"), a.npos);
    EXPECT_NE(a, b);
    EXPECT_TRUE(sameText(a, a));
    EXPECT_FALSE(sameText(a, b));
    EXPECT_FALSE(sameText(a, a.substr(1)));
    EXPECT_FALSE(sameText(a, ""));
    EXPECT_FALSE(sameText("", a));
    EXPECT_TRUE(sameText("", ""));
}

} // namespace

} // namespace http_test
