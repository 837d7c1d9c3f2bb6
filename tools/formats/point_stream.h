#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "bspc/arrays.h"
#include "bspc/mesh.h"
#include "bspc/span.h"
#include "formats/model.h"

namespace bspc::formats {

/// The points of a model file, read in pieces of the caller's size, so that a model may be larger
/// than memory. A stream holds a block of the file, whatever the file's size, unless its reader
/// says otherwise.
class PointStream {
 public:
  PointStream() = default;
  virtual ~PointStream() = default;
  PointStream(const PointStream&) = delete;
  PointStream& operator=(const PointStream&) = delete;

  /// Writes the next `count` points to `positions`: three numbers of info().type each, packed, in
  /// the byte order of this machine. Their tuples are appended to `values`, which has one array for
  /// each of info().arrays, or none, and arrays are passed over. Returns how many points there
  /// were; fewer than `count` (0 from then on) only at the end, when the whole file has been read
  /// and checked. Throws FormatError, or Error(Cancelled) once the progress callback asks to stop;
  /// the stream is then spent.
  virtual std::size_t read(std::uint8_t* positions, Span<ArrayValues> values,
                           std::size_t count) = 0;

  /// The type, the arrays and what a header tells are known from the start; otherContent is
  /// complete only once read() has returned fewer points than it was asked for.
  const ModelInfo& info() const { return info_; }

  /// Asks for the cells of meshes too, before the first read(); otherContent then does not name
  /// those that could be taken.
  virtual void keepMesh() { keepsMesh_ = true; }
  /// Whether the file may have cells; the formats of point sets never do.
  bool mayHaveMesh() const { return mayHaveMesh_; }
  /// The cells, once read() has returned fewer points than it was asked for.
  MeshCells takeMesh() { return std::move(mesh_); }

  /// For how many points there may be memory set aside: as many as the header claims, but never
  /// more than the file has bytes for; 0 if nothing is known.
  std::size_t reservable() const { return reservable_; }

 protected:
  ModelInfo info_;
  bool keepsMesh_ = false;
  bool mayHaveMesh_ = false;
  MeshCells mesh_;
  std::size_t reservable_ = 0;
};

}  // namespace bspc::formats
