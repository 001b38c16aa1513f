displacement
dimples(float Km = 0.1; float freq = 8; float truedisp = 1; string mapname = "";)
{
  point PP, NN;
  float mag, i, f;
  PP = freq * transform("object", P);
  NN = normalize(N);
  mag = 0;
  f = 1;
  for (i = 0; i < 4; i += 1)
    {
      mag += (.5 - float noise(PP * f)) / f;
      f *= 2;
    }
  if (mapname != "")
    mag += float texture(mapname[0], s, t);
  if (truedisp == 1) {
    P += Km * mag * NN;
    N = calculatenormal(P);
  } else
    N = calculatenormal(P + Km * mag * NN);
}
