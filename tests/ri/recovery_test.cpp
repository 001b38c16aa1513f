// Scopes, crossed and forgotten blocks, conditions, foreign code: what is mended and what is said.
#include "base/limits.h"
#include "collect.h"
#include "scene/scene.h"
#include "scene/solids.h"

namespace recovery_test {

using namespace alpenglow;
using namespace alpenglow::ri;

TEST(Recovery, WhatTheUserStoppedIsNotCalledUnfinished) {
    struct Stops : Collected {
        StopFlag stop;
        void render(std::shared_ptr<const scene::Frame> f) override { Collected::render(std::move(f)), stop = 1; }
    };
    Stops c;
    ReaderOptions options;
    options.stop = &c.stop;
    RibReader reader(options, c, c.diagnostics);
    reader.readMemory(
        "FrameBegin 1\nReadArchive \"inner\"\nIfBegin \"1\"\nWorldBegin WorldEnd\nSphere 1 -1 1 360\nIfEnd\nFrameEnd\n", "t.rib");
    EXPECT_EQ(c.frames.size(), 1u);
    EXPECT_EQ(c.count(), 1u) << c.messages(); // the archive that is not there
}

TEST(Scopes, OutOfScopeIsDoneAndWarnedAboutOnce) {
    auto c = read("WorldBegin Imager \"background\" Imager \"background\" Sphere 1 -1 1 360 WorldEnd");
    EXPECT_EQ(c->only().severity, Severity::Warning);
    EXPECT_EQ(c->only().code, Rie::NotOptions);
    EXPECT_EQ(c->frame().options.imager->name, "background");
    auto d = read("AttributeBegin Color 1 0 0 WorldBegin Sphere 1 -1 1 360 WorldEnd AttributeEnd AttributeBegin AttributeEnd");
    EXPECT_EQ(d->only().code, Rie::Nesting);
    EXPECT_EQ(d->primitive().attributes->color, Color(1, 0, 0));
    auto e = read("FrameBegin 1 WorldBegin MakeShadow \"a\" \"b\" WorldEnd FrameEnd");
    EXPECT_EQ(e->only().code, Rie::IllState);
    EXPECT_EQ(e->textures.size(), 1u);
}

TEST(Scopes, WorldOptionsEndWithTheWorld) {
    auto c = read("WorldBegin Format 10 10 1 WorldEnd WorldBegin WorldEnd");
    ASSERT_EQ(c->frames.size(), 2u);
    EXPECT_EQ(c->frames[0]->options.xres, 10);
    EXPECT_EQ(c->frames[1]->options.xres, 640);
}

TEST(Scopes, PrimitivesOutsideTheWorld) {
    auto c = read("Sphere 1 -1 1 360\nSphere 1 -1 1 360");
    EXPECT_EQ(c->only().code, Rie::NotPrims);
    EXPECT_EQ(c->only().severity, Severity::Error);
}

TEST(Nesting, CrossedBlocksAreMended) {
    auto c = inWorld("AttributeBegin TransformBegin Translate 1 0 0 AttributeEnd\nSphere 1 -1 1 360");
    EXPECT_EQ(c->only().code, Rie::Nesting);
    EXPECT_EQ(c->primitive().toWorld.first(), Matrix{});
    auto d = read("WorldBegin AttributeBegin Sphere 1 -1 1 360 WorldEnd WorldBegin WorldEnd");
    EXPECT_EQ(d->only().code, Rie::Nesting);
    EXPECT_EQ(d->frames.size(), 2u);
    auto e = read("FrameBegin 1 WorldBegin Sphere 1 -1 1 360 FrameEnd");
    EXPECT_EQ(e->only().code, Rie::Nesting);
    EXPECT_EQ(e->frame().primitives.size(), 1u);
    auto f = read("WorldBegin Sphere 1 -1 1 360 WorldBegin Sphere 1 -1 1 360 WorldEnd");
    EXPECT_EQ(f->frames.size(), 2u) << f->messages();
}

TEST(Nesting, EndsWithoutBegin) {
    for (const char* end : {"AttributeEnd", "TransformEnd", "WorldEnd", "FrameEnd", "SolidEnd", "ObjectEnd", "MotionEnd",
                            "ResourceEnd", "ArchiveEnd", "IfEnd", "Else", "ElseIf \"1\"", "EditEnd"}) {
        auto c = read(end);
        ASSERT_FALSE(c->diagnostics.all().empty()) << end;
        EXPECT_EQ(c->diagnostics.all().back().code, Rie::Nesting) << end;
    }
    auto c = inWorld("AttributeEnd TransformEnd Sphere 1 -1 1 360"); // do not close the world
    EXPECT_EQ(c->count(), 2u);
    EXPECT_EQ(c->frame().primitives.size(), 1u);
}

TEST(Nesting, StreamEndsInsideAWorld) {
    auto c = read("FrameBegin 1 WorldBegin AttributeBegin Sphere 1 -1 1 360\n");
    EXPECT_FALSE(c->ok);
    EXPECT_EQ(c->count(), 3u) << c->messages(); // Attribute, World, Frame
    EXPECT_EQ(c->frame().primitives.size(), 1u);
}

TEST(Solids, PartsKeepTheWayToThem) {
    using Op = scene::SolidOperation;
    auto c = inWorld("SolidBegin \"difference\"\n SolidBegin \"primitive\" Color 1 0 0 Sphere 1 -1 1 360 AttributeBegin Disk 1 1 "
                     "360 AttributeEnd SolidEnd\n"
                     "SolidBegin \"union\" SolidBegin \"primitive\" Sphere 2 -1 1 360 SolidEnd SolidBegin \"primitive\" Sphere 3 "
                     "-1 1 360 SolidEnd SolidEnd\n"
                     "SolidBegin \"primitive\" Sphere 4 -1 1 360 SolidEnd SolidEnd\nSphere 5 -1 1 360");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    ASSERT_EQ(c->frame().primitives.size(), 6u);
    const auto path = [&](size_t i) { return scene::solidPath(*c->primitive(i).attributes); };
    EXPECT_EQ(c->primitive(2).attributes->color, Color(1, 1, 1)); // a solid is an attribute block
    ASSERT_EQ(path(0).size(), 2u);
    EXPECT_EQ(path(0)[0].operation, Op::Difference);
    EXPECT_EQ(path(0)[1].operation, Op::Part);
    EXPECT_EQ(path(0)[1].child, 0);
    EXPECT_EQ(path(1)[1].id, path(0)[1].id); // two surfaces of one part
    for (size_t i : {2u, 3u}) {
        ASSERT_EQ(path(i).size(), 3u);
        EXPECT_EQ(path(i)[0].id, path(0)[0].id);
        EXPECT_EQ(path(i)[1].operation, Op::Union);
        EXPECT_EQ(path(i)[1].child, 1);
        EXPECT_EQ(path(i)[2].child, int(i) - 2);
        EXPECT_TRUE(scene::solidTakenAway(*c->primitive(i).attributes));
    }
    EXPECT_EQ(path(4)[1].child, 2);
    EXPECT_FALSE(scene::solidTakenAway(*c->primitive(0).attributes));
    EXPECT_TRUE(path(5).empty());
    EXPECT_EQ(inWorld("SolidBegin \"xor\" SolidEnd")->only().code, Rie::BadSolid);
}

TEST(Solids, WhatStandsBesidePartsIsOne) {
    auto c = inWorld("SolidBegin \"intersection\" Sphere 1 -1 1 360 Sphere 2 -1 1 360 SolidBegin \"primitive\" Sphere 3 -1 1 360 "
                     "SolidEnd SolidEnd");
    EXPECT_EQ(c->only().code, Rie::BadSolid);
    ASSERT_EQ(c->frame().primitives.size(), 3u);
    for (int i = 0; i < 3; ++i) {
        const auto path = scene::solidPath(*c->primitive(size_t(i)).attributes);
        ASSERT_EQ(path.size(), 2u);
        EXPECT_EQ(path[1].child, i);
        EXPECT_EQ(path[1].operation, scene::SolidOperation::Part);
    }
    // A block inside a part belongs to it.
    c = inWorld(
        "SolidBegin \"union\" SolidBegin \"primitive\" SolidBegin \"union\" Sphere 1 -1 1 360 SolidEnd SolidEnd SolidEnd");
    EXPECT_EQ(c->only().code, Rie::BadSolid);
    EXPECT_EQ(scene::solidPath(*c->primitive().attributes).size(), 2u);
}

TEST(Solids, InstancesKeepThePathOfTheirObject) {
    auto c = inWorld("ObjectBegin 1 SolidBegin \"difference\" SolidBegin \"primitive\" Sphere 1 -1 1 360 SolidEnd SolidBegin "
                     "\"primitive\" Sphere .5 -1 1 360 "
                     "SolidEnd SolidEnd ObjectEnd ObjectInstance 1 ObjectInstance 1");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    for (const scene::PrimitiveRef& p : c->frame().objects[0].primitives) {
        EXPECT_TRUE(p->attributesInside); // so that instances take what differs
        EXPECT_EQ(scene::solidPath(*p->attributes).size(), 2u);
    }
}

TEST(ForeignCode, IsNotRun) {
    auto c = inWorld("System \"ls\" Procedural \"RunProgram\" [\"p\" \"d\"] [-1 1 -1 1 -1 1] Procedural \"DynamicLoad\" [\"l\" "
                     "\"d\"] [-1 1 -1 1 -1 1]");
    ASSERT_EQ(c->count(), 3u) << c->messages();
    for (const Diagnostic& d : c->diagnostics.all()) {
        EXPECT_EQ(d.code, Rie::Incapable);
        EXPECT_NE(d.message.find("--allow-exec"), std::string::npos);
    }
    EXPECT_EQ(inWorld("Procedural \"Magic\" [\"a\"] [-1 1 -1 1 -1 1]")->only().code, Rie::BadToken);
}

TEST(Handler, UnknownStyles) { EXPECT_EQ(read("ErrorHandler \"shout\"")->only().code, Rie::BadToken); }

namespace {
/// Whether `expression` is true, with user:x = 3 (option) and user:s = 'abc' (attribute).
bool holds(const std::string& expression, size_t messages = 0) {
    auto c = read("Option \"user\" \"float x\" 3 Attribute \"user\" \"string s\" \"abc\" WorldBegin IfBegin \"" + expression +
                  "\" Sphere 1 -1 1 360 IfEnd WorldEnd");
    EXPECT_EQ(c->count(), messages) << expression << "\n" << c->messages();
    return c->frame().primitives.size() == 1;
}
} // namespace

TEST(Conditions, Expressions) {
    EXPECT_TRUE(holds("1"));
    EXPECT_FALSE(holds("0"));
    EXPECT_TRUE(holds("1 + 2 * 3 == 7"));
    EXPECT_TRUE(holds("(1 + 2) * 3 == 9"));
    EXPECT_TRUE(holds("-1 < 0 && !(2 < 1)"));
    EXPECT_TRUE(holds("0 || 10 / 4 == 2.5"));
    EXPECT_TRUE(holds("$Option:user:x == 3"));
    EXPECT_TRUE(holds("$user:x >= 3"));
    EXPECT_TRUE(holds("$Attribute:user:s == 'abc'"));
    EXPECT_TRUE(holds("$Attribute:user:s != 'abd'"));
    EXPECT_TRUE(holds("defined(Option:user:x)"));
    EXPECT_TRUE(holds("defined($user:s) && !defined(user:nothing)"));
    EXPECT_TRUE(holds("concat('a', 'b', 'c') == $user:s"));
    EXPECT_TRUE(holds("$(concat('user:', 'x')) == 3"));
    EXPECT_TRUE(holds("$user:s =~ 'b' && $user:s =~ '^a.*c$' && $user:x =~ '[0-9]'"));
    EXPECT_TRUE(holds("${user:x} == 3 && ${s} == 'abc'"));
    EXPECT_TRUE(holds("'it\\\\'s' =~ '^it.s$' && 'a*c' =~ 'a\\\\*c'"));
    EXPECT_FALSE(holds("${user:x == 3", 1));
    EXPECT_FALSE(holds("$user:s =~ '^b'"));
    EXPECT_FALSE(holds("$user:s =~ '('", 1));
    EXPECT_FALSE(holds("$user:nothing == 1", 1));
    EXPECT_FALSE(holds("defined(user:nothing) && $user:nothing == 1")); // not looked at
    // Where nothing is set, the default, as shaders get it; defined() asks for what is set.
    EXPECT_TRUE(holds("$Option:hider:jitter == 1 && $shadow:sample == 16 && $Attribute:trace:bias == -1"));
    EXPECT_TRUE(holds("$Attribute:displacementbound:coordinatesystem == 'object'"));
    EXPECT_FALSE(holds("defined($Option:hider:jitter) || defined(trace:bias)"));
    EXPECT_FALSE(holds("1 +", 1));
    EXPECT_FALSE(holds("1 2", 1));
    EXPECT_FALSE(holds("1 / 0", 1));
    EXPECT_FALSE(holds("'abc", 1));
    EXPECT_FALSE(holds("", 1));
    EXPECT_FALSE(holds(std::string(100000, '('), 1));
    EXPECT_FALSE(holds(std::string(100000, '!'), 1));
}

TEST(Conditions, Branches) {
    auto color = [](const std::string& a, const std::string& b) {
        return inWorld("IfBegin \"" + a + "\" Color 1 0 0 ElseIf \"" + b +
                       "\" Color 0 1 0 Else Color 0 0 1 IfEnd Sphere 1 -1 1 360")
            ->primitive()
            .attributes->color;
    };
    EXPECT_EQ(color("1", "1"), Color(1, 0, 0));
    EXPECT_EQ(color("0", "1"), Color(0, 1, 0));
    EXPECT_EQ(color("0", "0"), Color(0, 0, 1));
    auto c = inWorld("IfBegin \"0\" IfBegin \"1\" Sphere 1 -1 1 360 Else Sphere 1 -1 1 360 IfEnd Else Sphere 2 -2 2 360 IfEnd");
    EXPECT_EQ(c->primitive().numbers[0], 2);
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    EXPECT_EQ(read("IfBegin \"1\"")->only().code, Rie::Nesting);
}

TEST(Hints, WrongBoundIsOnlyAWarning) {
    auto c = inWorld("Bound 1 -1 0 1 0 1 Sphere 1 -1 1 360");
    EXPECT_TRUE(c->ok);
    EXPECT_EQ(c->only().code, Rie::Range);
    EXPECT_FALSE(c->primitive().attributes->bound);
}

TEST(Hints, VisibilityTakesNumbersAndWords) {
    EXPECT_EQ(inWorld("Attribute \"visibility\" \"transmission\" 1 Attribute \"visibility\" \"transmission\" \"Os\"")->count(),
              0u);
}

TEST(Foreign, EachNameIsSaidOnce) {
    auto c = inWorld("Sphre 1\nSphre 2\nSphere 1 -1 1 360\nNotthis 1 2\nSphre 3\n");
    EXPECT_EQ(c->count(), 2u) << c->messages();
    EXPECT_EQ(c->frame().primitives.size(), 1u);
    std::string many; // more different names than are distinguished: the reporter's own bound holds
    for (int i = 0; i < 2 * limits::kUnknownNames; ++i) many += "Q" + std::to_string(i) + "x 1\nQ0x 1\n";
    EXPECT_LE(inWorld(many)->count(), size_t(3 * limits::kUnknownNames) + 1);
}

TEST(Foreign, LaterNamesOfTheSameThings) {
    auto c = inWorld("VPAtmosphere \"fog\" VPInterior \"haze\" Sphere 1 -1 1 360");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->primitive().attributes->atmosphere->name, "fog");
    EXPECT_EQ(c->primitive().attributes->interior->name, "haze");
}

