surface screen_door(float Ka=1,Kd=.75,Ks=.4,roughness=.1;
   color specularcolor=1;
   float density=.25,frequency=20;) {
  point Nf,V;
  varying float d;
  Nf=faceforward(normalize(N),I); V=normalize(-I);
  if( mod(s*frequency,1)<density||mod(t*frequency,1)<density ) d=1; else d=0;
  Oi=d;
  if(d>0) { Ci=Oi*(Cs*(Ka*ambient()+Kd*diffuse(Nf))+specularcolor*Ks*specular(Nf,V,roughness)); }
  else Ci=0;
}