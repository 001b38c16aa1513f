surface VDecal ( float Ka=1,Kd=.7; string DecalNames[4] = {"","","",""}; float DecalS[4]={0,0,0,0}, DecalT[4]={0}; color DecalTint[4] = {1,1,1,1}; matrix DecalTx[4] = {1,1,1,1}; point DecalP[2] = { point (0,0,0), (1,1,1) };
   uniform float Count = 4;)
{
  color BC = Cs; uniform float ii;
  for (ii=0; ii<Count; ii=ii+1)
  {
    uniform string nm = DecalNames[ii];
    if (nm != "")
    {
      point dp = transform(DecalTx[ii], P) - vector DecalP[mod(ii,2)];
      color dc = texture(nm, xcomp(dp)+DecalS[ii], ycomp(dp)+DecalT[ii]);
      float da = texture(nm[3], xcomp(dp)+DecalS[ii], ycomp(dp)+DecalT[ii], "fill", 1);
      BC = mix(BC, dc*DecalTint[ii], da);
    }
  }
  Ci = BC*(Ka*ambient()+Kd*diffuse(normalize(faceforward(N,I)))); Oi=Os; Ci*=Oi;
}
