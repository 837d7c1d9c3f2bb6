#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "entropy/logistic_math.h"
#include "entropy/logistic_mixer.h"
#include "geometry/predictive/features.h"
#include "geometry/predictive/near_points.h"
#include "geometry/predictive/question.h"
#include "geometry/predictive/surface.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Predictor: points of meshes and scans continue the pattern of those around them. Pairs and
/// triples of near points say where: 2a − b, and a + b − c. If a row of three
/// bends, 2a − b bends on with it, half as much. Those that would come closer than 0.3
/// spacings to a known point are left out. The longer the pairs, the less a candidate counts.
class Candidates {
 public:
  enum Kind : unsigned { kExtrapolated, kParallelogram, kProjected, kKinds };
  static constexpr unsigned kScales = 2;

  /// What one kind at one width says: its mass in either half of the box.
  struct Answer {
    float evidence = 0;
    float lower = 0;
    float upper = 0;
  };
  std::array<std::array<Answer, kScales>, kKinds> answer{};

  explicit Candidates(const Features& features)
      : features_(features), scales_(features.has(Features::kTwoScales) ? 2 : 1) {}

  /// Before a cell of side `side`, whose points are about `spacing` apart.
  void startCell(NearPoints& near, float side, float spacing);
  /// A point that has just been added to the near ones.
  void addPoint(const NearPoints& near);
  /// Chooses those in or near the box of a question and spreads each by the error of earlier ones.
  void startBox(const Question& q, float spacing, float error, const Surface& surface);

  void ask(const Question& q);
  /// The box is halved: only one half of the last question's is left.
  void take(unsigned axis, bool upper);

  /// Square distance of the nearest candidate of the best kind, at most `most`.
  float nearestSquare(float px, float py, float pz, float most) const;

  const Answer& widest(unsigned kind) const { return answer[kind][scalesOf(kind) - 1]; }
  void addEvidence(entropy::Evidence& evidence) const {
    for (unsigned kind = 0; kind < kKinds; ++kind) {
      for (unsigned s = 0; s < scalesOf(kind); ++s) evidence.add(answer[kind][s].evidence);
    }
  }

 private:
  using Lanes = entropy::Lanes;
  static constexpr unsigned kMostInCell = 640;
  static constexpr unsigned kMostInBox = 128;

  struct Kernel {
    float inverseWidth = 1;
    alignas(32) float low[3][kMostInBox];   ///< distribution function at the lower face
    alignas(32) float high[3][kMostInBox];  ///< and at the upper one
    alignas(32) float mass[3][kMostInBox];  ///< between
    alignas(32) float at[kMostInBox];       ///< at the middle of the last question
  };
  struct Group {
    unsigned count = 0;
    alignas(32) float place[3][kMostInBox];
    alignas(32) float weight[kMostInBox];
    std::array<Kernel, kScales> kernel;
    void add(float x, float y, float z, float w) {
      if (count >= kMostInBox) return;
      weight[count] = w;
      place[0][count] = x;
      place[1][count] = y;
      place[2][count] = z;
      ++count;
    }
  };

  /// Those that were moved onto the surface count at the greater width alone.
  unsigned scalesOf(unsigned kind) const { return kind == kProjected ? 1 : scales_; }
  /// `square`: of the pair's length, or of the parallelogram's sides together.
  void propose(const NearPoints& near, Kind kind, float x, float y, float z, float square);
  void extrapolate(const NearPoints& near, const Vector3& a, const Vector3& b, float square);
  void proposeAround(const NearPoints& near, unsigned t);
  BSPC_LANES_INLINE std::uint32_t inCell(const Lanes& x, const Lanes& y, const Lanes& z) const {
    return entropy::maskBits((entropy::magnitude(x - middle_) <= reach_) &
                             (entropy::magnitude(y - middle_) <= reach_) &
                             (entropy::magnitude(z - middle_) <= reach_));
  }
  void dropNear(float px, float py, float pz);
  void project(const Surface& surface, float spacing, Group& from);
  void spread(const Question& q, unsigned kind);

  Features features_;
  unsigned scales_;
  float middle_ = 0;         ///< of the cell, on each axis
  float reach_ = 0;          ///< candidates lie within so much of it
  float pairSquare_ = 0;     ///< pairs lie closer
  float minimumSquare_ = 0;  ///< candidates and known points do not
  float inverseSquare_ = 1;  ///< of the spacing in the cell
  unsigned listed_ = 0;
  alignas(32) float x_[kMostInCell + entropy::kLanes];
  alignas(32) float y_[kMostInCell + entropy::kLanes];
  alignas(32) float z_[kMostInCell + entropy::kLanes];
  std::array<float, kMostInCell> weight_{};
  std::array<std::uint8_t, kMostInCell> kind_{};
  std::array<std::uint32_t, NearPoints::kMost> pairs_{};  ///< bit j of i: i and j are a pair
  std::array<Group, kKinds> group_{};
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
