#pragma once

#include <OpenMesh/Core/IO/Options.hh>
#include <OpenMesh/Core/IO/exporter/ExporterT.hh>
#include <OpenMesh/Core/IO/importer/ImporterT.hh>
#include <iosfwd>
#include <string>

#include "bspc/encoder.h"
#include "bspc/limits.h"

// .bspc files for OpenMesh. A program that includes this header and links the library can call
// OpenMesh::IO::read_mesh and write_mesh with names, or stream formats, that end in ".bspc". The
// functions below do the same and take settings.
//
// Vertices and faces come back in another order than they had unless the file keeps it
// (WriteSettings::encoding.keepOrder); with encoding.originalIds the vertex property
// "OriginalPointIds" (std::uint64_t) tells the handle that each vertex had. Attributes follow their
// vertices and faces: normals, colours and status if the options and the mesh ask for them, 2D
// texture coordinates of vertices, and persistent properties of numbers, vectors and strings of
// vertices and faces. What cannot be stored (attributes of edges and halfedges, other properties)
// is an error, told in omerr(), rather than left out. Deleted vertices and faces are left out.

namespace bspc::openmesh {

#define BSPC_OPENMESH_API __attribute__((visibility("default")))

struct WriteSettings {
  /// Grid, effort, order …; metadata go into the file.
  EncodeOptions encoding;
};

struct ReadSettings {
  DecodeLimits limits;
};

/// What OpenMesh::IO::write_mesh and read_mesh use. Not to be changed while another thread calls
/// these.
BSPC_OPENMESH_API WriteSettings& writeSettings();
BSPC_OPENMESH_API ReadSettings& readSettings();

/// Makes ".bspc" known to OpenMesh::IO::IOManager; done by including this header. May be called
/// again.
BSPC_OPENMESH_API bool registerModule();

/// Through OpenMesh's interface for all meshes. On entry `options` say which attributes are wished,
/// on return which ones the file has. False on failure, told in omerr(); the mesh is then as it
/// was.
BSPC_OPENMESH_API bool read(std::istream& stream, OpenMesh::IO::BaseImporter& importer,
                            OpenMesh::IO::Options& options, const ReadSettings& settings);
BSPC_OPENMESH_API bool read(const std::string& filename, OpenMesh::IO::BaseImporter& importer,
                            OpenMesh::IO::Options& options, const ReadSettings& settings);

/// False on failure, told in omerr(); a file is then not touched.
BSPC_OPENMESH_API bool write(std::ostream& stream, OpenMesh::IO::BaseExporter& exporter,
                             OpenMesh::IO::Options options, const WriteSettings& settings);
BSPC_OPENMESH_API bool write(const std::string& filename, OpenMesh::IO::BaseExporter& exporter,
                             OpenMesh::IO::Options options, const WriteSettings& settings);

/// Reads into a mesh of any of OpenMesh's types, which is cleared before. Points of type double are
/// read as such.
template <class Mesh>
bool readMesh(Mesh& mesh, const std::string& filename, OpenMesh::IO::Options& options,
              const ReadSettings& settings = {}) {
  mesh.clear();
  OpenMesh::IO::ImporterT<Mesh> importer(mesh);
  return read(filename, importer, options, settings);
}
template <class Mesh>
bool readMesh(Mesh& mesh, std::istream& stream, OpenMesh::IO::Options& options,
              const ReadSettings& settings = {}) {
  mesh.clear();
  OpenMesh::IO::ImporterT<Mesh> importer(mesh);
  return read(stream, importer, options, settings);
}

template <class Mesh>
bool writeMesh(const Mesh& mesh, const std::string& filename, OpenMesh::IO::Options options = {},
               const WriteSettings& settings = {}) {
  OpenMesh::IO::ExporterT<Mesh> exporter(mesh);
  return write(filename, exporter, options, settings);
}
template <class Mesh>
bool writeMesh(const Mesh& mesh, std::ostream& stream, OpenMesh::IO::Options options = {},
               const WriteSettings& settings = {}) {
  OpenMesh::IO::ExporterT<Mesh> exporter(mesh);
  return write(stream, exporter, options, settings);
}

namespace detail {
/// In every program that includes this header, so that a static library's module is there too.
inline const bool kRegistered = registerModule();
}  // namespace detail

}  // namespace bspc::openmesh
