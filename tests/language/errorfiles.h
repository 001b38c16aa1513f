// The files of erroneous programs, taken apart. What stands in them is described in errorplaces_test.cpp.
#pragma once
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

namespace alpenglow::rsl {

/// Line, column, warning, id.
using Said = std::tuple<int, int, bool, std::string>;

struct Bad {
    std::string mode, name, text;
    int line = 0; ///< in the file of programs
    std::vector<Said> expected;
};

inline std::string repeated(std::string s) {
    for (size_t at; (at = s.find("{{")) != std::string::npos;) {
        const size_t star = s.find('*', at), end = s.find("}}", at);
        if (star == std::string::npos || end == std::string::npos || star > end) break;
        std::string all;
        for (int n = std::atoi(s.c_str() + at + 2); n > 0; --n) all += s.substr(star + 1, end - star - 1);
        s.replace(at, end + 2 - at, all);
    }
    return s;
}

inline std::vector<Bad> readErrors(const std::filesystem::path& path) {
    std::vector<Bad> all;
    std::ifstream in(path, std::ios::binary);
    std::string line, mode, name;
    int rows = 0;
    for (int number = 1; std::getline(in, line); ++number) {
        const size_t mark = line.find_first_not_of(' ');
        if (line.rfind("== ", 0) == 0) {
            const size_t space = line.find(' ', 3);
            mode = line.substr(3, space - 3);
            name = space == std::string::npos ? "" : line.substr(space + 1);
            if (mode != "lines") all.push_back({mode, name, "", number, {}});
            rows = 0;
        } else if (mode.empty() || (mode == "lines" && (mark == std::string::npos || line[0] == '#'))) {
            continue;
        } else if (mark != std::string::npos && line[mark] == '^' && line.compare(mark, 2, "^ ") == 0) {
            Said s{std::max(rows, 1), int(mark) + 1, false, line.substr(mark + 2)};
            auto& [row, column, warning, id] = s;
            if (std::isdigit(static_cast<unsigned char>(id[0]))) {
                char* end = nullptr;
                row = int(std::strtol(id.c_str(), &end, 10));
                column = int(std::strtol(end + 1, &end, 10));
                id = end + 1;
            }
            warning = id.rfind("warning ", 0) == 0;
            if (warning) id.erase(0, 8);
            if (!all.empty()) all.back().expected.push_back(s);
        } else if (mode == "lines") {
            all.push_back({mode, name, line, number, {}});
            rows = 1;
        } else {
            all.back().text += repeated(line) + "\n";
            ++rows;
        }
    }
    for (Bad& b : all) {
        std::sort(b.expected.begin(), b.expected.end());
        while (b.mode != "lines" && b.text.size() > 1 && b.text.ends_with("\n")) b.text.pop_back(); // the blank lines behind it
    }
    return all;
}

inline std::vector<std::filesystem::path> errorFiles() {
    std::vector<std::filesystem::path> all;
    for (const auto& e :
         std::filesystem::directory_iterator(std::filesystem::path(ALPENGLOW_SOURCE_DIR) / "tests/language/errors"))
        if (e.path().extension() == ".err") all.push_back(e.path());
    std::sort(all.begin(), all.end());
    return all;
}

} // namespace alpenglow::rsl
