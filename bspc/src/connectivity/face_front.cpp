#include "connectivity/face_front.h"

#include <algorithm>

namespace bspc::connectivity {

void FaceFront::addVertex() {
  gates_.addVertex();
  valence_.push_back(0);
  border_.push_back(0);
}

std::uint32_t FaceFront::faceAt(std::uint32_t from, std::uint32_t to) const {
  const std::uint32_t corner = cornerAt(from, to);
  return corner == kNoVertex ? kNoVertex : faceOf(corner);
}

std::uint32_t FaceFront::cornerAfter(std::uint32_t corner) const {
  const std::uint32_t face = faceOf(corner);
  return corner + 1 < faceStart(face + 1) ? corner + 1 : faceStart(face);
}

std::uint32_t FaceFront::corners(std::uint32_t face) const {
  return faceStart(face + 1) - faceStart(face);
}

std::uint32_t FaceFront::apexOf(std::uint32_t from, std::uint32_t to) const {
  const std::uint32_t corner = cornerAt(from, to);
  if (corner == kNoVertex) return kNoVertex;
  const std::uint32_t face = faceOf(corner);
  return corners_[(corner > faceStart(face) ? corner : faceStart(face + 1)) - 1];
}

bool FaceFront::fits(Span<const std::uint32_t> face) const {
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!free(face[i], face[i + 1 < face.size() ? i + 1 : 0])) return false;
  }
  if (face.size() == 3) return face[0] != face[1] && face[1] != face[2] && face[2] != face[0];
  std::vector<std::uint32_t> sorted(face.begin(), face.end());
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

void FaceFront::place(Span<const std::uint32_t> face, std::vector<Edge>& opened) {
  opened.clear();
  const auto start = static_cast<std::uint32_t>(corners_.size());
  for (std::size_t i = 0; i < face.size(); ++i) {
    const Edge edge{face[i], face[i + 1 < face.size() ? i + 1 : 0]};
    ++valence_[edge.from];
    const std::uint32_t corner = start + static_cast<std::uint32_t>(i);
    const std::uint32_t across = cornerAt(edge.to, edge.from);
    halfEdges_.put(edge.from, edge.to, corner);
    if (across != kNoVertex) {
      gates_.close(across);
    } else if (free(edge.to, edge.from)) {
      gates_.open(edge.to, edge.from, corner);
      opened.push_back({edge.to, edge.from});
    }
  }
  corners_.insert(corners_.end(), face.begin(), face.end());
  if (!triangles_) {
    faceOf_.insert(faceOf_.end(), face.size(), static_cast<std::uint32_t>(faceEnds_.size()));
    faceEnds_.push_back(static_cast<std::uint32_t>(corners_.size()));
  }
}

void FaceFront::close(Edge edge) {
  halfEdges_.put(edge.from, edge.to, kBorder);
  gates_.close(cornerAt(edge.to, edge.from));
  border_[edge.from] |= kBegins;
  border_[edge.to] |= kEnds;
}

std::size_t FaceFront::bytes() const {
  return halfEdges_.bytes() + gates_.bytes() +
         (corners_.capacity() + faceOf_.capacity() + faceEnds_.capacity()) * 4;
}

}  // namespace bspc::connectivity
