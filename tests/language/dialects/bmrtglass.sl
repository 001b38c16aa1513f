/* BMRT manner: ray tracing functions and its own include */
#include "filterwidth.h"
#include "noises.h"
surface
bmrt_glass ( float Ka = 0.2, Kd = 0, Ks = 0.5;
	     float Kr = 1, krough = 0, envsamples = 1;
	     float Kt = 1, troughness = 0;
	     color transmitcolor = 1;
	     float eta = 1.5, samples = 1; )
{
    normal Nf;
    vector IN, R, T, Rfldir, Rfrdir, uoffset, voffset;
    color ev, cr;
    float kr, kt, i, j;

    IN = normalize (I);
    Nf = faceforward (normalize(N), I);
    fresnel (IN, Nf, (I.N < 0) ? 1.0/eta : eta, kr, kt, R, T);
    kt = 1 - kr;
    Rfldir = normalize (R); Rfrdir = normalize (T);
    ev = 0; cr = 0;
    if (kr*Kr > 0.001) {
	if (krough > 0) {
	    uoffset = krough * normalize (vector (zcomp(Rfldir) - ycomp(Rfldir),
						  xcomp(Rfldir) - zcomp(Rfldir),
						  ycomp(Rfldir) - xcomp(Rfldir)));
	    voffset = Rfldir ^ uoffset;
	    for (i = 0;  i < samples;  i += 1) {
		for (j = 0;  j < samples;  j += 1) {
		    R = Rfldir + ((i + float random())/samples - 0.5) * uoffset +
			((j + float random())/samples - 0.5) * voffset;
		    ev += trace (P, normalize(R));
		}
	    }
	    ev *= Kr*kr / (samples*samples);
	} else ev = Kr*kr * trace (P, Rfldir);
    }
    if (kt*Kt > 0.001 && rayinside_ () == 0)
	cr = Kt*kt * trace (P, Rfrdir);
    Oi = Os;
    Ci = (Cs * (Ka*ambient() + Kd*diffuse(Nf)) + ev + transmitcolor*cr + Ks*specular(Nf,-IN,.1));
}
float rayinside_() { return 0; }
