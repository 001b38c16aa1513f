light sunlamp (float intensity=1;color lightcolor=1;point from=point "shader" (0,0,0),to=point "shader" (0,0,1);float angle=0;string shadowname="raytrace";float parallelness=1)
{
  vector dir=normalize(to-from);
  solar(dir,angle)
  {
    Cl=intensity*lightcolor;
    if(shadowname=="raytrace") Cl*=transmission(Ps,Ps-dir*1e5,"samples",4);
    else if(shadowname!="") Cl*=1-color shadow(shadowname,Ps);
  }
}
