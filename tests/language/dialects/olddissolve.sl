/* opacity tricks, random, cellnoise with two, names like types */
surface dissolve (float amount = .5, scale = 10; string noisetype = "perlin"; )
{
	vector vector = I; normal normal = N; 
	float type = 0; color mask; point position = transform("object", P);
	string perlin = "per" "lin";
	if (noisetype == perlin) type = noise(position*scale);
	else if (noisetype == "cell") type = cellnoise(s*scale, t*scale);
	else if (noisetype == "pnoise") type = float pnoise(position*scale, point(4,4,4));
	else type = random();
	mask = (type < amount) ? color(0) : color(1);
	if (mask == color(0)) { Oi = 0; Ci = 0; }
	else { Oi = Os * mask; Ci = Oi * Cs * diffuse(faceforward(normalize(normal), vector)); }
}
