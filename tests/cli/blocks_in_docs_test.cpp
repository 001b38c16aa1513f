// The code blocks of docs/plugins.md and docs/editors.md can be copied: what is compiled there is compiled here, with the command
// lines of the page, and run; what configures a foreign program is read as that program reads it, or compared with what ours
// says.
#include "command_folder.h"
#include <algorithm>
#include <iterator>
#include <regex>
#include <sstream>
#include <vector>

namespace blocks_in_docs_test {

namespace fs = std::filesystem;

namespace {

struct Block {
    std::string language, text; ///< language: what stands behind the three backquotes
};

std::string textOf(const fs::path& p) {
    std::ifstream in(p);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<Block> blocksOf(const std::string& page) {
    std::istringstream in(textOf(fs::path(ALPENGLOW_SOURCE_DIR) / "docs" / page));
    std::vector<Block> all;
    bool inside = false;
    for (std::string line, gap; std::getline(in, line);) {
        const bool fence = line.starts_with("```"), indented = !inside && line.starts_with("    ") && gap.empty();
        if (fence && !inside) all.push_back({line.substr(3), ""});
        else if (inside && !fence) all.back().text += line + "\n";
        else if (indented) all.push_back({"sh", line.substr(4) + "\n"});
        if (fence) inside = !inside;
        gap = line;
    }
    return all;
}

/// Brackets close what they open, outside of strings and comments.
bool balanced(const std::string& code, const std::string& comment) {
    std::string open;
    for (size_t i = 0; i < code.size(); ++i) {
        const char c = code[i];
        if (c == '"' || (c == '\'' && open.find('\'') == std::string::npos)) {
            const size_t end = code.find(c, i + 1);
            if (end == std::string::npos) return false;
            i = end;
        } else if (code.compare(i, comment.size(), comment) == 0) {
            i = std::min(code.find('\n', i), code.size());
        } else if (c == '(' || c == '[' || c == '{') {
            open += c;
        } else if (c == ')' || c == ']' || c == '}') {
            if (open.empty() || open.back() != (c == ')' ? '(' : c == ']' ? '[' : '{')) return false;
            open.pop_back();
        }
    }
    return open.empty();
}

class BlocksInDocs : public alpenglow::cli::testing::CommandFolder {
protected:
    const fs::path build = fs::path(ALPENGLOW_PROGRAM).parent_path().parent_path();
    /// In the test's folder, with our program on the path; what it writes.
    std::string shell(const std::string& command) {
        write("command.sh", "cd '" + dir.string() + "'\nexport PATH='" + (build / "bin").string() + "':\"$PATH\"\nexport HOME='" +
                                dir.string() + "' PKG_CONFIG_PATH='" + (dir / "place/share/pkgconfig").string() + "'\n" +
                                command);
        write("said.txt", "");
        const std::string said = (dir / "said.txt").string();
        status = std::system(("sh '" + (dir / "command.sh").string() + "' >'" + said + "' 2>&1").c_str());
        return textOf(said);
    }
    bool has(const std::string& program) { return shell("command -v " + program), status == 0; }
    /// The headers as they lie in a checkout, and as they are installed.
    void headers() {
        const fs::path from = fs::path(ALPENGLOW_SOURCE_DIR) / "include", place = dir / "place";
        fs::create_directory_symlink(from, dir / "include");
        fs::create_directories(place / "include/alpenglow");
        fs::create_directories(place / "share/pkgconfig");
        fs::create_directories(place / "share/cmake/alpenglow");
        fs::copy(from / "ri.h", place / "include/alpenglow/ri.h");
        fs::copy(from / "alpenglow/rslplugin.h", place / "include/alpenglow/rslplugin.h");
        fs::copy(build / "packaging/alpenglow.pc", place / "share/pkgconfig/alpenglow.pc");
        for (const char* file : {"alpenglowConfig.cmake", "alpenglowConfigVersion.cmake"})
            fs::copy(build / "packaging" / file, place / "share/cmake/alpenglow" / file);
    }
};

TEST_F(BlocksInDocs, Plugins) {
    const std::vector<Block> blocks = blocksOf("plugins.md");
    if (!has("c++") || !has("cc")) GTEST_SKIP() << "no compiler on the path";
    headers();
    fs::create_directory_symlink(fs::path(ALPENGLOW_SOURCE_DIR) / "examples", dir / "examples");
    fs::create_directories(dir / "build/release");
    fs::create_directory_symlink(build / "plugins", dir / "build/release/plugins");
    int shaders = 0, sources = 0, lines = 0, others = 0;
    for (const Block& b : blocks) {
        if (b.language == "rsl") {
            write("cloth.sl", b.text);
            EXPECT_EQ(run("compile -W --allow-exec --searchpath build/release/plugins cloth.sl", "2>&1"), "") << b.text;
            ++shaders;
        } else if (b.language == "cpp") {
            // The second has the headers of the first.
            const std::string begin =
                b.text.starts_with("#include")
                    ? ""
                    : "#include <alpenglow/rslplugin.h>\n#include <cmath>\nusing namespace alpenglow::rslplugin;\n";
            write(begin.empty() ? "wave.cpp" : "triangle.cpp", begin + b.text);
            ++sources;
        } else if (b.language == "c") {
            write("facets.c", b.text);
            ++sources;
        } else if (b.language == "sh") {
            if (b.text.find("pkg-config") != std::string::npos && !has("pkg-config")) continue;
            const std::string said = shell(b.text);
            EXPECT_EQ(status, 0) << b.text << said;
            EXPECT_EQ(said.find("warning: "), std::string::npos) << b.text << said;
            ++lines;
        } else if (b.language == "cmake") { // without a compiler: what the package offers is what is asked for
            write("block.cmake", R"(cmake_minimum_required(VERSION 3.20)
set(targets)
macro(add_library name)
  list(APPEND targets ${name})
endmacro()
macro(set_target_properties)
endmacro()
function(target_link_libraries name access library)
  if(NOT name IN_LIST targets OR NOT library IN_LIST targets)
    message(FATAL_ERROR "${name} ${library}: ${targets}")
  endif()
endfunction()
)" + b.text);
            const std::string said = shell("cmake -DCMAKE_PREFIX_PATH=\"$PWD/place\" -P block.cmake");
            EXPECT_EQ(status, 0) << b.text << said;
            ++others;
        } else {
            ADD_FAILURE() << "nothing runs a block of \"" << b.language << "\":\n" << b.text;
        }
    }
    EXPECT_GE(shaders, 1);
    EXPECT_GE(sources, 3);
    EXPECT_GE(lines, 4);
    EXPECT_GE(others, 1);
    // And they do what the page says.
    EXPECT_TRUE(fs::exists(dir / "weave.png"));
    shell("c++ -std=c++17 -O0 -shared -fPIC -I include triangle.cpp -o triangle.so");
    ASSERT_EQ(status, 0);
    write("both.sl",
          "plugin \"wave\";\nplugin \"triangle\";\nsurface both() { float luma; color rest; split(color(.5), luma, rest); "
          "Oi = 1; Ci = color(wave(0, PI / 2), triangle(.25), luma); }\n");
    write("a.rib",
          "Hider \"hidden\"\nFormat 8 8 1\nPixelSamples 1 1\nDisplay \"a.tif\" \"file\" \"rgb\"\nProjection "
          "\"orthographic\"\nTranslate 0 0 5\nWorldBegin\nSurface \"both\"\nProcedural \"DynamicLoad\" [\"facets\" \".5\"] "
          "[-1 1 -1 1 -1 1]\nWorldEnd\n");
    const std::string pixel = run("render -q a.rib --allow-exec --pixel 4,4", "2>&1");
    float r = 0, g = 0, b = 0;
    std::istringstream(pixel) >> r >> g >> b;
    EXPECT_NEAR(r, 1, 1e-5) << pixel;
    EXPECT_NEAR(g, .5, 1e-5) << pixel;
    EXPECT_NEAR(b, .5, 1e-5) << pixel;
}

/// 'errorformat' of Vim as regular expressions: file, line, column, message.
std::vector<std::regex> errorFormats(const std::string& option) {
    std::vector<std::regex> all;
    for (size_t at = 0, end; at < option.size(); at = end + 1) {
        end = std::min(option.find(",%f", at), option.size());
        std::string f = option.substr(at, end - at);
        for (const auto& [from, to] : {std::pair<std::string, std::string>{"\\ ", " "},
                                       {"%f", "([^:]+)"},
                                       {"%l", "([0-9]+)"},
                                       {"%c", "([0-9]+)"},
                                       {"%t", "[ew]"},
                                       {"%m", "(.+)"}})
            for (size_t k = 0; (k = f.find(from, k)) != std::string::npos; k += to.size()) f.replace(k, from.size(), to);
        all.emplace_back(f);
    }
    return all;
}

TEST_F(BlocksInDocs, Editors) {
    fs::create_directories(dir / ".vscode/extensions");
    fs::create_directory_symlink(fs::path(ALPENGLOW_SOURCE_DIR) / "editors", dir / "editors");
    int servers = 0;
    for (const Block& b : blocksOf("editors.md")) {
        if (b.language == "sh") {
            const std::string said = shell(b.text);
            EXPECT_EQ(status, 0) << b.text << said;
            EXPECT_TRUE(fs::exists(dir / fs::path(".vscode/extensions") / b.text.substr(b.text.find("alpenglow.alp"), 25) /
                                   "package.json"))
                << b.text;
            continue;
        }
        const bool vim = b.language == "vim";
        ASSERT_TRUE(vim || b.language == "lua") << "nothing reads a block of \"" << b.language << "\":\n" << b.text;
        if (vim && has("vim") && shell("vim --version").find("+eval") != std::string::npos) {
            write("block.vim", b.text);
            const std::string said = shell("vim -e -s -N -u NONE -i NONE -c 'verbose source block.vim' -c 'qa!' </dev/null");
            EXPECT_EQ(said.find("E1"), std::string::npos) << said;
            EXPECT_EQ(said.find("Error"), std::string::npos) << said;
        }
        if (!vim) { EXPECT_TRUE(balanced(b.text, "--")) << b.text; }
        // The command that serves an editor is one of ours.
        std::smatch server;
        if (std::regex_search(b.text, server, std::regex(R"([\[{] ?['"]alpenglow['"], ['"](\w+)['"] ?[\]}])"))) {
            run(server[1].str() + " --help", ">/dev/null 2>&1");
            EXPECT_EQ(status, 0) << b.text;
            ++servers;
        }
        // What :make runs, and how its messages are read.
        std::smatch make, format;
        if (std::regex_search(b.text, make, std::regex("makeprg=(.*)\n")) &&
            std::regex_search(b.text, format, std::regex("errorformat=(.*)\n"))) {
            write("bad.sl", "surface bad(float unused = 1;)\n{\n    Ci = nothing;\n}\n");
            std::string command = std::regex_replace(make[1].str(), std::regex(R"(\\ )"), " ");
            command.replace(command.find('%'), 1, "bad.sl");
            std::istringstream said(shell(command));
            int errors = 0, warnings = 0;
            const std::vector<std::regex> messages = errorFormats(format[1]);
            std::smatch parts;
            for (std::string line; std::getline(said, line);)
                if (std::any_of(messages.begin(), messages.end(),
                                [&](const std::regex& r) { return std::regex_match(line, parts, r); })) {
                    EXPECT_EQ(fs::path(parts[1].str()).filename(), "bad.sl");
                    const bool error = line.find(" error: ") != std::string::npos;
                    EXPECT_EQ(parts[2], error ? "3" : "1") << line;
                    ++(error ? errors : warnings);
                }
            EXPECT_EQ(errors, 1);
            EXPECT_EQ(warnings, 1);
            ++servers;
        }
    }
    EXPECT_EQ(servers, 3) << "vim-lsp, Neovim, :make";
}

} // namespace

} // namespace blocks_in_docs_test
