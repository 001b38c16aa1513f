/*
 * stars.sl -- a sky of stars, for the inside of a big sphere.
 * old style header comment: don't mind the apostrophe
 */
#define snoise(Pt) (2 * noise(Pt) - 1)
surface
starfield (
  float frequency = 0.5,
        intensity = 3;
  color cloudcolor = 0;
)
{
  point PP;
  color C;
  float val, index, i;

  PP = frequency * transform("shader", P);
  val = pow(noise(PP), intensity);
  C = cloudcolor + val;
  for (i = 0; i < 3; i += 1) C += color (val, val, val) * snoise(PP * pow(2, i)) * 0.01;
  setcomp(C, 2, comp(C, 2) * 1.1);
  Ci = C; Oi = 1;
}
