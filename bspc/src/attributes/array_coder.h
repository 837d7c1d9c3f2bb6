#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "attributes/tile_points.h"
#include "bspc/point_set.h"
#include "bspc/scalar_type.h"
#include "bspc/span.h"

namespace bspc::attributes {

/// What the numbers of an array are; both encoder and decoder know it before the payload.
struct ArrayShape {
  ScalarType type = ScalarType::Float32;
  std::uint32_t components = 1;
  Semantic semantic = Semantic::None;
};

/// The tuples of a tile in memory, in the order of its points.
struct ArrayValues {
  /// Packed numbers in the machine's (little-endian) form; Bit: a byte a number, 0 or 1.
  Bytes numbers;
  /// String only: components strings a tuple; numbers is empty then.
  std::vector<std::string> strings;
};

/// What an encoder may do.
struct ArrayWishes {
  unsigned effort = 2;  ///< 1 … 4: quick methods; 5 … 9: full ones, more tries the higher
  /// Floating point only: 0 is lossless, else |restored − given| ≤ maxError for each finite number.
  /// NaN and infinities come back as they were.
  double maxError = 0;
  /// Semantic Normals with three floating-point components only: 0 is lossless, else the angle
  /// between given and restored, in degrees, is at most this; restored vectors have length one
  /// (tuples of another length come back with their own bits). Goes before maxError.
  double maxAngle = 0;
};

struct EncodedArray {
  Bytes payload;
  /// What the loss was: the greatest |restored − given|, or angle in degrees; 0 if lossless.
  double greatestError = 0;
  /// Whether the payload can be decoded only with TilePoints::setInputOrder. Files note it, so that
  /// readers leave the order on the disk.
  bool usesInputOrder = false;
};

/// Codes the tuples of the new points of `points`; those of the known points are known to the
/// decoder too. `values` holds the tuples of all points, known ones first. With loss, new tuples
/// are replaced by what the decoder will restore, so that they can be the known ones of the next
/// layer. Several arrays of a tile share one TilePoints, which is all the state there is.
///
/// Throws Error(InvalidArgument) if the values are not as many as the points.
EncodedArray encodeArray(const ArrayShape& shape, ArrayValues& values, TilePoints& points,
                         const ArrayWishes& wishes);

/// Appends the tuples of the new points to `values`, which holds those of the known points.
/// `maxBytes` bounds the memory of the output and of all that is allocated on the way.
///
/// Throws Error(Corrupt, Unsupported, LimitExceeded); any bytes are safe. Whether the payload needs
/// the order of the input (TilePoints::setInputOrder) stands in it; without it Error(Corrupt).
void decodeArray(const ArrayShape& shape, ByteView payload, TilePoints& points,
                 std::uint64_t maxBytes, ArrayValues& values);

}  // namespace bspc::attributes
