#pragma nolint
#pragma annotation "grouping" "Diffuse/Kd;"
#pragma annotation "Kd" "gadgettype=floatslider;min=0;max=1;label=Diffuse;"
#pragma once
#pragma something else (entirely) "unbalanced
#ident "$Id$"
surface annotated(
    #pragma annotation Kd "hint=inside"
    float Kd = 0.8; /* @label=foo */
    float Ks = 0.2; // comment with "quote
    string note = "a \"quoted\" string\twith tab\\";
    string two = "joined " "literals";
    float big = 1e10, small = 1.e-4, odd = .5e+2, dot = 3.;
    )
{
    string empty = "";
    float z = (big > small) && !(odd == dot) || note == two;
    printf("%s %f %p %c %% %d\n", note, z, P, Cs, 3);
    Ci = Kd * Ks * z; Oi = 1;;
}
