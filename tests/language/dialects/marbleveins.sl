/*
 * veins.sl -- RSL 1 with nested comment signs // inside, spline of colours, point arithmetic
 */
surface veins(float Ks=.4,Kd=.6,Ka=.1,roughness=.1,txtscale=1;color specularcolor=1)
{
#define PALE_BLUE       color (0.25, 0.25, 0.35)
#define MEDIUM_BLUE     color (0.10, 0.10, 0.30)
#define DARK_BLUE       color (0.05, 0.05, 0.26)
#define DARKER_BLUE     color (0.03, 0.03, 0.20)
#define NNOISE          4
    color Ct;
    point NN, PP;
    float csp, f, turb, pixelsize, scale, twice, weight;
    NN = normalize(faceforward(N, I));
    PP = transform("shader", P) * txtscale;
    pixelsize = sqrt(area(PP)); twice = 2*pixelsize;
    turb = 0;
    for (scale = 1; scale > twice; scale /= 2)
        turb += scale * noise(PP/scale);
    if (scale > pixelsize) {
        weight = (scale / pixelsize) - 1;
        weight = clamp(weight, 0, 1);
        turb += weight * scale * noise(PP/scale);
    }
    csp = clamp(4*turb - 3, 0, 1);
    Ci = color spline(csp,
      PALE_BLUE,  PALE_BLUE,
      MEDIUM_BLUE, MEDIUM_BLUE, MEDIUM_BLUE,
      PALE_BLUE,  PALE_BLUE,
      DARK_BLUE,  DARK_BLUE,
      DARKER_BLUE, DARKER_BLUE,
      PALE_BLUE,  DARKER_BLUE);
    Oi = Os;
    Ci = Os * (Ci*(Ka*ambient() + Kd*diffuse(NN)) + specularcolor*Ks*specular(NN,normalize(-I),roughness));
}
