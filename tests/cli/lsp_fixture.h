// The language server through its pipes, as an editor drives it.
#pragma once
#include "base/limits.h"
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

namespace fs = std::filesystem;
using Json = nlohmann::json;

inline std::string framed(const std::string& body) {
    return "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

inline Json span(int line, int begin, int end) {
    return {{"start", {{"line", line}, {"character", begin}}}, {"end", {{"line", line}, {"character", end}}}};
}

/// The text with '|' taken out, and where it was: line and character from 0.
struct Marked {
    std::string text;
    int line = 0, character = 0;
    explicit Marked(std::string t) {
        const size_t at = t.find('|');
        t.erase(at, 1);
        for (size_t i = 0; i < at; ++i) {
            ++character;
            if (t[i] == '\n') ++line, character = 0;
        }
        text = t;
    }
};

class Server : public testing::Test {
protected:
    fs::path dir;
    std::string input, arguments;
    int ids = 0;

    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "alpenglow-lsp-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        dir = name;
    }
    void TearDown() override { fs::remove_all(dir); }

    void write(const std::string& name, const std::string& text) const { std::ofstream(dir / name, std::ios::binary) << text; }
    std::string uri(const std::string& name) const { return "file://" + (dir / name).string(); }
    void raw(const std::string& bytes) { input += bytes; }
    int request(const std::string& method, Json params) {
        input += framed(Json{{"jsonrpc", "2.0"}, {"id", ++ids}, {"method", method}, {"params", std::move(params)}}.dump());
        return ids;
    }
    void notify(const std::string& method, Json params) {
        input += framed(Json{{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}}.dump());
    }
    void begin() {
        request("initialize", {{"capabilities", Json::object()}, {"rootUri", nullptr}});
        notify("initialized", Json::object());
    }
    void open(const std::string& name, const std::string& text) {
        notify("textDocument/didOpen",
               {{"textDocument", {{"uri", uri(name)}, {"languageId", "rsl"}, {"version", 1}, {"text", text}}}});
    }
    int ask(const std::string& method, const std::string& name, int line, int character) {
        return request("textDocument/" + method,
                       {{"textDocument", {{"uri", uri(name)}}}, {"position", {{"line", line}, {"character", character}}}});
    }
    void end() {
        request("shutdown", nullptr);
        notify("exit", nullptr);
    }

    int status = -1;
    std::vector<Json> run() {
        std::ofstream(dir / "in", std::ios::binary) << input;
        const std::string command = "cd '" + dir.string() + "' && '" + ALPENGLOW_PROGRAM "' lsp " + arguments + " < in 2>err";
        std::string out;
        FILE* p = popen(command.c_str(), "r");
        if (!p) return {};
        std::array<char, 4096> buffer;
        while (size_t n = fread(buffer.data(), 1, buffer.size(), p)) out.append(buffer.data(), n);
        const int s = pclose(p);
        status = WIFEXITED(s) ? WEXITSTATUS(s) : 128 + WTERMSIG(s);
        std::vector<Json> list;
        for (size_t at = 0; at < out.size();) {
            EXPECT_EQ(out.compare(at, 16, "Content-Length: "), 0);
            const size_t length = size_t(std::atoll(out.c_str() + at + 16)), body = out.find("\r\n\r\n", at);
            if (body == std::string::npos) {
                ADD_FAILURE() << "no end of the headers";
                break;
            }
            list.push_back(Json::parse(out.substr(body + 4, length)));
            at = body + 4 + length;
        }
        return list;
    }
    static Json answer(const std::vector<Json>& all, int id) {
        for (const Json& j : all)
            if (j.contains("id") && j["id"] == id) return j.contains("result") ? j["result"] : j["error"];
        ADD_FAILURE() << "no answer " << id;
        return nullptr;
    }
    /// The diagnostics last published for this text.
    Json published(const std::vector<Json>& all, const std::string& name) const {
        Json last;
        for (const Json& j : all)
            if (j.value("method", "") == "textDocument/publishDiagnostics" && j["params"]["uri"] == uri(name))
                last = j["params"]["diagnostics"];
        return last;
    }
    static std::vector<std::string> labels(const Json& items) {
        std::vector<std::string> l;
        for (const Json& i : items) l.push_back(i["label"].get<std::string>());
        return l;
    }
    static bool has(const std::vector<std::string>& l, const std::string& s) {
        return std::find(l.begin(), l.end(), s) != l.end();
    }
    /// One question about the place of '|' in a text called "a.sl".
    Json ask(const std::string& method, const std::string& marked) {
        const Marked m(marked);
        begin();
        open("a.sl", m.text);
        const int id = ask(method, "a.sl", m.line, m.character);
        end();
        return answer(run(), id);
    }
};
