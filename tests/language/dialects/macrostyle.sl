/* directives and macros as people wrote them */
#define MIX3(a,b,c,t) (t<.5 ? mix(a,b,2*t) : mix(b,c,2*t-1))
#define LOOP(i,n) for(i=0;i<n;i+=1)
#define DEBUG(x) /* printf x */
#define VAR(T,n) T n
#define CAT(a,b) a##b
#define STR(a) #a
#ifdef NEVER
this isn't code at all "unterminated
#endif
#if 0
'
#elif 1 && !defined(NEVER)
#endif
void swap(output float a, b) { float t2 = a; a = b; b = t2; }
void orthobasis(vector n; output vector a; output vector b;) { a = normalize(n ^ vector(0,1,0.01)); b = n ^ a; }
color vary(color c; float k) { color h = ctransform("hsv", c); setcomp(h, 0, mod(comp(h,0)+k,1)); return ctransform("hsv","rgb",h); }
surface macrostyle(float Kd = .5 ; color A = (1,0,0), B = color(0,1,0), C = 0.5 ; VAR(float,zz) = 1;)
{
  uniform float i; float x = 1, y = 2; vector a1, b1;
  color CAT(my,Col) = 0;
  LOOP(i, 4) { myCol += MIX3(A,B,C,i/4); DEBUG(("hi")) }
  swap(x, y);
  orthobasis(vector N, a1, b1);
  float PHI = (1 + sqrt(5)) / 2, pi = PI;
  string nm = STR(hello);
  Ci = vary(myCol, .1) * (nm == "hello" ? 1 : 0) * pi;
  Oi = x/y;
  return;
}
