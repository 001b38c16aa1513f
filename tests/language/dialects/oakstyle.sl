#include "patterns.h"
#include "filterwidth.h"
#include "noises.h"
#include "material.h"
/* in the manner of the advanced books: oak, screen aa, shading tiles */
float oakgrain(point Pshad; float ringfreq, ringunevenness, ringnoise, ringnoisefreq, grainfreq, varnish) {
  point p = Pshad;
  vector offset = vfBm(p*ringnoisefreq, filterwidthp(p*ringnoisefreq), 2, 4, .5);
  point Pring = p + ringnoise*offset;
  Pring += (.3 * vsnoise(.15*Pring)) * vector (1,1,0);
  float r2 = sqr(xcomp(Pring)) + sqr(ycomp(Pring)); float r = sqrt(r2)*ringfreq;
  r += ringunevenness * snoise(r);
  float inring = smoothpulsetrain(.1, .55, .7, .95, 1, r);
  point Pgrain = Pshad * grainfreq * point(1,1,.05);
  float dPgrain = filterwidthp(Pgrain); float i, amp = 1, grain = 0;
  if (dPgrain < .2) for (i = 0; i < 2; i += 1) { float g1isolines = snoise(Pgrain); if (g1isolines > .2) grain += amp; Pgrain *= 2; dPgrain *= 2; amp *= .5; }
  return mix(inring, 1, .1) * (1 - .2*grain);
}
surface oakstyle(float Ka = 1, Kd = .75, Ks = .15, roughness = .2; color Clight = color (.5,.2,.067), Cdark = color(.15,.077,.028);
   DECLARE_DEFAULTED_ENVPARAMS)
{
  point p = transform("shader", P);
  float wood = oakgrain(p, 8, .5, .02, 1, 25, .5);
  color Ct = mix(Clight, Cdark, wood); normal Nf = faceforward(normalize(N), I);
  float sswidth = filterwidth(s), x = filteredpulse(.1,.4,s,sswidth) + filteredsmoothstep(.2,.6,t,filterwidth(t)) + filteredabs(s-.5, sswidth);
  Ci = MaterialPlastic(Nf, Ct, Ka, Kd, Ks*(1-wood), roughness) + 0 * SampleEnvironment(P, reflect(normalize(I),Nf), .3, 0, ENVPARAMS) + 0*x;
  Oi = Os; Ci *= Oi;
}
