/* PxrTee: hands a value on and writes it to the output aov, of RIS: a number where inputF is connected, else a colour, as the display has declared it. */
#include "rispattern.h"
surface PxrTee(varying color inputRGB = 0; varying float inputF = 0; string aov = "", aovName = ""; float verbosity = 0;
               output varying color resultRGB = 0; output varying float resultF = 0) {
    resultRGB = inputRGB;
    resultF = inputF;
    uniform string name = (aov == "") ? aovName : aov;
    if (name != "") {
        outputchannel(name, resultRGB);
        outputchannel(name, resultF);
    }
}
