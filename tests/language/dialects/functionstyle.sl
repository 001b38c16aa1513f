/* user functions with odd signatures */
float max4(float a,b,c,d) { return max(max(a,b),max(c,d)); }
max3(float a, b, c) { return max(a, b, c); }
void nothing() { }
void both(float a; output float b; output varying color c;) { b = a; c = a; }
color tint(uniform float w[3]; color c) { return c * w[0]; }
uniform float unif(uniform float a) { return a * 2; }
string pick(float a; string x, y) { string r = y; if (a > 0) r = x; return r; }
float withexterns() { extern float s, t; extern point P; extern uniform float Kd; return s + t + Kd; }
extern float ext(float a) { return a; }
surface functionstyle(uniform float Kd = 1; float w[3] = {1,1,1})
{
  float inner(float a) { extern color Cs; extern float Kd; return a * Kd + comp(Cs,0); }
  color loc; float b;
  both(max3(1,2,3), b, loc); nothing();
  Ci = tint(w, loc) + max4(1,2,3,b) + unif(2) + withexterns() + inner(2) + ext(1);
  string p = pick(1, "a", "b");
  Oi = (p == "a") ? 1 : 0;
}
