// Pixie: how many surfaces scattered the ray before this one; 0 for the camera.
float raydepth() {
    float depth = 0;
    rayinfo("depth", depth);
    return depth;
}
