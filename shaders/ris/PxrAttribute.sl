/* PxrAttribute: an attribute of the object, of RIS, as Attribute "class" "name" gives it ("user:id"): varname, type float, int, color or string; else the default. */
#include "rispattern.h"
surface PxrAttribute(string varname = "", type = "float"; float defaultFloat = 0, defaultInt = 0; color defaultColor = 0, defaultFloat3 = 0; RIS_RGB; output varying float resultF = 0, resultI = 0) {
    uniform float f = (type == "int") ? defaultInt : defaultFloat;
    uniform color c = (type == "float3") ? defaultFloat3 : defaultColor;
    if (type == "color" || type == "float3") {
        attribute(varname, c);
        resultRGB = c;
        resultF = comp(c, 0);
    } else {
        attribute(varname, f);
        resultF = f;
        resultRGB = f;
    }
    resultI = resultF;
    RIS_CHANNELS
}
