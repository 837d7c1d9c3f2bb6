#pragma once

#include <array>
#include <cstdint>

namespace bspc::connectivity {

/// What is known about a vertex that a face could have next at a gate. All are numbers around 1.
enum Feature : unsigned {
  kBias,
  kCotangent,  ///< of the new angle: Delaunay would take the largest angle
  kCosine,     ///< of the same
  kFold,       ///< 1 − cosine between the normals of the face across and the new one
  kFoldSquared,
  kGlueFold,  ///< the same across other edges that would be glued
  kGlueFoldSquared,
  kPerimeterChange,  ///< |ln| of the perimeter against that of the face across
  kPerimeter,        ///< ln of the perimeter against three gate lengths
  kParallelogram,    ///< distance from where a parallelogram would be completed
  kParallelogramLog,
  kOverlap,          ///< the new face would cross the next edge of the front
  kSliver,           ///< or leave a narrow gap to it
  kGapClosed,        ///< or close the gap
  kClosedValence,    ///< |valence − usual one| of vertices that would be closed
  kValenceExcess,    ///< faces too many at vertices that stay open
  kRank,             ///< by cotangent among the candidates that neither fold nor overlap
  kBest,             ///< it is the first of them
  kMargin,           ///< its cotangent beyond that of the best
  kApexExcess,       ///< faces too many at the candidate
  kAngleChange,      ///< |cosine − that of the face across|
  kLongestKept,      ///< the gate is the longest edge of both faces or of neither
  kCoplanarLongest,  ///< of both, and they lie in a plane
  kCoplanar,
  kFeatures
};

struct Candidate {
  std::uint32_t vertex = 0;
  /// How many edges it would glue (0, 1, 2), or 3: none, but it has faces.
  std::uint8_t kind = 0;
  float cotangent = 0;
  float score = 0;
  float probability = 0;
  std::array<float, kFeatures> feature{};
};

}  // namespace bspc::connectivity