// Aqsis and 3Delight run the layers of a type one after the other: the last one's result is what stays.
TEST(Foreign, TheLastLayerIsTheShader) {
    const std::string layers =
        "ShaderLayer \"surface\" \"texmap\" \"one\" \"string texturename\" \"a.tex\"\n"
        "ShaderLayer \"surface\" \"matte\" \"two\" \"Kd\" .5\nShaderLayer \"displacement\" \"dented\" \"d\"\n";
    auto c = inWorld(layers + "Sphere 1 -1 1 360");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    EXPECT_EQ(c->primitive().attributes->surface->name, "matte");
    ASSERT_EQ(c->primitive().attributes->surface->params.size(), 1u);
    EXPECT_EQ(c->primitive().attributes->surface->params[0].name, "Kd");
    EXPECT_EQ(c->primitive().attributes->displacement->name, "dented");
    auto connected = inWorld(layers + "ConnectShaderLayers \"surface\" \"one\" \"Cout\" \"two\" \"Cs\"\nSphere 1 -1 1 360");
    EXPECT_NE(connected->only().message.find("\"Cs\" of the layer \"two\""), std::string::npos) << connected->messages();
    EXPECT_EQ(inWorld("ShaderLayer \"colour\" \"matte\" \"a\" Sphere 1 -1 1 360")->only().code, Rie::BadToken);
}

TEST(Foreign, ArchiveOfAProcedure) {
    auto c = read("ArchiveBegin \"part.rib\"\nColor 0 1 0\nSphere 1 -1 1 360\nArchiveEnd\n"
                  "WorldBegin\nProcedural2 \"DelayedReadArchive2\" \"SimpleBound\" \"float[6] bound\" [-1 1 -1 1 -1 1] \"string "
                  "filename\" [\"part.rib\"]\n"
                  "Sphere 2 -2 2 360\nWorldEnd\n");
    ASSERT_EQ(c->frame().primitives.size(), 2u) << c->messages();
    EXPECT_EQ(c->frame().primitives[0]->attributes->color, Color(0, 1, 0));
    EXPECT_NE(c->frame().primitives[1]->attributes->color, Color(0, 1, 0)); // its attributes stay its own
    EXPECT_EQ(c->count(), 0u) << c->messages();
}

} // namespace recovery_test
