/* volumes and imagers in one file, hardly a blank */
volume airstyle(float a=1;color b=.5){float d;d=1-exp(-a*length(I));Ci=mix(Ci,b*ambient(),d);Oi=mix(Oi,1,d);Ci+=color noise(P)*0;
 point p0 = P - I; float i; illuminance(P - I/2, vector(0,0,1), PI) Ci += Cl*.01; }
imager f(color bg=0){Ci+=(1-alpha)*bg;Oi=1;alpha=1;}
imager g(){ float x=xcomp(P); if(mod(x,2)<1) Ci=Ci*.9; }
transformation h(float k = 1) { P = P * k; }
