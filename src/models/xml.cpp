#include "models/xml.h"
#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <stdexcept>

namespace alpenglow::models {

namespace {

class XmlReader {
public:
    explicit XmlReader(std::string_view t) : text_(t) {}
    XmlElement document();
    int line() const {
        return int(std::count(text_.begin(), text_.begin() + std::ptrdiff_t(std::min(at_, text_.size())), '\n')) + 1;
    }

private:
    [[noreturn]] void fail(const std::string& why) { throw std::runtime_error(why); }
    bool starts(std::string_view word) const { return text_.substr(at_, word.size()) == word; }
    void until(std::string_view word, const char* what) {
        const size_t found = text_.find(word, at_);
        if (found == text_.npos) fail(fmt::format("{} does not end", what));
        at_ = found + word.size();
    }
    void blanks() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    }
    std::string name();
    std::string value();
    void begin(std::vector<XmlElement*>& open, XmlElement& root, bool& rooted);
    void end(std::vector<XmlElement*>& open);
    void step(std::vector<XmlElement*>& open, XmlElement& root, bool& rooted);
    int newlines();

    std::string_view text_;
    size_t at_ = 0, counted_ = 0, elements_ = 0;
    int lines_ = 1;
};

/// The line of the place that is read, counted on from the last call.
int XmlReader::newlines() {
    lines_ += int(std::count(text_.begin() + std::ptrdiff_t(counted_), text_.begin() + std::ptrdiff_t(at_), '\n'));
    counted_ = at_;
    return lines_;
}

std::string XmlReader::name() {
    const size_t from = at_;
    while (at_ < text_.size()) {
        const unsigned char c = static_cast<unsigned char>(text_[at_]);
        if (!(std::isalnum(c) || c == '_' || c == ':' || c == '-' || c == '.' || c >= 0x80)) break;
        ++at_;
    }
    if (at_ == from) fail("a name is missing");
    return std::string(text_.substr(from, at_ - from));
}

std::string XmlReader::value() {
    const char quote = at_ < text_.size() ? text_[at_] : 0;
    if (quote != '"' && quote != '\'') fail("the value of an attribute is not in quotes");
    const size_t end = text_.find(quote, ++at_);
    if (end == text_.npos) fail("the value of an attribute does not end");
    std::string out;
    while (at_ < end) {
        const char c = text_[at_++];
        if (c == '<') fail("there is a < in the value of an attribute");
        if (c != '&') {
            out += c;
            continue;
        }
        static const std::pair<const char*, char> entities[] = {
            {"amp;", '&'}, {"lt;", '<'}, {"gt;", '>'}, {"quot;", '"'}, {"apos;", '\''}};
        bool known = false;
        for (const auto& [word, letter] : entities)
            if (!known && starts(word)) known = true, out += letter, at_ += std::string_view(word).size();
        if (!known) fail("an entity is not one of &amp; &lt; &gt; &quot; &apos;");
    }
    at_ = end + 1;
    return out;
}

void XmlReader::begin(std::vector<XmlElement*>& open, XmlElement& root, bool& rooted) {
    if (++elements_ > kXmlElements) fail(fmt::format("there are more than {} elements", kXmlElements));
    if (open.size() >= kXmlDepth) fail(fmt::format("elements lie more than {} deep", kXmlDepth));
    if (open.empty() && rooted) fail("there is something behind the outermost element");
    XmlElement& e = open.empty() ? root : open.back()->children.emplace_back();
    rooted = true;
    e.line = newlines();
    e.name = name();
    for (;;) {
        blanks();
        if (starts("/>")) {
            at_ += 2;
            return;
        }
        if (starts(">")) {
            ++at_;
            open.push_back(&e); // its parent gets no other child before it is closed
            return;
        }
        if (at_ >= text_.size()) fail("an element does not end");
        std::string n = name();
        blanks();
        if (!starts("=")) fail(fmt::format("attribute {} has no value", n.substr(0, 40)));
        ++at_;
        blanks();
        std::string v = value();
        e.attributes.emplace_back(std::move(n), std::move(v));
    }
}

void XmlReader::end(std::vector<XmlElement*>& open) {
    at_ += 2;
    const std::string n = name();
    blanks();
    if (!starts(">")) fail("the end of an element does not end");
    ++at_;
    if (open.empty() || open.back()->name != n)
        fail(fmt::format("</{}> ends another element than the one that is open", n.substr(0, 40)));
    open.pop_back();
}

void XmlReader::step(std::vector<XmlElement*>& open, XmlElement& root, bool& rooted) {
    if (starts("<!--")) until("-->", "a comment");
    else if (starts("<![CDATA[")) until("]]>", "a CDATA section");
    else if (starts("<?")) until("?>", "a processing instruction");
    else if (starts("<!")) fail("document types are not read");
    else if (starts("</")) end(open);
    else {
        ++at_;
        begin(open, root, rooted);
    }
}

XmlElement XmlReader::document() {
    XmlElement root;
    bool rooted = false;
    std::vector<XmlElement*> open;
    while ((at_ = std::min(text_.find('<', at_), text_.size())) < text_.size()) step(open, root, rooted);
    if (!open.empty()) fail(fmt::format("<{}> is not closed", open.back()->name.substr(0, 40)));
    if (!rooted) fail("there is no element");
    return root;
}

} // namespace

const std::string& XmlElement::attribute(std::string_view wanted) const {
    static const std::string none;
    for (const auto& [n, v] : attributes)
        if (n == wanted) return v;
    return none;
}

std::optional<XmlElement> parseXml(std::string_view text, const std::string& file, Diagnostics& d) {
    XmlReader reader(text);
    try {
        return reader.document();
    } catch (const std::runtime_error& e) {
        d.report(Severity::Error, Rie::Syntax, {file, reader.line(), 0}, fmt::format("this is no sound XML: {}", e.what()));
    }
    return {};
}

} // namespace alpenglow::models
