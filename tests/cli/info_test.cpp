// info: lists and pages that are made from the tables of requests, options, attributes, hiders, displays, and of the shaders.
#include "command_folder.h"
#include <algorithm>
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
    EXPECT_TRUE(text(ALPENGLOW_SOURCE_DIR "/docs/messages.md") == run("info --messages --markdown")) << how;
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
    EXPECT_NE(run("info --attributes indirect").find("Accepted, no effect"), std::string::npos);
    EXPECT_EQ(run("info --attributes visibilty"), "");
    EXPECT_EQ(status, 1);
    EXPECT_NE(errors().find("did you mean \"visibility\"?"), std::string::npos) << errors();
    const Json one = Json::parse(run("info --json --options shade:specular"));
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0]["type"], "string");
    EXPECT_EQ(one[0]["effect"], "used");
    EXPECT_EQ(one[0]["default"], "\"prman\"");
}

TEST_F(Info, MessagesAreExplained) {
    const std::string one = run("compile --explain pp-macro-arguments");
    EXPECT_EQ(status, 0);
    for (const char* part : {"error: macro '...' takes ... arguments, not ...", "as many arguments as its #define has parameters",
                             "    surface s() { Ci = product(1); }"})
        EXPECT_NE(one.find(part), std::string::npos) << part << "\n" << one;
    EXPECT_EQ(run("info --messages pp-macro-arguments"), one);
    EXPECT_NE(run("compile --explain unused-parameter").find("`compile -W` and editors say so."), std::string::npos);
    EXPECT_NE(run("compile --explain too-deep").find("It has no example: it needs"), std::string::npos);
    EXPECT_EQ(run("compile --explain no-such-functon"), "");
    EXPECT_EQ(status, 1);
    EXPECT_NE(errors().find("did you mean \"no-such-function\"?"), std::string::npos) << errors();
    const std::string all = run("compile --explain");
    EXPECT_EQ(status, 0);
    EXPECT_NE(all.find("\nmember-dot "), std::string::npos);
    EXPECT_GT(std::count(all.begin(), all.end(), '\n'), 170);
    const Json json = Json::parse(run("compile --json --explain member-dot"));
    ASSERT_EQ(json.size(), 1u);
    EXPECT_EQ(json[0]["texts"][0]["severity"], "error");
    EXPECT_EQ(json[0]["texts"][0]["hint"], "a member of a structure is read by '->'");
    EXPECT_NE(json[0]["example"].get<std::string>().find("r.origin"), std::string::npos);
    run("compile");
    EXPECT_EQ(status, 2); // a file is wanted
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

TEST_F(Info, PicturesMapsAndParts) {
    write("s.rib", "Format 16 12 1\nDisplay \"a.exr\" \"openexr\" \"rgba\"\nHider \"path\"\nWorldBegin\nColor [.25 .5 .75]\n"
                   "Surface \"constant\"\nPolygon \"P\" [-9 -9 1 -9 9 1 9 9 1 9 -9 1]\nWorldEnd\n");
    run("render --progress none --samples 0:2 s.rib");
    const Json picture = Json::parse(run("info --json a.exr"));
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(picture["kind"], "picture");
    EXPECT_EQ(picture["size"], Json({16, 12}));
    ASSERT_EQ(picture["channel"].size(), 4u);
    EXPECT_EQ(picture["channel"][2]["name"], "b");
    EXPECT_EQ(picture["channel"][2]["max"], .75);
    EXPECT_EQ(picture["metadata"]["spp"], "2");
    EXPECT_NE(run("info ./a.exr").find("\n  channel g, min 0.5, max 0.5, mean 0.5\n"), std::string::npos);
    const Json part = Json::parse(run("info --json a.exr.part"));
    EXPECT_EQ(part["kind"], "part of a render");
    EXPECT_EQ(part["samples"], Json({"0:2"}));
    run("maketx --mode periodic a.exr m.tx");
    const Json map = Json::parse(run("info --json m.tx"));
    EXPECT_EQ(map["kind"], "map, Plain Texture");
    EXPECT_EQ(map["levels"], 5); // 16, 8, 4, 2, 1
    EXPECT_EQ(map["metadata"]["wrapmodes"], "periodic,periodic");
    write("broken.exr", "no picture at all");
    EXPECT_EQ(run("info broken.exr"), "");
    EXPECT_EQ(status, 3);
    EXPECT_NE(errors().find("cannot read \"broken.exr\""), std::string::npos) << errors();
}

TEST_F(Info, ScenesAndModels) {
    write("s.rib",
          "Format 20 10 1\nDisplay \"x.exr\" \"openexr\" \"rgba\"\nFrameBegin 7\nWorldBegin\nLightSource \"pointlight\" 1\n"
          "Surface \"plastic\"\nSphere 1 -1 1 360\nSphere 1 -1 1 360\nObjectBegin 1\nDisk 0 1 360\nObjectEnd\n"
          "ObjectInstance 1\nObjectInstance 1\nWorldEnd\nFrameEnd\n");
    const Json scene = Json::parse(run("info --json s.rib"));
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(scene["kind"], "scene");
    ASSERT_EQ(scene["frame"].size(), 1u);
    const Json& frame = scene["frame"][0];
    EXPECT_EQ(frame["number"], 7);
    EXPECT_EQ(frame["size"], Json({20, 10}));
    EXPECT_EQ(frame["primitives"], (Json{{"Disk", 1}, {"Sphere", 2}}));
    EXPECT_EQ(frame["objects"]["instances"], 2);
    EXPECT_EQ(frame["lights"], (Json{{"pointlight", 1}}));
    EXPECT_NE(run("info s.rib").find("\n    primitives Disk 1, Sphere 2\n"), std::string::npos) << run("info s.rib");
    write("m.obj", "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nf 1 2 3\nf 1 3 4\n");
    const Json model = Json::parse(run("info --json m.obj"));
    EXPECT_EQ(model["kind"], "model");
    EXPECT_EQ(model["points"], 4);
    EXPECT_EQ(model["faces"], 2);
    EXPECT_EQ(model["to"], Json({2., 3., 0.}));
}

// What commands find is one object, which has their messages, too.
TEST_F(Info, JsonHoldsDiagnostics) {
    write("s.rib", "Format 4 4 1\nDisplay \"a.exr\" \"openexr\" \"rgba\"\nWorldBegin\nSurface \"constant\"\n"
                   "Polygon \"P\" [-9 -9 1 -9 9 1 9 9 1 9 -9 1]\nWorldEnd\n");
    run("render --progress none s.rib");
    const Json same = Json::parse(run("diff --json a.exr a.exr"));
    EXPECT_EQ(status, 0);
    EXPECT_EQ(same["within"], true);
    EXPECT_EQ(same["all"]["max"], 0);
    EXPECT_EQ(same["diagnostics"], Json::array());
    const Json none = Json::parse(run("diff --json a.exr none.exr"));
    EXPECT_EQ(status, 3);
    EXPECT_EQ(none["diagnostics"][0]["severity"], "error");
    EXPECT_EQ(errors(), "");
    EXPECT_EQ(Json::parse(run("eval --json '1 + 1'"))["numbers"], Json({2.}));
    EXPECT_EQ(Json::parse(run("eval --json 'nothing'"))["ok"], false);
    EXPECT_EQ(Json::parse(run("probe --json --spp 2 s.rib 0,0,1 0,0,-1"))["spp"], 2);
    EXPECT_EQ(Json::parse(run("ptc --json info none.ptc"))["files"], Json::array());
    EXPECT_EQ(Json::parse(run("merge --json none.part -o b.exr"))["merged"], false);
    EXPECT_TRUE(Json::parse(run("compile --json none.sl"))["diagnostics"].is_array());
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
