/* warns: varying-to-uniform */
light shadowy(
	float intensity = 1; color lightcolor = 1;
	string shadowmap_px = "", shadowmap_nx = "", shadowmap_py = "", shadowmap_ny = "", shadowmap_pz = "", shadowmap_nz = "";
	float width = 1, samples = 16; output float __nondiffuse = 0; output float __nonspecular = 0; output color __shadowC = 0; string __category = "";)
{
	float lighted = 1, x, y, z, ax, ay, az, decay = 2;
	vector lv;
	illuminate(point "shader" (0,0,0)) {
		lv = vtransform("world", L);
		x = xcomp(lv); y = ycomp(lv); z = zcomp(lv);
		ax = abs(x); ay = abs(y); az = abs(z);
		if (ax >= ay && ax >= az) {
			if (x >= 0 && shadowmap_px != "") lighted -= shadow(shadowmap_px, Ps, "samples", samples, "swidth", width, "twidth", width);
			else if (shadowmap_nx != "") lighted -= shadow(shadowmap_nx, Ps, "samples", samples, "swidth", width, "twidth", width);
		} else if (ay >= az) {
			if (y >= 0 && shadowmap_py != "") lighted -= shadow(shadowmap_py, Ps);
			else if (shadowmap_ny != "") lighted -= float shadow(shadowmap_ny, Ps);
		} else {
			if (z >= 0 && shadowmap_pz != "") lighted -= shadow(shadowmap_pz[0], Ps, "bias", 0.01);
			else if (shadowmap_nz != "") lighted -= shadow(shadowmap_nz, Ps);
		}
		__shadowC = 1 - lighted;
		Cl = intensity * lightcolor * lighted * pow(length(L), -decay);
	}
}
