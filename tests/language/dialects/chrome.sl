/* a mirror with a map */
surface chrome(float Ka=1,Ks=1,Kr=1,roughness=.1;string texturename="")
{
    point V,Nf,R;
    Nf=faceforward(normalize(N),I);
    V=normalize(I);
    if(texturename!=""){
        R=reflect(V,Nf);
        R=transform("world",R)-transform("world",point(0,0,0));
        Ci=Kr*color environment(texturename,R);
    }
    else Ci=0;
    Oi=Os;
    Ci=Os*Cs*(Ci+Ka*ambient()+Ks*specular(Nf,-V,roughness));
}
