#include "scene/filterlink.h"
#include <algorithm>
#include <set>

namespace alpenglow::scene {
namespace {

constexpr char kMark[] = "lightfilter\n";

std::string oneLine(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

/// The words of a text, separated by blanks or commas; a + before one does not count.
std::set<std::string> filterNames(const std::string& text) {
    std::set<std::string> all;
    for (size_t at = 0; at < text.size();) {
        const size_t begin = text.find_first_not_of(" \t\n,", at);
        if (begin == std::string::npos) break;
        at = std::min(text.find_first_of(" \t\n,", begin), text.size());
        const size_t plus = text[begin] == '+' ? 1 : 0;
        all.insert(text.substr(begin + plus, at - begin - plus));
    }
    return all;
}

std::set<std::string> namesOf(const Param* p) {
    return p && !p->strings.empty() ? filterNames(p->strings[0]) : std::set<std::string>();
}

bool meet(const std::set<std::string>& a, const std::set<std::string>& b) {
    return std::any_of(a.begin(), a.end(), [&](const std::string& s) { return b.count(s) > 0; });
}

} // namespace

std::string FilterLink::text() const { return kMark + oneLine(light) + '\n' + oneLine(filter) + '\n' + oneLine(groups); }

std::optional<FilterLink> FilterLink::of(const std::string& text) {
    constexpr size_t kBegin = sizeof kMark - 1;
    if (text.compare(0, kBegin, kMark) != 0) return {};
    const size_t first = text.find('\n', kBegin), second = first == std::string::npos ? first : text.find('\n', first + 1);
    if (second == std::string::npos) return {};
    return FilterLink{text.substr(kBegin, first - kBegin), text.substr(first + 1, second - first - 1), text.substr(second + 1)};
}

bool FilterLink::acts(const Attributes* a) const {
    std::set<std::string> own = filterNames(groups);
    if (!a) return own.empty();
    const Param* enabled = a->value(enabledFilterKey(light, filter));
    if (enabled && !enabled->numbers.empty()) return enabled->numbers[0] != 0;
    if (!own.empty() && !meet(own, namesOf(a->value("lightfilter:subset")))) return false;
    own.insert(filter);
    return !meet(own, namesOf(a->value("lightfilter:excludesubset")));
}

std::string enabledFilterKey(const std::string& light, const std::string& filter) {
    return "lightfilter:enabled\n" + oneLine(light) + '\n' + oneLine(filter);
}

} // namespace alpenglow::scene
