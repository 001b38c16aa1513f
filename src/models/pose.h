// A model at a time: animations of nodes, skins, morph targets. Source: glTF 2.0, 3.6 (interpolation: appendix C), 3.7.3.
#pragma once
#include "models/model.h"

namespace alpenglow::models {

/// Places of all nodes, in the space of the scene, and the weights of their morph targets.
struct Pose {
    std::vector<Matrix> world;                ///< by node: to the space of the scene
    std::vector<std::vector<double>> weights; ///< by node; none: those of the mesh
};

/// Of a model that was checked. animation: an index, or kNone for the file's own places; time in seconds, held at the ends.
Pose poseAt(const Model&, int animation, double time);

/// The last key of an animation, in seconds.
double lastKey(const Animation&);

/// Whether a part has another shape for each node and time.
bool deforms(const Node&, const Mesh&, const Part&);

/// P and N of a part as a node shows it at a pose: with a skin in the space of the scene, else in that of the node.
struct Shape {
    std::vector<float> P, N;
};
/// Of one part of a node's mesh.
Shape shapeAt(const Model&, const Pose&, int node, const Mesh&, const Part&);

/// The skin that moves a mesh of a node, or kNone.
int skinOf(const Node&, const Mesh&, const Part&);

} // namespace alpenglow::models
