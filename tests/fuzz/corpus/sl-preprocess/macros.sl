#define SQ(x) ((x) * (x))
#define CAT(a, b) a ## b
#define STR(a) #a
#define EMPTY
#define MANY(a, ...) a
#if defined(SQ) && (SQ(2) == 4) || !defined(NOSUCH)
#  define DEEP SQ(SQ(SQ(2)))
#elif 1 / 1 > 0
#  error never
#else
#endif
#ifdef EMPTY
#undef EMPTY
#endif
#ifndef EMPTY
surface CAT(a, b)(float Kd = DEEP; string name = STR(x "y" \n);) {
    float __x = SQ(Kd) + __LINE__; /* a comment
    over lines */
#line 100 "other.sl"
#pragma annotation "a" "b"
    Ci = __x; // and one
    Oi = Os;
}
#endif
