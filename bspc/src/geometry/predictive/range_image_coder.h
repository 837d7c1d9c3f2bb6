#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "bspc/error.h"
#include "entropy/adaptive_bit.h"
#include "entropy/counter.h"
#include "entropy/logistic_mixer.h"
#include "entropy/symbol_coder.h"
#include "geometry/predictive/range_image.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Codes range images: a head, then row by row whether pixels have a point, and how far its depth
/// is, in depths that occur, from what the pixels around tell.
///
/// Coder is SymbolWriter or SymbolReader.
template <class Coder>
class RangeImageCoder {
 public:
  RangeImageCoder()
      : maskMixer_({kNeighbourMasks, kSlopes + 1}, kMaskInputs, kMaskWeight, kMaskRate, kMaskAge),
        rankMixer_({kSteps * kActivities, kSteps * kSlopes, kSteps * 4}, kRankInputs, kRankWeight,
                   kRankRate, kRankAge) {
    for (std::size_t t = 0; t < mask_.size(); ++t) mask_[t].resize(kMaskSizes[t]);
    for (std::size_t t = 0; t < rank_.size(); ++t) rank_[t].resize(kSteps * kRankSizes[t]);
  }

  /// Codes the head of an image in a tile of `points` points with that extent; a reader fills it
  /// in. Throws Error(Corrupt) for one that no encoder writes.
  void codeHead(Coder& coder, RangeImageHead& head, const GridPoint& extent, std::uint64_t points) {
    codeCamera(coder, head.camera);
    for (unsigned k = 0; k < 2; ++k) {
      head.first[k] = static_cast<std::int32_t>(codeSigned(coder, head.first[k], kSizeBits));
      head.size[k] = coder.raw(head.size[k] - 1, kSizeBits) + 1;
    }
    const std::uint64_t pixels = std::uint64_t{head.size[0]} * head.size[1];
    if (pixels / RangeImageHead::kMaxPixelsAPoint > points) {
      throw Error(ErrorCode::Corrupt, "a range image has " + std::to_string(pixels) +
                                          " pixels for " + std::to_string(points) +
                                          " points: the file is damaged");
    }
    codeDepths(coder, head, extent[head.camera.depthAxis]);
    for (Row& row : rows_) row.assign(head.size[0] + kBefore + kBehind, RangePixel::kEmpty);
    lastErrors_.assign(head.size[0], 0);
    depths_ = head.depths.size();
  }

  /// Codes the next row of the image; a reader fills it in. `row` is as wide as the image.
  void codeRow(Coder& coder, Span<RangePixel> row) {
    std::rotate(rows_.begin(), rows_.end() - 1, rows_.end());
    std::fill(rows_[0].begin(), rows_[0].end(), RangePixel::kEmpty);
    std::int32_t errorBefore = 0;
    for (std::size_t x = 0; x < row.size(); ++x) {
      const Around around = lookAround(x);
      RangePixel& pixel = row[x];
      std::int32_t error = 0;
      if (!codeMask(coder, around, pixel.rank != RangePixel::kEmpty)) {
        pixel = RangePixel();
      } else {
        error = codeRank(coder, around, {errorBefore, lastErrors_[x]}, pixel.rank);
        for (unsigned k = 0; k < 2; ++k) codePlaceError(coder, k, pixel.error[k]);
        lastRank_ = pixel.rank;
      }
      rows_[0][x + kBefore] = pixel.rank;
      lastErrors_[x] = error;
      errorBefore = error;
    }
  }

  /// The point of a pixel. Throws Error(Corrupt) if it lies outside of the tile.
  static GridPoint pointOf(const RangeImageHead& head, std::uint32_t column, std::uint32_t row,
                           const RangePixel& pixel, const GridPoint& extent) {
    const auto rank = static_cast<std::size_t>(pixel.rank);
    const PinholeCamera& camera = head.camera;
    const std::array<std::uint32_t, 2> at = {column, row};
    GridPoint point{};
    point[camera.depthAxis] = head.depths[rank];
    for (unsigned k = 0; k < 2; ++k) {
      const double size = camera.pixelSize(k, head.depths[rank], head.shifts[rank]);
      const std::int32_t number = head.first[k] + static_cast<std::int32_t>(at[k]);
      const double x = camera.position(k, number, size) + pixel.error[k];
      if (!(x >= 0 && x <= static_cast<double>(extent[camera.axis(k)]))) {
        throw Error(ErrorCode::Corrupt,
                    "a pixel's point lies outside of its tile: the file is damaged");
      }
      point[camera.axis(k)] = static_cast<std::uint32_t>(x);
    }
    return point;
  }

