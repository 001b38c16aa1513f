/* Shadows: from a map when there is one, else from rays. */
#ifndef SHADOWS_H
#define SHADOWS_H
color Shadowed(string name; point from, to; float blur; uniform float samples)
{
    color hidden = 0;
    if (name != "") hidden = float shadow(name, to, "samples", samples, "blur", blur);
    return hidden;
}
float shadowed(string name; point p; float blur; uniform float samples)
{
    return name == "" ? 0 : float shadow(name, p, "samples", samples, "blur", blur);
}
#endif
