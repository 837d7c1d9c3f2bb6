#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/grid.h"
#include "bspc/mesh.h"
#include "bspc/point_set.h"
#include "bspc/scalar_type.h"

namespace bspc::formats {

/// A model file that cannot be read or written. what() says what is wrong, where (line and column
/// of text, byte and vertex number of binary data) and what was expected.
class FormatError : public std::runtime_error {
 public:
  explicit FormatError(const std::string& message) : std::runtime_error(message) {}
};

/// Something that a model file holds and that no array and no metadata carry.
struct OtherContent {
  enum class Kind : std::uint8_t {
    Connectivity,  ///< faces, edges and their like
    Rest,
  };
  /// How to name it: "5,660 faces", `vertex property "w" (list of float32)`.
  std::string phrase;
  Kind kind = Kind::Rest;
};

/// What is known of a model file beside where its points are and what their arrays hold.
struct ModelInfo {
  /// The type of the positions.
  ScalarType type = ScalarType::Float32;
  /// The arrays beside the positions, one tuple a point; names are unique.
  std::vector<ArrayDescription> arrays;
  /// What belongs to the whole: comments, the coordinate reference system, headers of scans.
  Metadata metadata;
  std::vector<OtherContent> otherContent;
  /// Whether the points are rows of an image or grid, so that their order says something.
  bool isOrganised = false;
  /// A lattice that every position lies on, if the file says one; its bases count for nothing.
  std::optional<Grid> lattice;
};

/// A model that was read from a file.
struct Model : ModelInfo {
  /// Three numbers of `type` a point, packed, in the byte order of this machine.
  std::vector<std::uint8_t> positions;
  /// The values of `arrays`, in that order.
  std::vector<ArrayValues> values;
  MeshCells mesh;

  std::uint64_t size() const { return positions.size() / (3 * scalarSize(type)); }
  /// Views positions, arrays and cells; the model must outlive the view.
  PointSetView view() const;
};

/// What has to be known of a model before its first point is written.
struct ModelLayout {
  ScalarType type = ScalarType::Float32;
  std::uint64_t points = 0;
  std::vector<ArrayDescription> arrays;
  /// Cells that are written behind the points; may be null, and must outlive the writer.
  const MeshCells* mesh = nullptr;
  Metadata metadata;
  /// Whether the points are in the order of the file that they once came from, all of them.
  bool keepsOrder = false;
  /// The lattice that the positions lie on, if one is known.
  std::optional<Grid> lattice;
  /// A box with all points in it, if one is known: lower corner, upper corner.
  std::optional<std::array<std::array<double, 3>, 2>> bounds;
  /// Whether the stream holds nothing but this model and can go back, so that what is known only at
  /// the end may be put into a header.
  bool mayPatch = false;
};

}  // namespace bspc::formats
