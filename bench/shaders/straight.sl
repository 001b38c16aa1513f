// The least a shader can do: what a point costs before any work.
surface straight() { Ci = color(u, v, u * v); Oi = 1; }
