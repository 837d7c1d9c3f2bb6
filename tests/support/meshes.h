#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bspc/grid.h"
#include "bspc/mesh.h"

namespace bspc::test {

struct Mesh {
  std::string name;
  std::vector<GridPoint> points;
  MeshCells cells;
};

/// A closed surface with one handle of `rings` × `sides` faces, in triangles or quadrilaterals.
Mesh torus(std::uint32_t rings, std::uint32_t sides, bool triangles);

/// An open, bumpy patch of 2 · side² triangles with uneven vertices and diagonals either way.
Mesh terrain(std::uint64_t seed, std::uint32_t side);

/// A smooth patch of 2 · side² triangles that lies askew to all axes: regular along its faces only.
Mesh smoothNet(std::uint32_t side);

/// A closed bumpy surface of 20 · 4^levels triangles whose vertices have been moved about and whose
/// edges flipped to be Delaunay again: like a scan that was meshed.
Mesh remeshedSphere(std::uint64_t seed, unsigned levels);

/// The same with vertices of their own for each face.
Mesh soup(Mesh mesh);
/// The same with faces in random order, each from a random vertex on.
Mesh shuffled(Mesh mesh, std::uint64_t seed);

/// Small meshes that have broken coders before: none, one face, faces of all sizes, holes, isolated
/// vertices, edges of three faces, bow ties, faces turned around, twice or without area, lines and
/// vertex cells of all sorts.
std::vector<Mesh> oddMeshes();

/// Faces each from its smallest vertex on, sorted.
std::vector<std::vector<std::uint32_t>> canonical(const Cells& faces);

}  // namespace bspc::test
