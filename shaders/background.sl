/* background: puts a colour behind the picture. RISpec standard shader; both parameter names are found in files. Ball: Imager "background" "color bgcolor" [.2 .3 .5] */
imager background(color bgcolor = 0, background = 0;) {
    Ci += (1 - alpha) * (bgcolor + background);
    Oi = 1;
    alpha = 1;
}
