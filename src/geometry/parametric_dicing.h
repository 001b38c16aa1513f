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

struct Parametric::Dicing {
    /// Part of a patch: facets that it needs along u and v.
    struct Block {
        double u0, u1, v0, v1, nu, nv;
        uint32_t cutU = 1, cutV = 1, first = 0; ///< facets, and the first vertex inside
        bool seen = true;                       ///< false: only its sides exist, if neighbours need them
    };
    /// A line of constant u or v, where it is a side of blocks.
    struct Line {
        struct Side {
            double from, to, need;
        };
        std::vector<Side> sides;
        std::vector<double> at;
        std::vector<uint32_t> vertex;
        bool given = false; ///< points come from an edge curve:
        std::vector<Vec3d> points;
        size_t nearest(double x) const;
        bool has(double x) const { return std::binary_search(at.begin(), at.end(), x); }
    };
    using Lines = std::map<double, Line>;
    /// A point of a block's side: where it is along it, and the vertex.
    struct Point {
        double at;
        uint32_t vertex;
    };

    const Parametric& s;
    const DiceOptions& opt;
    const bool displaced;
    const DiceCamera camera;
    const Unseen* unseen = nullptr; ///< if set, parts that may be omitted
    std::vector<const Parametric*> keys;
    bool closed[2];
    std::vector<Block> blocks;
    size_t cuts = 0;
    double scale = 1;
    Lines lines[2]; ///< of constant v, by v; of constant u, by u
    std::vector<std::array<double, 2>> param;
    std::vector<uint32_t> index;
    std::vector<Vec2> step;    ///< by vertex: along u and v to the next ones
    std::vector<uint8_t> used; ///< by vertex: a block that is seen has it; empty: all are

    Dicing(const Parametric& shape, const DiceOptions& o, bool displaced);
    void probe(const Parametric&, Block&, Block& least, ProbedBox&) const;
    void refine(Block, int depth);
    void cutPatches();
    bool leavesOut() const { return unseen && !unseen->none(); }
    std::vector<uint8_t> unseenPatches(const std::vector<double>& u, const std::vector<double>& v) const;
    void findUsed();
    void dropUnused(std::vector<Vec3>& P, std::vector<uint32_t>& border);
    bool limitFacets();
    void cutLine(Line&, double a, double b, std::span<const Line::Side*>);
    void giveEdge(int side, Line&, const std::vector<double>& cells);
    void makeLines();
    void makeVertices();
    void makeInside(Block&);
    void place(std::vector<Vec3>& P) const;
    void placeEdge(int side, const Line&, std::vector<Vec3>& P) const;
    std::vector<Point> side(int direction, double of, double from, double to) const;
    void zip(const std::vector<Point>& out, const std::vector<Point>& in, bool flip);
    void triangle(uint32_t a, uint32_t b, uint32_t c);
    void fill(const Block&, const TriMesh&);
    std::vector<uint32_t> border() const;
    double edge() const { return diceEdge(s.attributes()); }
    double tolerance() const {
        const double flat = diceFlatness(s.attributes());
        return flat > 0 ? flat : kDeviation * edge();
    }
    std::vector<double> cells(int direction) const;
};

} // namespace alpenglow::geometry
