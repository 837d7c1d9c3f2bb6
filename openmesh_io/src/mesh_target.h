#pragma once

#include <OpenMesh/Core/IO/Options.hh>
#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <vector>

#include "bspc/decoder.h"

namespace bspc::openmesh {

/// Puts what was decoded into a mesh of OpenMesh.
class MeshTarget {
 public:
  MeshTarget(OpenMesh::IO::BaseImporter& importer, OpenMesh::IO::Options wished)
      : importer_(importer), wished_(wished) {}

  void add(const Grid& grid, const DecodedPoints& points);

  /// Which attributes the file has.
  OpenMesh::IO::Options found() const { return found_; }

 private:
  void addVertices(const Grid& grid, const DecodedPoints& points);
  void addFaces(const MeshCells& mesh);
  void warnOfFloats(const std::vector<double>& xyz) const;
  /// `sources[i]`: the tuple of the array that the handle has.
  template <class Handle>
  void setArray(const ArrayValues& array, const std::vector<Handle>& handles,
                const std::vector<std::size_t>& sources);
  template <class Handle>
  bool setStandard(const ArrayValues& array, const std::vector<Handle>& handles,
                   const std::vector<std::size_t>& sources);
  template <class Handle>
  bool setColours(const ArrayValues& array, const std::vector<Handle>& handles,
                  const std::vector<std::size_t>& sources);

  OpenMesh::IO::BaseImporter& importer_;
  OpenMesh::IO::Options wished_;
  OpenMesh::IO::Options found_;
  /// Those of the file's vertices, then those that OpenMesh doubled for faces that do not fit.
  std::vector<OpenMesh::VertexHandle> vertices_;
  std::vector<std::size_t> vertexSources_;  ///< numbers in the file
  std::vector<OpenMesh::FaceHandle> faces_;
  std::vector<std::size_t> faceSources_;  ///< numbers among all cells
};

}  // namespace bspc::openmesh
