/* Greg Ward's model as people wrote it down in the nineties, illuminance over everything */
#define SQR(A) ((A)*(A))
color
LocIllumWardAnisotropic (normal Nn; vector V;
			 vector xdir;
			 float xroughness, yroughness;)
{
    float cos_theta_r = clamp (Nn.V, 0.0001, 1);
    vector X = xdir / xroughness;
    vector Y = (Nn ^ xdir) / yroughness;

    color C = 0;
    extern point P;
    illuminance (P, Nn, PI/2) {
	extern vector L;  extern color Cl;
	float nonspec = 0;
	lightsource ("__nonspecular", nonspec);
	if (nonspec < 1) {
	    vector LN = normalize (L);
	    float cos_theta_i = LN . Nn;
	    if (cos_theta_i > 0.0) {
		vector H = normalize (V + LN);
		float rho = exp (-2 * (SQR(X.H) + SQR(Y.H)) / (1 + H.Nn))
		    / sqrt (cos_theta_i * cos_theta_r);
		C += Cl * ((1-nonspec) * cos_theta_i * rho);
	    }
	}
    }
    return C / (4 * xroughness * yroughness);
}
surface wardbrushed (float Ka = 1, Kd = 0.1, Ks = 1;
		float xroughness = 0.3, yroughness = 0.05;
		color specularcolor = 1;)
{
    normal Nf = faceforward (normalize(N), I);
    vector xdir = normalize (dPdu);
    Ci = Cs * (Ka*ambient() + Kd*diffuse(Nf))
	+ specularcolor * Ks * LocIllumWardAnisotropic (Nf, -normalize(I), xdir, xroughness, yroughness);
    Oi = Os;  Ci *= Oi;
}
