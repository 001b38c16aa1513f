/* A woven cloth whose pattern is computed by a plug-in (examples/plugins/weave.cpp):
     alpenglow shade examples/plugins/weave.sl --allow-exec --searchpath build/release/plugins -o weave.png */
plugin "weave";

surface weave(float Ka = 0.2; float Kd = 0.8; float threads = 12; color warp = color(0.7, 0.2, 0.1); color weft = color(0.9, 0.8, 0.6);
              output varying float thread = 0;)
{
    color cloth = weave(threads * s, threads * t, warp, weft, thread);
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * cloth * (Ka + Kd * abs(normalize(I) . Nf));
}
