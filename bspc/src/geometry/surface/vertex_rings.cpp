#include "geometry/surface/vertex_rings.h"

#include <algorithm>
#include <array>
#include <deque>

namespace bspc::geometry::surface {

namespace {

template <class Visit>
void forEachTriangle(const Cells& faces, Visit visit) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Span<const std::uint32_t> face = faces[i];
    for (std::size_t j = 2; j < face.size(); ++j) {
      visit(std::array<std::uint32_t, 3>{face[0], face[j - 1], face[j]});
    }
  }
}

/// Decides the sequence as vertices become known one after the other.
class Sequencer {
 public:
  explicit Sequencer(const VertexRings& rings)
      : rings_(rings),
        known_(rings.vertices(), 0),
        parallelograms_(rings.vertices(), 0),
        class_(rings.vertices(), 0) {}

  std::vector<std::uint32_t> run() {
    std::vector<std::uint32_t> sequence;
    sequence.reserve(rings_.vertices());
    for (std::uint32_t first = 0; first < rings_.vertices(); ++first) {
      for (std::uint32_t v = first; v != kNoVertex; v = next()) {
        if (known_[v] != 0) continue;
        sequence.push_back(v);
        take(v);
      }
    }
    return sequence;
  }

 private:
  /// Nothing yet, an edge, one parallelogram, …, four or more.
  static constexpr unsigned kClasses = 6;

  std::uint32_t next() {
    for (unsigned c = kClasses; c-- > 1;) {
      while (!queues_[c].empty()) {
        const std::uint32_t vertex = queues_[c].front();
        queues_[c].pop_front();
        if (known_[vertex] == 0 && class_[vertex] == c) return vertex;
      }
    }
    return kNoVertex;
  }

  void take(std::uint32_t vertex) {
    known_[vertex] = 1;
    for (const VertexRings::Side side : rings_.sides(vertex)) {
      const bool from = known_[side.from] != 0;
      const bool to = known_[side.to] != 0;
      // The triangle's third vertex lies opposite an edge that is known now.
      if (from && !to) learn(side.to, rings_.third(side.from, vertex));
      if (to && !from) learn(side.from, rings_.third(vertex, side.to));
      if (from && to) complete(rings_.third(side.to, side.from));
    }
  }

  /// `vertex` lies opposite a known edge, `across` on its other side.
  void learn(std::uint32_t vertex, std::uint32_t across) {
    if (across != kNoVertex && across != vertex && known_[across] != 0) {
      complete(vertex);
    } else {
      raise(vertex, 1);
    }
  }
  /// There is one parallelogram more for `vertex`.
  void complete(std::uint32_t vertex) {
    if (vertex == kNoVertex || known_[vertex] != 0) return;
    ++parallelograms_[vertex];
    raise(vertex, 1 + std::min(parallelograms_[vertex], kClasses - 2));
  }
  void raise(std::uint32_t vertex, unsigned to) {
    if (class_[vertex] >= to) return;
    class_[vertex] = static_cast<std::uint8_t>(to);
    queues_[to].push_back(vertex);
  }

  const VertexRings& rings_;
  std::vector<std::uint8_t> known_;
  std::vector<std::uint32_t> parallelograms_;
  std::vector<std::uint8_t> class_;
  std::array<std::deque<std::uint32_t>, kClasses> queues_;
};

}  // namespace

VertexRings::VertexRings(const connectivity::SurfaceFaces& surface)
    : firstSide_(std::size_t{surface.vertices} + 1, 0) {
  forEachTriangle(surface.faces, [&](const std::array<std::uint32_t, 3>& t) {
    for (const std::uint32_t v : t) ++firstSide_[v + 1];
  });
  for (std::size_t v = 0; v < surface.vertices; ++v) firstSide_[v + 1] += firstSide_[v];
  sides_.resize(firstSide_.back());
  std::vector<std::size_t> next(firstSide_.begin(), firstSide_.end() - 1);
  forEachTriangle(surface.faces, [&](const std::array<std::uint32_t, 3>& t) {
    for (unsigned j = 0; j < 3; ++j) {
      const Side side{t[(j + 1) % 3], t[(j + 2) % 3]};
      sides_[next[t[j]]++] = side;
      if (!thirds_.contains(side.from, side.to)) thirds_.put(side.from, side.to, t[j]);
    }
  });
  firstNeighbour_.push_back(0);
  std::vector<std::uint32_t> ring;
  for (std::uint32_t v = 0; v < surface.vertices; ++v) {
    ring.clear();
    for (const Side side : sides(v)) {
      ring.push_back(side.from);
      ring.push_back(side.to);
    }
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    neighbours_.insert(neighbours_.end(), ring.begin(), ring.end());
    firstNeighbour_.push_back(neighbours_.size());
  }
}

std::vector<std::uint32_t> sequenceOf(const VertexRings& rings) { return Sequencer(rings).run(); }

}  // namespace bspc::geometry::surface
