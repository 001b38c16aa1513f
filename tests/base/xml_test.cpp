// XML 1.0 as it is read: what it means, where its faults are, and how much of it there may be.
#include "base/xml.h"
#include <gtest/gtest.h>

namespace base_xml_test {

using namespace alpenglow;

namespace {

/// "line:column message" of the one error of a text.
std::string fault(const std::string& text, const XmlRules& rules = {}) {
    Diagnostics d;
    EXPECT_FALSE(parseXml(text, "x", d, rules)) << text;
    EXPECT_EQ(d.all().size(), 1u);
    if (d.all().empty()) return "";
    const Diagnostic e = d.all()[0];
    EXPECT_EQ(e.place.file, "x");
    return std::to_string(e.place.line) + ":" + std::to_string(e.place.column) + " " + e.message;
}

XmlElement read(const std::string& text, const XmlRules& rules = {}) {
    Diagnostics d;
    auto x = parseXml(text, "x", d, rules);
    EXPECT_TRUE(x) << text << (d.all().empty() ? "" : d.all()[0].message);
    return x ? *x : XmlElement();
}

} // namespace

TEST(Xml, ReadsElementsAndAttributes) {
    const XmlElement x = read("<?xml?><!-- <no> --><a k='1 &lt; 2' l=\"x\">text<b/>\n<ns:c><![CDATA[<z>]]></ns:c ></a>");
    EXPECT_EQ(x.attribute("k"), "1 < 2");
    EXPECT_EQ(x.attribute("l"), "x");
    EXPECT_EQ(x.attribute("none"), "");
    ASSERT_EQ(x.children.size(), 2u);
    EXPECT_EQ(x.children[1].name, "ns:c");
    EXPECT_EQ(x.children[1].line, 2);
    EXPECT_EQ(x.children[1].column, 1);
    EXPECT_EQ(x.children[0].column, 47); // 46 bytes lie before <b/>
    EXPECT_EQ(x.child("ns:c"), &x.children[1]);
    EXPECT_EQ(x.child("none"), nullptr);
}

TEST(Xml, CharactersHaveTheirEntitiesReplaced) {
    const XmlElement x =
        read("\xef\xbb\xbf<a>\n one &amp;<b> in </b> two<!-- & --> &#65;&#x42;&#x20ac;&#228;&quot;<![CDATA[&lt;]]>\n</a>\n");
    EXPECT_EQ(x.text, "one & two AB\u20ac\u00e4\"&lt;");
    EXPECT_EQ(x.children.at(0).text, "in");
}

TEST(Xml, FaultsHaveTheirPlace) {
    EXPECT_EQ(fault(""), "1:1 this is no sound XML: there is no element");
    EXPECT_EQ(fault("<a>\n<b>\n</a>"), "3:1 this is no sound XML: </a> ends another element than the one that is open");
    EXPECT_EQ(fault("<a>"), "1:4 this is no sound XML: <a> is not closed");
    EXPECT_EQ(fault("<a/>\n <b/>"), "2:2 this is no sound XML: there is something behind the outermost element");
    EXPECT_EQ(fault("<a/>\n text"), "2:2 this is no sound XML: there is something behind the outermost element");
    EXPECT_EQ(fault("<a>\n<b c='1' d/>"), "2:11 this is no sound XML: attribute d has no value");
    for (const char* t : {"<a b>",
                          "<a b=c/>",
                          "<a b=\"",
                          "<a b=\"&x;\"/>",
                          "<a b='<'/>",
                          "<a",
                          "<",
                          "<a><!-- ",
                          "</a>",
                          "<a>&</a>",
                          "<a>&#0;</a>",
                          "<a>&#xd800;</a>",
                          "<a>&#x110000;</a>",
                          "<a>&#99999999999;</a>",
                          "<a>&#;</a>",
                          "<a>&#x;</a>",
                          "<a>&#6g;</a>",
                          "<a>&#xg;</a>",
                          "<![CDATA[x]]><a/>",
                          "<a><![CDATA[</a>",
                          "text"})
        EXPECT_NE(fault(t), "") << t;
}

// Neither a file nor memory can be asked for by entities (XXE, "a billion laughs").
TEST(Xml, DocumentTypesAreRefused) {
    EXPECT_EQ(fault("<!DOCTYPE a [<!ENTITY b \"bb\">]><a>&b;</a>"), "1:1 this is no sound XML: document types are not read");
    EXPECT_EQ(fault("<!DOCTYPE a SYSTEM \"file:///etc/passwd\"><a/>"), "1:1 this is no sound XML: document types are not read");
    EXPECT_NE(fault("<a>&b;</a>").find("1:4 this is no sound XML: an entity is not one of"), std::string::npos);
}

TEST(Xml, EndTagsMayBeWrongWhereThatIsAllowed) {
    const XmlElement x = read("<a><b>1</c><d>2</b></z>", {.anyEndTag = true});
    ASSERT_EQ(x.children.size(), 2u);
    EXPECT_EQ(x.children[0].text + x.children[1].text, "12");
    EXPECT_NE(fault("<a></b></c>", {.anyEndTag = true}), "");
}

TEST(Xml, DepthElementsAndBytesAreBounded) {
    std::string deep, wide = "<a>";
    for (int i = 0; i < 100000; ++i) deep += "<a>";
    for (int i = 0; i < 10; ++i) wide += "<b/>";
    wide += "</a>";
    EXPECT_EQ(fault(deep), "1:193 this is no sound XML: elements lie more than 64 deep"); // 64 times three bytes lie before it
    read(wide, {.elements = 11});
    EXPECT_NE(fault(wide, {.elements = 10}).find("more than 10 elements"), std::string::npos);
    read(wide, {.bytes = wide.size()});
    EXPECT_NE(fault(wide, {.bytes = wide.size() - 1}).find("bytes"), std::string::npos);
}

TEST(Xml, EveryBeginningOfATextEnds) {
    const std::string whole = "<?x?><a k='&#65;'><!-- c --><b>t&amp;</b><![CDATA[d]]></a>";
    for (size_t cut = 0; cut < whole.size(); ++cut) fault(whole.substr(0, cut));
    read(whole);
}

} // namespace base_xml_test