 private:
  using Bit = entropy::AdaptiveBit;
  using Counter = entropy::Counter;
  using Row = std::vector<std::int32_t>;

  static constexpr unsigned kSizeBits = RangeImageHead::kSizeBits;
  static constexpr std::size_t kBefore = 3;  ///< empty pixels in front of a row
  static constexpr std::size_t kBehind = 2;

  // Decisions of a depth: is it as expected; is it behind; is it more than 1, 2, … depths off.
  static constexpr unsigned kUnarySteps = 14;
  static constexpr unsigned kSteps = 2 + kUnarySteps;
  static constexpr unsigned kSlopes = 9;
  static constexpr unsigned kActivities = 10;
  static constexpr unsigned kNeighbourMasks = 256;

  static constexpr unsigned kMaskInputs = 8;
  static constexpr float kMaskWeight = 0.3F;
  static constexpr entropy::MixingRate kMaskRate{0.02F, 60, 0.003F};
  static constexpr unsigned kMaskAge = 255;
  static constexpr unsigned kRankInputs = 16;
  static constexpr float kRankWeight = 0.15F;
  static constexpr entropy::MixingRate kRankRate{0.02F, 60, 0.003F};
  static constexpr unsigned kRankAge = 255;

  static constexpr std::array<std::size_t, 4> kMaskSizes = {1024, 2560, 6400, 2048};
  /// Contexts of a decision; each step has tables of its own.
  static constexpr std::array<std::size_t, 9> kRankSizes = {81, 81, 81, 40, 192, 81, 81, 324, 729};

  /// Ranks of the pixels around one that is to be coded; kEmpty where there is none.
  struct Around {
    std::int32_t w, ww, www, n, nn, nw, ne, nww, nee, nne;
    unsigned mask;       ///< which of them there are
    unsigned slopeWest;  ///< class of w − n, one up; 0 if one is missing
    unsigned slopeEast;  ///< of n − ne
  };

  /// The ranks that count for a depth: those around, missing ones filled in.
  struct Surface {
    std::int32_t expected;
    std::int32_t w, n, nw, ne, ww, nn, nee;
    unsigned activity;
    unsigned missing;
  };

  struct Errors {
    std::int32_t w, n;
  };

  /// Class of a difference: 0 … 4 … 8, the middle one for 0.
  static unsigned slopeClass(std::int32_t difference) {
    const std::int32_t size = std::abs(difference);
    const unsigned c = size < 3 ? static_cast<unsigned>(size) : size < 5 ? 3 : 4;
    return difference < 0 ? 4 - c : 4 + c;
  }

  static bool isThere(std::int32_t rank) { return rank != RangePixel::kEmpty; }

  Around lookAround(std::size_t x) const {
    const std::int32_t* here = rows_[0].data() + x + kBefore;
    const std::int32_t* above = rows_[1].data() + x + kBefore;
    const std::int32_t* top = rows_[2].data() + x + kBefore;
    Around a{};
    a.w = here[-1];
    a.ww = here[-2];
    a.www = here[-3];
    a.n = above[0];
    a.nw = above[-1];
    a.ne = above[1];
    a.nww = above[-2];
    a.nee = above[2];
    a.nn = top[0];
    a.nne = top[1];
    const std::array<std::int32_t, 10> all = {a.w,  a.n,   a.nw,  a.ne,  a.ww,
                                              a.nn, a.nne, a.nww, a.nee, a.www};
    for (unsigned i = 0; i < all.size(); ++i) a.mask |= (isThere(all[i]) ? 1U : 0U) << i;
    a.slopeWest = isThere(a.w) && isThere(a.n) ? slopeClass(a.w - a.n) + 1 : 0;
    a.slopeEast = isThere(a.n) && isThere(a.ne) ? slopeClass(a.n - a.ne) + 1 : 0;
    return a;
  }

  bool codeMask(Coder& coder, const Around& a, bool there) {
    const auto deepest = static_cast<unsigned>(std::max({a.w, a.n, a.nw, a.ne, std::int32_t{0}}));
    evidence_.clear();
    evidence_.add(0.3F);
    evidence_.add(mask_[0][a.mask]);
    evidence_.add(mask_[1][(a.mask & 255) * 10 + a.slopeWest]);
    evidence_.add(mask_[2][(a.mask & 63) * 100 + a.slopeWest * 10 + a.slopeEast]);
    evidence_.add(mask_[3][(a.mask & 15) * 128 + deepest / 4 % 128]);
    return maskMixer_.code(coder, there, evidence_, {a.mask & 255, a.slopeWest});
  }

