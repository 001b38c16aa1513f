surface
rdc_cracks
	(
	float	Ka		= 1;
	float	Kd		= 0.5;
	float	Ks		= 0.5;
	float	roughness	= 0.1;
	color	specularcolor	= 1;
	string	crackspace	= "object";
	uniform float crackfreq	= 4.0;
	)
	{
	varying point	pt, cracks_near, Nf;
	varying color	color_1, color_2;
	varying float	f_1, edge, i, j;
	uniform string	coordsys	= crackspace;

	pt	= crackfreq * transform (coordsys, P);
	edge	= 10;
	for (i = -1; i <= 1; i += 1)
		{
		for (j = -1; j <= 1; j += 1)
			{
			cracks_near	= point cellnoise (xcomp (pt) + i, ycomp (pt) + j) + point (floor (xcomp (pt)) + i, floor (ycomp (pt)) + j, 0);
			f_1	= distance (point (xcomp (pt), ycomp (pt), 0), point (xcomp (cracks_near), ycomp (cracks_near), 0));
			if (f_1 < edge) edge = f_1;
			}
		}
	color_1	= Cs;
	color_2	= Cs * 0.3;
	Nf	= faceforward (normalize (N), I);
	Oi	= Os;
	Ci	= Os * mix (color_2, color_1, smoothstep (0, 0.2, edge)) * (Ka * ambient () + Kd * diffuse (Nf))
		+ Ks * specularcolor * specular (Nf, -normalize (I), roughness);
	}
