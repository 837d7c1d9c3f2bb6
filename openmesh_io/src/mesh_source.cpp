#include "mesh_source.h"

#include <OpenMesh/Core/Mesh/BaseKernel.hh>
#include <limits>
#include <string>

#include "bspc/error.h"
#include "property_types.h"

namespace bspc::openmesh {

namespace {

using OpenMesh::IO::Options;

[[noreturn]] void refuse(ErrorCode code, const std::string& reason) { throw Error(code, reason); }

template <class S>
void append(Bytes& bytes, const S* numbers, std::size_t count) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(numbers);
  bytes.insert(bytes.end(), first, first + count * sizeof(S));
}

template <class S, int N>
void append(Bytes& bytes, const OpenMesh::VectorT<S, N>& vector) {
  append(bytes, vector.data(), N);
}

ArrayValues described(const char* name, ScalarType type, std::uint32_t components,
                      Semantic semantic) {
  ArrayValues array;
  array.name = name;
  array.type = type;
  array.components = components;
  array.semantic = semantic;
  return array;
}

/// Internal names of OpenMesh: "v:points", "<vprop>".
bool isInternal(const std::string& name) {
  return (name.size() > 1 && name[1] == ':') || (!name.empty() && name[0] == '<');
}

/// The values of a property if it is one of T.
template <class T, class Handle>
bool takeAs(const OpenMesh::BaseProperty& property, const std::vector<Handle>& handles,
            ArrayValues& array) {
  const auto* typed = dynamic_cast<const OpenMesh::PropertyT<T>*>(&property);
  if (typed == nullptr) return false;
  array.name = property.name();
  array.type = scalarTypeOf<T>();
  array.components = ValueTraits<T>::kComponents;
  for (const Handle handle : handles) {
    const auto& value = (*typed)[handle.idx()];
    if constexpr (std::is_same_v<T, std::string>) {
      array.strings.push_back(value);
    } else if constexpr (std::is_same_v<T, bool>) {
      array.values.push_back(value ? 1 : 0);
    } else if constexpr (ValueTraits<T>::kComponents == 1) {
      append(array.values, &value, 1);
    } else {
      append(array.values, value);
    }
  }
  return true;
}

template <class Iterator, class Handle>
void takePersistent(Iterator begin, Iterator end, const std::vector<Handle>& handles,
                    std::vector<ArrayValues>& arrays) {
  for (; begin != end; ++begin) {
    const OpenMesh::BaseProperty* property = *begin;
    if (property == nullptr || !property->persistent() || isInternal(property->name())) continue;
    ArrayValues array;
    const bool taken = anyPropertyType(
        [&](auto tag) { return takeAs<typename decltype(tag)::Type>(*property, handles, array); });
    if (!taken) {
      refuse(ErrorCode::Unsupported, "the persistent property \"" + property->name() +
                                         "\" is of a type that .bspc files cannot hold; make it a "
                                         "number, a vector, a bool or a string, or not persistent");
    }
    arrays.push_back(std::move(array));
  }
}

template <class Iterator>
void refusePersistent(Iterator begin, Iterator end, const char* owner) {
  for (; begin != end; ++begin) {
    if (*begin == nullptr || !(*begin)->persistent() || isInternal((*begin)->name())) continue;
    refuse(ErrorCode::Unsupported, std::string("the property \"") + (*begin)->name() + "\" of " +
                                       owner +
                                       " is persistent, and .bspc files hold those of vertices "
                                       "and faces only; make it not persistent");
  }
}

}  // namespace

MeshSource::MeshSource(OpenMesh::IO::BaseExporter& exporter, const Options& options)
    : exporter_(exporter), options_(options) {
  refuseOthers();
  takeVertices();
  takeFaces();
  takeAttributes(vertices_, options_.vertex_has_normal(), options_.vertex_has_color(),
                 vertexArrays_);
  if (options_.vertex_has_texcoord()) takeTextureCoordinates();
  takeAttributes(faces_, options_.face_has_normal(), options_.face_has_color(), faceArrays_);
  takeProperties();
}

void MeshSource::refuseOthers() const {
  const bool missing = (options_.vertex_has_normal() && !exporter_.has_vertex_normals()) ||
                       (options_.vertex_has_color() && !exporter_.has_vertex_colors()) ||
                       (options_.vertex_has_texcoord() && !exporter_.has_vertex_texcoords()) ||
                       (options_.face_has_normal() && !exporter_.has_face_normals()) ||
                       (options_.face_has_color() && !exporter_.has_face_colors());
  if (missing) {
    refuse(ErrorCode::InvalidArgument,
           "the options ask for attributes that the mesh does not have; request them of the mesh");
  }
  if (options_.edge_has_color() || options_.face_has_texcoord()) {
    refuse(ErrorCode::Unsupported,
           "colours of edges and texture coordinates of halfedges cannot be stored in .bspc "
           "files; leave these options out");
  }
}

