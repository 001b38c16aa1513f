// Pixie: the label of the ray that is shaded; "camera" for the camera's, which have none by themselves.
string raylabel() {
    string label = "", type = "";
    rayinfo("label", label);
    if (label == "" && rayinfo("type", type) != 0 && type == "camera") label = "camera";
    return label;
}
