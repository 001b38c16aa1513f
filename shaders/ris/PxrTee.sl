/* PxrTee: hands a colour on and writes it to the output aov, of RIS. With inputF a scene means PxrTeeFloat. */
surface PxrTee(varying color inputRGB = 0; string aov = ""; float verbosity = 0; output varying color resultRGB = 0; output varying float resultF = 0) {
    resultRGB = inputRGB;
    if (aov != "") outputchannel(aov, inputRGB);
}
