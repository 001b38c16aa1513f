#include "ri/models/ply_file.h"
#include "base/limits.h"
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace alpenglow::ri {
namespace {

constexpr int kTypeBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};

std::optional<PlyNumber> plyNumberType(std::string_view name) {
    static const std::map<std::string_view, PlyNumber> known = {
        {"char", PlyNumber::I8},    {"int8", PlyNumber::I8},    {"uchar", PlyNumber::U8},   {"uint8", PlyNumber::U8},
        {"short", PlyNumber::I16},  {"int16", PlyNumber::I16},  {"ushort", PlyNumber::U16}, {"uint16", PlyNumber::U16},
        {"int", PlyNumber::I32},    {"int32", PlyNumber::I32},  {"uint", PlyNumber::U32},   {"uint32", PlyNumber::U32},
        {"int64", PlyNumber::I64},  {"uint64", PlyNumber::U64}, {"float", PlyNumber::F32},  {"float32", PlyNumber::F32},
        {"double", PlyNumber::F64}, {"float64", PlyNumber::F64}};
    const auto i = known.find(name);
    return i == known.end() ? std::nullopt : std::optional(i->second);
}

std::vector<std::string_view> plyWords(std::string_view text) {
    std::vector<std::string_view> words;
    for (size_t i = 0; i < text.size();) {
        while (i < text.size() && (text[i] == ' ' || text[i] == '\t')) ++i;
        size_t end = i;
        while (end < text.size() && text[end] != ' ' && text[end] != '\t') ++end;
        if (end > i) words.push_back(text.substr(i, end - i));
        i = end;
    }
    return words;
}

} // namespace

std::string PlyFile::where() const { return counted() ? "" : fmt::format(" at byte {}", at_); }

bool PlyFile::fail(Rie code, const std::string& what) {
    log_.error(code, here(), what + where());
    return false;
}

std::string_view PlyFile::line() {
    if (at_ >= bytes_.size()) return {};
    size_t end = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
    std::string_view text = bytes_.substr(at_, end - at_);
    if (end < bytes_.size()) end += bytes_[end] == '\r' && end + 1 < bytes_.size() && bytes_[end + 1] == '\n' ? 2 : 1;
    at_ = end;
    ++line_;
    return text;
}

bool PlyFile::formatLine(const std::vector<std::string_view>& w) {
    if (w[1] == "ascii") format_ = Format::Ascii;
    else if (w[1] == "binary_little_endian") format_ = Format::Little;
    else if (w[1] == "binary_big_endian") format_ = Format::Big;
    else return fail(Rie::BadFile, fmt::format("format \"{}\" is not known", w[1].substr(0, 40)));
    return true;
}

bool PlyFile::elementLine(const std::vector<std::string_view>& w) {
    PlyElement e{std::string(w[1].substr(0, 80)), 0, {}};
    const auto [end, fault] = std::from_chars(w[2].data(), w[2].data() + w[2].size(), e.count);
    if (fault != std::errc() || end != w[2].data() + w[2].size() || !(e.count >= 0) || e.count != std::floor(e.count) ||
        e.count > 1e15)
        return fail(Rie::Syntax, fmt::format("\"{}\" is no count of elements", w[2].substr(0, 40)));
    if (elements_.size() >= size_t(limits::kModelProperties)) return fail(Rie::Limit, "there are too many elements");
    elements_.push_back(std::move(e));
    return true;
}

bool PlyFile::propertyLine(const std::vector<std::string_view>& w) {
    if (elements_.empty()) return fail(Rie::Syntax, "a property without an element");
    PlyElement& e = elements_.back();
    const bool list = w[1] == "list";
    if (list && w.size() < 5) return fail(Rie::Syntax, "property list needs two types and a name");
    PlyProperty p;
    p.name = std::string(w[list ? 4 : 2].substr(0, 80));
    const auto type = plyNumberType(w[list ? 3 : 1]);
    if (list) p.count = plyNumberType(w[2]);
    if (!type || (list && !p.count)) return fail(Rie::Syntax, fmt::format("the type of property \"{}\" is not known", p.name));
    p.type = *type;
    if (e.properties.size() >= size_t(limits::kModelProperties)) return fail(Rie::Limit, "an element has too many properties");
    e.properties.push_back(std::move(p));
    return true;
}

