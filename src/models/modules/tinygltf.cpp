// The whole of tinygltf, compiled once. Pictures stay encoded, files are opened by callbacks of ours (gltf.cpp).
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
