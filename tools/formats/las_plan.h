#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bspc/arrays.h"
#include "formats/las_point.h"
#include "formats/model.h"

namespace bspc::formats {

/// A field of the point format and the array that fills it.
struct LasFilledField {
  LasField field;
  std::size_t array = 0;
  /// What values are multiplied by: 256 for colours of a byte, as the specification wants them.
  unsigned factor = 1;
};

/// A number among the extra bytes of a point.
struct LasExtraNumber {
  std::string name;
  ScalarType type = ScalarType::UInt8;
  std::size_t array = 0;
  std::size_t component = 0;
  std::size_t offset = 0;  ///< from the start of the record
};

/// How a model becomes a LAS file.
struct LasPlan {
  unsigned minorVersion = 2;
  unsigned pointFormat = 0;
  std::size_t recordBytes = 20;
  std::array<double, 3> scale{};
  std::array<double, 3> offset{};
  std::vector<LasFilledField> fields;
  std::vector<LasExtraNumber> extras;
  /// What describes the extra bytes.
  Bytes extraDescriptions;
};

/// Chooses the point format that the metadata name if all arrays with names of fields have a place
/// there, else the first of 6 to 10 and 0 to 5 where most have; arrays of other names or types
/// become extra bytes. Version 1.4 is taken where anything needs it or nothing else is wished.
///
/// The scale and offset are those of the metadata, of the lattice that the positions lie on, or
/// such that the box fits into 32 bits, whichever is there first.
LasPlan planLas(const ModelLayout& layout);

}  // namespace bspc::formats
