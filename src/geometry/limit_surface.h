// The limit surface of a subdivision cage, as weights of its control points.
//
// A face of the cage is one piece, or, where the scheme splits it (a face of catmull-clark without four corners), one piece a
// corner. A piece has u and v of its own, both 0 to 1: quadrilaterals have their corners at (0,0) (1,0) (1,1) (0,1), by winding;
// triangles of loop at (0,0) (1,0) (0,1), with u + v <= 1; the piece of a corner begins there, its u along the edge to the next
// corner and its v along the edge from the previous one, and ends in the middle of the face.
//
// Exact, that is the limit itself in double: faces that are regular, and others up to 2^-10 of a face from an extraordinary
// vertex. Nearer, OpenSubdiv's Gregory patches stand for it: position and normal meet the limit at the vertex and at the patch's
// border; the partials are finite there, where those of the limit by these u and v vanish or grow without bound.
#pragma once
#include "base/diagnostics.h"
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::geometry {

/// Rules of refinement, as in RISpec 3.2, 5.3, and SubdivisionMesh's further schemes.
enum class SubdivisionScheme { CatmullClark, Loop, Bilinear };

/// The cage. The caller checks indices; a face has no vertex twice. With Loop every face has three corners.
struct SubdivisionCage {
    SubdivisionScheme scheme = SubdivisionScheme::CatmullClark; ///< for the whole cage
    /// Which boundaries the surface interpolates: none, so that border faces are holes; edges and corners; edges alone.
    enum class Boundary { None, EdgeAndCorner, EdgeOnly } boundary = Boundary::None;
    /// Interpolation rule of face-varying values: which boundaries stay sharp.
    enum class FaceVarying {
        EdgeOnly,
        EdgeAndCorner,
        EdgeAndCornerPropagate,
        AlwaysSharp
    } faceVarying = FaceVarying::EdgeAndCorner;
    bool chaikin = false;               ///< sharpness of a crease is averaged along it
    bool smoothTriangles = false;       ///< special weights for triangles in catmull-clark
    int vertices = 0;                   ///< number of vertices
    std::span<const int> corners;       ///< per face: how many
    std::span<const int> vertex;        ///< per corner
    std::vector<int> creaseEnds;        ///< two vertices a crease
    std::vector<float> creaseSharpness; ///< one a crease; 10 and more are infinite
    std::vector<int> cornerVertex;      ///< vertices
    std::vector<float> cornerSharpness; ///< one a corner; 10 and more are infinite
    std::vector<int> holes;             ///< faces
};

/// Weights of control values at a point: by (`index`), then for derivatives by u, v, uu, uv, vv as requested.
class LimitWeights {
public:
    int count = 0;              ///< number of control values that act
    const int* index = nullptr; ///< of these values, `count` numbers
    /// 0: of the value; 1 to 5: of u, v, uu, uv, vv.
    const double* weights(int derivative) const { return data() + size_t(derivative) * size_t(count); }
    /// Prepares room for n values and so many sets of weights.
    double* make(int n, int sets);

private:
    const double* data() const { return large_.empty() ? small_.data() : large_.data(); }
    std::array<double, 6 * 32> small_;
    std::vector<double> large_;
};

/// The pieces of one cage, by OpenSubdiv. Evaluation is thread safe.
class LimitSurface {
public:
    /// Face-varying values that are smoothed: per corner an index; corners of one vertex with equal indices are joined.
    using Channel = std::vector<int>;
    /// `why`: reason if OpenSubdiv rejects the cage; valid() is then false.
    LimitSurface(const SubdivisionCage&, const std::vector<Channel>&, std::string& why);
    ~LimitSurface();
    /// The cage was accepted.
    bool valid() const { return valid_; }

    /// Numbers of faces, and of pieces with a u and v of their own; whether pieces are triangles.
    uint32_t faces() const { return uint32_t(faceCount_); }
    uint32_t pieces() const { return pieceCount_; }
    bool triangles() const { return scheme_ == SubdivisionScheme::Loop; }
    /// The face of a piece, and which of its corners (0 where a face is one piece).
    struct PieceOf {
        uint32_t face = 0; ///< index
        int corner = 0;    ///< 0 to 3
    };
    /// Of a piece below pieces().
    PieceOf pieceOf(uint32_t piece) const;
    /// The first piece of a face.
    uint32_t firstPiece(uint32_t face) const { return firstPiece_.empty() ? face : firstPiece_[face]; }
    /// How many pieces a face has: 1, or as many as corners.
    uint32_t piecesOf(uint32_t face) const { return firstPiece_.empty() ? 1 : firstPiece_[face + 1] - firstPiece_[face]; }
    /// Whether the face has a surface: holes, and faces at a border that is not interpolated, have none.
    bool drawn(uint32_t face) const { return vertexData_.pattern[face] != kNothing; }

    /// Weights of the vertices. derivatives: 0 value, 1 and slopes by u and v, 2 and their slopes. Thread safe.
    void weights(uint32_t piece, double u, double v, int derivatives, LimitWeights& out) const {
        evaluate(vertexData_, piece, u, v, derivatives, out);
    }
    /// The same of the values of a channel.
    void weights(int channel, uint32_t piece, double u, double v, int derivatives, LimitWeights& out) const {
        evaluate(channels_[size_t(channel)], piece, u, v, derivatives, out);
    }

    /// Number of edges of the cage, until forgetTopology(). Sheets that share an edge use its number, as for vertices.
    uint32_t edges() const;
    /// Corners of a face, until forgetTopology().
    int corners(uint32_t face) const;
    /// The vertex at a corner.
    int vertexAt(uint32_t face, int corner) const;
    int edgeAt(uint32_t face, int corner) const; ///< runs on to the next corner
    int edgeStart(int edge) const;               ///< first vertex of an edge
    /// Frees what only building needs.
    void forgetTopology();

    /// Number of faces with more adjacent edges than can be evaluated, which are flat. For a message.
    uint32_t flattened() const { return flattened_; }
    /// Whether patterns are coarser than stated above, because there are too many.
    bool coarser() const { return coarser_; }
    /// Whether the mesh had to be taken apart, and lost its creases and corners by that.
    bool blunted() const { return blunted_; }

private:
    static constexpr uint32_t kNothing = 0xffffffffu;
    /// Data of a face for vertices or a channel: a pattern, and indices of values.
    struct Data {
        std::vector<uint32_t> pattern;
        std::vector<size_t> first;
        std::vector<int> index;
    };
    struct Patterns;
    struct Topology;
    void joinEdges();
    void fill(Data&, int channel, const SubdivisionCage&);
    void evaluate(const Data&, uint32_t piece, double u, double v, int derivatives, LimitWeights&) const;

    bool valid_ = false, coarser_ = false, blunted_ = false;
    SubdivisionScheme scheme_;
    int faceCount_ = 0;
    uint32_t pieceCount_ = 0, flattened_ = 0;
    std::vector<uint32_t> firstPiece_, faceOfPiece_; ///< empty: a piece is a face
    std::vector<int> original_, sameEdge_;           ///< of meshes that were taken apart: per vertex and edge the one that counts
    Data vertexData_;
    std::vector<Data> channels_;
    std::unique_ptr<Patterns> patterns_;
    std::unique_ptr<Topology> topology_;
};

} // namespace alpenglow::geometry
