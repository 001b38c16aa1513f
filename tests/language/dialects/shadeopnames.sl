/* variables with the names of shadeops */
surface shadeopnames(float Ka = 1; float Kd = .5; float Ks = .5; float roughness = .1; color specularcolor = 1; string texturename = ""; string mapname="";)
{
  point Nf; point V; color Ct; float a, b, diffuse, ambient, specular, noise, mix, step = 2, texture, color_ = 1;
  diffuse = 1; ambient = 1; specular = .5; noise = float noise(P); mix = mix(1, 2, .5); texture = 0;
  Nf = faceforward( normalize(N), I ); V = -normalize(I);
  if( texturename != "" ) Ct = Cs * color texture( texturename ); else Ct = Cs;
  if (mapname != "") { Ct = Ct * environment(mapname, reflect(I, Nf)); a = texture(mapname[0]); b = float environment(mapname[1], V); }
  Oi = Os;
  Ci = Os * ( Ct * (Ka*ambient() + Kd*diffuse(Nf)) + specularcolor * Ks*specular(Nf,V,roughness) ) * diffuse * ambient * (specular + noise*0 + mix*0 + step*0 + texture);
  Ci = Ci * specularbrdf(V, Nf, V, .1);
}
