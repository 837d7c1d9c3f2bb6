#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bspc/grid.h"
#include "bspc/point_set.h"
#include "bspc/scalar_type.h"
#include "bspc/span.h"

namespace bspc::formats {

/// A model file that cannot be read or written. what() says what is wrong, where (line and column
/// of text, byte and vertex number of binary data) and what was expected.
class FormatError : public std::runtime_error {
 public:
  explicit FormatError(const std::string& message) : std::runtime_error(message) {}
};

/// What is known of a model file beside where its points are.
struct ModelInfo {
  /// The type of the positions.
  ScalarType type = ScalarType::Float32;
  /// What the file holds beside positions, as phrases: `vertex property "red" (uint8)`,
  /// "5,660 faces".
  std::vector<std::string> otherContent;
  /// Texts of the comment and obj_info lines of a PLY header.
  std::vector<std::string> comments;
  /// A lattice that every position lies on, if the file says one; its bases count for nothing.
  std::optional<Grid> lattice;
};

/// A model that was read from a file.
struct Model : ModelInfo {
  /// Three numbers of `type` a point, packed, in the byte order of this machine.
  std::vector<std::uint8_t> positions;

  std::uint64_t size() const { return positions.size() / (3 * scalarSize(type)); }
  /// Views the positions; the model must outlive the view.
  PointSetView view() const { return PointSetView(positions.data(), type, size(), 0); }
};

/// One whole number a point that goes into a file beside the positions.
struct PointColumn {
  std::string name;
  Span<const std::uint64_t> values;
};

/// What is to be written. Owns nothing but the names.
struct ModelView {
  PointSetView points;
  std::vector<PointColumn> columns;
};

/// A column that is to be written, and the greatest number in it.
struct ColumnLayout {
  std::string name;
  std::uint64_t greatest = 0;
};

/// What has to be known of a model before its first point is written.
struct ModelLayout {
  ScalarType type = ScalarType::Float32;
  std::uint64_t points = 0;
  std::vector<ColumnLayout> columns;
};

}  // namespace bspc::formats
