#pragma once

#include <array>

#include "entropy/logistic_math.h"
#include "geometry/predictive/neighbourhood.h"
#include "geometry/predictive/question.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

using Vector3 = std::array<float, 3>;

inline float dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A quantity that lies within ± half of 0 is spread around `middle` with a scale of
/// 1 / inverseScale. The default knows nothing.
struct Spread {
  float middle = 0;
  float inverseScale = 0;
  float half = 0;
};

/// ln of the odds that a quantity lies in the upper half; 0 of the default.
inline float halvesLogit(const Spread& s) {
  const float at = entropy::bell((0.0F - s.middle) * s.inverseScale);
  const float low = entropy::bell((0.0F - s.half - s.middle) * s.inverseScale);
  const float high = entropy::bell((s.half - s.middle) * s.inverseScale);
  return entropy::naturalLog((high - at + 1e-5F) / (at - low + 1e-5F));
}

/// The same of up to eight quantities at a time.
class HalvesLogits {
 public:
  void add(const Spread& spread) {
    middle_[count_] = spread.middle;
    inverseScale_[count_] = spread.inverseScale;
    half_[count_++] = spread.half;
  }
  std::array<float, entropy::kLanes> values() const {
    using entropy::Lanes;
    const Lanes middle = entropy::load(middle_.data());
    const Lanes inverseScale = entropy::load(inverseScale_.data());
    const Lanes half = entropy::load(half_.data());
    const Lanes at = entropy::bell((0.0F - middle) * inverseScale);
    const Lanes low = entropy::bell((0.0F - half - middle) * inverseScale);
    const Lanes high = entropy::bell((half - middle) * inverseScale);
    return entropy::valuesOf(entropy::naturalLog((high - at + 1e-5F) / (at - low + 1e-5F)));
  }

 private:
  unsigned count_ = 0;
  alignas(32) std::array<float, entropy::kLanes> middle_{};
  alignas(32) std::array<float, entropy::kLanes> inverseScale_{};
  alignas(32) std::array<float, entropy::kLanes> half_{};
};

/// Weighted least-squares plane through a neighbourhood (principal component analysis).
struct Plane {
  bool valid = false;
  Vector3 normal{};
  Vector3 through{};   ///< grid steps
  float variance = 0;  ///< of distances to it, square grid steps

  /// Where along the question's axis the plane is, from the middle of the box.
  Spread spreadIn(const Question& q) const;
};

/// Height above a plane as a quadratic function of the place in it, in units of the spacing.
struct Quadric {
  bool valid = false;
  Vector3 u{};
  Vector3 v{};
  Vector3 normal{};
  Vector3 centre{};             ///< grid steps
  float inverseSpacing = 1;     ///< units per grid step
  std::array<float, 6> term{};  ///< of 1, u, v, u², uv, v²

  struct Value {
    float height = 0;  ///< of the place above the surface, along the normal, in units
    Vector3 gradient{};
  };
  Value at(float x, float y, float z) const;
  float heightAt(float x, float y, float z) const { return at(x, y, z).height; }

  /// As of a plane, and once more as if heights were less wrong. `error`: the scale of what they
  /// are wrong by, in units.
  std::array<Spread, 2> spreadsIn(const Question& q, float error, float narrowError) const;
};

/// Predictor: the surface that the neighbourhood lies on.
class Surface {
 public:
  Plane plane;
  Quadric quadric;

  /// Fits to the neighbourhood, nearer and smaller parts counting more. `reach`: where weights
  /// of the plane have fallen to half, in spacings.
  void fit(const Neighbourhood& near, const Vector3& centre, float spacing, float reach,
           bool wantQuadric);

 private:
  /// Coordinates in units around the centre, by lanes.
  struct Scaled {
    unsigned groups = 0;
    std::array<entropy::Lanes, Neighbourhood::kRoom / entropy::kLanes> x, y, z, size, present;
  };
  void fitPlane(const Scaled& near, const Vector3& centre, float spacing, float reach);
  void fitQuadric(const Scaled& near, const Vector3& centre, float spacing);
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
