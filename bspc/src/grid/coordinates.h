#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/point_set.h"

namespace bspc::lattice {

/// The least and the greatest coordinate along one axis; −0 counts as +0.
struct AxisRange {
  double min = 0;
  double max = 0;

  bool constant() const { return min == max; }
  double maxAbs() const { return std::max(max, -min); }
  /// Infinite if the two ends are more than the largest double apart.
  double extent() const { return max - min; }
};

using Ranges = std::array<AxisRange, 3>;

/// The coordinates of points, wherever they are kept, converted to double a chunk at a time, so
/// that nothing needs a copy of the points or a type switch for each number.
class Coordinates {
 public:
  static constexpr std::size_t kChunk = 512;
  using Chunk = std::array<double, kChunk>;

  virtual ~Coordinates() = default;

  std::uint64_t size() const { return size_; }
  ScalarType type() const { return type_; }

  /// Coordinates of the points first … first + count − 1 along `axis`, each `hop` points apart.
  virtual void gather(std::size_t axis, std::uint64_t first, std::size_t count, double* out,
                      std::uint64_t hop = 1) const = 0;

  /// All the points as they stand in memory; null if they do not, or some are left out.
  virtual const PointSetView* inMemory() const { return nullptr; }

  /// Up to `wanted` coordinates spread over the whole set.
  std::vector<double> sample(std::size_t axis, std::size_t wanted) const;

  /// Calls visit(value) for every coordinate along `axis` until it returns false; whether it
  /// never did.
  template <class Visit>
  bool all(std::size_t axis, Visit visit) const {
    return allChunks(axis, [&visit](const Chunk& chunk, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        if (!visit(chunk[i])) return false;
      }
      return true;
    });
  }

  /// The same with visit(chunk, count).
  template <class Visit>
  bool allChunks(std::size_t axis, Visit visit) const {
    Chunk chunk;
    for (std::uint64_t first = 0; first < size_; first += kChunk) {
      const std::size_t count = chunkSize(first);
      gather(axis, first, count, chunk.data());
      if (!visit(chunk, count)) return false;
    }
    return true;
  }

  std::size_t chunkSize(std::uint64_t first) const {
    return static_cast<std::size_t>(std::min<std::uint64_t>(kChunk, size_ - first));
  }

 protected:
  Coordinates(ScalarType type, std::uint64_t size) : type_(type), size_(size) {}

 private:
  ScalarType type_;
  std::uint64_t size_;
};

/// Those of the points of a view that are kept.
class ViewCoordinates final : public Coordinates {
 public:
  /// Both must outlive this; `kept` holds input indices, and is empty for "all of them".
  ViewCoordinates(const PointSetView& points, const std::vector<std::uint64_t>& kept)
      : Coordinates(points.type(), kept.empty() ? points.size() : kept.size()),
        points_(points),
        kept_(kept) {}

  void gather(std::size_t axis, std::uint64_t first, std::size_t count, double* out,
              std::uint64_t hop) const override;
  const PointSetView* inMemory() const override { return kept_.empty() ? &points_ : nullptr; }

 private:
  template <class T>
  void gatherAs(std::size_t axis, std::uint64_t first, std::size_t count, double* out,
                std::uint64_t hop) const;

  const PointSetView& points_;
  const std::vector<std::uint64_t>& kept_;
};

/// Throws Error(InvalidArgument) naming the point if a 64-bit integer is beyond ±2^53, where
/// doubles have gaps. `firstIndex` is that of the view's first point.
void requireIntegersInDoubles(const PointSetView& points, std::uint64_t firstIndex = 0);

}  // namespace bspc::lattice
