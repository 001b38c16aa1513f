/* PxrConstant: a surface of one radiance, of RIS. Parameters and defaults are those of Pixar's documentation. */
surface PxrConstant(varying color emitColor = 1; varying float presence = 1;)
{
    Oi = presence;
    Ci = presence * emitColor;
}
