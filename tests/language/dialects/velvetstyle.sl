/* anisotropic, skin-like, velvet */
#include "filterwidth.h"
color LocIllumAniso(normal N; vector V; vector xdir; float xr, yr) {
  extern point P; color C = 0; vector X = xdir / xr; vector Y = (N ^ xdir) / yr;
  illuminance(P, N, PI/2) { extern vector L; extern color Cl; vector LN = normalize(L); vector H = normalize(V+LN);
    float rho = exp(-2*(((X.H)*(X.H)+(Y.H)*(Y.H))/(1+H.N))) / sqrt((LN.N)*(V.N)); C += Cl * ((LN.N) * rho); }
  return C / (4*xr*yr);
}
color velvet(normal N; vector V; float roughness, backscatter, edginess; color sheen)
{
  extern point P; color C = 0; float cosine, sine;
  illuminance(P, N, 1.57079632679489661923) {
    vector H = normalize(normalize(L) + V);
    cosine = max(normalize(L) . V, 0);
    C += pow(cosine, 1.0/roughness) / (N.normalize(L)) * Cl * sheen * backscatter;
    cosine = max(N.V, 0); sine = sqrt(1.0 - cosine*cosine);
    C += pow(sine, edginess) * (normalize(L).N) * Cl * sheen;
  }
  return C;
}
surface velvetstyle(float Ka = .05, Kd = .05, Ks = .1; color sheen = .25; float roughness = .1)
{
  normal Nf = faceforward(normalize(N),I); vector V = -normalize(I);
  color lite = Ka*ambient() + Kd*diffuse(Nf);
  lite += velvet(Nf, V, roughness, .25, 10, sheen) + Ks*LocIllumAniso(Nf, V, normalize(dPdu), .1, .4);
  Oi = Os; Ci = Os * Cs * lite * filterwidth(u);
}
