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
/// bends, 2a − b bends on with it, half as much. Those that would come closer than 0.47
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
      : features_(features),
        speaks_{true, features.has(Features::kSeparateKinds), features.has(Features::kProjection)},
        scales_(features.has(Features::kTwoScales) ? 2 : 1) {}

  /// Before a cell of side `side`, whose points are about `spacing` apart.
  void startCell(NearPoints& near, float side, float spacing);
  /// A point that has just been added to the near ones.
  void addPoint(const NearPoints& near);
  /// Chooses those in or near the box of a question and spreads each by the error of earlier ones.
  void startBox(const Question& q, float spacing, float error, const Surface& surface);

  void ask(const Question& q);
  /// The box is halved: only one half of the last question's is left. Now and then those that the
  /// remaining box holds too little of to matter are forgotten.
  void take(unsigned axis, bool upper);

  /// Instead of startBox() before the only point of a box is coded axis by axis: weighs all kinds
  /// together by their mass in the box.
  void startResiduals(const Question& q, float spacing, float error);
  /// Where along an axis they lie.
  struct Moments {
    float mean = 0;  ///< from the place asked for
    float variance = 0;
    float unexplained = 1;  ///< 0 to 1: how little their whole mass is
  };
  Moments momentsAlong(unsigned axis, float from) const;
  /// The point is known to lie at `place` along an axis: they count the less the farther they are.
  void weighAt(unsigned axis, float place);
  /// Square of what a candidate's place is wrong by, at least.
  float kernelVariance() const {
    const float width = group_[kExtrapolated].kernel[0].inverseWidth;
    return 0.25F / (width * width);
  }

  /// Square distance of the nearest candidate of the best kind, at most `most`.
  float nearestSquare(float px, float py, float pz, float most) const;

  /// Whether candidates of a kind are told apart from the others.
  bool speaks(unsigned kind) const { return speaks_[kind]; }
  const Answer& widest(unsigned kind) const { return answer[kind][scalesOf(kind) - 1]; }
  void addEvidence(entropy::Evidence& evidence) const {
    for (unsigned kind = 0; kind < kKinds; ++kind) {
      if (!speaks(kind)) continue;
      for (unsigned s = 0; s < scalesOf(kind); ++s) evidence.add(answer[kind][s].evidence);
    }
  }

 private:
  using Lanes = entropy::Lanes;
  static constexpr unsigned kMostInCell = 2048;
  static constexpr unsigned kMostInBox = 512;
  static constexpr unsigned kWorthPacking = 32;
  static constexpr unsigned kPackingPace = 3;  ///< halvings
  /// Of arrays that are walked together. Were it a power of two, their first entries, the ones in
  /// use, would all fall on the same few lines of the cache.
  static constexpr unsigned kStride = kMostInBox + 5 * entropy::kLanes;

  struct Kernel {
    float inverseWidth = 1;
    alignas(32) float low[3][kStride];   ///< distribution function at the lower face
    alignas(32) float high[3][kStride];  ///< and at the upper one
    alignas(32) float mass[3][kStride];  ///< between
    alignas(32) float at[kStride];       ///< at the middle of the last question
  };
  struct Group {
    unsigned count = 0;
    alignas(32) float place[3][kStride];
    alignas(32) float weight[kStride];
    std::array<Kernel, kScales> kernel;
    void grow(unsigned more) { count = std::min(count + more, kMostInBox); }
  };
  /// Candidates of the cell, of one kind where kinds are separate.
  struct List {
    unsigned count = 0;
    alignas(32) float x[kMostInCell + entropy::kLanes];
    alignas(32) float y[kMostInCell + entropy::kLanes];
    alignas(32) float z[kMostInCell + entropy::kLanes];
    alignas(32) float weight[kMostInCell + entropy::kLanes];
  };
  /// What one near point makes with the others, before it is known whether it may stay.
  struct Proposals {
    /// t + j − k of any two others, j + k − t of each two; eight more are written behind.
    static constexpr std::size_t kMost =
        std::size_t{NearPoints::kMost} * NearPoints::kMost * 3 / 2 + entropy::kLanes;
    unsigned count = 0;
    alignas(32) float x[kMost];
    alignas(32) float y[kMost];
    alignas(32) float z[kMost];
    alignas(32) float square[kMost];  ///< of the pair's length, or of both sides together

    BSPC_LANES_INLINE void add(std::uint32_t chosen, const Lanes& px, const Lanes& py,
                               const Lanes& pz, const Lanes& squares) {
      const entropy::Packing packing(chosen);
      packing.store(x + count, px);
      packing.store(y + count, py);
      packing.store(z + count, pz);
      packing.store(square + count, squares);
      count += packing.count();
    }
  };

  /// Those that were moved onto the surface count at the greater width alone.
  unsigned scalesOf(unsigned kind) const { return kind == kProjected ? 1 : scales_; }
  void proposeAround(const NearPoints& near, unsigned t);
  void extrapolate(const NearPoints& near, unsigned t, std::uint32_t pairs);
  void bend(const NearPoints& near);
  void span(const NearPoints& near, unsigned t, std::uint32_t pairs);
  void listProposed(Kind kind);
  void addInner(const NearPoints& near, unsigned t);
  List& listOf(Kind kind) {
    return list_[features_.has(Features::kSeparateKinds) ? kind : kExtrapolated];
  }
  BSPC_LANES_INLINE std::uint32_t inCell(const Lanes& x, const Lanes& y, const Lanes& z) const {
    return entropy::maskBits((entropy::magnitude(x - middle_) <= reach_) &
                             (entropy::magnitude(y - middle_) <= reach_) &
                             (entropy::magnitude(z - middle_) <= reach_));
  }
  void dropNear(float px, float py, float pz);
  void choose(const Question& q, float margin, const List& from, Group& to);
  void project(const Surface& surface, float spacing, const Group& from);
  void spread(const Question& q, unsigned kind);
  void packGroup(unsigned kind);
  static void padGroup(Group& group);

  Features features_;
  std::array<bool, kKinds> speaks_;
  unsigned scales_;
  float middle_ = 0;         ///< of the cell, on each axis
  float reach_ = 0;          ///< candidates lie within so much of it
  float innerReach_ = 0;     ///< and known points that are close to one within so much
  float pairSquare_ = 0;     ///< pairs lie closer
  float minimumSquare_ = 0;  ///< candidates and known points do not
  float inverseSquare_ = 1;  ///< of the spacing in the cell
  std::array<List, kProjected> list_;
  Proposals proposed_;
  Proposals before_;  ///< where a row would have begun that goes on to a proposed place
  unsigned inners_ = 0;
  std::array<Vector3, NearPoints::kMost> inner_{};  ///< near points that may be close to candidates
  std::array<std::uint32_t, NearPoints::kMost> pairs_{};  ///< bit j of i: i and j are a pair
  std::array<Group, kKinds> group_{};
  unsigned halvings_ = 0;                 ///< since startBox()
  alignas(32) float boxMass_[kStride]{};  ///< startResiduals() and weighAt()
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
