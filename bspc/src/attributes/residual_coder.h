#pragma once

#include <cstdint>

#include "attributes/ordered_words.h"
#include "attributes/prediction_weights.h"
#include "bspc/span.h"

namespace bspc::attributes {

/// What the words of an array are and how they are predicted.
struct ResidualSettings {
  /// How neighbours' words become a prediction.
  enum class Domain : std::uint8_t {
    Words = 0,    ///< the mean of the differences from the nearest one, modulo 2^bits
    Numbers = 1,  ///< the mean of the numbers, rounded to their type
    Unit = 2,     ///< three numbers of squares that sum up to one: the greatest from the others
    Sphere = 3,   ///< two words, places on a folded octahedron (OctahedralMap)
  };

  NumberKind kind = NumberKind::Unsigned;
  std::uint32_t components = 1;
  Predictor predictor = Predictor::Nearest;
  unsigned stiffness = 0;
  Domain domain = Domain::Words;
  std::uint32_t sphereHalf = 0;  ///< Sphere only: size of the OctahedralMap
};

/// Codes the words of the new points (those of ranks from points.known on) as differences from what
/// their neighbours let expect. `words` are those of all points, by rank; the decoder fills in
/// those of new points. The first `limit` new points are coded.
template <class Word>
Bytes writeResiduals(const RankedPoints& points, const NeighbourTable& neighbours,
                     const ResidualSettings& settings, std::vector<Word>& words, std::size_t limit);

template <class Word>
void readResiduals(ByteView stream, const RankedPoints& points, const NeighbourTable& neighbours,
                   const ResidualSettings& settings, std::vector<Word>& words);

}  // namespace bspc::attributes
