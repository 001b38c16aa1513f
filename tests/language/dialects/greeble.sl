/* displacement with bound parameters and nested macros of macros */
#define LERP(a,b,x) ((a)+((b)-(a))*(x))
#define BEVEL(x,w) (smoothstep(0,(w),(x))-smoothstep(1-(w),1,(x)))
#define CELL(x,f) floor((x)*(f))
#define LOCAL(x,f) ((x)*(f)-CELL(x,f))
#define HASH2(i,j) cellnoise((i)+.5,(j)+.5)
displacement greeble ( uniform float Km = .1, freqS = 12, freqT = 8, layers_=3, bevel=.1;
	float __displacementbound_sphere = 0.2;
	string __displacementbound_coordinatesystem = "shader"; )
{
	float h = 0, k, f = 1, a = 1;
	normal Nn = normalize(N);
	for (k = 0; k < layers_; k += 1) {
		float i = CELL(s, freqS*f), j = CELL(t, freqT*f);
		float x = LOCAL(s, freqS*f), y = LOCAL(t, freqT*f);
		if (HASH2(i, j) > LERP(.3, .7, k/layers_))
			h += a * BEVEL(x, bevel) * BEVEL(y, bevel) * HASH2(j, i);
		f *= 2; a /= 2;
	}
	P += Km * h * Nn / length(vtransform("shader", Nn));
	N = normalize(calculatenormal(P)) + (normalize(N) - normalize(Ng));
}
