/* warns: varying-to-uniform */
volume
layeredmist(float density = .05, lo = 0, hi = 2, step = .5, maxsteps = 20;
	color mist = color (.7,.75,.8);
	string space = "world")
{
	float d = length(I), at, dens, y, taken = 0, i = 0;
	color acc = 0, trans = 1;
	vector In = normalize(I);
	point org = P - I;
	uniform float st = max(step, d / maxsteps);
	at = st * random();
	while (at < d) {
		point Q = transform(space, org + at * In);
		y = ycomp(Q);
		dens = density * (1 - smoothstep(lo, hi, y)) * (.5 + noise(Q));
		color li = 0;
		illuminance(org + at * In) { li += Cl; }
		color o = 1 - exp(-dens * st);
		acc += trans * o * mist * li;
		trans *= 1 - o;
		at += st;
		i += 1;
	}
	Ci = acc + trans * Ci;
	Oi = 1 - trans * (1 - Oi);
}
