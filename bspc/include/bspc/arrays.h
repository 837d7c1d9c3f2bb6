#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bspc/scalar_type.h"
#include "bspc/span.h"

namespace bspc {

/// What an array means, where somebody knows: lets readers set normals, colours and so on.
enum class Semantic : std::uint8_t {
  None = 0,
  Scalars = 1,  ///< the array to colour by
  Normals = 2,
  Colours = 3,
  TextureCoordinates = 4,
  Ids = 5,
};

/// What is known of an array without its values. Names are unique in a file.
struct ArrayDescription {
  std::string name;  ///< UTF-8, not empty
  ScalarType type = ScalarType::Float32;
  std::uint32_t components = 1;             ///< numbers (or strings) a tuple, at least 1
  std::vector<std::string> componentNames;  ///< empty, or one a component (each may be empty)
  std::string unit;                         ///< of the values, as people write it; empty: unknown
  Semantic semantic = Semantic::None;
  /// Greatest error of a value that is allowed (in a file: that was allowed); 0: none, every value
  /// comes back bit for bit. For floating-point arrays; for normals of three components it is the
  /// angle between what went in and what comes back, in degrees.
  double tolerance = 0;
};

/// A named array that somebody else owns: `tuples` tuples, `strideBytes` apart (0: packed). A tuple
/// is `components` packed values in the byte order of this machine: numbers of `type`; for Bit, a
/// byte of 0 or 1 each; for String, a std::string each.
struct ArrayView : ArrayDescription {
  std::uint64_t tuples = 0;
  const void* data = nullptr;
  std::size_t strideBytes = 0;
};

/// A named array with its values, packed as in ArrayView.
struct ArrayValues : ArrayDescription {
  Bytes values;                      ///< of all types but String
  std::vector<std::string> strings;  ///< of type String

  std::uint64_t tuples() const;
  /// Views the values; this must outlive the view.
  ArrayView view() const;
};

/// Bytes of one value of an array in memory: scalarSize, 1 for Bit, sizeof(std::string) for String.
std::size_t arrayValueSize(ScalarType type);

/// What a file says beside its points.
struct Metadata {
  std::string crs;         ///< coordinate reference system, as WKT or "EPSG:25832"; empty: unknown
  std::string lengthUnit;  ///< of the coordinates, such as "m"; empty: unknown
  std::vector<std::pair<std::string, std::string>> entries;  ///< free text by unique key
  std::vector<ArrayValues> fieldData;  ///< arrays that belong to the whole, of any length

  bool empty() const {
    return crs.empty() && lengthUnit.empty() && entries.empty() && fieldData.empty();
  }
};

}  // namespace bspc
