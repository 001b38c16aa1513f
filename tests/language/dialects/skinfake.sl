surface skin_wax(
float Ka = 1.0;
float Kd = 0.6;
float Ks = 0.1;
float subfreq = 30;
float eta = 1.0/1.4;
float thickness = 0.5;
color skincolor = color "rgb" (0.85,0.65,0.55);
color sheencolor = color "rgb" (1,.9,.8);
string sheenmap = "";)
{
  float phase(vector In, Out; float g) {
    float costheta = -In . Out;
    return (1 - g*g) / pow(1 + g*g - 2*g*costheta, 1.5);
  }
  color singleScatter(vector In, Out; normal Nx; float eta_, g, thick; color albedo) {
    float wi = abs(In.Nx), wo = abs(Out.Nx);
    float sc = phase(In, Out, g) * (1 - exp(-(1/wi + 1/wo)*thick)) / max(wi + wo, 1e-3);
    return albedo * sc;
  }
  extern vector I;
  normal Nn = normalize(N);
  vector V = -normalize(I), T, R;
  float Kr, Kt;
  color C = 0, sheen = sheencolor;
  fresnel(normalize(I), faceforward(Nn, I), eta, Kr, Kt, R, T);
  if (sheenmap != "") sheen *= texture(sheenmap);
  illuminance(P, Nn, PI/2) {
    vector Ln = normalize(L), H = normalize(Ln + V), T2, R2;
    float Kr2, Kt2;
    if (Nn.H > 0) C += Kr * sheen * Cl * (Ln.Nn) * pow(Nn.H, 4);
    fresnel(-Ln, Nn, eta, Kr2, Kt2, R2, T2);
    C += skincolor * Cl * (Ln.Nn) * Kt * Kt2 *
      (singleScatter(T2, T, Nn, eta, .8, thickness, skincolor) +
       singleScatter(T2, T, Nn, eta, .3, thickness, color(.95, .8, .85)) +
       singleScatter(T2, T, Nn, eta, 0., thickness, color(1., .4, .4)));
  }
  Ci = C*Kd + skincolor*Ka*ambient() + Ks*specular(Nn, V, .3); Oi = Os; Ci *= Oi;
}
