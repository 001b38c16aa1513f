// Pixie: the label of the ray that is shaded.
string raylabel() {
    string label = "";
    rayinfo("label", label);
    return label;
}
