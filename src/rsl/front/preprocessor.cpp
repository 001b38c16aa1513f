#include "rsl/front/preprocessor.h"
#include "rsl/front/preprocessor_machine.h"
#include <filesystem>
#include <fstream>
#include <sstream>

namespace alpenglow::rsl::front {

namespace fs = std::filesystem;

std::optional<std::string> readSource(const std::string& path) {
    std::error_code ec;
    if (!fs::is_regular_file(path, ec) || fs::file_size(path, ec) > limits::kStringBytes || ec) return std::nullopt;
    std::ifstream in(path, std::ios::binary);
    if (!in) return std::nullopt;
    std::ostringstream s;
    s << in.rdbuf();
    return s.str();
}

std::string Preprocessed::text() const {
    std::string s;
    int line = 0, file = -1;
    for (const Token& t : tokens) {
        if (t.kind == Tok::End) break;
        if (!s.empty()) s += t.place.line != line || t.place.file != file ? '\n' : ' ';
        line = t.place.line;
        file = t.place.file;
        s += t.text;
    }
    for (const Annotation& a : annotations) s += "\n#pragma annotation \"" + a.key + "\" \"" + a.value + "\"";
    return s;
}

Preprocessed preprocess(SourceSet& s, int main, const FrontOptions& o) { return Preprocessor(s, o).run(main); }

} // namespace alpenglow::rsl::front
