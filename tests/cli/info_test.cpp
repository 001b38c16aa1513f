// info: lists and pages that are made from the tables of requests, options, attributes, hiders, displays, and of the shaders.
#include "command_folder.h"
#include <nlohmann/json.hpp>
#include <set>

namespace info_test {

using Json = nlohmann::json;

namespace {

class Info : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string run(const std::string& arguments) { return CommandFolder::run(arguments, "2>err"); }
    std::string errors() const { return text(dir / "err"); }
    static std::string text(const std::filesystem::path& p) {
        std::ifstream in(p, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

} // namespace

TEST_F(Info, PagesAreUpToDate) {
    const char* how = "make it again: ninja shadeops_manual";
    EXPECT_TRUE(text(ALPENGLOW_SOURCE_DIR "/docs/rib.md") == run("info --requests --markdown")) << how;
    EXPECT_TRUE(text(ALPENGLOW_SOURCE_DIR "/docs/options.md") == run("info --options --markdown")) << how;
    EXPECT_EQ(status, 0);
}

TEST_F(Info, OptionsByNameCategoryAndBoth) {
    for (const char* name : {"trace:maxdepth", "maxdepth", "trace"}) {
        const std::string out = run(std::string("info --options ") + name);
        EXPECT_EQ(status, 0);
        for (const char* part :
             {"trace:maxdepth  (int)", "Default: 32 under path, else 4", "Option \"trace\" \"int maxdepth\" 8"})
            EXPECT_NE(out.find(part), std::string::npos) << part << "\n" << out;
    }
    EXPECT_NE(run("info --attributes visibility").find("visibility:camera  (int)"), std::string::npos);
    EXPECT_NE(run("info --attributes indirect").find("it has no effect here"), std::string::npos);
    EXPECT_EQ(run("info --attributes visibilty"), "");
    EXPECT_EQ(status, 1);
    EXPECT_NE(errors().find("did you mean \"visibility\"?"), std::string::npos) << errors();
    const Json one = Json::parse(run("info --json --options shade:specular"));
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0]["type"], "string");
    EXPECT_EQ(one[0]["effect"], "used");
    EXPECT_EQ(one[0]["default"], "\"prman\"");
}

TEST_F(Info, HidersDisplaysAndRequests) {
    EXPECT_NE(run("info --hiders path").find("path\n    Path-traced"), std::string::npos);
    EXPECT_NE(run("info --displays tiff").find("TIFF. 8 bits"), std::string::npos);
    EXPECT_NE(run("info --displays filterwidth").find("filterwidth  (float[2])"), std::string::npos);
    const std::string sphere = run("info --requests Sphere");
    EXPECT_NE(sphere.find("Sphere number[4] shape; ..\n"), std::string::npos) << sphere;
    EXPECT_NE(sphere.find("Example: Sphere 1 -1 1 360"), std::string::npos) << sphere;
    EXPECT_EQ(run("info --requests Sphre"), "");
    EXPECT_NE(errors().find("\"Sphere\"?"), std::string::npos) << errors();
    EXPECT_GT(Json::parse(run("info --json --requests")).size(), 100u);
    EXPECT_GE(Json::parse(run("info --json --displays")).size(), 10u);
}

TEST_F(Info, ShadersInTheOrderOfTheSearch) {
    write("plastic.sl", "// plastic: mine. More of it.\n// And more.\nsurface plastic() { Ci = 1; Oi = 1; }\n"
                        "class kit() { public void surface(output color Ci, Oi) { Ci = 1; } }\n");
    const std::string out = run("info --shaders");
    EXPECT_EQ(status, 0);
    EXPECT_LT(out.find("mine."), out.find("(a folder above has one of that name)")) << out;
    EXPECT_EQ(out.find("More of it"), std::string::npos) << "the first sentence only";
    const Json list = Json::parse(run("info --json --shaders"));
    ASSERT_GT(list.size(), 20u);
    EXPECT_EQ(list[0]["name"], "plastic");
    EXPECT_EQ(list[0]["kind"], "surface");
    EXPECT_EQ(list[0]["doc"], "mine.");
    EXPECT_EQ(list[1]["name"], "kit");
    EXPECT_EQ(list[1]["kind"], "class");
    std::set<std::string> names;
    for (const Json& s : list) {
        names.insert(s["name"]);
        EXPECT_NE(s["doc"], s["name"] == "kit" ? "-" : "") << s << ": each shipped shader says what it is";
    }
    EXPECT_TRUE(names.count("spotlight") && names.count("fog") && !names.count("surface")); // methods are no shaders
}

// What the page calls "Not drawn yet" is what the program reports, and nothing else.
TEST_F(Info, WhatIsNotDrawnIsCalledSo) {
    for (const Json& r : Json::parse(run("info --json --requests"))) {
        if (r["kind"] != "primitive") continue;
        const std::string name = r["name"], sample = r["example"];
        write("p.rib", "Display \"p.tif\" \"null\" \"rgba\"\nFormat 4 4 1\nWorldBegin\nTranslate 0 0 5\n" + name + " " + sample +
                           "\nWorldEnd\n");
        run("render p.rib");
        EXPECT_EQ(errors().find("is not yet drawn") != std::string::npos,
                  r["doc"].get<std::string>().find("Not drawn yet") != std::string::npos)
            << name << ": " << r["doc"] << "\n"
            << errors();
    }
}

} // namespace info_test
