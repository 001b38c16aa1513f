/* PxrBlack: a surface that reflects nothing, of RIS. */
surface PxrBlack()
{
    Oi = 1;
    Ci = 0;
}
