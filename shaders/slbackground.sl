/* slbackground: the background of SLProject's scenes: a colour, a gradient, four corners or a picture, for all rays that leave the scene.
   bgcolor times what the corners give, between them linearly, times the picture mapname. Equal corners of a side make a gradient. Camera rays see it
   over the picture, the others by direction: corners by height and turn about y of "world", the picture by latitude and longitude about z of
   mapspace (or as a cube map). A light of "path"; under "hidden" and "raytrace" only rays see it. docs/design/slproject.md.
   Ball: LightSource "slbackground" 1 "color topleft" [.2 .4 .8] "color topright" [.2 .4 .8] */
light slbackground(color bgcolor = 1, bottomleft = 1, bottomright = 1, topleft = 1, topright = 1; string mapname = "", mapspace = "world";) {
    solar() {
        vector w = normalize(vtransform("world", -L));
        float x = mod(atan(xcomp(w), -zcomp(w)) / (2 * PI) + .5, 1), y = asin(clamp(ycomp(w), -1, 1)) / PI + .5;
        string kind = "";
        float way = 1, seen = 0;
        rayinfo("type", kind);
        rayinfo("length", way); /* 0: the ray has met nothing; else it is the one that met what is lit */
        if (kind == "camera" && way == 0) {
            point far = transform("NDC", Ps - 1e5 * normalize(L));
            x = clamp(xcomp(far), 0, 1);
            y = clamp(1 - ycomp(far), 0, 1);
            seen = 1;
        }
        Cl = bgcolor * mix(mix(bottomleft, bottomright, color(x)), mix(topleft, topright, color(x)), color(y));
        if (mapname != "") {
            if (seen == 1)
                Cl *= color texture(mapname, x, 1 - y);
            else
                Cl *= color environment(mapname, vtransform(mapspace, -L));
        }
    }
}
