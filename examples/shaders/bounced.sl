/* bounced: light that has gone to and fro between surfaces, by point clouds: a frame bakes what surfaces send ("to"), the next
   one looks at that in place of sending rays ("from"). See examples/bleeding.rib and docs/pointclouds.md. */
surface bounced(uniform string from = "", to = ""; uniform float maxsolidangle = 0.1; uniform float occluded = 0;)
{
    normal n = normalize(N);
    normal nf = faceforward(n, I);
    color sent = Cs * diffuse(nf);
    if (occluded != 0)
        sent = 1 - occlusion(P, nf, 1, "pointbased", 1, "filename", from, "maxsolidangle", maxsolidangle);
    else if (from != "")
        sent += Cs * indirectdiffuse(P, nf, 1, "pointbased", 1, "filename", from, "maxsolidangle", maxsolidangle);
    if (to != "")
        bake3d(to, "", P, nf, "interpolate", 1, "_radiosity", sent);
    Oi = 1;
    Ci = sent;
}