  /// Median of the west, the north, and the plane through them and the north-west (as LOCO-I);
  /// whatever is there of them otherwise.
  std::int32_t expectedRank(const Around& a) const {
    const bool w = isThere(a.w);
    const bool n = isThere(a.n);
    if (w && n) {
      if (!isThere(a.nw)) return (a.w + a.n) / 2;
      const std::int32_t high = std::max(a.w, a.n);
      const std::int32_t low = std::min(a.w, a.n);
      return a.nw >= high ? low : a.nw <= low ? high : a.w + a.n - a.nw;
    }
    for (const std::int32_t rank : {a.w, a.n, a.ne, a.nw, a.nn}) {
      if (isThere(rank)) return rank;
    }
    return lastRank_;
  }

  Surface surfaceOf(const Around& a) const {
    const auto either = [](std::int32_t rank, std::int32_t other) {
      return isThere(rank) ? rank : other;
    };
    Surface s{};
    s.expected = expectedRank(a);
    s.w = either(a.w, s.expected);
    s.n = either(a.n, s.expected);
    s.nw = either(a.nw, s.expected);
    s.ne = either(a.ne, s.expected);
    s.ww = either(a.ww, s.w);
    s.nn = either(a.nn, s.n);
    s.nee = either(a.nee, s.ne);
    const std::int32_t unrest =
        std::abs(s.w - s.nw) + std::abs(s.n - s.nw) + std::abs(s.n - s.ne) + std::abs(s.ww - s.w);
    constexpr std::array<std::int32_t, kActivities - 1> kBounds = {1, 2, 3, 4, 6, 9, 14, 24, 50};
    while (s.activity < kBounds.size() && unrest >= kBounds[s.activity]) ++s.activity;
    s.missing = (isThere(a.w) ? 0U : 1U) + (isThere(a.n) ? 0U : 2U);
    return s;
  }

  /// The contexts of a pixel's depth, those of its first decision.
  struct RankContexts {
    std::array<std::size_t, 9> index;
    unsigned activity;
    unsigned slope;
    unsigned missing;
  };

  static RankContexts contextsOf(const Surface& s, const Errors& errors) {
    const std::int32_t e = s.expected;
    const auto pair = [](std::int32_t a, std::int32_t b) {
      return std::size_t{slopeClass(a)} * kSlopes + slopeClass(b);
    };
    const std::int32_t plane = (3 * (s.w + s.n) - 2 * s.nw + 2) >> 2;
    RankContexts c{};
    c.index[0] = pair(s.w - e, s.n - e);
    c.index[1] = pair(s.ne - e, s.nw - e);
    c.index[2] = pair(s.ww - s.w, s.nn - s.n);
    c.index[3] = std::size_t{s.activity} * 4 + s.missing;
    c.index[4] = static_cast<std::size_t>(std::min(e / 6, 63)) * 3 + std::min(s.activity / 2, 2U);
    c.index[5] = pair(errors.w, errors.n);
    c.index[6] = pair(plane - e, 2 * s.w - s.ww - e);
    c.index[7] = pair(2 * s.n - s.nn - e, s.nee - e) * 4 + std::min(s.activity / 3, 3U);
    c.index[8] = pair(s.w - e, s.n - e) * kSlopes + slopeClass(s.ne - e);
    c.activity = s.activity;
    c.slope = slopeClass(errors.w);
    c.missing = s.missing;
    return c;
  }

  bool decide(Coder& coder, const RankContexts& c, unsigned step, bool bit) {
    evidence_.clear();
    evidence_.add(0.3F);
    for (std::size_t t = 0; t < rank_.size(); ++t) {
      evidence_.add(rank_[t][step * kRankSizes[t] + c.index[t]]);
    }
    return rankMixer_.code(
        coder, bit, evidence_,
        {step * kActivities + c.activity, step * kSlopes + c.slope, step * 4 + c.missing});
  }

  /// Returns the error of what was expected.
  std::int32_t codeRank(Coder& coder, const Around& around, const Errors& errors,
                        std::int32_t& rank) {
    const Surface surface = surfaceOf(around);
    const RankContexts contexts = contextsOf(surface, errors);
    const std::int32_t wanted = rank - surface.expected;
    if (!decide(coder, contexts, 0, wanted != 0)) {
      rank = surface.expected;
      return 0;
    }
    const bool behind = decide(coder, contexts, 1, wanted > 0);
    const auto beyond = static_cast<std::uint32_t>(std::abs(wanted)) - 1;
    std::uint32_t size = 0;
    while (size < kUnarySteps && decide(coder, contexts, 2 + size, beyond > size)) ++size;
    if (size == kUnarySteps) size += codeNumber(coder, escape_, beyond - kUnarySteps);
    const std::int64_t error = behind ? std::int64_t{size} + 1 : -(std::int64_t{size} + 1);
    const std::int64_t value = surface.expected + error;
    if (value < 0 || value >= static_cast<std::int64_t>(depths_)) {
      throw Error(ErrorCode::Corrupt, "a pixel has a depth that is none: the file is damaged");
    }
    rank = static_cast<std::int32_t>(value);
    return static_cast<std::int32_t>(error);
  }

