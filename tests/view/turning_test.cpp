// What a view shows while its camera is turned.
#include "session.h"

namespace session_test {

// A wall behind the eye, which the picture under `hidden` does not need: from the other side of the sphere it is all around.
TEST_F(ViewSession, WhatLiesOutsideIsThereWhileTheCameraTurns) {
    scene = with(kScene, "WorldBegin\n", "WorldBegin\nPatch \"bilinear\" \"P\" [-90 -90 -9 90 -90 -9.1 -90 90 -9 90 90 -9]\n");
    scene = with(scene, "\"path\"", "\"hidden\"");
    ASSERT_TRUE(open(false, {{"continuous", false}, {"spp", 4}}));
    const auto corner = [](const Picture& p) {
        const display::Image& i = *p.planes[0].image;
        return i.pixel(0, 0)[i.channel("a")];
    };
    EXPECT_EQ(corner(*done()), 0);
    EXPECT_EQ(session->act({{"do", "camera"}, {"orbit", {180, 0}}, {"drag", true}}), Json({{"ok", true}}));
    EXPECT_TRUE(until([&] {
        const auto picture = session->look("picture").picture;
        return picture && picture->plane("picture") && corner(*picture) > 0.9f;
    }));
}

} // namespace session_test
