// The README's example: a mesh through a .bspc file with OpenMesh. Run: openmesh_example FOLDER
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <iostream>
#include <string>

#include "bspc/openmesh_io.h"

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;

static Mesh tetrahedron() {
  Mesh mesh;
  const OpenMesh::VertexHandle a(0);
  const OpenMesh::VertexHandle b(1);
  const OpenMesh::VertexHandle c(2);
  const OpenMesh::VertexHandle d(3);
  for (const Mesh::Point& point :
       {Mesh::Point(0, 0, 0), Mesh::Point(1, 0, 0), Mesh::Point(0, 1, 0), Mesh::Point(0, 0, 1)}) {
    mesh.add_vertex(point);
  }
  mesh.add_face(a, c, b);
  mesh.add_face(a, b, d);
  mesh.add_face(b, c, d);
  mesh.add_face(c, a, d);
  return mesh;
}

int main(int argc, char** argv) {
  const std::string name = std::string(argc > 1 ? argv[1] : ".") + "/tetrahedron.bspc";
  const Mesh mesh = tetrahedron();

  // README: begin
  // As every other format that OpenMesh knows:
  OpenMesh::IO::write_mesh(mesh, name);
  Mesh restored;
  OpenMesh::IO::read_mesh(restored, name);

  // With settings of its own: 12 bits, and vertices and faces keep their handles.
  bspc::openmesh::WriteSettings settings;
  settings.encoding.grid = bspc::GridRequest::withBits(12);
  settings.encoding.keepOrder = true;
  bspc::openmesh::writeMesh(mesh, name, {}, settings);
  OpenMesh::IO::read_mesh(restored, name);
  // README: end

  for (const auto v : mesh.vertices()) {
    if ((restored.point(v) - mesh.point(v)).norm() > 1e-3) return 1;
  }
  std::cout << restored.n_vertices() << " vertices, " << restored.n_faces() << " faces\n";
  return restored.n_faces() == mesh.n_faces() ? 0 : 1;
}