  void codePlaceError(Coder& coder, unsigned k, std::int8_t& error) {
    if (!coder.bit(placeError_[k][0], error != 0)) {
      error = 0;
      return;
    }
    error = coder.bit(placeError_[k][1], error > 0) ? 1 : -1;
  }

  static constexpr unsigned kMaxLength = 20;  ///< of numbers below 2^20
  using Lengths = std::array<Bit, kMaxLength>;

  /// Codes a number below 2^20 − 1: the length of the number after it, then the digits.
  static std::uint32_t codeNumber(Coder& coder, Lengths& lengths, std::uint32_t number) {
    const unsigned wanted = entropy::bitLength(std::uint64_t{number} + 1) - 1;
    unsigned length = 0;
    while (length + 1 < kMaxLength && coder.bit(lengths[length], length < wanted)) ++length;
    const std::uint32_t top = 1U << length;
    return (top | coder.raw((number + 1) & (top - 1), length)) - 1;
  }

  static std::int64_t codeSigned(Coder& coder, std::int64_t value, unsigned bits) {
    const std::uint64_t middle = std::uint64_t{1} << (bits - 1);
    const std::uint64_t mask = 2 * middle - 1;
    const std::uint64_t shifted =
        coder.wide((static_cast<std::uint64_t>(value) + middle) & mask, bits);
    return static_cast<std::int64_t>(shifted) - static_cast<std::int64_t>(middle);
  }

  static void codeCamera(Coder& coder, PinholeCamera& camera) {
    constexpr unsigned kBits = PinholeCamera::kParameterBits;
    camera.depthAxis = coder.slice(camera.depthAxis, 3);
    camera.depthOffset = codeSigned(coder, camera.depthOffset, kBits);
    for (unsigned k = 0; k < 2; ++k) {
      camera.pitch[k] = codeSigned(coder, camera.pitch[k], kBits);
      camera.offset[k] = codeSigned(coder, camera.offset[k], kBits);
      camera.centre[k] = codeSigned(coder, camera.centre[k], PinholeCamera::kCentreBits);
    }
  }

  static void codeDepths(Coder& coder, RangeImageHead& head, std::uint32_t extent) {
    constexpr unsigned kShifts = 2 * PinholeCamera::kMaxShift + 1;
    const std::size_t count = coder.raw(static_cast<std::uint32_t>(head.depths.size()) - 1, 16) + 1;
    Lengths gaps;
    Bit shifted;
    std::uint64_t next = 0;  // the least depth that may come
    for (std::size_t i = 0; i < count; ++i) {
      if constexpr (!Coder::kWriting) {
        head.depths.push_back(0);
        head.shifts.push_back(0);
      }
      next += codeNumber(coder, gaps, static_cast<std::uint32_t>(head.depths[i] - next));
      if (next > extent) {
        throw Error(ErrorCode::Corrupt, "a depth lies outside of its tile: the file is damaged");
      }
      head.depths[i] = static_cast<std::uint32_t>(next++);
      const int shift = head.shifts[i];
      if (coder.bit(shifted, shift != 0)) {
        const auto code = static_cast<std::uint32_t>(shift + PinholeCamera::kMaxShift);
        head.shifts[i] = static_cast<std::int8_t>(static_cast<int>(coder.slice(code, kShifts)) -
                                                  PinholeCamera::kMaxShift);
      }
    }
  }

  entropy::Evidence evidence_;
  entropy::LogisticMixer<2> maskMixer_;
  entropy::LogisticMixer<3> rankMixer_;
  std::array<std::vector<Counter>, 4> mask_;
  std::array<std::vector<Counter>, 9> rank_;
  std::array<std::array<Bit, 2>, 2> placeError_;
  Lengths escape_;
  std::array<Row, 3> rows_;  ///< ranks of this row and the two above it
  std::vector<std::int32_t> lastErrors_;
  std::int32_t lastRank_ = 0;
  std::size_t depths_ = 0;
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
