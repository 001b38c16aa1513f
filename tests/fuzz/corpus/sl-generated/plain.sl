surface z(float Kx = 1; color Cx = 1;) { float f = noise(4 * P) + Du(s); Ci = f * Cx; Oi = Os; }
