/* PxrVisualizer: what the integrator of that name shows of all surfaces, of RIS: style shaded (lit from the eye), flat (plain), normals, bumpednormals, st, objectnormals. Not done: wireframe, matcap. */
surface PxrVisualizer(string style = "shaded", matCap = ""; float wireframe = 1, normalCheck = 0; color wireframeColor = 0; float wireframeOpacity = .5, wireframeWidth = 1) {
    normal n = normalize(N);
    float facing = abs(n . normalize(I));
    Oi = 1;
    if (style == "normals" || style == "bumpednormals") Ci = .5 + .5 * color(xcomp(ntransform("world", n)), ycomp(ntransform("world", n)), zcomp(ntransform("world", n)));
    else if (style == "objectnormals") Ci = .5 + .5 * color(xcomp(ntransform("object", n)), ycomp(ntransform("object", n)), zcomp(ntransform("object", n)));
    else if (style == "st") Ci = color(mod(s, 1), mod(t, 1), 0);
    else if (style == "flat") Ci = Cs;
    else Ci = Cs * facing * .8;
}
