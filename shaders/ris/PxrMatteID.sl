/* PxrMatteID: mattes for compositing, of RIS: the channels MatteID0 to MatteID7 have what Attribute "user" "color MatteID0" and the like say of the
   object, black where it says nothing, each times its matteTexture. Connect resultAOV to the utilityPattern or inputAOV of a material. Names are
   those of Pixar's documentation. */
surface PxrMatteID(varying float inputAOV = 0; float enable = 1;
                   varying color matteTexture0 = 1, matteTexture1 = 1, matteTexture2 = 1, matteTexture3 = 1, matteTexture4 = 1,
                       matteTexture5 = 1, matteTexture6 = 1, matteTexture7 = 1;
                   output varying float resultAOV = 0;) {
    void matte(uniform string attributeName, channel; color texture_;) {
        uniform color mine = 0;
        attribute(attributeName, mine);
        outputchannel(channel, enable * mine * texture_);
    }
    matte("user:MatteID0", "MatteID0", matteTexture0);
    matte("user:MatteID1", "MatteID1", matteTexture1);
    matte("user:MatteID2", "MatteID2", matteTexture2);
    matte("user:MatteID3", "MatteID3", matteTexture3);
    matte("user:MatteID4", "MatteID4", matteTexture4);
    matte("user:MatteID5", "MatteID5", matteTexture5);
    matte("user:MatteID6", "MatteID6", matteTexture6);
    matte("user:MatteID7", "MatteID7", matteTexture7);
    resultAOV = inputAOV;
}
