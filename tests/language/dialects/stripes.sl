surface stripes
(
  float Ka = 1.0,
        Kd = 1.0,
        Ks = 0.5,
        roughness = 0.1,
        txtscale = 1.0,
        numstripes = 7
  ;
  color stripeColor[7] = { color(1,0,0), color(1,.5,0), (1,1,0), color "hsv" (.33,1,1), 
                           color(0,0,1), .5, color (.5,0,1) },
        specularcolor = 1 ;
  string axis = "t" ;
)
{
  normal Nf = normalize( faceforward( N, I )) ;
  float v0 ;
  uniform float n ;
  color Ct ;

  if( axis == "t" ) v0 = t ;
  else if( axis == "s" ) v0 = s ;
  else if( axis == "u" ) v0 = u ;
  else v0 = v ;

  v0 = mod( v0 * numstripes * txtscale, numstripes ) ;
  Ct = stripeColor[ 0 ] ;
  for( n = 1 ; n < numstripes ; n += 1 )
    if( v0 >= n ) Ct = stripeColor[ n ] ;

  Oi = Os ;
  Ci = Oi * Ct * ( Ka * ambient( ) + Kd * diffuse( Nf ) )
     + specularcolor * Ks * specular( Nf, -normalize( I ), roughness ) ;
}
