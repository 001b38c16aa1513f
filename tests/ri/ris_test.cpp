// Requests of RIS: networks of patterns by handle, lights that are on everywhere, the hider that follows (docs/ris.md).
#include "collect.h"
#include "ri/lightfilters.h"
#include "ri/oslnetwork.h"
#include "ri/ris.h"
#include "scene/filterlink.h"
#include "scene/network.h"
#include <filesystem>
#include <fstream>

namespace ris_test {

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

/// The connection of the surface of a primitive, and the pattern that it means.
scene::Connection connectionOf(const scene::Primitive& p) {
    const auto& all = p.attributes->surface->connections;
    EXPECT_EQ(all.size(), 1u);
    return all.empty() ? scene::Connection{} : all[0];
}
float valueOf(const scene::Primitive& p, const std::string& parameter) {
    const auto pattern = p.attributes->coshaders.find(connectionOf(p).handle);
    const scene::Param* v = pattern == p.attributes->coshaders.end() ? nullptr : scene::find(pattern->second->params, parameter);
    EXPECT_NE(v, nullptr);
    return v ? v->numbers[0] : -1;
}

TEST(Ris, AHandleMeansThePatternThatItHasWhenTheBxdfStands) {
    auto c = inWorld("Pattern \"PxrMix\" \"m\" \"float mix\" .25\nBxdf \"PxrDiffuse\" \"d\" \"reference color diffuseColor\" "
                     "[\"m:resultRGB\"]\nSphere 1 -1 1 360\nPattern \"PxrMix\" \"m\" \"float mix\" .75\nSphere 2 -2 2 360\n"
                     "Bxdf \"PxrDiffuse\" \"d\" \"reference color diffuseColor\" [\"m:resultRGB\"]\nSphere 3 -3 3 360");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(connectionOf(c->primitive(0)).parameter, "diffuseColor");
    EXPECT_EQ(connectionOf(c->primitive(0)).output, "resultRGB");
    EXPECT_EQ(valueOf(c->primitive(0), "mix"), .25f);
    EXPECT_EQ(valueOf(c->primitive(1), "mix"), .25f); // the surface is still the first
    EXPECT_EQ(valueOf(c->primitive(2), "mix"), .75f);
}

TEST(Ris, PatternsEndWithTheirBlock) {
    auto c = inWorld("AttributeBegin\nPattern \"PxrMix\" \"mine\"\nAttributeEnd\nPattern \"PxrMix\" \"mind\"\n"
                     "Bxdf \"PxrDiffuse\" \"d\" \"reference color diffuseColor\" [\"mine:resultRGB\"]\nSphere 1 -1 1 360");
    EXPECT_EQ(c->only().code, Rie::BadHandle);
    EXPECT_EQ(c->only().place.line, 6);
    EXPECT_NE(c->only().hint.find("mind"), std::string::npos);
    EXPECT_TRUE(c->primitive().attributes->surface->connections.empty());
}

TEST(Ris, HandlesMayHaveColonsAndElementsMayBeConnected) {
    auto c = inWorld("Pattern \"PxrMix\" \"ns:m\"\nPattern \"PxrMix\" \"n\"\nBxdf \"X\" \"d\" \"reference float[2] w\" [\"\" "
                     "\"ns:m:resultR\"]\nSphere 1 -1 1 360");
    const scene::Connection k = connectionOf(c->primitive());
    EXPECT_EQ(scene::plainHandle(k.handle), "ns:m");
    EXPECT_EQ(k.output, "resultR");
    EXPECT_EQ(k.element, 1);
}

TEST(Ris, CirclesAreErrorsAndTheRestIsConnected) {
    auto c = inWorld(
        "Pattern \"PxrMix\" \"a\" \"reference color color1\" [\"b:resultRGB\"]\nPattern \"PxrMix\" \"b\" \"reference color "
        "color1\" [\"a:resultRGB\"]\nBxdf \"PxrDiffuse\" \"d\" \"reference color diffuseColor\" [\"a:resultRGB\"]\n"
        "Sphere 1 -1 1 360");
    EXPECT_EQ(c->only().code, Rie::BadHandle);
    EXPECT_NE(c->only().message.find("a > b > a"), std::string::npos) << c->messages();
    EXPECT_EQ(scene::plainHandle(connectionOf(c->primitive()).handle), "a");
    auto own = inWorld("Bxdf \"LamaLayer\" \"l\" \"reference bxdf materialTop\" [\"l:bxdf_out\"]\nSphere 1 -1 1 360");
    EXPECT_NE(own->only().message.find("l > l"), std::string::npos) << own->messages();
}

TEST(Ris, ChainsHaveABound) {
    std::string text = "Pattern \"PxrMix\" \"p0\"\n";
    for (size_t i = 1; i <= kNetworkDepth + 10; ++i)
        text += "Pattern \"PxrMix\" \"p" + std::to_string(i) + "\" \"reference color color1\" [\"p" + std::to_string(i - 1) +
                ":resultRGB\"]\n";
    auto c = inWorld(text + "Bxdf \"PxrDiffuse\" \"d\" \"reference color diffuseColor\" [\"p" +
                     std::to_string(kNetworkDepth + 10) + ":resultRGB\"]\nSphere 1 -1 1 360");
    EXPECT_EQ(c->only().code, Rie::Limit) << c->messages();
}

TEST(Ris, LightsAreOnEverywhere) {
    auto c = inWorld(
        "Sphere 1 -1 1 360\nAttributeBegin\nLight \"PxrRectLight\" \"l\" \"float intensity\" 2\nAttributeEnd\n"
        "AttributeBegin\nLight \"PxrDomeLight\" \"s\"\nAttributeEnd\nSphere 2 -2 2 360\nObjectBegin 1\nSphere 3 -3 3 360\n"
        "ObjectEnd\nObjectInstance 1");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    const scene::Frame& f = c->frame();
    ASSERT_EQ(f.lights.size(), 2u);
    EXPECT_TRUE(f.lights[0].area);
    EXPECT_FALSE(f.lights[1].area);
    ASSERT_EQ(f.primitives.size(), 3u); // with the rectangle
    for (const auto& p : f.primitives) EXPECT_EQ(p->attributes->lights.size(), 2u) << p->kind;
    EXPECT_EQ(f.primitives[1]->attributes->areaLight, 0);
    ASSERT_EQ(f.instances.size(), 1u);
    EXPECT_EQ(f.instances[0].attributes->lights.size(), 2u);
}

TEST(Ris, LightsOfAWorldEndWithIt) {
    auto c = read("Integrator \"PxrPathTracer\" \"i\"\nWorldBegin\nLight \"PxrDomeLight\" \"s\"\nSphere 1 -1 1 "
                  "360\nWorldEnd\nWorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
    ASSERT_EQ(c->frames.size(), 2u);
    EXPECT_EQ(c->frames[0]->primitives[0]->attributes->lights.size(), 1u);
    EXPECT_EQ(c->frames[1]->primitives[0]->attributes->lights.size(), 0u);
}

TEST(Ris, TheHiderIsPathUnlessTheSceneChoosesAnother) {
    const std::string ball = "WorldBegin\nBxdf \"PxrDiffuse\" \"d\"\nSphere 1 -1 1 360\nWorldEnd\n";
    EXPECT_EQ(read(ball)->frame().options.hider, "path");
    EXPECT_EQ(read("Hider \"hidden\"\n" + ball)->frame().options.hider, "hidden");
    EXPECT_EQ(inWorld("Sphere 1 -1 1 360")->frame().options.hider, "hidden");
    const auto traced = read("Hider \"raytrace\" \"int maxsamples\" 48 \"int incremental\" 1\n" + ball);
    EXPECT_EQ(traced->frame().options.hider, "path");
    EXPECT_EQ(traced->frame().options.pixelSamplesX * traced->frame().options.pixelSamplesY, 48);
    EXPECT_EQ(read("PixelSamples 4 4\nHider \"raytrace\" \"int maxsamples\" 48\n" + ball)->frame().options.pixelSamplesX, 4);
}

TEST(Ris, IntegratorsSayHowDeepPathsGo) {
    const auto depthOf = [](const std::string& integrator) {
        auto c = read(integrator + "\nWorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
        const auto v = c->frame().options.values.find("trace:maxdepth");
        return v == c->frame().options.values.end() ? -1 : v->second.numbers[0];
    };
    EXPECT_EQ(depthOf("Integrator \"PxrPathTracer\" \"i\" \"int maxPathLength\" 6"), 6);
    EXPECT_EQ(depthOf("Integrator \"PxrVCM\" \"i\" \"int maxPathLength\" 3"), 3);
    EXPECT_EQ(depthOf("Integrator \"PxrPathTracer\" \"i\""), -1);
    EXPECT_EQ(depthOf("Integrator \"PxrDirectLighting\" \"i\""), 1);
    auto other = read("Integrator \"PxrWonder\" \"i\"\nWorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
    EXPECT_EQ(other->only().code, Rie::Incapable);
    EXPECT_EQ(other->frame().options.hider, "path");
}

TEST(Ris, WithoutLightsAndIntegratorTheEyeHasALamp) {
    const std::string ball = "WorldBegin\nBxdf \"PxrDiffuse\" \"d\"\nSphere 1 -1 1 360\nWorldEnd\n";
    auto c = read(ball);
    ASSERT_EQ(c->frame().lights.size(), 1u);
    EXPECT_TRUE(c->primitive().attributes->lights.contains(0));
    EXPECT_EQ(read("Integrator \"PxrDefault\" \"i\"\n" + ball)->frame().lights.size(), 1u);
    EXPECT_EQ(read("Integrator \"PxrPathTracer\" \"i\"\n" + ball)->frame().lights.size(), 0u);
    EXPECT_EQ(inWorld("Sphere 1 -1 1 360")->frame().lights.size(), 0u);
    auto objects = read("WorldBegin\nObjectBegin 1\nSphere 1 -1 1 360\nObjectEnd\nBxdf \"PxrDiffuse\" \"d\"\nObjectInstance "
                        "1\nWorldEnd\n");
    EXPECT_EQ(objects->frame().lights.size(), 1u); // instances are drawn as well
    ASSERT_EQ(objects->frame().instances.size(), 1u);
    EXPECT_TRUE(objects->frame().instances[0].attributes->lights.contains(0));
}

// RIS gives Camera a kind, a handle and parameters; RISpec a name and parameters.
TEST(Ris, CameraHasAKindAndAHandle) {
    for (const char* camera : {"\"PRManCamera\" \"id\" \"float fStop\" [8]", "\"side\" \"float fStop\" [8]", "\"side\""}) {
        auto c = read(std::string("Camera ") + camera + "\nWorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
        ASSERT_EQ(c->count(), 1u) << c->messages();
        EXPECT_EQ(c->only().code, Rie::Incapable);
    }
}

TEST(Ris, PxrOcclusionSeesOneSurfaceEverywhere) {
    auto c = read("Integrator \"PxrOcclusion\" \"i\"\nWorldBegin\nBxdf \"PxrDiffuse\" \"d\"\nSphere 1 -1 1 360\nWorldEnd\n");
    EXPECT_EQ(c->primitive().attributes->surface->name, "PxrOcclusion");
}

TEST(Ris, WhatIsLeftOutIsSaidOnce) {
    auto c = inWorld("LightFilter \"PxrBarn\" \"b\"\nLightFilter \"PxrBarn\" \"c\"\nSampleFilter \"PxrGrade\" \"m\"\n"
                     "EnableLightFilter \"l\" \"b\" 1\nSphere 1 -1 1 360");
    EXPECT_EQ(c->count(), 2u) << c->messages();
    for (const Diagnostic& d : c->diagnostics.all()) EXPECT_EQ(d.severity, Severity::Warning);
}

// Pixar's manual, "Writing Light Filters": a filter without groups acts everywhere, one with groups where a subset names one.
TEST(Ris, LightFiltersActByTheirGroups) {
    const auto acts = [](const std::string& groups, const std::string& attributes) {
        const auto c = inWorld(attributes + "\nSphere 1 -1 1 360");
        return scene::FilterLink{"l", "f", groups}.acts(c->primitive().attributes.get());
    };
    const std::string subset = "Attribute \"lightfilter\" \"string subset\" [\"gobos, rods\"]\n";
    const std::string without = "Attribute \"lightfilter\" \"string excludesubset\" ";
    const std::string off = "EnableLightFilter \"l\" \"f\" 0\n";
    EXPECT_TRUE(acts("", ""));
    EXPECT_TRUE(acts("", subset));
    EXPECT_FALSE(acts("rods", ""));
    EXPECT_TRUE(acts("rods", subset));
    EXPECT_TRUE(acts("barns +rods", subset));
    EXPECT_FALSE(acts("rod", subset));
    EXPECT_FALSE(acts("rods", subset + without + "[\"rods\"]"));
    EXPECT_FALSE(acts("", without + "[\"f\"]"));
    EXPECT_TRUE(acts("", without + "[\"g\"]"));
    EXPECT_FALSE(acts("", off));
    EXPECT_FALSE(acts("rods", subset + off));
    EXPECT_TRUE(acts("", off + "EnableLightFilter \"l\" \"f\" 1"));
    EXPECT_TRUE(acts("", "EnableLightFilter \"k\" \"f\" 0\nEnableLightFilter \"l\" \"g\" 0"));
    EXPECT_TRUE((scene::FilterLink{"l", "f", ""}.acts(nullptr)));
    EXPECT_FALSE((scene::FilterLink{"l", "f", "rods"}.acts(nullptr)));
}

TEST(Ris, LinksOfLightFiltersAreTextsOfTheirLights) {
    const std::string lights =
        "LightFilter \"PxrRodLightFilter\" \"f\" GROUPS\nLight \"PxrDomeLight\" \"l\"\nSphere 1 -1 1 360\n";
    const auto links = [&](const std::string& groups, const std::string& more) {
        std::string text = lights;
        text.replace(text.find("GROUPS"), 6, groups);
        const auto c = inWorld(text + more);
        EXPECT_EQ(c->count(), 0u) << c->messages();
        const scene::Param* p = scene::find(c->frame().lights[0].shader->params, "lightFilterLinks");
        return p ? p->strings.at(0) : "";
    };
    EXPECT_EQ(links("", ""), ""); // all act on everything: the light asks nothing
    const auto link = scene::FilterLink::of(links("\"string linkingGroups\" [\"rods\"]", ""));
    ASSERT_TRUE(link.has_value());
    EXPECT_EQ(link->light, "l");
    EXPECT_EQ(link->filter, "f");
    EXPECT_EQ(link->groups, "rods");
    EXPECT_NE(links("", "EnableLightFilter \"l\" \"f\" 0\n"), "");
    EXPECT_NE(links("", "Attribute \"lightfilter\" \"string excludesubset\" [\"f\"]\n"), "");
    EXPECT_FALSE(scene::FilterLink::of("Kd").has_value());
    EXPECT_FALSE(scene::FilterLink::of("lightfilter\nl\nf").has_value());
}

TEST(Ris, SampleFilterPxrCryptomatteNamesAPicture) {
    const auto c = read("SampleFilter \"PxrCryptomatte\" \"c\" \"string filename\" [\"m.exr\"] \"string layer\" [\"material\"]\n"
                        "SampleFilter \"PxrCryptomatte\" \"d\" \"string filename\" [\"n.exr\"]\n"
                        "SampleFilter \"PxrCryptomatte\" \"d\" \"string filename\" [\"o.exr\"]\n"
                        "WorldBegin\nBxdf \"PxrDiffuse\" \"skin\"\nSphere 1 -1 1 360\nWorldEnd\n");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    ASSERT_EQ(c->frame().options.mattes.size(), 2u);
    EXPECT_EQ(c->frame().options.mattes.at("c").name, "m.exr");
    EXPECT_EQ(c->frame().options.mattes.at("d").name, "o.exr"); // the handle's last
    EXPECT_EQ(c->primitive().attributes->surface->handle, "skin");
}

TEST(Ris, LightsHaveGeometry) {
    auto c = inWorld(
        "Geometry \"rectlight\"\nGeometry \"envsphere\"\nAreaLightSource \"PxrStdAreaLight\" \"a\"\nGeometry \"spherelight\"");
    ASSERT_EQ(c->frame().primitives.size(), 2u) << c->messages();
    EXPECT_EQ(c->primitive(0).kind, "Polygon");
    EXPECT_EQ(c->primitive(1).kind, "Sphere");
    EXPECT_TRUE(c->primitive(0).attributes->lights.contains(0)); // of PRMan 19: on everywhere, too
}

TEST(Ris, PxrOslNamesItsShader) {
    auto c = inWorld("Pattern \"PxrOSL\" \"p\" \"string shader\" [\"band\"] \"float fuzz\" .1\nPattern \"PxrOSL\" \"q\"\n"
                     "Bxdf \"PxrDiffuse\" \"d\" \"reference color diffuseColor\" [\"p:Cout\"]\nSphere 1 -1 1 360");
    EXPECT_EQ(c->only().code, Rie::MissingData);
    EXPECT_EQ(valueOf(c->primitive(), "fuzz"), .1f);
    EXPECT_EQ(c->primitive().attributes->coshaders.at(connectionOf(c->primitive()).handle)->name, "band");
}

/// Two nodes of "stripes" and one of "blend", which takes both.
const char* kNetworkXml = "<?xml version=\"1.0\"?>\n<RenderManOSLNetwork Version=\"1\"><!-- <Node> -->\n<NodeList>\n"
                          "<Node><NodeId>stripes</NodeId><NodeLayer>A</NodeLayer><Properties><width/></Properties></Node>\n"
                          "<Node><NodeId>stripes</Id><NodeLayer>B</Layer></Node>\n<Node><NodeId> blend </NodeId></Node>\n"
                          "</NodeList><ConnectionList>\n<Connection><Source><NodeId>stripes</NodeId><NodeLayer>B</NodeLayer>"
                          "<ParameterName>Cout</ParameterName></Source><Destination><NodeId>blend</NodeId>"
                          "<ParameterName>first</ParameterName></Destination></Connection>\n</ConnectionList>\n"
                          "</RenderManOSLNetwork>\n";

TEST(Ris, NetworksOfOslAreRead) {
    Diagnostics said;
    const auto n = oslNetwork(kNetworkXml, "net.xml", said);
    ASSERT_TRUE(n) << said.all().at(0).message;
    ASSERT_EQ(n->nodes.size(), 3u);
    EXPECT_EQ(n->nodes[1].shader + n->nodes[1].layer, "stripesB");
    EXPECT_EQ(n->nodes[2].layer, "blend"); // without a layer
    ASSERT_EQ(n->links.size(), 1u);
    EXPECT_EQ(n->links[0].from + " " + n->links[0].output + " " + n->links[0].to + " " + n->links[0].parameter,
              "B Cout blend first");
    const std::string xml = kNetworkXml;
    std::string lost = xml;
    lost.replace(lost.find("<Source><NodeId>stripes</NodeId><NodeLayer>B"), 44, "<Source><NodeId>nobody</NodeId><NodeLayer>C");
    for (const std::string& bad :
         {std::string(), std::string("<"), std::string("<a><Node></Node></a>"), lost,
          std::string("<RenderManOSLNetwork><Node></Node>"), std::string("<!-- <RenderManOSLNetwork>")}) {
        Diagnostics faults;
        EXPECT_FALSE(oslNetwork(bad, "net.xml", faults)) << bad;
        ASSERT_EQ(faults.all().size(), 1u) << bad;
        EXPECT_GT(faults.all()[0].place.column, 0) << bad;
    }
    for (size_t cut = 0; cut < xml.size(); ++cut) {
        Diagnostics faults;
        EXPECT_EQ(oslNetwork(xml.substr(0, cut), "net.xml", faults).has_value(), cut + 1 == xml.size())
            << cut; // the last line end
    }
    Diagnostics where;
    EXPECT_FALSE(oslNetwork(lost, "net.xml", where));
    EXPECT_EQ(where.all()[0].place.line, 8);
    EXPECT_EQ(where.all()[0].place.column, 13); // of <Source>, behind <Connection>
}

TEST(Ris, ALayerOfANetworkIsAPatternOfItsOwn) {
    const auto folder = std::filesystem::temp_directory_path() / ("alpenglow_oslnet_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "net.xml") << kNetworkXml;
    const std::string option = "Option \"searchpath\" \"string shader\" [\"" + folder.string() + "\"]\nWorldBegin\n",
                      use = "Bxdf \"PxrDiffuse\" \"d\" \"reference color diffuseColor\" [\"m:B.Cout\"]\nSphere 1 -1 1 360\n",
                      first = "Pattern \"PxrOSL\" \"m\" \"string network\" \"net\" \"float A.width\" .1 \"float B.width\" .3\n";
    auto c = read(option + first + use + "Pattern \"PxrMix\" \"m\" \"float mix\" .5\n" + use + "WorldEnd\n");
    EXPECT_EQ(valueOf(c->primitive(), "width"), .3f);
    EXPECT_EQ(c->primitive().attributes->coshaders.at(connectionOf(c->primitive()).handle)->name, "stripes");
    EXPECT_EQ(connectionOf(c->primitive()).output, "Cout");
    EXPECT_EQ(valueOf(c->primitive(1), "mix"), .5f); // the layers ended with their handle
    EXPECT_EQ(c->count(), 0u) << c->messages();
    auto last = read(option + first +
                     "Bxdf \"PxrDiffuse\" \"d\" \"reference color diffuseColor\" [\"m:Cout\"]\nSphere 1 -1 1 "
                     "360\nWorldEnd\n");
    const auto at = last->primitive().attributes->coshaders.find(connectionOf(last->primitive()).handle);
    ASSERT_NE(at, last->primitive().attributes->coshaders.end()) << last->messages();
    EXPECT_EQ(at->second->name, "blend");
    EXPECT_EQ(at->second->connections.at(0).parameter, "first");
    EXPECT_EQ(inWorld("Pattern \"PxrOSL\" \"m\" \"string network\" \"nowhere\"\nSphere 1 -1 1 360")->only().code, Rie::NoFile);
    std::ofstream(folder / "net.xml") << "<html/>";
    const auto bad = read(option + first + "Sphere 1 -1 1 360\nWorldEnd\n");
    EXPECT_EQ(bad->only().code, Rie::BadFile);
    EXPECT_EQ(bad->only().place.file, (folder / "net.xml").string());
    std::filesystem::remove_all(folder);
}

TEST(Ris, PxrVolumeIsWhatIsInside) {
    auto c = inWorld("Bxdf \"PxrVolume\" \"v\" \"color diffuseColor\" [1 1 1]\nSphere 1 -1 1 360");
    EXPECT_EQ(c->primitive().attributes->interior->name, "PxrVolume");
    EXPECT_EQ(c->primitive().attributes->surface->name, "null");
}

TEST(Ris, ProfilesAreReadAndWhatIsDamagedIsRefused) {
    const std::string head = "IESNA:LM-63-1995\nTILT=", tail = "1 1000 2 2 3 1 1 0 0 0 1 1 50\n0, 90\n0 90 180\n10 5 20 0 -1 8\n";
    std::string why;
    const auto p = lightProfile(head + "NONE\n" + tail, why);
    ASSERT_TRUE(p) << why;
    EXPECT_EQ(*p, (std::vector<float>{2, 3, 0, 90, 0, 90, 180, .5f, .25f, 1, 0, 0, .4f}));
    EXPECT_EQ(lightProfile(head + "INCLUDE\n1 2\n0 90\n1 .9\n" + tail, why), p);
    for (const std::string& bad :
         {std::string(), head, head + "NONE\n", head + "NONE\n1 1000 2", head + "NONE\n1 1000 2 2 3 2 1 0 0 0 1 1 50\n0 90\n",
          head + "NONE\n1 1 1 99999 99999 1 1 0 0 0 1 1 1\n0 1\n", head + "NONE\n1 1 1 2 1 1 1 0 0 0 1 1 1\n90 0\n0\n1 1\n",
          head + "NONE\n1 1 1 2 1 1 1 0 0 0 1 1 1\n0 90\n0\n0 0\n", head + "NONE\n1 1 1 2 1 1 1 0 0 0 1 1 1\n0 90\n0\n1\n",
          head + "NONE\nnan nan nan", head + "INCLUDE\n1 99999\n"}) {
        why.clear();
        EXPECT_FALSE(lightProfile(bad, why)) << bad;
        EXPECT_FALSE(why.empty()) << bad;
    }
}

TEST(Ris, AProfileThatIsMissingIsSaidOnceAndTheLightShines) {
    auto c = inWorld("Light \"PxrRectLight\" \"l\" \"string iesProfile\" \"nowhere.ies\"\nSphere 1 -1 1 360");
    EXPECT_EQ(c->only().code, Rie::NoFile);
    EXPECT_EQ(c->frame().lights.size(), 1u);
}

TEST(Ris, FiltersHoldForTheLightsOfTheirBlockAndAreBounded) {
    auto c =
        inWorld("AttributeBegin\nTransformBegin\nTranslate 0 0 3\nLightFilter \"PxrRodLightFilter\" \"f\" \"float edge\" .5\n"
                "TransformEnd\nLight \"PxrDomeLight\" \"a\"\nAttributeEnd\nLight \"PxrDomeLight\" \"b\"\nSphere 1 -1 1 360");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    const scene::Param* rows = scene::find(c->frame().lights[0].shader->params, "lightFilters");
    ASSERT_NE(rows, nullptr);
    ASSERT_EQ(rows->numbers.size(), kFilterRow);
    EXPECT_EQ(rows->numbers[2 + 14], -3); // from world to the filter
    EXPECT_EQ(rows->numbers[27], .5f);
    EXPECT_EQ(scene::find(c->frame().lights[1].shader->params, "lightFilters"), nullptr);
    std::string many;
    for (size_t i = 0; i < kLightFilters + 3; ++i) many += "LightFilter \"PxrRodLightFilter\" \"f\"\n";
    EXPECT_EQ(inWorld(many + "Light \"PxrDomeLight\" \"a\"\nSphere 1 -1 1 360")->only().code, Rie::Limit);
}

} // namespace
} // namespace ris_test
