// Houdini/VEX exporter manner: generated names, one assignment a line, temporaries by number
surface vop_material_1(
	string name_1 = "default.rat";
	float vop_rough1 = 0.3 ;
	color vop_diff1 = color ( 0.8 , 0.8 , 0.8 ) ;
	float lyr_blend[ 3 ] = { 0.5 , 0.25 , 0.125 } ;
	)
{
	/* Code produced by: parameter1 */
	point P1 = P ;
	normal n1 = normalize ( N ) ;
	vector i1 = normalize ( I ) ;
	normal ff1 = faceforward ( n1 , i1 , n1 ) ;
	float tmp1 ; color tmp2 ; vector tmp3 ; string tmp4 ; matrix tmp5 ;
	tmp1 = ff1 . ( - i1 ) ;
	tmp2 = diffuse ( ff1 ) ;
	tmp3 = vector ( 0.0 , 0.0 , 1.0 ) ;
	tmp4 = name_1 ;
	tmp5 = matrix ( 1 , 0 , 0 , 0 , 0 , 1 , 0 , 0 , 0 , 0 , 1 , 0 , 0 , 0 , 0 , 1 ) ;
	color outclr = ( 0 , 0 , 0 ) ;
	{
		float sum1 ;
		sum1 = lyr_blend [ 0 ] + lyr_blend [ 1 ] * lyr_blend [ 2 ] ;
		outclr = vop_diff1 * tmp2 * sum1 ;
	}
	if ( tmp4 != "" )
	{
		outclr *= color texture ( tmp4 , s , t , "fill" , 1.0 ) ;
	}
	tmp3 = vtransform ( tmp5 , tmp3 ) ;
	outclr += specular ( ff1 , - i1 , vop_rough1 ) * tmp1 * comp ( outclr , 1 ) ;
	outclr += 0 * length ( tmp3 ) * length ( P1 ) ;
	Oi = Os ;
	Ci = outclr * Oi ;
}
