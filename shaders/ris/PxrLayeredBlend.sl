/* PxrLayeredBlend: up to eight colours over a background, of RIS: the layer 7 first, 0 on top. Operations and alphas are those of PxrBlend. */
#include "rispattern.h"
surface PxrLayeredBlend(varying color backgroundRGB = 0; varying float backgroundA = 1; float clampOutput = 1;
                        float enable_0 = 0, operation_0 = 19; varying color RGB_0 = 0; varying float A_0 = 1;
                        float enable_1 = 0, operation_1 = 19; varying color RGB_1 = 0; varying float A_1 = 1;
                        float enable_2 = 0, operation_2 = 19; varying color RGB_2 = 0; varying float A_2 = 1;
                        float enable_3 = 0, operation_3 = 19; varying color RGB_3 = 0; varying float A_3 = 1;
                        float enable_4 = 0, operation_4 = 19; varying color RGB_4 = 0; varying float A_4 = 1;
                        float enable_5 = 0, operation_5 = 19; varying color RGB_5 = 0; varying float A_5 = 1;
                        float enable_6 = 0, operation_6 = 19; varying color RGB_6 = 0; varying float A_6 = 1;
                        float enable_7 = 0, operation_7 = 19; varying color RGB_7 = 0; varying float A_7 = 1;
                        RIS_RGB; output varying float resultA = 1) {
    void put(float on, op; color c; float a; output color below; output float alpha;) {
        if (on != 0) {
            if (op != 16) below = mix(below, risBlended(op, c, below), color(a));
            alpha = a + alpha * (1 - a);
        }
    }
    color c = backgroundRGB;
    float a = backgroundA;
    put(enable_7, operation_7, RGB_7, A_7, c, a);
    put(enable_6, operation_6, RGB_6, A_6, c, a);
    put(enable_5, operation_5, RGB_5, A_5, c, a);
    put(enable_4, operation_4, RGB_4, A_4, c, a);
    put(enable_3, operation_3, RGB_3, A_3, c, a);
    put(enable_2, operation_2, RGB_2, A_2, c, a);
    put(enable_1, operation_1, RGB_1, A_1, c, a);
    put(enable_0, operation_0, RGB_0, A_0, c, a);
    resultRGB = (clampOutput != 0) ? clamp(c, color(0), color(1)) : c;
    resultA = a;
    RIS_CHANNELS
}
