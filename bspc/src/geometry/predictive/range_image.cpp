#include "geometry/predictive/range_image.h"

#include <algorithm>
#include <cmath>

#include "geometry/predictive/depth_classes.h"

namespace bspc::geometry::predictive {

namespace {

/// A point seen by the camera.
struct Sighting {
  std::array<std::int32_t, 2> at{};  ///< column, row
  RangePixel pixel;
  std::uint32_t index = 0;
};

/// Pixel numbers that leave room for an image of 2^16 columns or rows in 16 bits.
constexpr double kMaxPixel = 16384;

std::optional<Sighting> sighting(const PinholeCamera& camera, const std::array<double, 2>& size,
                                 const DepthClasses::Place& place) {
  Sighting s;
  for (unsigned k = 0; k < 2; ++k) {
    const double pixel = camera.pixelAt(k, place[k], size[k]);
    if (!(std::fabs(pixel) < kMaxPixel)) return std::nullopt;
    s.at[k] = static_cast<std::int32_t>(pixel);
    const double error = static_cast<double>(place[k]) - camera.position(k, s.at[k], size[k]);
    if (!(std::fabs(error) <= 1)) return std::nullopt;
    s.pixel.error[k] = static_cast<std::int8_t>(error);
  }
  return s;
}

/// All points that the camera sees, depth by depth; fills in the depths of the head.
std::vector<Sighting> sightingsOf(const DepthClasses& classes, RangeImageHead& head,
                                  std::vector<std::uint32_t>& left) {
  std::vector<Sighting> sightings;
  sightings.reserve(classes.points());
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const std::optional<ShiftChoice> choice =
        chooseShift(head.camera, classes.depth(i), classes.places(i));
    const std::size_t before = sightings.size();
    for (std::size_t j = 0; j < classes.places(i).size(); ++j) {
      const std::uint32_t index = classes.indices(i)[j];
      std::optional<Sighting> s;
      if (choice) {
        const std::array<double, 2> size = {
            head.camera.pixelSize(0, classes.depth(i), choice->shift),
            head.camera.pixelSize(1, classes.depth(i), choice->shift)};
        s = sighting(head.camera, size, classes.places(i)[j]);
      }
      if (!s) {
        left.push_back(index);
        continue;
      }
      s->index = index;
      s->pixel.rank = static_cast<std::int32_t>(head.depths.size());
      sightings.push_back(*s);
    }
    if (sightings.size() == before) continue;
    head.depths.push_back(classes.depth(i));
    head.shifts.push_back(static_cast<std::int8_t>(choice->shift));
  }
  return sightings;
}

}  // namespace

std::optional<RangeImage> arrangeRangeImage(Span<const GridPoint> points, const GridPoint& extent,
                                            const PinholeCamera& camera) {
  const std::optional<DepthClasses> classes =
      DepthClasses::of(points, camera.depthAxis, extent[camera.depthAxis]);
  if (!classes) return std::nullopt;
  RangeImage image;
  image.head.camera = camera;
  const std::vector<Sighting> sightings = sightingsOf(*classes, image.head, image.left);
  if (sightings.empty()) return std::nullopt;
  std::array<std::int32_t, 2> last = sightings[0].at;
  image.head.first = last;
  for (const Sighting& s : sightings) {
    for (unsigned k = 0; k < 2; ++k) {
      image.head.first[k] = std::min(image.head.first[k], s.at[k]);
      last[k] = std::max(last[k], s.at[k]);
    }
  }
  for (unsigned k = 0; k < 2; ++k) {
    image.head.size[k] = static_cast<std::uint32_t>(last[k] - image.head.first[k] + 1);
  }
  const std::uint64_t pixels = std::uint64_t{image.head.size[0]} * image.head.size[1];
  if (pixels > RangeImageHead::kMaxPixelsAPoint * points.size()) return std::nullopt;
  image.pixels.resize(static_cast<std::size_t>(pixels));
  image.indices.resize(static_cast<std::size_t>(pixels));
  for (const Sighting& s : sightings) {
    const auto column = static_cast<std::size_t>(s.at[0] - image.head.first[0]);
    const auto row = static_cast<std::size_t>(s.at[1] - image.head.first[1]);
    const std::size_t at = row * image.head.size[0] + column;
    if (image.pixels[at].rank != RangePixel::kEmpty) {
      image.left.push_back(s.index);
      continue;
    }
    image.pixels[at] = s.pixel;
    image.indices[at] = s.index;
  }
  if (4 * image.left.size() > points.size()) return std::nullopt;
  std::sort(image.left.begin(), image.left.end());
  return image;
}

}  // namespace bspc::geometry::predictive
