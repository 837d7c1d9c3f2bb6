#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "geometry/surface/stencil.h"
#include "geometry/surface/vector3.h"
#include "geometry/surface/vertex_rings.h"

namespace bspc::geometry::surface {

constexpr unsigned kGuesses = 5;
constexpr unsigned kExact = 5;
/// One to four and more parallelograms, an edge, neighbours, nothing.
constexpr unsigned kSituations = 7;

/// Where a vertex is expected.
struct VertexPrediction {
  /// One way to expect it: a place, and the covariance of how far off it is.
  struct Guess {
    Vector3 place{};
    std::array<Vector3, 3> spread{};
  };
  /// Coordinates that it may have exactly, as vertices of swept and flat parts do.
  struct Exact {
    std::array<std::int64_t, 3> value{};
    std::array<std::uint8_t, 3> trust{};  ///< a class: how often that held so far
  };

  static constexpr unsigned kBest = 3;    ///< the guess that has learned
  static constexpr unsigned kShared = 3;  ///< the exact value that most neighbours have
  static constexpr unsigned kTrusts = 20;
  static constexpr std::int64_t kNever = -1;

  std::array<Guess, kGuesses> guesses;
  std::array<Exact, kExact> exact;
  std::array<std::uint8_t, 3> sharing{};  ///< how many neighbours have the shared value: 0 … 2
  unsigned situation = 0;
};

/// Predicts the vertices of a surface one after the other from those before, and learns from each.
class VertexPredictor {
 public:
  VertexPredictor(const VertexRings& rings, const GridPoint& extent);

  const VertexPrediction& predict(std::uint32_t vertex);
  /// Where the vertex that was predicted last is.
  void learn(std::uint32_t vertex, const GridPoint& place);

  /// Memory that it takes for so many vertices.
  static std::uint64_t bytesFor(std::uint64_t vertices) { return vertices * sizeof(Known); }

 private:
  static constexpr unsigned kFeatures = 8;
  /// Neighbours of neighbours, and vertices around one, that are looked at.
  static constexpr std::size_t kMostAround = 16;

  struct Known {
    Vector3 place{};
    Vector3 error{};  ///< of the mean parallelogram
    std::array<Vector3, kGuesses> errors{};
    std::array<std::array<bool, 3>, kExact> hits{};
    bool known = false;
  };
  struct Parallelogram {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::uint32_t across = 0;
    double length = 0;  ///< squared, of the side a b
    Vector3 place{};
  };
  /// Mean squares of the errors of a guess along the axes of the frame.
  struct Scale {
    std::array<double, 3> sum{100, 100, 100};
    double weight = 1;
  };

  bool isKnown(std::uint32_t v) const { return v != kNoVertex && known_[v].known; }
  const Vector3& at(std::uint32_t v) const { return known_[v].place; }

  void gather(std::uint32_t vertex);
  /// Mean parallelogram, or what stands in its place, and what may correct it.
  void makeFeatures(std::uint32_t vertex);
  void addParallelograms();
  Vector3 meanAround(std::uint32_t vertex) const;
  Vector3 meanStraight(std::uint32_t vertex) const;
  /// The vertex opposite `vertex` around `middle`, kNoVertex if there is no one such.
  std::uint32_t opposite(std::uint32_t vertex, std::uint32_t middle) const;
  void makeFrame();
  void makeGuesses();
  void makeExact();
  void makeShared(unsigned axis);
  std::uint8_t trustOf(unsigned exact, unsigned axis) const;

  const VertexRings& rings_;
  std::vector<Known> known_;
  Vector3 last_;
  std::array<Stencil<kFeatures>, kSituations> stencils_;
  std::array<std::array<Scale, kGuesses>, kSituations> scales_;
  std::array<std::array<std::uint8_t, 3>, kExact> recent_{};

  // Of the vertex at hand:
  std::vector<std::uint32_t> near_;  ///< neighbours that are known
  std::vector<Parallelogram> parallelograms_;
  bool hasEdge_ = false;
  Vector3 edge_{};  ///< the middle of the first known side without a parallelogram
  Vector3 mean_{};  ///< of the neighbours
  Vector3 base_{};  ///< what all features are counted from
  Vector3 normal_{};
  Stencil<kFeatures>::Vectors features_{};
  std::array<Vector3, 3> frame_{};
  VertexPrediction prediction_;
};

}  // namespace bspc::geometry::surface
