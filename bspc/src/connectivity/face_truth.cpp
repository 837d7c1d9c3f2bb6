#include "connectivity/face_truth.h"

namespace bspc::connectivity {

FaceTruth::FaceTruth(const Cells& faces, const std::vector<std::uint8_t>& flipped,
                     const std::vector<std::uint32_t>& chosen, std::size_t vertices)
    : faces_(faces), flipped_(flipped), faceOf_(faces.indices.size()), firstEdge_(vertices + 1) {
  for (const std::uint32_t i : chosen) {
    for (const std::uint32_t vertex : faces[i]) ++firstEdge_[vertex + 1];
  }
  for (std::size_t v = 0; v < vertices; ++v) firstEdge_[v + 1] += firstEdge_[v];
  followers_.resize(firstEdge_[vertices]);
  std::vector<std::uint32_t> next(firstEdge_.begin(), firstEdge_.end() - 1);
  for (const std::uint32_t i : chosen) {
    const Span<const std::uint32_t> face = faces[i];
    for (std::size_t j = 0; j < face.size(); ++j) {
      const std::uint32_t to = face[j + 1 < face.size() ? j + 1 : 0];
      const std::uint32_t corner = faces.first(i) + static_cast<std::uint32_t>(j);
      corners_.put(face[j], to, corner);
      faceOf_[corner] = i;
      followers_[next[face[j]]++] = to;
    }
  }
}

std::uint32_t FaceTruth::neighbour(std::uint32_t vertex,
                                   const std::vector<Neighbour>& nearest) const {
  for (const Neighbour& n : nearest) {
    for (std::uint32_t i = firstEdge_[vertex]; i < firstEdge_[vertex + 1]; ++i) {
      if (followers_[i] == n.vertex) return n.vertex;
    }
  }
  return followers_[firstEdge_[vertex]];
}

void FaceTruth::take(Edge edge) {
  const std::uint32_t corner = corners_.find(edge.from, edge.to);
  const std::uint32_t id = faceOf_[corner];
  const Span<const std::uint32_t> face = faces_[id];
  const std::size_t start = corner - faces_.first(id);
  face_.clear();
  for (std::size_t j = 0; j < face.size(); ++j) face_.push_back(face[(start + j) % face.size()]);
  order_.push_back(id);
  firstCorners_.push_back(corner);
}

}  // namespace bspc::connectivity
