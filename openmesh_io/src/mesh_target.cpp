#include "mesh_target.h"

#include <OpenMesh/Core/IO/SR_store.hh>
#include <OpenMesh/Core/Mesh/BaseKernel.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <cstring>
#include <string>

#include "mesh_source.h"
#include "property_types.h"

namespace bspc::openmesh {

namespace {

using OpenMesh::IO::Options;

/// A tuple of an array as a vector of OpenMesh; the array has that type.
template <class Vector>
Vector vectorAt(const ArrayValues& array, std::size_t tuple) {
  Vector vector;
  std::memcpy(vector.data(), array.values.data() + tuple * sizeof(Vector), sizeof(Vector));
  return vector;
}

template <class Handle>
struct PropertyHandle;
template <>
struct PropertyHandle<OpenMesh::VertexHandle> {
  template <class T>
  using Of = OpenMesh::VPropHandleT<T>;
};
template <>
struct PropertyHandle<OpenMesh::FaceHandle> {
  template <class T>
  using Of = OpenMesh::FPropHandleT<T>;
};

template <class T, class Handle>
bool setProperty(OpenMesh::BaseKernel& kernel, const ArrayValues& array,
                 const std::vector<Handle>& handles, const std::vector<std::size_t>& sources) {
  if (array.type != scalarTypeOf<T>() || array.components != ValueTraits<T>::kComponents) {
    return false;
  }
  typename PropertyHandle<Handle>::template Of<T> property;
  if (!kernel.get_property_handle(property, array.name)) kernel.add_property(property, array.name);
  if (OpenMesh::IO::is_streamable<T>()) kernel.property(property).set_persistent(true);
  for (std::size_t i = 0; i < handles.size(); ++i) {
    if constexpr (std::is_same_v<T, std::string>) {
      kernel.property(property, handles[i]) = array.strings[sources[i]];
    } else if constexpr (std::is_same_v<T, bool>) {
      kernel.property(property, handles[i]) = array.values[sources[i]] != 0;
    } else {
      T value{};
      std::memcpy(&value, array.values.data() + sources[i] * sizeof(T), sizeof(T));
      kernel.property(property, handles[i]) = value;
    }
  }
  return true;
}

bool hasShape(const ArrayValues& array, ScalarType type, std::uint32_t components) {
  return array.type == type && array.components == components;
}

}  // namespace

void MeshTarget::add(const Grid& grid, const DecodedPoints& points) {
  addVertices(grid, points);
  addFaces(points.mesh);
  for (const ArrayValues& array : points.arrays) setArray(array, vertices_, vertexSources_);
  for (const ArrayValues& array : points.cellArrays) setArray(array, faces_, faceSources_);
  const std::size_t others = points.mesh.lines.size() + points.mesh.vertices.size();
  if (others > 0) {
    omerr() << "[BSPCReader] : the file has " << others
            << " lines and vertex cells, which OpenMesh has no place for\n";
  }
}

void MeshTarget::addVertices(const Grid& grid, const DecodedPoints& points) {
  std::vector<double> xyz(3 * points.points.size());
  restorePositions(grid, Span<const GridPoint>(points.points), xyz.data());
  importer_.reserve(static_cast<unsigned>(points.points.size()),
                    static_cast<unsigned>(points.points.size() + points.mesh.faces.size()),
                    static_cast<unsigned>(points.mesh.faces.size()));
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const OpenMesh::Vec3d point(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    vertices_.push_back(importer_.add_vertex(point));
    vertexSources_.push_back(i);
  }
  warnOfFloats(xyz);
}

void MeshTarget::warnOfFloats(const std::vector<double>& xyz) const {
  OpenMesh::BaseKernel* kernel = importer_.kernel();
  if (kernel == nullptr) return;
  const OpenMesh::BaseProperty* points = kernel->_get_vprop("v:points");
  if (dynamic_cast<const OpenMesh::PropertyT<OpenMesh::Vec3f>*>(points) == nullptr) return;
  for (const double x : xyz) {
    if (static_cast<double>(static_cast<float>(x)) == x) continue;
    omlog() << "[BSPCReader] : coordinates need double precision and are rounded to the float of "
               "the mesh; read into a mesh whose Point is Vec3d to have them exactly\n";
    return;
  }
}

void MeshTarget::addFaces(const MeshCells& mesh) {
  const std::size_t firstFace = mesh.vertices.size() + mesh.lines.size();
  std::size_t refused = 0;
  std::vector<OpenMesh::VertexHandle> corners;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    corners.clear();
    for (const std::uint32_t v : mesh.faces[i]) corners.push_back(vertices_[v]);
    const std::size_t before = importer_.n_vertices();
    const OpenMesh::FaceHandle handle = importer_.add_face(corners);
    // Where a face does not fit, OpenMesh gives it vertices of its own, in its order.
    const std::size_t doubled = importer_.n_vertices() - before;
    for (std::size_t j = 0; j < doubled && j < corners.size(); ++j) {
      vertices_.emplace_back(static_cast<int>(before + j));
      vertexSources_.push_back(mesh.faces[i][j]);
    }
    if (!handle.is_valid()) {
      ++refused;
      continue;
    }
    faces_.push_back(handle);
    faceSources_.push_back(firstFace + i);
  }
  if (refused > 0) {
    omerr() << "[BSPCReader] : " << refused
            << " faces have fewer than three different vertices, which OpenMesh cannot hold\n";
  }
}

