/* Old style: everything is a point, K&R spacing, nothing declared uniform. */
#define snoise(x) (2 * noise (x) - 1)
#define boxstep(a,b,x) clamp(((x)-(a))/((b)-(a)),0,1)
#define MAXOCT 8
surface
easyocean (
	float Ka = 1, Kd = .5, Ks = .8, roughness = .05;
	float freq = 4., octaves = 5.;
	color deep = color "rgb" (.05, .1, .2);
	color shallow = color "hsv" (.5, .6, .7);
	point wind = point "world" (1, 0, 0)
	)
{
	point Nf, V, PP, dir;
	float i, amp, sum, f;
	color Ct;

	PP = transform ("shader", P) * freq;
	dir = normalize (wind);
	sum = 0; amp = 1; f = 1;
	for (i = 0; i < octaves; i = i + 1) {
		sum += amp * abs (snoise (PP * f + dir * i));
		amp *= .5; f *= 2;
	}
	sum = boxstep (0, 1, sum);
	Nf = faceforward (normalize (N + sum * .1 * (dPdu + dPdv)), I);
	V = -normalize (I);
	Ct = mix (deep, shallow, sum) * Cs;
	Oi = Os;
	Ci = Oi * (Ct * (Ka * ambient () + Kd * diffuse (Nf)) + Ks * specular (Nf, V, roughness));
}
