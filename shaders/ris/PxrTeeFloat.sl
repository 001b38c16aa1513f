/* PxrTeeFloat: hands a number on and writes it to the output aov, of RIS: what PxrTee with inputF is. */
surface PxrTeeFloat(varying float inputF = 0; string aov = ""; float verbosity = 0; output varying float resultF = 0; output varying color resultRGB = 0) {
    resultF = inputF;
    resultRGB = inputF;
    if (aov != "") outputchannel(aov, inputF);
}
