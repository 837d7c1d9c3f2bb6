#pragma once

#include <cstdint>

#include "attributes/quick_coder.h"
#include "attributes/residual_coder.h"
#include "bspc/scalar_type.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"

namespace bspc::attributes {

/// How the payload of an array is coded (docs/format.md, "Arrays"): the low half of its first byte;
/// the high half is the version of the method.
enum class ArrayMethod : std::uint8_t {
  Constant = 0,
  Bytes = 1,
  Quick = 2,
  Residual = 3,
  Mixing = 4,
  Categories = 5,
  Strings = 6,
  Quantised = 7,
  Sphere = 8,
};

/// What the numbers of a payload are: those of an array, or those that a lossy method makes of
/// them.
struct NumberShape {
  ScalarType type = ScalarType::Float32;
  std::uint32_t components = 1;
  std::uint32_t sphereHalf =
      0;  ///< two components are a place of such an OctahedralMap; 0: are not
};

void writeMethod(ArrayMethod method, container::ByteWriter& out);

/// Throws Error(Unsupported) for methods and versions that are not known.
ArrayMethod readMethod(container::ByteReader& in);

/// Settings of method Bytes.
struct BytesSettings {
  bool inputOrder = false;
  bool delta = false;   ///< words minus those of the tuple before
  bool planes = false;  ///< a row for each byte of a tuple instead of one for all
};

/// Settings of method Categories but for its alphabet.
struct CategorySettings {
  bool inputOrder = false;  ///< contexts are the points before, else the nearest
  bool delta = false;       ///< in the order of the input: words minus those of the tuple before
};

// A byte for the settings of a method, and back. The readers throw Error(Corrupt) for settings that
// make no sense for the shape.

unsigned packed(const BytesSettings& settings);
unsigned packed(const QuickSettings& settings);
unsigned packed(const ResidualSettings& settings);
unsigned packed(const CategorySettings& settings, bool escapes);

BytesSettings readBytesSettings(container::ByteReader& in);
QuickSettings readQuickSettings(container::ByteReader& in, const NumberShape& shape);
ResidualSettings readResidualSettings(container::ByteReader& in, const NumberShape& shape);
CategorySettings readCategorySettings(container::ByteReader& in, bool& escapes);

/// The settings that the shape alone gives.
QuickSettings quickSettings(const NumberShape& shape);
ResidualSettings residualSettings(const NumberShape& shape);

/// Whether the numbers of a shape can be predicted in the given way.
bool allows(const NumberShape& shape, QuickSettings::Domain domain);
bool allows(const NumberShape& shape, ResidualSettings::Domain domain);

}  // namespace bspc::attributes