void MeshSource::takeVertices() {
  const std::size_t count = exporter_.n_vertices();
  const bool doubles = exporter_.is_point_double();
  for (std::size_t i = 0; i < count; ++i) {
    const OpenMesh::VertexHandle handle(static_cast<int>(i));
    if (exporter_.has_vertex_status() && exporter_.status(handle).deleted()) continue;
    vertices_.push_back(handle);
    if (doubles) {
      const OpenMesh::Vec3d point = exporter_.pointd(handle);
      doubles_.insert(doubles_.end(), point.data(), point.data() + 3);
    } else {
      const OpenMesh::Vec3f point = exporter_.point(handle);
      floats_.insert(floats_.end(), point.data(), point.data() + 3);
    }
  }
}

void MeshSource::takeFaces() {
  constexpr std::uint32_t kGone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> numberOf(exporter_.n_vertices(), kGone);
  for (std::uint32_t i = 0; i < vertices_.size(); ++i) {
    numberOf[static_cast<std::size_t>(vertices_[i].idx())] = i;
  }
  std::vector<OpenMesh::VertexHandle> corners;
  std::vector<std::uint32_t> face;
  for (std::size_t i = 0; i < exporter_.n_faces(); ++i) {
    const OpenMesh::FaceHandle handle(static_cast<int>(i));
    if (exporter_.has_face_status() && exporter_.status(handle).deleted()) continue;
    exporter_.get_vhandles(handle, corners);
    face.clear();
    for (const OpenMesh::VertexHandle corner : corners) {
      const std::uint32_t number = numberOf[static_cast<std::size_t>(corner.idx())];
      if (number == kGone) {
        refuse(ErrorCode::InvalidArgument,
               "a face that is not deleted has a vertex that is; call "
               "garbage_collection() or repair the mesh");
      }
      face.push_back(number);
    }
    cells_.faces.add(face);
    faces_.push_back(handle);
  }
}

template <class Handle>
void MeshSource::takeAttributes(const std::vector<Handle>& handles, bool normals, bool colours,
                                std::vector<ArrayValues>& arrays) const {
  if (normals) {
    const bool doubles = exporter_.is_normal_double();
    ArrayValues array = described(kNormals, doubles ? ScalarType::Float64 : ScalarType::Float32, 3,
                                  Semantic::Normals);
    for (const Handle handle : handles) {
      if (doubles) {
        append(array.values, exporter_.normald(handle));
      } else {
        append(array.values, exporter_.normal(handle));
      }
    }
    arrays.push_back(std::move(array));
  }
  if (colours) {
    const bool alpha = options_.color_has_alpha();
    const bool floats = options_.color_is_float();
    ArrayValues array = described(kColours, floats ? ScalarType::Float32 : ScalarType::UInt8,
                                  alpha ? 4 : 3, Semantic::Colours);
    for (const Handle handle : handles) {
      if (floats && alpha) append(array.values, exporter_.colorAf(handle));
      if (floats && !alpha) append(array.values, exporter_.colorf(handle));
      if (!floats && alpha) append(array.values, exporter_.colorA(handle));
      if (!floats && !alpha) append(array.values, exporter_.color(handle));
    }
    arrays.push_back(std::move(array));
  }
  const bool hasStatus = std::is_same_v<Handle, OpenMesh::VertexHandle>
                             ? exporter_.has_vertex_status()
                             : exporter_.has_face_status();
  if (options_.vertex_has_status() && hasStatus) {
    ArrayValues array = described(kStatus, ScalarType::UInt32, 1, Semantic::None);
    for (const Handle handle : handles) {
      const std::uint32_t bits = exporter_.status(handle).bits();
      append(array.values, &bits, 1);
    }
    arrays.push_back(std::move(array));
  }
}

void MeshSource::takeTextureCoordinates() {
  ArrayValues array =
      described(kTextureCoordinates, ScalarType::Float32, 2, Semantic::TextureCoordinates);
  for (const OpenMesh::VertexHandle handle : vertices_) {
    append(array.values, exporter_.texcoord(handle));
  }
  vertexArrays_.push_back(std::move(array));
}

void MeshSource::takeProperties() {
  const OpenMesh::BaseKernel* kernel = exporter_.kernel();
  if (kernel == nullptr) return;
  takePersistent(kernel->vprops_begin(), kernel->vprops_end(), vertices_, vertexArrays_);
  takePersistent(kernel->fprops_begin(), kernel->fprops_end(), faces_, faceArrays_);
  refusePersistent(kernel->eprops_begin(), kernel->eprops_end(), "edges");
  refusePersistent(kernel->hprops_begin(), kernel->hprops_end(), "halfedges");
  refusePersistent(kernel->mprops_begin(), kernel->mprops_end(), "the mesh");
}

PointSetView MeshSource::view() const {
  PointSetView view = exporter_.is_point_double() ? PointSetView(doubles_.data(), vertices_.size())
                                                  : PointSetView(floats_.data(), vertices_.size());
  for (const ArrayValues& array : vertexArrays_) view.addArray(array.view());
  view.setMesh(&cells_);
  if (!cells_.empty()) {
    for (const ArrayValues& array : faceArrays_) view.addCellArray(array.view());
  }
  return view;
}

}  // namespace bspc::openmesh
