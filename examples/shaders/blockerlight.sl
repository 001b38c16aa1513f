/* blockerlight: a point light with a blocker: a box in a space of its own that takes light away, as a flag does on a stage. The box need not
   exist in the scene, and shades what it is told to shade only.
     blockerspace   coordinate system of the box, the cube from -1 to 1; "" for none
     edge           softness of its shadow
     density        how much it takes
   Ball: TransformBegin Translate -.75 1.0 -1.0 Scale .22 .22 .22 CoordinateSystem "cube" TransformEnd LightSource "blockerlight" 1 "point from" [-3 4 -4] "float intensity" 45 "string blockerspace" "cube" */
light blockerlight(
    float intensity = 1, density = .9, edge = .3; color lightcolor = 1;
    point from = point "shader" (0, 0, 0); string blockerspace = "";
    output varying float blocked = 0;)
{
    illuminate(from) {
        Cl = intensity * lightcolor / (L . L);
        if (blockerspace != "") {
            /* The way from light to point against the slabs of the box. */
            point a = transform(blockerspace, from), b = transform(blockerspace, Ps);
            float start[3] = {xcomp(a), ycomp(a), zcomp(a)}, end[3] = {xcomp(b), ycomp(b), zcomp(b)};
            float tnear = 0, tfar = 1, miss = 0, i;
            for (i = 0; i < 3; i += 1) {
                float o = start[i], d = end[i] - start[i];
                if (abs(d) < 1e-6) {
                    miss = max(miss, step(1, abs(o)));
                } else {
                    float t0 = (-1 - o) / d, t1 = (1 - o) / d;
                    tnear = max(tnear, min(t0, t1));
                    tfar = min(tfar, max(t0, t1));
                }
            }
            /* How long it is inside says how much it loses: soft at the edges. */
            float inside = max(0, tfar - tnear) * distance(a, b);
            blocked = density * (1 - miss) * smoothstep(0, edge, inside);
            Cl *= 1 - blocked;
        }
    }
}
