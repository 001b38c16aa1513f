/* Aqsis test manner: odd but legal */
surface s_test( float a[3] = {1,2,3}; color c = color "hsv" ( 0.5, 1, 1 ); point p = point "shader" ( 1, 2, 3 ), q = 0; )
{
    uniform float x = 1, y = 2;
    varying float z = x < y;
    float b[4]; b[0] = b[1] = b[2] = b[3] = 1;
    if( x == 1 && ( y != 1 || !( z == 0 ) ) ) z += 1;
    float w = ( x < y ) + ( y < x ) * 2;
    color d = ( x > y ) ? c : 1;
    point r = p + q * 2 - (vector (1,1,1));
    r = -p; r = - - p; r = -(p + q);
    vector e = p - q, f = p ^ q, g = -N;
    w = e . f + e.g - -1;
    w = -w * -z / -x;
    w += 1; w -= .5; w *= 2; w /= 4;
    e += g; e *= 2; e /= g; d *= c; d /= 2; d -= c;
    if (r == p || e != g) w = 0;
    if (d > c) w = 1; else if (p <= q) w = 2;
    string st = "a" ; if ( st == "a" && "b" != st ) w += 3;
    printf( "%f %p %c %s\n", w, r, d, st );
    Ci = d * w * comp( c, 0 ) * b[ floor( mod( u * 4, 4 ) ) ] + a[ 1 ] + z; Oi = Os;
}
