/* translucent: marble, skin, wax: light from below the surface, under a highlight. What is below is said by Attribute "subsurface".
   model: "walk", "jensen" or "grosjean".
   Ball: Attribute "subsurface" "color reflectance" [.75 .5 .38] "color meanfreepath" [1.4 .7 .45] "float scale" 12 Surface "translucent" */
surface translucent(string model = "walk"; float Ks = .15, roughness = .15;) {
    normal Nf = faceforward(normalize(N), I);
    Oi = 1;
    Ci = (1 - Ks) * subsurface(P, Nf, "model", model) + Ks * specular(Nf, -normalize(I), roughness);
}
