#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bspc/grid.h"
#include "bspc/span.h"
#include "geometry/predictive/pinhole_camera.h"

namespace bspc::geometry::predictive {

/// Points grouped by their depth. Encoder only.
class DepthClasses {
 public:
  /// Place of a point beside the depth axis.
  using Place = std::array<std::uint32_t, 2>;

  /// Groups points by their coordinate along `axis`, of which `extent` is the greatest; none if
  /// that would not be the depth of a camera: too many different ones for so few points.
  static std::optional<DepthClasses> of(Span<const GridPoint> points, unsigned axis,
                                        std::uint32_t extent);

  std::size_t size() const { return depths_.size(); }
  std::uint32_t depth(std::size_t i) const { return depths_[i]; }
  Span<const Place> places(std::size_t i) const {
    return Span<const Place>(places_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  /// For each place the index of its point.
  Span<const std::uint32_t> indices(std::size_t i) const {
    return Span<const std::uint32_t>(indices_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  std::size_t points() const { return places_.size(); }

  /// About `wanted` of the points, and only classes that keep at least `least` of them.
  DepthClasses sample(std::size_t wanted, std::size_t least) const;

 private:
  std::vector<std::uint32_t> depths_;  ///< rising
  std::vector<std::size_t> first_;     ///< where the points of a class begin; one entry more
  std::vector<Place> places_;
  std::vector<std::uint32_t> indices_;
};

struct ShiftChoice {
  int shift = 0;
  std::size_t mismatches = 0;  ///< coordinates that the camera puts a step or more elsewhere
};

/// The shift with which a camera explains most coordinates of a class; the smallest of equals.
/// None if pixels are too small there to be told apart.
std::optional<ShiftChoice> chooseShift(const PinholeCamera& camera, std::uint32_t depth,
                                       Span<const DepthClasses::Place> places);

}  // namespace bspc::geometry::predictive
