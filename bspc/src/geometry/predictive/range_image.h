#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bspc/grid.h"
#include "bspc/span.h"
#include "geometry/predictive/pinhole_camera.h"

namespace bspc::geometry::predictive {

/// A pixel of a range image: which of the image's depths it has, and how far its point lies from
/// where the camera would have it.
struct RangePixel {
  static constexpr std::int32_t kEmpty = -1;

  std::int32_t rank = kEmpty;          ///< index into RangeImageHead::depths
  std::array<std::int8_t, 2> error{};  ///< −1, 0 or 1 along camera.axis(0), camera.axis(1)
};

/// What a range image says before its pixels.
struct RangeImageHead {
  PinholeCamera camera;
  std::array<std::int32_t, 2> first{};  ///< the pixel at the image's corner; 16 bits
  std::array<std::uint32_t, 2> size{};  ///< columns and rows; 1 … kMaxSize
  std::vector<std::uint32_t> depths;    ///< that occur, rising; at most kMaxDepths
  std::vector<std::int8_t> shifts;      ///< for each depth, see PinholeCamera

  static constexpr unsigned kSizeBits = 16;
  static constexpr std::uint32_t kMaxSize = 1U << kSizeBits;
  static constexpr std::size_t kMaxDepths = std::size_t{1} << 16;
  /// An image is at least so full: at most that many pixels for each point of its tile.
  static constexpr std::uint64_t kMaxPixelsAPoint = 16;
};

/// The encoder's arrangement of points as an image.
struct RangeImage {
  RangeImageHead head;
  std::vector<RangePixel> pixels;      ///< row by row
  std::vector<std::uint32_t> indices;  ///< of the pixels' points
  std::vector<std::uint32_t> left;     ///< indices of points that have no pixel, rising
};

/// Arranges points, of which `extent` has the greatest coordinates, as `camera` sees them. None if
/// that leaves more than a quarter of them, or would take too many pixels.
std::optional<RangeImage> arrangeRangeImage(Span<const GridPoint> points, const GridPoint& extent,
                                            const PinholeCamera& camera);

}  // namespace bspc::geometry::predictive
