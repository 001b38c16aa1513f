surface toon_outline(uniform float bands=3,edge=.3;uniform color linecolor=0;uniform string style="hard")
{
normal n=normalize(N);vector i=normalize(I);
float f=abs(i.n);
color d=0;
if(f<edge)Ci=linecolor;else{
illuminance(P,n,1.5708){float k=normalize(L).n;
if(style=="hard"){k=floor(k*bands)/bands;}
else if(style=="soft")k=smoothstep(0,1,k);
d+=Cl*k;}
Ci=Cs*d;}
Oi=Os;Ci*=Oi;
}
