#include "connectivity/mesh_preparation.h"

#include <algorithm>

#include "connectivity/half_edge_map.h"

namespace bspc::connectivity {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

bool isProper(Span<const std::uint32_t> face) {
  if (face.size() < 3) return false;
  std::vector<std::uint32_t> sorted(face.begin(), face.end());
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

std::uint32_t follower(Span<const std::uint32_t> face, std::size_t i) {
  return face[i + 1 < face.size() ? i + 1 : 0];
}

/// Which face lies on the other side of each edge that exactly two faces have.
class EdgeNeighbours {
 public:
  EdgeNeighbours(const Cells& faces, const std::vector<std::uint8_t>& proper)
      : across_(faces.indices.size(), kNone), sameWay_(faces.indices.size(), 0) {
    std::vector<Use> uses;
    uses.reserve(faces.indices.size());
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
      if (proper[i] == 0) continue;
      const Span<const std::uint32_t> face = faces[i];
      for (std::size_t j = 0; j < face.size(); ++j) {
        const std::uint32_t a = face[j];
        const std::uint32_t b = follower(face, j);
        uses.push_back({std::min(a, b), std::max(a, b), i,
                        faces.first(i) + static_cast<std::uint32_t>(j), a < b});
      }
    }
    std::sort(uses.begin(), uses.end(), [](const Use& x, const Use& y) {
      return x.low != y.low     ? x.low < y.low
             : x.high != y.high ? x.high < y.high
                                : x.corner < y.corner;
    });
    for (std::size_t i = 0; i < uses.size();) {
      std::size_t end = i + 1;
      while (end < uses.size() && uses[end].low == uses[i].low && uses[end].high == uses[i].high) {
        ++end;
      }
      if (end - i == 2) connect(uses[i], uses[i + 1]);
      i = end;
    }
  }

  bool consistent() const { return consistent_; }
  std::uint32_t across(std::uint32_t corner) const { return across_[corner]; }
  bool sameWay(std::uint32_t corner) const { return sameWay_[corner] != 0; }

 private:
  struct Use {
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t face;
    std::uint32_t corner;
    bool forward;
  };

  void connect(const Use& a, const Use& b) {
    across_[a.corner] = b.face;
    across_[b.corner] = a.face;
    if (a.forward == b.forward) {
      sameWay_[a.corner] = sameWay_[b.corner] = 1;
      consistent_ = false;
    }
  }

  std::vector<std::uint32_t> across_;
  std::vector<std::uint8_t> sameWay_;
  bool consistent_ = true;
};

/// Turns faces so that neighbours run along their common edge in opposite ways, as few of a
/// component as possible.
std::vector<std::uint8_t> orient(const Cells& faces, const std::vector<std::uint8_t>& proper) {
  std::vector<std::uint8_t> flipped(faces.size(), 0);
  const EdgeNeighbours neighbours(faces, proper);
  if (neighbours.consistent()) return flipped;
  std::vector<std::uint8_t> visited(faces.size(), 0);
  std::vector<std::uint32_t> component;
  for (std::uint32_t seed = 0; seed < faces.size(); ++seed) {
    if (proper[seed] == 0 || visited[seed] != 0) continue;
    component.assign(1, seed);
    visited[seed] = 1;
    std::size_t turned = 0;
    for (std::size_t head = 0; head < component.size(); ++head) {
      const std::uint32_t i = component[head];
      turned += flipped[i];
      for (std::uint32_t corner = faces.first(i); corner < faces.ends[i]; ++corner) {
        const std::uint32_t j = neighbours.across(corner);
        if (j == kNone || visited[j] != 0) continue;
        visited[j] = 1;
        flipped[j] = flipped[i] ^ (neighbours.sameWay(corner) ? 1 : 0);
        component.push_back(j);
      }
    }
    if (2 * turned > component.size()) {
      for (const std::uint32_t i : component) flipped[i] ^= 1;
    }
  }
  return flipped;
}

}  // namespace

PreparedFaces prepareFaces(const Cells& faces) {
  std::vector<std::uint8_t> proper(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) proper[i] = isProper(faces[i]) ? 1 : 0;
  PreparedFaces prepared;
  prepared.faces = faces;
  prepared.flipped = orient(faces, proper);
  HalfEdgeMap edges;
  for (std::uint32_t i = 0; i < faces.size(); ++i) {
    if (prepared.flipped[i] != 0) {
      std::reverse(prepared.faces.indices.begin() + faces.first(i),
                   prepared.faces.indices.begin() + faces.ends[i]);
    }
    const Span<const std::uint32_t> face = prepared.faces[i];
    bool fits = proper[i] != 0;
    for (std::size_t j = 0; fits && j < face.size(); ++j) {
      fits = !edges.contains(face[j], follower(face, j));
    }
    if (!fits) {
      prepared.irregular.push_back(i);
      continue;
    }
    for (std::size_t j = 0; j < face.size(); ++j) {
      edges.put(face[j], follower(face, j), i);
    }
    prepared.regular.push_back(i);
    if (prepared.flipped[i] != 0) prepared.anyFlipped = true;
  }
  for (const std::uint32_t i : prepared.regular) {
    const Span<const std::uint32_t> face = prepared.faces[i];
    for (std::size_t j = 0; j < face.size(); ++j) {
      if (!edges.contains(follower(face, j), face[j])) ++prepared.borderEdges;
    }
  }
  return prepared;
}

void keepRegular(PreparedFaces& faces, std::vector<std::uint32_t> reached) {
  std::sort(reached.begin(), reached.end());
  std::vector<std::uint32_t> regular;
  for (const std::uint32_t i : faces.regular) {
    const bool isReached = std::binary_search(reached.begin(), reached.end(), i);
    (isReached ? regular : faces.irregular).push_back(i);
  }
  faces.regular = std::move(regular);
}

}  // namespace bspc::connectivity
