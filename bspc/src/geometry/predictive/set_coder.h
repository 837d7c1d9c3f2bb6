#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "bspc/error.h"
#include "geometry/predictive/mirror_coder.h"
#include "geometry/predictive/range_image_coder.h"
#include "geometry/predictive/tile_structure.h"
#include "geometry/predictive/tree_coder.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Codes the points of a tile whose tree has no coarse layers: as a range image, as points and
/// their mirrored copies, or by the tree, which also takes what the others leave.
///
/// Beside what TreeCoder needs, `Points` offers
///   std::size_t size(), GridPoint at(i)             the points coded so far, in their order
///   void append(const GridPoint&, index)            the next of them, and what the encoder calls
///   it void select(std::vector<std::uint32_t>)         the encoder's points that the tree is to
///   code const GridPoint& input(index)                   an encoder's point
/// where only the encoder's are meant, the decoder's do nothing.
template <class Coder, class Points>
class SetCoder {
 public:
  using Indices = std::vector<std::uint32_t>;
  using Tree = TreeCoder<Coder, Points>;

  SetCoder(const Features& features, const GridPoint& extent, Tree& tree, Points& points)
      : features_(features), extent_(extent), tree_(tree), points_(points) {}

  /// Codes `count` points; `structure` and `all`, their indices, are the encoder's.
  void code(Coder& coder, const TileStructure& structure, std::uint32_t count, Indices all) {
    const bool mayBeImage = features_.has(Features::kRangeImage) && count >= kLeastImage;
    if (mayBeImage && coder.fixedBit(kRarely, structure.image.has_value())) {
      const std::uint32_t left = codeImage(coder, structure.image, count);
      codePlainly(coder, left, structure.image ? structure.image->left : Indices());
      return;
    }
    codeSet(coder, structure.plane, count, std::move(all), kMostPlanes);
  }

 private:
  static constexpr std::uint32_t kRarely = 2048;  ///< of 65536
  static constexpr std::uint32_t kLeastImage = 4000;
  static constexpr std::uint32_t kLeastMirrored = 16;
  static constexpr unsigned kMostPlanes = 2;  ///< one in the half of another

  void codePlainly(Coder& coder, std::uint32_t count, Indices indices) {
    tree_.startSet(count);
    if (count == 0) return;
    points_.select(std::move(indices));
    tree_.finalLayer(coder);
  }

  /// Returns how many points have no pixel.
  std::uint32_t codeImage(Coder& coder, const std::optional<RangeImage>& image,
                          std::uint32_t count) {
    RangeImageHead head;
    if (image) head = image->head;
    RangeImageCoder<Coder> pixels;
    pixels.codeHead(coder, head, extent_, count);
    std::vector<RangePixel> row(head.size[0]);
    std::uint32_t left = count;
    for (std::uint32_t y = 0; y < head.size[1]; ++y) {
      const std::size_t first = std::size_t{y} * head.size[0];
      for (std::uint32_t x = 0; image && x < head.size[0]; ++x) row[x] = image->pixels[first + x];
      pixels.codeRow(coder, row);
      for (std::uint32_t x = 0; x < head.size[0]; ++x) {
        if (row[x].rank == RangePixel::kEmpty) continue;
        if (left-- == 0) throwTooMany();
        points_.append(pixels.pointOf(head, x, y, row[x], extent_),
                       image ? image->indices[first + x] : 0);
      }
      points_.working(row.size() * kBytesAPixel);
    }
    return left;
  }

  void codeSet(Coder& coder, const std::optional<MirrorPlane>& found, std::uint32_t count,
               Indices indices, unsigned planes) {
    const bool mayBeMirrored =
        features_.has(Features::kMirror) && planes > 0 && count >= kLeastMirrored;
    if (!mayBeMirrored || !coder.fixedBit(kRarely, found.has_value())) {
      codePlainly(coder, count, std::move(indices));
      return;
    }
    const MirrorPlane plane = codePlane(coder, found.value_or(MirrorPlane()));
    Indices originals;
    Indices others;
    for (const std::uint32_t i : indices) {
      (plane.isOriginal(points_.input(i)) ? originals : others).push_back(i);
    }
    const std::uint32_t halves = coder.uniform(static_cast<std::uint32_t>(originals.size()), count);
    std::optional<MirrorPlane> nested;
    if (Coder::kWriting && planes > 1) nested = findMirrorPlane(inputs(originals));
    const std::size_t first = points_.size();
    codeSet(coder, nested, halves, std::move(originals), planes - 1);
    const std::uint32_t left = codeCopies(coder, plane, first, halves, count - halves, others);
    codeSet(coder, std::nullopt, left, std::move(others), 0);
  }

  MirrorPlane codePlane(Coder& coder, MirrorPlane plane) {
    plane.axis = coder.slice(plane.axis, 3);
    const std::uint64_t most = 2 * std::uint64_t{extent_[plane.axis]};
    plane.sum = coder.wide(plane.sum, entropy::bitLength(most));
    if (plane.sum > most) {
      throw Error(ErrorCode::Corrupt,
                  "a mirror plane lies outside of its tile: the file is damaged");
    }
    return plane;
  }

  /// Copies of the points that were coded from `first` on; at most `most` of them. Returns how many
  /// points are no one's copy, and leaves the encoder's indices of those in `others`.
  std::uint32_t codeCopies(Coder& coder, const MirrorPlane& plane, std::size_t first,
                           std::uint32_t halves, std::uint32_t most, Indices& others) {
    MirrorMatches matches;
    if constexpr (Coder::kWriting) {
      std::vector<GridPoint> originals;
      originals.reserve(halves);
      for (std::uint32_t i = 0; i < halves; ++i) originals.push_back(points_.at(first + i));
      matches = matchMirrored(plane, originals, inputs(others));
    }
    MirrorCoder<Coder> mirror(plane, extent_);
    std::uint32_t left = most;
    for (std::uint32_t i = 0; i < halves; ++i) {
      const GridPoint original = points_.at(first + i);
      if (!plane.isOriginal(original)) {
        throw Error(ErrorCode::Corrupt, "a point lies behind its mirror: the file is damaged");
      }
      std::optional<MirrorOffset> offset;
      if constexpr (Coder::kWriting) offset = matches.offsets[i];
      const auto copy = mirror.code(coder, original, offset, tree_.predictors().phases);
      points_.working(0);
      if (!copy) continue;
      if (left-- == 0) throwTooMany();
      points_.append(*copy, Coder::kWriting ? others[matches.copies[i]] : 0);
      tree_.predictors().learnCoordinates(*copy);
    }
    if constexpr (Coder::kWriting) {
      Indices unmatched;
      for (const std::uint32_t i : matches.unmatched) unmatched.push_back(others[i]);
      others = std::move(unmatched);
    }
    return left;
  }

  std::vector<GridPoint> inputs(const Indices& indices) const {
    std::vector<GridPoint> inputs;
    inputs.reserve(indices.size());
    for (const std::uint32_t i : indices) inputs.push_back(points_.input(i));
    return inputs;
  }

  [[noreturn]] static void throwTooMany() {
    throw Error(ErrorCode::Corrupt, "a tile has more points than it says: the file is damaged");
  }

  static constexpr std::uint64_t kBytesAPixel = 32;

  const Features features_;
  const GridPoint extent_;
  Tree& tree_;
  Points& points_;
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
