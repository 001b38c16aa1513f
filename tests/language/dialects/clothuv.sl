surface clothuv
	( float
		Ka		= .1,
		Kd		= .8,
		threads		= 100,
		ratio		= .5
	; color	warp		= (.2,.2,.7)
	; color	weft		= (.7,.2,.2)
	; varying float fade = 1
	)
{
#ifdef PREVIEW
	Ci = Cs;
#elif defined (FINAL) && QUALITY >= 3 || 0x10 == 16
	float du_ = abs (Du (s) * du) + abs (Dv (s) * dv)
	, dv_ = abs (Du (t) * du) + abs (Dv (t) * dv)
	, x = mod (s * threads, 1)
	, y = mod (t * threads, 1)
	;
	float a = filterstep (ratio, x) , b = filterstep (ratio, y, "filter", "gaussian") ;
	Ci = mix (warp, weft, a * (1 - b)) * fade ;
	if (max (du_, dv_) * threads > 1) Ci = (warp + weft) / 2 ;
	Ci *= Ka * ambient () + Kd * diffuse (faceforward (normalize (N), I)) ;
#else
# error no quality
#endif
	Oi = Os ; Ci *= Os ;
}
