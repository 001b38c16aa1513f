// The making of facets of a surface over a square (parametric_dice.cpp).
#pragma once
#include "geometry/dice.h"
#include "geometry/edge_curve.h"
#include "geometry/parametric.h"
#include "geometry/picture_sides.h"
#include <algorithm>
#include <array>
#include <map>

namespace alpenglow::geometry {

inline constexpr double kDeviation = 0.05; ///< pixels that facets may stray from the surface

/// Dicing of one parametric surface: patches are cut into blocks of equal facets, blocks share the points of the lines between
/// them.
struct Parametric::Dicing {
    /// Part of a patch: facets that it needs along u and v.
    struct Block {
        double u0, u1, v0, v1, nu, nv;          ///< its range of u and v, and numbers of facets as real numbers
        uint32_t cutU = 1, cutV = 1, first = 0; ///< facets, and the first vertex inside
        bool seen = true;                       ///< false: only its sides exist, if neighbours need them
    };
    /// A line of constant u or v, where it is a side of blocks.
    struct Line {
        /// A side of a block on the line.
        struct Side {
            double from, to, need; ///< range along the line; number of facets that the block needs there
        };
        std::vector<Side> sides;      ///< of all blocks
        std::vector<double> at;       ///< positions of the points, ascending
        std::vector<uint32_t> vertex; ///< of the points
        bool given = false;           ///< points come from an edge curve:
        std::vector<Vec3d> points;    ///< by point; camera space
        /// Index of the point nearest to x.
        size_t nearest(double x) const;
        /// There is a point at x.
        bool has(double x) const { return std::binary_search(at.begin(), at.end(), x); }
    };
    using Lines = std::map<double, Line>;
    /// A point of a block's side: where it is along it, and the vertex.
    struct Point {
        double at; ///< 0 to 1
        uint32_t vertex;
    };

    const Parametric& s;                      ///< the shape
    const DiceOptions& opt;                   ///< of the frame
    const bool displaced;                     ///< a displacement shader moves its points
    const DiceCamera camera;                  ///< of the options
    const Unseen* unseen = nullptr;           ///< if set, parts that may be omitted
    std::vector<const Parametric*> keys;      ///< of a moving shape, the first included
    bool closed[2];                           ///< along u, along v: ends are one line
    std::vector<Block> blocks;                ///< that have been cut
    size_t cuts = 0;                          ///< beyond one a patch
    double scale = 1;                         ///< > 1: facets are larger than asked for, because there would be too many
    Lines lines[2];                           ///< of constant v, by v; of constant u, by u
    std::vector<std::array<double, 2>> param; ///< by vertex: u and v
    std::vector<uint32_t> index;              ///< three a triangle
    std::vector<Vec2> step;                   ///< by vertex: along u and v to the next ones
    std::vector<uint8_t> used;                ///< by vertex: a block that is seen has it; empty: all are

    /// displaced: a displacement shader moves its points.
    Dicing(const Parametric& shape, const DiceOptions& o, bool displaced);
    /// Numbers of facets of a block, by points inside it; `least`: the smallest number of a probe.
    void probe(const Parametric&, Block&, Block& least, ProbedBox&) const;
    /// Appends the block, or cuts it where its facets differ too much in size.
    void refine(Block, int depth);
    /// Makes the blocks of all patches.
    void cutPatches();
    /// Parts of the surface may be omitted.
    bool leavesOut() const { return unseen && !unseen->none(); }
    /// By patch: 1 if no ray reaches it or its neighbours; empty: none is known.
    std::vector<uint8_t> unseenPatches(const std::vector<double>& u, const std::vector<double>& v) const;
    /// Fills `used`.
    void findUsed();
    /// Removes vertices that no triangle uses from all that is listed by vertex.
    void dropUnused(std::vector<Vec3>& P, std::vector<uint32_t>& border);
    /// Makes facets larger until they are few enough; true: they had to be.
    bool limitFacets();
    /// Halves a part of a line until no side starts or ends within a segment, and none is longer than its blocks need.
    void cutLine(Line&, double a, double b, std::span<const Line::Side*>);
    /// Points of a border of the surface (0: v = 0, 1: u = 1, 2: v = 1, 3: u = 0), for edges with edge curves.
    void giveEdge(int side, Line&, const std::vector<double>& cells);
    /// Cuts all lines.
    void makeLines();
    /// Numbers the points of lines; crossing lines share a vertex.
    void makeVertices();
    /// Numbers the vertices inside a block.
    void makeInside(Block&);
    /// Positions of all vertices, camera space.
    void place(std::vector<Vec3>& P) const;
    /// Positions on a border that has an edge curve.
    void placeEdge(int side, const Line&, std::vector<Vec3>& P) const;
    /// The points of a line from one position to another.
    std::vector<Point> side(int direction, double of, double from, double to) const;
    /// The strip between two rows of points; `out` on the right of `in` as u and v are drawn, or with flip on the left.
    void zip(const std::vector<Point>& out, const std::vector<Point>& in, bool flip);
    /// Appends a triangle; none if two of its vertices are one.
    void triangle(uint32_t a, uint32_t b, uint32_t c);
    /// The triangles of a block and of the strips along its sides.
    void fill(const Block&, const TriMesh&);
    /// Vertices along the border of the surface.
    std::vector<uint32_t> border() const;
    /// Length of a facet, pixels.
    double edge() const { return diceEdge(s.attributes()); }
    /// Distance that facets may stray from the surface, pixels.
    double tolerance() const {
        const double flat = diceFlatness(s.attributes());
        return flat > 0 ? flat : kDeviation * edge();
    }
    /// Start and end of each patch, two numbers each: if the surface is torn, both sides have separate ends.
    std::vector<double> cells(int direction) const;
};

} // namespace alpenglow::geometry
