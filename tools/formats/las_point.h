#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "bspc/arrays.h"

namespace bspc::formats {

constexpr unsigned kLasPointFormats = 11;

/// Something that a point of a LAS file has beside its position ("LAS Specification 1.4 - R15",
/// Point Data Records): whole numbers of `array`'s type, one after the other, or some bits of a
/// byte, which are an array of UInt8.
struct LasField {
  ArrayDescription array;
  std::size_t offset = 0;  ///< from the start of the record, in bytes
  unsigned shift = 0;      ///< of the lowest of the bits
  unsigned bits = 0;       ///< 0: whole numbers

  /// What a byte that has the bits is ANDed with once it is shifted down.
  unsigned mask() const { return (1U << bits) - 1U; }
};

/// Bytes of a point record of this format, 0 … 10, without extra bytes.
std::size_t lasRecordBytes(unsigned pointFormat);

/// All fields of a point format but X, Y and Z, under the names that PDAL gives them.
std::vector<LasField> lasFields(unsigned pointFormat);

/// Whether points of the format are said to have waveforms.
bool lasHasWaveforms(unsigned pointFormat);

/// An attribute of a point in its extra bytes, as a record of 192 bytes describes it.
struct LasExtraField {
  ArrayDescription array;
  std::size_t offset = 0;  ///< from the start of the extra bytes
  std::size_t bytes = 0;
  /// Whether it is one number, which may be a component of an array.
  bool isScalar = false;
};

constexpr std::size_t kLasExtraDescription = 192;

/// Name of the array of extra bytes that nothing describes.
constexpr const char* kLasExtraBytes = "ExtraBytes";

/// The attributes that the descriptions tell of, as far as they lie within `extraBytes`; what is
/// left over is ExtraBytes.
std::vector<LasExtraField> lasExtraFields(ByteView descriptions, std::size_t extraBytes);

/// The number by which a description tells the type of one number; 0 if there is none.
unsigned lasExtraType(ScalarType type);

}  // namespace bspc::formats
