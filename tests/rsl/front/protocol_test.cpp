// Names of rsl/front/protocol.h: made and taken apart again.
#include "rsl/front/protocol.h"
#include <gtest/gtest.h>

namespace protocol_test {

using namespace alpenglow::rsl;

namespace {

TEST(ProtocolNames, Inputs) {
    using Kind = InputName::Kind;
    const std::pair<const char*, InputName> cases[] = {
        {"P", {Kind::Variable, "P", false, false, "", ""}},
        {"param:Kd", InputName::parameter("Kd")},
        {"displacement:hump", InputName::displacement("hump")},
        {"displacement:this->h", InputName::left("h")},
        {"displacement:this->list#", InputName::left("list", true)},
        {"space:my space>current", InputName::space("my space", "current")},
    };
    for (const auto& [text, name] : cases) {
        EXPECT_EQ(InputName::parse(text), name) << text;
        EXPECT_EQ(name.text(), text);
    }
    const InputName open = InputName::parse("space:object"); // no end: a name of nothing, which crashes nobody
    EXPECT_EQ(open.from, "object");
    EXPECT_EQ(open.to, "");
}

TEST(ProtocolNames, Outputs) {
    using What = OutputName::What;
    const std::pair<const char*, OutputName> cases[] = {
        {"Ci", OutputName::of("Ci")},
        {"list[12]", {What::Value, false, false, false, "list", 12, 0}},
        {"param:Kd", OutputName::parameterOf("Kd")},
        {"param:list[0]", OutputName::parameterOf("list", 0)},
        {"Du:P", OutputName::du("P")},
        {"Dv:param:height", OutputName::parameterOf("height", -1, What::Dv)},
        {"given:layer", OutputName::given("layer")},
        {"slope:Ci", OutputName::slope("Ci")},
        {"param:this->h", OutputName::left("h")},
        {"Du:param:this->h", OutputName::left("h", false, What::Du)},
        {"param:this->list#", OutputName::left("list", true)},
        {"param:this->list[3]", {What::Value, true, true, false, "list", 3, 0}},
        {"lit", OutputName::ofBlock("lit", 0)},
        {"Cl#2", OutputName::ofBlock("Cl", 2)},
    };
    for (const auto& [text, name] : cases) {
        EXPECT_EQ(OutputName::parse(text), name) << text;
        EXPECT_EQ(name.text(), text);
    }
    // What is no number stays a part of the name.
    for (const char* text : {"a[x]", "a#", "a[]", "[1", "", "given:", "Du:"}) EXPECT_EQ(OutputName::parse(text).text(), text);
    EXPECT_EQ(OutputName::givenName("given:layer"), "layer");
    EXPECT_EQ(OutputName::givenName("layer"), "");
}

TEST(ProtocolNames, Pairs) {
    const PairName sent = PairName::parse("send:light:cone[3]");
    EXPECT_EQ(sent.kind, PairName::Kind::Send);
    EXPECT_EQ(sent.name, "cone");
    EXPECT_EQ(sent.element, 3);
    EXPECT_EQ(sent.text(), "send:light:cone[3]");
    EXPECT_EQ(PairName::send("x").text(), "send:light:x");
    for (const auto& [to, word] : {std::pair{PairName::To::Surface, "surface"},
                                   {PairName::To::Displacement, "displacement"},
                                   {PairName::To::Volume, "volume"}}) {
        const PairName all = PairName::send("w", -1, to, true), one = PairName::send("w", 2, to);
        EXPECT_EQ(all.text(), std::string("send:") + word + ":w#");
        EXPECT_EQ(one.text(), std::string("send:") + word + ":w[2]");
        for (const PairName& n : {all, one}) {
            const PairName read = PairName::parse(n.text());
            EXPECT_EQ(read.kind, PairName::Kind::Send);
            EXPECT_EQ(read.to, to);
            EXPECT_EQ(read.name, "w");
            EXPECT_EQ(read.element, n.element);
            EXPECT_EQ(read.length, n.length);
        }
    }
    EXPECT_EQ(PairName::parse("send:atmosphere:k").text(), "send:volume:k"); // the same shader
    EXPECT_EQ(PairName::parse("send:imager:k").kind, PairName::Kind::Plain);
    EXPECT_EQ(InputName::parse(InputName::sent("k", true).text()), InputName::sent("k", true));
    EXPECT_EQ(InputName::parse(InputName::sent("k").text()), InputName::sent("k"));
    EXPECT_EQ(PairName::parse(PairName::surface("Kd").text()).kind, PairName::Kind::Surface);
    EXPECT_EQ(PairName::parse("bias").kind, PairName::Kind::Plain);
    EXPECT_EQ(PairName::parse("eta[1]").text(), "eta[1]"); // of other pairs nothing is taken apart
    EXPECT_EQ(PairName::parse("eta[1]").name, "eta[1]");
}

TEST(ProtocolNames, WhatIsHeard) {
    const auto queried = QueriedOutput::parse(QueriedOutput{2, 5, true}.text());
    ASSERT_TRUE(queried);
    EXPECT_EQ(queried->kind, 2);
    EXPECT_EQ(queried->length, 5);
    EXPECT_TRUE(queried->varying);
    EXPECT_FALSE(QueriedOutput::parse("2 5"));
    EXPECT_TRUE(QueriedMember::parse(QueriedMember{4, true}.text()).length);
    EXPECT_EQ(QueriedMember::parse(QueriedMember{4, true}.text()).count, 4);
    EXPECT_EQ(QueriedMember::parse(QueriedMember{}.text()).count, 0);
    EXPECT_TRUE(isLengthResult(lengthResult("value")));
    EXPECT_TRUE(isLengthParameter(lengthParameter("list")));
    EXPECT_TRUE(isElementResult("list[0]"));
    EXPECT_FALSE(isElementResult(""));
}

TEST(ProtocolNames, Handles) {
    const auto light = LightHandle::parse(LightHandle{7, "key"}.text());
    ASSERT_TRUE(light);
    EXPECT_EQ(light->light, 7);
    EXPECT_EQ(light->declared, "key");
    EXPECT_FALSE(LightHandle::parse("key"));
    EXPECT_EQ(shownHandle("light#7:key"), "key");
    EXPECT_EQ(shownHandle("key"), "key");
    EXPECT_EQ(shownHandle(""), "<null>");
    EXPECT_EQ(shownHandle("light#7"), "light#7");
    EXPECT_LT(LightHandle::parse("light#x:y")->light, 0);
}

} // namespace

} // namespace protocol_test