template <class Handle>
void MeshTarget::setArray(const ArrayValues& array, const std::vector<Handle>& handles,
                          const std::vector<std::size_t>& sources) {
  if (setStandard(array, handles, sources)) return;
  OpenMesh::BaseKernel* kernel = importer_.kernel();
  const bool set =
      kernel != nullptr && anyPropertyType([&](auto tag) {
        return setProperty<typename decltype(tag)::Type>(*kernel, array, handles, sources);
      });
  if (set) {
    found_ += Options::Custom;
  } else {
    omerr() << "[BSPCReader] : the array \"" << array.name << "\" of " << array.components
            << " components is of no type that a property can have\n";
  }
}

/// Whether the array is a standard attribute, which is set if that was wished.
template <class Handle>
bool MeshTarget::setStandard(const ArrayValues& array, const std::vector<Handle>& handles,
                             const std::vector<std::size_t>& sources) {
  constexpr bool kVertex = std::is_same_v<Handle, OpenMesh::VertexHandle>;
  const auto each = [&](Options::Flag flag, auto set) {
    found_ += flag;
    if (!wished_.check(flag)) return true;
    for (std::size_t i = 0; i < handles.size(); ++i) set(handles[i], sources[i]);
    return true;
  };
  if (array.semantic == Semantic::Normals && array.components == 3 && isFloatingPoint(array.type)) {
    return each(kVertex ? Options::VertexNormal : Options::FaceNormal,
                [&](Handle h, std::size_t i) {
                  if (array.type == ScalarType::Float32) {
                    importer_.set_normal(h, vectorAt<OpenMesh::Vec3f>(array, i));
                  } else {
                    importer_.set_normal(h, vectorAt<OpenMesh::Vec3d>(array, i));
                  }
                });
  }
  if (array.semantic == Semantic::Colours) return setColours(array, handles, sources);
  if constexpr (kVertex) {
    if (array.semantic == Semantic::TextureCoordinates && hasShape(array, ScalarType::Float32, 2)) {
      return each(Options::VertexTexCoord, [&](Handle h, std::size_t i) {
        importer_.set_texcoord(h, vectorAt<OpenMesh::Vec2f>(array, i));
      });
    }
  }
  if (array.name == kStatus && hasShape(array, ScalarType::UInt32, 1)) {
    return each(Options::Status, [&](Handle h, std::size_t i) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, array.values.data() + i * sizeof(bits), sizeof(bits));
      OpenMesh::Attributes::StatusInfo status;
      status.set_bits(bits);
      importer_.set_status(h, status);
    });
  }
  return false;
}

template <class Handle>
bool MeshTarget::setColours(const ArrayValues& array, const std::vector<Handle>& handles,
                            const std::vector<std::size_t>& sources) {
  const bool floats = array.type == ScalarType::Float32;
  const bool alpha = array.components == 4;
  if ((!floats && array.type != ScalarType::UInt8) || (!alpha && array.components != 3)) {
    return false;
  }
  const Options::Flag flag =
      std::is_same_v<Handle, OpenMesh::VertexHandle> ? Options::VertexColor : Options::FaceColor;
  found_ += flag;
  if (floats) found_ += Options::ColorFloat;
  if (alpha) found_ += Options::ColorAlpha;
  if (!wished_.check(flag)) return true;
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const Handle h = handles[i];
    if (floats && alpha) importer_.set_color(h, vectorAt<OpenMesh::Vec4f>(array, sources[i]));
    if (floats && !alpha) importer_.set_color(h, vectorAt<OpenMesh::Vec3f>(array, sources[i]));
    if (!floats && alpha) importer_.set_color(h, vectorAt<OpenMesh::Vec4uc>(array, sources[i]));
    if (!floats && !alpha) importer_.set_color(h, vectorAt<OpenMesh::Vec3uc>(array, sources[i]));
  }
  return true;
}

}  // namespace bspc::openmesh
