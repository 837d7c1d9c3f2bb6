#pragma once

#include <cstdint>
#include <vector>

#include "bspc/encoder.h"
#include "choices.h"

namespace bspc::fuzz {

/// A point set or a mesh that an input chooses, with what it is to be encoded like.
struct RoundTripInput {
  explicit RoundTripInput(Choices& choices);

  PointSetView view() const;
  /// The points `first` … `first + count − 1` with their arrays, without cells.
  PointSetView part(std::uint64_t first, std::uint64_t count) const;
  std::uint64_t size() const { return positions.size() / (3 * scalarSize(type)); }

  ScalarType type = ScalarType::Float32;
  Bytes positions;  ///< three numbers of `type` a point
  std::vector<ArrayValues> arrays;
  MeshCells cells;
  std::vector<ArrayValues> cellArrays;
  EncodeOptions options;

 private:
  void chooseOptions(Choices& choices);
  void chooseGrid(Choices& choices);
  void chooseMetadata(Choices& choices);
  void choosePoints(Choices& choices);
  void chooseCells(Choices& choices);
};

}  // namespace bspc::fuzz
