// Compresses a mesh file with OpenMesh and reads it back: read_write IN.off OUT.bspc
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <iostream>

#include "bspc/openmesh_io.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  OpenMesh::PolyMesh_ArrayKernelT<> mesh;
  OpenMesh::PolyMesh_ArrayKernelT<> restored;
  if (!OpenMesh::IO::read_mesh(mesh, argv[1])) return 1;
  if (!OpenMesh::IO::write_mesh(mesh, argv[2])) return 1;
  if (!OpenMesh::IO::read_mesh(restored, argv[2])) return 1;
  std::cout << restored.n_vertices() << " vertices, " << restored.n_faces() << " faces\n";
  return restored.n_vertices() == mesh.n_vertices() && restored.n_faces() == mesh.n_faces() ? 0 : 1;
}
