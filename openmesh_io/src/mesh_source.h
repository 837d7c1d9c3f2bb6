#pragma once

#include <OpenMesh/Core/IO/Options.hh>
#include <OpenMesh/Core/IO/exporter/BaseExporter.hh>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/mesh.h"
#include "bspc/point_set.h"

namespace bspc::openmesh {

/// A mesh of OpenMesh as bspc::encode() takes it: its vertices and faces that are not deleted.
class MeshSource {
 public:
  /// Throws Error(Unsupported) naming what cannot be stored, Error(InvalidArgument) if the options
  /// ask for what the mesh does not have.
  MeshSource(OpenMesh::IO::BaseExporter& exporter, const OpenMesh::IO::Options& options);

  /// Views what this owns.
  PointSetView view() const;

 private:
  template <class Handle>
  struct Elements;

  void takeVertices();
  void takeFaces();
  template <class Handle>
  void takeAttributes(const std::vector<Handle>& handles, bool normals, bool colours,
                      std::vector<ArrayValues>& arrays) const;
  void takeTextureCoordinates();
  void takeProperties();
  void refuseOthers() const;

  OpenMesh::IO::BaseExporter& exporter_;
  OpenMesh::IO::Options options_;
  std::vector<OpenMesh::VertexHandle> vertices_;  ///< by number in the file
  std::vector<OpenMesh::FaceHandle> faces_;
  std::vector<float> floats_;
  std::vector<double> doubles_;
  MeshCells cells_;
  std::vector<ArrayValues> vertexArrays_;
  std::vector<ArrayValues> faceArrays_;
};

/// Names of the arrays of standard attributes.
constexpr const char* kNormals = "Normals";
constexpr const char* kColours = "Colors";
constexpr const char* kTextureCoordinates = "TextureCoordinates";
constexpr const char* kStatus = "Status";

}  // namespace bspc::openmesh
