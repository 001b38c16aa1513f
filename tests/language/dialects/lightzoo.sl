light
gobo_spot( float  intensity = 1;
	   color  lightcolor = 1;
	   point  from = point "shader" (0,0,0);	/* light position */
	   point  to   = point "shader" (0,0,1);
	   float  coneangle = radians(30);
	   float  conedeltaangle = radians(5);
	   float  beamdistribution = 2;
	   string gobo = "", shadowname = "";
	   float  samples = 16, blur = 0, bias = -1;
	 )
{
    float  atten, cosangle;
    uniform point  A = (to - from) / length(to - from);
    uniform float  outer = cos(coneangle), inner = cos(coneangle - conedeltaangle);
    color c = lightcolor;

    illuminate( from, A, coneangle ) {
	cosangle = (L . A) / length(L);
	atten = pow(cosangle, beamdistribution) / (L . L);
	atten *= smoothstep( outer, inner, cosangle );
	if( gobo != "" ) {
	    point Pl = transform("shader", Ps);
	    float ss = xcomp(Pl)/zcomp(Pl), tt = ycomp(Pl)/zcomp(Pl);
	    c *= color texture(gobo, ss, tt);
	}
	if( shadowname != "" )
	    atten *= 1 - shadow( shadowname, Ps, "samples", samples, "blur", blur, "bias", bias );
	Cl = atten * intensity * c;
    }
}