bool PlyFile::headerLine(const std::vector<std::string_view>& w) {
    const auto is = [&](const char* name, size_t words) { return w[0] == name && w.size() >= words; };
    if (w[0] == "comment" || w[0] == "obj_info") return true;
    if (is("format", 2)) return formatLine(w);
    if (is("element", 3)) return elementLine(w);
    if (is("property", 3)) return propertyLine(w);
    return fail(Rie::Syntax, fmt::format("\"{}\" is not known in a header", w[0].substr(0, 40)));
}

bool PlyFile::header() {
    if (line().substr(0, 3) != "ply") {
        log_.error(Rie::BadFile, {path_, 1, 1}, "the file is no PLY: it does not begin with \"ply\"");
        return false;
    }
    while (at_ < bytes_.size()) {
        const int begun = line_;
        const auto words = plyWords(line());
        if (words.empty()) continue;
        if (words[0] == "end_header") {
            inHeader_ = false;
            return true;
        }
        line_ = begun; // faults are of this line
        if (!headerLine(words)) return false;
        line_ = begun + 1;
    }
    return fail(Rie::BadFile, "the header does not end");
}

bool PlyFile::word(double& v) {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f'; };
    while (at_ < bytes_.size() && blank(bytes_[at_])) line_ += bytes_[at_++] == '\n';
    if (at_ >= bytes_.size()) return fail(Rie::BadFile, "the file ends early");
    size_t end = at_;
    while (end < bytes_.size() && !blank(bytes_[end])) ++end;
    const std::string_view text = bytes_.substr(at_, end - at_);
    const char* first = text.data() + (text[0] == '+');
    const auto [stop, fault] = std::from_chars(first, text.data() + text.size(), v);
    at_ = end;
    if (stop == text.data() + text.size() && fault == std::errc()) return true;
    if (fault == std::errc::result_out_of_range) return v = 0, true;
    return fail(Rie::Syntax, fmt::format("\"{}\" is no number", text.substr(0, 40)));
}

bool PlyFile::number(PlyNumber type, double& v) {
    if (format_ == Format::Ascii) return word(v);
    const size_t n = size_t(kTypeBytes[int(type)]);
    if (bytes_.size() - at_ < n) return fail(Rie::BadFile, "the file ends early");
    uint64_t bits = 0;
    for (size_t i = 0; i < n; ++i)
        bits |= uint64_t(uint8_t(bytes_[at_ + i])) << (8 * (format_ == Format::Little ? i : n - 1 - i));
    at_ += n;
    switch (type) {
    case PlyNumber::I8:
        v = int8_t(bits);
        break;
    case PlyNumber::I16:
        v = int16_t(bits);
        break;
    case PlyNumber::I32:
        v = int32_t(bits);
        break;
    case PlyNumber::I64:
        v = double(int64_t(bits));
        break;
    case PlyNumber::F32:
        v = std::bit_cast<float>(uint32_t(bits));
        break;
    case PlyNumber::F64:
        v = std::bit_cast<double>(bits);
        break;
    default:
        v = double(bits);
    }
    return true;
}

bool PlyFile::row(const PlyElement& e, PlyRow& r) {
    r.values.resize(e.properties.size());
    r.lists.resize(e.properties.size());
    for (size_t i = 0; i < e.properties.size(); ++i) {
        const PlyProperty& p = e.properties[i];
        if (!p.count) {
            if (!number(p.type, r.values[i])) return false;
            continue;
        }
        double n = 0;
        if (!number(*p.count, n)) return false;
        const double least = format_ == Format::Ascii ? 1 : kTypeBytes[int(p.type)];
        if (!(n >= 0) || n != std::floor(n) || n * least > double(bytes_.size() - at_))
            return fail(Rie::Range, fmt::format("a list of {} values is longer than the file", n));
        r.values[i] = n;
        r.lists[i].clear();
        for (double k = 0; k < n; ++k) {
            double v = 0;
            if (!number(p.type, v)) return false;
            r.lists[i].push_back(v);
        }
    }
    return true;
}

} // namespace alpenglow::ri
